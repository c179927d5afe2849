//! How many facets are hidden, from the light or from the eye, by others.

use super::{Distribution, Lean};

/// The shadowing–masking term G.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shadowing {
    /// Smith, light and eye independent: `1/((1+Λ(L))(1+Λ(E)))`.
    Separable,
    /// Smith, correlated by height: `1/(1+Λ(L)+Λ(E))`.
    Correlated,
    /// V-shaped grooves (Cook and Torrance 1982):
    /// `min(1, 2(N·H)(N·E)/(E·H), 2(N·H)(N·L)/(E·H))`.
    VCavity,
    /// `(N·L)(N·E)`, which cancels the BRDF's denominator: what programs do that write `D F/4`,
    /// such as three.js's `MeshPhongMaterial`.
    Implicit,
}

impl Shadowing {
    /// The share of the facets facing `h` that light reaches and eye sees, in [0, 1].
    ///
    /// `l`, `e`, `h` are leans from the normal, all above the horizon; `e_dot_h` = E·H = L·H > 0.
    pub fn visible(self, facets: Distribution, [l, e, h]: [Lean; 3], e_dot_h: f32) -> f32 {
        match self {
            Self::Separable => 1.0 / ((1.0 + facets.lambda(l)) * (1.0 + facets.lambda(e))),
            Self::Correlated => 1.0 / (1.0 + facets.lambda(l) + facets.lambda(e)),
            Self::VCavity => (2.0 * h.cos * e.cos.min(l.cos) / e_dot_h).min(1.0),
            Self::Implicit => l.cos * e.cos,
        }
    }
}
