//! How much memory a geometry takes, told before it is built.

use std::mem::size_of;

use glam::{Vec2, Vec3};
use phong_bvh::Sphere;
use phong_scene::{Object, Rgb, Scene, Shape};

use super::ObjectRecord;

/// About how many bytes the scene takes once compiled, the build's own included.
pub(super) fn estimate(scene: &Scene) -> u64 {
    /// Nodes, leaves, and what the builder holds for a moment: measured, rounded up.
    const TRIANGLE: usize = 160;
    const SPHERE: usize = 120;
    let bytes = |object: &Object| match &object.shape {
        Shape::Mesh(mesh) => {
            mesh.positions.len() * size_of::<Vec3>()
                + mesh.indices.len() * (size_of::<[u32; 3]>() + TRIANGLE)
                + (mesh.normals.len() + mesh.colors.len()) * size_of::<Vec3>()
                + mesh.uvs.len() * size_of::<Vec2>()
                + (mesh.normal_indices.len() + mesh.uv_indices.len()) * size_of::<[u32; 3]>()
                + mesh.face_materials.len() * size_of::<u32>()
        }
        Shape::Points(points) => {
            points.spheres.len() * (size_of::<Sphere>() + SPHERE)
                + points.colors.len() * size_of::<Rgb>()
        }
        _ => size_of::<Object>() + size_of::<ObjectRecord>() + SPHERE,
    };
    // A group may hold instances of earlier groups only, so one pass in order knows them all.
    let mut groups: Vec<u64> = Vec::with_capacity(scene.groups.len());
    for group in &scene.groups {
        let total = sum(&group.objects, &groups, bytes);
        groups.push(total);
    }
    sum(&scene.objects, &groups, bytes) + groups.iter().fold(0_u64, |a, b| a.saturating_add(*b))
}

fn sum(objects: &[Object], groups: &[u64], bytes: impl Fn(&Object) -> usize) -> u64 {
    objects.iter().fold(0, |total, object| {
        total.saturating_add(match object.shape {
            Shape::Instance(group) => groups.get(group.0 as usize).copied().unwrap_or(0),
            _ => bytes(object) as u64,
        })
    })
}
