//! Rays that go the same way, together down the tree.
//!
//! Up to 64 rays whose directions agree in sign share one walk. A node is tested once for all of
//! them: with every origin in an interval and every reciprocal direction in another, interval
//! arithmetic bounds where the first ray could enter a child and the last could leave it. A leaf's
//! box is then tested against the rays themselves, eight at a time, and those it stops are tested
//! against its primitives one by one, just as in any other walk.
//!
//! The bounds are taken over the very numbers each ray's own test uses, and rounding is monotone; so
//! no child is left out that a ray alone would have entered, and hits are the same.

use std::marker::PhantomData;

use fearless_simd::{Simd, f32x8, prelude::*};

use super::{
    Best, World,
    leaves::{Content, Leaves},
    slabs::SLACK,
};
use crate::{
    Aabb, Hit, Ray,
    level::Kernel,
    node8::{NODE, REFS, Ref, Row, rows},
};

/// The most rays that go together.
pub(super) const GROUP: usize = 64;
const PACKETS: usize = GROUP / 8;
/// Nodes and leaves per ray after which a group gives up.
const PATIENCE: usize = 2;

/// One number of each ray, in packets of eight.
type Column = [[f32; 8]; PACKETS];

/// The rays by columns: what eight of them need to be tested against one box.
struct Columns {
    near_origin: [Column; 3],
    far_origin: [Column; 3],
    near_reciprocal: [Column; 3],
    far_reciprocal: [Column; 3],
    t_min: Column,
    /// The best hit so far; −1 where there is no ray, or a blocked one, so that no box is met.
    t_max: Column,
    packets: usize,
    near: [usize; 3],
}

/// Where a child is entered, what it is, and where its box is: row of the node times eight, plus lane.
#[derive(Clone, Copy)]
pub(super) struct Entry {
    key: u64,
    parent: u32,
}

impl Entry {
    /// Nothing.
    pub(super) const NONE: Self = Self { key: 0, parent: 0 };
}

/// Nodes and leaves to visit.
pub(super) type Entries = [Entry; super::STACK];

impl Columns {
    /// The columns of `rays`, which agree in the signs of their directions.
    #[inline(always)]
    fn new<S: Simd>(simd: S, rays: &[Ray], t_max: impl Fn(usize) -> f32) -> Self {
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
    fn meet<S: Simd>(&self, simd: S, node: &[Row; NODE], lane: usize) -> u64 {
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
    fn farthest<S: Simd>(&self, simd: S) -> f32 {
        let mut most = f32x8::load_array_ref(simd, &self.t_max[0]);
        for packet in 1..self.packets.min(PACKETS) {
            most = most.max(f32x8::load_array_ref(simd, &self.t_max[packet]));
        }
        highest(most)
    }
}

#[inline(always)]
fn highest<S: Simd>(v: f32x8<S>) -> f32 {
    let [a, b, c, d, e, f, g, h] = v.to_array();
    a.max(b).max(c.max(d)).max(e.max(f).max(g.max(h)))
}

#[inline(always)]
fn lowest<S: Simd>(v: f32x8<S>) -> f32 {
    let [a, b, c, d, e, f, g, h] = v.to_array();
    a.min(b).min(c.min(d)).min(e.min(f).min(g.min(h)))
}

/// All rays at once, against eight boxes.
struct Frustum<S: Simd> {
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
    fn new(simd: S, columns: &Columns) -> Self {
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
    fn backwards(simd: S, columns: &Columns, rays: &[Ray]) -> Option<Self> {
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
    fn meet(&self, simd: S, node: &[Row; NODE], t_max: f32x8<S>) -> (u32, f32x8<S>) {
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

/// The least and the greatest of a column.
#[inline(always)]
fn bounds<S: Simd>(simd: S, column: &Column, packets: usize) -> [f32; 2] {
    let first = f32x8::load_array_ref(simd, &column[0]);
    let (mut low, mut high) = (first, first);
    for packet in &column[1..packets.clamp(1, PACKETS)] {
        let next = f32x8::load_array_ref(simd, packet);
        (low, high) = (low.min(next), high.max(next));
    }
    [lowest(low), highest(high)]
}

/// Whether `rays` are worth going together: they agree in sign, and all but in direction.
pub(super) fn is_coherent(rays: &[Ray]) -> bool {
    const SPREAD: f32 = 0.05;
    let first = rays[0].dir;
    rays.len() >= 16 && rays.iter().all(|ray| (ray.dir - first).abs().max_element() <= SPREAD)
}

/// How many of the first rays agree in the signs of their directions.
pub(super) fn same_octant(rays: &[Ray]) -> usize {
    let Some(first) = rays.first() else { return 0 };
    let octant = first.dir.is_negative_bitmask();
    let others = rays.iter().take(GROUP);
    others.take_while(|ray| ray.dir.is_negative_bitmask() == octant).count()
}

/// The closest hit of each ray. On entry hits hold the best outside the tree. False: given up, with what
/// was found so far; the rays do not go together after all.
pub(super) struct ClosestTogether<'a, C> {
    pub(super) world: &'a World<'a>,
    pub(super) root: Ref,
    pub(super) rays: &'a [Ray],
    pub(super) hits: &'a mut [Hit],
    pub(super) entries: &'a mut Entries,
    pub(super) content: PhantomData<C>,
}

impl<C: Content> Kernel for ClosestTogether<'_, C> {
    type Output = bool;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> bool {
        let Self { world, root, rays, hits, entries, .. } = self;
        let mut columns = Columns::new(simd, rays, |i| hits[i].t);
        let frustum = Frustum::new(simd, &columns);
        let mut farthest = columns.farthest(simd);
        let mut patience = PATIENCE * rays.len();
        entries[0] = Entry { key: u64::from(root.0), parent: 0 };
        let mut depth = 1;
        while depth > 0 {
            if patience == 0 {
                return false;
            }
            patience -= 1;
            depth -= 1;
            let Entry { key, parent } = entries[depth];
            if f32::from_bits((key >> 32) as u32) > farthest {
                continue;
            }
            let at = Ref(key as u32);
            if at.kind().is_none() {
                depth = visit(simd, world, &frustum, at, farthest, entries, depth);
                continue;
            }
            let node = rows(world.rows, parent as usize / 8);
            let mut met = columns.meet(simd, node, parent as usize % 8);
            if met == 0 {
                continue;
            }
            while met != 0 {
                let i = met.trailing_zeros() as usize;
                met &= met - 1;
                let (ray, hit) = (&rays[i], &mut hits[i]);
                let leaves = C::Leaves::new(simd, ray);
                let mut best = Best(*hit);
                leaves.offer(simd, world, ray, at, &mut best);
                *hit = best.0;
                columns.t_max[i / 8][i % 8] = best.0.t;
            }
            farthest = columns.farthest(simd);
        }
        true
    }
}

/// Puts the children of a node that some ray may enter on the stack, nearest on top.
#[inline(always)]
fn visit<S: Simd>(
    simd: S,
    world: &World<'_>,
    frustum: &Frustum<S>,
    at: Ref,
    farthest: f32,
    entries: &mut Entries,
    bottom: usize,
) -> usize {
    let node: &[Row; NODE] = rows(world.rows, at.row());
    let (mut mask, enter) = frustum.meet(simd, node, f32x8::splat(simd, farthest));
    let enter = enter.to_array();
    let mut depth = bottom;
    while mask != 0 {
        let lane = mask.trailing_zeros() as usize & 7;
        mask &= mask - 1;
        let child = Ref(node[REFS].bits(lane)).from(at.row());
        let key = u64::from(enter[lane].to_bits()) << 32 | u64::from(child.0);
        let mut place = depth;
        while place > bottom && entries[place - 1].key < key {
            entries[place] = entries[place - 1];
            place -= 1;
        }
        entries[place] = Entry { key, parent: (at.row() * 8 + lane) as u32 };
        depth += 1;
    }
    depth
}

/// Whether each ray hits anything; those already blocked are left out. False: given up, as above.
pub(super) struct AnyTogether<'a, C> {
    pub(super) world: &'a World<'a>,
    pub(super) root: Ref,
    pub(super) rays: &'a [Ray],
    pub(super) blocked: &'a mut [bool],
    pub(super) entries: &'a mut Entries,
    pub(super) content: PhantomData<C>,
}

impl<C: Content> Kernel for AnyTogether<'_, C> {
    type Output = bool;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> bool {
        let Self { world, root, rays, blocked, entries, .. } = self;
        let end = |i: usize| if blocked[i] { -1.0 } else { rays[i].t_max };
        let mut columns = Columns::new(simd, rays, end);
        let frustum = Frustum::backwards(simd, &columns, rays)
            .unwrap_or_else(|| Frustum::new(simd, &columns));
        let mut farthest = columns.farthest(simd);
        let mut patience = PATIENCE * rays.len();
        entries[0] = Entry { key: u64::from(root.0), parent: 0 };
        let mut depth = 1;
        while depth > 0 {
            if patience == 0 {
                return false;
            }
            patience -= 1;
            depth -= 1;
            let Entry { key, parent } = entries[depth];
            if farthest < 0.0 {
                return true;
            }
            let at = Ref(key as u32);
            if at.kind().is_none() {
                depth = visit(simd, world, &frustum, at, farthest, entries, depth);
                continue;
            }
            let node = rows(world.rows, parent as usize / 8);
            let mut met = columns.meet(simd, node, parent as usize % 8);
            let mut changed = false;
            while met != 0 {
                let i = met.trailing_zeros() as usize;
                met &= met - 1;
                if C::Leaves::new(simd, &rays[i]).any(simd, world, &rays[i], at) {
                    blocked[i] = true;
                    columns.t_max[i / 8][i % 8] = -1.0;
                    changed = true;
                }
            }
            if changed {
                farthest = columns.farthest(simd);
            }
        }
        true
    }
}
