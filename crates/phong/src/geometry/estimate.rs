//! How much memory a geometry takes, told before it is built.

use std::collections::BTreeSet;
use std::mem::size_of;

use glam::{DAffine3, Vec2, Vec3};
use phong_bvh::{Cylinder, Sphere};
use phong_scene::{Field, Material, Mesh, Object, Rgb, Scene, Shape, Shared};

use super::ObjectRecord;
use super::batch::Batch;

/// Nodes and leaves of a triangle, and what the builder holds for a moment: measured, rounded up.
const TRIANGLE: usize = 160;
/// The tangents at the corners of a triangle, where a texture turns its normals.
const TANGENTS: usize = size_of::<[[f32; 4]; 3]>();
/// What making them holds for a moment, of the mesh at hand: for each triangle at most its numbers, slopes and groups,
/// 92 bytes, three corners that are one with no other, 72, the sums of three groups, 132, their tangents, 36, and
/// groups that fall apart, 24.
const MAKING_TANGENTS: usize = 356;
/// The same of a sphere, or of another primitive.
const SPHERE: usize = 120;
/// The same of a cylinder of a bundle.
const CYLINDER: usize = 150;
/// A placed tree: its two transforms, its box, and its share of the tree over all.
const INSTANCE: usize = 4 * size_of::<DAffine3>() + SPHERE;

/// About how many bytes the geometry of a scene of `count` objects takes, instances unfolded; the
/// build's own included, and each array once however many objects share it.
pub(super) fn estimate(scene: &Scene, count: u64) -> u64 {
    let mut seen = BTreeSet::new();
    let arrays = scene.all_objects().map(|object| bytes(object, &mut seen));
    let arrays = arrays.fold(tangents(scene), |sum, bytes| sum.saturating_add(bytes as u64));
    let each = size_of::<Object>() + size_of::<ObjectRecord>() + size_of::<Batch>() + INSTANCE;
    arrays.saturating_add(count.saturating_mul(each as u64))
}

/// Bytes that the tangents of meshes take that have a material with turned normals, and those that making
/// them takes, one mesh after another.
fn tangents(scene: &Scene) -> u64 {
    let is_turned = |material: &Material| material.normal.is_some() || material.bump.is_some();
    if !scene.materials.iter().any(is_turned) {
        return 0;
    }
    let turned = |number: u32| scene.materials.get(number as usize).is_some_and(is_turned);
    let mut seen = BTreeSet::new();
    let (mut triangles, mut largest) = (0_u64, 0);
    // While they are made, each normal is kept made unit once.
    let mut normals_of_one = 0;
    for object in scene.all_objects() {
        let Shape::Mesh(mesh) = &object.shape else { continue };
        let Mesh { positions, indices, normals, uvs, uv_indices, .. } = &**mesh;
        let key = [
            Shared::address(positions),
            Shared::address(indices),
            Shared::address(uvs),
            Shared::address(uv_indices),
            Shared::address(normals),
        ];
        if !uvs.is_empty() && object.material_numbers().any(turned) && seen.insert(key) {
            triangles = triangles.saturating_add(indices.len() as u64);
            largest = largest.max(indices.len() as u64);
            normals_of_one = normals_of_one.max((normals.len() * size_of::<Vec3>()) as u64);
        }
    }
    let kept = triangles.saturating_mul(TANGENTS as u64);
    kept.saturating_add(largest.saturating_mul(MAKING_TANGENTS as u64))
        .saturating_add(normals_of_one)
}

/// Bytes that the arrays of an object take with their tree, unless they were seen before.
fn bytes(object: &Object, seen: &mut BTreeSet<usize>) -> usize {
    match &object.shape {
        Shape::Mesh(mesh) => {
            array(&mesh.positions, 0, seen)
                + array(&mesh.indices, TRIANGLE, seen)
                + array(&mesh.normals, 0, seen)
                + array(&mesh.normal_indices, 0, seen)
                + array::<Vec2>(&mesh.uvs, 0, seen)
                + array(&mesh.uv_indices, 0, seen)
                + array::<Rgb>(&mesh.colors, 0, seen)
                + array(&mesh.face_materials, 0, seen)
                + fields(&mesh.fields, seen)
        }
        Shape::Points(points) => {
            array(&points.spheres, size_of::<Sphere>() + SPHERE, seen)
                + array(&points.colors, 0, seen)
                + fields(&points.fields, seen)
        }
        Shape::Cylinders(cylinders) => {
            array(&cylinders.segments, size_of::<Cylinder>() + CYLINDER, seen)
                + array(&cylinders.colors, 0, seen)
                + fields(&cylinders.fields, seen)
        }
        _ => 0,
    }
}

/// Bytes of the numbers of points.
fn fields(fields: &[Field], seen: &mut BTreeSet<usize>) -> usize {
    fields.iter().map(|field| array(&field.values, 0, seen)).sum()
}

/// Bytes of an array, and as many more for each value in it.
fn array<T>(values: &Shared<T>, more: usize, seen: &mut BTreeSet<usize>) -> usize {
    let new = !values.is_empty() && seen.insert(Shared::address(values));
    if new { values.len() * (size_of::<T>() + more) } else { 0 }
}
