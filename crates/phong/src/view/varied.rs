//! Surfaces whose materials vary: what their parameters are at a point.

use fearless_simd::{Simd, prelude::*, u32x8};
use glam::{DVec2, DVec3, Vec2, Vec3};
use phong_bvh::{Hit, Hits8, Ray, Rays8, Surface, Surfaces8, lanes};
use phong_scene::{
    ConstantMaterial, Field, Param, Rgb, TextureRef, TextureSpace, TextureUse, Textured,
};

use super::View;
use super::images::Met8;
use super::relief::Turned;
use super::shading::Shading8;
use crate::interaction::SurfaceInteraction;
use crate::material::Material;
use crate::math::lanes::{get, set};
use crate::texture::{Texture, TexturePoint, footprint};

/// How far back a material that was made is looked for before another one is made.
const REMEMBERED: usize = 4;

/// What textures vary of a material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Varied {
    Nothing,
    /// Its colour alone, which every surface has of its own anyway.
    Color(TextureRef),
    /// Other parameters, and perhaps its colour.
    More(Option<TextureRef>),
}

/// What of a point of a surface textures ask for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Asked {
    /// Where it is in the object's own space.
    object: bool,
    /// How texture coordinates change along its footprint.
    uv_changes: bool,
    /// The tangent, where it is not the texture coordinates' own.
    tangent: bool,
}

/// A material as it is at some surfaces that textures vary.
#[derive(Clone, Debug)]
pub(crate) struct MadeMaterial {
    /// The number of the material that it was made of.
    pub(crate) number: u32,
    pub(crate) material: Material,
}

impl Varied {
    pub(super) fn of(material: &phong_scene::Material) -> Self {
        let color = material.color.texture();
        // Normals are no parameters: they are turned by themselves.
        let textured = material.textured().into_iter();
        let count = textured.filter(|(key, _)| !matches!(*key, "normal" | "bump")).count();
        match (count, color) {
            (0, _) => Self::Nothing,
            (1, Some(color)) => Self::Color(color),
            _ => Self::More(color),
        }
    }

    pub(super) fn color(self) -> Option<TextureRef> {
        match self {
            Self::Nothing => None,
            Self::Color(by) => Some(by),
            Self::More(by) => by,
        }
    }
}

impl Asked {
    /// Everything that a point has.
    const ALL: Self = Self { object: true, uv_changes: true, tangent: true };

    /// What these textures look at.
    pub(super) fn by(textures: &[Texture]) -> Self {
        Self {
            object: textures.iter().any(|texture| texture.space() == TextureSpace::Object),
            uv_changes: textures
                .iter()
                .any(|texture| texture.space() == TextureSpace::Uv && texture.has_footprint()),
            tangent: false,
        }
    }
}

impl View {
    /// Gives those of eight surfaces whose materials vary their own colours and materials. A
    /// material that was made for some is added to `made`, and numbered behind those of the view.
    #[inline(always)]
    pub(crate) fn vary<S: Simd>(
        &self,
        simd: S,
        (rays, hits, surfaces): (&Rays8, &Hits8, &Surfaces8),
        widths: Option<&[f32; 8]>,
        shading: &mut Shading8,
        made: &mut Vec<MadeMaterial>,
    ) {
        let met = Met8 { rays, hits, surfaces, widths };
        let (mut left, mut others) = (hits.met, hits.met);
        while left != 0 {
            let first = left.trailing_zeros() as usize & 7;
            let (part, number) = (hits.part[first], shading.material[first]);
            let parts = u32x8::load_array_ref(simd, &hits.part);
            let numbers = u32x8::load_array_ref(simd, &shading.material);
            let same = parts.simd_eq(u32x8::splat(simd, part))
                & numbers.simd_eq(u32x8::splat(simd, number));
            let same = left & same.to_bitmask() as u32;
            left &= !same;
            if let Some(images) = self.images.get(number as usize).copied().flatten() {
                others &= !self.show_images(simd, images, met, same, shading);
            }
        }
        self.vary_each(met, others, shading, made);
    }

    /// [`View::vary`] of the surfaces in these lanes, one by one.
    fn vary_each(
        &self,
        Met8 { rays, hits, surfaces, widths }: Met8<'_>,
        each: u32,
        shading: &mut Shading8,
        made: &mut Vec<MadeMaterial>,
    ) {
        let remembered = made.len().saturating_sub(REMEMBERED);
        for lane in lanes(each) {
            let number = shading.material[lane];
            let varied = self.varied(number);
            let relief = self.relief(number);
            if varied == Varied::Nothing && relief.is_none() {
                continue;
            }
            let (ray, hit) = (rays.get(lane), hits.get(lane));
            let p = DVec3::from(surfaces.p.map(|all| all[lane]));
            let ng = Vec3::from(get(&surfaces.ng, lane));
            let width = widths.map_or(0.0, |widths| widths[lane]);
            let has_tangents = || self.tangents.get(hit.part as usize).is_some_and(Option::is_some);
            let tangent = relief.is_some() && !has_tangents();
            let asked = Asked { tangent, ..self.asked };
            let point = self.point_asked_for(asked, (&ray, &hit), (p, ng), width);
            if let Some(relief) = relief {
                let n = Vec3::from(get(&shading.n, lane));
                let front = Vec3::from(get(&shading.front, lane));
                let is_flipped = shading.flipped >> lane & 1 != 0;
                let at = Turned { ray: &ray, hit: &hit, point: &point, n, front, is_flipped };
                let n = self.turned_normal(relief, &at);
                set(&mut shading.n, lane, n.to_array());
            }
            if let Some(by) = varied.color() {
                let own = self.own_color(self.geometry.batch(hit.part), &hit);
                let written = || Param::<Rgb>::from(by).at(|asked| self.look_up(asked, &point));
                let color = self.diffuse_color(number, own, written);
                set(&mut shading.color, lane, color.to_array());
            }
            if let Varied::More(_) = varied {
                let material = self.material_at(number, &point);
                let known = made[remembered..]
                    .iter()
                    .position(|made| made.number == number && made.material == material);
                let place = known.map_or(made.len(), |place| remembered + place);
                if place == made.len() {
                    made.push(MadeMaterial { number, material });
                }
                shading.material[lane] = (self.materials.len() + place) as u32;
            }
        }
    }

    #[inline]
    fn varied(&self, material: u32) -> Varied {
        self.varied.get(material as usize).copied().unwrap_or(Varied::Nothing)
    }

    /// The diffuse colour of the material at a surface.
    pub(super) fn color_at(&self, material: u32, ray: &Ray, hit: &Hit, at: &Surface) -> Rgb {
        match self.varied(material).color() {
            Some(by) => self.value_at(by, ray, hit, at),
            None => self.materials[material as usize].color,
        }
    }

    /// The index of refraction of the material at a surface.
    pub(crate) fn ior_at(&self, material: u32, ray: &Ray, hit: &Hit, at: &Surface) -> f32 {
        match self.look.materials[material as usize].ior {
            Param::Constant(ior) => ior,
            Param::Textured(by) => self.value_at(by, ray, hit, at),
        }
    }

    /// What a parameter takes from a texture at a surface.
    fn value_at<T: Textured>(&self, by: TextureRef, ray: &Ray, hit: &Hit, at: &Surface) -> T {
        let point = self.texture_point(ray, hit, at.p, at.ng, 0.0);
        Param::<T>::Textured(by).at(|asked| self.look_up(asked, &point))
    }

    /// Whether any material takes a value from a texture.
    #[inline]
    pub(crate) fn has_textures(&self) -> bool {
        !self.varied.is_empty()
    }

    /// A material as it is at a point, ready for light.
    pub fn material_at(&self, number: u32, point: &TexturePoint) -> Material {
        match self.varied(number) {
            Varied::Nothing => self.materials[number as usize].clone(),
            _ => Material::new(&self.written_at(number, point), self.camera.backward()),
        }
    }

    /// A material as it was written, and as it is at a point.
    pub fn written_at(&self, number: u32, point: &TexturePoint) -> ConstantMaterial {
        self.look.materials[number as usize].at(|asked| self.look_up(asked, point))
    }

    /// Where a surface is for textures.
    pub fn texture_point_of(&self, ray: &Ray, at: &SurfaceInteraction) -> TexturePoint {
        self.texture_point(ray, &at.hit, at.p, at.ng.to_vec(), at.width)
    }

    /// `width` is that of the ray there.
    pub(super) fn texture_point(
        &self,
        ray: &Ray,
        hit: &Hit,
        world: DVec3,
        ng: Vec3,
        width: f32,
    ) -> TexturePoint {
        self.point_asked_for(Asked::ALL, (ray, hit), (world, ng), width)
    }

    /// [`View::texture_point`], with 0 for what is not asked for.
    fn point_asked_for(
        &self,
        asked: Asked,
        (ray, hit): (&Ray, &Hit),
        (world, ng): (DVec3, Vec3),
        width: f32,
    ) -> TexturePoint {
        let mut point = TexturePoint {
            world,
            normal: if self.has_normal_maps { self.outwards(hit, ng) } else { [0.0; 3] },
            properties: self.properties_at(hit),
            ..TexturePoint::default()
        };
        if asked.object {
            point.object = self.geometry.own_point(hit, world);
        }
        if width > 0.0 && self.has_footprints {
            let [dir, normal] = [ray.dir, ng].map(|v| v.as_dvec3().to_array());
            let sides = footprint(f64::from(width), dir, normal).map(DVec3::from_array);
            point.footprint.world = sides;
            if asked.object {
                point.footprint.object = sides.map(|side| self.geometry.own_vector(hit, side));
            }
            if asked.uv_changes {
                point.footprint.uv = self.uv_changes(ray, hit, sides);
            }
        }
        let own = if asked.tangent { None } else { self.own_uv(hit) };
        if let Some(uv) = own {
            point.uv = uv.to_array();
        } else {
            let here = self.coordinates(ray, hit);
            (point.uv, point.tangent) = (here.uv.to_array(), here.tangent.to_array());
        }
        point
    }

    /// The texture coordinates that the geometry itself brings.
    fn own_uv(&self, hit: &Hit) -> Option<Vec2> {
        if self.cap(hit).is_some() {
            return None;
        }
        let corners = self.geometry.corners(hit.part, hit.prim)?;
        self.geometry.batch(hit.part).uv(hit.prim, corners, hit)
    }

    /// The shading normal on the outer side of a surface, before textures turn it.
    fn outwards(&self, hit: &Hit, ng: Vec3) -> [f32; 3] {
        let own = if self.cap(hit).is_none() { self.own_normal(hit) } else { None };
        own.map_or(ng, crate::math::Dir3::to_vec).to_array()
    }

    /// What the points of a surface have besides their place.
    fn properties_at(&self, hit: &Hit) -> [f32; Field::MOST] {
        match self.properties.get(hit.part as usize) {
            Some(of_part) if self.cap(hit).is_none() => {
                let corners = self.geometry.corners(hit.part, hit.prim);
                self.geometry.batch(hit.part).properties_at(of_part, corners, hit)
            }
            _ => [f32::NAN; Field::MOST],
        }
    }

    /// How texture coordinates change along two vectors that are tangent to the surface at a hit.
    pub(super) fn uv_changes(&self, ray: &Ray, hit: &Hit, along: [DVec3; 2]) -> [DVec2; 2] {
        if self.cap(hit).is_none() {
            return self.geometry.uv_changes(ray, hit, along);
        }
        // A cap is flat, and its coordinates change evenly.
        let here = self.coordinates(ray, hit).uv.as_dvec2();
        along.map(|along| {
            let beside = Ray { origin: ray.origin + along, ..*ray };
            self.coordinates(&beside, hit).uv.as_dvec2() - here
        })
    }

    /// [`Geometry::curvature`](crate::geometry::Geometry::curvature); of a cap 0.
    pub(crate) fn curvature(&self, hit: &Hit, ng: Vec3) -> f32 {
        if self.cap(hit).is_some() { 0.0 } else { self.geometry.curvature(hit, ng) }
    }

    /// A texture's value; black where the look has no such texture.
    pub(super) fn look_up(&self, asked: TextureUse, point: &TexturePoint) -> Rgb {
        let texture = self.textures.get(asked.texture.0 as usize);
        texture.map_or(Rgb::BLACK, |texture| texture.value(point, asked))
    }

    /// Whether any texture's values depend on how much of a surface a look-up stands for.
    #[inline]
    pub(crate) fn has_footprints(&self) -> bool {
        self.has_footprints
    }
}
