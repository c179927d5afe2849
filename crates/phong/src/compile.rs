//! From what was written to what rays meet.
//!
//! Instances are flattened, transforms are baked in f64, and the whole scene is moved so that
//! its middle is near the origin: far-away data keep their detail in f32.

mod flatten;
mod geometry;

use fearless_simd::{Simd, f32x8, mask32x8, prelude::*, u32x8};
use glam::{DVec3, Vec3};
use phong_bvh::{
    BuildError, BuildOptions, Bvh, Coordinates, Hit, Hits8, Preset, Primitives, Ray, Surface, lanes,
};
use phong_scene::{Image, MaterialId, Place, Rgb, Scene};
use thiserror::Error;

use crate::camera::Camera;
use crate::interaction::SurfaceInteraction;
use crate::light::Light;
use crate::material::Material;
use crate::math::Dir3;
use crate::math::lanes::{Lanes3, dot, load3, select3, set, splat3, store3};
use geometry::Part;

/// A scene that rays can meet. Immutable; shared freely between threads.
#[derive(Debug)]
pub struct CompiledScene {
    camera: Camera,
    center: DVec3,
    ambient: Rgb,
    lights: Vec<Light>,
    materials: Vec<Material>,
    /// Whether rays go on from any material.
    has_bounces: bool,
    /// Whether any material takes ambient light from each light.
    has_ambient_per_light: bool,
    bvh: Bvh,
    /// What the hierarchy's geometries belong to, one for each.
    parts: Vec<Part>,
    objects: Vec<ObjectRecord>,
    /// The lights and materials as they were written: for telling, not for shading.
    written_lights: Vec<phong_scene::Light>,
    written_materials: Vec<phong_scene::Material>,
}

/// An object as rays meet it: for telling, not for shading.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ObjectRecord {
    /// Its name; within an instance `instance 1 / sphere 2`.
    pub name: String,
    /// Where it was written.
    pub place: Place,
}

/// What belongs to a surface besides its geometry.
pub(crate) struct Dressed {
    /// Shading normal, on the side of the eye.
    pub(crate) n: Dir3,
    /// Number of the material.
    pub(crate) material: u32,
    /// The diffuse colour.
    pub(crate) color: Rgb,
}

/// What belongs to eight surfaces besides their geometry: [`Dressed`], number by number.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub(crate) struct Dressed8 {
    pub(crate) n: Lanes3,
    pub(crate) color: Lanes3,
    pub(crate) material: [u32; 8],
}

impl Dressed8 {
    pub(crate) const NONE: Self = Self { n: [[0.0; 8]; 3], color: [[0.0; 8]; 3], material: [0; 8] };
}

/// How to compile.
#[derive(Clone, Copy, Debug, Default)]
pub struct CompileOptions {
    /// How to build the hierarchy; `None`: as it draws the scene's own picture soonest.
    pub build: Option<BuildOptions>,
    /// The most bytes that the compiled scene may take, estimated before anything is built;
    /// `None`: no limit.
    pub max_bytes: Option<u64>,
}

/// Why a scene could not be compiled.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum CompileError {
    /// The estimate is over the limit: the caller's to raise, or the scene's to shrink.
    #[error("the scene needs about {needed} bytes, over the limit of {limit}")]
    Memory {
        /// Estimated bytes, building included.
        needed: u64,
        /// The limit.
        limit: u64,
    },
    /// The hierarchy cannot be built.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// The scene is so large that distances in it overflow f32: the input's fault.
    #[error("the scene is {0:e} units across, more than the 1e18 that numbers can hold")]
    TooLarge(f64),
}

/// The way to build that draws the scene's own picture soonest.
fn soonest(scene: &Scene) -> BuildOptions {
    let primitives = |object: &phong_scene::Object| match &object.shape {
        phong_scene::Shape::Mesh(mesh) => mesh.indices.len() as u64,
        phong_scene::Shape::Points(points) => points.spheres.len() as u64,
        _ => 1,
    };
    let primitives = scene.objects.iter().map(primitives).sum();
    let Image { size: [width, height], samples, .. } = scene.image;
    let paths = u64::from(width) * u64::from(height) * u64::from(samples);
    let rays = paths.saturating_mul(1 + scene.lights.len() as u64);
    BuildOptions { preset: Preset::for_rays(primitives, rays), ..BuildOptions::default() }
}

impl CompiledScene {
    /// Compiles a scene, taking its bulk geometry by value, in the current rayon pool.
    ///
    /// # Errors
    /// [`CompileError`].
    pub fn new(scene: Scene, options: CompileOptions) -> Result<Self, CompileError> {
        if let Some(limit) = options.max_bytes {
            let needed = geometry::estimate(&scene);
            if needed > limit {
                return Err(CompileError::Memory { needed, limit });
            }
        }
        let bounds = scene.bounds();
        let extent = bounds.size().max_element();
        if extent.is_nan() || extent > 1e18 {
            return Err(CompileError::TooLarge(extent));
        }
        let center = geometry::center(bounds);
        let build = options.build.unwrap_or_else(|| soonest(&scene));
        let Scene { image: _, camera, ambient, lights, materials, objects, groups } = scene;
        let leaves = flatten::flatten(objects, &groups);
        drop(groups);
        let has_grain = |material: MaterialId| {
            let material = materials.get(material.0 as usize);
            material.is_some_and(|m| matches!(m.model, phong_scene::Model::Ward { .. }))
        };
        let geometry::Compiled { geometry, parts, objects } =
            geometry::compile(leaves, center, &has_grain);
        let camera = Camera::new(&camera, center);
        let written_materials = materials;
        let viewer = camera.backward();
        let materials: Vec<_> =
            written_materials.iter().map(|m| Material::new(m, viewer)).collect();
        Ok(Self {
            has_bounces: materials.iter().any(Material::bounces),
            has_ambient_per_light: materials.iter().any(Material::takes_ambient_per_light),
            camera,
            center,
            ambient,
            lights: lights.iter().map(|light| Light::new(light, center)).collect(),
            written_lights: lights,
            materials,
            written_materials,
            bvh: Bvh::build(geometry, build)?,
            parts,
            objects,
        })
    }

    /// The camera.
    #[inline]
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// What was taken off every coordinate: world = compiled + this.
    pub fn center(&self) -> DVec3 {
        self.center
    }

    /// A point of the compiled scene's space, in the world.
    pub fn to_world(&self, p: Vec3) -> DVec3 {
        p.as_dvec3() + self.center
    }

    /// The ambient light.
    #[inline]
    pub fn ambient(&self) -> Rgb {
        self.ambient
    }

    /// The lights, in the order of the text.
    #[inline]
    pub fn lights(&self) -> &[Light] {
        &self.lights
    }

    /// The lights as they were written, in the same order.
    pub fn written_lights(&self) -> &[phong_scene::Light] {
        &self.written_lights
    }

    /// The materials, in the scene's order.
    #[inline]
    pub fn materials(&self) -> &[Material] {
        &self.materials
    }

    /// Whether mirror or glass rays go on from any of the materials.
    pub fn has_bounces(&self) -> bool {
        self.has_bounces
    }

    /// Whether any light has an extent: whether samples differ but by their rays.
    pub fn has_soft_lights(&self) -> bool {
        self.lights.iter().any(|light| light.soft)
    }

    /// Whether any of the materials takes ambient light from each light.
    pub fn has_ambient_per_light(&self) -> bool {
        self.has_ambient_per_light
    }

    /// The materials as they were written, in the same order.
    pub fn written_materials(&self) -> &[phong_scene::Material] {
        &self.written_materials
    }

    /// The objects, numbered from 0, instances flattened.
    pub fn objects(&self) -> &[ObjectRecord] {
        &self.objects
    }

    /// The hierarchy.
    #[inline]
    pub fn bvh(&self) -> &Bvh {
        &self.bvh
    }

    /// The number of a primitive within its object, from 0: a mesh's face, a point of a cloud.
    /// `None` for objects that are one primitive.
    pub fn element(&self, prim: u32) -> Option<u32> {
        let (part, local) = self.bvh.locate(prim);
        self.parts[part].is_bulk().then_some(local)
    }

    /// The number of the object that a primitive belongs to, from 0.
    pub fn object(&self, prim: u32) -> u32 {
        let (part, local) = self.bvh.locate(prim);
        self.parts[part].object(local)
    }

    /// Where `ray` met a surface.
    ///
    /// # Panics
    /// If `hit` is none.
    pub fn interaction(&self, ray: &Ray, hit: &Hit) -> SurfaceInteraction {
        let Surface { p, p_error, ng } = self.bvh.surface(ray, hit);
        let (ng, e) = (Dir3::from_unit(ng), -Dir3::from_unit(ray.dir));
        let Dressed { n, material, color } = self.dressed(hit, ng, e);
        SurfaceInteraction { hit: *hit, material, p, p_error, ng, n, e, color }
    }

    /// What belongs to the surface at a hit besides its geometry; its normal is `ng`, and `e` leads
    /// to the eye.
    fn dressed(&self, hit: &Hit, ng: Dir3, e: Dir3) -> Dressed {
        let (index, local) = self.bvh.locate(hit.prim);
        let part = &self.parts[index];
        let material = part.material(local);
        let own = self.materials[material as usize].color;
        let corners = self.corners(index, local);
        let n = corners.and_then(|c| part.normal(local, c, hit)).unwrap_or(ng);
        let color = part.color(local, corners, hit).unwrap_or(own);
        Dressed { n: n.facing(e), material, color }
    }

    /// [`CompiledScene::dressed`] of those of eight surfaces that were met: the same bits. `index` is
    /// the number of the geometry met last, of whatever eight.
    #[inline(always)]
    pub(crate) fn dress<S: Simd>(
        &self,
        simd: S,
        hits: &Hits8,
        ng: [f32x8<S>; 3],
        e: [f32x8<S>; 3],
        index: &mut usize,
        dressed: &mut Dressed8,
    ) {
        let Dressed8 { n, color, material } = dressed;
        let zero = f32x8::splat(simd, 0.0);
        *n = store3(ng);
        let mut left = hits.met;
        while left != 0 {
            // Neighbours are mostly of one part.
            let first = left.trailing_zeros() as usize & 7;
            let range = self.bvh.primitives_around(index, hits.prim[first]);
            let part = &self.parts[*index];
            let prim = u32x8::load_array_ref(simd, &hits.prim);
            let from = prim.simd_ge(u32x8::splat(simd, range.start));
            let below = prim.simd_lt(u32x8::splat(simd, range.end));
            let same = left & (from & below).to_bitmask() as u32;
            left &= !same;
            if let (Some(number), true) = (part.only_material(), part.is_plain()) {
                let own = splat3(simd, self.materials[number as usize].color.to_array());
                // What is in lanes without a hit is of no account.
                let lanes = if same == hits.met { 0xff } else { same };
                let lanes = mask32x8::from_bitmask(simd, lanes.into());
                *color = store3(select3(lanes, own, load3(simd, color)));
                let old = u32x8::load_array_ref(simd, material);
                lanes.select(u32x8::splat(simd, number), old).store_array(material);
                continue;
            }
            for lane in lanes(same) {
                let (hit, local) = (hits.get(lane), hits.prim[lane] - range.start);
                let corners = self.corners(*index, local);
                let own = part.material(local);
                material[lane] = own;
                let own = self.materials[own as usize].color;
                set(color, lane, part.color(local, corners, &hit).unwrap_or(own).to_array());
                if let Some(normal) = corners.and_then(|c| part.normal(local, c, &hit)) {
                    set(n, lane, normal.to_array());
                }
            }
        }
        let up = load3(simd, n);
        let away = dot(up, e).simd_lt(zero);
        *n = store3(select3(away, [-up[0], -up[1], -up[2]], up));
    }

    /// Where on its surface a hit of `ray` is: a mesh's own texture coordinates, if it has some.
    ///
    /// # Panics
    /// If `hit` is none.
    pub fn coordinates(&self, ray: &Ray, hit: &Hit) -> Coordinates {
        let (index, local) = self.bvh.locate(hit.prim);
        let here = self.bvh.coordinates(ray, hit);
        let own = self.corners(index, local).and_then(|c| self.parts[index].uv(local, c, hit));
        Coordinates { uv: own.unwrap_or(here.uv), ..here }
    }

    /// The corners of a triangle.
    #[inline]
    fn corners(&self, geometry: usize, local: u32) -> Option<[u32; 3]> {
        match &self.bvh.geometry()[geometry] {
            Primitives::Triangles { indices, .. } => Some(indices[local as usize]),
            _ => None,
        }
    }
}
