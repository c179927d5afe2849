//! Up to 64 rays side by side, against one box.

use fearless_simd::{Simd, f32x8, prelude::*};

use super::slabs::SLACK;
use crate::{
    Aabb,
    local::Ray,
    node8::{NODE, Row},
};

/// The most rays side by side.
pub(super) const GROUP: usize = 64;
/// Their packets.
pub(super) const PACKETS: usize = GROUP / 8;

/// One number of each ray, in packets of eight.
pub(super) type Column = [[f32; 8]; PACKETS];

/// Zeros.
pub(super) const ZERO: Column = [[0.0; 8]; PACKETS];

/// The rays by columns: what eight of them need to be tested against one box.
#[derive(Debug)]
pub(super) struct Columns {
    pub(super) origin: [Column; 3],
    pub(super) dir: [Column; 3],
    near_origin: [Column; 3],
    far_origin: [Column; 3],
    near_reciprocal: [Column; 3],
    far_reciprocal: [Column; 3],
    pub(super) t_min: Column,
    /// Where the rays end.
    pub(super) end: Column,
    /// The best hit so far; −1 where there is no ray, or a blocked one, so that no box is met.
    pub(super) t_max: Column,
    pub(super) packets: usize,
    /// The rows of near sides.
    pub(super) near: [usize; 3],
    /// What the numbers lie between.
    pub(super) bounds: Bounds,
}

/// The least and the greatest numbers of all rays.
#[derive(Debug)]
pub(super) struct Bounds {
    /// Of their origins, moved back and on.
    pub(super) start: Aabb,
    /// Of the points where they end; without meaning if one has no end.
    pub(super) end: Aabb,
    /// Of their reciprocal directions.
    pub(super) reciprocal: Aabb,
    /// The least beginning.
    pub(super) t_min: f32,
    /// The greatest length.
    pub(super) longest: f32,
}

impl Columns {
    /// No rays.
    pub(super) const EMPTY: Self = Self {
        origin: [ZERO; 3],
        dir: [ZERO; 3],
        near_origin: [ZERO; 3],
        far_origin: [ZERO; 3],
        near_reciprocal: [ZERO; 3],
        far_reciprocal: [ZERO; 3],
        t_min: ZERO,
        end: ZERO,
        t_max: ZERO,
        packets: 0,
        near: [0; 3],
        bounds: Bounds {
            start: Aabb::EMPTY,
            end: Aabb::EMPTY,
            reciprocal: Aabb::EMPTY,
            t_min: 0.0,
            longest: 0.0,
        },
    };

    /// Takes `rays`, which agree in the signs of their directions; how far each has to go is not known yet.
    pub(super) fn fill<S: Simd>(&mut self, simd: S, rays: &[Ray]) {
        simd.vectorize(
            #[inline(always)]
            || self.fill_at(simd, rays),
        );
    }

    #[inline(always)]
    fn fill_at<S: Simd>(&mut self, simd: S, rays: &[Ray]) {
        self.packets = rays.len().div_ceil(8).min(PACKETS);
        let negative = rays[0].dir.is_negative_bitmask() as usize;
        self.near = [negative & 1, 2 + (negative >> 1 & 1), 4 + (negative >> 2 & 1)];
        // Lows, and highs with their signs turned: the least of those is the greatest.
        let most = f32x8::splat(simd, f32::INFINITY);
        let (mut starts, mut ends, mut reciprocals) = ([most; 8], [most; 8], [most; 8]);
        for packet in 0..self.packets {
            let [x, y, z, t_min, dx, dy, dz, end] = eight(simd, rays, packet);
            t_min.store_array(&mut self.t_min[packet]);
            end.store_array(&mut self.end[packet]);
            starts[6] = starts[6].min(t_min);
            starts[7] = starts[7].min(-end);
            let pad = x.abs().max(y.abs()).max(z.abs()) * SLACK + 1e-24;
            for (axis, (origin, dir)) in [(x, dx), (y, dy), (z, dz)].into_iter().enumerate() {
                let (low, high) = (origin - pad, origin + pad);
                let (near, far) = if negative >> axis & 1 != 0 { (low, high) } else { (high, low) };
                let reciprocal = (f32x8::splat(simd, 1.0) / dir)
                    .max(f32x8::splat(simd, -1e37))
                    .min(f32x8::splat(simd, 1e37));
                origin.store_array(&mut self.origin[axis][packet]);
                dir.store_array(&mut self.dir[axis][packet]);
                near.store_array(&mut self.near_origin[axis][packet]);
                far.store_array(&mut self.far_origin[axis][packet]);
                reciprocal.store_array(&mut self.near_reciprocal[axis][packet]);
                (reciprocal * (1.0 + SLACK)).store_array(&mut self.far_reciprocal[axis][packet]);
                let at = origin + end * dir;
                starts[axis] = starts[axis].min(low);
                starts[axis + 3] = starts[axis + 3].min(-high);
                ends[axis] = ends[axis].min(at);
                ends[axis + 3] = ends[axis + 3].min(-at);
                reciprocals[axis] = reciprocals[axis].min(reciprocal);
                reciprocals[axis + 3] = reciprocals[axis + 3].min(-reciprocal);
            }
        }
        let starts = least(starts);
        self.bounds = Bounds {
            start: aabb(starts),
            end: aabb(least(ends)),
            reciprocal: aabb(least(reciprocals)),
            t_min: starts[6],
            longest: -starts[7],
        };
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
        for packet in &self.t_max[1..self.packets.clamp(1, PACKETS)] {
            most = most.max(f32x8::load_array_ref(simd, packet));
        }
        highest(most)
    }
}

/// Eight rays, number by number. The last packet is filled up with the last ray.
#[inline(always)]
fn eight<S: Simd>(simd: S, rays: &[Ray], packet: usize) -> [f32x8<S>; 8] {
    let row = |i: usize| {
        let Ray { origin: o, t_min, dir: d, t_max } = rays[(8 * packet + i).min(rays.len() - 1)];
        f32x8::simd_from(simd, [o.x, o.y, o.z, t_min, d.x, d.y, d.z, t_max])
    };
    turned([row(0), row(1), row(2), row(3), row(4), row(5), row(6), row(7)])
}

/// Rows as columns. As with cards: cut in halves that are then merged, three times.
#[inline(always)]
fn turned<S: Simd>(mut rows: [f32x8<S>; 8]) -> [f32x8<S>; 8] {
    for _ in 0..3 {
        let [a, b, c, d, e, f, g, h] = rows;
        let [(a, b), (c, d), (e, f), (g, h)] =
            [a.interleave(e), b.interleave(f), c.interleave(g), d.interleave(h)];
        rows = [a, b, c, d, e, f, g, h];
    }
    rows
}

/// The least number of each row.
#[inline(always)]
pub(super) fn least<S: Simd>(rows: [f32x8<S>; 8]) -> [f32; 8] {
    let [a, b, c, d, e, f, g, h] = turned(rows);
    a.min(b).min(c.min(d)).min(e.min(f).min(g.min(h))).to_array()
}

/// The greatest of eight.
#[inline(always)]
pub(super) fn highest<S: Simd>(v: f32x8<S>) -> f32 {
    v.reduce_max()
}

/// The least of eight.
#[inline(always)]
pub(super) fn lowest<S: Simd>(v: f32x8<S>) -> f32 {
    v.reduce_min()
}

/// From lows and turned highs.
#[inline(always)]
fn aabb([x, y, z, nx, ny, nz, ..]: [f32; 8]) -> Aabb {
    Aabb { lo: [x, y, z].into(), hi: [-nx, -ny, -nz].into() }
}
