//! Oren and Nayar's rough diffuse surfaces: matt facets that shade and light each other.
//!
//! "Generalization of Lambert's Reflectance Model", SIGGRAPH 1994.

use std::f32::consts::FRAC_1_PI;

use phong_scene::Rgb;

use super::{GRAZING, HORIZON, Incident};
use crate::math::{Dir3, acos};
use crate::terms::Terms;

/// `π f (N·L) C`, with `f = ρ/π (direct + ρ interreflected)` and ρ = `k_d` × colour.
///
/// σ = 0 is Lambert. There is no specular term.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrenNayar {
    /// `k_d`, in [0, 1].
    pub k_d: f32,
    /// Standard deviation of the facets' slope angle, radians, ≥ 0.
    pub sigma: f32,
    /// Which of the paper's forms.
    pub form: OrenNayarForm,
}

/// The paper's forms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OrenNayarForm {
    /// The "qualitative" one that everybody uses.
    Qualitative,
    /// The full fit, with or without light that meets two facets.
    Full {
        /// Whether light that meets two facets counts.
        interreflection: bool,
    },
}

/// The BRDF without its ρ: `f = ρ/π (direct + ρ interreflected)`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RoughDiffuse {
    /// Light that met one facet; 1 for Lambert.
    pub direct: f32,
    /// Light that met two.
    pub interreflected: f32,
}

impl OrenNayar {
    /// What one light above the horizon adds: `π f (N·L) C`, all of it diffuse.
    ///
    /// Light that met two facets is tinted twice, by the colour the surface has there.
    pub(super) fn shade_light(
        &self,
        n: Dir3,
        e: Dir3,
        Incident { l, c_d, color, .. }: Incident,
    ) -> Terms {
        let RoughDiffuse { direct, interreflected } = self.shape(n, l, e);
        let rho = self.k_d * color;
        // The full fit dips below 0 where very rough surfaces are lit and seen at grazing angles.
        let shape = (Rgb::grey(direct) + interreflected * rho).map(|shape| shape.max(0.0));
        Terms { diffuse: self.k_d * n.cos(l) * shape * c_d, ..Terms::default() }
    }

    /// The BRDF without its ρ, as published; 0 where L is not above the horizon. N·E counts as 1e-4 at
    /// least.
    pub fn shape(&self, n: Dir3, l: Dir3, e: Dir3) -> RoughDiffuse {
        let (n_dot_l, n_dot_e) = (n.dot(l), n.dot(e).max(GRAZING));
        if n_dot_l <= HORIZON {
            return RoughDiffuse::default();
        }
        let s2 = self.sigma * self.sigma;
        // In the surface's plane: sin θ_l sin θ_e cos(φ_l − φ_e).
        let flat_l = l.to_vec() - n_dot_l * n.to_vec();
        let flat_e = e.to_vec() - n_dot_e * n.to_vec();
        let flat_dot = flat_l.dot(flat_e);
        match self.form {
            // A + B max(0, cos Δφ) sin α tan β, where tan β = sin β / max(N·L, N·E)
            OrenNayarForm::Qualitative => {
                let a = 1.0 - 0.5 * s2 / (s2 + 0.33);
                let b = 0.45 * s2 / (s2 + 0.09);
                let direct = a + b * flat_dot.max(0.0) / n_dot_l.max(n_dot_e);
                RoughDiffuse { direct, interreflected: 0.0 }
            }
            OrenNayarForm::Full { interreflection } => {
                let (sin_l, sin_e) = (flat_l.length(), flat_e.length());
                let cos_dphi = if sin_l * sin_e > 0.0 {
                    (flat_dot / (sin_l * sin_e)).clamp(-1.0, 1.0)
                } else {
                    0.0 // face on there is no azimuth, and nothing depends on it
                };
                let alpha = Angle { sin: sin_l.max(sin_e), cos: n_dot_l.min(n_dot_e) };
                let beta = Angle { sin: sin_l.min(sin_e), cos: n_dot_l.max(n_dot_e) };
                let full = full(s2, alpha, beta, cos_dphi);
                let interreflected = if interreflection { full.interreflected } else { 0.0 };
                RoughDiffuse { interreflected, ..full }
            }
        }
    }
}

/// An angle to the normal, both of whose functions are known better than itself.
#[derive(Clone, Copy)]
struct Angle {
    sin: f32,
    cos: f32,
}

/// The paper's equations 30–33, of σ², the larger angle α and the smaller β to the normal.
///
/// `L₁ = ρ/π (C₁ + cos Δφ C₂ tan β + (1 − |cos Δφ|) C₃ tan((α+β)/2))`,
/// `L₂ = 0.17 ρ²/π σ²/(σ²+0.13) (1 − cos Δφ (2β/π)²)`.
fn full(s2: f32, alpha: Angle, beta: Angle, cos_dphi: f32) -> RoughDiffuse {
    let [share_a, share_b] = [alpha, beta].map(|angle| 2.0 * FRAC_1_PI * acos(angle.cos));
    let tan_beta = beta.sin / beta.cos;
    let tan_half_sum = (alpha.sin + beta.sin) / (alpha.cos + beta.cos);
    let bend = if cos_dphi >= 0.0 { 0.0 } else { share_b * share_b * share_b };
    let both = share_a * share_b; // 4αβ/π²
    let c1 = 1.0 - 0.5 * s2 / (s2 + 0.33);
    let c2 = 0.45 * s2 / (s2 + 0.09) * (alpha.sin - bend);
    let c3 = 0.125 * s2 / (s2 + 0.09) * (both * both);
    RoughDiffuse {
        direct: c1 + cos_dphi * c2 * tan_beta + (1.0 - cos_dphi.abs()) * c3 * tan_half_sum,
        interreflected: 0.17 * s2 / (s2 + 0.13) * (1.0 - cos_dphi * share_b * share_b),
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{dir, white};
    use super::*;

    fn rough(sigma: f32, form: OrenNayarForm) -> OrenNayar {
        OrenNayar { k_d: 1.0, sigma, form }
    }

    const FULL: OrenNayarForm = OrenNayarForm::Full { interreflection: true };

    #[test]
    fn without_roughness_it_is_lambert() {
        for form in [OrenNayarForm::Qualitative, FULL] {
            for (l, e) in [(Dir3::Z, Dir3::Z), (dir(1.0, 2.0, 1.0), dir(-1.0, 0.5, 0.3))] {
                let shape = rough(0.0, form).shape(Dir3::Z, l, e);
                assert_eq!(shape, RoughDiffuse { direct: 1.0, interreflected: 0.0 });
            }
        }
    }

    #[test]
    fn a_worked_example_seen_from_the_light() {
        // σ² = 0.09: A = 1 − 0.045/0.42 = 0.892857, B = 0.0405/0.18 = 0.225. L = E at 60°:
        // sin α tan β = (√3/2) √3 = 1.5, so A + 1.5 B = 1.230357.
        let tilted = dir(3.0_f32.sqrt(), 0.0, 1.0);
        let shape = rough(0.3, OrenNayarForm::Qualitative).shape(Dir3::Z, tilted, tilted);
        assert!((shape.direct - 1.230_357).abs() < 1e-6, "{shape:?}");
    }

    #[test]
    fn the_full_form_face_on() {
        // α = β = 0: C₁ = 1 − 0.045/0.42 = 0.892857; L₂ = 0.17 · 0.09/0.22 = 0.0695455.
        let shape = rough(0.3, FULL).shape(Dir3::Z, Dir3::Z, Dir3::Z);
        assert!((shape.direct - 0.892_857).abs() < 1e-6, "{shape:?}");
        assert!((shape.interreflected - 0.069_545_5).abs() < 1e-7, "{shape:?}");
    }

    #[test]
    fn the_full_form_across_the_plane() {
        // Both at 45°, at right angles in azimuth: cos Δφ = 0, C₃ = 0.0625 (4/16)² tan 45°.
        let (l, e) = (dir(1.0, 0.0, 1.0), dir(0.0, 1.0, 1.0));
        let shape = rough(0.3, FULL).shape(Dir3::Z, l, e);
        assert!((shape.direct - (0.892_857 + 0.003_906_25)).abs() < 1e-6, "{shape:?}");
    }

    #[test]
    fn light_that_meets_two_facets_is_tinted_twice() {
        let color = Rgb::new(1.0, 0.5, 0.0);
        let model = OrenNayar { k_d: 0.8, sigma: 0.3, form: FULL };
        let incident = Incident { c_d: color, color, ..white(Dir3::Z) };
        let diffuse = model.shade_light(Dir3::Z, Dir3::Z, incident).diffuse;
        let twice = |c: f32| 0.8 * c * (0.892_857 + 0.069_545_5 * 0.8 * c);
        for (found, c) in diffuse.to_array().into_iter().zip([1.0, 0.5, 0.0]) {
            assert!((found - twice(c)).abs() < 1e-6, "{diffuse:?}");
        }
    }
}
