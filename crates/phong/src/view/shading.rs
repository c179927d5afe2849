//! What shading needs of a surface besides its geometry, of one surface or of eight.

use fearless_simd::{Simd, f32x8, mask32x8, prelude::*, u32x8};
use glam::Vec3;
use phong_bvh::{Hit, Hits8, lanes};
use phong_scene::Rgb;

use super::View;
use crate::math::Dir3;
use crate::math::lanes::{Lanes3, dot, get, load3, select3, set, splat3, store3};

/// What shading needs of a surface besides its geometry.
pub(super) struct Shading {
    /// Shading normal, on the side of the geometric normal that faces the eye.
    pub(super) n: Dir3,
    /// Number of the material.
    pub(super) material: u32,
    /// The diffuse colour, if the geometry brings one.
    pub(super) color: Option<Rgb>,
}

/// What shading needs of eight surfaces besides their geometry, number by number.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub(crate) struct Shading8 {
    /// Shading normals, on the side of the geometric normals that faces the eye.
    pub(crate) n: Lanes3,
    /// The diffuse colours.
    pub(crate) color: Lanes3,
    /// Numbers of the materials.
    pub(crate) material: [u32; 8],
    /// Surfaces of meshes with smooth normals, one bit each, where they are asked for: shadow rays start
    /// above the face.
    pub(crate) smooth: u32,
    /// How far above: of those surfaces.
    pub(crate) lift: Lanes3,
}

impl Shading8 {
    pub(crate) const NONE: Self = Self {
        n: [[0.0; 8]; 3],
        color: [[0.0; 8]; 3],
        material: [0; 8],
        smooth: 0,
        lift: [[0.0; 8]; 3],
    };
}

impl View {
    /// What shading needs of the surface at a hit whose geometric normal is `ng`; `e` leads to the
    /// eye.
    pub(super) fn shading(&self, hit: &Hit, ng: Dir3, e: Dir3) -> Shading {
        let (material, color, n) = self.attributes(hit);
        Shading { n: n.unwrap_or(ng).facing(ng.facing(e)), material, color }
    }

    /// The material at a hit, and the colour and the shading normal where the geometry brings them.
    #[inline]
    fn attributes(&self, hit: &Hit) -> (u32, Option<Rgb>, Option<Dir3>) {
        let batch = self.geometry.batch(hit.part);
        let corners = self.geometry.corners(hit.part, hit.prim);
        let color = batch.color(hit.prim, corners, hit);
        let normal = corners.and_then(|c| batch.normal(hit.prim, c, hit));
        (batch.material(hit.prim), color, normal)
    }

    /// Whether the geometry brings the colour at a hit, which counts before the material's.
    pub(super) fn has_own_color(&self, hit: &Hit) -> bool {
        self.attributes(hit).1.is_some()
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
        let Shading8 { n, color, material, smooth, lift: lifts } = shading;
        *smooth = 0;
        let zero = f32x8::splat(simd, 0.0);
        *n = store3(ng);
        let mut left = hits.met;
        while left != 0 {
            // Neighbours are mostly of one part.
            let part = hits.part[left.trailing_zeros() as usize & 7];
            let batch = self.geometry.batch(part);
            let parts = u32x8::load_array_ref(simd, &hits.part);
            let same = left & parts.simd_eq(u32x8::splat(simd, part)).to_bitmask() as u32;
            left &= !same;
            if let (Some(number), true) = (batch.only_material(), batch.is_plain()) {
                let own = splat3(zero, self.materials[number as usize].color.to_array());
                // What is in lanes without a hit is unspecified.
                let lanes = if same == hits.met { 0xff } else { same };
                let lanes = mask32x8::from_bitmask(simd, lanes.into());
                *color = store3(select3(lanes, own, load3(simd, color)));
                let old = u32x8::load_array_ref(simd, material);
                lanes.select(u32x8::splat(simd, number), old).store_array(material);
                continue;
            }
            if let (Some(number), false) = (batch.only_material(), batch.is_mesh()) {
                let material_color = self.materials[number as usize].color;
                for lane in lanes(same) {
                    material[lane] = number;
                    let own = batch.color(hits.prim[lane], None, &hits.get(lane));
                    set(color, lane, own.unwrap_or(material_color).to_array());
                }
                continue;
            }
            for lane in lanes(same) {
                let (number, own, normal) = self.attributes(&hits.get(lane));
                material[lane] = number;
                let own = own.unwrap_or(self.materials[number as usize].color);
                set(color, lane, own.to_array());
                if let Some(normal) = normal {
                    set(n, lane, normal.to_array());
                    *smooth |= u32::from(lift) << lane;
                }
            }
        }
        // Turned to the side of the geometric normal that faces the eye, never by N·E: at a silhouette
        // the shading normal may well look away from the eye.
        let back = dot(ng, e).simd_lt(zero);
        let front = select3(back, [-ng[0], -ng[1], -ng[2]], ng);
        let up = load3(simd, n);
        let away = dot(up, front).simd_lt(zero);
        *n = store3(select3(away, [-up[0], -up[1], -up[2]], up));
        if *smooth != 0 {
            let (front, away) = (store3(front), away.to_bitmask());
            for lane in lanes(*smooth) {
                let side = (Vec3::from(get(&front, lane)), away >> lane & 1 != 0);
                set(lifts, lane, self.geometry.lift(&hits.get(lane), side).to_array());
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
    use crate::math::lanes::direction;

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
