//! How wide a ray is: what one look-up of a texture stands for.

use glam::DVec3;
use phong_bvh::Lanes;

use crate::math::lanes::{cross, dot, scale};

/// The cone of space about a ray that its sample of the picture stands for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cone {
    /// How wide it is where the ray starts, across the ray, in units of the world.
    pub width: f32,
    /// How much wider it grows with each unit of the way; below 0 it comes together, and goes apart again behind
    /// that.
    pub spread: f32,
}

/// How grazing a surface counts at most: the least cosine.
const LEAST_COSINE: f64 = 1e-4;

impl Cone {
    /// What it is after so long a way: it goes apart again behind where it comes together.
    #[must_use]
    pub fn after(self, t: f32) -> Self {
        let width = self.width + self.spread * t;
        if width < 0.0 {
            Self { width: -width, spread: -self.spread }
        } else {
            Self { width, ..self }
        }
    }
}

/// The sides of what a ray of direction `dir` that is `width` wide covers of a surface whose unit normal is
/// `normal`: the shorter side, across the ray, and the longer one.
#[inline(always)]
pub(crate) fn footprint<F: Lanes<Scalar = f64>>(
    width: F,
    dir: [F; 3],
    normal: [F; 3],
) -> [[F; 3]; 2] {
    let across = cross(normal, dir);
    let shrink = across[0].splat(1.0) / dot(across, across).sqrt();
    let none = !shrink.lt(shrink.splat(f64::INFINITY));
    let any = |normal| DVec3::from_array(normal).any_orthonormal_vector().to_array();
    let across = F::map3_where(none, normal, scale(shrink, across), any);
    let along = cross(normal, across);
    let cos = dot(dir, normal).abs().at_least(LEAST_COSINE);
    [scale(width, across), scale(width / cos, along)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cone_that_comes_together_goes_apart_again() {
        let cone = Cone { width: 1.0, spread: -0.5 };
        let at = |t| {
            let Cone { width, spread } = cone.after(t);
            [width, spread]
        };
        assert_eq!([at(1.0), at(2.0), at(4.0)], [[0.5, -0.5], [0.0, -0.5], [1.0, 0.5]]);
    }

    #[test]
    fn a_footprint_is_as_long_as_the_surface_is_grazed() {
        let dir = DVec3::new(3.0, 0.0, -4.0) / 5.0;
        let footprint = |width, dir: DVec3, normal: DVec3| {
            footprint(width, dir.to_array(), normal.to_array()).map(DVec3::from_array)
        };
        let [short, long] = footprint(0.1, dir, DVec3::Z);
        assert!((short.length() - 0.1).abs() < 1e-7 && (short.y.abs() - 0.1).abs() < 1e-7);
        assert!((long.length() - 0.125).abs() < 1e-7 && (long.x.abs() - 0.125).abs() < 1e-7);
        let [a, b] = footprint(1.0, -DVec3::Z, DVec3::Z);
        assert!((a.length() - 1.0).abs() < 1e-6 && a.dot(b).abs() < 1e-6 && a.z == 0.0);
        assert!(footprint(1.0, DVec3::X, DVec3::Z)[1].is_finite());
    }
}
