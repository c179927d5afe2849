//! One ray at a time.
//!
//! A single ray takes the steps of [`walk`](super::walk) with branches: where a branch is predicted
//! correctly, the processor starts on the next node before the test of this one is done. There are no
//! other rays that could fill that time.

use std::marker::PhantomData;

use fearless_simd::{Simd, f32x8, prelude::*};

use super::{
    Best, Meter, World,
    leaves::{Content, Leaves},
    slabs::Slabs,
};
use crate::{
    level::Kernel,
    local::Ray,
    node8::{NODE, REFS, Ref, Row, rows},
};

/// The closest hit of one ray in the tree, given the best outside it.
pub(super) struct Closest<'a, C, M> {
    pub(super) world: &'a World<'a>,
    pub(super) root: Ref,
    pub(super) ray: &'a Ray,
    pub(super) best: &'a mut Best,
    pub(super) stack: &'a mut Stack,
    pub(super) meter: &'a mut M,
    pub(super) content: PhantomData<C>,
}

impl<C: Content, M: Meter> Kernel for Closest<'_, C, M> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let best = Best::outside(self.best.0.t, self.best.0.prim);
        let mut walk = Walk::<S, C::Leaves<S>>::new(simd, self.ray, best, self.root);
        while walk.step(simd, self.world, self.stack, self.meter) {}
        *self.best = walk.best;
    }
}

/// Whether one ray hits anything in the tree.
pub(super) struct Any<'a, C> {
    pub(super) world: &'a World<'a>,
    pub(super) root: Ref,
    pub(super) ray: &'a Ray,
    pub(super) stack: &'a mut Stack,
    pub(super) content: PhantomData<C>,
}

impl<C: Content> Kernel for Any<'_, C> {
    type Output = bool;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> bool {
        let best = Best::new(self.ray.t_max);
        let mut walk = Walk::<S, C::Leaves<S>>::new(simd, self.ray, best, self.root);
        loop {
            if let Some(hit) = walk.step_any(simd, self.world, self.stack) {
                return hit;
            }
        }
    }
}

/// A ray, prepared, where it stands, and the best hit so far.
struct Walk<S: Simd, L> {
    ray: Ray,
    slabs: Slabs<S>,
    leaves: L,
    best: Best,
    t_max: f32x8<S>,
    at: Ref,
    depth: usize,
}

/// Nodes to visit: entry distance in the upper half, [`Ref`] in the lower.
pub(super) type Stack = [u64; super::STACK];

impl<S: Simd, L: Leaves<S>> Walk<S, L> {
    /// A ray before the root, given the best hit outside the tree.
    #[inline(always)]
    fn new(simd: S, ray: &Ray, best: Best, root: Ref) -> Self {
        Self {
            ray: *ray,
            slabs: Slabs::new(simd, ray),
            leaves: L::new(simd, ray),
            best,
            t_max: f32x8::splat(simd, best.0.t),
            at: root,
            depth: 0,
        }
    }

    /// Visits one node or leaf on the way to the closest hit; whether there is another.
    #[inline(always)]
    fn step(
        &mut self,
        simd: S,
        world: &World<'_>,
        stack: &mut Stack,
        meter: &mut impl Meter,
    ) -> bool {
        if self.at.kind().is_some() {
            meter.primitive();
            self.leaves.offer(simd, world, &self.ray, self.at, &mut self.best);
            self.t_max = f32x8::splat(simd, self.best.0.t);
            return self.pop(stack);
        }
        meter.node();
        let node: &[Row; NODE] = rows(world.rows, self.at.row());
        let (mask, enter) = self.slabs.meet(simd, node, self.t_max);
        let mut mask = mask.to_bitmask() as u32;
        if mask == 0 {
            return self.pop(stack);
        }
        let parent = self.at.row();
        let child = |lane: usize| Ref(node[REFS].bits(lane)).from(parent);
        let lane = next(&mut mask);
        if mask == 0 {
            self.at = child(lane);
            return true;
        }
        let enter = enter.to_array();
        let key =
            |lane: usize| u64::from(enter[lane & 7].to_bits()) << 32 | u64::from(child(lane).0);
        let first = key(lane);
        let second = key(next(&mut mask));
        if mask == 0 {
            stack[self.depth] = first.max(second);
            self.depth += 1;
            self.at = Ref(first.min(second) as u32);
            return true;
        }
        // Nearest on top.
        let bottom = self.depth;
        stack[self.depth] = first.max(second);
        stack[self.depth + 1] = first.min(second);
        self.depth += 2;
        while mask != 0 {
            let key = key(next(&mut mask));
            let mut place = self.depth;
            while place > bottom && stack[place - 1] < key {
                stack[place] = stack[place - 1];
                place -= 1;
            }
            stack[place] = key;
            self.depth += 1;
        }
        self.depth -= 1;
        self.at = Ref(stack[self.depth] as u32);
        true
    }

    /// Goes to the next node that begins no farther than the best hit.
    #[inline(always)]
    fn pop(&mut self, stack: &Stack) -> bool {
        while self.depth > 0 {
            self.depth -= 1;
            let key = stack[self.depth];
            if f32::from_bits((key >> 32) as u32) <= self.best.0.t {
                self.at = Ref(key as u32);
                return true;
            }
        }
        false
    }

    /// Visits one node or leaf on the way to any hit; none: there is another.
    #[inline(always)]
    fn step_any(&mut self, simd: S, world: &World<'_>, stack: &mut Stack) -> Option<bool> {
        if self.at.kind().is_none() {
            let node: &[Row; NODE] = rows(world.rows, self.at.row());
            let mut mask = self.slabs.meet(simd, node, self.t_max).0.to_bitmask() as u32;
            if mask != 0 {
                let parent = self.at.row();
                let child = |lane: usize| Ref(node[REFS].bits(lane)).from(parent);
                self.at = child(next(&mut mask));
                while mask != 0 {
                    stack[self.depth] = u64::from(child(next(&mut mask)).0);
                    self.depth += 1;
                }
                return None;
            }
        } else if self.leaves.any(simd, world, &self.ray, self.at) {
            return Some(true);
        }
        if self.depth == 0 {
            return Some(false);
        }
        self.depth -= 1;
        self.at = Ref(stack[self.depth] as u32);
        None
    }
}

/// The lowest set bit, and clears it.
#[inline(always)]
fn next(mask: &mut u32) -> usize {
    let lane = mask.trailing_zeros() as usize;
    *mask &= *mask - 1;
    lane
}
