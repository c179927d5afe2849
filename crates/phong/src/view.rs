//! A geometry and its look together: all that a picture needs.

mod clip;
mod coincident;
mod far;
mod fixture;
mod fog;
mod images;
mod occlusion;
mod relief;
mod shading;
mod varied;

use std::sync::Arc;

use phong_bvh::{Coordinates, Hit, Ray, Surface, World};
use phong_scene::{Background, Cap, Diagnostic, LightKind, Rgb, Scene, ShadowRule};
use thiserror::Error;

use crate::camera::Camera;
use crate::geometry::{
    Geometry, GeometryError, GeometryOptions, ObjectRecord, Properties, Tangents, summary,
};
use crate::interaction::SurfaceInteraction;
use crate::light::{Light, MOUNTED};
use crate::look::Look;
use crate::material::Material;
use crate::math::Dir3;
use crate::sky::Sky;
use crate::texture::{MapContext, Texture, properties_of};
use clip::Clipping;
pub(crate) use coincident::Coincidences;
pub use far::StartedRay;
pub(crate) use fixture::Fixture;
pub(crate) use fog::Fog;
use images::Images;
pub(crate) use occlusion::Occlusion;
use relief::{Relief, Turned};
use shading::Shading;
pub(crate) use shading::Shading8;
pub(crate) use varied::MadeMaterial;
use varied::{Asked, Varied};

/// A geometry and its look together. Made in no time, immutable, and shared freely between threads.
#[derive(Clone, Debug)]
#[expect(clippy::struct_excessive_bools, reason = "each is asked for by itself, ray by ray")]
pub struct View {
    geometry: Arc<Geometry>,
    look: Look,
    camera: Camera,
    lights: Vec<Light>,
    /// What each light is mounted in.
    fixtures: Vec<Fixture>,
    /// The materials; of those that vary, with white for every texture.
    materials: Vec<Material>,
    /// What varies of each; empty where no material takes a value from a texture.
    varied: Vec<Varied>,
    textures: Vec<Texture>,
    /// What turns normals, of each material; empty: nothing does.
    reliefs: Vec<Option<Relief>>,
    /// The images of each material, where they are all that varies of it; empty as `varied`.
    images: Vec<Option<Images>>,
    /// The tangents of meshes, by their parts; empty: no texture turns normals.
    tangents: Vec<Option<Arc<Tangents>>>,
    /// Whether the values of any texture depend on how much of a surface a look-up stands for.
    has_footprints: bool,
    /// Whether those of any depend on the normal.
    has_normal_maps: bool,
    /// What they ask for of points of surfaces.
    asked: Asked,
    /// Of each part the properties of its points that maps show; empty: they show none.
    properties: Vec<Properties>,
    /// Where rays need more than the closest hit; `None`: nowhere.
    coincidences: Option<Coincidences>,
    /// What takes ambient light away; `None`: nothing does.
    occlusion: Option<Occlusion>,
    /// What the ambient light comes from; `None`: from everywhere alike.
    sky: Option<Sky>,
    /// What is far away fades; `None`: it does not.
    fog: Option<Fog>,
    /// What is cut away; `None`: nothing.
    clipping: Option<Arc<Clipping>>,
    /// Whether rays go on from any material.
    has_bounces: bool,
    /// Whether any material is seen through in a straight line.
    has_see_through: bool,
    /// Whether light goes through any material in a straight line.
    has_filters: bool,
    /// Whether any light has an extent.
    has_soft_lights: bool,
    /// Whether rays see the surface of any light.
    has_lamps: bool,
    /// Whether any light sends nothing to some places, wherever their horizon is.
    has_ends: bool,
    /// Whether any material takes ambient light from each light.
    has_ambient_per_light: bool,
}

/// Why there is no view.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ViewError {
    /// The geometry cannot be built.
    #[error(transparent)]
    Geometry(#[from] GeometryError),
    /// The camera, a light, a material, or the ambient light is broken, as
    /// [`Scene::check`](phong_scene::Scene::check) says: the caller's fault.
    #[error("{}", summary(.0))]
    Look(Vec<Diagnostic>),
    /// A surface names a material that the look does not have: the caller's fault.
    #[error("a surface is of material {number}, and the look has {count} materials")]
    NoMaterial {
        /// The material's number, from 0.
        number: u32,
        /// How many materials the look has.
        count: usize,
    },
}

impl View {
    /// What a scene's own picture shows: its geometry is built in the current rayon pool.
    ///
    /// # Errors
    /// [`ViewError`].
    pub fn of(scene: &Scene) -> Result<Self, ViewError> {
        let geometry = Geometry::new(scene, GeometryOptions::of(scene))?;
        Self::new(Arc::new(geometry), Look::new(scene))
    }

    /// A geometry with a look: nothing is built.
    ///
    /// # Errors
    /// [`ViewError::Look`], [`ViewError::NoMaterial`].
    pub fn new(geometry: Arc<Geometry>, look: Look) -> Result<Self, ViewError> {
        let broken = look.check();
        if !broken.is_empty() {
            return Err(ViewError::Look(broken));
        }
        let count = look.materials.len();
        if geometry.materials() as usize > count {
            return Err(ViewError::NoMaterial { number: geometry.materials() - 1, count });
        }
        let center = geometry.center();
        let camera = Camera::new(&look.camera);
        let viewer = camera.backward();
        let mut lights: Vec<_> =
            look.lights.iter().map(|light| Light::new(light, center)).collect();
        let ready = |m: &phong_scene::Material| Material::new(&m.at(|_| Rgb::WHITE), viewer);
        let materials: Vec<_> = look.materials.iter().map(ready).collect();
        let fixture = |light: &Light| {
            let around = |at| Fixture::of(&geometry, &materials, at, look.camera.eye);
            light.position().map(around).unwrap_or_default()
        };
        let mut fixtures: Vec<_> = lights.iter().map(fixture).collect();
        for (i, written) in look.lights.iter().enumerate() {
            if !matches!(written.kind, LightKind::Mesh { .. }) {
                continue;
            }
            let Some((object, triangles)) = geometry.luminous(&written.object) else {
                let wrong = format!(
                    "{}: `object`: there is no mesh of at most {} triangles called {:?}",
                    written.name,
                    phong_scene::Light::MOST_TRIANGLES,
                    written.object
                );
                return Err(ViewError::Look(vec![Diagnostic::error(wrong, None)]));
            };
            lights[i].shine_from(&triangles);
            let error = lights[i].error(center);
            fixtures[i] = Fixture::of_mesh(geometry.primitives_of_mesh(object), error);
        }
        let mut varied: Vec<_> = look.materials.iter().map(Varied::of).collect();
        let mut reliefs: Vec<_> = look.materials.iter().map(Relief::of).collect();
        let mut tangents = Vec::new();
        if reliefs.iter().all(Option::is_none) {
            reliefs = Vec::new();
        } else {
            let parts = 0..geometry.world().parts() as u32;
            let turned = |number: u32| reliefs.get(number as usize).is_some_and(Option::is_some);
            let of_part = |part: u32| {
                let mut used = geometry.batch(part).materials_used();
                used.any(turned).then(|| geometry.tangents(part)).flatten()
            };
            tangents = parts.map(of_part).collect();
        }
        if reliefs.is_empty() && varied.iter().all(|&varied| varied == Varied::Nothing) {
            varied = Vec::new();
        }
        let of_parts = (0..geometry.world().parts() as u32)
            .flat_map(|part| geometry.batch(part).materials_used());
        let names = properties_of(&look.materials, &look.textures, of_parts);
        let context = MapContext { camera: &look.camera, properties: &names };
        let new = |texture| Texture::new(texture, context);
        let textures: Vec<_> = look.textures.iter().map(new).collect();
        let images = varied.iter().enumerate().map(|(number, varied)| match varied {
            Varied::Nothing | Varied::Color(_) => {
                Images::of(varied.color(), reliefs.get(number).copied().flatten(), &textures)
            }
            Varied::More(_) => None,
        });
        let images = images.collect();
        let parts = 0..geometry.world().parts() as u32;
        let of_part = |part: u32| geometry.batch(part).properties(&names);
        let properties = if names.is_empty() { Vec::new() } else { parts.map(of_part).collect() };
        let bounces =
            |m: &phong_scene::Material| !(m.reflection.is_black() && m.transmission.is_black());
        let filters = |m: &phong_scene::Material| match m.shadow {
            None => m.is_see_through(),
            Some(ShadowRule::Full) => false,
            Some(ShadowRule::Filtered) => m.is_see_through() || !m.transmission.is_black(),
        };
        let capped = look.clips.iter().filter_map(|clip| match clip.cap {
            Cap::Of(material) => Some(material.0),
            _ => None,
        });
        if let Some(number) = capped.max().filter(|number| *number as usize >= count) {
            return Err(ViewError::NoMaterial { number, count });
        }
        let occlusion = Occlusion::of(&look, geometry.world());
        let rays = occlusion.map_or(1, |occlusion| occlusion.samples);
        let sky = look.sky.as_ref().map(|sky| Sky::new(sky, rays));
        Ok(Self {
            clipping: Clipping::of(&look.clips, &geometry).map(Arc::new),
            coincidences: Coincidences::of(&geometry, &materials),
            occlusion,
            has_bounces: look.materials.iter().any(bounces),
            fog: look.fog.map(|fog| Fog::new(&fog, look.background, sky.as_ref(), &camera)),
            sky,
            has_see_through: look.materials.iter().any(phong_scene::Material::is_see_through),
            has_filters: look.materials.iter().any(filters),
            has_soft_lights: lights.iter().any(|light| light.soft),
            has_lamps: lights.iter().any(|light| light.is_seen),
            has_ends: lights.iter().any(Light::has_end),
            has_ambient_per_light: materials.iter().any(Material::takes_ambient_per_light),
            has_footprints: !varied.is_empty() && textures.iter().any(Texture::has_footprint),
            asked: Asked::by(&textures),
            has_normal_maps: !varied.is_empty() && textures.iter().any(Texture::has_normals),
            properties,
            textures,
            reliefs,
            images,
            tangents,
            fixtures,
            geometry,
            look,
            camera,
            lights,
            materials,
            varied,
        })
    }

    /// What rays meet.
    pub fn geometry(&self) -> &Arc<Geometry> {
        &self.geometry
    }

    /// What it looks like, as it was written.
    pub fn look(&self) -> &Look {
        &self.look
    }

    /// The camera.
    #[inline]
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// The ambient light.
    #[inline]
    pub fn ambient(&self) -> Rgb {
        self.look.ambient
    }

    /// What rays see that hit nothing.
    #[inline]
    pub fn background(&self) -> Background {
        self.look.background
    }

    /// The lights, in the order of the text.
    #[inline]
    pub fn lights(&self) -> &[Light] {
        &self.lights
    }

    /// What a light is mounted in.
    #[inline]
    pub(crate) fn fixture(&self, light: usize) -> &Fixture {
        &self.fixtures[light]
    }

    /// The lights as they were written, in the same order.
    pub fn written_lights(&self) -> &[phong_scene::Light] {
        &self.look.lights
    }

    /// The materials, in the scene's order; of those that vary, with white for every texture.
    #[inline]
    pub fn materials(&self) -> &[Material] {
        &self.materials
    }

    /// Whether mirror or glass rays go on from any of the materials.
    pub fn has_bounces(&self) -> bool {
        self.has_bounces
    }

    /// Whether what is behind any of the materials is seen through it in a straight line.
    #[inline]
    pub fn has_see_through(&self) -> bool {
        self.has_see_through
    }

    /// Whether light goes through any of the materials in a straight line.
    #[inline]
    pub(crate) fn has_filters(&self) -> bool {
        self.has_filters
    }

    /// Where rays need more than the closest hit; `None`: nowhere.
    #[inline]
    pub(crate) fn coincidences(&self) -> Option<&Coincidences> {
        self.coincidences.as_ref()
    }

    /// What takes ambient light away; `None`: nothing does.
    #[inline]
    pub(crate) fn occlusion(&self) -> Option<Occlusion> {
        self.occlusion
    }

    /// Whether anything is cut away.
    #[inline]
    pub(crate) fn is_clipped(&self) -> bool {
        self.clipping.is_some()
    }

    /// What the ambient light comes from; `None`: from everywhere alike.
    #[inline]
    pub(crate) fn sky(&self) -> Option<&Sky> {
        self.sky.as_ref()
    }

    /// What is far away fades; `None`: it does not.
    #[inline]
    pub(crate) fn fog(&self) -> Option<&Fog> {
        self.fog.as_ref()
    }

    /// Whether samples differ but by their rays: where any light has an extent, and where rays look around
    /// for what takes ambient light away.
    pub(crate) fn asks_for_samplers(&self) -> bool {
        self.has_soft_lights || self.occlusion.is_some()
    }

    /// Whether rays see the surface of any light.
    #[inline]
    pub(crate) fn has_lamps(&self) -> bool {
        self.has_lamps
    }

    /// Whether any light sends nothing to some places, wherever their horizon is.
    #[inline]
    pub(crate) fn has_ends(&self) -> bool {
        self.has_ends
    }

    /// How far a ray goes until it sees the surface of a light, before what it hits at `hit`; `None`: it
    /// sees none.
    pub(crate) fn lamp(&self, ray: &Ray, hit: f32) -> Option<f32> {
        let meet = |light: &Light| light.meet(ray.origin, ray.dir);
        let nearest = self.lights.iter().map(meet).fold(f32::INFINITY, f32::min);
        (nearest < f32::INFINITY && nearest * (1.0 - MOUNTED) <= hit).then_some(nearest)
    }

    /// Whether any of the materials takes ambient light from each light.
    pub fn has_ambient_per_light(&self) -> bool {
        self.has_ambient_per_light
    }

    /// The materials as they were written, in the same order.
    pub fn written_materials(&self) -> &[phong_scene::Material] {
        &self.look.materials
    }

    /// The textures, ready to be looked up, in the order of the look's.
    pub(crate) fn textures(&self) -> &[Texture] {
        &self.textures
    }

    /// The objects, numbered from 0, instances unfolded.
    pub fn objects(&self) -> &[ObjectRecord] {
        self.geometry.objects()
    }

    /// What rays meet.
    #[inline]
    pub fn world(&self) -> &World {
        self.geometry.world()
    }

    /// The number of the primitive hit within its object, from 0: a mesh's face, a point of a cloud.
    /// `None` for objects that are one primitive.
    pub fn element(&self, hit: &Hit) -> Option<u32> {
        self.geometry.element(hit)
    }

    /// The number of the object hit, from 0.
    ///
    /// # Panics
    /// If `hit` is none.
    pub fn object(&self, hit: &Hit) -> u32 {
        self.geometry.object(hit)
    }

    /// Where on its surface a hit of `ray` is: a mesh's own texture coordinates, if it has some.
    ///
    /// # Panics
    /// If `hit` is none.
    pub fn coordinates(&self, ray: &Ray, hit: &Hit) -> Coordinates {
        let on_cap = self.cap_coordinates(ray, hit);
        on_cap.unwrap_or_else(|| self.geometry.coordinates(ray, hit))
    }

    /// Where `ray` met a surface.
    ///
    /// # Panics
    /// If `hit` is none.
    pub fn interaction(&self, ray: &Ray, hit: &Hit) -> SurfaceInteraction {
        let surface = self.surface(ray, hit);
        let Surface { p, p_error, ng } = surface;
        let (ng, e) = (Dir3::from_unit(ng), -Dir3::from_unit(ray.dir));
        let Shading { n, is_flipped, material, color } = self.shading(hit, ng, e);
        let written = || self.color_at(material, ray, hit, &surface);
        let color = self.diffuse_color(material, color, written);
        let n = match self.relief(material) {
            Some(relief) => {
                let (point, front) =
                    (self.texture_point(ray, hit, p, ng.to_vec(), 0.0), ng.facing(e));
                let (n, front) = (n.to_vec(), front.to_vec());
                let at = Turned { ray, hit, point: &point, n, front, is_flipped };
                Dir3::from_unit(self.turned_normal(relief, &at))
            }
            None => n,
        };
        let (hit, eta, width) = (*hit, None, 0.0);
        SurfaceInteraction { hit, material, p, p_error, ng, n, e, color, eta, width }
    }
}
