//! All rays of a group at once against eight boxes.
//!
//! Interval arithmetic over the origins and reciprocal directions bounds where the first ray could enter a
//! box and the last could leave it. The intervals hold the same numbers that each ray's own test uses, and
//! rounding is monotone, so the group enters every box that one of its rays would enter alone.

use fearless_simd::{Simd, f32x8, prelude::*};

use super::{columns::Columns, slabs::SLACK};
use crate::node8::{NODE, Row};

/// The bounds of a group's rays, prepared for boxes.
#[derive(Debug)]
pub(super) struct Frustum {
    near: [usize; 3],
    near_origin: [f32; 3],
    far_origin: [f32; 3],
    near_reciprocal: [[f32; 2]; 3],
    far_reciprocal: [[f32; 2]; 3],
    t_min: f32,
}

impl Frustum {
    /// The rays as they are.
    pub(super) fn new(columns: &Columns) -> Self {
        let bounds = &columns.bounds;
        let (low, high) = (bounds.reciprocal.lo.to_array(), bounds.reciprocal.hi.to_array());
        let [x, y, z] = [0, 1, 2].map(|axis| [low[axis], high[axis]]);
        let far = |[low, high]: [f32; 2]| [low * (1.0 + SLACK), high * (1.0 + SLACK)];
        let (low, high) = (bounds.start.lo.to_array(), bounds.start.hi.to_array());
        // Earliest in: a ray along +x from the greatest origin. Latest out: from the least.
        let negative = columns.near.map(|near| near & 1 != 0);
        let pick = |axis: usize, low_first: bool| if low_first { low[axis] } else { high[axis] };
        Self {
            near: columns.near,
            near_origin: [0, 1, 2].map(|axis| pick(axis, negative[axis])),
            far_origin: [0, 1, 2].map(|axis| pick(axis, !negative[axis])),
            near_reciprocal: [x, y, z],
            far_reciprocal: [far(x), far(y), far(z)],
            t_min: bounds.t_min,
        }
    }

    /// The same rays backwards, from their ends, where the ends are closer together than the origins, as
    /// those of shadow rays at a light. `None` where they are not, or where a ray is infinite.
    pub(super) fn backwards(columns: &Columns) -> Option<Self> {
        let (start, end) = (columns.bounds.start, columns.bounds.end);
        let longest = columns.bounds.longest;
        if !longest.is_finite()
            || (end.hi - end.lo).max_element() >= (start.hi - start.lo).max_element()
        {
            return None;
        }
        // More than the rounding of the end points, the slack of a ray's own test and the padding of its
        // origin together.
        let magnitude = start.lo.abs().max(start.hi.abs()).max_element() + longest;
        let pad = magnitude * (8.0 * SLACK) + 1e-24;
        let mut frustum = Self::new(columns);
        for axis in 0..3 {
            // Now the far sides come first.
            frustum.near[axis] ^= 1;
            let (low, high) = (end.lo[axis] - pad, end.hi[axis] + pad);
            let positive = columns.near[axis] & 1 == 0;
            let (near, far) = if positive { (low, high) } else { (high, low) };
            (frustum.near_origin[axis], frustum.far_origin[axis]) = (near, far);
            let [low, high] = frustum.near_reciprocal[axis];
            frustum.near_reciprocal[axis] = [-high, -low];
            let [low, high] = frustum.far_reciprocal[axis];
            frustum.far_reciprocal[axis] = [-high, -low];
        }
        frustum.t_min = 0.0;
        Some(frustum)
    }

    /// The children that some ray may enter before `t_max`, and the least distance at which.
    #[inline(always)]
    pub(super) fn meet<S: Simd>(&self, simd: S, node: &[Row; NODE], t_max: f32) -> (u32, f32x8<S>) {
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
        let first = enter(0).max(enter(1)).max(enter(2).max(f32x8::splat(simd, self.t_min)));
        let last = leave(0).min(leave(1)).min(leave(2).min(f32x8::splat(simd, t_max)));
        (first.simd_le(last).to_bitmask() as u32, first)
    }
}
