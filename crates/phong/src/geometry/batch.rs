//! What belongs to the primitives of a tree's batch besides their shape.

use glam::{DMat3, DVec3, Mat3, Vec2, Vec3};
use phong_bvh::Hit;
use phong_scene::{NO_INDEX, Rgb, Shared};

use crate::math::Dir3;

/// What belongs to the primitives of one batch.
#[derive(Debug)]
pub(crate) struct Batch {
    pub(super) objects: Objects,
    pub(super) materials: MaterialNumbers,
    pub(super) mesh: Option<Box<MeshAttributes>>,
    /// A colour a sphere; empty: the material's.
    pub(super) colors: Shared<Rgb>,
    /// Two colours a cylinder, of the half at either end; empty: the material's.
    pub(super) end_colors: Shared<[Rgb; 2]>,
    /// From the mesh to the world; `None`: they are the same.
    pub(super) to_world: Option<Box<ToWorld>>,
    /// The spheres that are turned, in order of their number, and the rotation of each.
    pub(super) rotations: Vec<(u32, DMat3)>,
    /// The middle of what has a tree of its own because it is far away, about which its numbers are.
    pub(super) apart: Option<DVec3>,
    /// Of a triangle among solids its number in the mesh, and its corners.
    pub(super) face: Option<(u32, [u32; 3])>,
}

/// What turns vectors of a mesh with normals into those of the world.
#[derive(Debug)]
pub(super) struct ToWorld {
    /// Normals, up to their length.
    pub(super) normals: Mat3,
    /// Edges.
    pub(super) edges: Mat3,
}

/// The objects that a batch's primitives belong to.
#[derive(Clone, Copy, Debug)]
pub(super) enum Objects {
    /// All to one: a mesh, a cloud of points.
    One(u32),
    /// The first primitive to this one, and each further one to the next.
    OneEach(u32),
}

/// The materials of a batch's primitives.
#[derive(Debug)]
pub(super) enum MaterialNumbers {
    One(u32),
    OneEach(Shared<u32>),
}

/// What a mesh has besides its triangles.
#[derive(Debug, Default)]
pub(super) struct MeshAttributes {
    pub(super) normals: Shared<Vec3>,
    pub(super) normal_indices: Shared<[u32; 3]>,
    pub(super) uvs: Shared<Vec2>,
    pub(super) uv_indices: Shared<[u32; 3]>,
    pub(super) colors: Shared<Rgb>,
}

impl Batch {
    /// A batch of one material, with no colours or mesh attributes of its own.
    pub(super) fn new(objects: Objects, material: u32) -> Self {
        Self {
            objects,
            materials: MaterialNumbers::One(material),
            mesh: None,
            colors: Shared::default(),
            end_colors: Shared::default(),
            to_world: None,
            rotations: Vec::new(),
            apart: None,
            face: None,
        }
    }

    /// The number of the object that a primitive belongs to.
    #[inline]
    pub(crate) fn object(&self, local: u32) -> u32 {
        match self.objects {
            Objects::One(object) => object,
            Objects::OneEach(first) => first + local,
        }
    }

    /// Whether its primitives are one object together.
    pub(crate) fn is_bulk(&self) -> bool {
        matches!(self.objects, Objects::One(_))
    }

    /// The highest number of a material; `None` if it has no primitives.
    pub(super) fn highest_material(&self) -> Option<u32> {
        match &self.materials {
            MaterialNumbers::One(material) => Some(*material),
            MaterialNumbers::OneEach(materials) => materials.iter().copied().max(),
        }
    }

    /// The materials of its primitives, some perhaps named more than once.
    pub(crate) fn materials_used(&self) -> impl Iterator<Item = u32> {
        let (one, each) = match &self.materials {
            MaterialNumbers::One(material) => (Some(*material), &[][..]),
            MaterialNumbers::OneEach(materials) => (None, &materials[..]),
        };
        one.into_iter().chain(each.iter().copied())
    }

    /// How a sphere is turned; `None`: it is not, or it is no sphere.
    pub(super) fn rotation(&self, local: u32) -> Option<DMat3> {
        let place = self.rotations.binary_search_by_key(&local, |(number, _)| *number).ok()?;
        Some(self.rotations[place].1)
    }

    /// The number of a primitive's material.
    #[inline]
    pub(crate) fn material(&self, local: u32) -> u32 {
        match &self.materials {
            MaterialNumbers::One(material) => *material,
            MaterialNumbers::OneEach(materials) => materials[local as usize],
        }
    }

    /// The material, where all primitives have the same.
    #[inline]
    pub(crate) fn only_material(&self) -> Option<u32> {
        match self.materials {
            MaterialNumbers::One(material) => Some(material),
            MaterialNumbers::OneEach(_) => None,
        }
    }

    /// Whether its surfaces have only what the shape and the material give them.
    #[inline]
    pub(crate) fn is_plain(&self) -> bool {
        let bare = |mesh: &MeshAttributes| mesh.normals.is_empty() && mesh.colors.is_empty();
        let colors = self.colors.is_empty() && self.end_colors.is_empty();
        colors && self.mesh.as_ref().is_none_or(|mesh| bare(mesh))
    }

    /// Whether it has what triangles of a mesh may have.
    #[inline]
    pub(crate) fn is_mesh(&self) -> bool {
        self.mesh.is_some()
    }

    /// The interpolated shading normal; `None` where the mesh has none. Normals of any length count as
    /// unit ones: those that are so, to rounding, are taken as they are.
    #[inline]
    pub(crate) fn normal(&self, local: u32, corners: [u32; 3], hit: &Hit) -> Option<Dir3> {
        let mesh = self.mesh.as_ref()?;
        let [a, b, c] = at_corners(&mesh.normals, &mesh.normal_indices, local, corners)?;
        let [a, b, c] = [unit(a), unit(b), unit(c)];
        let n = (1.0 - hit.u - hit.v) * a + hit.u * b + hit.v * c;
        Dir3::new(self.to_world.as_ref().map_or(n, |to_world| to_world.normals * n))
    }

    /// The way from a point of a triangle to the curved surface that its normals stand for, in the world:
    /// each corner's tangent plane lifts what lies below it onto itself, and the point takes the mean by
    /// its weights. 0 where the mesh has no normals, or is not convex there. (Hanika, *Hacking the shadow
    /// terminator*, Ray Tracing Gems II, 2021.)
    ///
    /// `front` is the geometric normal on the side that is lit, and the normals are those of the other
    /// side where they are `flipped`; a corner whose normal disagrees lifts nothing.
    pub(super) fn lift(
        &self,
        local: u32,
        corners: [u32; 3],
        [a, b, c]: [Vec3; 3],
        hit: &Hit,
        (front, flipped): (Vec3, bool),
    ) -> Vec3 {
        let Some(mesh) = self.mesh.as_ref() else { return Vec3::ZERO };
        let normals = at_corners(&mesh.normals, &mesh.normal_indices, local, corners);
        let Some(normals) = normals else { return Vec3::ZERO };
        let (mut ab, mut ac, mut normals) = (b - a, c - a, normals.map(unit));
        if let Some(ToWorld { normals: turn, edges }) = self.to_world.as_deref() {
            (ab, ac) = (*edges * ab, *edges * ac);
            normals = normals.map(|n| unit(*turn * n));
        }
        let from_a = hit.u * ab + hit.v * ac;
        let from = [from_a, from_a - ab, from_a - ac];
        let weights = [1.0 - hit.u - hit.v, hit.u, hit.v];
        let mut lift = Vec3::ZERO;
        for ((n, from), weight) in normals.into_iter().zip(from).zip(weights) {
            let n = if flipped { -n } else { n };
            let below = from.dot(n).min(0.0);
            if n.dot(front) > 0.0 {
                lift -= weight * below * n;
            }
        }
        // Beyond the range of f32 there is nothing to lift.
        if lift.is_finite() { lift } else { Vec3::ZERO }
    }

    /// The interpolated texture coordinates; `None` where the mesh has none.
    pub(crate) fn uv(&self, local: u32, corners: [u32; 3], hit: &Hit) -> Option<Vec2> {
        let mesh = self.mesh.as_ref()?;
        let [a, b, c] = at_corners(&mesh.uvs, &mesh.uv_indices, local, corners)?;
        Some((1.0 - hit.u - hit.v) * a + hit.u * b + hit.v * c)
    }

    /// The geometry's own colour; `None` where it is the material's.
    #[inline]
    pub(crate) fn color(&self, local: u32, corners: Option<[u32; 3]>, hit: &Hit) -> Option<Rgb> {
        if let (Some(mesh), Some(corners)) = (&self.mesh, corners) {
            let [a, b, c] = at_corners(&mesh.colors, &[], local, corners)?;
            return Some((1.0 - hit.u - hit.v) * a + hit.u * b + hit.v * c);
        }
        if let Some(ends) = self.end_colors.get(local as usize) {
            return Some(ends[usize::from(hit.u > 0.5)]);
        }
        self.colors.get(local as usize).copied()
    }
}

/// The unit vector along `n`, which stays as it is where it is one to 5e-6; 0 where it has no direction.
#[inline]
fn unit(n: Vec3) -> Vec3 {
    if (n.dot(n) - 1.0).abs() < 1e-5 { n } else { Dir3::new(n).map_or(Vec3::ZERO, Dir3::to_vec) }
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
