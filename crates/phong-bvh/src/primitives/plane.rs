//! The infinite plane: `(p − point) · normal = 0`.
//!
//! With `p = o + t d`: `t = (point − o) · normal / (d · normal)`. A ray within the plane, or along
//! it, meets nothing. A plane has no bounds, so it stays out of every tree.

use fearless_simd::{Simd, f32x8, f64x4, mask32x8, prelude::*};
use glam::DVec3;

use crate::{
    Plane,
    local::{Loaded, Ray},
};

impl Plane {
    /// The distance at which `ray` meets the plane, or none; both sides count.
    #[inline]
    pub(crate) fn intersect(&self, ray: &Ray) -> Option<f32> {
        let t = self.solve(ray) as f32;
        (ray.t_min < t && t < ray.t_max).then_some(t)
    }

    /// The distance along the whole line of `ray`, not a finite number where they are parallel.
    #[inline]
    fn solve(&self, ray: &Ray) -> f64 {
        let Self { point, normal } = self;
        let (o, d) = (ray.origin.as_dvec3(), ray.dir.as_dvec3());
        (point - o).dot(*normal) / d.dot(*normal)
    }

    /// [`Plane::intersect`] for eight rays: the lanes that are hit, and where. None where it lies
    /// behind all of them.
    #[inline(always)]
    pub(crate) fn intersect8<S: Simd>(
        &self,
        simd: S,
        rays: &Loaded<S>,
    ) -> Option<(mask32x8<S>, f32x8<S>)> {
        let Loaded { origin: o, dir: d, t_min, t_max } = *rays;
        let [low, high] = match self.axis() {
            // Of two coordinates nothing is left, so that they are not asked for.
            Some(0) => self.parts_along(0, o[0], d[0]),
            Some(1) => self.parts_along(1, o[1], d[1]),
            Some(_) => self.parts_along(2, o[2], d[2]),
            None => {
                let (ox, oy, oz) = (o[0].widen(), o[1].widen(), o[2].widen());
                let (dx, dy, dz) = (d[0].widen(), d[1].widen(), d[2].widen());
                let low = self.parts4([ox.0, oy.0, oz.0], [dx.0, dy.0, dz.0]);
                [low, self.parts4([ox.1, oy.1, oz.1], [dx.1, dy.1, dz.1])]
            }
        };
        // Most rays that leave a plane go away from it: no division.
        if !ahead(simd, low) && !ahead(simd, high) {
            return None;
        }
        let t: f32x8<S> = (low[0] / low[1]).narrow(high[0] / high[1]);
        Some((t_min.simd_lt(t) & t.simd_lt(t_max), t))
    }

    /// The number of the axis that its normal lies along, if it lies along one.
    #[inline(always)]
    pub(crate) fn axis(&self) -> Option<usize> {
        match self.normal.abs().to_array() {
            [1.0, 0.0, 0.0] => Some(0),
            [0.0, 1.0, 0.0] => Some(1),
            [0.0, 0.0, 1.0] => Some(2),
            _ => None,
        }
    }

    /// What [`Plane::solve`] divides, for four rays.
    #[inline(always)]
    fn parts4<S: Simd>(&self, o: [f64x4<S>; 3], d: [f64x4<S>; 3]) -> [f64x4<S>; 2] {
        let Self { point, normal } = self;
        let off =
            (point.x - o[0]) * normal.x + (point.y - o[1]) * normal.y + (point.z - o[2]) * normal.z;
        [off, d[0] * normal.x + d[1] * normal.y + d[2] * normal.z]
    }

    /// The same, up to the sign of both, for twice four rays, where the normal lies along an axis: of
    /// starts and directions the coordinates along that one.
    #[inline(always)]
    fn parts_along<S: Simd>(&self, axis: usize, o: f32x8<S>, d: f32x8<S>) -> [[f64x4<S>; 2]; 2] {
        let (o, d, point) = (o.widen(), d.widen(), self.point[axis]);
        [[point - o.0, d.0], [point - o.1, d.1]]
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

/// Whether any of four quotients is above 0.
#[inline(always)]
fn ahead<S: Simd>(simd: S, [off, along]: [f64x4<S>; 2]) -> bool {
    let zero = f64x4::splat(simd, 0.0);
    let up = off.simd_gt(zero) & along.simd_gt(zero);
    (up | off.simd_lt(zero) & along.simd_lt(zero)).any_true()
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::local::Rays8;

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
    fn eight_rays_take_the_steps_of_one() {
        let plane =
            Plane { point: DVec3::new(0.1, -2.0, 0.7), normal: DVec3::new(0.6, -0.48, 0.64) };
        let ray = |i: u32| {
            let x = |k: u32| ((i * 37 + k * 101) % 97) as f32 / 48.5 - 1.0;
            let dir = Vec3::new(x(4), x(5), x(6)).normalize_or(Vec3::X);
            Ray { t_max: 3.0 + x(7), ..Ray::new(3.0 * Vec3::new(x(1), x(2), x(3)), dir) }
        };
        let mut count = 0;
        let rays: Vec<Ray> = (0..400).map(ray).collect();
        for (rays, eight) in rays.chunks(8).zip(Rays8::of(&rays)) {
            let simd = fearless_simd::Fallback::new();
            let met = plane.intersect8(simd, &eight.load(simd));
            for (lane, ray) in rays.iter().enumerate() {
                let here = met.filter(|(hit, _)| hit.to_bitmask() >> lane & 1 != 0);
                let found = here.map(|(_, t)| t[lane]);
                assert_eq!(found, plane.intersect(ray));
                count += u32::from(found.is_some());
            }
        }
        assert!(count > 50, "{count}");
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
