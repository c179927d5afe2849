//! How many facets face which way.

use std::f32::consts::PI;

use crate::math::{Dir3, erfc, exp, lobe};
use crate::reflectance::NARROWEST;

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
        /// The exponent, ≥ 0.
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
            Self::Blinn { n } => (n + 2.0) / (2.0 * PI) * lobe(h.cos, n),
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
