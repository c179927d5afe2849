//! Lambert's cosine law: rough surfaces that look equally bright from everywhere.

use phong_bvh::Lanes;

use super::Incident;
use crate::math::Dir3;
use crate::math::lanes::dot;
use crate::terms::Terms;

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
    #[inline]
    pub(super) fn shade_light(self, n: Dir3, Incident { l, c_d, .. }: Incident) -> Terms {
        Terms { diffuse: self.weight(n.to_array(), l.to_array()) * c_d, ..Terms::default() }
    }

    /// `k_d (L·N)`, for one light or eight.
    #[inline(always)]
    pub(super) fn weight<F: Lanes<Scalar = f32>>(self, n: [F; 3], l: [F; 3]) -> F {
        dot(n, l).at_least(0.0) * self.k_d
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{dir, white};
    use super::*;

    #[test]
    fn the_cosine_of_the_angle_of_incidence_is_all_there_is() {
        let model = Lambert { k_d: 0.5 };
        let diffuse = |l| model.shade_light(Dir3::Z, white(l)).diffuse.r;
        assert_eq!(diffuse(Dir3::Z), 0.5);
        assert!((diffuse(dir(0.6, 0.0, 0.8)) - 0.4).abs() < 1e-7);
        assert!((diffuse(dir(0.0, 3.0_f32.sqrt(), 1.0)) - 0.25).abs() < 1e-7); // 60°
        assert_eq!(diffuse(Dir3::X), 0.0);
    }
}
