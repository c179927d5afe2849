//! The primitives of a leaf against one ray.
//!
//! Most trees hold only triangles, only spheres or only cylinders. Each kind of tree has its own copy of the
//! traversal, which prepares only what its leaves need of a ray.

use fearless_simd::{Simd, f32x8, prelude::*};

use super::{Best, World};
use crate::{
    Primitives,
    local::Ray,
    node8::{Kind, Ref, Row, rows},
    primitives::{
        capsule::{self, Seen8},
        ray_frame::RayFrame,
        sphere::{self, Closest, Closest8},
        tapered::Tapered,
        triangle::{self, Shear, Shear8},
    },
};

/// A kind of tree.
pub(super) trait Content {
    /// Its leaves' tests.
    type Leaves<S: Simd>: Leaves<S>;
    /// Whether there may be leaves of triangles.
    const TRIANGLES: bool = true;
    /// Whether groups are worth while for any-hit queries. Among many spheres each ray is soon blocked by
    /// another one, before a group has saved what it cost.
    const ANY_TOGETHER: bool = true;
    /// Whether groups prepare their rays for leaves of cylinders.
    const CYLINDERS: bool = false;
}

/// A ray prepared for the primitives of leaves.
pub(super) trait Leaves<S: Simd>: Copy {
    /// Prepares a ray.
    fn new(simd: S, ray: &Ray) -> Self;

    /// Offers the hits in a leaf.
    fn offer(&self, simd: S, world: &World<'_>, ray: &Ray, leaf: Ref, best: &mut Best);

    /// Whether anything in a leaf is hit.
    fn any(&self, simd: S, world: &World<'_>, ray: &Ray, leaf: Ref) -> bool;
}

/// Triangles alone.
pub(super) struct OnlyTriangles;
/// Spheres alone.
pub(super) struct OnlySpheres;
/// Cylinders alone.
pub(super) struct OnlyCylinders;
/// All there is.
pub(super) struct Anything;

impl Content for OnlyTriangles {
    type Leaves<S: Simd> = Triangles<S>;
}

impl Content for OnlySpheres {
    type Leaves<S: Simd> = Spheres<S>;
    const TRIANGLES: bool = false;
    const ANY_TOGETHER: bool = false;
}

impl Content for OnlyCylinders {
    type Leaves<S: Simd> = Cylinders<S>;
    const TRIANGLES: bool = false;
    const ANY_TOGETHER: bool = false;
    const CYLINDERS: bool = true;
}

impl Content for Anything {
    type Leaves<S: Simd> = Mixed<S>;
}

/// A ray prepared for triangles.
#[derive(Clone, Copy)]
pub(super) struct Triangles<S: Simd> {
    shear: Shear,
    shear8: Shear8<S>,
}

impl<S: Simd> Leaves<S> for Triangles<S> {
    #[inline(always)]
    fn new(simd: S, ray: &Ray) -> Self {
        Self::of(simd, Shear::new(ray))
    }

    #[inline(always)]
    fn offer(&self, simd: S, world: &World<'_>, _: &Ray, leaf: Ref, best: &mut Best) {
        self.offer_block(simd, rows(world.rows, leaf.row()), best);
    }

    #[inline(always)]
    fn any(&self, simd: S, world: &World<'_>, _: &Ray, leaf: Ref) -> bool {
        self.any_block(simd, rows(world.rows, leaf.row()))
    }
}

impl<S: Simd> Triangles<S> {
    /// A ray that is prepared already.
    #[inline(always)]
    pub(super) fn of(simd: S, shear: Shear) -> Self {
        Self { shear, shear8: Shear8::new(simd, &shear) }
    }

    #[inline(always)]
    fn offer_block(&self, simd: S, block: &[Row; triangle::BLOCK], best: &mut Best) {
        let mut mask = self.shear8.filter(simd, block);
        while mask != 0 {
            let lane = mask.trailing_zeros() as usize;
            mask &= mask - 1;
            let prim = block[triangle::BLOCK - 1].bits(lane);
            if prim != u32::MAX
                && let Some([t, u, v]) = self.shear.intersect_lane(block, lane)
            {
                best.offer(t, prim, u, v);
            }
        }
    }

    #[inline(always)]
    fn any_block(&self, simd: S, block: &[Row; triangle::BLOCK]) -> bool {
        let mut mask = self.shear8.filter(simd, block);
        while mask != 0 {
            let lane = mask.trailing_zeros() as usize;
            mask &= mask - 1;
            if self.shear.intersect_lane(block, lane).is_some() {
                return true;
            }
        }
        false
    }
}

/// A ray prepared for spheres.
#[derive(Clone, Copy)]
pub(super) struct Spheres<S: Simd> {
    closest8: Closest8<S>,
}

impl<S: Simd> Leaves<S> for Spheres<S> {
    #[inline(always)]
    fn new(simd: S, ray: &Ray) -> Self {
        Self { closest8: Closest8::new(simd, &Closest::new(ray)) }
    }

    #[inline(always)]
    fn offer(&self, simd: S, world: &World<'_>, _: &Ray, leaf: Ref, best: &mut Best) {
        let block = rows(world.rows, leaf.row());
        let (mut mask, t) = self.closest8.intersect(simd, block);
        if mask != 0 {
            let t = t.to_array();
            while mask != 0 {
                let lane = mask.trailing_zeros() as usize & 7;
                mask &= mask - 1;
                // An unused lane has no number, and loses every tie to the one it repeats.
                best.offer(t[lane], block[sphere::BLOCK - 1].bits(lane), 0.0, 0.0);
            }
        }
    }

    #[inline(always)]
    fn any(&self, simd: S, world: &World<'_>, _: &Ray, leaf: Ref) -> bool {
        self.closest8.intersect(simd, rows(world.rows, leaf.row())).0 != 0
    }
}

/// A ray prepared for cylinders.
///
/// What comes after the question that most rays fail is a function of its own for each level: inlined into
/// every traversal it made compiling the crate take far longer.
#[derive(Clone, Copy)]
pub(super) struct Cylinders<S: Simd> {
    frame: RayFrame<f32x8<S>>,
}

impl<S: Simd> Cylinders<S> {
    /// A ray that is prepared already.
    #[inline(always)]
    pub(super) fn of(simd: S, frame: &RayFrame<f32>) -> Self {
        Self { frame: frame.eight(simd) }
    }
}

impl<S: Simd> Leaves<S> for Cylinders<S> {
    #[inline(always)]
    fn new(simd: S, ray: &Ray) -> Self {
        Self::of(simd, &RayFrame::new(ray))
    }

    #[inline(always)]
    fn offer(&self, simd: S, world: &World<'_>, ray: &Ray, leaf: Ref, best: &mut Best) {
        let block = rows(world.rows, leaf.row());
        let seen = Seen8::new(simd, &self.frame, block);
        let may = seen.may_meet(simd);
        if may != 0 {
            offer_lanes(simd, ray, block, seen, may, best);
        }
    }

    #[inline(always)]
    fn any(&self, simd: S, world: &World<'_>, ray: &Ray, leaf: Ref) -> bool {
        let block = rows(world.rows, leaf.row());
        let seen = Seen8::new(simd, &self.frame, block);
        let may = seen.may_meet(simd);
        may != 0 && any_lane(simd, ray, block, seen, may)
    }
}

/// Offers the hits among the lanes `may`.
fn offer_lanes<S: Simd>(
    simd: S,
    ray: &Ray,
    block: &[Row; capsule::BLOCK],
    seen: Seen8<'_, S>,
    may: u32,
    best: &mut Best,
) {
    simd.vectorize(
        #[inline(always)]
        || {
            let met = seen.intersect(simd, may);
            let mut hit = met.hit;
            while hit != 0 {
                let lane = hit.trailing_zeros() as usize & 7;
                hit &= hit - 1;
                best.offer_cylinder(met.at(lane), block[capsule::BLOCK - 1].bits(lane));
            }
            if met.tapered != 0 {
                offer_tapered(ray, block, met.tapered, best);
            }
        },
    );
}

/// Whether anything is hit among the lanes `may`.
fn any_lane<S: Simd>(
    simd: S,
    ray: &Ray,
    block: &[Row; capsule::BLOCK],
    seen: Seen8<'_, S>,
    may: u32,
) -> bool {
    simd.vectorize(
        #[inline(always)]
        || {
            let met = seen.intersect(simd, may);
            met.hit != 0
                || met.tapered != 0 && {
                    let mut best = Best::new(ray.t_max);
                    offer_tapered(ray, block, met.tapered, &mut best);
                    best.0.is_some()
                }
        },
    )
}

/// Offers the hits among lanes of a block that have two radii. An unused lane has no number, and repeats the
/// first.
#[inline(never)]
fn offer_tapered(ray: &Ray, block: &[Row; capsule::BLOCK], lanes: u32, best: &mut Best) {
    for lane in crate::lanes(lanes) {
        let number = block[capsule::BLOCK - 1].bits(lane);
        if number == u32::MAX {
            break;
        }
        let numbers = std::array::from_fn(|row| block[row].0[lane]);
        if let Some(at) = Tapered::of_lane(numbers).intersect(ray) {
            best.offer_cylinder(at, number);
        }
    }
}

/// A ray prepared for everything.
#[derive(Clone, Copy)]
pub(super) struct Mixed<S: Simd> {
    triangles: Triangles<S>,
    spheres: Spheres<S>,
}

impl<S: Simd> Leaves<S> for Mixed<S> {
    #[inline(always)]
    fn new(simd: S, ray: &Ray) -> Self {
        Self { triangles: Triangles::new(simd, ray), spheres: Spheres::new(simd, ray) }
    }

    #[inline(always)]
    fn offer(&self, simd: S, world: &World<'_>, ray: &Ray, leaf: Ref, best: &mut Best) {
        match leaf.kind() {
            Some(Kind::Triangles) => self.triangles.offer(simd, world, ray, leaf, best),
            Some(Kind::Spheres) => self.spheres.offer(simd, world, ray, leaf, best),
            Some(Kind::Solid) => {
                let (hit, prim) = solid(world, ray, leaf);
                if let Some((t, [u, v])) = hit {
                    best.offer(t, prim, u, v);
                }
            }
            Some(Kind::Indexed) => {
                self.triangles.offer_block(simd, &gather(world, leaf), best);
            }
            Some(Kind::Cylinders) => Cylinders::new(simd, ray).offer(simd, world, ray, leaf, best),
            None => {}
        }
    }

    #[inline(always)]
    fn any(&self, simd: S, world: &World<'_>, ray: &Ray, leaf: Ref) -> bool {
        match leaf.kind() {
            Some(Kind::Triangles) => self.triangles.any(simd, world, ray, leaf),
            Some(Kind::Spheres) => self.spheres.any(simd, world, ray, leaf),
            Some(Kind::Solid) => solid(world, ray, leaf).0.is_some(),
            Some(Kind::Indexed) => self.triangles.any_block(simd, &gather(world, leaf)),
            Some(Kind::Cylinders) => Cylinders::new(simd, ray).any(simd, world, ray, leaf),
            None => false,
        }
    }
}

/// Where a solid is hit, and its number.
#[inline(never)]
fn solid(world: &World<'_>, ray: &Ray, leaf: Ref) -> (Option<(f32, [f32; 2])>, u32) {
    let row = world.rows[leaf.row()];
    let hit = match &world.geometry[row.bits(1) as usize] {
        Primitives::Solid(solid) => solid.intersect(ray),
        _ => None,
    };
    (hit, row.bits(0))
}

/// The block of triangles that a leaf names. Unused lanes repeat the first, with no number.
fn gather(world: &World<'_>, leaf: Ref) -> [Row; triangle::BLOCK] {
    let [locals, geometries]: &[Row; 2] = rows(world.rows, leaf.row());
    let mut block = [Row::ZERO; triangle::BLOCK];
    for lane in 0..8 {
        let used = locals.bits(lane) != u32::MAX;
        let from = if used { lane } else { 0 };
        let (local, index) = (locals.bits(from) as usize, geometries.bits(from) as usize);
        if let Primitives::Triangles { positions, indices } = &world.geometry[index] {
            for (corner, &vertex) in indices[local].iter().enumerate() {
                let [x, y, z] = positions[vertex as usize].to_array();
                block[3 * corner].0[lane] = x;
                block[3 * corner + 1].0[lane] = y;
                block[3 * corner + 2].0[lane] = z;
            }
        }
        let prim = if used { world.first[index] + local as u32 } else { u32::MAX };
        block[triangle::BLOCK - 1].0[lane] = f32::from_bits(prim);
    }
    block
}
