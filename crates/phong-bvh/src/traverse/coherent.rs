//! Rays that go the same way, together down the tree.
//!
//! Up to 64 rays whose directions agree in sign share one walk. A node is tested once for all of
//! them, as a [`Frustum`]. A leaf's box is then tested against the rays themselves, eight at a time, and
//! those it stops are tested against its primitives one by one, just as in any other walk. No box that a
//! ray alone would have entered is left out, and hits are the same.

use std::marker::PhantomData;

use fearless_simd::{Simd, prelude::*};

use super::{
    World,
    columns::{Columns, GROUP, PACKETS},
    errand::Errand,
    frustum::Frustum,
    leaves::{Content, Leaves},
    sheared::Sheared,
};
use crate::{
    level::Kernel,
    local::Ray,
    node8::{Kind, NODE, REFS, Ref, Row, rows},
};

/// Nodes and leaves per ray after which a group gives up.
const PATIENCE: usize = 2;

/// Where a child is entered, what it is, and where its box is: row of the node times eight, plus lane.
#[derive(Clone, Copy)]
struct Entry {
    key: u64,
    parent: u32,
}

impl Entry {
    /// Nothing.
    const NONE: Self = Self { key: 0, parent: 0 };
}

/// What a group works on.
pub(super) struct Group {
    columns: Columns,
    sheared: Sheared,
    entries: Entries,
}

impl Group {
    /// No rays.
    pub(super) const EMPTY: Self =
        Self { columns: Columns::EMPTY, sheared: Sheared::EMPTY, entries: [Entry::NONE; _] };
}

/// Nodes and leaves to visit.
type Entries = [Entry; super::STACK];

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

/// Rays, together. False: given up, with what was found so far; they do not go together after all.
pub(super) struct Together<'a, E, C> {
    pub(super) world: &'a World<'a>,
    pub(super) root: Ref,
    pub(super) rays: &'a [Ray],
    pub(super) errand: &'a mut E,
    pub(super) group: &'a mut Group,
    pub(super) content: PhantomData<C>,
}

impl<E: Errand, C: Content> Kernel for Together<'_, E, C> {
    type Output = bool;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> bool {
        let Self { world, root, rays, errand, group, .. } = self;
        let Group { columns, sheared, entries } = group;
        columns.fill(simd, rays);
        columns.t_max = [[-1.0; 8]; PACKETS];
        for (i, ray) in rays.iter().enumerate().take(GROUP) {
            columns.t_max[i / 8][i % 8] = errand.t_max(ray, i);
        }
        // Where any hit will do, it does not matter from which end it is looked for.
        let backwards = if E::ANY { Frustum::backwards(columns) } else { None };
        let frustum = backwards.unwrap_or_else(|| Frustum::new(columns));
        let sheared = (C::TRIANGLES && sheared.fill(simd, columns, rays)).then_some(&*sheared);
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
            if at.kind() == Some(Kind::Triangles)
                && let Some(sheared) = sheared
            {
                sheared.leaf(simd, world, rays, (at, met), columns, errand);
            } else {
                while met != 0 {
                    let i = met.trailing_zeros() as usize;
                    met &= met - 1;
                    let leaves = C::Leaves::new(simd, &rays[i]);
                    columns.t_max[i / 8][i % 8] =
                        errand.leaf(simd, world, &leaves, (&rays[i], i), at);
                }
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
