//! How a surface answers one light: the lecture's terms, one model a file.
//!
//! The letters are the lecture's: `n` normal, `l` to the light, `r` its mirror image, `e` to the
//! eye, `h` halfway; all unit, all away from the surface.
//!
//! A light's colour is what a white Lambert surface facing it gives back, so Lambert is
//! `k_d (L·N) C_d` without a π, and a model known as a BRDF f adds `π f (N·L)`.

pub mod blinn_phong;
pub mod fresnel;
mod lambert;
pub mod microfacet;
mod oren_nayar;
pub mod phong;
mod scale;
mod terms;
mod ward;

pub use blinn_phong::BlinnPhong;
pub use fresnel::Fresnel;
pub use lambert::Lambert;
pub use microfacet::{Distribution, Microfacet, Shadowing};
pub use oren_nayar::{OrenNayar, OrenNayarForm};
pub use phong::Phong;
pub use scale::Switches;
pub use terms::{Incident, Terms};
pub use ward::{Ward, WardForm};

use crate::math::Dir3;

/// Roughnesses below this count as this: a narrower lobe is a mirror, which f32 cannot hold and
/// which no light but the mirror ray would ever meet.
pub const NARROWEST: f32 = 1e-4;

/// How a surface answers light: one of the models, with its numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reflectance {
    /// Diffuse only.
    Lambert(Lambert),
    /// `(R·E)^α`, over Lambert.
    Phong(Phong),
    /// `(N·H)^α`, over Lambert.
    BlinnPhong(BlinnPhong),
    /// Tiny mirrors, over Lambert.
    Microfacet(Microfacet),
    /// Rough and diffuse.
    OrenNayar(OrenNayar),
    /// Brushed, over Lambert.
    Ward(Ward),
}

impl Reflectance {
    /// What one light adds to the diffuse and the specular term; the other terms are 0.
    ///
    /// `n` is the shading normal, on the side of `e`, the direction to the eye; `tangent` gives
    /// brushed models their grain, need not be perpendicular to `n`, and is ignored by the rest.
    /// Included: cosine, weights, colours. Not included: visibility, and ambient light.
    ///
    /// **A light with L·N ≤ 0 adds nothing**, whatever the model.
    pub fn shade_light(&self, n: Dir3, tangent: Dir3, e: Dir3, incident: Incident) -> Terms {
        if incident.l.dot(n) <= 0.0 {
            return Terms::default();
        }
        match self {
            Self::Lambert(model) => model.shade_light(n, incident),
            Self::Phong(model) => model.shade_light(n, e, incident),
            Self::BlinnPhong(model) => model.shade_light(n, e, incident),
            Self::Microfacet(model) => model.shade_light(n, e, incident),
            Self::OrenNayar(model) => model.shade_light(n, e, incident),
            Self::Ward(model) => model.shade_light(n, tangent, e, incident),
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use phong_scene::Rgb;

    use super::*;

    fn dir(x: f32, y: f32, z: f32) -> Dir3 {
        Dir3::new(Vec3::new(x, y, z)).unwrap()
    }

    #[test]
    fn a_light_at_or_below_the_horizon_adds_nothing() {
        let models = [
            Reflectance::Lambert(Lambert { k_d: 1.0 }),
            Reflectance::Phong(Phong::new(1.0, 1.0, 0.0, Switches::default())),
            Reflectance::BlinnPhong(BlinnPhong::new(1.0, 1.0, 0.0, Switches::default())),
        ];
        for model in models {
            for l in [Dir3::X, dir(1.0, 0.0, -0.01), -Dir3::Z] {
                let incident = Incident { l, c_d: Rgb::WHITE, c_s: Rgb::WHITE };
                let terms = model.shade_light(Dir3::Z, Dir3::X, dir(-1.0, 0.0, 0.1), incident);
                assert_eq!(terms, Terms::default());
            }
        }
    }
}
