//! A bundle of eights through the world: each part in turn, for all rays that may meet it.

use std::cell::RefCell;

use fearless_simd::{Simd, f32x8, mask32x8, prelude::*, u32x8};

use super::{
    Best, Instance, WithPlanes, World,
    few::{self, Few, Spheres},
    loose::Loose,
};
use crate::{
    Aabb, Hits8, Rays8, Tree,
    eights::{halves, whole},
    frame::{Frame, SLACK},
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
}

/// The [`Way`](crate::frame::Way)s of eight rays.
#[derive(Clone, Copy)]
#[repr(align(32))]
struct Ways8 {
    /// Whether distances are the world's, and the numbers here unspecified.
    same: bool,
    scale: [f64; 8],
    skip: [f64; 8],
}

impl Ways8 {
    const NONE: Self = Self { same: true, scale: [1.0; 8], skip: [0.0; 8] };
}

/// The closest hit of each ray.
pub(super) fn closest(world: &World, rays: &[Rays8], hits: &mut [Hits8]) {
    let World { loose, instances, upper, token, .. } = world;
    let (few, first) = few_of(world);
    let done = token.run(few::Closest { few, first: true, rays, hits });
    ROOM.with_borrow_mut(|room| {
        if loose.has_tree() && !(done && few.spheres.is_some()) {
            closest_in(*token, loose.tree(), loose.frame(), loose, rays, hits, room);
        }
        if let Some(upper) = upper {
            for (rays, hits) in rays.iter().zip(&mut *hits) {
                for lane in lanes(rays.there) {
                    let ray = rays.get(lane);
                    let mut best = best_of(hits, lane, ray.t_max);
                    upper.closest(*token, instances, &ray, &mut best, &mut ());
                    hits.set(lane, best.hit());
                }
            }
            return;
        }
        for (number, instance) in instances.iter().enumerate() {
            if done && first == Some(number) {
                continue;
            }
            let Instance { tree, frame, part } = instance;
            if let Some(few) = instance.few(*token)
                && token.run(few::Closest { few, first: false, rays, hits })
            {
                continue;
            }
            closest_in(*token, tree, frame, &OnePart(*part), rays, hits, room);
        }
    });
}

/// Whether each ray hits anything; `scattered`: the rays start close together and go everywhere.
pub(super) fn any(world: &World, rays: &[Rays8], blocked: &mut [u32], scattered: bool) {
    blocked.fill(0);
    let World { loose, instances, upper, token, .. } = world;
    let (few, first) = few_of(world);
    let done = token.run(few::Any { few, rays, blocked });
    ROOM.with_borrow_mut(|room| {
        if loose.has_tree() && !(done && few.spheres.is_some()) {
            any_in(*token, (loose.tree(), loose.frame()), rays, blocked, scattered, room);
        }
        if let Some(upper) = upper {
            for (rays, blocked) in rays.iter().zip(&mut *blocked) {
                for lane in lanes(rays.there & !*blocked) {
                    let hit = upper.any(*token, instances, &rays.get(lane));
                    *blocked |= u32::from(hit) << lane;
                }
            }
            return;
        }
        for (number, instance) in instances.iter().enumerate() {
            if done && first == Some(number) {
                continue;
            }
            let Instance { tree, frame, .. } = instance;
            if let Some(few) = instance.few(*token)
                && token.run(few::Any { few, rays, blocked })
            {
                continue;
            }
            any_in(*token, (tree, frame), rays, blocked, scattered, room);
        }
    });
}

/// The planes of a world and the spheres asked with them, and which of the instances these are, if they are one.
fn few_of(world: &World) -> (Few<'_>, Option<usize>) {
    let World { loose, instances, with_planes, token, .. } = world;
    let planes = Few { frame: loose.frame(), planes: loose.planes(), spheres: None };
    match *with_planes {
        WithPlanes::Nothing => (planes, None),
        WithPlanes::Loose(names) => {
            let block = loose.tree().rays(*token).single_leaf();
            (Few { spheres: block.map(|block| Spheres { block, names }), ..planes }, None)
        }
        WithPlanes::Instance(number) => match instances[number].few(*token) {
            Some(own) => (Few { planes: planes.planes, ..own }, Some(number)),
            None => (planes, None),
        },
    }
}

fn best_of(hits: &Hits8, lane: usize, t_max: f32) -> Best {
    let hit = hits.get(lane);
    Best(crate::Hit { t: if hit.is_some() { hit.t } else { t_max }, ..hit })
}

/// Takes the hits in a tree that are nearer than those so far.
fn closest_in(
    token: Token,
    tree: &Tree,
    frame: &Frame,
    names: &impl Names,
    rays: &[Rays8],
    hits: &mut [Hits8],
    room: &mut Room,
) {
    let Some(bounds) = tree.bounds() else { return };
    room.rays.resize(rays.len(), local::Rays8::NONE);
    room.hits.resize(rays.len(), local::Hits8::NONE);
    room.ways.resize(rays.len(), Ways8::NONE);
    let Room { rays: local, hits: found, ways, .. } = room;
    if token.run(Enter { frame, bounds, rays, hits, local, found, ways }) {
        tree.rays(token).closest_of_eights(local, found);
        token.run(Offer { names, rays, found, ways, hits });
    }
}

/// Whether rays that are not blocked hit anything in a tree.
fn any_in(
    token: Token,
    (tree, frame): (&Tree, &Frame),
    rays: &[Rays8],
    blocked: &mut [u32],
    scattered: bool,
    room: &mut Room,
) {
    let Some(bounds) = tree.bounds() else { return };
    room.rays.resize(rays.len(), local::Rays8::NONE);
    let local = &mut room.rays;
    if token.run(EnterAny { frame, bounds, rays, blocked, local }) {
        if scattered {
            tree.rays(token).any_of_scattered(local, blocked);
        } else {
            tree.rays(token).any_of_eights(local, blocked);
        }
    }
}

/// The part of what is met in a tree, and its number there.
trait Names {
    fn names<S: Simd>(&self, simd: S, found: &local::Hits8) -> [u32x8<S>; 2];
}

/// All of it is of one part.
struct OnePart(u32);

impl Names for OnePart {
    #[inline(always)]
    fn names<S: Simd>(&self, simd: S, found: &local::Hits8) -> [u32x8<S>; 2] {
        [u32x8::splat(simd, self.0), numbers(simd, &found.prim)]
    }
}

impl Names for Loose {
    #[inline(always)]
    fn names<S: Simd>(&self, simd: S, found: &local::Hits8) -> [u32x8<S>; 2] {
        let number = numbers(simd, &found.prim);
        let (mut part, mut prim) = (u32x8::splat(simd, u32::MAX), u32x8::splat(simd, u32::MAX));
        let (mut left, mut batch) = (found.met, 0);
        while left != 0 {
            // Neighbours are mostly of one batch.
            batch = self.batch(batch, found.prim[left.trailing_zeros() as usize & 7]);
            let range = self.numbers(batch);
            let (start, end) = (u32x8::splat(simd, range.start), u32x8::splat(simd, range.end));
            let same = number.simd_ge(start) & number.simd_lt(end);
            let same = left & same.to_bitmask() as u32;
            left &= !same;
            let same = mask32x8::from_bitmask(simd, same.into());
            part = same.select(u32x8::splat(simd, self.part(batch)), part);
            prim = same.select(number - start, prim);
        }
        [part, prim]
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
            let best = load(simd, &hits.t);
            let met = mask32x8::from_bitmask(simd, hits.met.into())
                & best.simd_lt(down(load(simd, &rays.t_max)));
            let (best_low, best_high) = best.widen();
            let reach: f32x8<S> = if let Some(near) = frame.load_near(simd, rays) {
                near.store(rays.there, local);
                ways.same = true;
                (best_low * SLACK).narrow(best_high * SLACK)
            } else {
                let [low, high] = frame.rays(simd, rays, local);
                ways.same = false;
                ways.scale = whole(low.scale, high.scale);
                ways.skip = whole(low.skip, high.skip);
                (best_low * low.scale * SLACK - low.skip)
                    .narrow(best_high * high.scale * SLACK - high.skip)
            };
            let end = load(simd, &local.t_max);
            let reach = (met & reach.simd_lt(end)).select(reach, end);
            local.there &= meet(simd, local, &bounds, reach);
            any |= local.there;
            found.t = reach.into();
            found.prim = [u32::MAX; 8];
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
            if let Some(near) = frame.load_near(simd, rays) {
                near.store(rays.there, local);
            } else {
                frame.rays(simd, rays, local);
            }
            let end = f32x8::load_array_ref(simd, &local.t_max);
            local.there = there & meet(simd, local, &bounds, end);
            any |= local.there;
        }
        any != 0
    }
}

/// Takes the hits in a part that are nearer than those so far, or as near and of a lower part.
struct Offer<'a, N> {
    names: &'a N,
    rays: &'a [Rays8],
    found: &'a [local::Hits8],
    ways: &'a [Ways8],
    hits: &'a mut [Hits8],
}

impl<N: Names> Kernel for Offer<'_, N> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { names, rays, found, ways, hits } = self;
        for (((rays, found), ways), hits) in rays.iter().zip(found).zip(ways).zip(hits) {
            if found.met == 0 {
                continue;
            }
            let [part, prim] = names.names(simd, found);
            // `Way::back`, step by step.
            let mut t = load(simd, &found.t);
            if !ways.same {
                let (low, high) = t.widen();
                let (scale, skip) = (halves(simd, &ways.scale), halves(simd, &ways.skip));
                t = ((low + skip[0]) / scale[0]).narrow((high + skip[1]) / scale[1]);
            }
            let (least, most) = (up(load(simd, &rays.t_min).abs()), down(load(simd, &rays.t_max)));
            let t = t.simd_gt(least).select(t, least);
            let t = t.simd_lt(most).select(t, most);
            let had = mask32x8::from_bitmask(simd, hits.met.into());
            let (best, best_part) = (load(simd, &hits.t), numbers(simd, &hits.part));
            let nearer = t.simd_lt(best) | (t.simd_eq(best) & part.simd_lt(best_part));
            let new = mask32x8::from_bitmask(simd, found.met.into()) & (nearer | !had);
            let bits = new.to_bitmask() as u32;
            if bits == 0xff {
                // Processors write some lanes of eight slowly.
                t.store_array(&mut hits.t);
                part.store_array(&mut hits.part);
                prim.store_array(&mut hits.prim);
                (hits.u, hits.v) = (found.u, found.v);
            } else if bits != 0 {
                new.select(t, best).store_array(&mut hits.t);
                new.select(part, best_part).store_array(&mut hits.part);
                new.select(prim, numbers(simd, &hits.prim)).store_array(&mut hits.prim);
                new.select(load(simd, &found.u), load(simd, &hits.u)).store_array(&mut hits.u);
                new.select(load(simd, &found.v), load(simd, &hits.v)).store_array(&mut hits.v);
            }
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
