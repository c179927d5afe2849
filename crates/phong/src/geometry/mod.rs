//! What rays meet: the trees, and what belongs to their primitives. Nothing of the look is here.
//!
//! Groups are unfolded. A mesh or a cloud has a tree of its own, built once from the scene's own
//! arrays however many objects share them; each object is an instance of it with a transform, which
//! rays pass in f64. What is written one by one shares one tree about its middle, with transforms
//! applied in f64.

mod batch;
mod build;
mod change;
mod closed;
mod estimate;
mod flatten;
mod scale;
mod smooth;
mod solid;
mod tangents;
mod trees;

use glam::{DAffine3, DVec3};
use phong_bvh::{BuildError, BuildOptions, Coordinates, Hit, Preset, Primitives, Ray, World};
use phong_scene::{Diagnostic, Place, Scene, Shape, SoundArrays};
use thiserror::Error;

pub(crate) use batch::{Batch, Properties};
use build::CoarseMesh;
pub(crate) use change::weights_changes;
use closed::Closed;
use scale::Scale;
pub(crate) use smooth::gather;
use tangents::KnownTangents;
pub(crate) use tangents::Tangents;
use trees::Trees;

/// What rays meet: immutable, and shared freely between threads and pictures.
///
/// ```
/// use std::sync::Arc;
///
/// use phong::geometry::{Geometry, GeometryOptions};
/// use phong::look::Look;
/// use phong::view::View;
/// use phong_scene::{Limits, Memory, Rgb, read};
///
/// let text = "version = 1\n[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\n\
///             [[sphere]]\ncenter = [0, 0, 0]\nradius = 1\n";
/// let files = Memory::new().with("ball.toml", text.as_bytes());
/// let scene = read("ball.toml", None, &files, &Limits::default()).scene.ok_or("broken")?;
/// let geometry = Arc::new(Geometry::new(&scene, GeometryOptions::default())?);
/// let by_day = View::new(Arc::clone(&geometry), Look::new(&scene))?;
/// let by_night = View::new(geometry, Look { ambient: Rgb::BLACK, ..Look::new(&scene) })?;
/// assert_eq!(by_day.objects(), by_night.objects());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Geometry {
    center: DVec3,
    world: World,
    /// What belongs to the primitives of each part of the world.
    batches: Vec<Batch>,
    objects: Vec<ObjectRecord>,
    /// From the world to their own space, of the objects that have one, in the order of numbers.
    own_spaces: Vec<(u32, DAffine3)>,
    /// One more than the highest number of a material; 0: nothing has a material.
    materials: u32,
    /// Which objects enclose what is inside.
    closed: Closed,
    /// The trees of meshes and clouds.
    trees: Trees,
    /// The arrays of meshes and clouds, which are sound.
    sound: SoundArrays,
    /// The meshes that may be lights, by the number of their object.
    coarse: Vec<CoarseMesh>,
    /// The tangents of meshes that were asked for.
    tangents: KnownTangents,
    /// How it was built, and is built again.
    options: GeometryOptions,
}

/// An object as rays meet it: for telling, not for shading.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ObjectRecord {
    /// Its name; within an instance `instance 1 / sphere 2`.
    pub name: String,
    /// Where it was written.
    pub place: Place,
}

/// How to build.
#[derive(Clone, Copy, Debug)]
pub struct GeometryOptions {
    /// How to build the trees; `None`: so that building and tracing `rays` takes the least time.
    pub build: Option<BuildOptions>,
    /// About how many rays will be traced, of every kind and in all pictures together. It changes
    /// no bit of a picture. Default: as many as there can be.
    pub rays: u64,
    /// The most bytes that the geometry may take, estimated before anything is built; `None`: no
    /// limit.
    pub max_bytes: Option<u64>,
}

impl Default for GeometryOptions {
    fn default() -> Self {
        Self { build: None, rays: u64::MAX, max_bytes: None }
    }
}

impl GeometryOptions {
    /// For the one picture that a scene describes.
    pub fn of(scene: &Scene) -> Self {
        let phong_scene::Image { size: [width, height], samples, .. } = scene.image;
        let paths = u64::from(width) * u64::from(height) * u64::from(samples);
        let rays = paths.saturating_mul(1 + scene.lights.len() as u64);
        Self { rays, ..Self::default() }
    }
}

/// Why a geometry could not be built.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum GeometryError {
    /// The estimate is over the limit: the caller's to raise, or the scene's to shrink.
    #[error("the scene needs about {needed} bytes, over the limit of {limit}")]
    Memory {
        /// Estimated bytes, building included.
        needed: u64,
        /// The limit.
        limit: u64,
    },
    /// An object or a group is broken, as [`Scene::check_objects`] says: the scene's fault.
    #[error("{}", summary(.0))]
    Scene(Vec<Diagnostic>),
    /// The trees cannot be built.
    #[error(transparent)]
    Build(#[from] BuildError),
}

/// The first of some diagnostics, and how many more there are.
pub(crate) fn summary(diagnostics: &[Diagnostic]) -> String {
    let first = diagnostics.first().map_or_else(String::new, |d| d.message.clone());
    match diagnostics.len() {
        0 | 1 => first,
        count => format!("{first} (and {} more)", count - 1),
    }
}

/// The preset that takes the least time in all for so many rays; of arrays that are shared, each
/// object's primitives count.
fn soonest(scene: &Scene, rays: u64) -> BuildOptions {
    let primitives = |object: &phong_scene::Object| match &object.shape {
        Shape::Mesh(mesh) => mesh.indices.len() as u64,
        Shape::Points(points) => points.spheres.len() as u64,
        Shape::Cylinders(cylinders) => cylinders.segments.len() as u64,
        _ => 1,
    };
    let primitives = scene.all_objects().map(primitives).sum();
    BuildOptions { preset: Preset::for_rays(primitives, rays), ..BuildOptions::default() }
}

impl Geometry {
    /// Builds the trees of a scene's objects, in the current rayon pool. The scene's arrays are
    /// shared, not copied.
    ///
    /// # Errors
    /// [`GeometryError`].
    pub fn new(scene: &Scene, options: GeometryOptions) -> Result<Self, GeometryError> {
        let build = options.build.unwrap_or_else(|| soonest(scene, options.rays));
        let options = GeometryOptions { build: Some(build), ..options };
        let earlier = (&Trees::default(), &Closed::default());
        Self::with_known(scene, options, earlier, SoundArrays::default())
    }

    /// The geometry of a scene that differs in some objects: as [`Geometry::new`] would build it, to
    /// the bit, with the same options. Trees of meshes and clouds whose arrays are the very same, as
    /// those of a clone of the scene are, are taken over, so moving, adding or removing one of those
    /// builds only the tree above them, and nothing of those arrays is read again but the numbers of
    /// faces' materials.
    ///
    /// # Errors
    /// [`GeometryError`].
    pub fn update(&self, scene: &Scene) -> Result<Self, GeometryError> {
        let earlier = (&self.trees, &self.closed);
        Self::with_known(scene, self.options, earlier, self.sound.clone())
    }

    fn with_known(
        scene: &Scene,
        options: GeometryOptions,
        (trees, closed): (&Trees, &Closed),
        mut sound: SoundArrays,
    ) -> Result<Self, GeometryError> {
        let broken = scene.check_objects_again(&mut sound);
        if !broken.is_empty() {
            return Err(GeometryError::Scene(broken));
        }
        if let Some(limit) = options.max_bytes {
            let needed = estimate::estimate(scene, flatten::count(scene));
            if needed > limit {
                return Err(GeometryError::Memory { needed, limit });
            }
        }
        let build = options.build.unwrap_or_default();
        let placed = flatten::flatten(scene);
        let closed = Closed::of(&placed, closed);
        let scale = Scale::of(&placed);
        let center = scale.center;
        let built = build::build(placed, scale, trees, build)?;
        let build::Built { parts, batches, objects, own_spaces, trees, coarse } = built;
        let materials = batches.iter().filter_map(Batch::highest_material).max();
        let materials = materials.map_or(0, |highest| highest.saturating_add(1));
        let world = World::build(parts, center, build)?;
        Ok(Self {
            center,
            world,
            batches,
            objects,
            own_spaces,
            materials,
            closed,
            trees,
            sound,
            coarse,
            tangents: KnownTangents::default(),
            options,
        })
    }

    /// The middle of all, about which things that are written one by one keep their detail in f32.
    pub fn center(&self) -> DVec3 {
        self.center
    }

    /// The objects, numbered from 0, instances unfolded.
    pub fn objects(&self) -> &[ObjectRecord] {
        &self.objects
    }

    /// What rays meet.
    #[inline]
    pub fn world(&self) -> &World {
        &self.world
    }

    /// How many trees meshes and clouds have: one for each mesh or cloud that is not a copy of
    /// another's arrays, however many objects are made of it.
    pub fn trees(&self) -> usize {
        self.trees.len()
    }

    /// How many materials a look must have at least: one more than the highest number of one.
    pub fn materials(&self) -> u32 {
        self.materials
    }

    /// The number of the primitive hit within its object, from 0: a mesh's face, a point of a cloud.
    /// `None` for objects that are one primitive.
    pub fn element(&self, hit: &Hit) -> Option<u32> {
        let batch = self.batch(hit.part);
        batch.is_bulk().then(|| batch.face.map_or(hit.prim, |(number, _)| number))
    }

    /// The number of the object hit, from 0.
    ///
    /// # Panics
    /// If `hit` is none.
    pub fn object(&self, hit: &Hit) -> u32 {
        self.batch(hit.part).object(hit.prim)
    }

    /// The number of the object of this name, and its triangles in the world; `None`: it is no mesh, or none
    /// that may be a light.
    pub(crate) fn luminous(&self, name: &str) -> Option<(u32, Vec<[DVec3; 3]>)> {
        let is_named = |mesh: &&CoarseMesh| self.objects[mesh.object as usize].name == name;
        self.coarse.iter().find(is_named).map(|mesh| (mesh.object, mesh.triangles()))
    }

    /// Part and number of each primitive of a mesh, in order.
    pub(crate) fn primitives_of_mesh(&self, object: u32) -> Vec<[u32; 2]> {
        let parts = (0..self.batches.len() as u32).filter(|&part| {
            let batch = self.batch(part);
            (batch.is_mesh() || batch.face.is_some()) && batch.object(0) == object
        });
        let each =
            |part| (0..self.world.primitives(part).len() as u32).map(move |prim| [part, prim]);
        parts.flat_map(each).collect()
    }

    /// Whether an object encloses what is inside. Of a mesh it is found out when it is first asked for.
    pub(crate) fn is_closed(&self, object: u32) -> bool {
        self.closed.of_object(object)
    }

    /// A point of the world in the own space of the object hit: before its transform, and that of
    /// the instance that it is part of.
    ///
    /// # Panics
    /// If `hit` is none.
    pub fn own_point(&self, hit: &Hit, world: DVec3) -> DVec3 {
        self.own_space(self.object(hit)).map_or(world, |space| space.transform_point3(world))
    }

    /// From the world to an object's own space; `None`: they are the same.
    pub(crate) fn own_space(&self, object: u32) -> Option<&DAffine3> {
        let place = self.own_spaces.binary_search_by_key(&object, |&(object, _)| object).ok()?;
        Some(&self.own_spaces[place].1)
    }

    /// Where on its surface a hit of `ray` is: a mesh's own texture coordinates, if it has some.
    ///
    /// # Panics
    /// If `hit` is none.
    pub fn coordinates(&self, ray: &Ray, hit: &Hit) -> Coordinates {
        let local = hit.prim;
        let batch = self.batch(hit.part);
        if let (Some(rotation), Primitives::Spheres(spheres)) =
            (batch.rotation(local), self.world.primitives(hit.part))
        {
            // The tree holds the sphere unturned, so it is the ray that is turned back about it.
            let about = batch.apart.unwrap_or(self.center);
            let center = spheres.get(local as usize).center.as_dvec3() + about;
            let back = rotation.transpose();
            let origin = center + back * (ray.origin - center);
            let dir = back * ray.dir.as_dvec3();
            let ray = Ray { origin, dir: dir.as_vec3(), ..*ray };
            let Coordinates { uv, tangent } = self.world.coordinates(&ray, hit);
            return Coordinates { uv, tangent: (rotation * tangent.as_dvec3()).as_vec3() };
        }
        let here = self.world.coordinates(ray, hit);
        let own = self.corners(hit.part, local).and_then(|corners| batch.uv(local, corners, hit));
        Coordinates { uv: own.unwrap_or(here.uv), ..here }
    }

    /// What belongs to the primitives of one part of the world.
    #[inline]
    pub(crate) fn batch(&self, part: u32) -> &Batch {
        &self.batches[part as usize]
    }

    /// The corners of a triangle; `None` for other primitives.
    #[inline]
    pub(crate) fn corners(&self, part: u32, local: u32) -> Option<[u32; 3]> {
        match self.world.primitives(part) {
            Primitives::Triangles { indices, .. } => Some(indices[local as usize]),
            Primitives::Solid(_) => self.batch(part).face.map(|(_, corners)| corners),
            _ => None,
        }
    }
}
