//! Shapes become parts of a world, and what belongs to their primitives.

use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec2, DVec3, Mat3, Vec3};
use phong_bvh::{BuildError, BuildOptions, Part, Plane, Primitives, Sphere, Tree};
use phong_scene::{Cylinders, Light, Mesh, Points, Shape, Shared, cofactor, even_scale};

use super::ObjectRecord;
use super::batch::{Batch, MaterialNumbers, MeshAttributes, Objects};
use super::flatten::Placed;
use super::scale::{FEW_TRIANGLES, Scale};
use super::smooth::ToWorld;
use super::solid::{self, canonical};
use super::trees::{Arrays, Trees};

/// A whole scene's parts.
pub(super) struct Built {
    pub(super) parts: Vec<Part>,
    /// One for each of `parts`.
    pub(super) batches: Vec<Batch>,
    pub(super) objects: Vec<ObjectRecord>,
    /// From the world to their own space, of the objects that have one.
    pub(super) own_spaces: Vec<(u32, DAffine3)>,
    pub(super) trees: Trees,
    /// The meshes that may be lights.
    pub(super) coarse: Vec<CoarseMesh>,
}

/// A mesh of few triangles: its corners in its own space, shared with the scene.
#[derive(Debug)]
pub(super) struct CoarseMesh {
    /// The number of its object.
    pub(super) object: u32,
    positions: Shared<Vec3>,
    indices: Shared<[u32; 3]>,
    to_world: DAffine3,
}

impl CoarseMesh {
    /// Its triangles in the world.
    pub(super) fn triangles(&self) -> Vec<[DVec3; 3]> {
        let corner = |i: u32| {
            let own = self.positions[i as usize].as_dvec3();
            self.to_world.transform_point3(own)
        };
        self.indices.iter().map(|corners| corners.map(corner)).collect()
    }
}

/// Makes parts of all objects. What is written one by one goes into the world moved by minus the centre of
/// `scale`; meshes and clouds become instances of trees, which are taken from `earlier` where they are there.
/// What is too large for f32 next to the others is met in f64, and what is too far away has a tree of its own.
pub(super) fn build(
    placed: Vec<Placed<'_>>,
    scale: Scale,
    earlier: &Trees,
    options: BuildOptions,
) -> Result<Built, BuildError> {
    let mut out = Built {
        parts: Vec::with_capacity(placed.len()),
        batches: Vec::with_capacity(placed.len()),
        objects: Vec::with_capacity(placed.len()),
        trees: Trees::default(),
        own_spaces: Vec::new(),
        coarse: Vec::new(),
    };
    let to_center = DAffine3::from_translation(-scale.center);
    for Placed { object, name, to_world } in placed {
        let number = out.objects.len() as u32;
        let material = object.material.0;
        out.objects.push(ObjectRecord { name, place: object.place.clone() });
        if to_world != DAffine3::IDENTITY {
            out.own_spaces.push((number, to_world.inverse()));
        }
        if let Shape::Mesh(mesh) = &object.shape
            && mesh.indices.len() <= Light::MOST_TRIANGLES
        {
            out.coarse.push(CoarseMesh {
                object: number,
                positions: mesh.positions.clone(),
                indices: mesh.indices.clone(),
                to_world: to_world * DAffine3::from_translation(mesh.origin),
            });
        }
        let (arrays, origin, batch) = match &object.shape {
            Shape::Mesh(mesh)
                if mesh.indices.len() <= FEW_TRIANGLES
                    && scale.is_large(object.shape.bounds(to_world)) =>
            {
                out.facets(mesh, to_center, to_world, number, material);
                continue;
            }
            Shape::Mesh(mesh) => {
                let arrays = Arrays::Triangles(mesh.positions.clone(), mesh.indices.clone());
                (arrays, mesh.origin, of_mesh(mesh, to_world.matrix3, number, material))
            }
            Shape::Points(points) => {
                let batch = Batch::new(Objects::One(number), material);
                let Points { origin, spheres, colors, fields, .. } = &**points;
                let (colors, fields) = (colors.clone(), fields.clone());
                let batch = Batch { colors, fields, ..batch };
                (Arrays::Spheres(spheres.clone()), *origin, batch)
            }
            Shape::Cylinders(cylinders) => {
                let batch = Batch::new(Objects::One(number), material);
                let Cylinders { origin, segments, colors, caps, fields, .. } = &**cylinders;
                let (end_colors, fields) = (colors.clone(), fields.clone());
                let batch = Batch { end_colors, fields, is_ends: true, ..batch };
                (Arrays::Cylinders(segments.clone(), *caps), *origin, batch)
            }
            shape => {
                let bounds = shape.bounds(to_world);
                let large = !bounds.is_empty() && scale.is_large(bounds);
                if !bounds.is_empty() && !large && scale.is_astray(bounds) {
                    let middle = bounds.center();
                    let from = out.parts.len();
                    let to_middle = DAffine3::from_translation(-middle);
                    out.single(shape, to_middle * to_world, false, number, material);
                    out.place_apart(from, middle, options)?;
                } else {
                    out.single(shape, to_center * to_world, large, number, material);
                }
                continue;
            }
        };
        let tree = out.trees.get(arrays, earlier, options)?;
        let to_world = to_world * DAffine3::from_translation(origin);
        out.push(Part::Instance { tree, to_world }, batch);
    }
    Ok(out)
}

/// What belongs to the triangles of a mesh under a transform.
fn of_mesh(mesh: &Mesh, to_world: DMat3, object: u32, material: u32) -> Batch {
    let mut batch = Batch::new(Objects::One(object), material);
    if !mesh.face_materials.is_empty() {
        batch.materials = MaterialNumbers::OneEach(mesh.face_materials.clone());
    }
    let Mesh { normals, normal_indices, uvs, uv_indices, colors, fields, .. } = mesh.clone();
    batch.fields = fields;
    if to_world != DMat3::IDENTITY && !normals.is_empty() {
        // Of about unit size, which f32 can hold whatever the transform's.
        let matrix = cofactor(to_world);
        let largest = matrix.to_cols_array().into_iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        let matrix = if largest > 0.0 { matrix * largest.recip() } else { matrix };
        let narrow =
            |m: DMat3| Mat3::from_cols(m.x_axis.as_vec3(), m.y_axis.as_vec3(), m.z_axis.as_vec3());
        batch.to_world =
            Some(Box::new(ToWorld { normals: narrow(matrix), edges: narrow(to_world) }));
    }
    batch.mesh =
        Some(Box::new(MeshAttributes { normals, normal_indices, uvs, uv_indices, colors }));
    batch
}

impl Built {
    fn push(&mut self, part: Part, batch: Batch) {
        self.parts.push(part);
        self.batches.push(batch);
    }

    fn push_own(&mut self, primitives: Primitives, batch: Batch) {
        self.push(Part::Own(primitives), batch);
    }

    /// Gives the part made last a tree of its own at `middle`, about which its numbers are.
    fn place_apart(
        &mut self,
        number: usize,
        middle: DVec3,
        options: BuildOptions,
    ) -> Result<(), BuildError> {
        let Some(part) = self.parts.get_mut(number) else { return Ok(()) };
        if let Part::Own(primitives) = part {
            let tree = Arc::new(Tree::build(primitives.clone(), options)?);
            *part = Part::Instance { tree, to_world: DAffine3::from_translation(middle) };
            self.batches[number].apart = Some(middle);
        }
        Ok(())
    }

    /// A mesh of few triangles that are to be met in f64, as a primitive each.
    fn facets(
        &mut self,
        mesh: &Mesh,
        to_center: DAffine3,
        to_world: DAffine3,
        object: u32,
        material: u32,
    ) {
        let to_center = to_center * to_world * DAffine3::from_translation(mesh.origin);
        let mirrored = to_world.matrix3.determinant() < 0.0;
        for (number, corners) in mesh.indices.iter().enumerate() {
            let at = |i: u32| to_center.transform_point3(mesh.positions[i as usize].as_dvec3());
            let Some(facet) = solid::facet(corners.map(at), mirrored) else { continue };
            let material = mesh.face_materials.get(number).copied().unwrap_or(material);
            let mut batch = of_mesh(mesh, to_world.matrix3, object, material);
            batch.materials = MaterialNumbers::One(material);
            batch.face = Some((number as u32, *corners));
            if let Some(attributes) = &mut batch.mesh {
                let of_face = |all: &[[u32; 3]]| all.get(number).map_or(vec![], |&own| vec![own]);
                attributes.normal_indices = of_face(&attributes.normal_indices).into();
                attributes.uv_indices = of_face(&attributes.uv_indices).into();
            }
            self.push_own(Primitives::Solid(facet), batch);
        }
    }

    /// An object that is one primitive; `large`: it is to be met in f64.
    fn single(
        &mut self,
        shape: &Shape,
        to_world: DAffine3,
        large: bool,
        object: u32,
        material: u32,
    ) {
        let batch = Batch::new(Objects::OneEach(object), material);
        match *shape {
            Shape::Sphere { center, radius } => {
                let Some(scale) = even_scale(to_world.matrix3).filter(|_| !large) else {
                    let solid = solid::sphere(center, radius, to_world);
                    return self.push_own(Primitives::Solid(solid), batch);
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
                self.push_own(Primitives::Plane(Plane { point, normal }), batch);
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
                if large {
                    let corners = points.map(|p| to_world.transform_point3(p));
                    if let Some(facet) = solid::facet(corners, mirrored) {
                        let face = Some((0, [0, 1, 2]));
                        self.push_own(Primitives::Solid(facet), Batch { face, ..batch });
                    }
                    return;
                }
                let indices = vec![if mirrored { [0, 2, 1] } else { [0, 1, 2] }];
                self.push_own(Primitives::triangles(positions, indices), batch);
            }
            ref solid => {
                if let Some(solid) = canonical(solid, to_world) {
                    self.push_own(Primitives::Solid(solid), batch);
                }
            }
        }
    }

    /// Spheres written one after another share a batch.
    fn sphere(&mut self, sphere: Sphere, rotation: Option<DMat3>, object: u32, material: u32) {
        if let (Some(Part::Own(Primitives::Spheres(spheres))), Some(batch)) =
            (self.parts.last_mut(), self.batches.last_mut())
            && let (Objects::OneEach(first), MaterialNumbers::OneEach(materials)) =
                (batch.objects, &mut batch.materials)
            && first + spheres.len() as u32 == object
        {
            let local = spheres.len() as u32;
            spheres.push(sphere);
            materials.push(material);
            batch.rotations.extend(rotation.map(|rotation| (local, rotation)));
            return;
        }
        let mut batch = Batch::new(Objects::OneEach(object), material);
        batch.materials = MaterialNumbers::OneEach([material].into());
        batch.rotations.extend(rotation.map(|rotation| (0, rotation)));
        self.push_own(Primitives::spheres(vec![sphere]), batch);
    }
}
