//! What a bundle asks for: the closest hit of each ray, or whether there is any.

use fearless_simd::{Simd, f32x8, mask32x8, prelude::*, u32x8};

use super::{
    Best, World,
    leaves::Leaves,
    walk::{Stack, Walk},
};
use crate::{
    local::{Hits8, Ray, Rays8},
    node8::Ref,
};

/// Where a ray is in a bundle: the number of its eight, and its lane.
pub(super) type At = (usize, usize);

/// What a bundle asks for, and where the answers go.
pub(super) trait Query {
    /// Whether any hit will do.
    const ANY: bool;

    /// The rays of an eight that have to be traced, a bit each.
    fn wanted(&self, rays: &Rays8, eight: usize) -> u32;

    /// The best hit of a ray before it is traced.
    fn best(&self, ray: &Ray, at: At) -> Best;

    /// How far each ray of an eight has to look.
    fn t_max(&self, rays: &Rays8, eight: usize) -> [f32; 8];

    /// One step of a ray on its own. Returns whether there is another one.
    fn step<S: Simd, L: Leaves<S>>(
        walk: &mut Walk<S, L>,
        simd: S,
        world: &World<'_>,
        stack: &mut Stack,
    ) -> bool;

    /// Takes the best hit of a ray that was traced on its own.
    fn finish(&mut self, at: At, best: Best);

    /// Tests a ray of a group against a leaf. Returns how far it still has to look; −1: it is done.
    fn leaf<S: Simd, L: Leaves<S>>(
        &mut self,
        simd: S,
        world: &World<'_>,
        leaves: &L,
        ray: (&Ray, At),
        leaf: Ref,
    ) -> f32;

    /// Takes the hits of some rays of an eight, those in `mask`, on one primitive, and updates how far each
    /// of them still has to look.
    fn hits<S: Simd>(
        &mut self,
        simd: S,
        eight: usize,
        mask: u32,
        prim: u32,
        hit: [f32x8<S>; 3],
        t_max: &mut [f32; 8],
    );
}

/// The closest hits. They begin as the best hits outside the tree.
pub(super) struct ClosestHit<'a>(pub(super) &'a mut [Hits8]);

/// Whether anything is hit, a bit each. Rays already blocked are not traced.
pub(super) struct AnyHit<'a>(pub(super) &'a mut [u32]);

impl Query for ClosestHit<'_> {
    const ANY: bool = false;

    #[inline(always)]
    fn wanted(&self, rays: &Rays8, _: usize) -> u32 {
        rays.there
    }

    #[inline(always)]
    fn best(&self, _: &Ray, (eight, lane): At) -> Best {
        let hits = &self.0[eight];
        Best::outside(hits.t[lane], hits.prim[lane])
    }

    #[inline(always)]
    fn t_max(&self, _: &Rays8, eight: usize) -> [f32; 8] {
        self.0[eight].t
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
    fn finish(&mut self, (eight, lane): At, best: Best) {
        // The walk started from the distance and the number of the hit that was known before. Where it
        // found no other, the known one stays, for a group that gave up may have found its weights.
        let hits = &mut self.0[eight];
        if best.0.prim != hits.prim[lane] {
            hits.set(lane, best.0);
        }
    }

    #[inline(always)]
    fn leaf<S: Simd, L: Leaves<S>>(
        &mut self,
        simd: S,
        world: &World<'_>,
        leaves: &L,
        (ray, (eight, lane)): (&Ray, At),
        leaf: Ref,
    ) -> f32 {
        let hits = &mut self.0[eight];
        let mut best = Best::outside(hits.t[lane], hits.prim[lane]);
        leaves.offer(simd, world, ray, leaf, &mut best);
        if best.0.prim != hits.prim[lane] {
            hits.set(lane, best.0);
        }
        best.0.t
    }

    #[inline(always)]
    fn hits<S: Simd>(
        &mut self,
        simd: S,
        eight: usize,
        mask: u32,
        prim: u32,
        [t, u, v]: [f32x8<S>; 3],
        t_max: &mut [f32; 8],
    ) {
        // The rule of `Best::offer`.
        let hits = &mut self.0[eight];
        let old = f32x8::load_array_ref(simd, &hits.t);
        let old_prim = u32x8::load_array_ref(simd, &hits.prim);
        let prim = u32x8::splat(simd, prim);
        let better = t.simd_lt(old) | (t.simd_eq(old) & prim.simd_lt(old_prim));
        let better = better & mask32x8::from_bitmask(simd, mask.into());
        let bits = better.to_bitmask() as u32;
        if bits == 0 {
            return;
        }
        hits.met |= bits;
        // The least, and not a choice: processors write some lanes of eight slowly.
        let nearer = better.select(t, f32x8::splat(simd, f32::INFINITY));
        nearer.min(old).store_array(&mut hits.t);
        nearer.min(f32x8::load_array_ref(simd, t_max)).store_array(t_max);
        better.select(prim, old_prim).store_array(&mut hits.prim);
        better.select(u, f32x8::load_array_ref(simd, &hits.u)).store_array(&mut hits.u);
        better.select(v, f32x8::load_array_ref(simd, &hits.v)).store_array(&mut hits.v);
    }
}

impl Query for AnyHit<'_> {
    const ANY: bool = true;

    #[inline(always)]
    fn wanted(&self, rays: &Rays8, eight: usize) -> u32 {
        rays.there & !self.0[eight]
    }

    #[inline(always)]
    fn best(&self, ray: &Ray, _: At) -> Best {
        Best::new(ray.t_max)
    }

    #[inline(always)]
    fn t_max(&self, rays: &Rays8, _: usize) -> [f32; 8] {
        rays.t_max
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
    fn finish(&mut self, (eight, lane): At, best: Best) {
        self.0[eight] |= u32::from(best.0.is_some()) << lane;
    }

    #[inline(always)]
    fn leaf<S: Simd, L: Leaves<S>>(
        &mut self,
        simd: S,
        world: &World<'_>,
        leaves: &L,
        (ray, (eight, lane)): (&Ray, At),
        leaf: Ref,
    ) -> f32 {
        if !leaves.any(simd, world, ray, leaf) {
            return ray.t_max;
        }
        self.0[eight] |= 1 << lane;
        -1.0
    }

    #[inline(always)]
    fn hits<S: Simd>(
        &mut self,
        simd: S,
        eight: usize,
        mask: u32,
        _: u32,
        _: [f32x8<S>; 3],
        t_max: &mut [f32; 8],
    ) {
        self.0[eight] |= mask;
        let hit = mask32x8::from_bitmask(simd, mask.into());
        let done = hit.select(f32x8::splat(simd, -1.0), f32x8::splat(simd, f32::INFINITY));
        done.min(f32x8::load_array_ref(simd, t_max)).store_array(t_max);
    }
}
