//! The sphere, from the point of the ray that is closest to its middle.
//!
//! With `c` from the ray's origin to the middle, the closest point is at `b = c·d / d·d`, and
//! `f = c − b d` leads from it to the middle. The ray is inside within `h = √((r² − f·f) / d·d)`
//! of it: `t = b ± h`. The textbook `b² − a c` takes the difference of two numbers of the
//! size of the distance squared; in f32 it loses a sphere of radius 0.01 at distance 100. `f` is
//! of the size of the radius, and so are its errors times the distance (Hearn and Baker; *Ray
//! Tracing Gems*, chapter 7).
//!
//! The first of the two `t` that the ray counts is the hit: from within, the far side.
//! One lane and eight lanes take the same steps in f32, so they agree bit for bit.

use fearless_simd::{Simd, f32x8, mask32x8, prelude::*};

use crate::{
    Sphere,
    local::{Loaded, Ray},
    node8::Row,
    primitives::splat3,
};

/// What the test needs of a ray.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Closest {
    pub(super) origin: [f32; 3],
    pub(super) dir: [f32; 3],
    /// 1 / d·d.
    pub(super) scale: f32,
    pub(super) t_min: f32,
    pub(super) t_max: f32,
}

impl Closest {
    /// Prepares a ray.
    #[inline(always)]
    pub(crate) fn new(ray: &Ray) -> Self {
        let dir @ [x, y, z] = ray.dir.to_array();
        Self {
            origin: ray.origin.to_array(),
            dir,
            scale: 1.0 / (x * x + y * y + z * z),
            t_min: ray.t_min,
            t_max: ray.t_max,
        }
    }

    /// The distance at which the ray meets `sphere`, or none.
    pub(crate) fn intersect(&self, sphere: &Sphere) -> Option<f32> {
        let [ox, oy, oz] = self.origin;
        let [dx, dy, dz] = self.dir;
        let [cx, cy, cz] = [sphere.center.x - ox, sphere.center.y - oy, sphere.center.z - oz];
        let b = (cx * dx + cy * dy + cz * dz) * self.scale;
        let [fx, fy, fz] = [cx - b * dx, cy - b * dy, cz - b * dz];
        let inside = sphere.radius * sphere.radius - (fx * fx + fy * fy + fz * fz);
        if inside < 0.0 {
            return None;
        }
        let h = (inside * self.scale).sqrt();
        let t = if b - h > self.t_min { b - h } else { b + h };
        (t > self.t_min && t < self.t_max).then_some(t)
    }
}

/// Eight spheres: x, y, z, radius, then their numbers.
pub(crate) const BLOCK: usize = 5;

/// [`Closest`] for eight spheres at once.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Closest8<S: Simd> {
    pub(crate) origin: [f32x8<S>; 3],
    pub(crate) dir: [f32x8<S>; 3],
    pub(crate) scale: f32x8<S>,
    pub(crate) t_min: f32x8<S>,
    pub(crate) t_max: f32x8<S>,
}

impl<S: Simd> Closest8<S> {
    /// Spreads a prepared ray over the lanes.
    #[inline(always)]
    pub(crate) fn new(simd: S, ray: &Closest) -> Self {
        Self {
            origin: splat3(simd, ray.origin),
            dir: splat3(simd, ray.dir),
            scale: f32x8::splat(simd, ray.scale),
            t_min: f32x8::splat(simd, ray.t_min),
            t_max: f32x8::splat(simd, ray.t_max),
        }
    }

    /// Eight rays, one in each lane.
    #[inline(always)]
    pub(crate) fn of_rays(simd: S, rays: &Loaded<S>) -> Self {
        let Loaded { origin, dir, t_min, t_max } = *rays;
        let [x, y, z] = dir;
        let scale = f32x8::splat(simd, 1.0) / (x * x + y * y + z * z);
        Self { origin, dir, scale, t_min, t_max }
    }

    /// The lanes that are hit, and where: a ray against eight spheres.
    #[inline(always)]
    pub(crate) fn intersect(&self, simd: S, block: &[Row; BLOCK]) -> (u32, f32x8<S>) {
        let load = |row: usize| f32x8::load_array_ref(simd, &block[row].0);
        let met = self.meet(simd, [load(0), load(1), load(2)], load(3));
        met.map_or((0, f32x8::splat(simd, 0.0)), |(hit, t)| (hit.to_bitmask() as u32, t))
    }

    /// The lanes that are hit, and where: eight rays against the sphere in one lane of a block. None
    /// where all of them miss it widely.
    #[inline(always)]
    pub(crate) fn intersect_one(
        &self,
        simd: S,
        block: &[Row; BLOCK],
        lane: usize,
    ) -> Option<(mask32x8<S>, f32x8<S>)> {
        let splat = |row: usize| f32x8::splat(simd, block[row].0[lane]);
        self.meet(simd, [splat(0), splat(1), splat(2)], splat(3))
    }

    #[inline(always)]
    fn meet(
        &self,
        simd: S,
        center: [f32x8<S>; 3],
        radius: f32x8<S>,
    ) -> Option<(mask32x8<S>, f32x8<S>)> {
        let [dx, dy, dz] = self.dir;
        let cx = center[0] - self.origin[0];
        let cy = center[1] - self.origin[1];
        let cz = center[2] - self.origin[2];
        let b = (cx * dx + cy * dy + cz * dz) * self.scale;
        let fx = cx - b * dx;
        let fy = cy - b * dy;
        let fz = cz - b * dz;
        let zero = f32x8::splat(simd, 0.0);
        let inside = radius * radius - (fx * fx + fy * fy + fz * fz);
        let hit = inside.simd_ge(zero);
        if !hit.any_true() {
            return None;
        }
        let h = (inside.max(zero) * self.scale).sqrt();
        let (enter, leave) = (b - h, b + h);
        let t = enter.simd_gt(self.t_min).select(enter, leave);
        Some((hit & t.simd_gt(self.t_min) & t.simd_lt(self.t_max), t))
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    fn meet(ray: &Ray, center: Vec3, radius: f32) -> Option<f32> {
        Closest::new(ray).intersect(&Sphere { center, radius })
    }

    #[test]
    fn a_small_sphere_far_away_is_met_at_its_near_side() {
        let ray = Ray::new(Vec3::ZERO, Vec3::X);
        let t = meet(&ray, Vec3::new(100.0, 0.009, 0.0), 0.01).unwrap();
        assert!((t - (100.0 - (0.01f32 * 0.01 - 0.009 * 0.009).sqrt())).abs() < 1e-5, "{t}");
        assert_eq!(meet(&ray, Vec3::new(100.0, 0.0101, 0.0), 0.01), None);
    }

    #[test]
    fn from_within_the_far_side_is_met_and_behind_nothing_is() {
        let ray = Ray::new(Vec3::new(1.5, 0.0, 0.0), Vec3::X);
        assert_eq!(meet(&ray, Vec3::X, 1.0), Some(0.5));
        assert_eq!(meet(&ray, Vec3::new(-4.0, 0.0, 0.0), 1.0), None);
        assert_eq!(meet(&Ray { t_min: 0.5, ..ray }, Vec3::X, 1.0), None, "t_min is excluded");
        assert_eq!(meet(&Ray { t_max: 0.5, ..ray }, Vec3::X, 1.0), None, "and so is t_max");
    }
}
