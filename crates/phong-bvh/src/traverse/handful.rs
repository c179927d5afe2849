//! A tree that is one leaf of spheres, as in many a small scene: eight rays against each of them.

use fearless_simd::{Simd, prelude::*};

use super::Best;
use crate::{
    Hit, Ray,
    level::Kernel,
    node8::Row,
    primitives::sphere::{BLOCK, Closest8},
};

/// The closest hit of each ray; `hits` come with the best outside the tree.
pub(super) struct ClosestOfHandful<'a> {
    pub(super) block: &'a [Row; BLOCK],
    pub(super) rays: &'a [Ray],
    pub(super) hits: &'a mut [Hit],
}

impl Kernel for ClosestOfHandful<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { block, rays, hits } = self;
        for (rays, hits) in rays.chunks(8).zip(hits.chunks_mut(8)) {
            let rays8 = Closest8::of_rays(simd, rays);
            for (lane, number) in numbers(block) {
                let (mut mask, t) = rays8.intersect_one(simd, block, lane);
                mask &= (1 << hits.len()) - 1;
                if mask != 0 {
                    let t = t.to_array();
                    while mask != 0 {
                        let ray = mask.trailing_zeros() as usize & 7;
                        mask &= mask - 1;
                        let mut best = Best(hits[ray]);
                        best.offer(t[ray], number, 0.0, 0.0);
                        hits[ray] = best.0;
                    }
                }
            }
        }
    }
}

/// Whether each ray hits any; those already `blocked` stay so.
pub(super) struct AnyOfHandful<'a> {
    pub(super) block: &'a [Row; BLOCK],
    pub(super) rays: &'a [Ray],
    pub(super) blocked: &'a mut [bool],
}

impl Kernel for AnyOfHandful<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { block, rays, blocked } = self;
        for (rays, blocked) in rays.chunks(8).zip(blocked.chunks_mut(8)) {
            let rays8 = Closest8::of_rays(simd, rays);
            let mut mask = 0;
            for (lane, _) in numbers(block) {
                mask |= rays8.intersect_one(simd, block, lane).0;
            }
            for (ray, blocked) in blocked.iter_mut().enumerate() {
                *blocked |= mask >> ray & 1 != 0;
            }
        }
    }
}

/// The lanes of a block that are used, and the numbers of the primitives there.
#[inline(always)]
fn numbers(block: &[Row; BLOCK]) -> impl Iterator<Item = (usize, u32)> {
    (0..8).map(|lane| (lane, block[BLOCK - 1].bits(lane))).take_while(|&(_, n)| n != u32::MAX)
}
