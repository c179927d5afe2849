//! Primitives that were written one by one: one tree over all that have bounds, and planes outside.

use std::ops::Range;

use glam::DVec3;

use super::Best;
use crate::{
    Plane, Primitives, Ray, Tree,
    build::{BuildError, BuildOptions},
    frame::{Frame, Way},
    level::Token,
    local,
    primitives::sphere::BLOCK,
    reference,
    traverse::{self, Meter},
};

/// All primitives written one by one.
#[derive(Debug)]
pub(super) struct Loose {
    tree: Tree,
    /// The planes, each with the part that it is.
    planes: Vec<(Plane, u32)>,
    /// The part that each batch is.
    parts: Vec<u32>,
    /// Where the tree stands.
    frame: Frame,
    /// Where the planes stand: there too, but rays are not moved along to them.
    whole: Frame,
}

impl Loose {
    pub(super) fn build(
        batches: Vec<Primitives>,
        parts: Vec<u32>,
        center: DVec3,
        options: BuildOptions,
    ) -> Result<Self, BuildError> {
        let plane = |(batch, &part): (&Primitives, &u32)| match batch {
            Primitives::Plane(plane) => Some((*plane, part)),
            _ => None,
        };
        let planes = batches.iter().zip(&parts).filter_map(plane).collect();
        let tree = Tree::of(batches, options)?;
        let (frame, whole) = (Frame::about(center, tree.bounds()), Frame::about(center, None));
        Ok(Self { tree, planes, parts, frame, whole })
    }

    pub(super) fn tree(&self) -> &Tree {
        &self.tree
    }

    /// The planes, each with its part.
    pub(super) fn planes(&self) -> &[(Plane, u32)] {
        &self.planes
    }

    pub(super) fn has_planes(&self) -> bool {
        !self.planes.is_empty()
    }

    /// Whether anything is in the tree.
    pub(super) fn has_tree(&self) -> bool {
        self.tree.bounds().is_some()
    }

    /// Where the tree stands.
    pub(super) fn frame(&self) -> &Frame {
        &self.frame
    }

    /// Part and number of each sphere, where the tree is a single leaf of them.
    pub(super) fn names(&self, token: Token) -> Option<[[u32; 2]; 8]> {
        let block = self.tree.rays(token).single_leaf()?;
        let mut names = [[u32::MAX; 2]; 8];
        for (number, name) in block[BLOCK - 1].0.iter().zip(&mut names) {
            let number = number.to_bits();
            if number != u32::MAX {
                let batch = self.batch(0, number);
                *name = [self.part(batch), number - self.numbers(batch).start];
            }
        }
        Some(names)
    }

    /// A batch, and where it stands.
    #[inline]
    pub(super) fn place(&self, batch: usize) -> (&Primitives, &Frame) {
        let primitives = &self.tree.batches()[batch];
        let is_plane = matches!(primitives, Primitives::Plane(_));
        (primitives, if is_plane { &self.whole } else { &self.frame })
    }

    /// The batch that a primitive of the tree is of; most often `guess`.
    #[inline]
    pub(super) fn batch(&self, guess: usize, number: u32) -> usize {
        if self.numbers(guess).contains(&number) {
            return guess;
        }
        self.tree.first().partition_point(|&first| first <= number) - 1
    }

    /// The numbers that a batch's primitives have in the tree.
    #[inline]
    pub(super) fn numbers(&self, batch: usize) -> Range<u32> {
        self.tree.first()[batch]..self.tree.first()[batch + 1]
    }

    /// The part that a batch is.
    #[inline]
    pub(super) fn part(&self, batch: usize) -> u32 {
        self.parts[batch]
    }

    fn offer_planes(&self, ray: &Ray, best: &mut Best, meter: &mut impl Meter) {
        if self.planes.is_empty() {
            return;
        }
        let (local, _) = self.whole.ray(ray);
        for &(plane, part) in &self.planes {
            meter.primitive();
            if let Some(t) = plane.intersect(&local) {
                best.offer(t, part, local::Hit { prim: 0, ..local::Hit::NONE });
            }
        }
    }

    fn offer(&self, found: local::Hit, way: Way<f64>, ray: &Ray, best: &mut Best) {
        if found.is_some() {
            let batch = self.batch(0, found.prim);
            let prim = found.prim - self.numbers(batch).start;
            best.offer(way.back(found.t, ray), self.part(batch), local::Hit { prim, ..found });
        }
    }

    /// Gives `add` the part of every plane hit, and where.
    pub(super) fn each_plane_hit(&self, ray: &Ray, mut add: impl FnMut(u32, f32)) {
        let (local, _) = self.whole.ray(ray);
        for &(plane, part) in &self.planes {
            if let Some(t) = plane.intersect(&local) {
                add(part, t);
            }
        }
    }

    /// Offers the closest hit.
    #[inline(never)]
    pub(super) fn closest(&self, token: Token, ray: &Ray, best: &mut Best, meter: &mut impl Meter) {
        self.offer_planes(ray, best, meter);
        if self.has_tree() {
            let (local, way) = self.frame.ray(ray);
            let mut found = traverse::Best::new(way.reach(best.0.t, ray));
            self.tree.rays(token).closest(&local, &mut found, meter);
            self.offer(found.0, way, ray, best);
        }
    }

    /// Whether anything is hit.
    #[inline(never)]
    pub(super) fn any(&self, token: Token, ray: &Ray) -> bool {
        if self.has_planes() {
            let (local, _) = self.whole.ray(ray);
            if self.planes.iter().any(|(plane, _)| plane.intersect(&local).is_some()) {
                return true;
            }
        }
        self.has_tree() && self.tree.rays(token).any(&self.frame.ray(ray).0)
    }

    /// Offers the closest hit, by trying every primitive.
    pub(super) fn brute_force(&self, ray: &Ray, best: &mut Best) {
        self.offer_planes(ray, best, &mut ());
        let (local, way) = self.frame.ray(ray);
        self.offer(reference::intersect(&self.tree, &local), way, ray, best);
    }
}
