//! One ray on its way through the tree, a node or a leaf at a time.
//!
//! How many children of a node a ray enters is hard to predict, and a mispredicted branch costs as much
//! as testing the node. So a step takes the same branches for up to two children: all that are entered
//! are pushed at once, and the ray goes on with the nearer of the two entries on top of the stack. These
//! may be older entries, too, since all of them have to be visited.

use fearless_simd::{Simd, f32x8, mask32x8, prelude::*, u32x8};

use super::{Best, World, leaves::Leaves, slabs::Slabs};
use crate::{
    local::Ray,
    node8::{NODE, REFS, Ref, Row, rows},
};

/// A ray, prepared, where it stands, and the best hit so far.
#[derive(Clone, Copy)]
pub(super) struct Walk<S: Simd, L> {
    ray: Ray,
    slabs: Slabs<S>,
    leaves: L,
    best: Best,
    t_max: f32x8<S>,
    at: Ref,
    /// Entries on the stack, including the sentinel.
    depth: usize,
}

impl<S: Simd, L: Leaves<S>> Walk<S, L> {
    /// A ray before the root, given the best hit outside the tree.
    #[inline(always)]
    pub(super) fn new(simd: S, ray: &Ray, best: Best, root: Ref) -> Self {
        Self {
            ray: *ray,
            slabs: Slabs::new(simd, ray),
            leaves: L::new(simd, ray),
            best,
            t_max: f32x8::splat(simd, best.0.t),
            at: root,
            depth: 1,
        }
    }

    /// The best hit so far; after [`Walk::step_any`] it says no more than whether there is one.
    #[inline(always)]
    pub(super) fn best(&self) -> Best {
        self.best
    }

    /// Where the ray stands.
    #[inline(always)]
    pub(super) fn at(&self) -> Ref {
        self.at
    }

    /// Visits one node or leaf on the way to the closest hit; whether there is another.
    #[inline(always)]
    pub(super) fn step(&mut self, simd: S, world: &World<'_>, stack: &mut Stack) -> bool {
        if self.at.kind().is_some() {
            self.leaves.offer(simd, world, &self.ray, self.at, &mut self.best);
            self.t_max = f32x8::splat(simd, self.best.0.t);
            return self.pop(stack);
        }
        let node: &[Row; NODE] = rows(world.rows, self.at.row());
        let (mask, enter) = self.slabs.meet(simd, node, self.t_max);
        let bottom = self.depth;
        self.depth += stack.push(simd, bottom, node, self.at, mask, enter);
        if self.depth > bottom + 2 {
            stack.sort(bottom, self.depth);
        }
        let (near, next) = stack.pop_nearer(self.depth);
        self.depth -= 1;
        if near > self.best.0.t {
            return self.pop(stack);
        }
        self.at = next;
        self.depth > 0
    }

    /// Goes to the next node that begins no farther than the best hit.
    #[inline(always)]
    fn pop(&mut self, stack: &Stack) -> bool {
        self.depth -= 1;
        // The sentinel ends this loop.
        while stack.near[self.depth] > self.best.0.t {
            self.depth -= 1;
        }
        self.at = Ref(stack.refs[self.depth]);
        self.depth > 0
    }

    /// Visits one node or leaf on the way to any hit; whether there is another.
    #[inline(always)]
    pub(super) fn step_any(&mut self, simd: S, world: &World<'_>, stack: &mut Stack) -> bool {
        if self.at.kind().is_none() {
            let node: &[Row; NODE] = rows(world.rows, self.at.row());
            let mask = self.slabs.meet(simd, node, self.t_max).0;
            self.depth += stack.push_any(simd, self.depth, node, self.at, mask);
        } else if self.leaves.any(simd, world, &self.ray, self.at) {
            self.best.0.prim = 0;
            return false;
        }
        self.depth -= 1;
        self.at = Ref(stack.refs[self.depth]);
        self.depth > 0
    }
}

/// Room for all entries a ray can need, one more where it goes on with an older entry, the sentinel, and
/// eight children that are written at once.
const ROOM: usize = super::STACK + 16;

/// Nodes and leaves to visit. The lowest entry is a sentinel: it ends every search for an entry that is
/// near enough, and its bits are greater than those of any distance.
#[derive(Debug)]
pub(super) struct Stack {
    near: [f32; ROOM],
    refs: [u32; ROOM],
}

impl Stack {
    /// Only the sentinel.
    pub(super) const EMPTY: Self = Self { near: [f32::NEG_INFINITY; ROOM], refs: [0; ROOM] };

    /// Writes the children in `mask` and where they are entered; how many there are.
    #[inline(always)]
    fn push<S: Simd>(
        &mut self,
        simd: S,
        depth: usize,
        node: &[Row; NODE],
        at: Ref,
        mask: mask32x8<S>,
        enter: f32x8<S>,
    ) -> usize {
        enter.compress(mask).store_array(eight(&mut self.near, depth));
        self.push_any(simd, depth, node, at, mask)
    }

    /// Writes the children in `mask`; how many there are.
    #[inline(always)]
    fn push_any<S: Simd>(
        &mut self,
        simd: S,
        depth: usize,
        node: &[Row; NODE],
        at: Ref,
        mask: mask32x8<S>,
    ) -> usize {
        let refs = f32x8::load_array_ref(simd, &node[REFS].0).bitcast::<u32x8<S>>();
        let refs = refs + u32x8::splat(simd, at.row() as u32);
        refs.compress(mask).store_array(eight(&mut self.refs, depth));
        mask.to_bitmask().count_ones() as usize
    }

    /// Pops the nearer of the two entries on top.
    #[inline(always)]
    fn pop_nearer(&mut self, depth: usize) -> (f32, Ref) {
        // The bits of distances ≥ 0 are in order, and those of the sentinel are greater.
        let key = |at: usize| u64::from(self.near[at].to_bits()) << 32 | u64::from(self.refs[at]);
        let below = depth.saturating_sub(2);
        let (top, second) = (key(depth - 1), key(below));
        let (nearer, other) = (top.min(second), top.max(second));
        self.near[below] = f32::from_bits((other >> 32) as u32);
        self.refs[below] = other as u32;
        (f32::from_bits((nearer >> 32) as u32), Ref(nearer as u32))
    }

    /// Puts the nearest of some entries on top.
    #[inline(always)]
    fn sort(&mut self, bottom: usize, top: usize) {
        for from in bottom + 1..top {
            let (near, child) = (self.near[from], self.refs[from]);
            let mut place = from;
            while place > bottom && self.near[place - 1] < near {
                self.near[place] = self.near[place - 1];
                self.refs[place] = self.refs[place - 1];
                place -= 1;
            }
            (self.near[place], self.refs[place]) = (near, child);
        }
    }
}

/// Eight places from `from` on.
#[inline(always)]
fn eight<T>(of: &mut [T; ROOM], from: usize) -> &mut [T; 8] {
    (&mut of[from..from + 8]).try_into().expect("a range of eight has length eight")
}
