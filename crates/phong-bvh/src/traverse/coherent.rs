//! Groups of coherent rays, traversed together.
//!
//! A group has up to 64 rays, from up to eight eights, whose directions have the same signs. A node is
//! tested once for the whole group, by a [`Frustum`]. The box of a leaf is then tested against the rays
//! themselves, eight at a time, and only the rays that enter it are tested against its primitives. A group
//! enters every box that one of its rays would enter alone, so the hits are the same.

use std::marker::PhantomData;

use fearless_simd::{Simd, f32x8, mask32x8, prelude::*, u32x8};

use super::{
    World,
    columns::{Columns, PACKETS, Packets},
    framed::{Entered, Framed},
    frustum::Frustum,
    leaves::{Content, Leaves},
    pause::Pause,
    query::Query,
    sheared::Sheared,
    waiting::{Waiting, key_of_child, push},
};
use crate::{
    level::Kernel,
    local::Rays8,
    node8::{Kind, NODE, Ref, Row, rows},
};

/// A group gives up after so many nodes and leaves per ray.
const PATIENCE: usize = 2;

/// An entry of the stack. `key`: entry distance in the upper half, [`Ref`] in the lower. `parent`: where
/// the box is, as the row of the node times eight plus the lane.
#[derive(Clone, Copy)]
struct Entry {
    key: u64,
    parent: u32,
}

impl Waiting for Entry {
    #[inline(always)]
    fn key(self) -> u64 {
        self.key
    }
}

impl Entry {
    /// Nothing.
    const NONE: Self = Self { key: 0, parent: 0 };
}

/// Memory for a group.
pub(super) struct Group {
    pause: Pause,
    columns: Columns,
    sheared: Sheared,
    framed: Framed,
    entries: Entries,
}

impl Group {
    /// No rays.
    pub(super) const EMPTY: Self = Self {
        pause: Pause::NONE,
        columns: Columns::EMPTY,
        sheared: Sheared::EMPTY,
        framed: Framed::EMPTY,
        entries: [Entry::NONE; _],
    };
}

/// Nodes and leaves to visit.
type Entries = [Entry; super::STACK];

/// Groups of fewer rays cost more than they save.
const FEWEST: usize = 16;
/// The most by which directions within a group may differ from the first one, along each axis.
const SPREAD: f32 = 0.05;

/// Traces groups of rays, each out of up to [`PACKETS`] eights. The rays that are left in `lanes` then have
/// to be traced one by one.
pub(super) struct Groups<'a, E, C> {
    pub(super) world: &'a World<'a>,
    pub(super) root: Ref,
    pub(super) rays: &'a [Rays8],
    /// The rays that have to be traced, a bit each.
    pub(super) lanes: &'a mut [u32],
    pub(super) query: &'a mut E,
    pub(super) group: &'a mut Group,
    pub(super) content: PhantomData<C>,
}

impl<E: Query, C: Content> Kernel for Groups<'_, E, C> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { world, root, rays, lanes, query, group, .. } = self;
        let chunks = rays.chunks(PACKETS).zip(lanes.chunks_mut(PACKETS));
        for (i, (rays, lanes)) in chunks.enumerate() {
            let mut left = [0; PACKETS];
            left[..lanes.len()].copy_from_slice(lanes);
            let signs = signs(simd, rays);
            loop {
                let packets = Packets { rays, first_eight: i * PACKETS, lanes: left };
                if packets.count() < FEWEST {
                    break;
                }
                let packets = same_octant(packets, &signs);
                for (left, taken) in left.iter_mut().zip(packets.lanes) {
                    *left &= !taken;
                }
                if packets.count() < FEWEST || !is_coherent(simd, &packets) || group.pause.skips() {
                    continue;
                }
                let together = Together::<E, C> { world, root, packets, content: PhantomData };
                let done = together.run(simd, query, group);
                group.pause.note(done);
                if done {
                    for (lanes, done) in lanes.iter_mut().zip(packets.lanes) {
                        *lanes &= !done;
                    }
                }
            }
        }
    }
}

/// The signs of directions along each axis, one bit each: 1 is negative.
#[inline(always)]
fn signs<S: Simd>(simd: S, rays: &[Rays8]) -> [[u32; 3]; PACKETS] {
    let mut signs = [[0; 3]; PACKETS];
    for (rays, signs) in rays.iter().zip(&mut signs) {
        for (dir, signs) in rays.dir.iter().zip(signs) {
            let bits = f32x8::load_array_ref(simd, dir).bitcast::<u32x8<S>>();
            let sign = u32x8::splat(simd, 1 << 31);
            *signs = bits.simd_ge(sign).to_bitmask() as u32;
        }
    }
    signs
}

/// The rays whose directions have the same signs as that of the first.
#[inline(always)]
fn same_octant<'a>(packets: Packets<'a>, signs: &[[u32; 3]; PACKETS]) -> Packets<'a> {
    let (packet, lane) = packets.first();
    let [x, y, z] = signs[packet];
    // All bits set where it is negative.
    let negative = |sign: u32| 0_u32.wrapping_sub(sign >> lane & 1);
    let [x, y, z] = [negative(x), negative(y), negative(z)];
    let mut lanes = packets.lanes;
    for (lanes, signs) in lanes.iter_mut().zip(signs) {
        *lanes &= !((signs[0] ^ x) | (signs[1] ^ y) | (signs[2] ^ z));
    }
    Packets { lanes, ..packets }
}

/// Whether rays with the same signs are coherent enough for a group: their directions are almost equal.
#[inline(always)]
fn is_coherent<S: Simd>(simd: S, packets: &Packets<'_>) -> bool {
    let (packet, lane) = packets.first();
    let first = &packets.rays[packet];
    for (rays, &lanes) in packets.rays.iter().zip(&packets.lanes) {
        let mut most = f32x8::splat(simd, 0.0);
        for axis in 0..3 {
            let dir = f32x8::load_array_ref(simd, &rays.dir[axis]);
            most = most.max((dir - first.dir[axis][lane]).abs());
        }
        let near = most.simd_le(f32x8::splat(simd, SPREAD)).to_bitmask() as u32;
        if lanes & !near != 0 {
            return false;
        }
    }
    true
}

/// Traces one group.
struct Together<'a, E, C> {
    world: &'a World<'a>,
    root: Ref,
    packets: Packets<'a>,
    content: PhantomData<(E, C)>,
}

impl<E: Query, C: Content> Together<'_, E, C> {
    /// Returns false where it gave up: the rays spread too far. What was found so far is kept.
    #[inline(always)]
    fn run<S: Simd>(self, simd: S, query: &mut E, group: &mut Group) -> bool {
        let Self { world, root, packets, .. } = self;
        let Group { columns, sheared, framed, entries, .. } = group;
        columns.fill(simd, &packets);
        for (packet, rays) in packets.rays.iter().enumerate() {
            let t_max = query.t_max(rays, packets.first_eight + packet);
            let own = mask32x8::from_bitmask(simd, packets.lanes[packet].into());
            let t_max = own.select(f32x8::load_array(simd, t_max), f32x8::splat(simd, -1.0));
            t_max.store_array(&mut columns.t_max[packet]);
        }
        // For any hit a ray may as well be searched from its end.
        let backwards = if E::ANY { Frustum::backwards(columns) } else { None };
        let frustum = backwards.unwrap_or_else(|| Frustum::new(columns));
        let sheared = (C::TRIANGLES && sheared.fill(simd, columns, &packets)).then_some(&*sheared);
        let framed = (C::CYLINDERS && framed.fill(simd, columns, &packets)).then_some(&*framed);
        let mut farthest = columns.farthest(simd);
        let mut patience = PATIENCE * packets.count();
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
            if at.kind() == Some(Kind::Triangles)
                && let Some(sheared) = sheared
            {
                sheared.leaf(simd, world, &packets, (at, met), columns, query);
            } else if let Some(framed) = framed {
                let entered = Entered { leaf: at, met, frustum: &frustum, farthest };
                framed.leaf(simd, world, &packets, entered, columns, query);
            } else {
                while met != 0 {
                    let i = met.trailing_zeros() as usize;
                    met &= met - 1;
                    let (packet, lane) = (i / 8, i % 8);
                    let ray = packets.rays[packet].get(lane);
                    let leaves = C::Leaves::new(simd, &ray);
                    let place = (packets.first_eight + packet, lane);
                    columns.t_max[packet][lane] =
                        query.leaf(simd, world, &leaves, (&ray, place), at);
                }
            }
            farthest = columns.farthest(simd);
        }
        true
    }
}

/// Pushes the children of a node that some ray may enter, with the nearest on top.
#[inline(always)]
fn visit<S: Simd>(
    simd: S,
    world: &World<'_>,
    frustum: &Frustum,
    at: Ref,
    farthest: f32,
    entries: &mut Entries,
    bottom: usize,
) -> usize {
    let node: &[Row; NODE] = rows(world.rows, at.row());
    let (mut mask, enter) = frustum.meet(simd, node, farthest);
    let enter = enter.to_array();
    let mut depth = bottom;
    while mask != 0 {
        let lane = mask.trailing_zeros() as usize & 7;
        mask &= mask - 1;
        let key = key_of_child(node, at.row(), lane, &enter);
        let parent = (at.row() * 8 + lane) as u32;
        push(entries, bottom, &mut depth, Entry { key, parent });
    }
    depth
}
