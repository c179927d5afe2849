//! What belongs to the primitives of a tree's batch besides their shape.

use glam::{DMat3, DVec2, DVec3, Vec2, Vec3};
use phong_bvh::Hit;
use phong_scene::{Field, NO_INDEX, Rgb, Shared};

use super::smooth::{SmoothMesh, ToWorld};
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
    /// Numbers that the points have: of a mesh at its corners, of spheres one each, of cylinders two.
    pub(super) fields: Vec<Field>,
    /// Whether these are of the ends of cylinders.
    pub(super) is_ends: bool,
}

/// The properties of a batch's points that maps show, in their order; `None`: it does not have that one.
pub(crate) type Properties = [Option<Shared<f32>>; Field::MOST];

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
            fields: Vec::new(),
            is_ends: false,
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

    /// Whether the geometry brings no colours.
    #[inline]
    pub(crate) fn has_no_colors(&self) -> bool {
        let bare = self.mesh.as_ref().is_none_or(|mesh| mesh.colors.is_empty());
        bare && self.colors.is_empty() && self.end_colors.is_empty()
    }

    /// Whether it has what triangles of a mesh may have.
    #[inline]
    pub(crate) fn is_mesh(&self) -> bool {
        self.mesh.is_some()
    }

    /// Its smooth normals, if it has some.
    #[inline]
    pub(crate) fn smooth(&self) -> Option<SmoothMesh<'_>> {
        let mesh = self.mesh.as_ref().filter(|mesh| !mesh.normals.is_empty())?;
        let (normals, normal_indices) = (&mesh.normals, &mesh.normal_indices);
        Some(SmoothMesh { normals, normal_indices, to_world: self.to_world.as_deref() })
    }

    /// The interpolated shading normal; `None` where the mesh has none. Normals of any length count as
    /// unit ones: those that are so, to rounding, are taken as they are.
    #[inline]
    pub(crate) fn normal(&self, local: u32, corners: [u32; 3], hit: &Hit) -> Option<Dir3> {
        let n = self.smooth()?.normal(self.normals(local, corners)?, [hit.u, hit.v])?;
        Some(Dir3::from_unit(n.into()))
    }

    /// The normals at the corners of a triangle, of any length, in the mesh's own space; `None` where it has none.
    #[inline]
    pub(crate) fn normals(&self, local: u32, corners: [u32; 3]) -> Option<[Vec3; 3]> {
        let SmoothMesh { normals, normal_indices, .. } = self.smooth()?;
        at_corners(normals, normal_indices, local, corners)
    }

    /// The interpolated texture coordinates; `None` where the mesh has none.
    pub(crate) fn uv(&self, local: u32, corners: [u32; 3], hit: &Hit) -> Option<Vec2> {
        let [a, b, c] = self.uvs(local, corners)?;
        Some((1.0 - hit.u - hit.v) * a + hit.u * b + hit.v * c)
    }

    /// The texture coordinates at the corners of a triangle; `None` where the mesh has none.
    #[inline]
    pub(crate) fn uvs(&self, local: u32, corners: [u32; 3]) -> Option<[Vec2; 3]> {
        let mesh = self.mesh.as_ref()?;
        at_corners(&mesh.uvs, &mesh.uv_indices, local, corners)
    }

    /// How texture coordinates change from the first corner to the second, and to the third; `None` where the
    /// mesh has none.
    pub(crate) fn uv_edges(&self, local: u32, corners: [u32; 3]) -> Option<[DVec2; 2]> {
        let [a, b, c] =
            self.uvs(local, corners)?.map(|Vec2 { x, y }| DVec2::new(x.into(), y.into()));
        Some([b - a, c - a])
    }

    /// Those of its fields that have these names.
    pub(crate) fn properties(&self, names: &[String]) -> Properties {
        std::array::from_fn(|i| {
            let name = names.get(i)?;
            let field = self.fields.iter().find(|field| *field.name == **name)?;
            Some(field.values.clone())
        })
    }

    /// What they are at a hit: between points linear; NaN where it has none.
    pub(crate) fn properties_at(
        &self,
        properties: &Properties,
        corners: Option<[u32; 3]>,
        hit: &Hit,
    ) -> [f32; Field::MOST] {
        let at = |values: &Option<Shared<f32>>| -> Option<f32> {
            let values = values.as_ref()?;
            if self.mesh.is_some() {
                let [a, b, c] = corners?.map(|corner| values.get(corner as usize).copied());
                return Some((1.0 - hit.u - hit.v) * a? + hit.u * b? + hit.v * c?);
            }
            let first = hit.prim as usize;
            if self.is_ends {
                let [a, b] = [0, 1].map(|end| values.get(2 * first + end).copied());
                return Some((1.0 - hit.u) * a? + hit.u * b?);
            }
            values.get(first).copied()
        };
        properties.each_ref().map(|values| at(values).unwrap_or(f32::NAN))
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

/// The values at a triangle's corners; `None` where there are none.
#[inline]
pub(super) fn at_corners<T: Copy>(
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
