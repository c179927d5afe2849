//! What formats without placements and shapes can hold of a scene: its triangles, in world space,
//! as one mesh.

use std::collections::BTreeMap;

use glam::{DAffine3, DMat3, DVec2, DVec3, Vec3};

use crate::color::Rgb;
use crate::diagnostic::Diagnostic;
use crate::format::origin::origin_of;
use crate::material::Material;
use crate::mesh::{Caps, Cylinders, Mesh, NO_INDEX, Points};
use crate::scene::{Group, Object, Scene};
use crate::shape::Shape;
use crate::transform::{cofactor, even_scale};

/// A scene's triangles.
#[derive(Debug, Default)]
pub(crate) struct Merged {
    /// All of them; a material for each, if any has one of its own.
    pub(crate) mesh: Mesh,
    /// What they belong to: the number of the first triangle, and a name.
    pub(crate) objects: Vec<(usize, String)>,
}

/// How many triangles, bytes and spheres there are with all instances unfolded.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Size {
    pub(crate) triangles: u64,
    pub(crate) vertices: u64,
    pub(crate) spheres: u64,
    pub(crate) cylinders: u64,
}

impl Size {
    pub(crate) fn of(scene: &Scene) -> Self {
        let mut groups: Vec<Self> = Vec::with_capacity(scene.groups.len());
        for group in &scene.groups {
            // A group holds instances of earlier ones only.
            let size = Self::sum(&group.objects, &groups);
            groups.push(size);
        }
        Self::sum(&scene.objects, &groups)
    }

    fn sum(objects: &[Object], groups: &[Self]) -> Self {
        objects.iter().fold(Self::default(), |sum, object| {
            let one = match &object.shape {
                Shape::Mesh(mesh) => Self {
                    triangles: mesh.indices.len() as u64,
                    vertices: mesh.positions.len() as u64,
                    ..Self::default()
                },
                Shape::Triangle { .. } => Self { triangles: 1, vertices: 3, ..Self::default() },
                Shape::Sphere { .. } => Self { spheres: 1, ..Self::default() },
                Shape::Points(points) => {
                    Self { spheres: points.spheres.len() as u64, ..Self::default() }
                }
                Shape::Cylinders(cylinders) => {
                    Self { cylinders: cylinders.segments.len() as u64, ..Self::default() }
                }
                Shape::Instance(group) => groups.get(group.0 as usize).copied().unwrap_or_default(),
                _ => Self::default(),
            };
            Self {
                triangles: sum.triangles.saturating_add(one.triangles),
                vertices: sum.vertices.saturating_add(one.vertices),
                spheres: sum.spheres.saturating_add(one.spheres),
                cylinders: sum.cylinders.saturating_add(one.cylinders),
            }
        })
    }

    /// Bytes of memory that all of it takes as one mesh, or as one cloud of points.
    fn bytes(self) -> u64 {
        // Positions, normals, texture coordinates and colours; three indices, one material.
        let mesh =
            self.vertices.saturating_mul(44).saturating_add(self.triangles.saturating_mul(40));
        mesh.saturating_add(self.spheres.saturating_mul(28))
            .saturating_add(self.cylinders.saturating_mul(56))
    }

    /// Refuses what memory, or the numbers of vertices, cannot hold.
    pub(crate) fn check(self, most: u64) -> Result<(), Box<Diagnostic>> {
        let bytes = self.bytes();
        let numbers = u64::from(u32::MAX) - 1;
        let Self { triangles, vertices, spheres, cylinders } = self;
        let largest = vertices.max(triangles).max(spheres).max(cylinders.saturating_mul(2));
        if bytes <= most && largest <= numbers {
            return Ok(());
        }
        let message = format!(
            "with every instance unfolded there are {triangles} triangles, {spheres} spheres and \
             {cylinders} cylinders, which take {bytes} bytes of memory; {most} are allowed"
        );
        let help = "a .toml keeps instances as they are";
        Err(Box::new(Diagnostic::error(message, None).with_help(help)))
    }
}

/// All objects with instances unfolded, each with its placement and the names on the way to it.
pub(crate) fn each_placed<'s>(
    objects: &'s [Object],
    groups: &'s [Group],
    to_world: DAffine3,
    path: &str,
    see: &mut impl FnMut(&'s Object, DAffine3, String),
) {
    for object in objects {
        let to_world = to_world * object.transform;
        let name =
            if path.is_empty() { object.name.clone() } else { format!("{path}/{}", object.name) };
        match object.shape {
            Shape::Instance(group) => {
                if let Some(group) = groups.get(group.0 as usize) {
                    each_placed(&group.objects, groups, to_world, &name, see);
                }
            }
            _ => see(object, to_world, name),
        }
    }
}

/// The scene's triangles as one mesh. If `colors`, vertices without one get that of their
/// material; if `bare`, material 0 is none that the triangles are said to be of.
pub(crate) fn merge(mut scene: Scene, colors: bool, bare: bool) -> Merged {
    if let Some((name, mesh)) = take_only(&mut scene, colors, bare) {
        return Merged { mesh, objects: vec![(0, name)] };
    }
    let scene = &scene;
    let mut out = Merged::default();
    let bounds = scene.bounds();
    if !bounds.is_empty() {
        out.mesh.origin = origin_of([bounds.min, bounds.max]);
    }
    let mut has = [false; 2];
    each_placed(&scene.objects, &scene.groups, DAffine3::IDENTITY, "", &mut |object, _, _| {
        if let Shape::Mesh(mesh) = &object.shape {
            has[0] |= !mesh.uvs.is_empty();
        }
        has[0] |= matches!(object.shape, Shape::Triangle { uv: Some(_), .. });
        has[1] |= !bare || has_own_material(object);
    });
    let [uvs, materials] = has;
    each_placed(&scene.objects, &scene.groups, DAffine3::IDENTITY, "", &mut |object, at, name| {
        let triangle;
        let mesh = match &object.shape {
            Shape::Mesh(mesh) => &**mesh,
            Shape::Triangle { points, normals, uv } => {
                triangle = single(*points, *normals, *uv);
                &triangle
            }
            _ => return,
        };
        out.objects.push((out.mesh.indices.len(), name));
        out.add(mesh, at, uvs);
        let faces = mesh.indices.len();
        if materials {
            if mesh.face_materials.is_empty() {
                out.mesh.face_materials.extend(std::iter::repeat_n(object.material.0, faces));
            } else {
                out.mesh.face_materials.extend(&mesh.face_materials);
            }
        }
        if colors {
            let own = scene.materials.get(object.material.0 as usize).map_or(Rgb::WHITE, own_color);
            let count = mesh.positions.len() - mesh.colors.len().min(mesh.positions.len());
            out.mesh
                .colors
                .extend(mesh.colors.iter().copied().chain(std::iter::repeat_n(own, count)));
        }
    });
    out
}

/// The only mesh, if it already is what merging would make of it.
fn take_only(scene: &mut Scene, colors: bool, bare: bool) -> Option<(String, Mesh)> {
    let [object] = &mut scene.objects[..] else { return None };
    let materials = !bare || has_own_material(object);
    let Shape::Mesh(mesh) = &mut object.shape else { return None };
    let flat = mesh.normals.is_empty()
        || mesh.normal_indices.iter().any(|corners| corners.contains(&NO_INDEX));
    let as_is = !flat
        && object.transform == DAffine3::IDENTITY
        && colors != mesh.colors.is_empty()
        && materials != mesh.face_materials.is_empty();
    as_is.then(|| (object.name.clone(), std::mem::take(&mut **mesh)))
}

/// The colour of what has none of its own; a texture cannot be written, so a grey stands for it.
fn own_color(material: &Material) -> Rgb {
    material.color.constant().unwrap_or(Rgb::grey(0.5))
}

/// Whether a bare model's object has materials from its file.
fn has_own_material(object: &Object) -> bool {
    match &object.shape {
        Shape::Mesh(mesh) => !mesh.face_materials.is_empty() || object.material.0 != 0,
        _ => object.material.0 != 0,
    }
}

impl Merged {
    /// Adds a mesh at its place; corners without a normal get their triangle's.
    fn add(&mut self, mesh: &Mesh, to_world: DAffine3, uvs: bool) {
        let into = &mut self.mesh;
        let place = to_world * DAffine3::from_translation(mesh.origin);
        let still = place == DAffine3::from_translation(into.origin);
        let first = into.positions.len() as u32;
        let world = |p: &Vec3| place.transform_point3(p.as_dvec3());
        if still {
            into.positions.extend(&mesh.positions);
        } else {
            let origin = into.origin;
            into.positions.extend(mesh.positions.iter().map(|p| (world(p) - origin).as_vec3()));
        }
        // Mirrored: the winding turns, so that triangles face the side they faced.
        let mirrored = place.matrix3.determinant() < 0.0;
        let turned = |[a, b, c]: [u32; 3]| if mirrored { [a, c, b] } else { [a, b, c] };
        let first_face = into.indices.len();
        into.indices.extend(mesh.indices.iter().map(|t| turned(t.map(|i| first + i))));

        let first_normal = into.normals.len() as u32;
        let turn = cofactor(place.matrix3);
        let rigid = place.matrix3 == DMat3::IDENTITY;
        into.normals.extend(
            mesh.normals.iter().map(|n| {
                if rigid { *n } else { (turn * n.as_dvec3()).normalize_or_zero().as_vec3() }
            }),
        );
        let corners = |own: &[[u32; 3]], count: usize, face: usize| -> [u32; 3] {
            let numbers = if own.is_empty() { &mesh.indices } else { own };
            if count == 0 { [NO_INDEX; 3] } else { numbers[face] }
        };
        let shifted = |i: u32, first: u32| if i == NO_INDEX { i } else { first + i };
        for face in 0..mesh.indices.len() {
            let own = corners(&mesh.normal_indices, mesh.normals.len(), face);
            let mut normals = turned(own.map(|i| shifted(i, first_normal)));
            if normals.contains(&NO_INDEX) {
                let [a, b, c] = into.indices[first_face + face].map(|i| into.positions[i as usize]);
                let flat = (b - a).as_dvec3().cross((c - a).as_dvec3()).try_normalize();
                if let Some(flat) = flat {
                    let number = into.normals.len() as u32;
                    into.normals.push(flat.as_vec3());
                    normals = normals.map(|n| if n == NO_INDEX { number } else { n });
                }
            }
            into.normal_indices.push(normals);
        }
        if uvs {
            let first_uv = into.uvs.len() as u32;
            into.uvs.extend(&mesh.uvs);
            let uv = |face| corners(&mesh.uv_indices, mesh.uvs.len(), face);
            let uv = (0..mesh.indices.len()).map(|f| turned(uv(f).map(|i| shifted(i, first_uv))));
            into.uv_indices.extend(uv);
        }
    }
}

/// One triangle as a mesh.
fn single(points: [DVec3; 3], normals: Option<[DVec3; 3]>, uv: Option<[DVec2; 3]>) -> Mesh {
    let origin = origin_of(points);
    Mesh {
        origin,
        positions: points.map(|p| (p - origin).as_vec3()).into(),
        indices: [[0, 1, 2]].into(),
        normals: normals.iter().flatten().map(|n| n.normalize_or_zero().as_vec3()).collect(),
        uvs: uv.iter().flatten().map(|uv| uv.as_vec2()).collect(),
        ..Mesh::default()
    }
}

/// The scene's spheres as one cloud; with colours if wanted. How many are none under their
/// placement, but ellipsoids, is told by name.
pub(crate) fn spheres(scene: &Scene, colors: bool, uneven: &mut BTreeMap<String, usize>) -> Points {
    let mut out = Points::default();
    let bounds = scene.bounds();
    if !bounds.is_empty() {
        out.origin = origin_of([bounds.min, bounds.max]);
    }
    each_placed(&scene.objects, &scene.groups, DAffine3::IDENTITY, "", &mut |object, at, name| {
        let one;
        let points = match &object.shape {
            Shape::Points(points) => &**points,
            Shape::Sphere { center, radius } => {
                one = Points {
                    origin: *center,
                    spheres: [[0.0, 0.0, 0.0, *radius as f32]].into(),
                    ..Points::default()
                };
                &one
            }
            _ => return,
        };
        let Some(scale) = even_scale(at.matrix3) else {
            *uneven.entry(name).or_default() += points.spheres.len();
            return;
        };
        let place = at * DAffine3::from_translation(points.origin);
        let still = place == DAffine3::from_translation(out.origin);
        let origin = out.origin;
        out.spheres.extend(points.spheres.iter().map(|&[x, y, z, radius]| {
            if still {
                return [x, y, z, radius];
            }
            let p = place.transform_point3(DVec3::new(x.into(), y.into(), z.into())) - origin;
            let [x, y, z] = p.as_vec3().to_array();
            [x, y, z, (f64::from(radius) * scale) as f32]
        }));
        if colors {
            let own = scene.materials.get(object.material.0 as usize).map_or(Rgb::WHITE, own_color);
            let count = points.spheres.len() - points.colors.len().min(points.spheres.len());
            out.colors.extend(points.colors.iter().copied().chain(std::iter::repeat_n(own, count)));
        }
    });
    out
}

/// The scene's cylinders as one bundle with round ends; with colours if wanted. How many are none
/// under their placement is told by name.
pub(crate) fn cylinders(
    scene: &Scene,
    colors: bool,
    uneven: &mut BTreeMap<String, usize>,
) -> Cylinders {
    let mut out = Cylinders { caps: Caps::Round, ..Cylinders::default() };
    let bounds = scene.bounds();
    if !bounds.is_empty() {
        out.origin = origin_of([bounds.min, bounds.max]);
    }
    each_placed(&scene.objects, &scene.groups, DAffine3::IDENTITY, "", &mut |object, at, name| {
        let Shape::Cylinders(cylinders) = &object.shape else { return };
        let Some(scale) = even_scale(at.matrix3) else {
            *uneven.entry(name).or_default() += cylinders.segments.len();
            return;
        };
        let place = at * DAffine3::from_translation(cylinders.origin);
        let origin = out.origin;
        let still = place == DAffine3::from_translation(origin);
        let end = |[x, y, z, radius]: [f32; 4]| {
            if still {
                return [x, y, z, radius];
            }
            let p = place.transform_point3(DVec3::new(x.into(), y.into(), z.into())) - origin;
            let [x, y, z] = p.as_vec3().to_array();
            [x, y, z, (f64::from(radius) * scale) as f32]
        };
        out.segments.extend(cylinders.segments.iter().map(|ends| ends.map(end)));
        if colors {
            let own = scene.materials.get(object.material.0 as usize).map_or(Rgb::WHITE, own_color);
            let count = cylinders.segments.len().saturating_sub(cylinders.colors.len());
            let rest = std::iter::repeat_n([own; 2], count);
            out.colors.extend(cylinders.colors.iter().copied().chain(rest));
        }
    });
    out
}
