//! The bounding volume hierarchy: the door of this crate.

use std::ops::Range;

use thiserror::Error;

use crate::{
    Coordinates, Hit, Hits8, Level, Primitives, Ray, Rays8, Surface,
    build::{self, Tree},
    level::{Kernel, Token},
    reference,
    surface::{self, Surfaces, Surfaces8},
    traverse::{Best, Meter, Planes, World},
};

/// A built hierarchy, with the geometry it was built from.
#[derive(Debug)]
pub struct Bvh {
    geometry: Vec<Primitives>,
    /// First primitive number of each geometry, and the total at the end.
    first: Vec<u32>,
    /// Indices of the planes among the geometry: they have no bounds and stay out of the tree.
    planes: Vec<usize>,
    tree: Tree,
    token: Token,
}

/// How to build.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BuildOptions {
    /// How much time to spend on a better tree.
    pub preset: Preset,
    /// The vector instructions to use, by building and tracing. None: the fastest of this machine.
    pub level: Option<Level>,
}

/// How much time to spend on a better tree. The preset never changes a result.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Preset {
    /// Soonest built: for fewer than two rays a primitive.
    Fast,
    /// The usual choice.
    #[default]
    Balanced,
    /// Fastest to trace.
    Best,
    /// Least memory.
    Compact,
}

impl Preset {
    /// The preset that takes the least time in all for so many primitives and rays, of every kind and
    /// in all samples of all pictures: [`Fast`](Self::Fast) up to two rays a primitive, then
    /// [`Balanced`](Self::Balanced).
    ///
    /// A function of the two numbers alone, so that a tree is the same on every machine.
    ///
    /// ```
    /// use phong_bvh::Preset;
    ///
    /// let rays = 2 * 1920 * 1080;
    /// assert_eq!(Preset::for_rays(20_000_000, rays), Preset::Fast);
    /// assert_eq!(Preset::for_rays(1_000_000, rays), Preset::Balanced);
    /// ```
    pub const fn for_rays(primitives: u64, rays: u64) -> Self {
        // Measured on spheres and meshes (NOTES.md): a ray loses half of the time that a primitive
        // saves.
        if rays / 2 < primitives { Self::Fast } else { Self::Balanced }
    }
}

/// Why a hierarchy could not be built.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum BuildError {
    /// More primitives than numbers, in one geometry or in all: the caller's fault.
    #[error(
        "{0} primitives are too many: one mesh or cloud holds at most {of_one}, all together {all}",
        of_one = build::MOST_OF_ONE,
        all = u32::MAX - 1
    )]
    TooMany(u64),
    /// The level asked for is not one of this machine: the caller's fault.
    #[error("this machine has no level {0:?}; leave the level out to use its fastest")]
    NoSuchLevel(Level),
}

/// What tracing one ray cost. Differs between SIMD levels and presets.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cost {
    /// Nodes visited.
    pub nodes: u32,
    /// Primitives (or blocks of them) tested.
    pub primitives: u32,
}

/// What a hierarchy is made of.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stats {
    /// Primitives, infinite ones included.
    pub primitives: u64,
    /// Inner nodes.
    pub nodes: u64,
    /// Bytes of nodes and leaves, without the geometry's own arrays.
    pub bytes: u64,
}

impl Bvh {
    /// Builds a hierarchy in the current rayon pool; the result does not depend on its size.
    ///
    /// # Errors
    /// [`BuildError::TooMany`], [`BuildError::NoSuchLevel`].
    pub fn build(geometry: Vec<Primitives>, options: BuildOptions) -> Result<Self, BuildError> {
        let level = options.level.unwrap_or_else(Level::detect);
        let token = Token::of(level).ok_or(BuildError::NoSuchLevel(level))?;
        let total: u64 = geometry.iter().map(|g| g.len() as u64).sum();
        if total >= u64::from(u32::MAX) {
            return Err(BuildError::TooMany(total));
        }
        let mut first = vec![0];
        let mut end = 0;
        first.extend(geometry.iter().map(|g| {
            end += g.len() as u32;
            end
        }));
        let planes = (0..geometry.len()).filter(|&i| matches!(geometry[i], Primitives::Plane(_)));
        let planes = planes.collect();
        let tree = build::build(&geometry, &first, options.preset, token)
            .map_err(|build::TooLarge| BuildError::TooMany(total))?;
        Ok(Self { geometry, first, planes, tree, token })
    }

    /// The geometry, in the order it was given.
    #[inline]
    pub fn geometry(&self) -> &[Primitives] {
        &self.geometry
    }

    /// The primitive numbers of geometry `index`.
    pub fn primitives(&self, index: usize) -> Range<u32> {
        self.first[index]..self.first[index + 1]
    }

    /// The primitive numbers of the geometry that one belongs to. `index`, its number, is changed
    /// where it is of another: neighbours are mostly of the same.
    ///
    /// # Panics
    /// If there is no such primitive.
    #[inline]
    pub fn primitives_around(&self, index: &mut usize, prim: u32) -> Range<u32> {
        let here = self.primitives(*index);
        if here.contains(&prim) {
            return here;
        }
        *index = self.locate(prim).0;
        self.primitives(*index)
    }

    /// Which geometry a primitive number belongs to, and its number within.
    ///
    /// # Panics
    /// If there is no such primitive.
    #[inline]
    pub fn locate(&self, prim: u32) -> (usize, u32) {
        let index = self.first.partition_point(|&f| f <= prim) - 1;
        (index, prim - self.first[index])
    }

    /// The closest hit with `t_min < t < t_max`; at equal `t` the lowest primitive number.
    pub fn intersect(&self, ray: &Ray) -> Hit {
        self.closest(ray, &mut ())
    }

    fn closest(&self, ray: &Ray, meter: &mut impl Meter) -> Hit {
        let mut best = self.outside(ray, meter);
        self.world().closest(ray, &mut best, meter);
        best.hit()
    }

    /// The closest hit outside the tree.
    fn outside(&self, ray: &Ray, meter: &mut impl Meter) -> Best {
        let mut best = Best::new(ray.t_max);
        for &index in &self.planes {
            meter.primitive();
            if let Primitives::Plane(plane) = &self.geometry[index]
                && let Some(t) = plane.intersect(ray)
            {
                best.offer(t, self.first[index], 0.0, 0.0);
            }
        }
        best
    }

    /// Whether anything outside the tree is hit.
    fn blocked_outside(&self, ray: &Ray) -> bool {
        self.planes.iter().any(|&index| match &self.geometry[index] {
            Primitives::Plane(plane) => plane.intersect(ray).is_some(),
            _ => false,
        })
    }

    fn world(&self) -> World<'_> {
        World::new(&self.tree, &self.geometry, &self.first, self.token)
    }

    /// Whether anything is hit with `t_min < t < t_max`.
    pub fn occluded(&self, ray: &Ray) -> bool {
        self.blocked_outside(ray) || self.world().any(ray)
    }

    /// [`Bvh::intersect`] for each ray of a bundle: the same bits, faster where the rays are
    /// coherent.
    ///
    /// # Panics
    /// If `hits` has not the length of `rays`.
    pub fn intersect_bundle(&self, rays: &[Ray], hits: &mut [Hit]) {
        assert_eq!(rays.len(), hits.len(), "one hit for each ray");
        // A loop of its own where nothing is outside: it took a coherent ray a fifth of its time.
        if self.planes.is_empty() {
            for (ray, hit) in rays.iter().zip(&mut *hits) {
                *hit = Best::new(ray.t_max).0;
            }
        } else {
            for (ray, hit) in rays.iter().zip(&mut *hits) {
                *hit = self.outside(ray, &mut ()).0;
            }
        }
        self.world().closest_of_many(rays, hits);
        for hit in hits {
            *hit = Best(*hit).hit();
        }
    }

    /// [`Bvh::occluded`] for each ray of a bundle.
    ///
    /// # Panics
    /// If `blocked` has not the length of `rays`.
    pub fn occluded_bundle(&self, rays: &[Ray], blocked: &mut [bool]) {
        assert_eq!(rays.len(), blocked.len(), "one answer for each ray");
        for (ray, blocked) in rays.iter().zip(&mut *blocked) {
            *blocked = self.blocked_outside(ray);
        }
        self.world().any_of_many(rays, blocked);
    }

    /// [`Bvh::intersect`] for each ray of a bundle of eights: the same bits. Where few things are in
    /// the scene it is faster than one behind the other; those that are missing hit nothing.
    ///
    /// # Panics
    /// If `hits` has not the length of `rays`.
    pub fn intersect_eights(&self, rays: &[Rays8], hits: &mut [Hits8]) {
        assert_eq!(rays.len(), hits.len(), "eight hits for eight rays");
        self.world().closest_of_eights(self.outside_of_tree(), rays, hits);
    }

    /// [`Bvh::occluded`] for each ray of a bundle of eights, a bit each, the lowest for the first.
    ///
    /// # Panics
    /// If `blocked` has not the length of `rays`.
    pub fn occluded_eights(&self, rays: &[Rays8], blocked: &mut [u32]) {
        assert_eq!(rays.len(), blocked.len(), "an answer for eight rays");
        self.world().any_of_eights(self.outside_of_tree(), rays, blocked);
    }

    fn outside_of_tree(&self) -> Planes<'_> {
        Planes { geometry: &self.geometry, which: &self.planes, first: &self.first }
    }

    /// [`Bvh::intersect`] with what it cost.
    pub fn intersect_counted(&self, ray: &Ray) -> (Hit, Cost) {
        let mut cost = Cost::default();
        (self.closest(ray, &mut cost), cost)
    }

    /// [`Bvh::intersect`] by trying every primitive: the same bits, slowly. The oracle of tests.
    pub fn intersect_brute_force(&self, ray: &Ray) -> Hit {
        reference::intersect(self, ray)
    }

    /// The surface at a hit of `ray`.
    ///
    /// # Panics
    /// If `hit` is none.
    pub fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        surface::surface(self, ray, hit)
    }

    /// [`Bvh::surface`] of a bundle of eights: the same bits. What is said of rays without a hit is of no
    /// account.
    ///
    /// # Panics
    /// If `hits` or `surfaces` has not the length of `rays`.
    pub fn surface_eights(&self, rays: &[Rays8], hits: &[Hits8], surfaces: &mut [Surfaces8]) {
        assert_eq!((rays.len(), rays.len()), (hits.len(), surfaces.len()), "one for each");
        self.token.run(Surfaces { bvh: self, rays, hits, out: surfaces });
    }

    /// Where on its surface a hit of `ray` is.
    ///
    /// # Panics
    /// If `hit` is none.
    pub fn coordinates(&self, ray: &Ray, hit: &Hit) -> Coordinates {
        surface::coordinates(self, ray, hit)
    }

    /// Runs other vector code at the level that this hierarchy uses.
    #[inline]
    pub fn run<K: Kernel>(&self, kernel: K) -> K::Output {
        self.token.run(kernel)
    }

    /// What it is made of.
    pub fn stats(&self) -> Stats {
        let primitives = u64::from(self.first[self.geometry.len()]);
        Stats { primitives, nodes: self.tree.nodes, bytes: self.tree.bytes() }
    }

    /// The tree.
    #[cfg(test)]
    pub(crate) fn tree(&self) -> &Tree {
        &self.tree
    }
}
