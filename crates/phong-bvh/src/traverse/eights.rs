//! What lies outside a tree, and a tree that is one leaf of spheres, as in many a small scene: eight
//! rays side by side against each plane and each sphere.

use fearless_simd::{Simd, f32x8, mask32x8, prelude::*, u32x8};

use crate::{
    Geometry, Hits8, Plane, Rays8,
    level::Kernel,
    node8::Row,
    primitives::sphere::{BLOCK, Closest8},
};

/// The geometry that has no bounds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Planes<'a> {
    pub(crate) geometry: &'a [Geometry],
    /// Which of the geometries are planes.
    pub(crate) which: &'a [usize],
    /// First primitive number of each geometry.
    pub(crate) first: &'a [u32],
}

impl<'a> Planes<'a> {
    #[inline(always)]
    fn each(self) -> impl Iterator<Item = (&'a Plane, u32)> {
        self.which.iter().filter_map(move |&index| match &self.geometry[index] {
            Geometry::Plane(plane) => Some((plane, self.first[index])),
            _ => None,
        })
    }
}

/// The closest hit of each ray outside the tree and in `block`; where there is none, its end and
/// the number of none.
pub(crate) struct ClosestOfFew<'a> {
    pub(crate) planes: Planes<'a>,
    pub(crate) block: Option<&'a [Row; BLOCK]>,
    pub(crate) rays: &'a [Rays8],
    pub(crate) hits: &'a mut [Hits8],
}

impl Kernel for ClosestOfFew<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { planes, block, rays, hits } = self;
        let load = |lanes: &[f32; 8]| f32x8::load_array_ref(simd, lanes);
        for (rays, hits) in rays.iter().zip(hits) {
            let mut best = (load(&rays.t_max), u32x8::splat(simd, u32::MAX));
            let there = mask32x8::from_bitmask(simd, rays.there.into());
            for (plane, number) in planes.each() {
                if let Some((met, t)) = plane.intersect8(simd, rays) {
                    offer(simd, &mut best, there & met, t, number);
                }
            }
            if let Some(block) = block {
                let closest = Closest8::of_rays(simd, rays);
                for (lane, number) in numbers(block) {
                    if let Some((met, t)) = closest.intersect_one(simd, block, lane) {
                        offer(simd, &mut best, there & met, t, number);
                    }
                }
            }
            let (t, prim) = best;
            let met = prim.simd_lt(u32x8::splat(simd, u32::MAX)).to_bitmask() as u32;
            *hits = Hits8 { t: t.into(), prim: prim.into(), met, ..Hits8::NONE };
        }
    }
}

/// Takes hits that are nearer, or as near and of a lower number.
#[inline(always)]
fn offer<S: Simd>(
    simd: S,
    best: &mut (f32x8<S>, u32x8<S>),
    met: mask32x8<S>,
    t: f32x8<S>,
    number: u32,
) {
    let number = u32x8::splat(simd, number);
    let lower = t.simd_eq(best.0) & number.simd_lt(best.1);
    let better = met & (t.simd_lt(best.0) | lower);
    *best = (better.select(t, best.0), better.select(number, best.1));
}

/// Whether each ray hits anything outside the tree or in `block`, a bit each.
pub(crate) struct AnyOfFew<'a> {
    pub(crate) planes: Planes<'a>,
    pub(crate) block: Option<&'a [Row; BLOCK]>,
    pub(crate) rays: &'a [Rays8],
    pub(crate) blocked: &'a mut [u32],
}

impl Kernel for AnyOfFew<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { planes, block, rays, blocked } = self;
        for (rays, blocked) in rays.iter().zip(blocked) {
            *blocked = 0;
            if rays.there == 0 {
                continue;
            }
            for (plane, _) in planes.each() {
                if let Some((met, _)) = plane.intersect8(simd, rays) {
                    *blocked |= met.to_bitmask() as u32;
                }
            }
            if let Some(block) = block {
                let closest = Closest8::of_rays(simd, rays);
                for (lane, _) in numbers(block) {
                    if let Some((met, _)) = closest.intersect_one(simd, block, lane) {
                        *blocked |= met.to_bitmask() as u32;
                    }
                }
            }
            *blocked &= rays.there;
        }
    }
}

/// The lanes of a block that are used, and the numbers of the primitives there.
#[inline(always)]
fn numbers(block: &[Row; BLOCK]) -> impl Iterator<Item = (usize, u32)> {
    (0..8).map(|lane| (lane, block[BLOCK - 1].bits(lane))).take_while(|&(_, n)| n != u32::MAX)
}
