//! Rays that start close together and go everywhere, as those of ambient occlusion: whether each hits a sphere.
//!
//! As they come, neighbours go different ways. Put in order of their directions, they are beams of up to 64 rays.
//! A node is tested once for a beam, by intervals; a child that the beam may enter is tested once more when its turn
//! comes, against the rays themselves that entered its parent and are not blocked yet. So a beam enters every box that one
//! of its rays would enter alone, and most boxes are met while many of its rays are left. Where surfaces lie too far
//! apart for that, beams give up, and rays are traced one by one.

use fearless_simd::{Simd, f32x8, mask32x8, prelude::*, u32x8};

use super::{
    World,
    columns::{least, lowest},
    pause::Pause,
    sheared::packets,
    slabs::SLACK,
    waiting::{Waiting, key_of_child, push},
};
use crate::{
    lanes,
    level::Kernel,
    local::Rays8,
    node8::{NODE, Ref, Row, rows},
    primitives::{
        sphere::{BLOCK, Closest8},
        splat3,
    },
};

/// Rays that are put in order together, in eights.
pub(super) const TOGETHER: usize = 512;
/// The most rays of a beam.
const MOST: usize = 64;
/// A beam gives up after so many nodes and leaves per ray.
const PATIENCE: u32 = 4;
/// Beams of fewer rays are left to be traced one by one.
const FEWEST: usize = 4;
/// Up to so many rays are tested one by one in a leaf, each against eight spheres.
const FEW: u32 = 4;
/// Kinds of directions: eight octants, each cut in 16 triangles, of 32 numbers.
const CELLS: usize = 256;
/// A number of each ray of a beam.
type Column = [[f32; 8]; MOST / 8];

/// Rays put in order, and memory for a beam.
pub(super) struct Memory {
    pause: Pause,
    /// The cell of each ray as they come, if it is to be traced.
    cells: Vec<u16>,
    /// Which rays they are, in order.
    order: Vec<u16>,
    beam: Numbers,
    entries: Vec<Entry>,
}

/// The rays of a beam side by side. Behind the last are rays of earlier beams.
struct Numbers {
    origin: [Column; 3],
    dir: [Column; 3],
    reciprocal: [Column; 3],
    /// 1 / d·d.
    scale: Column,
    t_min: Column,
    t_max: Column,
}

impl Memory {
    /// No rays.
    pub(super) const EMPTY: Self = Self {
        pause: Pause::NONE,
        cells: Vec::new(),
        order: Vec::new(),
        beam: Numbers {
            origin: [[[0.0; 8]; MOST / 8]; 3],
            dir: [[[0.0; 8]; MOST / 8]; 3],
            reciprocal: [[[0.0; 8]; MOST / 8]; 3],
            scale: [[0.0; 8]; MOST / 8],
            t_min: [[0.0; 8]; MOST / 8],
            t_max: [[0.0; 8]; MOST / 8],
        },
        entries: Vec::new(),
    };
}

impl Numbers {
    /// Eight rays.
    #[inline(always)]
    fn eight<S: Simd>(&self, simd: S, packet: usize) -> Closest8<S> {
        let packet = packet & 7;
        Closest8 {
            origin: eight_of(simd, &self.origin, packet),
            dir: eight_of(simd, &self.dir, packet),
            scale: load(simd, &self.scale[packet]),
            t_min: load(simd, &self.t_min[packet]),
            t_max: load(simd, &self.t_max[packet]),
        }
    }

    /// One ray in all lanes.
    #[inline(always)]
    fn one<S: Simd>(&self, simd: S, ray: usize) -> Closest8<S> {
        let (packet, lane) = ((ray / 8) & 7, ray & 7);
        Closest8 {
            origin: one_of(simd, &self.origin, packet, lane),
            dir: one_of(simd, &self.dir, packet, lane),
            scale: f32x8::splat(simd, self.scale[packet][lane]),
            t_min: f32x8::splat(simd, self.t_min[packet][lane]),
            t_max: f32x8::splat(simd, self.t_max[packet][lane]),
        }
    }
}

// No closures: they would become calls.

#[inline(always)]
fn eight_of<S: Simd>(simd: S, [x, y, z]: &[Column; 3], packet: usize) -> [f32x8<S>; 3] {
    [load(simd, &x[packet]), load(simd, &y[packet]), load(simd, &z[packet])]
}

#[inline(always)]
fn one_of<S: Simd>(simd: S, [x, y, z]: &[Column; 3], packet: usize, lane: usize) -> [f32x8<S>; 3] {
    splat3(simd, [x[packet][lane], y[packet][lane], z[packet][lane]])
}

/// A node or leaf to visit. `key`: entry distance in the upper half, [`Ref`] in the lower. `rays`: those that enter its
/// parent. `parent`: where its box is, as the row of the node times eight plus the lane; [`NO_BOX`]: all rays enter.
#[derive(Clone, Copy)]
struct Entry {
    key: u64,
    rays: u64,
    parent: u32,
}

impl Waiting for Entry {
    #[inline(always)]
    fn key(self) -> u64 {
        self.key
    }
}

/// Of the root, and of boxes in which all rays start.
const NO_BOX: u32 = u32::MAX;

/// Traces the rays `lanes`, a bit each, of a tree of spheres alone. Those that are left in them have to be traced one by one.
pub(super) struct Scattered<'a> {
    pub(super) world: &'a World<'a>,
    pub(super) root: Ref,
    /// At most [`TOGETHER`].
    pub(super) rays: &'a [Rays8],
    pub(super) lanes: &'a mut [u32],
    pub(super) blocked: &'a mut [u32],
    pub(super) memory: &'a mut Memory,
}

impl Kernel for Scattered<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { world, root, rays, lanes, blocked, memory } = self;
        if memory.pause.skips() {
            return;
        }
        let ends = put_in_order(simd, rays, lanes, memory);
        lanes.fill(0);
        let (mut start, mut tried, mut given_up) = (0, 0, 0);
        for (cell, &end) in ends.iter().enumerate() {
            let end = usize::from(end);
            while start < end {
                let count = (end - start).min(MOST);
                let Memory { order, beam, entries, .. } = &mut *memory;
                let order = &order[start..start + count];
                start += count;
                let all = u64::MAX >> (MOST - count);
                if count < FEWEST || !is_worth_while(tried, given_up) {
                    mark(lanes, order, all);
                    continue;
                }
                let Traced { hit, known } = Beam::new(simd, cell, order, rays, beam)
                    .trace(simd, world, root, beam, entries);
                tried += 1;
                given_up += u32::from(known != u64::MAX);
                mark(lanes, order, all & !known);
                mark(blocked, order, hit);
            }
        }
        memory.pause.note(is_worth_while(tried, given_up));
    }
}

/// Sets the bits of some of the rays of a beam, `which`, in the eights that they come from.
#[inline(always)]
fn mark(eights: &mut [u32], order: &[u16], mut which: u64) {
    while which != 0 {
        let from = order[which.trailing_zeros() as usize];
        which &= which - 1;
        eights[usize::from(from / 8)] |= 1 << (from % 8);
    }
}

/// Puts rays in order of their cells; where each cell ends.
#[inline(always)]
fn put_in_order<S: Simd>(
    simd: S,
    rays: &[Rays8],
    wanted: &[u32],
    memory: &mut Memory,
) -> [u16; CELLS] {
    let Memory { cells, order, entries, .. } = memory;
    cells.resize(8 * TOGETHER, 0);
    order.resize(8 * TOGETHER, 0);
    entries.resize(super::STACK, Entry { key: 0, rays: 0, parent: NO_BOX });
    let mut counts = [0_u16; CELLS];
    for ((rays, &wanted), cells) in rays.iter().zip(wanted).zip(cells.as_chunks_mut::<8>().0) {
        if wanted == 0 {
            continue;
        }
        let all: [u32; 8] = cells_of(simd, rays).into();
        for lane in lanes(wanted) {
            let cell = all[lane & 7] as usize % CELLS;
            cells[lane & 7] = cell as u16;
            counts[cell] += 1;
        }
    }
    let mut next = [0; CELLS];
    let mut sum = 0;
    for (next, count) in next.iter_mut().zip(counts) {
        *next = sum;
        sum += count;
    }
    for (i, (cells, &wanted)) in cells.as_chunks::<8>().0.iter().zip(wanted).enumerate() {
        for lane in lanes(wanted) {
            let lane = lane & 7;
            let next = &mut next[usize::from(cells[lane]) % CELLS];
            order[usize::from(*next)] = (8 * i + lane) as u16;
            *next += 1;
        }
    }
    next
}

/// The cell of each direction. The signs of its coordinates are the three upper bits.
#[inline(always)]
fn cells_of<S: Simd>(simd: S, rays: &Rays8) -> u32x8<S> {
    let [x, y, z] = &rays.dir;
    let (x, y, z) = (load(simd, x), load(simd, y), load(simd, z));
    let signs = sign(x) * 4 + sign(y) * 2 + sign(z);
    // On the octahedron: three numbers whose sum is 4, in whole steps.
    let scale = f32x8::splat(simd, 3.9999) / (x.abs() + y.abs() + z.abs());
    let i: u32x8<S> = (x.abs() * scale).to_int();
    let j: u32x8<S> = (y.abs() * scale).to_int();
    let k: u32x8<S> = (z.abs() * scale).to_int();
    let points_down = (i + j + k) & 1;
    signs * 32 + ((i * 8 + j * 2 + points_down) & 31)
}

/// 1 where a number is negative.
#[inline(always)]
fn sign<S: Simd>(v: f32x8<S>) -> u32x8<S> {
    v.bitcast::<u32x8<S>>() >> 31
}

/// Whether most of the beams that were tried reached their end.
fn is_worth_while(tried: u32, given_up: u32) -> bool {
    given_up < 8 || given_up < tried / 4
}

/// What is known of the rays of a beam, a bit each.
struct Traced {
    /// Those that hit something.
    hit: u64,
    /// Those of which it is known whether they do: all, but where the beam gave up.
    known: u64,
}

/// Rays of one cell that follow one another.
struct Beam<S: Simd> {
    /// A bit for each.
    all: u64,
    negative: [bool; 3],
    /// How far origins are moved against rounding.
    pad: f32,
    t_min: f32,
    t_max: f32,
    /// The origins that enter boxes first and leave them last, and the reciprocal directions: those of
    /// [`Frustum`](super::frustum::Frustum).
    near_origin: [f32; 3],
    far_origin: [f32; 3],
    reciprocal: [[f32; 2]; 3],
    /// The middle of the origins, and of the directions.
    middle: [f32x8<S>; 3],
    along: [f32x8<S>; 3],
    /// No ray starts farther from the middle.
    width: f32,
    /// The tangent of the greatest angle to the middle direction.
    spread: f32,
}

impl<S: Simd> Beam<S> {
    #[inline(always)]
    fn new(simd: S, cell: usize, order: &[u16], rays: &[Rays8], beam: &mut Numbers) -> Self {
        let count = order.len();
        let all = u64::MAX >> (MOST - count);
        let negative = [cell & 128 != 0, cell & 64 != 0, cell & 32 != 0];
        for (to, &from) in order.iter().enumerate() {
            let (rays, from) = (&rays[usize::from(from / 8)], usize::from(from) & 7);
            let (packet, to) = ((to / 8) & 7, to & 7);
            for axis in 0..3 {
                beam.origin[axis][packet][to] = rays.origin[axis][from];
                beam.dir[axis][packet][to] = rays.dir[axis][from];
            }
            beam.t_min[packet][to] = rays.t_min[from];
            beam.t_max[packet][to] = rays.t_max[from];
        }
        // Minima, and maxima with their signs changed, as in `Columns`.
        let most = f32x8::splat(simd, f32::INFINITY);
        let one = f32x8::splat(simd, 1.0);
        let (mut starts, mut directions, mut reciprocals) = ([most; 8], [most; 8], [most; 8]);
        for packet in 0..count.div_ceil(8) {
            let own = mask32x8::from_bitmask(simd, all >> (8 * packet) & 0xff);
            let Closest8 { origin, dir, t_min, t_max, .. } = beam.eight(simd, packet);
            let [x, y, z] = dir;
            // The number that `Closest8::of_rays` finds.
            (one / (x * x + y * y + z * z)).store_array(&mut beam.scale[packet & 7]);
            for axis in 0..3 {
                let (origin, dir) = (origin[axis], dir[axis]);
                let reciprocal =
                    (one / dir).max(f32x8::splat(simd, -1e37)).min(f32x8::splat(simd, 1e37));
                reciprocal.store_array(&mut beam.reciprocal[axis][packet & 7]);
                starts[axis] = own.select(origin, most).min(starts[axis]);
                starts[axis + 3] = own.select(-origin, most).min(starts[axis + 3]);
                directions[axis] = own.select(dir, most).min(directions[axis]);
                directions[axis + 3] = own.select(-dir, most).min(directions[axis + 3]);
                reciprocals[axis] = own.select(reciprocal, most).min(reciprocals[axis]);
                reciprocals[axis + 3] = own.select(-reciprocal, most).min(reciprocals[axis + 3]);
            }
            starts[6] = own.select(t_min, most).min(starts[6]);
            starts[7] = own.select(-t_max, most).min(starts[7]);
        }
        let (starts, directions) = (least(starts), least(directions));
        let reciprocals = least(reciprocals);
        let middle = |of: &[f32; 8], axis: usize| 0.5 * (of[axis] - of[axis + 3]);
        let half = |axis: usize| 0.5 * (-starts[axis + 3] - starts[axis]);
        let [x, y, z] = [half(0), half(1), half(2)];
        let far = |axis: usize| starts[axis].abs().max(starts[axis + 3].abs());
        let pad = far(0).max(far(1)).max(far(2)) * SLACK + 1e-24;
        let width = (x * x + y * y + z * z).sqrt() * 1.001 + 4.0 * pad;
        let [x, y, z] = [middle(&directions, 0), middle(&directions, 1), middle(&directions, 2)];
        let length = (x * x + y * y + z * z).sqrt();
        let along = splat3(simd, [x / length, y / length, z / length]);
        let mut cosine = one;
        for packet in 0..count.div_ceil(8) {
            let own = mask32x8::from_bitmask(simd, all >> (8 * packet) & 0xff);
            let [x, y, z] = beam.eight(simd, packet).dir;
            let dot = x * along[0] + y * along[1] + z * along[2];
            cosine = own.select(dot, one).min(cosine);
        }
        let cosine = lowest(cosine) - 1e-5;
        // Of a beam this wide, which there is not where directions are unit, nothing is said.
        let spread =
            if cosine > 0.1 { (1.0 - cosine * cosine).sqrt() / cosine } else { f32::INFINITY };
        let (mut near_origin, mut far_origin, mut reciprocal) = ([0.0; 3], [0.0; 3], [[0.0; 2]; 3]);
        for axis in 0..3 {
            let (low, high) = (starts[axis] - pad, pad - starts[axis + 3]);
            let (near, far) = if negative[axis] { (low, high) } else { (high, low) };
            (near_origin[axis], far_origin[axis]) = (near, far);
            reciprocal[axis] = [reciprocals[axis], -reciprocals[axis + 3]];
        }
        Self {
            all,
            negative,
            pad,
            t_min: starts[6],
            t_max: -starts[7],
            near_origin,
            far_origin,
            reciprocal,
            middle: splat3(simd, [middle(&starts, 0), middle(&starts, 1), middle(&starts, 2)]),
            along,
            width,
            spread,
        }
    }

    /// Asks of all rays whether they hit something, unless that takes too long.
    #[inline(always)]
    fn trace(
        &self,
        simd: S,
        world: &World<'_>,
        root: Ref,
        beam: &Numbers,
        entries: &mut [Entry],
    ) -> Traced {
        let mut active = self.all;
        let mut patience = PATIENCE * active.count_ones();
        entries[0] = Entry { key: u64::from(root.0), rays: active, parent: NO_BOX };
        let mut depth = 1;
        while depth > 0 {
            if patience == 0 {
                let hit = self.all & !active;
                return Traced { hit, known: hit };
            }
            patience -= 1;
            depth -= 1;
            let Entry { key, rays, parent } = entries[depth];
            let mut rays = rays & active;
            if rays == 0 {
                continue;
            }
            if parent != NO_BOX {
                let node = rows(world.rows, parent as usize / 8);
                rays = self.enter(simd, node, parent as usize % 8, rays, beam);
                if rays == 0 {
                    continue;
                }
            }
            let at = Ref(key as u32);
            if at.kind().is_none() {
                depth = self.visit(simd, world, at, rays, entries, depth);
                continue;
            }
            active &= !self.leaf(simd, rows(world.rows, at.row()), rays, beam);
            if active == 0 {
                break;
            }
        }
        Traced { hit: self.all & !active, known: u64::MAX }
    }

    /// Those of some rays that enter the box of a child.
    #[inline(always)]
    fn enter(&self, simd: S, node: &[Row; NODE], lane: usize, rays: u64, beam: &Numbers) -> u64 {
        let side = |axis: usize, is_far: bool| {
            let is_high = self.negative[axis] != is_far;
            let pad = if is_high { self.pad } else { -self.pad };
            f32x8::splat(simd, node[2 * axis + usize::from(is_high)].0[lane & 7] + pad)
        };
        let nears = [side(0, false), side(1, false), side(2, false)];
        let fars = [side(0, true), side(1, true), side(2, true)];
        let mut met = 0;
        let mut left = rays;
        while left != 0 {
            let packet = left.trailing_zeros() as usize / 8;
            left &= !(0xff << (8 * packet));
            let mut first = f32x8::splat(simd, self.t_min);
            let mut last = f32x8::splat(simd, self.t_max);
            for axis in 0..3 {
                let origin = load(simd, &beam.origin[axis][packet & 7]);
                let reciprocal = load(simd, &beam.reciprocal[axis][packet & 7]);
                first = first.max((nears[axis] - origin) * reciprocal);
                last = last.min((fars[axis] - origin) * reciprocal);
            }
            met |= first.simd_le(last * (1.0 + SLACK)).to_bitmask() << (8 * packet);
        }
        met & rays
    }

    /// Pushes the children of a node that some ray may enter, with the nearest on top.
    #[inline(always)]
    fn visit(
        &self,
        simd: S,
        world: &World<'_>,
        at: Ref,
        rays: u64,
        entries: &mut [Entry],
        bottom: usize,
    ) -> usize {
        let node: &[Row; NODE] = rows(world.rows, at.row());
        let mut first = f32x8::splat(simd, self.t_min);
        let mut last = f32x8::splat(simd, self.t_max);
        // No closures: they would become calls.
        for axis in 0..3 {
            let near = 2 * axis + usize::from(self.negative[axis]);
            let [low, high] = self.reciprocal[axis];
            let way = load(simd, &node[near & 7].0) - self.near_origin[axis];
            first = first.max((way * low).min(way * high));
            let way = load(simd, &node[(near ^ 1) & 7].0) - self.far_origin[axis];
            last = last.min((way * (low * (1.0 + SLACK))).max(way * (high * (1.0 + SLACK))));
        }
        let mut mask = first.simd_le(last).to_bitmask() as u32;
        let full = self.around(simd, node);
        let enter = first.to_array();
        let mut depth = bottom;
        while mask != 0 {
            let lane = mask.trailing_zeros() as usize & 7;
            mask &= mask - 1;
            let key = key_of_child(node, at.row(), lane, &enter);
            let is_full = full >> lane & 1 != 0;
            let parent = if is_full { NO_BOX } else { (at.row() * 8 + lane) as u32 };
            push(entries, bottom, &mut depth, Entry { key, rays, parent });
        }
        depth
    }

    /// The children of a node in whose boxes all rays start, a bit each.
    #[inline(always)]
    fn around(&self, simd: S, node: &[Row; NODE]) -> u32 {
        let mut full = mask32x8::from_bitmask(simd, 0xff);
        for axis in 0..3 {
            // Of the numbers of origins, moved outwards, the least and the greatest.
            let (a, b) = (self.near_origin[axis], self.far_origin[axis]);
            let (low, high) = if self.negative[axis] { (a, b) } else { (b, a) };
            full = full
                & load(simd, &node[2 * axis].0).simd_le(f32x8::splat(simd, low))
                & load(simd, &node[2 * axis + 1].0).simd_ge(f32x8::splat(simd, high));
        }
        full.to_bitmask() as u32
    }

    /// Those of some rays that hit a sphere of a leaf.
    #[inline(always)]
    fn leaf(&self, simd: S, block: &[Row; BLOCK], rays: u64, beam: &Numbers) -> u64 {
        let count = rays.count_ones();
        // For few rays, finding the spheres that all of them miss costs more than it saves.
        let mut spheres = if count <= FEW { 0 } else { self.near(simd, block) };
        let mut hit = 0;
        if count <= FEW || count <= spheres.count_ones() * packets(rays) {
            let mut left = rays;
            while left != 0 {
                let i = left.trailing_zeros() as usize & 63;
                left &= left - 1;
                hit |= u64::from(beam.one(simd, i).intersect(simd, block).0 != 0) << i;
            }
            return hit;
        }
        while spheres != 0 {
            let lane = spheres.trailing_zeros() as usize & 7;
            spheres &= spheres - 1;
            let mut left = rays & !hit;
            while left != 0 {
                let packet = left.trailing_zeros() as usize / 8;
                left &= !(0xff << (8 * packet));
                let eight = beam.eight(simd, packet);
                if let Some((met, _)) = eight.intersect_one(simd, block, lane) {
                    hit |= met.to_bitmask() << (8 * packet) & rays;
                }
            }
        }
        hit
    }

    /// The spheres of a leaf that some ray may hit, a bit each.
    ///
    /// A point that a ray comes to at `t` is off the line through the middle by no more than the ray's start is and what its
    /// angle makes of `t`, and a little less far along it.
    #[inline(always)]
    fn near(&self, simd: S, block: &[Row; BLOCK]) -> u32 {
        if self.spread == f32::INFINITY {
            return 0xff;
        }
        let row = |row: usize| load(simd, &block[row].0);
        let c = [row(0) - self.middle[0], row(1) - self.middle[1], row(2) - self.middle[2]];
        let [ax, ay, az] = self.along;
        let along = c[0] * ax + c[1] * ay + c[2] * az;
        let off = [c[0] - along * ax, c[1] - along * ay, c[2] - along * az];
        let off = off[0] * off[0] + off[1] * off[1] + off[2] * off[2];
        // What rounding can do here and in the kernel is far less than that.
        let rounding = (c[0].abs() + c[1].abs() + c[2].abs()) * 1e-5;
        let reach = row(3) * 1.001 + rounding + self.width;
        let most = reach + (along + reach) * self.spread;
        let far = off.simd_gt(most * most) | (along + reach).simd_lt(f32x8::splat(simd, 0.0));
        !far.to_bitmask() as u32 & 0xff
    }
}

#[inline(always)]
fn load<S: Simd>(simd: S, lanes: &[f32; 8]) -> f32x8<S> {
    f32x8::load_array_ref(simd, lanes)
}
