//! All that rays can meet: primitives that were written one by one, and instances of trees.

mod approach;
mod bundle;
mod few;
mod loose;
mod upper;
mod within;

use std::sync::Arc;

use glam::{DAffine3, DVec3};

use crate::{
    Aabb, Coordinates, Cost, Hit, Hits8, Kernel, Primitives, Ray, Rays8, Surface, Surfaces8, Tree,
    build::{BuildError, BuildOptions},
    frame::Frame,
    level::Token,
    local,
    primitives::sphere::BLOCK,
    reference,
    surface::{self, Places, Surfaces},
    traverse::{self, Meter},
    tree,
};
use few::{Few, Spheres};
use loose::Loose;
use upper::Upper;

/// Up to so many instances are asked one by one; beyond that there is a tree over them.
const FEW: usize = 8;

/// One part of a world. Parts are numbered in the order they are given.
#[derive(Clone, Debug)]
pub enum Part {
    /// Primitives that were written one by one. All these share one tree, which is built with the world,
    /// and their numbers are about the world's centre. The only place for infinite planes.
    Own(Primitives),
    /// An object with a tree of its own, placed.
    Instance {
        /// The tree, which any number of instances share.
        tree: Arc<Tree>,
        /// From the object's own space, as its primitives were before [`Tree::center`] was taken off, to
        /// the world. Invertible.
        to_world: DAffine3,
    },
}

/// What rays meet. Immutable; shared freely between threads.
///
/// ```
/// use std::sync::Arc;
/// use glam::{DAffine3, DVec3, Vec3};
/// use phong_bvh::{BuildOptions, Part, Plane, Primitives, Ray, Sphere, Tree, World};
///
/// let options = BuildOptions::default();
/// let ball = Primitives::spheres(vec![Sphere { center: Vec3::ZERO, radius: 1.0 }]);
/// let tree = Arc::new(Tree::build(ball, options)?);
/// let floor = Plane { point: DVec3::ZERO, normal: DVec3::Y };
/// let at = |x| Part::Instance {
///     tree: Arc::clone(&tree),
///     to_world: DAffine3::from_translation(DVec3::new(x, 1.0, 0.0)),
/// };
/// let parts = vec![Part::Own(Primitives::Plane(floor)), at(-2.0), at(2.0)];
/// let world = World::build(parts, DVec3::ZERO, options)?;
///
/// let hit = world.intersect(&Ray::new(DVec3::new(2.0, 5.0, 0.0), Vec3::NEG_Y));
/// assert_eq!((hit.part, hit.prim, hit.t), (2, 0, 3.0));
/// # Ok::<(), phong_bvh::BuildError>(())
/// ```
#[derive(Debug)]
pub struct World {
    loose: Loose,
    instances: Vec<Instance>,
    /// Over the instances, where there are many.
    upper: Option<Upper>,
    places: Vec<Place>,
    /// The spheres that are asked together with the planes.
    with_planes: WithPlanes,
    /// Around everything but planes.
    bounds: Option<[DVec3; 2]>,
    token: Token,
}

/// Where a part is kept.
#[derive(Clone, Copy, Debug)]
enum Place {
    /// The number of its batch among those written one by one.
    Loose(u32),
    /// The number of the instance.
    Instance(u32),
}

/// The spheres that are asked together with the planes.
#[derive(Clone, Copy, Debug)]
enum WithPlanes {
    /// None.
    Nothing,
    /// Those written one by one, which are a single leaf. Part and number of each.
    Loose([[u32; 2]; 8]),
    /// Those of the instance of this number, which stand about the same origin.
    Instance(usize),
}

/// A placed tree.
#[derive(Debug)]
struct Instance {
    tree: Arc<Tree>,
    frame: Frame,
    /// The number of its part.
    part: u32,
}

/// What a world is made of.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stats {
    /// Primitives as rays meet them: those of an instance once for each.
    pub primitives: u64,
    /// Inner nodes, those of a tree once however many instances share it.
    pub nodes: u64,
    /// Bytes of nodes, leaves and the primitives' own arrays, those of a tree once.
    pub bytes: u64,
}

/// The best hit of a ray so far. Before the first it stands at the ray's end.
#[derive(Clone, Copy, Debug)]
struct Best(Hit);

impl Best {
    fn new(ray: &Ray) -> Self {
        Self(Hit { t: ray.t_max, ..Hit::NONE })
    }

    /// Takes a hit that is nearer, or as near and of a lower part.
    fn offer(&mut self, t: f32, part: u32, local::Hit { prim, u, v, .. }: local::Hit) {
        if t < self.0.t || (t == self.0.t && part < self.0.part) {
            self.0 = Hit { t, part, prim, u, v };
        }
    }

    fn hit(self) -> Hit {
        if self.0.is_some() { self.0 } else { Hit::NONE }
    }
}

impl World {
    /// Builds a world in the current rayon pool; it does not depend on the pool's size. Trees of instances
    /// are there already: what this takes time for are the primitives written one by one, and the tree
    /// over the instances.
    ///
    /// `center` is what was taken off the coordinates of all [`Part::Own`].
    ///
    /// # Errors
    /// [`BuildError::TooMany`], [`BuildError::NoSuchLevel`], [`BuildError::NoInverse`].
    pub fn build(
        parts: Vec<Part>,
        center: DVec3,
        options: BuildOptions,
    ) -> Result<Self, BuildError> {
        let token = tree::token(options)?;
        if parts.len() >= u32::MAX as usize {
            return Err(BuildError::TooMany(parts.len() as u64));
        }
        let mut places = Vec::with_capacity(parts.len());
        let (mut batches, mut numbers, mut instances) = (Vec::new(), Vec::new(), Vec::new());
        for (part, number) in parts.into_iter().zip(0..) {
            match part {
                Part::Own(primitives) => {
                    places.push(Place::Loose(batches.len() as u32));
                    batches.push(primitives);
                    numbers.push(number);
                }
                Part::Instance { tree, to_world } => {
                    places.push(Place::Instance(instances.len() as u32));
                    let frame = Frame::placed(&to_world, tree.center(), tree.bounds());
                    let frame = frame.ok_or(BuildError::NoInverse(number))?;
                    instances.push(Instance { tree, frame, part: number });
                }
            }
        }
        let loose = Loose::build(batches, numbers, center, options)?;
        let upper = (instances.len() > FEW)
            .then(|| Upper::build(&instances, center, options))
            .transpose()?;
        let bounds = approach::bounds(&loose, &instances);
        let with_planes = if let Some(names) = loose.names(token) {
            WithPlanes::Loose(names)
        } else if loose.has_tree() || upper.is_some() {
            WithPlanes::Nothing
        } else {
            let together = |instance: &Instance| {
                instance.few(token).is_some() && instance.frame.starts_at(loose.frame())
            };
            instances.iter().position(together).map_or(WithPlanes::Nothing, WithPlanes::Instance)
        };
        Ok(Self { loose, instances, upper, places, with_planes, bounds, token })
    }

    /// A world of primitives written one by one, about the origin.
    ///
    /// # Errors
    /// As [`World::build`].
    pub fn of(primitives: Vec<Primitives>, options: BuildOptions) -> Result<Self, BuildError> {
        Self::build(primitives.into_iter().map(Part::Own).collect(), DVec3::ZERO, options)
    }

    /// How many parts there are.
    pub fn parts(&self) -> usize {
        self.places.len()
    }

    /// The primitives of a part: about the world's centre, or in the space of a tree.
    ///
    /// # Panics
    /// If there is no such part.
    #[inline]
    pub fn primitives(&self, part: u32) -> &Primitives {
        match self.places[part as usize] {
            Place::Loose(batch) => &self.loose.tree().batches()[batch as usize],
            Place::Instance(instance) => self.instances[instance as usize].tree.primitives(),
        }
    }

    /// The closest hit with `t_min < t < t_max`; at equal `t` that of the lowest part, and of that the
    /// lowest primitive.
    pub fn intersect(&self, ray: &Ray) -> Hit {
        self.closest(ray, &mut ())
    }

    /// [`World::intersect`] with what it cost.
    pub fn intersect_counted(&self, ray: &Ray) -> (Hit, Cost) {
        let mut cost = Cost::default();
        (self.closest(ray, &mut cost), cost)
    }

    fn closest(&self, ray: &Ray, meter: &mut impl Meter) -> Hit {
        let mut best = Best::new(ray);
        self.loose.closest(self.token, ray, &mut best, meter);
        match &self.upper {
            None => {
                for instance in &self.instances {
                    instance.closest(self.token, ray, &mut best, meter);
                }
            }
            Some(upper) => upper.closest(self.token, &self.instances, ray, &mut best, meter),
        }
        best.hit()
    }

    /// Whether anything is hit with `t_min < t < t_max`.
    pub fn occluded(&self, ray: &Ray) -> bool {
        self.loose.any(self.token, ray)
            || match &self.upper {
                None => self.instances.iter().any(|instance| instance.any(self.token, ray)),
                Some(upper) => upper.any(self.token, &self.instances, ray),
            }
    }

    /// [`World::intersect`] for each ray of a bundle of eights: the same bits, faster where the rays are
    /// coherent; those that are missing hit nothing.
    ///
    /// # Panics
    /// If `hits` has not the length of `rays`.
    pub fn intersect_eights(&self, rays: &[Rays8], hits: &mut [Hits8]) {
        assert_eq!(rays.len(), hits.len(), "eight hits for eight rays");
        bundle::closest(self, rays, hits);
    }

    /// [`World::occluded`] for each ray of a bundle of eights, a bit each, the lowest for the first.
    ///
    /// # Panics
    /// If `blocked` has not the length of `rays`.
    pub fn occluded_eights(&self, rays: &[Rays8], blocked: &mut [u32]) {
        assert_eq!(rays.len(), blocked.len(), "an answer for eight rays");
        bundle::any(self, rays, blocked, false);
    }

    /// [`World::occluded_eights`] of rays that start close together and go everywhere, as many as there are at once, up to
    /// 4096: the same answers, among spheres alone sooner.
    ///
    /// # Panics
    /// If `blocked` has not the length of `rays`.
    pub fn occluded_scattered(&self, rays: &[Rays8], blocked: &mut [u32]) {
        assert_eq!(rays.len(), blocked.len(), "an answer for eight rays");
        bundle::any(self, rays, blocked, true);
    }

    /// Every primitive that a ray hits with `t_min < t < t_max`, each once, where it is hit first; in the
    /// order of the numbers of parts and primitives.
    pub fn every(&self, ray: &Ray, found: &mut Vec<Hit>) {
        found.clear();
        within::every(self, ray, found);
        found.sort_unstable_by_key(|hit| (hit.part, hit.prim));
        found.dedup_by_key(|hit| (hit.part, hit.prim));
    }

    /// [`World::intersect`] by trying every primitive: the same bits, slowly. The oracle of tests.
    pub fn intersect_brute_force(&self, ray: &Ray) -> Hit {
        let mut best = Best::new(ray);
        self.loose.brute_force(ray, &mut best);
        for Instance { tree, frame, part } in &self.instances {
            let (local, way) = frame.ray(ray);
            let hit = reference::intersect(tree, &local);
            if hit.is_some() {
                best.offer(way.back(hit.t, ray), *part, hit);
            }
        }
        best.hit()
    }

    /// The surface at a hit of `ray`.
    ///
    /// # Panics
    /// If `hit` is none.
    pub fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        surface::surface(self, ray, hit)
    }

    /// [`World::surface`] of a bundle of eights: the same bits. What is said of rays without a hit is
    /// unspecified.
    ///
    /// # Panics
    /// If `hits` or `surfaces` has not the length of `rays`.
    pub fn surface_eights(&self, rays: &[Rays8], hits: &[Hits8], surfaces: &mut [Surfaces8]) {
        assert_eq!((rays.len(), rays.len()), (hits.len(), surfaces.len()), "one for each");
        self.token.run(Surfaces { world: self, rays, hits, out: surfaces });
    }

    /// Where on its surface a hit of `ray` is.
    ///
    /// # Panics
    /// If `hit` is none.
    pub fn coordinates(&self, ray: &Ray, hit: &Hit) -> Coordinates {
        surface::coordinates(self, ray, hit)
    }

    /// Runs other vector code at the level that this world uses.
    #[inline]
    pub fn run<K: Kernel>(&self, kernel: K) -> K::Output {
        self.token.run(kernel)
    }

    /// What it is made of.
    pub fn stats(&self) -> Stats {
        let mut stats = Stats {
            primitives: u64::from(self.loose.tree().len()),
            nodes: self.loose.tree().nodes(),
            bytes: self.loose.tree().bytes(),
        };
        if let Some(upper) = &self.upper {
            stats.nodes += upper.nodes();
            stats.bytes += upper.bytes();
        }
        stats.bytes += size_of_val(&self.instances[..]) as u64;
        let mut trees: Vec<&Arc<Tree>> = self.instances.iter().map(|i| &i.tree).collect();
        stats.primitives += trees.iter().map(|tree| u64::from(tree.len())).sum::<u64>();
        trees.sort_unstable_by_key(|tree| Arc::as_ptr(tree));
        trees.dedup_by_key(|tree| Arc::as_ptr(tree));
        stats.nodes += trees.iter().map(|tree| tree.nodes()).sum::<u64>();
        stats.bytes += trees.iter().map(|tree| tree.bytes()).sum::<u64>();
        stats
    }
}

impl Places for World {
    #[inline]
    fn place(&self, part: u32) -> (&Primitives, &Frame) {
        match self.places[part as usize] {
            Place::Loose(batch) => self.loose.place(batch as usize),
            Place::Instance(instance) => {
                let Instance { tree, frame, .. } = &self.instances[instance as usize];
                (tree.primitives(), frame)
            }
        }
    }
}

impl Instance {
    fn rays(&self, token: Token) -> traverse::World<'_> {
        self.tree.rays(token)
    }

    /// The box of its tree; none: there is nothing in it.
    fn bounds(&self) -> Option<Aabb> {
        self.tree.bounds()
    }

    /// Its spheres, where they are all that it holds, and fit one leaf.
    fn few(&self, token: Token) -> Option<Few<'_>> {
        if !self.frame.is_upright() {
            return None;
        }
        let block = self.rays(token).single_leaf()?;
        let names = block[BLOCK - 1].0.map(|number| [self.part, number.to_bits()]);
        Some(Few { frame: &self.frame, planes: &[], spheres: Some(Spheres { block, names }) })
    }

    /// Offers its closest hit.
    ///
    /// Not inlined, so that the traversals of all levels do not stand in each level of the upper tree's.
    #[inline(never)]
    fn closest(&self, token: Token, ray: &Ray, best: &mut Best, meter: &mut impl Meter) {
        let (local, way) = self.frame.ray(ray);
        let mut found = traverse::Best::new(way.reach(best.0.t, ray));
        self.rays(token).closest(&local, &mut found, meter);
        if found.0.is_some() {
            best.offer(way.back(found.0.t, ray), self.part, found.0);
        }
    }

    #[inline(never)]
    fn any(&self, token: Token, ray: &Ray) -> bool {
        self.rays(token).any(&self.frame.ray(ray).0)
    }
}
