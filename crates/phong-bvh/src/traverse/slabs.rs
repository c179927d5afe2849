//! A ray against eight boxes.
//!
//! Along each axis a box is met between `(near − o) / d` and `(far − o) / d`; near and far are its
//! sides by the direction's sign. The test is conservative in three ways:
//! the origin is moved back from near sides and on from far sides by 2⁻²⁰ of its largest coordinate
//! (see [`Aabb::padded`](crate::Aabb)); the interval's end is stretched by 2⁻²⁰ against
//! the rounding of the quotients; and reciprocals are finite, so a direction of 0 makes no NaN:
//! `0 · 10³⁷` is 0, and a side 10⁻²⁴ away is 10¹³ away.

use fearless_simd::{Simd, f32x8, mask32x8, prelude::*};

use crate::{
    node8::{NODE, Row},
    ray::Ray,
};

/// What the test needs of a ray.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slabs<S: Simd> {
    /// The rows of near sides; a far side is the other one of its pair.
    near: [usize; 3],
    near_origin: [f32x8<S>; 3],
    far_origin: [f32x8<S>; 3],
    reciprocal: [f32x8<S>; 3],
    t_min: f32x8<S>,
}

/// 2⁻²⁰.
const SLACK: f32 = 1.0 / 1_048_576.0;

impl<S: Simd> Slabs<S> {
    /// Prepares a ray.
    #[inline(always)]
    pub(super) fn new(simd: S, ray: &Ray) -> Self {
        let (o, d) = (ray.origin.to_array(), ray.dir.to_array());
        let pad = ray.origin.abs().max_element() * SLACK + 1e-24;
        let splat = |x: f32| f32x8::splat(simd, x);
        let negative = d.map(f32::is_sign_negative);
        let side = |axis: usize, pad: f32| {
            splat(if negative[axis] { o[axis] - pad } else { o[axis] + pad })
        };
        Self {
            near: [0, 1, 2].map(|axis| 2 * axis + usize::from(negative[axis])),
            near_origin: [0, 1, 2].map(|axis| side(axis, pad)),
            far_origin: [0, 1, 2].map(|axis| side(axis, -pad)),
            reciprocal: d.map(|d| splat((1.0 / d).clamp(-1e37, 1e37))),
            t_min: splat(ray.t_min),
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
        let side = |axis: usize, row: usize, origin: f32x8<S>| {
            (f32x8::load_array_ref(simd, &node[row & 7].0) - origin) * self.reciprocal[axis]
        };
        let near = |axis: usize| side(axis, self.near[axis], self.near_origin[axis]);
        let far = |axis: usize| side(axis, self.near[axis] ^ 1, self.far_origin[axis]);
        let enter = near(0).max(near(1)).max(near(2).max(self.t_min));
        let leave = far(0).min(far(1)).min(far(2)) * (1.0 + SLACK);
        (enter.simd_le(leave.min(t_max)), enter)
    }
}
