//! One ray at a time.

use std::marker::PhantomData;

use fearless_simd::Simd;

use super::{
    Best, Meter, World,
    leaves::Content,
    walk::{Stack, Walk},
};
use crate::{Ray, level::Kernel, node8::Ref};

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
        *self.best = walk.best();
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
