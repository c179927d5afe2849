//! Several rays at once, a step of each in turn.
//!
//! A ray waits at every node: for the node's rows, then for its own arithmetic. Steps of rays
//! that have nothing to do with each other fill that time; and the next node of a ray is asked for
//! while others take their steps. Nothing is shared between rays, so their order does not matter.

use std::marker::PhantomData;

use fearless_simd::Simd;

use super::{
    World,
    errand::Errand,
    leaves::Content,
    walk::{Stack, Walk},
};
use crate::{level::Kernel, local::Ray, node8::Ref, simd::prefetch};

/// How many rays are on their way at once.
pub(super) const RAYS: usize = 12;

/// A stack for each.
pub(super) type Stacks = [Stack; RAYS];

/// Rays, each on its own.
pub(super) struct Many<'a, E, C> {
    pub(super) world: &'a World<'a>,
    pub(super) root: Ref,
    pub(super) rays: &'a [Ray],
    pub(super) errand: &'a mut E,
    pub(super) stacks: &'a mut Stacks,
    pub(super) content: PhantomData<C>,
}

impl<E: Errand, C: Content> Kernel for Many<'_, E, C> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { world, root, rays, errand, stacks, .. } = self;
        let Some(first) = errand.next(rays, 0) else { return };
        let best = errand.best(&rays[first], first);
        let walk = Walk::<S, C::Leaves<S>>::new(simd, &rays[first], best, root);
        // All are the first ray until they are another.
        let mut walks = [walk; RAYS];
        let mut indices = [first; RAYS];
        let mut going = [false; RAYS];
        going[0] = true;
        let mut active = 1;
        let mut coming = first + 1;
        for i in 1..RAYS {
            if let Some(index) = errand.next(rays, coming) {
                let best = errand.best(&rays[index], index);
                walks[i] = Walk::new(simd, &rays[index], best, root);
                (indices[i], going[i]) = (index, true);
                coming = index + 1;
                active += 1;
            }
        }
        while active > 0 {
            for i in 0..RAYS {
                if !going[i] {
                    continue;
                }
                if E::step(&mut walks[i], simd, world, &mut stacks[i]) {
                    prefetch(world.rows, walks[i].at().row());
                    continue;
                }
                errand.back(indices[i], walks[i].best());
                if let Some(index) = errand.next(rays, coming) {
                    let best = errand.best(&rays[index], index);
                    walks[i] = Walk::new(simd, &rays[index], best, root);
                    indices[i] = index;
                    coming = index + 1;
                } else {
                    going[i] = false;
                    active -= 1;
                }
            }
        }
    }
}
