//! A material ready for light: the reflectance, and the colours that go with it.

use std::f32::consts::PI;

use glam::Vec3;
use phong_bvh::Lanes;
use phong_scene::{
    self as scene, AmbientRule, ConstantMaterial, Model, OpacityMode, Rgb, ShadowRule, Tint,
    VertexColors, Viewer,
};

use crate::light::LightSample;
use crate::math::lanes::splat3;
use crate::math::{self, Dir3};
use crate::reflectance::{
    BlinnPhong, Distribution, Falloff, Incident, Lambert, Microfacet, OrenNayar, OrenNayarForm,
    Phong, Reflectance, Switches, Ward, fresnel,
};
use crate::terms::Terms;

/// A material ready for light.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// How it answers one light.
    pub reflectance: Reflectance,
    /// The diffuse colour where the geometry brings none of its own.
    pub color: Rgb,
    /// What it does with one that the geometry brings.
    pub vertex_colors: VertexColors,
    ambient_color: Option<Rgb>,
    specular_color: Option<Rgb>,
    k_a: f32,
    k_e: f32,
    emission_color: Option<Rgb>,
    tint: Tint,
    ambient_rule: AmbientRule,
    /// Where highlights are seen from, if not from the ray's own eye.
    distant_eye: Option<Dir3>,
    /// Weight of the mirror ray, before Fresnel.
    pub reflection: Rgb,
    /// Weight of the refracted ray, before Fresnel.
    pub transmission: Rgb,
    /// Share of the surface that is there, seen from the front in a mode that knows angles: what is behind
    /// it counts the rest.
    pub opacity: f32,
    opacity_mode: OpacityMode,
    /// With a mask: from which opacity on the surface is there.
    cutoff: f32,
    /// How many see-through surfaces a ray may have passed and still meet it: fewer than this.
    surfaces: u32,
    shadow: Option<ShadowRule>,
    /// Index of refraction of the inside relative to the outside.
    pub ior: f32,
    /// Which of several surfaces or glasses in one place counts: that of the highest priority.
    pub priority: u32,
    /// Whether exact dielectric Fresnel shares light between the two.
    pub fresnel: bool,
}

impl Material {
    /// The material of a scene whose camera is infinitely far in direction `viewer`, for materials
    /// that see highlights from there.
    pub fn new(material: &ConstantMaterial, viewer: Dir3) -> Self {
        Self {
            reflectance: reflectance(material),
            color: material.color,
            vertex_colors: material.vertex_colors,
            ambient_color: material.ambient_color,
            specular_color: material.specular_color,
            k_a: material.k_a,
            k_e: material.k_e,
            emission_color: material.emission_color,
            tint: material.tint,
            ambient_rule: material.ambient_rule,
            distant_eye: (material.viewer == Viewer::Distant).then_some(viewer),
            reflection: material.reflection,
            transmission: material.transmission,
            opacity: material.opacity,
            opacity_mode: material.opacity_mode,
            cutoff: material.cutoff,
            surfaces: material.surfaces.unwrap_or(u32::MAX),
            shadow: material.shadow,
            ior: material.ior,
            priority: material.priority,
            fresnel: material.fresnel,
        }
    }

    /// `k_a C_a` under the ambient light `ambient`, where the surface's colour is `color`; black
    /// where the ambient term is added per light.
    #[inline]
    pub fn ambient(&self, color: Rgb, ambient: Rgb) -> Rgb {
        Rgb::from(self.ambient_of(color.to_array(), ambient))
    }

    /// [`Material::ambient`] of one surface, or of eight.
    #[inline(always)]
    pub(crate) fn ambient_of<F: Lanes<Scalar = f32>>(&self, color: [F; 3], ambient: Rgb) -> [F; 3] {
        let like = |c: Rgb| splat3(color[0], c.to_array());
        match self.ambient_rule {
            AmbientRule::Once | AmbientRule::Both => {
                let [r, g, b] = self.ambient_color.map_or(color, like);
                let k_a = self.k_a;
                [r * ambient.r * k_a, g * ambient.g * k_a, b * ambient.b * k_a]
            }
            AmbientRule::PerLight => like(Rgb::BLACK),
        }
    }

    /// Whether it has light of its own.
    #[inline]
    pub fn glows(&self) -> bool {
        self.k_e > 0.0
    }

    /// `k_e C_e` where the surface's colour is `color`, of one surface or of eight.
    #[inline(always)]
    pub(crate) fn emission_of<F: Lanes<Scalar = f32>>(&self, color: [F; 3]) -> [F; 3] {
        let own = |c: Rgb| splat3(color[0], c.to_array());
        self.emission_color.map_or(color, own).map(|channel| channel * self.k_e)
    }

    /// Whether mirror or glass rays go on from it.
    pub fn bounces(&self) -> bool {
        !(self.reflection.is_black() && self.transmission.is_black())
    }

    /// Whether what is behind is seen through it in a straight line.
    #[inline]
    pub fn is_see_through(&self) -> bool {
        self.opacity < 1.0
    }

    /// The share of the surface that is there, of one or of eight that are seen at these cosines by rays that
    /// have `passed` so many see-through surfaces.
    #[inline(always)]
    pub(crate) fn cover<F: Lanes<Scalar = f32>>(&self, n_dot_e: F, passed: u32) -> F {
        let opacity = self.opacity;
        if passed >= self.surfaces && self.is_see_through() {
            return n_dot_e.splat(0.0);
        }
        match self.opacity_mode {
            OpacityMode::Plain => n_dot_e.splat(opacity),
            OpacityMode::Mask => n_dot_e.splat(if opacity >= self.cutoff { 1.0 } else { 0.0 }),
            OpacityMode::Angle => n_dot_e.map(|cos| {
                let root = 0.5 + 0.5 * math::cos(PI * (1.0 - opacity) * cos.clamp(0.0, 1.0));
                root * root
            }),
        }
    }

    /// What is left of a light that goes through it in a straight line, at this cosine.
    pub(crate) fn passes(&self, cos: f32) -> Rgb {
        let cover = self.cover(cos, 0);
        let beside = Rgb::grey(1.0 - cover);
        match self.shadow {
            None => beside,
            Some(ShadowRule::Full) => Rgb::BLACK,
            Some(ShadowRule::Filtered) => beside + cover * self.transmission,
        }
    }

    /// Whether each light adds to the ambient term.
    #[inline]
    pub fn takes_ambient_per_light(&self) -> bool {
        self.ambient_rule != AmbientRule::Once
    }

    /// What one light adds to the ambient term: nothing where that is added once.
    #[inline]
    pub fn ambient_of_light(&self, color: Rgb, ambient: Rgb, light: &LightSample) -> Rgb {
        match self.ambient_rule {
            AmbientRule::Once => Rgb::BLACK,
            AmbientRule::PerLight => {
                self.k_a * (ambient * self.ambient_color.unwrap_or(color) * light.color)
            }
            AmbientRule::Both => self.k_a * (self.ambient_color.unwrap_or(color) * light.color),
        }
    }

    /// E as highlights are seen, for rays whose E is `e`: that, unless the viewer is distant.
    #[inline]
    pub fn eye(&self, e: Dir3) -> Dir3 {
        Dir3::from_unit(Vec3::from(self.eye_of(e.to_array())))
    }

    /// [`Material::eye`] of one ray, or of eight.
    #[inline(always)]
    pub(crate) fn eye_of<F: Lanes<Scalar = f32>>(&self, e: [F; 3]) -> [F; 3] {
        match self.distant_eye {
            Some(eye) => splat3(e[0], eye.to_array()),
            None => e,
        }
    }

    /// The light tinted by the material: `C_{m,d}` and `C_{m,s}`, where the normal is `n`.
    #[inline]
    pub fn incident(&self, n: Dir3, color: Rgb, light: &LightSample) -> Incident {
        let LightSample { l, color: diffuse, specular_color: specular, .. } = *light;
        let arriving = [diffuse.to_array(), specular.to_array()];
        let [c_d, c_s] = self.tint(n.dot(l), color.to_array(), arriving);
        Incident { l, c_d: Rgb::from(c_d), c_s: Rgb::from(c_s), color }
    }

    /// `C_{m,d}` and `C_{m,s}` of one surface of colour `color`, or of eight, that light of these diffuse
    /// and specular colours meets at cosine `n_dot_l`.
    #[inline(always)]
    pub(crate) fn tint<F: Lanes<Scalar = f32>>(
        &self,
        n_dot_l: F,
        color: [F; 3],
        [diffuse, specular]: [[F; 3]; 2],
    ) -> [[F; 3]; 2] {
        let own = match self.specular_color {
            Some(own) => splat3(n_dot_l, own.to_array()),
            None => color,
        };
        let c_s = match self.tint {
            Tint::Light => product(specular, own),
            Tint::Object => color,
            Tint::Metallic => {
                let share = n_dot_l.map(|cos| 1.0 - fresnel::pov_ray(cos.max(0.0)));
                let metal = [
                    share * (color[0] - 1.0) + 1.0,
                    share * (color[1] - 1.0) + 1.0,
                    share * (color[2] - 1.0) + 1.0,
                ];
                product(product(specular, own), metal)
            }
        };
        [product(diffuse, color), c_s]
    }

    /// What one light adds to the diffuse and specular terms where nothing stands between.
    #[inline]
    pub fn shade_light(
        &self,
        n: Dir3,
        tangent: Dir3,
        e: Dir3,
        color: Rgb,
        light: &LightSample,
    ) -> Terms {
        self.reflectance.shade_light(n, tangent, self.eye(e), self.incident(n, color, light))
    }
}

/// The product of two colours.
#[inline(always)]
fn product<F: Lanes>(a: [F; 3], b: [F; 3]) -> [F; 3] {
    [a[0] * b[0], a[1] * b[1], a[2] * b[2]]
}

fn reflectance(material: &ConstantMaterial) -> Reflectance {
    let &ConstantMaterial { k_d, k_s, shininess, times_cosine, normalize, .. } = material;
    let switches = Switches { times_cosine, normalize };
    match material.model {
        Model::Lambert => Reflectance::Lambert(Lambert { k_d }),
        Model::Phong => Reflectance::Phong(Phong::new(k_d, k_s, shininess, switches)),
        Model::BlinnPhong => {
            Reflectance::BlinnPhong(BlinnPhong::new(k_d, k_s, shininess, switches))
        }
        Model::BlinnFast => Reflectance::BlinnPhong(
            BlinnPhong::new(k_d, k_s, shininess, switches).with_falloff(Falloff::Rational),
        ),
        Model::Microfacet { distribution, roughness, shadowing, fresnel } => {
            Reflectance::Microfacet(Microfacet {
                k_d,
                k_s,
                distribution: match distribution {
                    scene::Distribution::Blinn => Distribution::Blinn { n: roughness },
                    scene::Distribution::Beckmann => Distribution::Beckmann { m: roughness },
                    scene::Distribution::Ggx => Distribution::Ggx { alpha: roughness },
                },
                shadowing,
                fresnel,
            })
        }
        Model::OrenNayar { sigma, full } => Reflectance::OrenNayar(OrenNayar {
            k_d,
            sigma,
            form: if full {
                OrenNayarForm::Full { interreflection: true }
            } else {
                OrenNayarForm::Qualitative
            },
        }),
        Model::Ward { roughness_x, roughness_y, form } => {
            Reflectance::Ward(Ward { k_d, k_s, a_x: roughness_x, a_y: roughness_y, form })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_that_meets_two_facets_is_tinted_by_the_colour_of_the_vertex() {
        let model = Model::OrenNayar { sigma: 0.3, full: true };
        let drawn = |material: Rgb, vertex: Rgb| {
            let written =
                ConstantMaterial { model, color: material, ..ConstantMaterial::default() };
            let light = LightSample {
                l: Dir3::Z,
                distance: 1.0,
                color: Rgb::WHITE,
                specular_color: Rgb::WHITE,
            };
            let material = Material::new(&written, Dir3::Z);
            material.shade_light(Dir3::Z, Dir3::X, Dir3::Z, vertex, &light).diffuse
        };
        let (red, white) = (Rgb::new(0.9, 0.1, 0.1), Rgb::WHITE);
        assert_eq!(drawn(white, red), drawn(red, red));
        assert_ne!(drawn(white, red), drawn(white, white));
    }
}
