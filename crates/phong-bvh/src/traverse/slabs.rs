//! A ray against eight boxes.
//!
//! Along each axis a box is met between `(near − o) / d` and `(far − o) / d`; near and far are its
//! sides by the direction's sign. The test is conservative in three ways:
//! the origin is moved back from near sides and on from far sides by 2⁻²⁰ of its largest coordinate
//! (see [`Aabb::padded`](crate::Aabb)); the interval's end is stretched by 2⁻²⁰ against
//! the rounding of the quotients; and reciprocals are finite, so a direction of 0 makes no NaN:
//! `0 · 10³⁷` is 0, and a side 10⁻²⁴ away is 10¹³ away.

use fearless_simd::{Simd, f32x8, mask32x8, prelude::*};

use glam::{BVec3, Vec3};

use crate::{
    Aabb,
    local::{Ray, Rays8},
    node8::{NODE, Row},
    primitives::splat3,
};

/// What the test needs of a ray.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slabs<S: Simd> {
    /// The rows of near sides; a far side is the other one of its pair.
    near: [usize; 3],
    near_origin: [f32x8<S>; 3],
    far_origin: [f32x8<S>; 3],
    near_reciprocal: [f32x8<S>; 3],
    far_reciprocal: [f32x8<S>; 3],
    t_min: f32x8<S>,
}

/// 2⁻²⁰.
pub(super) const SLACK: f32 = 1.0 / 1_048_576.0;

impl<S: Simd> Slabs<S> {
    /// Prepares a ray.
    #[inline(always)]
    pub(super) fn new(simd: S, ray: &Ray) -> Self {
        let (o, d) = (ray.origin, ray.dir);
        let pad = Vec3::splat(o.abs().max_element() * SLACK + 1e-24);
        let negative = d.is_negative_bitmask();
        let back = Vec3::select(
            BVec3::new(negative & 1 != 0, negative & 2 != 0, negative & 4 != 0),
            -pad,
            pad,
        );
        let reciprocal = d.recip().clamp(Vec3::splat(-1e37), Vec3::splat(1e37));
        let near = |axis: usize| 2 * axis + (negative >> axis & 1) as usize;
        Self {
            near: [near(0), near(1), near(2)],
            near_origin: splat3(simd, (o + back).to_array()),
            far_origin: splat3(simd, (o - back).to_array()),
            near_reciprocal: splat3(simd, reciprocal.to_array()),
            far_reciprocal: splat3(simd, (reciprocal * (1.0 + SLACK)).to_array()),
            t_min: f32x8::splat(simd, ray.t_min),
        }
    }

    /// The children that the ray enters before `t_max`, and where.
    #[inline(always)]
    pub(super) fn meet(
        &self,
        simd: S,
        node: &[Row; NODE],
        t_max: f32x8<S>,
    ) -> (mask32x8<S>, f32x8<S>) {
        let near = |axis: usize| {
            let side = f32x8::load_array_ref(simd, &node[self.near[axis] & 7].0);
            (side - self.near_origin[axis]) * self.near_reciprocal[axis]
        };
        let far = |axis: usize| {
            let side = f32x8::load_array_ref(simd, &node[(self.near[axis] ^ 1) & 7].0);
            (side - self.far_origin[axis]) * self.far_reciprocal[axis]
        };
        let enter = near(0).max(near(1)).max(near(2).max(self.t_min));
        let leave = far(0).min(far(1)).min(far(2).min(t_max));
        (enter.simd_le(leave), enter)
    }
}

/// The rays that meet a box before `t_max`, as bits: [`Slabs::meet`] of eight rays and one box. Of rays
/// that are not there what is said is unspecified.
#[inline(always)]
pub(crate) fn meet<S: Simd>(simd: S, rays: &Rays8, bounds: &Aabb, t_max: f32x8<S>) -> u32 {
    let (x, y, z) =
        (load(simd, &rays.origin[0]), load(simd, &rays.origin[1]), load(simd, &rays.origin[2]));
    let pad = x.abs().max(y.abs()).max(z.abs()) * SLACK + 1e-24;
    let Aabb { lo, hi } = *bounds;
    let (x0, x1) = slab(simd, x, load(simd, &rays.dir[0]), [lo.x, hi.x], pad);
    let (y0, y1) = slab(simd, y, load(simd, &rays.dir[1]), [lo.y, hi.y], pad);
    let (z0, z1) = slab(simd, z, load(simd, &rays.dir[2]), [lo.z, hi.z], pad);
    let enter = x0.max(y0).max(z0.max(load(simd, &rays.t_min)));
    let leave = x1.min(y1).min(z1.min(t_max));
    enter.simd_le(leave).to_bitmask() as u32
}

/// Where eight rays are between two sides of a box.
#[inline(always)]
fn slab<S: Simd>(
    simd: S,
    origin: f32x8<S>,
    dir: f32x8<S>,
    [lo, hi]: [f32; 2],
    pad: f32x8<S>,
) -> (f32x8<S>, f32x8<S>) {
    let reciprocal = (f32x8::splat(simd, 1.0) / dir)
        .max(f32x8::splat(simd, -1e37))
        .min(f32x8::splat(simd, 1e37));
    let back = reciprocal.simd_lt(f32x8::splat(simd, 0.0));
    let (low, high) = (f32x8::splat(simd, lo) - pad, f32x8::splat(simd, hi) + pad);
    let (near, far) = (back.select(high, low), back.select(low, high));
    ((near - origin) * reciprocal, (far - origin) * (reciprocal * (1.0 + SLACK)))
}

#[inline(always)]
fn load<S: Simd>(simd: S, lanes: &[f32; 8]) -> f32x8<S> {
    f32x8::load_array_ref(simd, lanes)
}
