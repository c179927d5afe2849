//! Several rays at once, a step of each in turn.
//!
//! A ray waits at every node: for the node's rows, then for its own arithmetic. Steps of rays
//! that have nothing to do with each other fill that time; and the next node of a ray is asked for
//! while others take their steps. Nothing is shared between rays, so their order does not matter.

use std::marker::PhantomData;

use fearless_simd::Simd;

use super::{
    Best, World,
    leaves::{Content, Leaves},
    walk::{Stack, Walk},
};
use crate::{Hit, Ray, level::Kernel, node8::Ref, simd::prefetch};

/// How many rays are on their way at once.
pub(super) const RAYS: usize = 4;

/// A stack for each.
pub(super) type Stacks = [Stack; RAYS];

/// The closest hit of each ray. On entry hits hold the best outside the tree.
pub(super) struct ClosestOfMany<'a, C> {
    pub(super) world: &'a World<'a>,
    pub(super) root: Ref,
    pub(super) rays: &'a [Ray],
    pub(super) hits: &'a mut [Hit],
    pub(super) stacks: &'a mut Stacks,
    pub(super) content: PhantomData<C>,
}

/// A ray on its way.
struct Slot<S: Simd, L> {
    walk: Walk<S, L>,
    /// Which ray it is.
    index: usize,
}

impl<S: Simd, L: Leaves<S>> Slot<S, L> {
    #[inline(always)]
    fn new(simd: S, ray: &Ray, best: Best, root: Ref, index: usize) -> Self {
        Self { walk: Walk::new(simd, ray, best, root), index }
    }

    #[inline(always)]
    fn any(simd: S, rays: &[Ray], root: Ref, index: usize) -> Self {
        Self::new(simd, &rays[index], Best::new(rays[index].t_max), root, index)
    }
}

impl<C: Content> Kernel for ClosestOfMany<'_, C> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { world, root, rays, hits, stacks, .. } = self;
        if rays.len() < RAYS {
            for index in 0..rays.len() {
                let best = Best::outside(hits[index].t, hits[index].prim);
                let mut slot = Slot::<S, C::Leaves<S>>::new(simd, &rays[index], best, root, index);
                while slot.walk.step(simd, world, &mut stacks[0], &mut ()) {}
                improve(&mut hits[index], slot.walk.best());
            }
            return;
        }
        let mut slots: [Slot<S, C::Leaves<S>>; RAYS] = [
            Slot::new(simd, &rays[0], Best::outside(hits[0].t, hits[0].prim), root, 0),
            Slot::new(simd, &rays[1], Best::outside(hits[1].t, hits[1].prim), root, 1),
            Slot::new(simd, &rays[2], Best::outside(hits[2].t, hits[2].prim), root, 2),
            Slot::new(simd, &rays[3], Best::outside(hits[3].t, hits[3].prim), root, 3),
        ];
        let mut coming = RAYS;
        let mut idle = [false; RAYS];
        let mut active = RAYS;
        while active > 0 {
            for i in 0..RAYS {
                if idle[i] {
                    continue;
                }
                let slot = &mut slots[i];
                if slot.walk.step(simd, world, &mut stacks[i], &mut ()) {
                    prefetch(world.rows, slot.walk.at().row());
                    continue;
                }
                improve(&mut hits[slot.index], slot.walk.best());
                if coming < rays.len() {
                    let best = Best::outside(hits[coming].t, hits[coming].prim);
                    *slot = Slot::new(simd, &rays[coming], best, root, coming);
                    coming += 1;
                } else {
                    idle[i] = true;
                    active -= 1;
                }
            }
        }
    }
}

/// Takes the hit a walk ends with, unless it is the one it began with: a walk is told a hit's distance
/// and number alone, and a group that gave up has found weights as well.
#[inline(always)]
fn improve(hit: &mut Hit, best: Best) {
    if best.0.prim != hit.prim {
        *hit = best.0;
    }
}

/// Whether each ray hits anything; rays already blocked are left out.
pub(super) struct AnyOfMany<'a, C> {
    pub(super) world: &'a World<'a>,
    pub(super) root: Ref,
    pub(super) rays: &'a [Ray],
    pub(super) blocked: &'a mut [bool],
    pub(super) stacks: &'a mut Stacks,
    pub(super) content: PhantomData<C>,
}

impl<C: Content> Kernel for AnyOfMany<'_, C> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { world, root, rays, blocked, stacks, .. } = self;
        // The rays that are not blocked yet.
        let mut coming = 0;
        let mut next = |blocked: &[bool]| {
            coming += blocked.get(coming..)?.iter().position(|&blocked| !blocked)? + 1;
            Some(coming - 1)
        };
        let Some(first) = next(blocked) else { return };
        let mut slots: [Slot<S, C::Leaves<S>>; RAYS] = [
            Slot::any(simd, rays, root, first),
            Slot::any(simd, rays, root, first),
            Slot::any(simd, rays, root, first),
            Slot::any(simd, rays, root, first),
        ];
        let mut idle = [false; RAYS];
        let mut active = 1;
        for i in 1..RAYS {
            if let Some(index) = next(blocked) {
                slots[i] = Slot::any(simd, rays, root, index);
                active += 1;
            } else {
                idle[i] = true;
            }
        }
        while active > 0 {
            for i in 0..RAYS {
                if idle[i] {
                    continue;
                }
                let slot = &mut slots[i];
                let Some(hit) = slot.walk.step_any(simd, world, &mut stacks[i]) else {
                    prefetch(world.rows, slot.walk.at().row());
                    continue;
                };
                blocked[slot.index] = hit;
                if let Some(index) = next(blocked) {
                    *slot = Slot::any(simd, rays, root, index);
                } else {
                    idle[i] = true;
                    active -= 1;
                }
            }
        }
    }
}
