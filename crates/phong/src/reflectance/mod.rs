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
mod ward;

pub use blinn_phong::{BlinnPhong, Falloff};
pub use fresnel::Fresnel;
pub use lambert::Lambert;
pub use microfacet::{Distribution, Microfacet};
pub use oren_nayar::{OrenNayar, OrenNayarForm};
pub use phong::Phong;
pub use scale::Switches;
pub use ward::Ward;

pub use phong_scene::{Shadowing, WardForm};

use phong_scene::Rgb;

use crate::math::{Dir3, Lobe};
use crate::terms::Terms;

/// Cosines up to this are 0 but for rounding; what is divided by them would be noise, or ∞.
const HORIZON: f32 = 1e-9;

/// The least cosine between normal and eye that is divided by: an eye below the horizon of a shading normal,
/// as at the silhouette of a smooth mesh, counts as this far above it.
const GRAZING: f32 = 1e-4;

/// Roughnesses below this count as this: a narrower lobe is a mirror, which f32 cannot hold and
/// which no light but the mirror ray would ever meet.
pub const NARROWEST: f32 = 1e-4;

/// Light that arrives at a point from one light, already tinted by the material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Incident {
    /// To the light.
    pub l: Dir3,
    /// `C_{m,d}`: the light's colour, attenuated, times the material's diffuse colour. No cosine.
    pub c_d: Rgb,
    /// `C_{m,s}`: the light's specular colour, attenuated, times the material's specular colour.
    pub c_s: Rgb,
    /// The material's diffuse colour alone: what tints light once more that meets two facets.
    pub color: Rgb,
}

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
    /// Whether it has a grain: whether the tangent matters.
    #[inline]
    pub const fn is_brushed(&self) -> bool {
        matches!(self, Self::Ward(_))
    }

    /// What stands before `C_{m,d}` and `C_{m,s}` for one light or eight, above the horizon; `None` for the
    /// models that are worked out one light at a time.
    #[inline(always)]
    pub(crate) fn weights<F: Lobe>(&self, n: [F; 3], e: [F; 3], l: [F; 3]) -> Option<[F; 2]> {
        match self {
            Self::Lambert(model) => {
                let diffuse = model.weight(n, l);
                Some([diffuse, diffuse.splat(0.0)])
            }
            Self::Phong(model) => Some(model.weights(n, e, l)),
            Self::BlinnPhong(model) => Some(model.weights(n, e, l)),
            Self::Microfacet(_) | Self::OrenNayar(_) | Self::Ward(_) => None,
        }
    }

    /// What one light adds to the diffuse and the specular term; the other terms are 0.
    ///
    /// `n` is the shading normal and `e` the direction to the eye, which at a silhouette may lie below the
    /// horizon of `n`: models that divide by N·E take max(N·E, 1e-4). `tangent` gives
    /// brushed models their grain, need not be perpendicular to `n`, and is ignored by the rest.
    /// Included: cosine, weights, colours. Not included: visibility, and ambient light.
    ///
    /// **A light with L·N ≤ 0 adds nothing**, whatever the model.
    #[inline]
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
    use crate::math::lanes::{Lanes3, load3};

    /// The direction of `(x, y, z)`.
    pub(super) fn dir(x: f32, y: f32, z: f32) -> Dir3 {
        Dir3::new(Vec3::new(x, y, z)).unwrap()
    }

    /// White light from `l`.
    pub(super) fn white(l: Dir3) -> Incident {
        Incident { l, c_d: Rgb::WHITE, c_s: Rgb::WHITE, color: Rgb::WHITE }
    }

    /// One of each.
    fn models() -> [Reflectance; 6] {
        let lecture = Switches::default();
        [
            Reflectance::Lambert(Lambert { k_d: 0.5 }),
            Reflectance::Phong(Phong::new(0.5, 0.25, 0.0, lecture)),
            Reflectance::BlinnPhong(BlinnPhong::new(0.5, 0.25, 0.0, lecture)),
            Reflectance::Microfacet(Microfacet {
                k_d: 0.5,
                k_s: 0.25,
                distribution: Distribution::Ggx { alpha: 0.3 },
                shadowing: Shadowing::Correlated,
                fresnel: Fresnel::None,
            }),
            Reflectance::OrenNayar(OrenNayar {
                k_d: 0.5,
                sigma: 0.0,
                form: OrenNayarForm::Qualitative,
            }),
            Reflectance::Ward(Ward {
                k_d: 0.5,
                k_s: 0.25,
                a_x: 0.3,
                a_y: 0.1,
                form: WardForm::Gmd,
            }),
        ]
    }

    #[test]
    fn eight_lights_have_the_bits_of_one() {
        let simd = fearless_simd::Fallback::new();
        let mut shaded = 0;
        for switches in [(false, false), (true, false), (false, true), (true, true)]
            .map(|(times_cosine, normalize)| Switches { times_cosine, normalize })
        {
            for model in [
                Reflectance::Lambert(Lambert { k_d: 0.7 }),
                Reflectance::Phong(Phong::new(0.6, 0.3, 17.0, switches)),
                Reflectance::BlinnPhong(BlinnPhong::new(0.6, 0.3, 17.0, switches)),
                Reflectance::BlinnPhong(
                    BlinnPhong::new(0.6, 0.3, 17.0, switches).with_falloff(Falloff::Rational),
                ),
            ] {
                let x = |i: u32, k: u32| ((i * 37 + k * 61) % 83) as f32 / 41.5 - 1.0;
                let e = dir(0.3, -0.2, 0.7);
                let l: [Dir3; 8] = std::array::from_fn(|i| {
                    dir(x(i as u32, 1), x(i as u32, 2), 0.9 + x(i as u32, 3))
                });
                let n: [Dir3; 8] = std::array::from_fn(|i| dir(x(i as u32, 4), 0.1, 1.5));
                let lanes = |of: &dyn Fn(usize) -> Dir3| -> Lanes3 {
                    std::array::from_fn(|k| std::array::from_fn(|i| of(i).to_array()[k]))
                };
                let [n8, e8, l8] = [lanes(&|i| n[i]), lanes(&|_| e), lanes(&|i| l[i])]
                    .map(|lanes| load3(simd, &lanes));
                let [diffuse, specular] = model.weights(n8, e8, l8).unwrap();
                for i in (0..8).filter(|&i| l[i].dot(n[i]) > 0.0) {
                    let terms = model.shade_light(n[i], Dir3::X, e, white(l[i]));
                    assert_eq!([diffuse[i], specular[i]], [terms.diffuse.r, terms.specular.r]);
                    shaded += 1;
                }
            }
        }
        assert!(shaded > 60, "{shaded}");
    }

    #[test]
    fn a_light_at_or_below_the_horizon_adds_nothing() {
        for model in models() {
            for l in [Dir3::X, dir(1.0, 0.0, -0.01), -Dir3::Z] {
                let terms = model.shade_light(Dir3::Z, Dir3::X, dir(-1.0, 0.0, 0.1), white(l));
                assert_eq!(terms, Terms::default(), "{model:?}");
            }
        }
    }

    #[test]
    fn every_model_stands_on_the_same_lambert() {
        let l = dir(0.6, 0.0, 0.8);
        for model in models() {
            let terms = model.shade_light(Dir3::Z, Dir3::X, dir(0.0, 0.6, 0.8), white(l));
            assert_eq!(terms.diffuse, Rgb::grey(0.5 * l.dot(Dir3::Z)), "{model:?}");
        }
    }

    #[test]
    fn the_colours_of_light_tint_the_term_they_belong_to() {
        let (c_d, c_s) = (Rgb::new(1.0, 0.5, 0.0), Rgb::new(0.0, 0.25, 2.0));
        let (n, e) = (Dir3::Z, dir(-0.5, 0.1, 0.8));
        for model in models() {
            let l = dir(0.6, 0.0, 0.8);
            let plain = model.shade_light(n, Dir3::X, e, white(l));
            let tinted =
                model.shade_light(n, Dir3::X, e, Incident { l, c_d, c_s, color: Rgb::WHITE });
            assert_eq!(tinted.diffuse, plain.diffuse.r * c_d, "{model:?}");
            assert_eq!(tinted.specular, plain.specular.r * c_s, "{model:?}");
        }
    }

    #[test]
    fn nothing_becomes_nan_or_infinite_however_grazing_or_narrow() {
        let tiny = [0.0, 1e-38, 1e-23, 1e-20, 1e-9, 0.5, 1.0];
        let directions: Vec<Dir3> = tiny
            .into_iter()
            .flat_map(|z| [dir(1.0, 0.0, z), dir(-1.0, 0.0, z), dir(0.0, 1.0, z)])
            .collect();
        for width in [f32::MIN_POSITIVE, 1e-4, 1.0, 1e10] {
            for distribution in [
                Distribution::Blinn { n: 1.0 / width },
                Distribution::Beckmann { m: width },
                Distribution::Ggx { alpha: width },
            ] {
                for shadowing in [
                    Shadowing::Separable,
                    Shadowing::Correlated,
                    Shadowing::VCavity,
                    Shadowing::Implicit,
                ] {
                    let fresnel = Fresnel::Dielectric { eta: 1.5 };
                    let facets =
                        Microfacet { k_d: 1.0, k_s: 1.0, distribution, shadowing, fresnel };
                    assert_finite(Reflectance::Microfacet(facets), &directions);
                }
            }
            for form in [WardForm::Ward, WardForm::Gmd] {
                let ward = Ward { k_d: 1.0, k_s: 1.0, a_x: width, a_y: 0.2, form };
                assert_finite(Reflectance::Ward(ward), &directions);
            }
        }
        for form in [OrenNayarForm::Qualitative, OrenNayarForm::Full { interreflection: true }] {
            let rough = OrenNayar { k_d: 1.0, sigma: 0.5, form };
            assert_finite(Reflectance::OrenNayar(rough), &directions);
        }
    }

    fn assert_finite(model: Reflectance, directions: &[Dir3]) {
        for &l in directions {
            for &e in directions {
                let terms = model.shade_light(Dir3::Z, Dir3::X, e, white(l));
                let total = terms.total().r;
                assert!(total.is_finite() && total >= 0.0, "{model:?}: {terms:?} at {l:?}, {e:?}");
            }
        }
    }
}
