//! How much memory a geometry takes, told before it is built.

use std::collections::BTreeSet;
use std::mem::size_of;

use glam::{DAffine3, Vec2};
use phong_bvh::{Cylinder, Sphere};
use phong_scene::{Object, Rgb, Scene, Shape, Shared};

use super::ObjectRecord;
use super::batch::Batch;

/// Nodes and leaves of a triangle, and what the builder holds for a moment: measured, rounded up.
const TRIANGLE: usize = 160;
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
    let in_groups = scene.groups.iter().flat_map(|group| &group.objects);
    let arrays = scene.objects.iter().chain(in_groups).map(|object| bytes(object, &mut seen));
    let arrays = arrays.fold(0_u64, |sum, bytes| sum.saturating_add(bytes as u64));
    let each = size_of::<Object>() + size_of::<ObjectRecord>() + size_of::<Batch>() + INSTANCE;
    arrays.saturating_add(count.saturating_mul(each as u64))
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
        }
        Shape::Points(points) => {
            array(&points.spheres, size_of::<Sphere>() + SPHERE, seen)
                + array(&points.colors, 0, seen)
        }
        Shape::Cylinders(cylinders) => {
            array(&cylinders.segments, size_of::<Cylinder>() + CYLINDER, seen)
                + array(&cylinders.colors, 0, seen)
        }
        _ => 0,
    }
}

/// Bytes of an array, and as many more for each value in it.
fn array<T>(values: &Shared<T>, more: usize, seen: &mut BTreeSet<usize>) -> usize {
    let new = !values.is_empty() && seen.insert(Shared::address(values));
    if new { values.len() * (size_of::<T>() + more) } else { 0 }
}
