//! One ray at a time.

use fearless_simd::{Simd, f32x8, prelude::*};

use super::{Best, Meter, Stack, slabs::Slabs};
use crate::{
    Geometry, Ray,
    build::Tree,
    level::Kernel,
    node8::{Kind, NODE, REFS, Ref, Row, rows},
    primitives::{sphere, triangle},
};

/// The closest hit of one ray in the tree, given the best outside it.
pub(crate) struct Closest<'a, M> {
    pub(crate) tree: &'a Tree,
    pub(crate) geometry: &'a [Geometry],
    pub(crate) ray: &'a Ray,
    pub(crate) best: Best,
    pub(crate) stack: &'a mut Stack,
    pub(crate) meter: &'a mut M,
}

impl<M: Meter> Kernel for Closest<'_, M> {
    type Output = Best;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> Best {
        let Self { tree, geometry, ray, mut best, stack, meter } = self;
        let Some(root) = tree.root else { return best };
        let prepared = Prepared::new(simd, ray);
        let stack = &mut stack.0;
        let mut depth = 0;
        let mut at = root;
        let mut t_max = f32x8::splat(simd, best.0.t);
        loop {
            while at.kind().is_none() {
                meter.node();
                let node: &[Row; NODE] = rows(&tree.rows, at.row());
                let (mask, enter) = prepared.slabs.meet(simd, node, t_max);
                let mut mask = mask.to_bitmask() as u32;
                if mask == 0 {
                    match pop(stack, &mut depth, best.0.t) {
                        Some(next) => at = next,
                        None => return best,
                    }
                    continue;
                }
                let enter = enter.to_array();
                let parent = at.row();
                let mut next = || {
                    let lane = mask.trailing_zeros() as usize & 7;
                    mask &= mask - 1;
                    let child = Ref(node[REFS].bits(lane)).from(parent);
                    (u64::from(enter[lane].to_bits()) << 32 | u64::from(child.0), mask == 0)
                };
                let (first, alone) = next();
                if alone {
                    at = Ref(first as u32);
                    continue;
                }
                let (second, two) = next();
                if two {
                    at = Ref(first.min(second) as u32);
                    stack[depth] = first.max(second);
                    depth += 1;
                    continue;
                }
                // Nearest on top.
                let bottom = depth;
                stack[depth] = first.max(second);
                stack[depth + 1] = first.min(second);
                depth += 2;
                loop {
                    let (key, last) = next();
                    let mut place = depth;
                    while place > bottom && stack[place - 1] < key {
                        stack[place] = stack[place - 1];
                        place -= 1;
                    }
                    stack[place] = key;
                    depth += 1;
                    if last {
                        break;
                    }
                }
                depth -= 1;
                at = Ref(stack[depth] as u32);
            }
            meter.primitive();
            prepared.leaf(simd, tree, geometry, ray, at, &mut best);
            t_max = f32x8::splat(simd, best.0.t);
            match pop(stack, &mut depth, best.0.t) {
                Some(next) => at = next,
                None => return best,
            }
        }
    }
}

/// The next node that begins no farther than `t`.
#[inline(always)]
fn pop(stack: &[u64], depth: &mut usize, t: f32) -> Option<Ref> {
    while *depth > 0 {
        *depth -= 1;
        let key = stack[*depth];
        if f32::from_bits((key >> 32) as u32) <= t {
            return Some(Ref(key as u32));
        }
    }
    None
}

/// Whether one ray hits anything in the tree.
pub(crate) struct Any<'a> {
    pub(crate) tree: &'a Tree,
    pub(crate) geometry: &'a [Geometry],
    pub(crate) ray: &'a Ray,
    pub(crate) stack: &'a mut Stack,
}

impl Kernel for Any<'_> {
    type Output = bool;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> bool {
        let Self { tree, geometry, ray, stack } = self;
        let Some(root) = tree.root else { return false };
        let prepared = Prepared::new(simd, ray);
        let stack = &mut stack.0;
        let mut depth = 0;
        let mut at = root;
        let t_max = f32x8::splat(simd, ray.t_max);
        loop {
            if at.kind().is_none() {
                let node: &[Row; NODE] = rows(&tree.rows, at.row());
                let mut mask = prepared.slabs.meet(simd, node, t_max).0.to_bitmask() as u32;
                if mask != 0 {
                    let parent = at.row();
                    let child = |mask: u32| {
                        Ref(node[REFS].bits(mask.trailing_zeros() as usize)).from(parent)
                    };
                    at = child(mask);
                    mask &= mask - 1;
                    while mask != 0 {
                        stack[depth] = u64::from(child(mask).0);
                        depth += 1;
                        mask &= mask - 1;
                    }
                    continue;
                }
            } else if prepared.leaf_any(simd, tree, geometry, ray, at) {
                return true;
            }
            if depth == 0 {
                return false;
            }
            depth -= 1;
            at = Ref(stack[depth] as u32);
        }
    }
}

/// What the tests need of a ray.
struct Prepared<S: Simd> {
    slabs: Slabs<S>,
    shear: triangle::Shear,
    shear8: triangle::Shear8<S>,
    closest8: sphere::Closest8<S>,
}

impl<S: Simd> Prepared<S> {
    #[inline(always)]
    fn new(simd: S, ray: &Ray) -> Self {
        let shear = triangle::Shear::new(ray);
        Self {
            slabs: Slabs::new(simd, ray),
            shear,
            shear8: triangle::Shear8::new(simd, &shear),
            closest8: sphere::Closest8::new(simd, &sphere::Closest::new(ray)),
        }
    }

    /// Offers the hits in a leaf.
    #[inline(always)]
    fn leaf(
        &self,
        simd: S,
        tree: &Tree,
        geometry: &[Geometry],
        ray: &Ray,
        leaf: Ref,
        best: &mut Best,
    ) {
        match leaf.kind() {
            Some(Kind::Triangles) => {
                let block = rows(&tree.rows, leaf.row());
                let mut mask = self.shear8.filter(simd, block);
                while mask != 0 {
                    let lane = mask.trailing_zeros() as usize;
                    mask &= mask - 1;
                    let prim = block[triangle::BLOCK - 1].bits(lane);
                    if prim != u32::MAX
                        && let Some([t, u, v]) =
                            triangle::verdict(&self.shear, triangle::corners(block, lane))
                    {
                        best.offer(t, prim, u, v);
                    }
                }
            }
            Some(Kind::Spheres) => {
                let block = rows(&tree.rows, leaf.row());
                let (mut mask, t) = self.closest8.intersect(simd, block);
                if mask != 0 {
                    let t = t.to_array();
                    while mask != 0 {
                        let lane = mask.trailing_zeros() as usize & 7;
                        mask &= mask - 1;
                        // An unused lane has no number and loses every tie to the one it repeats.
                        best.offer(t[lane], block[sphere::BLOCK - 1].bits(lane), 0.0, 0.0);
                    }
                }
            }
            _ => {
                let row = tree.rows[leaf.row()];
                if let Geometry::Solid(solid) = &geometry[row.bits(1) as usize]
                    && let Some(t) = solid.intersect(ray)
                {
                    best.offer(t, row.bits(0), 0.0, 0.0);
                }
            }
        }
    }

    /// Whether anything in a leaf is hit.
    #[inline(always)]
    fn leaf_any(&self, simd: S, tree: &Tree, geometry: &[Geometry], ray: &Ray, leaf: Ref) -> bool {
        match leaf.kind() {
            Some(Kind::Triangles) => {
                let block = rows(&tree.rows, leaf.row());
                let mut mask = self.shear8.filter(simd, block);
                while mask != 0 {
                    let lane = mask.trailing_zeros() as usize;
                    mask &= mask - 1;
                    if triangle::verdict(&self.shear, triangle::corners(block, lane)).is_some() {
                        return true;
                    }
                }
                false
            }
            Some(Kind::Spheres) => {
                self.closest8.intersect(simd, rows(&tree.rows, leaf.row())).0 != 0
            }
            _ => {
                let row = tree.rows[leaf.row()];
                match &geometry[row.bits(1) as usize] {
                    Geometry::Solid(solid) => solid.intersect(ray).is_some(),
                    _ => false,
                }
            }
        }
    }
}
