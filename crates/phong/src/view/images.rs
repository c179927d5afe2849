//! Images on meshes, of eight surfaces side by side: the colours and the normals of most models that have textures.
//!
//! Each surface takes the steps that [`View::vary`] takes for one by itself, so it has the same bits.

use fearless_simd::{Simd, f32x8, f64x4, mask32x8, prelude::*};
use glam::DMat3;
use phong_bvh::{Hits8, Lanes, Primitives, Rays8, Surfaces8, lanes};
use phong_scene::{NormalFormat, Param, Rgb, TextureRef, TextureUse};

use super::View;
use super::relief::{Relief, frame, mapped, number, raised, turned};
use super::shading::Shading8;
use crate::geometry::{Tangents, gather, weights_changes};
use crate::math::lanes::{Lanes3, add, get, load3, put3, scale, set, sub, wide3};
use crate::texture::{Texture, footprint};

/// The images that a material takes its colour and its normals from, where it takes nothing else from textures.
#[derive(Clone, Copy, Debug)]
pub(super) struct Images {
    color: Option<TextureRef>,
    normal: Option<(TextureRef, NormalFormat)>,
}

/// Eight surfaces, and how wide the ray is at each; `None`: no texture asks.
#[derive(Clone, Copy)]
pub(super) struct Met8<'a> {
    pub(super) rays: &'a Rays8,
    pub(super) hits: &'a Hits8,
    pub(super) surfaces: &'a Surfaces8,
    pub(super) widths: Option<&'a [f32; 8]>,
}

/// Texture coordinates of eight surfaces, u of each and v of each, and how they change along the two sides of what a
/// look-up stands for.
struct Places {
    uv: [[f64; 8]; 2],
    sides: [[[f64; 8]; 2]; 2],
}

impl Images {
    /// Those of a material that takes its colour from this texture; `None`: it has none, or others.
    pub(super) fn of(
        color: Option<TextureRef>,
        relief: Option<Relief>,
        textures: &[Texture],
    ) -> Option<Self> {
        let normal = match relief {
            None => None,
            Some(Relief { normal: Some(by), bump: None }) => Some(by),
            Some(_) => return None,
        };
        let mut all = color.into_iter().chain(normal.map(|(by, _)| by)).peekable();
        all.peek()?;
        let is_image = |by: TextureRef| {
            textures.get(by.texture.0 as usize).is_some_and(Texture::is_image_on_uv)
        };
        all.all(is_image).then_some(Self { color, normal })
    }
}

impl View {
    /// Gives the surfaces in these lanes, which are of one part and of a material with these images, their colours and
    /// normals. The lanes of those that got theirs, a bit each: none but of meshes that bring all that is asked for.
    #[inline(always)]
    pub(super) fn show_images<S: Simd>(
        &self,
        simd: S,
        images: Images,
        met: Met8<'_>,
        same: u32,
        shading: &mut Shading8,
    ) -> u32 {
        let hits = met.hits;
        let first = same.trailing_zeros() as usize & 7;
        let part = hits.part[first];
        let batch = self.geometry.batch(part);
        let Primitives::Triangles { positions, indices } = self.world().primitives(part) else {
            return 0;
        };
        let tangents = self.tangents.get(part as usize).and_then(Option::as_deref);
        let lacks_tangents = images.normal.is_some() && tangents.is_none();
        if self.clipping.is_some() || !batch.is_bulk() || lacks_tangents {
            return 0;
        }
        // The other lanes repeat the first.
        let mut triangles = [hits.prim[first]; 8];
        lanes(same).for_each(|lane| triangles[lane] = hits.prim[lane]);
        let (mut corners, mut uvs, mut there) = ([[0; 3]; 8], [[[0.0; 8]; 2]; 3], 0);
        for (lane, &triangle) in triangles.iter().enumerate() {
            corners[lane] = indices[triangle as usize];
            let Some(own) = batch.uvs(triangle, corners[lane]) else { continue };
            there |= same & 1 << lane;
            for (uvs, own) in uvs.iter_mut().zip(own) {
                (uvs[0][lane], uvs[1][lane]) = (own.x, own.y);
            }
        }
        if there == 0 {
            return 0;
        }
        let own_space = self.geometry.own_space(batch.object(triangles[0]));
        let to_own = own_space.map(|space| space.matrix3);
        let places = places(simd, met, gather(positions, &corners), &uvs, to_own);
        if let (Some((by, format)), Some(tangents)) = (images.normal, tangents) {
            let value = self.image_values(simd, number(by), there, &places);
            let tangents = Tangents8::of(tangents, &triangles, to_own);
            let map = (value, by.scale.into(), format);
            let (is_turned, n) = tangents.turn(simd, hits, shading, map);
            put3(simd, &mut shading.n, there & is_turned, n);
        }
        if let Some(by) = images.color {
            let asked = TextureUse { texture: by.texture, channel: by.channel, is_color: true };
            let values = self.image_values(simd, asked, there, &places);
            let brings_none = batch.has_no_colors();
            for lane in lanes(there) {
                let [r, g, b] = get(&values, lane);
                let written = || Param::<Rgb>::from(by).at(|_| Rgb::new(r, g, b));
                let color = if brings_none {
                    written()
                } else {
                    let own = self.own_color(batch, &hits.get(lane));
                    self.diffuse_color(shading.material[lane], own, written)
                };
                set(&mut shading.color, lane, color.to_array());
            }
        }
        there
    }

    #[inline(always)]
    fn image_values<S: Simd>(
        &self,
        simd: S,
        asked: TextureUse,
        lanes: u32,
        places: &Places,
    ) -> Lanes3 {
        let texture = &self.textures[asked.texture.0 as usize];
        texture.image_values(simd, lanes, &places.uv, &places.sides, asked)
    }
}

/// Where textures are at eight surfaces of a mesh, whose triangles have these corners and coordinates there. `to_own`
/// leads from the world to the mesh's own space; `None`: they are the same.
#[inline(always)]
fn places<S: Simd>(
    simd: S,
    met: Met8<'_>,
    [a, b, c]: [Lanes3; 3],
    uvs: &[[[f32; 8]; 2]; 3],
    to_own: Option<DMat3>,
) -> Places {
    let load = |all: &[f32; 8]| f32x8::load_array_ref(simd, all);
    let uvs = [
        [load(&uvs[0][0]), load(&uvs[0][1])],
        [load(&uvs[1][0]), load(&uvs[1][1])],
        [load(&uvs[2][0]), load(&uvs[2][1])],
    ];
    let (u, v) = (load(&met.hits.u), load(&met.hits.v));
    let w = Lanes::splat(u, 1.0) - u - v;
    let mut places = Places { uv: [[0.0; 8]; 2], sides: [[[0.0; 8]; 2]; 2] };
    // Half by half from here on: a closure called for each would be compiled without the level's instructions.
    let (first, _) = u.widen();
    let (mut ab, mut ac) = ([[first; 2]; 2], [[first; 2]; 2]);
    for k in 0..2 {
        let at = w * uvs[0][k] + u * uvs[1][k] + v * uvs[2][k];
        let (low, high) = at.widen();
        low.store_slice(&mut places.uv[k][..4]);
        high.store_slice(&mut places.uv[k][4..]);
        let [a, b, c] = [uvs[0][k].widen(), uvs[1][k].widen(), uvs[2][k].widen()];
        (ab[0][k], ac[0][k]) = (b.0 - a.0, c.0 - a.0);
        (ab[1][k], ac[1][k]) = (b.1 - a.1, c.1 - a.1);
    }
    let Some(widths) = met.widths else { return places };
    // Of what is a point the sides are 0.
    let (low, high) = load(widths).at_least(0.0).widen();
    let widths = [low, high];
    let dir = wide3(load3(simd, &met.rays.dir));
    let ng = wide3(load3(simd, &met.surfaces.ng));
    let (a, b, c) = (wide3(load3(simd, &a)), wide3(load3(simd, &b)), wide3(load3(simd, &c)));
    for half in 0..2 {
        let [s, t] = footprint(widths[half], dir[half], ng[half]);
        let along = match to_own {
            Some(to_own) => [times(to_own, s), times(to_own, t)],
            None => [s, t],
        };
        let edges = [sub(b[half], a[half]), sub(c[half], a[half])];
        let changes = weights_changes(edges, along);
        for (places, [x, y]) in places.sides.iter_mut().zip(changes) {
            for (k, places) in places.iter_mut().enumerate() {
                let side = x * ab[half][k] + y * ac[half][k];
                side.store_slice(&mut places[4 * half..][..4]);
            }
        }
    }
    places
}

/// The tangents at the corners of eight triangles in the mesh's own space, and the hand of each.
struct Tangents8 {
    corners: [Lanes3; 3],
    hand: [f32; 8],
    to_world: Option<DMat3>,
}

impl Tangents8 {
    #[inline(always)]
    fn of(all: &Tangents, triangles: &[u32; 8], to_own: Option<DMat3>) -> Self {
        let mut eight = Self {
            corners: [[[0.0; 8]; 3]; 3],
            hand: [0.0; 8],
            to_world: to_own.map(|to_own| to_own.inverse()),
        };
        // A mirror image has the other hand.
        let side = if eight.to_world.is_some_and(|m| m.determinant() < 0.0) { -1.0 } else { 1.0 };
        for (lane, &triangle) in triangles.iter().enumerate() {
            let tangents = all.get(triangle as usize).unwrap_or_default();
            for (to, [x, y, z, _]) in eight.corners.iter_mut().zip(tangents) {
                set(to, lane, [x, y, z]);
            }
            eight.hand[lane] = side * tangents[0][3];
        }
        eight
    }

    /// The shading normals that the values of a map show at hits of these triangles; and where there are some, a bit
    /// each.
    #[inline(always)]
    fn turn<S: Simd>(
        &self,
        simd: S,
        hits: &Hits8,
        shading: &Shading8,
        (value, strength, format): (Lanes3, f64, NormalFormat),
    ) -> (u32, [f32x8<S>; 3]) {
        let load = |all: &[f32; 8]| f32x8::load_array_ref(simd, all);
        let [a, b, c] = &self.corners;
        let (a, b, c) = (wide3(load3(simd, a)), wide3(load3(simd, b)), wide3(load3(simd, c)));
        let facing = wide3(load3(simd, &shading.n));
        let front = wide3(load3(simd, &shading.front));
        let value = wide3(load3(simd, &value));
        let one: f32x8<S> = SimdBase::splat(simd, 1.0);
        let side = mask32x8::from_bitmask(simd, shading.flipped.into()).select(-one, one);
        let (u, v) = (load(&hits.u).widen(), load(&hits.v).widen());
        let (side, hand) = (side.widen(), load(&self.hand).widen());
        let (u, v) = ([u.0, u.1], [v.0, v.1]);
        let (side, hand) = ([side.0, side.1], [hand.0, hand.1]);
        let (mut is_turned, mut n) = (0, facing);
        // A closure called for each half would be compiled without the level's instructions.
        for half in 0..2 {
            let (u, v) = (u[half], v[half]);
            let w = Lanes::splat(u, 1.0) - u - v;
            let mut t = add(add(scale(w, a[half]), scale(u, b[half])), scale(v, c[half]));
            if let Some(to_world) = self.to_world {
                t = times(to_world, t);
            }
            // The texture lies about the normal as the surface has it, whichever side is seen.
            let own = scale(side[half], facing[half]);
            let (is_there, [t, b]) = frame(t, own);
            let map = mapped(value[half], (strength, format));
            let turned = turned(own, [t, scale(hand[half], b)], map);
            is_turned |= (is_there.to_bitmask() as u32) << (4 * half);
            n[half] = raised(scale(side[half], turned), front[half], facing[half]);
        }
        let [low, high] = n;
        (is_turned, [low[0].narrow(high[0]), low[1].narrow(high[1]), low[2].narrow(high[2])])
    }
}

/// A vector transformed.
#[inline(always)]
fn times<S: Simd>(m: DMat3, [x, y, z]: [f64x4<S>; 3]) -> [f64x4<S>; 3] {
    [
        x * m.x_axis.x + y * m.y_axis.x + z * m.z_axis.x,
        x * m.x_axis.y + y * m.y_axis.y + z * m.z_axis.y,
        x * m.x_axis.z + y * m.y_axis.z + z * m.z_axis.z,
    ]
}
