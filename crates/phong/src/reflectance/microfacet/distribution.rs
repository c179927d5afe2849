//! How many facets face which way.

use std::f32::consts::PI;

use crate::math::{Dir3, erfc, exp, lobe};
use crate::reflectance::NARROWEST;

/// The exponent as narrow as [`NARROWEST`], by `m² = 2/(n+2)`.
const SHARPEST: f32 = 2.0 / (NARROWEST * NARROWEST) - 2.0;

/// How far a direction leans from the normal.
///
/// Cosine and sine both, since near the normal neither follows from the other in f32.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lean {
    /// Cosine of the angle to the normal.
    pub cos: f32,
    /// Squared sine of it.
    pub sin2: f32,
}

impl Lean {
    /// The lean of `v` from the normal `n`.
    pub fn of(n: Dir3, v: Dir3) -> Self {
        Self { cos: n.dot(v), sin2: n.to_vec().cross(v.to_vec()).length_squared() }
    }

    /// The lean of this very cosine.
    pub fn from_cos(cos: f32) -> Self {
        Self { cos, sin2: (1.0 - cos) * (1.0 + cos) }
    }

    /// Squared tangent; ∞ at the horizon.
    pub fn tan2(self) -> f32 {
        self.sin2 / (self.cos * self.cos)
    }
}

/// The distribution of facet normals, with its width.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Distribution {
    /// A power of the cosine (Blinn 1977).
    Blinn {
        /// The exponent, ≥ 0; above that of the width [`NARROWEST`] it counts as that.
        n: f32,
    },
    /// Gaussian slopes (Beckmann and Spizzichino 1963).
    Beckmann {
        /// Root mean square slope m, > 0, no less than [`NARROWEST`].
        m: f32,
    },
    /// GGX, or Trowbridge–Reitz: a longer tail (Walter and others 2007).
    Ggx {
        /// Roughness α, > 0, no less than [`NARROWEST`].
        alpha: f32,
    },
}

impl Distribution {
    /// D: facets that face `h`, per steradian, by area; 0 below the horizon.
    ///
    /// Normalised so that `∫ D(h) (N·h) dh = 1`, the facets' shadow on the ground.
    ///
    /// - Blinn: `(n+2)/2π (N·h)^n`
    /// - Beckmann: `exp(−tan²θ/m²) / (π m² cos⁴θ)`
    /// - GGX: `α² / (π (α² cos²θ + sin²θ)²)`
    pub fn density(self, h: Lean) -> f32 {
        if h.cos <= 0.0 {
            return 0.0;
        }
        let cos2 = h.cos * h.cos;
        match self {
            Self::Blinn { n } => {
                let n = n.min(SHARPEST);
                (n + 2.0) / (2.0 * PI) * lobe(h.cos, n)
            }
            Self::Beckmann { m } => {
                let m2 = m.max(NARROWEST) * m.max(NARROWEST);
                let slopes = exp(-h.tan2() / m2);
                // At the horizon cos⁴ falls to 0 as well, in f32.
                if slopes == 0.0 { 0.0 } else { slopes / (PI * m2 * cos2 * cos2) }
            }
            Self::Ggx { alpha } => {
                let alpha2 = alpha.max(NARROWEST) * alpha.max(NARROWEST);
                let width = alpha2 * cos2 + h.sin2;
                alpha2 / (PI * width * width)
            }
        }
    }

    /// Smith's Λ: facets hidden from `v`, per facet seen.
    ///
    /// - Beckmann: `(exp(−a²)/(a√π) − erfc(a))/2` with `a = 1/(m tan θ)`, exact
    /// - GGX: `(√(1 + α² tan²θ) − 1)/2`
    /// - Blinn has no closed form; Beckmann's of like width, `m² = 2/(n+2)`, serves (Walter 2007)
    pub fn lambda(self, v: Lean) -> f32 {
        match self {
            Self::Blinn { n } => Self::Beckmann { m: (2.0 / (n + 2.0)).sqrt() }.lambda(v),
            Self::Beckmann { m } => {
                let a = 1.0 / (m.max(NARROWEST) * v.tan2().sqrt());
                0.5 * (exp(-a * a) / (a * PI.sqrt()) - erfc(a))
            }
            Self::Ggx { alpha } => {
                // √(1 + x) − 1 = x/(√(1 + x) + 1), which does not cancel for small x.
                let slope = alpha.max(NARROWEST);
                let x = slope * slope * v.tan2();
                if x.is_finite() { 0.5 * x / ((1.0 + x).sqrt() + 1.0) } else { f32::INFINITY }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Distribution; 3] = [
        Distribution::Blinn { n: 30.0 },
        Distribution::Beckmann { m: 0.25 },
        Distribution::Ggx { alpha: 0.25 },
    ];

    #[test]
    fn face_on_the_densities_are_their_bare_factors() {
        let up = Lean::from_cos(1.0);
        let found = ALL.map(|d| d.density(up));
        // 32/2π, and 1/(π/16) twice
        for (found, expected) in found.into_iter().zip([16.0 / PI, 16.0 / PI, 16.0 / PI]) {
            assert!((found - expected).abs() < 1e-6, "{found} for {expected}");
        }
    }

    #[test]
    fn worked_examples_at_45_degrees() {
        // cos² = ½, tan² = 1.
        let slanted = Lean { cos: 0.5_f32.sqrt(), sin2: 0.5 };
        let [blinn, beckmann, ggx] = ALL.map(|d| d.density(slanted));
        assert!((blinn - 16.0 / PI / 32_768.0).abs() < 1e-9); // 2⁻¹⁵
        let expected = 16.0 / PI * 4.0 * 1.125_351_7e-7; // e⁻¹⁶ / cos⁴
        assert!((beckmann - expected).abs() < 1e-11, "{beckmann}");
        // α²/(π (α²/2 + ½)²) = (1/16)/(π (17/32)²)
        assert!((ggx - 0.0625 / (PI * 0.282_226_56)).abs() < 1e-7, "{ggx}");
    }

    #[test]
    fn ggx_hides_as_a_square_root_does() {
        // α tan θ = 1: (√2 − 1)/2.
        let cos = (1.0_f32 / 17.0).sqrt(); // tan² = 16
        let lambda = Distribution::Ggx { alpha: 0.25 }.lambda(Lean { cos, sin2: 16.0 / 17.0 });
        assert!((lambda - 0.5 * (2.0_f32.sqrt() - 1.0)).abs() < 1e-7, "{lambda}");
    }

    #[test]
    fn beckmann_hides_by_the_error_function() {
        // a = 1: (e⁻¹/√π − erfc 1)/2 = (0.20755375 − 0.15729921)/2
        let cos = (1.0_f32 / 17.0).sqrt();
        let lambda = Distribution::Beckmann { m: 0.25 }.lambda(Lean { cos, sin2: 16.0 / 17.0 });
        assert!((lambda - 0.025_127_27).abs() < 1e-7, "{lambda}");
    }

    #[test]
    fn nothing_is_hidden_face_on_and_everything_at_the_horizon() {
        for d in ALL {
            assert_eq!(d.lambda(Lean::from_cos(1.0)), 0.0, "{d:?}");
            assert_eq!(d.lambda(Lean::from_cos(0.0)), f32::INFINITY, "{d:?}");
            assert_eq!(d.density(Lean::from_cos(0.0)), 0.0 * d.density(Lean::from_cos(1.0)));
        }
    }
}
