//! Microfacets: a surface of tiny mirrors, of which those facing H are seen.

mod distribution;
mod shadowing;

use std::f32::consts::PI;

use phong_scene::{Rgb, Shadowing};

pub use distribution::{Distribution, Lean};
pub use shadowing::visible;

use super::fresnel::{Fresnel, mirrored};
use super::{GRAZING, HORIZON, Incident};
use crate::math::Dir3;
use crate::terms::Terms;

/// `k_d (L·N) C_d + k_s π f (N·L) C_s`, with `f = D G F / (4 (N·L)(N·E))`.
///
/// Torrance and Sparrow (1967), Cook and Torrance (1982, whose π for the 4 nobody kept), Walter
/// and others (2007). `C_s` tints what [`Fresnel`] colours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Microfacet {
    /// Diffuse weight of the Lambert base, ≥ 0.
    pub k_d: f32,
    /// Specular weight, ≥ 0.
    pub k_s: f32,
    /// D, how many facets face which way.
    pub distribution: Distribution,
    /// G, how many of them are hidden.
    pub shadowing: Shadowing,
    /// F, how much a facet mirrors.
    pub fresnel: Fresnel,
}

impl Microfacet {
    /// What one light above the horizon adds: `k_d (L·N) C_d` and `k_s π f (N·L) C_s`.
    pub(super) fn shade_light(
        &self,
        n: Dir3,
        e: Dir3,
        Incident { l, c_d, c_s, .. }: Incident,
    ) -> Terms {
        let n_dot_l = n.cos(l);
        Terms {
            diffuse: self.k_d * n_dot_l * c_d,
            specular: self.k_s * PI * n_dot_l * self.brdf(n, l, e) * c_s,
            ..Terms::default()
        }
    }

    /// `f = D G F / (4 (N·L)(N·E))`, per steradian, without weights and cosine; black where L is not
    /// above the horizon. N·E counts as 1e-4 at least.
    pub fn brdf(&self, n: Dir3, l: Dir3, e: Dir3) -> Rgb {
        let [lean_l, lean_e] = [l, e].map(|v| Lean::of(n, v));
        if lean_l.cos <= HORIZON {
            return Rgb::BLACK;
        }
        let lean_e = Lean { cos: lean_e.cos.max(GRAZING), ..lean_e };
        let Some(h) = l.halfway(e) else { return Rgb::BLACK };
        let (lean_h, e_dot_h) = (Lean::of(n, h), e.cos(h));
        let d = self.distribution.density(lean_h);
        let g = visible(self.shadowing, self.distribution, [lean_l, lean_e, lean_h], e_dot_h);
        let f = mirrored(self.fresnel, e_dot_h);
        d * g / (4.0 * lean_l.cos * lean_e.cos) * f
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{dir, white};
    use super::*;

    #[test]
    fn face_on_nothing_is_hidden_and_a_quarter_of_d_comes_back() {
        let model = Microfacet {
            k_d: 0.0,
            k_s: 0.5,
            distribution: Distribution::Ggx { alpha: 0.25 },
            shadowing: Shadowing::Separable,
            fresnel: Fresnel::Schlick { f0: Rgb::new(1.0, 0.5, 0.0) },
        };
        // D = 16/π, G = 1, F = F₀: f = 4/π F₀; π f k_s = 2 F₀.
        let specular = model.shade_light(Dir3::Z, Dir3::Z, white(Dir3::Z)).specular;
        for (found, expected) in specular.to_array().into_iter().zip([2.0, 1.0, 0.0]) {
            assert!((found - expected).abs() < 1e-6, "{specular:?}");
        }
    }

    #[test]
    fn the_implicit_form_of_blinns_facets_is_three_js_blinn_phong() {
        // π f (N·L) = F (n + 2)/8 (N·H)^n (N·L), with L·H in Schlick's F.
        let (n, f0) = (30.0_f32, 0.1_f32);
        let model = Microfacet {
            k_d: 0.0,
            k_s: 1.0,
            distribution: Distribution::Blinn { n },
            shadowing: Shadowing::Implicit,
            fresnel: Fresnel::Schlick { f0: Rgb::grey(f0) },
        };
        let (l, e) = (dir(0.6, 0.0, 0.8), dir(-0.5, 0.1, 0.8));
        let found = model.shade_light(Dir3::Z, e, white(l)).specular.r;
        let h = l.halfway(e).unwrap();
        let fresnel = crate::reflectance::fresnel::schlick(l.dot(h), f0);
        let expected = fresnel * 4.0 * crate::math::pow(h.dot(Dir3::Z), n) * l.dot(Dir3::Z);
        assert!((found - expected).abs() < 1e-6, "{found} for {expected}");
    }

    #[test]
    fn an_eye_below_the_horizon_sees_what_a_grazing_one_sees_and_a_light_there_gives_nothing() {
        let model = Microfacet {
            k_d: 0.0,
            k_s: 1.0,
            distribution: Distribution::Beckmann { m: 0.5 },
            shadowing: Shadowing::VCavity,
            fresnel: Fresnel::None,
        };
        let below = model.brdf(Dir3::Z, Dir3::Z, dir(1.0, 0.0, -0.1));
        let grazing = model.brdf(Dir3::Z, Dir3::Z, dir(1.0, 0.0, 1e-4));
        assert!(below.r > 0.0 && below.r < grazing.r && grazing.r < 1.0, "{below:?} {grazing:?}");
        assert_eq!(model.brdf(Dir3::Z, dir(1.0, 0.0, -0.1), Dir3::Z), Rgb::BLACK);
    }
}
