//! Lambert's cosine law: rough surfaces that look equally bright from everywhere.

use super::{Incident, Terms};
use crate::math::Dir3;

/// `k_d (L·N) C_d`.
///
/// As a BRDF: `k_d/π`, so that `k_d` is the albedo.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lambert {
    /// `k_d`, ≥ 0: the share of light given back.
    pub k_d: f32,
}

impl Lambert {
    /// What one light above the horizon adds: `k_d (L·N) C_d`.
    pub(super) fn shade_light(self, n: Dir3, Incident { l, c_d, .. }: Incident) -> Terms {
        let Self { k_d } = self;
        Terms { diffuse: k_d * l.cos(n) * c_d, ..Terms::default() }
    }
}
