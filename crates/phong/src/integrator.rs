//! The road of a ray: intersect → interaction → material → lights and shadows → [`Terms`]; mirror
//! and glass rays go the same road, to a depth.
//!
//! Rays travel in bundles, a tile's worth at a time, so that the hierarchy can use what they have
//! in common. A bundle of one ray takes this very road too, which is how `explain` is told.

use glam::Vec3;
use phong_bvh::{Hit, Ray};
use phong_scene::{Background, Rgb};

use crate::compile::CompiledScene;
use crate::interaction::SurfaceInteraction;
use crate::light::LightSample;
use crate::material::Material;
use crate::math::{Dir3, reflect};
use crate::reflectance::{Terms, fresnel};
use crate::sampling::{Sampler, Use};
use crate::witness::{Branch, LightTold, Witness};

/// Traces rays through a scene.
#[derive(Clone, Copy, Debug)]
pub struct Integrator<'a> {
    /// What rays meet.
    pub scene: &'a CompiledScene,
    /// What rays see that meet nothing.
    pub background: Background,
    /// Mirror and glass bounces; beyond it a ray brings black.
    pub depth: u32,
    /// Whether things stand in the way of lights at all.
    pub shadows: bool,
}

/// A ray from the camera.
#[derive(Clone, Copy, Debug)]
pub struct CameraRay {
    /// The ray.
    pub ray: Ray,
    /// Where its samples come from.
    pub sampler: Sampler,
    /// Where it crosses the picture's height: 0 the upper edge, 1 the lower.
    pub height: f32,
}

/// What a ray brought home.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Radiance {
    /// The terms, linear and unclamped.
    pub terms: Terms,
    /// Whether the ray met a surface.
    pub met: bool,
}

/// How many rays were traced.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RayCounts {
    /// From the camera.
    pub primary: u64,
    /// Towards lights.
    pub shadow: u64,
    /// Mirror and glass.
    pub secondary: u64,
}

impl RayCounts {
    /// All rays.
    pub fn total(&self) -> u64 {
        self.primary + self.shadow + self.secondary
    }

    /// Adds the counts of another.
    pub fn add(&mut self, other: &Self) {
        self.primary += other.primary;
        self.shadow += other.shadow;
        self.secondary += other.secondary;
    }
}

/// A ray that goes on from a surface.
struct Onward {
    /// The bundle's ray it came from.
    parent: usize,
    weight: Rgb,
    fresnel: Option<f32>,
    ray: Ray,
    sampler: Sampler,
}

impl Integrator<'_> {
    /// Traces rays from the camera, and all that follow from them; what each brings, in order.
    pub fn trace<W: Witness>(
        &self,
        bundle: &[CameraRay],
        counts: &mut RayCounts,
        witness: &mut W,
    ) -> Vec<Radiance> {
        counts.primary += bundle.len() as u64;
        let rays: Vec<Ray> = bundle.iter().map(|camera| camera.ray).collect();
        let samplers: Vec<Sampler> = bundle.iter().map(|camera| camera.sampler).collect();
        let height = |i: usize| bundle[i].height;
        self.follow(&rays, &samplers, &height, self.depth, counts, witness)
    }

    /// The road itself. `height` tells where in the background's height a ray ends that meets
    /// nothing; `bounces` are left.
    fn follow<W: Witness>(
        &self,
        rays: &[Ray],
        samplers: &[Sampler],
        height: &dyn Fn(usize) -> f32,
        bounces: u32,
        counts: &mut RayCounts,
        witness: &mut W,
    ) -> Vec<Radiance> {
        let mut out = vec![Radiance::default(); rays.len()];
        let mut hits = vec![Hit::NONE; rays.len()];
        self.scene.bvh().intersect_bundle(rays, &mut hits);

        let mut met = Vec::with_capacity(rays.len());
        for (i, (ray, hit)) in rays.iter().zip(&hits).enumerate() {
            if hit.is_some() {
                let at = self.scene.interaction(ray, hit);
                let ambient = self.material(&at).ambient(at.color, self.scene.ambient());
                out[i] = Radiance { met: true, terms: Terms { ambient, ..Terms::default() } };
                witness.met(ray, &at, ambient);
                met.push((i, at));
            } else {
                let background = seen(self.background, height(i));
                out[i].terms.background = background;
                witness.missed(ray, background);
            }
        }
        for light in 0..self.scene.lights().len() {
            self.light(light, &met, samplers, &mut out, counts, witness);
        }
        for branch in [Branch::Reflection, Branch::Transmission] {
            self.branch(branch, &met, samplers, bounces, &mut out, counts, witness);
        }
        out
    }

    fn material(&self, at: &SurfaceInteraction) -> &Material {
        &self.scene.materials()[at.material as usize]
    }

    /// Adds what one light gives to every surface met.
    fn light<W: Witness>(
        &self,
        number: usize,
        met: &[(usize, SurfaceInteraction)],
        samplers: &[Sampler],
        out: &mut [Radiance],
        counts: &mut RayCounts,
        witness: &mut W,
    ) {
        let light = &self.scene.lights()[number];
        let casts = self.shadows && light.shadows;
        let mut lit: Vec<(usize, LightSample)> = Vec::with_capacity(met.len());
        let mut shadow_rays = Vec::with_capacity(if casts { met.len() } else { 0 });
        for (k, (i, at)) in met.iter().enumerate() {
            let place =
                if light.soft { samplers[*i].pair(Use::Light(number as u32)) } else { [0.5; 2] };
            let sample = light.sample(at.p, place);
            let above = sample.is_some_and(|s| is_above(at, s.l));
            if let Some(sample) = sample {
                let material = self.material(at);
                out[*i].terms.ambient +=
                    material.ambient_of_light(at.color, self.scene.ambient(), &sample);
                // Nothing comes from a spot beyond its edge: nobody need look.
                if above && !(sample.color.is_black() && sample.specular_color.is_black()) {
                    lit.push((k, sample));
                    if casts {
                        shadow_rays.push(at.spawn(sample.l, sample.distance));
                    }
                    continue;
                }
            }
            witness.lit(&LightTold {
                light: number,
                sample,
                incident: sample.map(|s| self.material(at).incident(at.n, at.color, &s)),
                above,
                shadow: None,
                visible: false,
                terms: Terms::default(),
            });
        }
        let mut blocked = vec![false; shadow_rays.len()];
        self.scene.bvh().occluded_bundle(&shadow_rays, &mut blocked);
        counts.shadow += shadow_rays.len() as u64;
        for (j, (k, sample)) in lit.into_iter().enumerate() {
            let (i, at) = &met[k];
            let visible = !(casts && blocked[j]);
            let material = self.material(at);
            let terms = if visible {
                material.shade_light(at.n, at.tangent, at.e, at.color, &sample)
            } else {
                Terms::default()
            };
            out[*i].terms.diffuse += terms.diffuse;
            out[*i].terms.specular += terms.specular;
            witness.lit(&LightTold {
                light: number,
                sample: Some(sample),
                incident: Some(material.incident(at.n, at.color, &sample)),
                above: true,
                shadow: shadow_rays.get(j).copied(),
                visible,
                terms,
            });
        }
    }

    /// Adds what the mirror rays, or the refracted ones, bring to the surfaces met.
    #[expect(clippy::too_many_arguments, reason = "the state of the road, handed on as it is")]
    fn branch<W: Witness>(
        &self,
        branch: Branch,
        met: &[(usize, SurfaceInteraction)],
        samplers: &[Sampler],
        bounces: u32,
        out: &mut [Radiance],
        counts: &mut RayCounts,
        witness: &mut W,
    ) {
        let mut onward = Vec::new();
        for (i, at) in met {
            let material = self.material(at);
            if material.reflection.is_black() && material.transmission.is_black() {
                continue;
            }
            let (dir, weight, fresnel) = match branch {
                Branch::Reflection => mirrored(material, at),
                Branch::Transmission => match refracted(material, at) {
                    Some(refracted) => refracted,
                    None => continue,
                },
            };
            if weight.is_black() {
                continue;
            }
            if bounces == 0 {
                witness.cut(branch, weight, fresnel);
                continue;
            }
            onward.push(Onward {
                parent: *i,
                weight,
                fresnel,
                ray: at.spawn(dir, f32::INFINITY),
                sampler: samplers[*i].branch(branch as u32),
            });
        }
        if onward.is_empty() {
            return;
        }
        for Onward { weight, fresnel, ray, .. } in &onward {
            witness.entered(branch, *weight, *fresnel, ray);
        }
        counts.secondary += onward.len() as u64;
        let rays: Vec<Ray> = onward.iter().map(|o| o.ray).collect();
        let samplers: Vec<Sampler> = onward.iter().map(|o| o.sampler).collect();
        let up = self.scene.camera().up();
        let height = |i: usize| 0.5 - 0.5 * rays[i].dir.dot(up);
        let brought = self.follow(&rays, &samplers, &height, bounces - 1, counts, witness);
        for (Onward { parent, weight, .. }, Radiance { terms, .. }) in onward.iter().zip(&brought) {
            let light = terms.total();
            witness.left(branch, light);
            let terms = &mut out[*parent].terms;
            match branch {
                Branch::Reflection => terms.reflection = *weight * light,
                Branch::Transmission => terms.transmission = *weight * light,
            }
        }
    }
}

/// A light counts only above the horizon: that of the surface as it is, and that of N.
fn is_above(at: &SurfaceInteraction, l: Dir3) -> bool {
    l.dot(at.n) > 0.0 && l.dot(at.facing_ng()) > 0.0
}

/// The background at a height: 0 its top, 1 its bottom. Transparent is black.
fn seen(background: Background, height: f32) -> Rgb {
    match background {
        Background::Color(color) => color,
        Background::Gradient { top, bottom } => (1.0 - height) * top + height * bottom,
        Background::Transparent => Rgb::BLACK,
    }
}

/// The index of refraction of the far side relative to the near one.
fn relative_ior(material: &Material, at: &SurfaceInteraction) -> f32 {
    if at.from_outside() { material.ior } else { 1.0 / material.ior }
}

/// The exact reflectance where the material wants it, and 1 where nothing is refracted.
fn dielectric(material: &Material, at: &SurfaceInteraction) -> f32 {
    fresnel::dielectric(at.n.cos(at.e), relative_ior(material, at))
}

/// Where the mirror ray goes, its weight, and F where it was asked for.
fn mirrored(material: &Material, at: &SurfaceInteraction) -> (Dir3, Rgb, Option<f32>) {
    let facing = at.facing_ng();
    let mirrored = reflect(-at.e, at.n);
    // A shading normal can send the mirror ray into the surface: the real normal does not.
    let dir = if mirrored.dot(facing) > 0.0 { mirrored } else { reflect(-at.e, facing) };
    if material.fresnel {
        let f = dielectric(material, at);
        return (dir, material.reflection * f, Some(f));
    }
    let total = !material.transmission.is_black() && refracted(material, at).is_none();
    let weight =
        if total { material.reflection + material.transmission } else { material.reflection };
    (dir, weight, None)
}

/// Where the refracted ray goes, its weight, and F where it was asked for; `None` under total
/// internal reflection.
fn refracted(material: &Material, at: &SurfaceInteraction) -> Option<(Dir3, Rgb, Option<f32>)> {
    let eta = relative_ior(material, at);
    let facing = at.facing_ng();
    let dir = refract(at.e, at.n, eta)?;
    let dir = if dir.dot(facing) < 0.0 { dir } else { refract(at.e, facing, eta)? };
    if material.fresnel {
        let f = dielectric(material, at);
        return Some((dir, material.transmission * (1.0 - f), Some(f)));
    }
    Some((dir, material.transmission, None))
}

/// Snell's law: `sin θ_i = η sin θ_t`, η the index of the far side relative to the near one, `e`
/// and `n` on the near side. `None` under total internal reflection.
fn refract(e: Dir3, n: Dir3, eta: f32) -> Option<Dir3> {
    let cos_i = n.dot(e);
    let sin2_t = (1.0 - cos_i * cos_i).max(0.0) / (eta * eta);
    if sin2_t >= 1.0 {
        return None;
    }
    let cos_t = (1.0 - sin2_t).sqrt();
    let (e, n): (Vec3, Vec3) = (e.to_vec(), n.to_vec());
    Dir3::new((cos_i / eta - cos_t) * n - e / eta)
}
