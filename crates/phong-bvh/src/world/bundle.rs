//! A bundle of eights through the world: each part in turn, for all rays that may meet it.

use std::cell::RefCell;

use fearless_simd::{Simd, f32x8, mask32x8, prelude::*, u32x8};

use super::{Best, Instance, World, loose::Loose};
use crate::{
    Aabb, Hits8, Rays8,
    eights::{halves, whole},
    frame::{Frame, SLACK, Way},
    lanes,
    level::{Kernel, Token},
    local,
    traverse::meet,
};

thread_local! {
    static ROOM: RefCell<Room> = RefCell::default();
}

/// Room for the rays of a bundle as one part sees them.
#[derive(Default)]
struct Room {
    rays: Vec<local::Rays8>,
    hits: Vec<local::Hits8>,
    ways: Vec<Ways8>,
    blocked: Vec<u32>,
}

/// The [`Way`]s of eight rays.
#[derive(Clone, Copy)]
#[repr(align(32))]
struct Ways8 {
    scale: [f64; 8],
    skip: [f64; 8],
}

impl Ways8 {
    const NONE: Self = Self { scale: [1.0; 8], skip: [0.0; 8] };
}

/// The closest hit of each ray.
pub(super) fn closest(world: &World, rays: &[Rays8], hits: &mut [Hits8]) {
    ROOM.with_borrow_mut(|room| {
        let World { loose, instances, upper, token, .. } = world;
        loose_closest(loose, *token, rays, hits, room);
        if let Some(upper) = upper {
            for (rays, hits) in rays.iter().zip(&mut *hits) {
                for lane in lanes(rays.there) {
                    let ray = rays.get(lane);
                    let mut best = best_of(hits, lane, ray.t_max);
                    upper.closest(*token, instances, &ray, &mut best, &mut ());
                    hits.set(lane, best.hit());
                }
            }
        } else {
            for Instance { tree, frame, part } in instances {
                let Some(bounds) = tree.bounds() else { continue };
                room.resize(rays.len());
                let Room { rays: local, hits: found, ways, .. } = &mut *room;
                let enter = Enter { frame, bounds, rays, hits, local, found, ways };
                if token.run(enter) {
                    tree.rays(*token).closer_of_eights(local, found);
                    token.run(Offer { part: *part, rays, found, ways, hits });
                }
            }
        }
    });
}

/// Whether each ray hits anything.
pub(super) fn any(world: &World, rays: &[Rays8], blocked: &mut [u32]) {
    ROOM.with_borrow_mut(|room| {
        let World { loose, instances, upper, token, .. } = world;
        loose_any(loose, *token, rays, blocked, room);
        if let Some(upper) = upper {
            for (rays, blocked) in rays.iter().zip(&mut *blocked) {
                for lane in lanes(rays.there & !*blocked) {
                    let hit = upper.any(*token, instances, &rays.get(lane));
                    *blocked |= u32::from(hit) << lane;
                }
            }
        } else {
            for Instance { tree, frame, .. } in instances {
                let Some(bounds) = tree.bounds() else { continue };
                room.resize(rays.len());
                let local = &mut room.rays;
                if token.run(EnterAny { frame, bounds, rays, blocked, local }) {
                    tree.rays(*token).more_of_eights(local, blocked);
                }
            }
        }
    });
}

fn best_of(hits: &Hits8, lane: usize, t_max: f32) -> Best {
    let hit = hits.get(lane);
    Best(crate::Hit { t: if hit.is_some() { hit.t } else { t_max }, ..hit })
}

impl Room {
    fn resize(&mut self, len: usize) {
        self.rays.resize(len, local::Rays8::NONE);
        self.hits.resize(len, local::Hits8::NONE);
        self.ways.resize(len, Ways8::NONE);
        self.blocked.resize(len, 0);
    }
}

/// The closest hits among the primitives written one by one.
fn loose_closest(loose: &Loose, token: Token, rays: &[Rays8], hits: &mut [Hits8], room: &mut Room) {
    if loose.is_empty() {
        return hits.fill(Hits8::NONE);
    }
    room.resize(rays.len());
    let Room { rays: local, hits: found, ways, .. } = room;
    let tree = loose.tree().rays(token);
    if token.run(Whole { loose, rays, local }) {
        tree.closest_of_eights(loose.outside(), local, found);
        return token.run(Name { loose, found, hits });
    }
    // Some rays start far from what is in the tree: they are moved along to it, and not to the planes.
    tree.closest_outside(loose.outside(), local, found);
    token.run(Name { loose, found, hits });
    let Some(bounds) = loose.tree().bounds() else { return };
    let enter = Enter { frame: loose.frame(), bounds, rays, hits, local, found, ways };
    if token.run(enter) {
        tree.closer_of_eights(local, found);
        let mut batch = 0;
        for (((rays, hits), found), ways) in rays.iter().zip(hits).zip(&*found).zip(&*ways) {
            for lane in lanes(found.met) {
                let (ray, hit) = (rays.get(lane), found.get(lane));
                let way = Way { scale: ways.scale[lane], skip: ways.skip[lane] };
                batch = loose.batch(batch, hit.prim);
                let (part, prim) = (loose.part(batch), hit.prim - loose.numbers(batch).start);
                let mut best = best_of(hits, lane, ray.t_max);
                best.offer(way.back(hit.t, &ray), part, local::Hit { prim, ..hit });
                hits.set(lane, best.hit());
            }
        }
    }
}

/// Whether each ray hits any of the primitives written one by one.
fn loose_any(loose: &Loose, token: Token, rays: &[Rays8], blocked: &mut [u32], room: &mut Room) {
    blocked.fill(0);
    if loose.is_empty() {
        return;
    }
    room.resize(rays.len());
    let local = &mut room.rays;
    let tree = loose.tree().rays(token);
    if token.run(Whole { loose, rays, local }) {
        return tree.any_of_eights(loose.outside(), local, blocked);
    }
    tree.any_outside(loose.outside(), local, blocked);
    let Some(bounds) = loose.tree().bounds() else { return };
    if token.run(EnterAny { frame: loose.frame(), bounds, rays, blocked, local }) {
        tree.more_of_eights(local, blocked);
    }
}

/// Gives the primitives met in the loose tree their parts, and their numbers there.
struct Name<'a> {
    loose: &'a Loose,
    found: &'a [local::Hits8],
    hits: &'a mut [Hits8],
}

impl Kernel for Name<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { loose, found, hits } = self;
        let mut batch = 0;
        for (found, hits) in found.iter().zip(hits) {
            let local::Hits8 { t, prim, u, v, met } = *found;
            (hits.t, hits.u, hits.v, hits.met) = (t, u, v, met);
            let number = u32x8::load_array_ref(simd, &prim);
            let (mut part, mut prim) = (u32x8::splat(simd, u32::MAX), u32x8::splat(simd, u32::MAX));
            let mut left = met;
            while left != 0 {
                // Neighbours are mostly of one batch.
                batch = loose.batch(batch, found.prim[left.trailing_zeros() as usize & 7]);
                let numbers = loose.numbers(batch);
                let (start, end) =
                    (u32x8::splat(simd, numbers.start), u32x8::splat(simd, numbers.end));
                let same = number.simd_ge(start) & number.simd_lt(end);
                let same = left & same.to_bitmask() as u32;
                left &= !same;
                let same = mask32x8::from_bitmask(simd, same.into());
                part = same.select(u32x8::splat(simd, loose.part(batch)), part);
                prim = same.select(number - start, prim);
            }
            part.store_array(&mut hits.part);
            prim.store_array(&mut hits.prim);
        }
    }
}

/// Takes rays to the world's centre; whether all are near enough to the loose tree to go on into it.
struct Whole<'a> {
    loose: &'a Loose,
    rays: &'a [Rays8],
    local: &'a mut [local::Rays8],
}

impl Kernel for Whole<'_> {
    type Output = bool;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> bool {
        let Self { loose, rays, local } = self;
        let mut near = 0xff;
        for (rays, local) in rays.iter().zip(local) {
            near &= loose.frame().shift(simd, rays, local) | !rays.there;
        }
        near & 0xff == 0xff || !loose.has_tree()
    }
}

/// Takes rays into the space of a part. Of those that may meet its box before what they have met already,
/// `found` says how far each has to look; whether there are any.
struct Enter<'a> {
    frame: &'a Frame,
    bounds: Aabb,
    rays: &'a [Rays8],
    hits: &'a [Hits8],
    local: &'a mut [local::Rays8],
    found: &'a mut [local::Hits8],
    ways: &'a mut [Ways8],
}

impl Kernel for Enter<'_> {
    type Output = bool;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> bool {
        let Self { frame, bounds, rays, hits, local, found, ways } = self;
        let mut any = 0;
        let eights = rays.iter().zip(hits).zip(local).zip(found).zip(ways);
        for ((((rays, hits), local), found), ways) in eights {
            local.there = 0;
            found.met = 0;
            if rays.there == 0 {
                continue;
            }
            let [low, high] = frame.rays(simd, rays, local);
            let end = load(simd, &local.t_max);
            let best = load(simd, &hits.t);
            let met = mask32x8::from_bitmask(simd, hits.met.into())
                & best.simd_lt(down(load(simd, &rays.t_max)));
            let (best_low, best_high) = best.widen();
            let reach: f32x8<S> = (best_low * low.scale * SLACK - low.skip)
                .narrow(best_high * high.scale * SLACK - high.skip);
            let reach = (met & reach.simd_lt(end)).select(reach, end);
            local.there &= meet(simd, local, &bounds, reach);
            any |= local.there;
            found.t = reach.into();
            found.prim = [u32::MAX; 8];
            ways.scale = whole(low.scale, high.scale);
            ways.skip = whole(low.skip, high.skip);
        }
        any != 0
    }
}

/// [`Enter`] where any hit will do, for rays that are not blocked.
struct EnterAny<'a> {
    frame: &'a Frame,
    bounds: Aabb,
    rays: &'a [Rays8],
    blocked: &'a [u32],
    local: &'a mut [local::Rays8],
}

impl Kernel for EnterAny<'_> {
    type Output = bool;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> bool {
        let Self { frame, bounds, rays, blocked, local } = self;
        let mut any = 0;
        for ((rays, blocked), local) in rays.iter().zip(blocked).zip(local) {
            let there = rays.there & !*blocked;
            local.there = 0;
            if there == 0 {
                continue;
            }
            frame.rays(simd, rays, local);
            let end = f32x8::load_array_ref(simd, &local.t_max);
            local.there = there & meet(simd, local, &bounds, end);
            any |= local.there;
        }
        any != 0
    }
}

/// Takes the hits in a part that are nearer than those so far, or as near and of a lower part.
struct Offer<'a> {
    part: u32,
    rays: &'a [Rays8],
    found: &'a [local::Hits8],
    ways: &'a [Ways8],
    hits: &'a mut [Hits8],
}

impl Kernel for Offer<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { part, rays, found, ways, hits } = self;
        let part = u32x8::splat(simd, part);
        for (((rays, found), ways), hits) in rays.iter().zip(found).zip(ways).zip(hits) {
            if found.met == 0 {
                continue;
            }
            // [`Way::back`], step by step.
            let (low, high) = load(simd, &found.t).widen();
            let (scale, skip) = (halves(simd, &ways.scale), halves(simd, &ways.skip));
            let t: f32x8<S> = ((low + skip[0]) / scale[0]).narrow((high + skip[1]) / scale[1]);
            let (least, most) = (up(load(simd, &rays.t_min).abs()), down(load(simd, &rays.t_max)));
            let t = t.simd_gt(least).select(t, least);
            let t = t.simd_lt(most).select(t, most);
            let had = mask32x8::from_bitmask(simd, hits.met.into());
            let (best, best_part) = (load(simd, &hits.t), numbers(simd, &hits.part));
            let nearer = t.simd_lt(best) | (t.simd_eq(best) & part.simd_lt(best_part));
            let new = mask32x8::from_bitmask(simd, found.met.into()) & (nearer | !had);
            new.select(t, best).store_array(&mut hits.t);
            new.select(part, best_part).store_array(&mut hits.part);
            new.select(numbers(simd, &found.prim), numbers(simd, &hits.prim))
                .store_array(&mut hits.prim);
            new.select(load(simd, &found.u), load(simd, &hits.u)).store_array(&mut hits.u);
            new.select(load(simd, &found.v), load(simd, &hits.v)).store_array(&mut hits.v);
            hits.met |= found.met;
        }
    }
}

#[inline(always)]
fn load<S: Simd>(simd: S, lanes: &[f32; 8]) -> f32x8<S> {
    f32x8::load_array_ref(simd, lanes)
}

#[inline(always)]
fn numbers<S: Simd>(simd: S, lanes: &[u32; 8]) -> u32x8<S> {
    u32x8::load_array_ref(simd, lanes)
}

/// The next number above, of numbers from 0 up.
#[inline(always)]
fn up<S: Simd>(v: f32x8<S>) -> f32x8<S> {
    let bits: u32x8<S> = v.bitcast();
    (bits + 1).bitcast()
}

/// The next number below, of numbers above 0.
#[inline(always)]
fn down<S: Simd>(v: f32x8<S>) -> f32x8<S> {
    let bits: u32x8<S> = v.bitcast();
    (bits - 1).bitcast()
}
