//! Rays that go the same way, as one: against eight boxes.
//!
//! With every origin in an interval and every reciprocal direction in another, interval arithmetic
//! bounds where the first ray could enter a box and the last could leave it. The bounds are taken over
//! the very numbers each ray's own test uses, and rounding is monotone; so no box is left out that a ray
//! alone would have entered.

use fearless_simd::{Simd, f32x8, prelude::*};

use super::{
    columns::{Column, Columns, bounds},
    slabs::SLACK,
};
use crate::{
    Aabb, Ray,
    node8::{NODE, Row},
};

/// All rays at once, against eight boxes.
pub(super) struct Frustum<S: Simd> {
    near: [usize; 3],
    near_origin: [f32x8<S>; 3],
    far_origin: [f32x8<S>; 3],
    near_reciprocal: [[f32x8<S>; 2]; 3],
    far_reciprocal: [[f32x8<S>; 2]; 3],
    t_min: f32x8<S>,
}

impl<S: Simd> Frustum<S> {
    /// Around rays from their origins.
    #[inline(always)]
    pub(super) fn new(simd: S, columns: &Columns) -> Self {
        let zero = f32x8::splat(simd, 0.0);
        let mut frustum = Self {
            near: columns.near,
            near_origin: [zero; 3],
            far_origin: [zero; 3],
            near_reciprocal: [[zero; 2]; 3],
            far_reciprocal: [[zero; 2]; 3],
            t_min: f32x8::splat(simd, bounds(simd, &columns.t_min, columns.packets)[0]),
        };
        for axis in 0..3 {
            let bounds = |column: &Column| bounds(simd, column, columns.packets);
            let negative = columns.near[axis] & 1;
            // Earliest in: a ray along +x from the greatest origin. Latest out: from the least.
            let near = bounds(&columns.near_origin[axis])[1 - negative];
            let far = bounds(&columns.far_origin[axis])[negative];
            frustum.near_origin[axis] = f32x8::splat(simd, near);
            frustum.far_origin[axis] = f32x8::splat(simd, far);
            let [low, high] = bounds(&columns.near_reciprocal[axis]);
            frustum.near_reciprocal[axis] = [f32x8::splat(simd, low), f32x8::splat(simd, high)];
            let [low, high] = bounds(&columns.far_reciprocal[axis]);
            frustum.far_reciprocal[axis] = [f32x8::splat(simd, low), f32x8::splat(simd, high)];
        }
        frustum
    }

    /// The same rays from their ends, backwards, where those lie closer together: shadow rays meet
    /// at the light. None where they do not, or where a ray has no end.
    #[inline(always)]
    pub(super) fn backwards(simd: S, columns: &Columns, rays: &[Ray]) -> Option<Self> {
        let longest = rays.iter().fold(0.0_f32, |longest, ray| longest.max(ray.t_max));
        if !longest.is_finite() {
            return None;
        }
        let (mut start, mut end) = (Aabb::EMPTY, Aabb::EMPTY);
        for ray in rays {
            let at = ray.at(ray.t_max);
            start = Aabb { lo: start.lo.min(ray.origin), hi: start.hi.max(ray.origin) };
            end = Aabb { lo: end.lo.min(at), hi: end.hi.max(at) };
        }
        if (end.hi - end.lo).max_element() >= (start.hi - start.lo).max_element() {
            return None;
        }
        // Beyond all that rounding the ends, the slack of a ray's own test and the padding of its
        // origin can amount to.
        let magnitude = start.lo.abs().max(start.hi.abs()).max_element() + longest;
        let pad = magnitude * (8.0 * SLACK) + 1e-24;
        let mut frustum = Self::new(simd, columns);
        for axis in 0..3 {
            // Now the far sides come first.
            frustum.near[axis] ^= 1;
            let (low, high) = (end.lo[axis] - pad, end.hi[axis] + pad);
            let (near, far) = if columns.near[axis] & 1 == 0 { (low, high) } else { (high, low) };
            frustum.near_origin[axis] = f32x8::splat(simd, near);
            frustum.far_origin[axis] = f32x8::splat(simd, far);
            let [low, high] = frustum.near_reciprocal[axis];
            frustum.near_reciprocal[axis] = [-high, -low];
            let [low, high] = frustum.far_reciprocal[axis];
            frustum.far_reciprocal[axis] = [-high, -low];
        }
        frustum.t_min = f32x8::splat(simd, 0.0);
        Some(frustum)
    }

    /// The children that some ray may enter before `t_max`, and where at the earliest.
    #[inline(always)]
    pub(super) fn meet(&self, simd: S, node: &[Row; NODE], t_max: f32x8<S>) -> (u32, f32x8<S>) {
        let load = |row: usize| f32x8::load_array_ref(simd, &node[row & 7].0);
        let enter = |axis: usize| {
            let way = load(self.near[axis]) - self.near_origin[axis];
            let [low, high] = self.near_reciprocal[axis];
            (way * low).min(way * high)
        };
        let leave = |axis: usize| {
            let way = load(self.near[axis] ^ 1) - self.far_origin[axis];
            let [low, high] = self.far_reciprocal[axis];
            (way * low).max(way * high)
        };
        let first = enter(0).max(enter(1)).max(enter(2).max(self.t_min));
        let last = leave(0).min(leave(1)).min(leave(2).min(t_max));
        (first.simd_le(last).to_bitmask() as u32, first)
    }
}
