//! The rays of a group against one box.

use fearless_simd::{Simd, f32x8, mask32x8, prelude::*};

use super::slabs::SLACK;
use crate::{
    Aabb,
    local::{Ray, Rays8},
    node8::{NODE, Row},
};

/// The most eights in a group.
pub(super) const PACKETS: usize = 8;

/// One number of each ray of a group.
pub(super) type Column = [[f32; 8]; PACKETS];

/// Zeros.
pub(super) const ZERO: Column = [[0.0; 8]; PACKETS];

/// The rays of a group: the bundle's eights, unchanged, and which of their rays belong to it.
#[derive(Clone, Copy)]
pub(super) struct Packets<'a> {
    /// At least one, at most [`PACKETS`].
    pub(super) rays: &'a [Rays8],
    /// The index of the first of them in the bundle.
    pub(super) first_eight: usize,
    /// One bit for each ray of the group; at least one is set. 0 for eights beyond `rays`.
    pub(super) lanes: [u32; PACKETS],
}

impl Packets<'_> {
    /// How many rays there are.
    pub(super) fn count(&self) -> usize {
        self.lanes.iter().map(|lanes| lanes.count_ones() as usize).sum()
    }

    /// The packet and the lane of the first ray.
    pub(super) fn first(&self) -> (usize, usize) {
        let packet = self.lanes.iter().position(|&lanes| lanes != 0).unwrap_or(0);
        (packet, self.lanes[packet].trailing_zeros() as usize & 7)
    }
}

/// What the box test needs of each ray. Lanes that do not belong to the group repeat its first ray, so that
/// they do not change the bounds.
#[derive(Debug)]
pub(super) struct Columns {
    near_origin: [Column; 3],
    far_origin: [Column; 3],
    near_reciprocal: [Column; 3],
    far_reciprocal: [Column; 3],
    t_min: Column,
    /// The distance of the best hit so far. −1 in lanes that do not belong to the group and for rays that
    /// are blocked already, so that they enter no box.
    pub(super) t_max: Column,
    pub(super) packets: usize,
    /// The rows of near sides.
    pub(super) near: [usize; 3],
    /// The bounds of all rays.
    pub(super) bounds: Bounds,
}

/// The bounds of a group's rays.
#[derive(Debug)]
pub(super) struct Bounds {
    /// The origins, padded.
    pub(super) start: Aabb,
    /// The end points; unspecified if a ray is infinite.
    pub(super) end: Aabb,
    /// The reciprocal directions.
    pub(super) reciprocal: Aabb,
    /// The least `t_min`.
    pub(super) t_min: f32,
    /// The greatest `t_max`.
    pub(super) longest: f32,
}

impl Columns {
    /// No rays.
    pub(super) const EMPTY: Self = Self {
        near_origin: [ZERO; 3],
        far_origin: [ZERO; 3],
        near_reciprocal: [ZERO; 3],
        far_reciprocal: [ZERO; 3],
        t_min: ZERO,
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

    /// Takes rays whose directions have the same signs. `t_max` is left to the caller.
    pub(super) fn fill<S: Simd>(&mut self, simd: S, group: &Packets<'_>) {
        simd.vectorize(
            #[inline(always)]
            || self.fill_at(simd, group),
        );
    }

    #[inline(always)]
    fn fill_at<S: Simd>(&mut self, simd: S, group: &Packets<'_>) {
        self.packets = group.rays.len().min(PACKETS);
        let (packet, lane) = group.first();
        let first = &group.rays[packet];
        let Ray { origin, dir, .. } = first.get(lane);
        let (origin, dir) = (origin.to_array(), dir.to_array());
        let negative = |axis: usize| usize::from(first.dir[axis][lane].is_sign_negative());
        self.near = [negative(0), 2 + negative(1), 4 + negative(2)];
        // Minima, and maxima with their signs changed, so that one minimum finds both.
        let most = f32x8::splat(simd, f32::INFINITY);
        let (mut starts, mut ends, mut reciprocals) = ([most; 8], [most; 8], [most; 8]);
        for (packet, rays) in group.rays.iter().enumerate().take(PACKETS) {
            let own = mask32x8::from_bitmask(simd, group.lanes[packet].into());
            let [x, y, z] = own_or_first3(simd, own, &rays.origin, origin);
            let [dx, dy, dz] = own_or_first3(simd, own, &rays.dir, dir);
            let t_min = own_or_first(simd, own, &rays.t_min, first.t_min[lane]);
            let end = own_or_first(simd, own, &rays.t_max, first.t_max[lane]);
            t_min.store_array(&mut self.t_min[packet]);
            starts[6] = starts[6].min(t_min);
            starts[7] = starts[7].min(-end);
            let pad = x.abs().max(y.abs()).max(z.abs()) * SLACK + 1e-24;
            for (axis, (origin, dir)) in [(x, dx), (y, dy), (z, dz)].into_iter().enumerate() {
                let (low, high) = (origin - pad, origin + pad);
                let back = self.near[axis] & 1 != 0;
                let (near, far) = if back { (low, high) } else { (high, low) };
                let reciprocal = (f32x8::splat(simd, 1.0) / dir)
                    .max(f32x8::splat(simd, -1e37))
                    .min(f32x8::splat(simd, 1e37));
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

    /// The rays that enter the box of one child, one bit each.
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

    /// The greatest distance at which any ray still looks for a hit.
    #[inline(always)]
    pub(super) fn farthest<S: Simd>(&self, simd: S) -> f32 {
        let mut most = f32x8::load_array_ref(simd, &self.t_max[0]);
        for packet in &self.t_max[1..self.packets.clamp(1, PACKETS)] {
            most = most.max(f32x8::load_array_ref(simd, packet));
        }
        highest(most)
    }
}

/// The numbers of the rays in `own`, and `first` in the other lanes.
#[inline(always)]
pub(super) fn own_or_first<S: Simd>(
    simd: S,
    own: mask32x8<S>,
    lanes: &[f32; 8],
    first: f32,
) -> f32x8<S> {
    own.select(f32x8::load_array_ref(simd, lanes), f32x8::splat(simd, first))
}

/// [`own_or_first`] of three numbers of each ray.
#[inline(always)]
pub(super) fn own_or_first3<S: Simd>(
    simd: S,
    own: mask32x8<S>,
    [x, y, z]: &[[f32; 8]; 3],
    first: [f32; 3],
) -> [f32x8<S>; 3] {
    [
        own_or_first(simd, own, x, first[0]),
        own_or_first(simd, own, y, first[1]),
        own_or_first(simd, own, z, first[2]),
    ]
}

/// Transposes an 8 × 8 matrix by interleaving its halves three times.
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

/// The minimum of each row.
#[inline(always)]
pub(super) fn least<S: Simd>(rows: [f32x8<S>; 8]) -> [f32; 8] {
    let [a, b, c, d, e, f, g, h] = turned(rows);
    a.min(b).min(c.min(d)).min(e.min(f).min(g.min(h))).to_array()
}

/// The maximum of eight lanes.
#[inline(always)]
pub(crate) fn highest<S: Simd>(v: f32x8<S>) -> f32 {
    v.reduce_max()
}

/// The minimum of eight lanes.
#[inline(always)]
pub(crate) fn lowest<S: Simd>(v: f32x8<S>) -> f32 {
    v.reduce_min()
}

/// A box from minima and maxima with their signs changed.
#[inline(always)]
fn aabb([x, y, z, nx, ny, nz, ..]: [f32; 8]) -> Aabb {
    Aabb { lo: [x, y, z].into(), hi: [-nx, -ny, -nz].into() }
}
