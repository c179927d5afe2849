//! Shapes become batches of primitives, and what belongs to them.

use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec2, DVec3};
use phong_bvh::{Plane, Primitives, Sphere};
use phong_scene::{Bounds, Mesh, Object, Points, Shape, cofactor, even_scale};
use rayon::prelude::*;

use super::ObjectRecord;
use super::batch::{Batch, MaterialNumbers, MeshAttributes, Objects};
use super::solid::{self, canonical};
use crate::math::wide;

/// A whole scene's batches.
pub(super) struct Built {
    pub(super) primitives: Vec<Primitives>,
    /// One for each of `primitives`.
    pub(super) batches: Vec<Batch>,
    pub(super) objects: Vec<ObjectRecord>,
}

/// The middle of the scene, rounded to a power of two about as large as the scene, so that scenes
/// written around the origin stay as they were written, and the rest lose no digits.
pub(super) fn center(bounds: Bounds) -> DVec3 {
    let size = bounds.size().max_element();
    if bounds.is_empty() || size == 0.0 {
        return if bounds.is_empty() { DVec3::ZERO } else { bounds.center() };
    }
    let step = wide::power_of_two_above(size);
    (bounds.center() / step).round() * step
}

/// Puts every object into world space moved by `−center`.
pub(super) fn build(leaves: Vec<Object>, center: DVec3) -> Built {
    let mut out = Built {
        primitives: Vec::new(),
        batches: Vec::new(),
        objects: Vec::with_capacity(leaves.len()),
    };
    for Object { name, shape, material, transform, place } in leaves {
        let number = out.objects.len() as u32;
        out.objects.push(ObjectRecord { name, place });
        let to_world = DAffine3::from_translation(-center) * transform;
        match shape {
            Shape::Mesh(mesh) => out.mesh(*mesh, to_world, number, material.0),
            Shape::Points(points) => out.points(*points, to_world, number, material.0),
            shape => out.single(&shape, to_world, number, material.0),
        }
    }
    out
}

impl Built {
    fn push(&mut self, primitives: Primitives, batch: Batch) {
        self.primitives.push(primitives);
        self.batches.push(batch);
    }

    fn mesh(&mut self, mesh: Mesh, to_world: DAffine3, object: u32, material: u32) {
        let Mesh { origin, mut positions, mut indices, normals, face_materials, .. } = mesh;
        let move_by = to_world * DAffine3::from_translation(origin);
        let mut attributes = MeshAttributes {
            normals,
            normal_indices: mesh.normal_indices,
            uvs: mesh.uvs,
            uv_indices: mesh.uv_indices,
            colors: mesh.colors,
        };
        if move_by != DAffine3::IDENTITY {
            positions.par_iter_mut().with_min_len(4096).for_each(|p| {
                *p = move_by.transform_point3(p.as_dvec3()).as_vec3();
            });
        }
        if move_by.matrix3 != DMat3::IDENTITY {
            let normal_matrix = cofactor(move_by.matrix3);
            attributes.normals.par_iter_mut().with_min_len(4096).for_each(|n| {
                *n = (normal_matrix * n.as_dvec3()).normalize_or_zero().as_vec3();
            });
        }
        if move_by.matrix3.determinant() < 0.0 {
            // Mirrored: the winding turns, so that geometric normals stay outward.
            for corners in
                [&mut indices, &mut attributes.normal_indices, &mut attributes.uv_indices]
            {
                corners.par_iter_mut().with_min_len(4096).for_each(|c| c.swap(1, 2));
            }
        }
        let mut batch = Batch::new(Objects::One(object), material);
        if !face_materials.is_empty() {
            batch.materials = MaterialNumbers::OneEach(face_materials);
        }
        batch.mesh = Some(Box::new(attributes));
        self.push(Primitives::triangles(positions.to_arc(), indices.to_arc()), batch);
    }

    fn points(&mut self, points: Points, to_world: DAffine3, object: u32, material: u32) {
        let Points { origin, spheres, colors, .. } = points;
        let move_by = to_world * DAffine3::from_translation(origin);
        let batch = |colors| Batch { colors, ..Batch::new(Objects::One(object), material) };
        let Some(scale) = even_scale(move_by.matrix3) else {
            // Ellipsoids: one batch each.
            for (i, &[x, y, z, radius]) in spheres.iter().enumerate() {
                let center = DVec3::new(x.into(), y.into(), z.into());
                let solid = solid::sphere(center, radius.into(), move_by);
                let colors = colors.get(i).map(|&c| [c].into()).unwrap_or_default();
                self.push(Primitives::Solid(solid), batch(colors));
            }
            return;
        };
        let place = |[x, y, z, radius]: [f32; 4]| Sphere {
            center: move_by.transform_point3(DVec3::new(x.into(), y.into(), z.into())).as_vec3(),
            radius: (f64::from(radius) * scale) as f32,
        };
        let spheres: Vec<_> = spheres.iter().copied().map(place).collect();
        self.push(Primitives::spheres(spheres), batch(colors));
    }

    /// An object that is one primitive, or a box's worth of them.
    fn single(&mut self, shape: &Shape, to_world: DAffine3, object: u32, material: u32) {
        let batch = Batch::new(Objects::OneEach(object), material);
        match *shape {
            Shape::Sphere { center, radius } => {
                let Some(scale) = even_scale(to_world.matrix3) else {
                    let solid = solid::sphere(center, radius, to_world);
                    return self.push(Primitives::Solid(solid), batch);
                };
                let rotation = to_world.matrix3 * (1.0 / scale);
                let rotation =
                    Some(rotation).filter(|rotation| !rotation.abs_diff_eq(DMat3::IDENTITY, 1e-12));
                let center = to_world.transform_point3(center).as_vec3();
                let radius = (radius * scale) as f32;
                self.sphere(Sphere { center, radius }, rotation, object, material);
            }
            Shape::Plane { point, normal } => {
                let point = to_world.transform_point3(point);
                let normal = (cofactor(to_world.matrix3) * normal).normalize_or(DVec3::Y);
                self.push(Primitives::Plane(Plane { point, normal }), batch);
            }
            Shape::Triangle { points, normals, uv } => {
                let to_f32 = |v: DVec3| v.as_vec3();
                let positions = points.map(|p| to_f32(to_world.transform_point3(p))).to_vec();
                let narrow2 = |t: DVec2| t.as_vec2();
                let normal_matrix = cofactor(to_world.matrix3);
                let normal = |n: DVec3| to_f32((normal_matrix * n).normalize_or_zero());
                let attributes = MeshAttributes {
                    normals: normals.map(|n| n.map(normal).into()).unwrap_or_default(),
                    uvs: uv.map(|uv| uv.map(narrow2).into()).unwrap_or_default(),
                    ..MeshAttributes::default()
                };
                let batch = Batch { mesh: Some(Box::new(attributes)), ..batch };
                let mirrored = to_world.matrix3.determinant() < 0.0;
                let indices = vec![if mirrored { [0, 2, 1] } else { [0, 1, 2] }];
                self.push(Primitives::triangles(positions, indices), batch);
            }
            ref solid => {
                if let Some(solid) = canonical(solid, to_world) {
                    self.push(Primitives::Solid(solid), batch);
                }
            }
        }
    }

    /// Spheres written one after another share a batch.
    fn sphere(&mut self, sphere: Sphere, rotation: Option<DMat3>, object: u32, material: u32) {
        if let (Some(Primitives::Spheres(spheres)), Some(batch)) =
            (self.primitives.last_mut(), self.batches.last_mut())
            && let (Objects::OneEach(first), MaterialNumbers::OneEach(materials)) =
                (batch.objects, &mut batch.materials)
            && first + spheres.len() as u32 == object
        {
            let local = spheres.len() as u32;
            Arc::make_mut(spheres).push(sphere);
            materials.push(material);
            batch.rotations.extend(rotation.map(|rotation| (local, rotation)));
            return;
        }
        let mut batch = Batch::new(Objects::OneEach(object), material);
        batch.materials = MaterialNumbers::OneEach([material].into());
        batch.rotations.extend(rotation.map(|rotation| (0, rotation)));
        self.push(Primitives::spheres(vec![sphere]), batch);
    }
}
