//! The infinite plane: `(p − point) · normal = 0`.
//!
//! With `p = o + t d`: `t = (point − o) · normal / (d · normal)`. A ray within the plane, or along
//! it, meets nothing. A plane has no bounds, so it stays out of every tree.

use glam::DVec3;

use crate::{Plane, Ray};

impl Plane {
    /// The distance at which `ray` meets the plane, or none; both sides count.
    pub fn intersect(&self, ray: &Ray) -> Option<f32> {
        let t = self.solve(ray) as f32;
        (ray.t_min < t && t < ray.t_max).then_some(t)
    }

    /// The distance along the whole line of `ray`, not a finite number where they are parallel.
    pub(crate) fn solve(&self, ray: &Ray) -> f64 {
        (self.point - ray.origin.as_dvec3()).dot(self.normal) / ray.dir.as_dvec3().dot(self.normal)
    }

    /// Two unit vectors that span the plane: along growing u and v, with `u × v = normal`.
    ///
    /// u is the world's x axis as far as the plane allows; the y axis where x is all but the normal.
    pub(crate) fn axes(&self) -> [DVec3; 2] {
        let along = if self.normal.x.abs() < 0.999 { DVec3::X } else { DVec3::Y };
        let u = (along - along.dot(self.normal) * self.normal).normalize_or(DVec3::X);
        [u, self.normal.cross(u)]
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    const FLOOR: Plane = Plane { point: DVec3::new(0.0, 0.0, 1.0), normal: DVec3::Z };

    #[test]
    fn both_sides_of_a_plane_are_met_and_what_lies_behind_is_not() {
        let down = Ray::new(Vec3::new(3.0, 4.0, 3.0), Vec3::NEG_Z);
        assert_eq!(FLOOR.intersect(&down), Some(2.0));
        let up = Ray::new(Vec3::new(3.0, 4.0, -3.0), Vec3::Z);
        assert_eq!(FLOOR.intersect(&up), Some(4.0));
        assert_eq!(FLOOR.intersect(&Ray { dir: Vec3::Z, ..down }), None);
        assert_eq!(FLOOR.intersect(&Ray { t_max: 2.0, ..down }), None);
        assert_eq!(FLOOR.intersect(&Ray { t_min: 2.0, ..down }), None);
    }

    #[test]
    fn a_ray_along_or_within_a_plane_meets_nothing() {
        assert_eq!(FLOOR.intersect(&Ray::new(Vec3::new(0.0, 0.0, 2.0), Vec3::X)), None);
        assert_eq!(FLOOR.intersect(&Ray::new(Vec3::new(0.0, 0.0, 1.0), Vec3::X)), None);
    }

    #[test]
    fn the_axes_of_every_plane_are_a_right_handed_frame() {
        for normal in [DVec3::X, DVec3::NEG_Y, DVec3::Z, DVec3::new(0.6, -0.48, 0.64)] {
            let [u, v] = Plane { point: DVec3::ZERO, normal }.axes();
            assert!((u.cross(v) - normal).length() < 1e-15, "{normal}: {u} {v}");
            assert!((u.length() - 1.0).abs() < 1e-15, "{normal}: {u}");
        }
    }
}
