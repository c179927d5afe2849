//! What one light sends to one point.

use glam::{DVec3, Vec3};
use phong_scene::{LightKind, Rgb};

use crate::camera::disc;
use crate::math::{Dir3, wide};

/// A light in the compiled scene's space.
#[derive(Clone, Debug)]
pub struct Light {
    kind: Kind,
    color: Rgb,
    specular_color: Rgb,
    /// Whether things in between take its light away.
    pub shadows: bool,
    /// Whether it has an extent, so that its samples differ.
    pub soft: bool,
}

#[derive(Clone, Debug)]
enum Kind {
    Distant { to_light: Dir3, half_angle_tan: f32 },
    Point { position: Vec3, attenuation: [f32; 3], radius: f32, cone: Option<Cone> },
}

#[derive(Clone, Debug)]
struct Cone {
    /// The way the light travels along the axis.
    axis: Dir3,
    /// Cosine of the half-angle of full light.
    full: f32,
    /// Cosine of the half-angle where it ends.
    none: f32,
}

/// What one light sends to one point, before the surface answers and whatever stands between.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSample {
    /// To the light.
    pub l: Dir3,
    /// Distance to the light in scene units; infinite for a distant one.
    pub distance: f32,
    /// Its colour there, attenuated: what `C_{m,d}` is before the material. Linear.
    pub color: Rgb,
    /// Its specular colour there, attenuated. Linear.
    pub specular_color: Rgb,
}

impl Light {
    /// A light moved by `−center`.
    pub fn new(light: &phong_scene::Light, center: DVec3) -> Self {
        let (kind, size) = match light.kind {
            LightKind::Distant { direction, angle } => {
                let to_light = Dir3::from_unit((-direction).normalize_or(DVec3::Y).as_vec3());
                let half_angle_tan = wide::tan((angle / 2.0).to_radians()) as f32;
                (Kind::Distant { to_light, half_angle_tan }, angle)
            }
            LightKind::Point { position, attenuation, radius } => {
                (point(position - center, attenuation, radius, None), radius)
            }
            LightKind::Spot { position, target, cone, edge, attenuation, radius } => {
                let axis = Dir3::from_unit((target - position).normalize_or(-DVec3::Y).as_vec3());
                let [full, none] = [cone, edge].map(|a| wide::cos(a.to_radians()) as f32);
                let cone = Cone { axis, full, none };
                (point(position - center, attenuation, radius, Some(cone)), radius)
            }
        };
        Self {
            kind,
            color: light.color,
            specular_color: light.specular_color,
            shadows: light.shadows,
            soft: size > 0.0,
        }
    }

    /// What it sends to `p`. `place` in [0, 1)² picks a point of a soft light, (½, ½) its centre.
    /// `None` if `p` is where the light is.
    pub fn sample(&self, p: Vec3, place: [f32; 2]) -> Option<LightSample> {
        match &self.kind {
            &Kind::Distant { to_light, half_angle_tan } => {
                let l = if half_angle_tan > 0.0 {
                    Dir3::new(to_light.to_vec() + half_angle_tan * across(to_light, place))?
                } else {
                    to_light
                };
                Some(LightSample {
                    l,
                    distance: f32::INFINITY,
                    color: self.color,
                    specular_color: self.specular_color,
                })
            }
            Kind::Point { position, attenuation: [c, k, q], radius, cone } => {
                let mut toward = position - p;
                if *radius > 0.0 {
                    toward += *radius * across(Dir3::new(toward)?, place);
                }
                let l = Dir3::new(toward)?;
                let distance = toward.dot(l.to_vec());
                let mut factor = 1.0 / (c + k * distance + q * distance * distance);
                if let Some(cone) = cone {
                    factor *= cone.share(l);
                }
                Some(LightSample {
                    l,
                    distance,
                    color: self.color * factor,
                    specular_color: self.specular_color * factor,
                })
            }
        }
    }
}

impl Cone {
    /// 1 within the cone, 0 beyond the edge, between them smoothstep in the cosine.
    fn share(&self, l: Dir3) -> f32 {
        let cos = -self.axis.dot(l);
        if cos >= self.full {
            1.0
        } else if cos <= self.none {
            0.0
        } else {
            let t = (cos - self.none) / (self.full - self.none);
            t * t * (3.0 - 2.0 * t)
        }
    }
}

fn point(position: DVec3, attenuation: [f64; 3], radius: f64, cone: Option<Cone>) -> Kind {
    Kind::Point {
        position: position.as_vec3(),
        attenuation: attenuation.map(|a| a as f32),
        radius: radius as f32,
        cone,
    }
}

/// A point of the unit disc perpendicular to `axis`: a luminous sphere seen from `axis` is a disc.
fn across(axis: Dir3, place: [f32; 2]) -> Vec3 {
    let [x, y] = disc(place).map(|v| v as f32);
    let (a, b) = axis.to_vec().any_orthonormal_pair();
    x * a + y * b
}

#[cfg(test)]
mod tests {
    use super::*;
    use phong_scene::Place;

    const MIDDLE: [f32; 2] = [0.5, 0.5];

    fn light(kind: LightKind) -> Light {
        let light = phong_scene::Light {
            name: "light 1".to_owned(),
            kind,
            color: Rgb::grey(2.0),
            specular_color: Rgb::WHITE,
            shadows: true,
            place: Place::default(),
        };
        Light::new(&light, DVec3::ZERO)
    }

    #[test]
    fn a_distant_light_is_looked_for_against_the_way_it_travels() {
        let sun = light(LightKind::Distant { direction: DVec3::new(0.0, -3.0, 0.0), angle: 0.0 });
        let a = sun.sample(Vec3::ZERO, MIDDLE).unwrap();
        assert_eq!((a.l, a.distance, a.color), (Dir3::Y, f32::INFINITY, Rgb::grey(2.0)));
        assert_eq!(sun.sample(Vec3::splat(7.0), MIDDLE), Some(a), "the same everywhere");
    }

    #[test]
    fn a_point_light_is_divided_by_its_attenuation() {
        let position = DVec3::new(0.0, 3.0, 0.0);
        let lamp = light(LightKind::Point { position, attenuation: [1.0, 2.0, 3.0], radius: 0.0 });
        let sample = lamp.sample(Vec3::new(0.0, 1.0, 0.0), MIDDLE).unwrap();
        assert_eq!((sample.l, sample.distance), (Dir3::Y, 2.0));
        assert_eq!(sample.color, Rgb::grey(2.0) * (1.0 / 17.0));
        assert_eq!(lamp.sample(Vec3::new(0.0, 3.0, 0.0), MIDDLE), None, "at the light itself");
    }

    #[test]
    fn a_spot_fades_from_its_cone_to_its_edge() {
        let spot = light(LightKind::Spot {
            position: DVec3::Y,
            target: DVec3::ZERO,
            cone: 20.0,
            edge: 40.0,
            attenuation: [1.0, 0.0, 0.0],
            radius: 0.0,
        });
        let at = |degrees: f64| {
            let x = wide::tan(degrees.to_radians()) as f32;
            spot.sample(Vec3::new(x, 0.0, 0.0), MIDDLE).unwrap().specular_color.r
        };
        assert_eq!((at(0.0), at(19.9), at(40.1)), (1.0, 1.0, 0.0));
        // Half way between the cosines smoothstep is a half.
        let half = wide::acos(f64::midpoint(
            wide::cos(20.0_f64.to_radians()),
            wide::cos(40.0_f64.to_radians()),
        ));
        assert!((at(half.to_degrees()) - 0.5).abs() < 1e-5);
    }

    #[test]
    fn a_soft_light_is_sampled_over_its_disc() {
        let position = DVec3::new(0.0, 4.0, 0.0);
        let lamp = light(LightKind::Point { position, attenuation: [1.0, 0.0, 0.0], radius: 1.0 });
        assert_eq!(lamp.sample(Vec3::ZERO, MIDDLE).unwrap().l, Dir3::Y);
        let rim = lamp.sample(Vec3::ZERO, [0.0, 0.5]).unwrap();
        let sin = (1.0 - rim.l.dot(Dir3::Y) * rim.l.dot(Dir3::Y)).sqrt();
        assert!((sin - 1.0 / 17.0_f32.sqrt()).abs() < 1e-6, "a unit off at a distance of four");
    }
}
