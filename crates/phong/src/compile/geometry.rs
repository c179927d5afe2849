//! Shapes become batches of primitives, and what belongs to them.

use std::mem::size_of;
use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec2, DVec3, Vec2, Vec3};
use phong_bvh::{Canonical, Hit, Plane, Primitives, Solid, Sphere};
use phong_scene::{
    Bounds, MaterialId, Mesh, NO_INDEX, Object, Points, Rgb, Scene, Shape, cofactor, even_scale,
};
use rayon::prelude::*;

use super::ObjectRecord;
use crate::math::{Dir3, wide};

/// What belongs to the primitives of one batch.
#[derive(Debug)]
pub(super) struct Part {
    object: Number,
    material: Numbers,
    mesh: Option<Box<Attributes>>,
    /// A colour a sphere; empty: the material's.
    colors: Vec<Rgb>,
}

/// The object of a batch's primitives.
#[derive(Debug)]
enum Number {
    /// The same for all: a mesh, a cloud of points.
    Same(u32),
    /// The first primitive's; each further one belongs to the next object.
    From(u32),
}

/// The material of a batch's primitives.
#[derive(Debug)]
enum Numbers {
    Same(u32),
    Each(Vec<u32>),
}

/// What a mesh carries beside its triangles.
#[derive(Debug)]
struct Attributes {
    normals: Vec<Vec3>,
    normal_indices: Vec<[u32; 3]>,
    uvs: Vec<Vec2>,
    uv_indices: Vec<[u32; 3]>,
    colors: Vec<Rgb>,
}

impl Part {
    #[inline]
    pub(super) fn object(&self, local: u32) -> u32 {
        match self.object {
            Number::Same(object) => object,
            Number::From(first) => first + local,
        }
    }

    pub(super) fn is_bulk(&self) -> bool {
        matches!(self.object, Number::Same(_))
    }

    #[inline]
    pub(super) fn material(&self, local: u32) -> u32 {
        match &self.material {
            Numbers::Same(material) => *material,
            Numbers::Each(materials) => materials[local as usize],
        }
    }

    /// The material, where all primitives have the same.
    #[inline]
    pub(super) fn only_material(&self) -> Option<u32> {
        match self.material {
            Numbers::Same(material) => Some(material),
            Numbers::Each(_) => None,
        }
    }

    /// Whether its surfaces have only what the shape and the material give them.
    #[inline]
    pub(super) fn is_plain(&self) -> bool {
        let bare = |mesh: &Attributes| mesh.normals.is_empty() && mesh.colors.is_empty();
        self.colors.is_empty() && self.mesh.as_ref().is_none_or(|mesh| bare(mesh))
    }

    /// The interpolated shading normal; `None` where the mesh has none.
    #[inline]
    pub(super) fn normal(&self, local: u32, corners: [u32; 3], hit: &Hit) -> Option<Dir3> {
        let mesh = self.mesh.as_ref()?;
        let [a, b, c] = at_corners(&mesh.normals, &mesh.normal_indices, local, corners)?;
        Dir3::new((1.0 - hit.u - hit.v) * a + hit.u * b + hit.v * c)
    }

    /// The interpolated texture coordinates; `None` where the mesh has none.
    pub(super) fn uv(&self, local: u32, corners: [u32; 3], hit: &Hit) -> Option<Vec2> {
        let mesh = self.mesh.as_ref()?;
        let [a, b, c] = at_corners(&mesh.uvs, &mesh.uv_indices, local, corners)?;
        Some((1.0 - hit.u - hit.v) * a + hit.u * b + hit.v * c)
    }

    /// The geometry's own colour; `None` where it is the material's.
    #[inline]
    pub(super) fn color(&self, local: u32, corners: Option<[u32; 3]>, hit: &Hit) -> Option<Rgb> {
        if let (Some(mesh), Some(corners)) = (&self.mesh, corners) {
            let [a, b, c] = at_corners(&mesh.colors, &[], local, corners)?;
            return Some((1.0 - hit.u - hit.v) * a + hit.u * b + hit.v * c);
        }
        self.colors.get(local as usize).copied()
    }
}

/// The values at a triangle's corners; `None` where there are none.
#[inline]
fn at_corners<T: Copy>(
    values: &[T],
    indices: &[[u32; 3]],
    local: u32,
    corners: [u32; 3],
) -> Option<[T; 3]> {
    if values.is_empty() {
        return None;
    }
    let corners = indices.get(local as usize).copied().unwrap_or(corners);
    if corners.contains(&NO_INDEX) {
        return None;
    }
    Some(corners.map(|i| values[i as usize]))
}

/// A whole scene's batches.
pub(super) struct Compiled {
    pub(super) geometry: Vec<Primitives>,
    pub(super) parts: Vec<Part>,
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

/// Bakes every object into world space moved by `−center`.
///
/// `has_grain` tells the materials on which it is seen how a surface is turned.
pub(super) fn compile(
    leaves: Vec<Object>,
    center: DVec3,
    has_grain: &dyn Fn(MaterialId) -> bool,
) -> Compiled {
    let mut out = Compiled {
        geometry: Vec::new(),
        parts: Vec::new(),
        objects: Vec::with_capacity(leaves.len()),
    };
    for Object { name, shape, material, transform, place } in leaves {
        let number = out.objects.len() as u32;
        out.objects.push(ObjectRecord { name, place });
        let to_world = DAffine3::from_translation(-center) * transform;
        match shape {
            Shape::Mesh(mesh) => out.mesh(*mesh, to_world, number, material.0),
            Shape::Points(points) => out.points(*points, to_world, number, material.0),
            shape => out.single(&shape, to_world, number, material.0, has_grain(material)),
        }
    }
    out
}

impl Compiled {
    fn push(&mut self, geometry: Primitives, part: Part) {
        self.geometry.push(geometry);
        self.parts.push(part);
    }

    fn mesh(&mut self, mesh: Mesh, to_world: DAffine3, object: u32, material: u32) {
        let Mesh { origin, mut positions, mut indices, normals, face_materials, .. } = mesh;
        let move_by = to_world * DAffine3::from_translation(origin);
        let mut attributes = Attributes {
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
        let material = if face_materials.is_empty() {
            Numbers::Same(material)
        } else {
            Numbers::Each(face_materials)
        };
        let part = Part {
            object: Number::Same(object),
            material,
            mesh: Some(Box::new(attributes)),
            colors: Vec::new(),
        };
        self.push(Primitives::triangles(positions, indices), part);
    }

    fn points(&mut self, points: Points, to_world: DAffine3, object: u32, material: u32) {
        let Points { origin, spheres, colors } = points;
        let move_by = to_world * DAffine3::from_translation(origin);
        let part = |object| Part {
            object: Number::Same(object),
            material: Numbers::Same(material),
            mesh: None,
            colors: Vec::new(),
        };
        let Some(scale) = even_scale(move_by.matrix3) else {
            // Ellipsoids: one batch each.
            for (i, [x, y, z, radius]) in spheres.into_iter().enumerate() {
                let center = DVec3::new(x.into(), y.into(), z.into());
                let solid = sphere_solid(center, radius.into(), move_by);
                let colors = colors.get(i).map(|&c| vec![c]).unwrap_or_default();
                self.push(Primitives::Solid(solid), Part { colors, ..part(object) });
            }
            return;
        };
        let place = |[x, y, z, radius]: [f32; 4]| Sphere {
            center: move_by.transform_point3(DVec3::new(x.into(), y.into(), z.into())).as_vec3(),
            radius: (f64::from(radius) * scale) as f32,
        };
        // The same size and alignment: the collection happens in place.
        let spheres: Vec<_> = spheres.into_iter().map(place).collect();
        self.push(Primitives::spheres(spheres), Part { colors, ..part(object) });
    }

    /// An object that is one primitive, or a box's worth of them.
    fn single(
        &mut self,
        shape: &Shape,
        to_world: DAffine3,
        object: u32,
        material: u32,
        has_grain: bool,
    ) {
        let part = Part {
            object: Number::Same(object),
            material: Numbers::Same(material),
            mesh: None,
            colors: Vec::new(),
        };
        let part = Part { object: Number::From(object), ..part };
        match *shape {
            Shape::Sphere { center, radius } => match even_scale(to_world.matrix3) {
                // A turned sphere looks as one that is not, unless it has a grain.
                Some(scale) if !has_grain || is_scale(to_world.matrix3, scale) => {
                    let center = to_world.transform_point3(center).as_vec3();
                    let radius = (radius * scale) as f32;
                    self.sphere(Sphere { center, radius }, object, material);
                }
                _ => self.push(Primitives::Solid(sphere_solid(center, radius, to_world)), part),
            },
            Shape::Plane { point, normal } => {
                let point = to_world.transform_point3(point);
                let normal = (cofactor(to_world.matrix3) * normal).normalize_or(DVec3::Y);
                self.push(Primitives::Plane(Plane { point, normal }), part);
            }
            Shape::Triangle { points, normals, uv } => {
                let to_f32 = |v: DVec3| v.as_vec3();
                let positions = points.map(|p| to_f32(to_world.transform_point3(p))).to_vec();
                let narrow2 = |t: DVec2| t.as_vec2();
                let normal_matrix = cofactor(to_world.matrix3);
                let normal = |n: DVec3| to_f32((normal_matrix * n).normalize_or_zero());
                let attributes = Attributes {
                    normals: normals.map(|n| n.map(normal).to_vec()).unwrap_or_default(),
                    normal_indices: Vec::new(),
                    uvs: uv.map(|uv| uv.map(narrow2).to_vec()).unwrap_or_default(),
                    uv_indices: Vec::new(),
                    colors: Vec::new(),
                };
                let part = Part { mesh: Some(Box::new(attributes)), ..part };
                let mirrored = to_world.matrix3.determinant() < 0.0;
                let indices = vec![if mirrored { [0, 2, 1] } else { [0, 1, 2] }];
                self.push(Primitives::triangles(positions, indices), part);
            }
            ref solid => {
                if let Some(solid) = canonical(solid, to_world) {
                    self.push(Primitives::Solid(solid), part);
                }
            }
        }
    }

    /// Spheres written one after another share a batch.
    fn sphere(&mut self, sphere: Sphere, object: u32, material: u32) {
        if let (Some(Primitives::Spheres(spheres)), Some(part)) =
            (self.geometry.last_mut(), self.parts.last_mut())
            && let (Number::From(first), Numbers::Each(materials)) =
                (&part.object, &mut part.material)
            && first + spheres.len() as u32 == object
        {
            Arc::make_mut(spheres).push(sphere);
            materials.push(material);
            return;
        }
        let part = Part {
            object: Number::From(object),
            material: Numbers::Each(vec![material]),
            mesh: None,
            colors: Vec::new(),
        };
        self.push(Primitives::spheres(vec![sphere]), part);
    }
}

/// The canonical shape that a scene's shape is, placed; `None` for shapes that are none.
fn canonical(shape: &Shape, to_world: DAffine3) -> Option<Solid> {
    let (shape, own) = match *shape {
        Shape::Disc { center, normal, radius } => {
            (Canonical::Disc, along(center, normal, radius, 1.0))
        }
        Shape::Box { min, max } => {
            let (middle, half) = ((min + max) / 2.0, (max - min) / 2.0);
            (Canonical::Box, DAffine3::from_translation(middle) * DAffine3::from_scale(half))
        }
        Shape::Cylinder { from, to, radius, capped } => {
            let axis = to - from;
            (Canonical::Cylinder { capped }, along(from, axis, radius, axis.length()))
        }
        Shape::Cone { from, to, radius, radius_to, capped } => {
            let axis = to - from;
            // In units of the larger radius.
            let unit = radius.max(radius_to);
            let cone =
                Canonical::Cone { radius: radius / unit, radius_to: radius_to / unit, capped };
            (cone, along(from, axis, unit, axis.length()))
        }
        Shape::Torus { center, axis, radius, tube } => {
            (Canonical::Torus { tube: tube / radius }, along(center, axis, radius, radius))
        }
        Shape::Sphere { .. }
        | Shape::Plane { .. }
        | Shape::Triangle { .. }
        | Shape::Mesh(_)
        | Shape::Points(_)
        | Shape::Instance(_) => return None,
    };
    Some(Solid { shape, to_world: to_world * own })
}

/// The frame whose origin is `from` and whose z axis is along `axis`: x and y scaled by `radius`,
/// z by `height`.
fn along(from: DVec3, axis: DVec3, radius: f64, height: f64) -> DAffine3 {
    let z = axis.normalize_or(DVec3::Z);
    let (x, y) = z.any_orthonormal_pair();
    // A right-handed frame, so that no shape is mirrored.
    let (x, y) = if x.cross(y).dot(z) < 0.0 { (y, x) } else { (x, y) };
    DAffine3 { matrix3: DMat3::from_cols(x * radius, y * radius, z * height), translation: from }
}

fn sphere_solid(center: DVec3, radius: f64, to_world: DAffine3) -> Solid {
    let own = DAffine3 { matrix3: DMat3::from_diagonal(DVec3::splat(radius)), translation: center };
    Solid { shape: Canonical::Sphere, to_world: to_world * own }
}

/// Whether a matrix is a scale and nothing else.
fn is_scale(m: DMat3, scale: f64) -> bool {
    m.abs_diff_eq(DMat3::from_diagonal(DVec3::splat(scale)), 1e-12 * scale)
}
