//! What shading needs of a surface besides its geometry, of one surface or of eight.

use fearless_simd::{Simd, f32x8, mask32x8, prelude::*, u32x8};
use phong_bvh::{Hit, Hits8, Primitives, lanes};
use phong_scene::{Rgb, VertexColors};

use super::View;
use super::clip::cap_of;
use crate::geometry::Batch;
use crate::math::Dir3;
use crate::math::lanes::{Lanes3, direction, dot, load3, put3, select3, set, splat3, store3};

/// What shading needs of a surface besides its geometry.
pub(super) struct Shading {
    /// Shading normal, on the side of the geometric normal that faces the eye.
    pub(super) n: Dir3,
    /// Whether it is turned to that side.
    pub(super) is_flipped: bool,
    /// Number of the material.
    pub(super) material: u32,
    /// The colour that the geometry brings, if it brings one.
    pub(super) color: Option<Rgb>,
}

/// What shading needs of eight surfaces besides their geometry, number by number.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub(crate) struct Shading8 {
    /// Shading normals, on the side of the geometric normals that faces the eye.
    pub(crate) n: Lanes3,
    /// The geometric normals on that side.
    pub(crate) front: Lanes3,
    /// The diffuse colours.
    pub(crate) color: Lanes3,
    /// Numbers of the materials.
    pub(crate) material: [u32; 8],
    /// Surfaces whose shading normals are turned to that side, one bit each.
    pub(crate) flipped: u32,
    /// Surfaces of meshes with smooth normals, one bit each, where they are asked for: shadow rays start
    /// above the face.
    pub(crate) smooth: u32,
    /// How far above: of those surfaces.
    pub(crate) lift: Lanes3,
}

impl Shading8 {
    pub(crate) const NONE: Self = Self {
        n: [[0.0; 8]; 3],
        front: [[0.0; 8]; 3],
        color: [[0.0; 8]; 3],
        material: [0; 8],
        flipped: 0,
        smooth: 0,
        lift: [[0.0; 8]; 3],
    };
}

impl View {
    /// What shading needs of the surface at a hit whose geometric normal is `ng`; `e` leads to the
    /// eye.
    pub(super) fn shading(&self, hit: &Hit, ng: Dir3, e: Dir3) -> Shading {
        let batch = self.geometry.batch(hit.part);
        if self.cap_normal(hit, e).is_some() {
            let (material, color) = (self.material_of(hit), self.own_color(batch, hit));
            return Shading { n: ng.facing(e), is_flipped: false, material, color };
        }
        let own = self.own_normal(hit).unwrap_or(ng);
        let n = own.facing(ng.facing(e));
        let (material, color) = (batch.material(hit.prim), self.own_color(batch, hit));
        Shading { n, is_flipped: n != own, material, color }
    }

    /// The shading normal, where the geometry brings one.
    #[inline]
    pub(super) fn own_normal(&self, hit: &Hit) -> Option<Dir3> {
        let corners = self.geometry.corners(hit.part, hit.prim)?;
        self.geometry.batch(hit.part).normal(hit.prim, corners, hit)
    }

    /// The colour, where the geometry brings one.
    #[inline]
    pub(super) fn own_color(&self, batch: &Batch, hit: &Hit) -> Option<Rgb> {
        if self.clipping.is_some() && cap_of(hit).is_some() {
            // On the way through a mesh its colours are not known.
            let brings_none = batch.is_mesh() || self.cap_material(hit).is_some();
            let beyond = Hit { u: hit.v, ..*hit };
            return if brings_none { None } else { batch.color(hit.prim, None, &beyond) };
        }
        let corners = batch.is_mesh().then(|| self.geometry.corners(hit.part, hit.prim)).flatten();
        batch.color(hit.prim, corners, hit)
    }

    /// The diffuse colour where the geometry may bring one of its own, and the material's is `written`.
    #[inline]
    pub(super) fn diffuse_color(
        &self,
        material: u32,
        own: Option<Rgb>,
        written: impl FnOnce() -> Rgb,
    ) -> Rgb {
        match (own, self.materials[material as usize].vertex_colors) {
            (None, _) | (_, VertexColors::Ignore) => written(),
            (Some(own), VertexColors::Replace) => own,
            (Some(own), VertexColors::Multiply) => written() * own,
        }
    }

    /// [`View::shading`] of those of eight surfaces that were hit: the same bits, with the
    /// material's colour where the geometry brings none. With `lift` the smooth ones are told how far above
    /// them shadow rays start.
    #[inline(always)]
    pub(crate) fn shading8<S: Simd>(
        &self,
        simd: S,
        hits: &Hits8,
        ng: [f32x8<S>; 3],
        e: [f32x8<S>; 3],
        lift: bool,
        shading: &mut Shading8,
    ) {
        let zero = f32x8::splat(simd, 0.0);
        let back = dot(ng, e).simd_lt(zero);
        let front = select3(back, [-ng[0], -ng[1], -ng[2]], ng);
        shading.front = store3(front);
        shading.n = store3(ng);
        shading.smooth = 0;
        let mut left = hits.met;
        while left != 0 {
            // Neighbours are mostly of one part.
            let first = left.trailing_zeros() as usize & 7;
            let part = hits.part[first];
            let batch = self.geometry.batch(part);
            let parts = u32x8::load_array_ref(simd, &hits.part);
            let same = left & parts.simd_eq(u32x8::splat(simd, part)).to_bitmask() as u32;
            // What is in lanes without a hit is unspecified, and the others are yet to come.
            let to = if left == hits.met { 0xff } else { same };
            left &= !same;
            match batch.only_material() {
                Some(number) if batch.has_no_colors() => {
                    let color = splat3(zero, self.materials[number as usize].color.to_array());
                    put3(simd, &mut shading.color, to, color);
                    if to == 0xff {
                        shading.material = [number; 8];
                    } else {
                        lanes(to).for_each(|lane| shading.material[lane] = number);
                    }
                }
                _ => self.colors(batch, hits, same, shading),
            }
            let Some(mesh) = batch.smooth() else { continue };
            let Primitives::Triangles { positions, indices } = self.world().primitives(part) else {
                self.normals(hits, same, lift, shading);
                continue;
            };
            // The other lanes repeat the first.
            let own = mask32x8::from_bitmask(simd, same.into());
            let first = u32x8::splat(simd, hits.prim[first]);
            let triangles = own.select(u32x8::load_array_ref(simd, &hits.prim), first);
            let triangles = <[u32; 8]>::from(triangles);
            let corners = triangles.map(|triangle| indices[triangle as usize]);
            let u = own.select(f32x8::load_array_ref(simd, &hits.u), zero);
            let v = own.select(f32x8::load_array_ref(simd, &hits.v), zero);
            let smooth = mesh.normals(simd, &triangles, &corners, [u, v]);
            let there = same & smooth.there;
            // The normals of other parts are there already.
            put3(simd, &mut shading.n, if there == hits.met { 0xff } else { there }, smooth.n);
            if lift && there != 0 {
                let side = (front, dot(smooth.n, front).simd_lt(zero));
                let way = mesh.lifts(simd, &smooth, (positions, &corners), [u, v], side);
                put3(simd, &mut shading.lift, to, way);
                shading.smooth |= there;
            }
        }
        // Turned to the side of the geometric normal that faces the eye, never by N·E: at a silhouette
        // the shading normal may well look away from the eye.
        let up = load3(simd, &shading.n);
        let away = dot(up, front).simd_lt(zero);
        shading.flipped = away.to_bitmask() as u32;
        shading.n = store3(select3(away, [-up[0], -up[1], -up[2]], up));
    }

    /// Makes caps of those of eight surfaces that are some: flat, and of their own material.
    pub(crate) fn shade_caps8(&self, hits: &Hits8, e: &Lanes3, shading: &mut Shading8) {
        if self.clipping.is_none() {
            return;
        }
        for lane in lanes(hits.met) {
            let hit = hits.get(lane);
            let Some(n) = self.cap_normal(&hit, direction(e, lane)) else { continue };
            let batch = self.geometry.batch(hit.part);
            let number = self.material_of(&hit);
            let written = || self.materials[number as usize].color;
            let color = self.diffuse_color(number, self.own_color(batch, &hit), written);
            set(&mut shading.n, lane, n.to_array());
            set(&mut shading.front, lane, n.to_array());
            set(&mut shading.color, lane, color.to_array());
            shading.material[lane] = number;
            shading.smooth &= !(1 << lane);
            shading.flipped &= !(1 << lane);
        }
    }

    /// Materials and colours of some hits in one part, one by one.
    fn colors(&self, batch: &Batch, hits: &Hits8, same: u32, shading: &mut Shading8) {
        for lane in lanes(same) {
            let hit = hits.get(lane);
            let number = batch.material(hit.prim);
            shading.material[lane] = number;
            let written = || self.materials[number as usize].color;
            let color = self.diffuse_color(number, self.own_color(batch, &hit), written);
            set(&mut shading.color, lane, color.to_array());
        }
    }

    /// Shading normals of some hits in one part, one by one: of a mesh whose few triangles are solids.
    fn normals(&self, hits: &Hits8, same: u32, lift: bool, shading: &mut Shading8) {
        for lane in lanes(same) {
            if let Some(normal) = self.own_normal(&hits.get(lane)) {
                set(&mut shading.n, lane, normal.to_array());
                set(&mut shading.lift, lane, [0.0; 3]);
                shading.smooth |= u32::from(lift) << lane;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, Vec3};
    use phong_bvh::{Ray, Rays8, Surfaces8};
    use phong_scene::{Material, MaterialId, Mesh, Object, Points, Scene, Shape};

    use super::*;
    use crate::math::lanes::{direction, get};

    /// A plane, a ball, a mesh of two materials with normals, one with colours, and coloured points, seen
    /// by rays down −z that lie close together.
    fn scene() -> Scene {
        let square = |x: f32| -> Vec<Vec3> {
            [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]]
                .map(|[u, v]| Vec3::new(x + u, v, 0.5))
                .to_vec()
        };
        let indices = vec![[0, 1, 2], [3, 2, 1]];
        let normals = [[0.3, 0.0, 1.0], [0.0, 0.4, -1.0], [-0.2, 0.0, 1.0], [0.1, 0.1, 1.0]];
        let with_normals = Mesh {
            positions: square(0.0).into(),
            indices: indices.clone().into(),
            normals: normals.map(Vec3::from_array).to_vec().into(),
            face_materials: vec![1, 0].into(),
            ..Mesh::default()
        };
        let colors = [Rgb::WHITE, Rgb::BLACK, Rgb::new(1.0, 0.0, 0.0), Rgb::new(0.0, 0.5, 0.0)];
        let with_colors = Mesh {
            positions: square(1.0).into(),
            indices: indices.into(),
            colors: colors.to_vec().into(),
            ..Mesh::default()
        };
        let points = Points {
            spheres: vec![[2.25, 0.5, 0.5, 0.2], [2.75, 0.5, 0.5, 0.2]].into(),
            colors: vec![Rgb::grey(0.25), Rgb::new(0.0, 0.0, 1.0)].into(),
            ..Points::default()
        };
        let shapes = [
            Shape::Plane { point: DVec3::ZERO, normal: DVec3::Z },
            Shape::Sphere { center: DVec3::new(3.5, 0.5, 0.5), radius: 0.4 },
            Shape::Mesh(Box::new(with_normals)),
            Shape::Mesh(Box::new(with_colors)),
            Shape::Points(Box::new(points)),
        ];
        let object = |(i, shape): (usize, Shape)| Object {
            name: format!("shape {i}"),
            material: MaterialId(i as u32 % 2),
            shape,
            ..Object::default()
        };
        let blue = Material { color: Rgb::new(0.1, 0.2, 0.9), ..Material::default() };
        Scene {
            materials: vec![Material::default(), blue.into()],
            objects: shapes.into_iter().enumerate().map(object).collect(),
            ..Scene::default()
        }
    }

    #[test]
    fn eight_surfaces_are_shaded_with_the_bits_of_one() {
        let view = View::of(&scene()).expect("a scene without mistakes");
        let simd = fearless_simd::Fallback::new();
        let start = |i: usize| DVec3::new((i % 40) as f64 * 0.1, (i / 40) as f64 * 0.2 + 0.07, 5.0);
        let rays: Vec<Ray> = (0..200).map(|i| Ray::new(start(i), Vec3::NEG_Z)).collect();
        let eights = Rays8::of(&rays);
        let mut hits = vec![Hits8::NONE; eights.len()];
        let mut surfaces = vec![Surfaces8::default(); eights.len()];
        view.world().intersect_eights(&eights, &mut hits);
        view.world().surface_eights(&eights, &hits, &mut surfaces);
        let (mut materials, mut turned) = ([0, 0], 0);
        for ((rays, hits), surface) in eights.iter().zip(&hits).zip(&surfaces) {
            let mut eight = Shading8::NONE;
            let [x, y, z] = load3(simd, &rays.dir);
            let ng = load3(simd, &surface.ng);
            view.shading8(simd, hits, ng, [-x, -y, -z], false, &mut eight);
            assert_eq!(hits.met, 0xff, "the plane is behind everything");
            for lane in lanes(hits.met) {
                let (ng, e) = (direction(&surface.ng, lane), -direction(&rays.dir, lane));
                let one = view.shading(&hits.get(lane), ng, e);
                assert_eq!(get(&eight.n, lane), one.n.to_array());
                assert_eq!(eight.flipped >> lane & 1 != 0, one.is_flipped);
                let own = one.color.unwrap_or(view.materials()[one.material as usize].color);
                assert_eq!(get(&eight.color, lane), own.to_array());
                assert_eq!(eight.material[lane], one.material);
                materials[one.material as usize] += 1;
                turned += u32::from(one.n != ng);
            }
        }
        assert!(materials[0] > 20 && materials[1] > 20 && turned > 10, "{materials:?} {turned}");
    }
}
