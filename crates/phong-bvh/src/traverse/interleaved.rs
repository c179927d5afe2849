//! Several rays at once, interleaved: one step of each in turn.
//!
//! At every node a ray waits for memory and then for its own arithmetic. Steps of independent rays fill
//! that time, and the next node of a ray is prefetched while the others take their steps. Rays share
//! nothing, so their order does not change a hit.

use std::marker::PhantomData;

use fearless_simd::Simd;

use super::{
    World,
    leaves::Content,
    query::{At, Query},
    walk::{Stack, Walk},
};
use crate::{level::Kernel, local::Rays8, node8::Ref, simd::prefetch};

/// How many rays are interleaved.
pub(super) const RAYS: usize = 12;

/// One stack for each.
pub(super) type Stacks = [Stack; RAYS];

/// Traces rays, each on its own.
pub(super) struct Interleaved<'a, E, C> {
    pub(super) world: &'a World<'a>,
    pub(super) root: Ref,
    pub(super) rays: &'a [Rays8],
    /// Which of them are to be traced, one bit each.
    pub(super) lanes: &'a [u32],
    pub(super) query: &'a mut E,
    pub(super) stacks: &'a mut Stacks,
    pub(super) content: PhantomData<C>,
}

impl<E: Query, C: Content> Kernel for Interleaved<'_, E, C> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { world, root, rays, lanes, query, stacks, .. } = self;
        let mut coming = Coming { lanes, eight: 0, left: 0 };
        let Some(first) = coming.next() else { return };
        let ray = rays[first.0].get(first.1);
        let walk = Walk::<S, C::Leaves<S>>::new(simd, &ray, query.best(&ray, first), root);
        // All walks are of the first ray until another takes their place.
        let mut walks = [walk; RAYS];
        let mut places = [first; RAYS];
        let mut going = [false; RAYS];
        going[0] = true;
        let mut active = 1;
        for i in 1..RAYS {
            if let Some(at) = coming.next() {
                let ray = rays[at.0].get(at.1);
                walks[i] = Walk::new(simd, &ray, query.best(&ray, at), root);
                (places[i], going[i]) = (at, true);
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
                query.finish(places[i], walks[i].best());
                if let Some(at) = coming.next() {
                    let ray = rays[at.0].get(at.1);
                    walks[i] = Walk::new(simd, &ray, query.best(&ray, at), root);
                    places[i] = at;
                } else {
                    going[i] = false;
                    active -= 1;
                }
            }
        }
    }
}

/// The rays that have not been started yet, in order.
struct Coming<'a> {
    lanes: &'a [u32],
    /// The number of eights that have been taken.
    eight: usize,
    /// The rays left of the last of them.
    left: u32,
}

impl Coming<'_> {
    /// The next ray.
    #[inline(always)]
    fn next(&mut self) -> Option<At> {
        while self.left == 0 {
            self.left = *self.lanes.get(self.eight)?;
            self.eight += 1;
        }
        let lane = self.left.trailing_zeros() as usize & 7;
        self.left &= self.left - 1;
        Some((self.eight - 1, lane))
    }
}
