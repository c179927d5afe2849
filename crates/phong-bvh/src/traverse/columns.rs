//! Up to 64 rays side by side, against one box.

use fearless_simd::{Simd, f32x8, prelude::*};

use super::slabs::SLACK;
use crate::{
    Ray,
    node8::{NODE, Row},
};

/// The most rays side by side.
pub(super) const GROUP: usize = 64;
const PACKETS: usize = GROUP / 8;

/// One number of each ray, in packets of eight.
pub(super) type Column = [[f32; 8]; PACKETS];

/// The rays by columns: what eight of them need to be tested against one box.
pub(super) struct Columns {
    pub(super) near_origin: [Column; 3],
    pub(super) far_origin: [Column; 3],
    pub(super) near_reciprocal: [Column; 3],
    pub(super) far_reciprocal: [Column; 3],
    pub(super) t_min: Column,
    /// The best hit so far; −1 where there is no ray, or a blocked one, so that no box is met.
    pub(super) t_max: Column,
    pub(super) packets: usize,
    /// The rows of near sides.
    pub(super) near: [usize; 3],
}

impl Columns {
    /// The columns of `rays`, which agree in the signs of their directions.
    #[inline(always)]
    pub(super) fn new<S: Simd>(simd: S, rays: &[Ray], t_max: impl Fn(usize) -> f32) -> Self {
        let zero = [[0.0; 8]; PACKETS];
        let mut columns = Self {
            near_origin: [zero; 3],
            far_origin: [zero; 3],
            near_reciprocal: [zero; 3],
            far_reciprocal: [zero; 3],
            t_min: zero,
            t_max: [[-1.0; 8]; PACKETS],
            packets: rays.len().div_ceil(8),
            near: [0; 3],
        };
        let negative = rays[0].dir.is_negative_bitmask() as usize;
        columns.near = [negative & 1, 2 + (negative >> 1 & 1), 4 + (negative >> 2 & 1)];
        for i in 0..columns.packets * 8 {
            // The last packet is filled up with rays that end before they begin.
            let ray = &rays[i.min(rays.len() - 1)];
            let (packet, lane) = (i / 8, i % 8);
            for axis in 0..3 {
                columns.near_origin[axis][packet][lane] = ray.origin[axis];
                columns.near_reciprocal[axis][packet][lane] = ray.dir[axis];
            }
            columns.t_min[packet][lane] = ray.t_min;
            if i < rays.len() {
                columns.t_max[packet][lane] = t_max(i);
            }
        }
        for packet in 0..columns.packets {
            let [x, y, z] = &columns.near_origin;
            let x = f32x8::load_array_ref(simd, &x[packet]).abs();
            let y = f32x8::load_array_ref(simd, &y[packet]).abs();
            let z = f32x8::load_array_ref(simd, &z[packet]).abs();
            let pad = x.max(y).max(z) * SLACK + 1e-24;
            for axis in 0..3 {
                let origin = f32x8::load_array_ref(simd, &columns.near_origin[axis][packet]);
                let back = if negative >> axis & 1 != 0 { -pad } else { pad };
                let dir = f32x8::load_array_ref(simd, &columns.near_reciprocal[axis][packet]);
                let reciprocal = (f32x8::splat(simd, 1.0) / dir)
                    .max(f32x8::splat(simd, -1e37))
                    .min(f32x8::splat(simd, 1e37));
                (origin + back).store_array(&mut columns.near_origin[axis][packet]);
                (origin - back).store_array(&mut columns.far_origin[axis][packet]);
                reciprocal.store_array(&mut columns.near_reciprocal[axis][packet]);
                (reciprocal * (1.0 + SLACK)).store_array(&mut columns.far_reciprocal[axis][packet]);
            }
        }
        columns
    }

    /// The rays that meet the box of one child, as bits.
    #[inline(always)]
    pub(super) fn meet<S: Simd>(&self, simd: S, node: &[Row; NODE], lane: usize) -> u64 {
        let side = |row: usize| f32x8::splat(simd, node[row & 7].0[lane & 7]);
        let [nx, ny, nz] = self.near;
        let near = [side(nx), side(ny), side(nz)];
        let far = [side(nx ^ 1), side(ny ^ 1), side(nz ^ 1)];
        let mut met = 0;
        for packet in 0..self.packets.min(PACKETS) {
            let load = |column: &Column| f32x8::load_array_ref(simd, &column[packet]);
            let enter = |axis: usize| {
                (near[axis] - load(&self.near_origin[axis])) * load(&self.near_reciprocal[axis])
            };
            let leave = |axis: usize| {
                (far[axis] - load(&self.far_origin[axis])) * load(&self.far_reciprocal[axis])
            };
            let first = enter(0).max(enter(1)).max(enter(2).max(load(&self.t_min)));
            let last = leave(0).min(leave(1)).min(leave(2).min(load(&self.t_max)));
            met |= first.simd_le(last).to_bitmask() << (8 * packet);
        }
        met
    }

    /// The farthest that any ray still goes.
    #[inline(always)]
    pub(super) fn farthest<S: Simd>(&self, simd: S) -> f32 {
        let mut most = f32x8::load_array_ref(simd, &self.t_max[0]);
        for packet in 1..self.packets.min(PACKETS) {
            most = most.max(f32x8::load_array_ref(simd, &self.t_max[packet]));
        }
        highest(most)
    }
}

/// The least and the greatest of a column.
#[inline(always)]
pub(super) fn bounds<S: Simd>(simd: S, column: &Column, packets: usize) -> [f32; 2] {
    let first = f32x8::load_array_ref(simd, &column[0]);
    let (mut low, mut high) = (first, first);
    for packet in &column[1..packets.clamp(1, PACKETS)] {
        let next = f32x8::load_array_ref(simd, packet);
        (low, high) = (low.min(next), high.max(next));
    }
    [lowest(low), highest(high)]
}

/// The greatest of eight.
#[inline(always)]
pub(super) fn highest<S: Simd>(v: f32x8<S>) -> f32 {
    let [a, b, c, d, e, f, g, h] = v.to_array();
    a.max(b).max(c.max(d)).max(e.max(f).max(g.max(h)))
}

/// The least of eight.
#[inline(always)]
pub(super) fn lowest<S: Simd>(v: f32x8<S>) -> f32 {
    let [a, b, c, d, e, f, g, h] = v.to_array();
    a.min(b).min(c.min(d)).min(e.min(f).min(g.min(h)))
}
