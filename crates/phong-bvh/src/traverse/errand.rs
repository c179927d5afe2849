//! What rays are sent for: the closest hit, or any.

use std::ops::Range;

use fearless_simd::{Simd, f32x8, prelude::*};

use super::{
    Best, World,
    leaves::Leaves,
    walk::{Stack, Walk},
};
use crate::{
    local::{Hit, Ray},
    node8::Ref,
};

/// What the rays of a bundle are sent for, and where their answers go.
pub(super) trait Errand {
    /// The same for some of the rays.
    type Part<'a>: Errand
    where
        Self: 'a;

    /// Whether any hit will do.
    const ANY: bool;

    /// The same for the rays of a range.
    fn part(&mut self, range: Range<usize>) -> Self::Part<'_>;

    /// The first ray from `from` on that has to be sent.
    fn next(&self, rays: &[Ray], from: usize) -> Option<usize>;

    /// What is known of a ray before it is sent.
    fn best(&self, ray: &Ray, index: usize) -> Best;

    /// How far a ray has to go; −1: it need not.
    fn t_max(&self, ray: &Ray, index: usize) -> f32;

    /// One step of a ray on its own; whether there is another.
    fn step<S: Simd, L: Leaves<S>>(
        walk: &mut Walk<S, L>,
        simd: S,
        world: &World<'_>,
        stack: &mut Stack,
    ) -> bool;

    /// A ray on its own is back.
    fn back(&mut self, index: usize, best: Best);

    /// A ray of a group, prepared, meets a leaf; how far it has to go from now on.
    fn leaf<S: Simd, L: Leaves<S>>(
        &mut self,
        simd: S,
        world: &World<'_>,
        leaves: &L,
        ray: (&Ray, usize),
        leaf: Ref,
    ) -> f32;

    /// Some of eight rays of a group, those in `mask`, hit a primitive; `t_max` is how far each has to go.
    fn hits<S: Simd>(
        &mut self,
        packet: usize,
        mask: u32,
        prim: u32,
        at: [f32x8<S>; 3],
        t_max: &mut [f32; 8],
    );
}

/// The closest hits. They come with the best outside the tree.
pub(super) struct Closest<'a>(pub(super) &'a mut [Hit]);

/// Whether anything is hit. Rays already blocked are not sent.
pub(super) struct Any<'a>(pub(super) &'a mut [bool]);

impl Errand for Closest<'_> {
    type Part<'b>
        = Closest<'b>
    where
        Self: 'b;

    const ANY: bool = false;

    fn part(&mut self, range: Range<usize>) -> Closest<'_> {
        Closest(&mut self.0[range])
    }

    #[inline(always)]
    fn next(&self, rays: &[Ray], from: usize) -> Option<usize> {
        (from < rays.len()).then_some(from)
    }

    #[inline(always)]
    fn best(&self, _: &Ray, index: usize) -> Best {
        Best::outside(self.0[index].t, self.0[index].prim)
    }

    #[inline(always)]
    fn t_max(&self, _: &Ray, index: usize) -> f32 {
        self.0[index].t
    }

    #[inline(always)]
    fn step<S: Simd, L: Leaves<S>>(
        walk: &mut Walk<S, L>,
        simd: S,
        world: &World<'_>,
        stack: &mut Stack,
    ) -> bool {
        walk.step(simd, world, stack)
    }

    #[inline(always)]
    fn back(&mut self, index: usize, best: Best) {
        // Not the hit it was sent with: a walk is told its distance and number alone, and a group that
        // gave up has found weights as well.
        if best.0.prim != self.0[index].prim {
            self.0[index] = best.0;
        }
    }

    #[inline(always)]
    fn leaf<S: Simd, L: Leaves<S>>(
        &mut self,
        simd: S,
        world: &World<'_>,
        leaves: &L,
        (ray, index): (&Ray, usize),
        leaf: Ref,
    ) -> f32 {
        let mut best = Best(self.0[index]);
        leaves.offer(simd, world, ray, leaf, &mut best);
        self.0[index] = best.0;
        best.0.t
    }

    #[inline(always)]
    fn hits<S: Simd>(
        &mut self,
        packet: usize,
        mut mask: u32,
        prim: u32,
        [t, u, v]: [f32x8<S>; 3],
        t_max: &mut [f32; 8],
    ) {
        let (t, u, v) = (t.to_array(), u.to_array(), v.to_array());
        while mask != 0 {
            let lane = mask.trailing_zeros() as usize & 7;
            mask &= mask - 1;
            let hit = &mut self.0[8 * packet + lane];
            let mut best = Best(*hit);
            best.offer(t[lane], prim, u[lane], v[lane]);
            *hit = best.0;
            t_max[lane] = best.0.t;
        }
    }
}

impl Errand for Any<'_> {
    type Part<'b>
        = Any<'b>
    where
        Self: 'b;

    const ANY: bool = true;

    fn part(&mut self, range: Range<usize>) -> Any<'_> {
        Any(&mut self.0[range])
    }

    #[inline(always)]
    fn next(&self, _: &[Ray], from: usize) -> Option<usize> {
        Some(from + self.0.get(from..)?.iter().position(|&blocked| !blocked)?)
    }

    #[inline(always)]
    fn best(&self, ray: &Ray, _: usize) -> Best {
        Best::new(ray.t_max)
    }

    #[inline(always)]
    fn t_max(&self, ray: &Ray, index: usize) -> f32 {
        if self.0[index] { -1.0 } else { ray.t_max }
    }

    #[inline(always)]
    fn step<S: Simd, L: Leaves<S>>(
        walk: &mut Walk<S, L>,
        simd: S,
        world: &World<'_>,
        stack: &mut Stack,
    ) -> bool {
        walk.step_any(simd, world, stack)
    }

    #[inline(always)]
    fn back(&mut self, index: usize, best: Best) {
        self.0[index] = best.0.is_some();
    }

    #[inline(always)]
    fn leaf<S: Simd, L: Leaves<S>>(
        &mut self,
        simd: S,
        world: &World<'_>,
        leaves: &L,
        (ray, index): (&Ray, usize),
        leaf: Ref,
    ) -> f32 {
        if leaves.any(simd, world, ray, leaf) {
            self.0[index] = true;
        }
        self.t_max(ray, index)
    }

    #[inline(always)]
    fn hits<S: Simd>(
        &mut self,
        packet: usize,
        mut mask: u32,
        _: u32,
        _: [f32x8<S>; 3],
        t_max: &mut [f32; 8],
    ) {
        while mask != 0 {
            let lane = mask.trailing_zeros() as usize & 7;
            mask &= mask - 1;
            self.0[8 * packet + lane] = true;
            t_max[lane] = -1.0;
        }
    }
}
