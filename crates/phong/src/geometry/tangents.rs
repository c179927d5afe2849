//! Tangents of meshes, along which texture coordinates grow, by the convention of `MikkTSpace`: those that the
//! programs used which baked a mesh's normal map.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use bevy_mikktspace::{Ops, TangentSpace};
use glam::{DVec3, Vec3};
use phong_bvh::{Hit, Primitives};
use phong_scene::Shared;

use super::Geometry;
use super::batch::{MeshAttributes, at_corners};

/// The tangents at the corners of each triangle: unit vectors in the mesh's own space, and 1 where texture
/// coordinates are right-handed about the normal, −1 where they are mirrored.
pub(crate) type Tangents = Vec<[[f32; 4]; 3]>;

/// The tangents of meshes that were asked for, by where their arrays lie.
#[derive(Debug, Default)]
pub(super) struct KnownTangents(Mutex<BTreeMap<[usize; 5], Arc<Tangents>>>);

impl Geometry {
    /// The tangents of a part, made when they are first asked for; `None`: it is no mesh with texture
    /// coordinates.
    pub(crate) fn tangents(&self, part: u32) -> Option<Arc<Tangents>> {
        let mesh = self.batch(part).mesh.as_deref().filter(|mesh| !mesh.uvs.is_empty())?;
        let Primitives::Triangles { positions, indices } = self.world.primitives(part) else {
            return None;
        };
        let key = [
            positions.as_ptr().addr(),
            indices.as_ptr().addr(),
            Shared::address(&mesh.uvs),
            Shared::address(&mesh.uv_indices),
            Shared::address(&mesh.normals),
        ];
        // Only finished tangents are put in, so a panic of another thread leaves nothing half made.
        let known = &self.tangents.0;
        if let Some(known) = known.lock().unwrap_or_else(PoisonError::into_inner).get(&key) {
            return Some(Arc::clone(known));
        }
        let made = Arc::new(made(positions, indices, mesh));
        let mut known = known.lock().unwrap_or_else(PoisonError::into_inner);
        Some(Arc::clone(known.entry(key).or_insert(made)))
    }

    /// The tangent at a hit of a mesh and the handedness of its texture coordinates, in the world.
    pub(crate) fn tangent(&self, hit: &Hit, tangents: &Tangents) -> Option<(DVec3, f64)> {
        let [a, b, c] = *tangents.get(hit.prim as usize)?;
        let vector = |[x, y, z, _]: [f32; 4]| DVec3::new(x.into(), y.into(), z.into());
        let (u, v) = (f64::from(hit.u), f64::from(hit.v));
        let own = (1.0 - u - v) * vector(a) + u * vector(b) + v * vector(c);
        let object = self.object(hit);
        let place = self.own_spaces.binary_search_by_key(&object, |&(object, _)| object);
        let Ok(place) = place else { return Some((own, a[3].into())) };
        let to_world = self.own_spaces[place].1.matrix3.inverse();
        // A mirror image has the other hand.
        let hand = if to_world.determinant() < 0.0 { -a[3] } else { a[3] };
        Some((to_world * own, hand.into()))
    }
}

fn made(positions: &[Vec3], indices: &[[u32; 3]], mesh: &MeshAttributes) -> Tangents {
    let none = vec![[[0.0; 4]; 3]; indices.len()];
    let units = mesh.normals.iter().map(|n| n.try_normalize().unwrap_or(Vec3::ZERO)).collect();
    let mut corners = Corners { positions, indices, mesh, units, out: none };
    // It has no way to fail.
    let _ = bevy_mikktspace::generate_tangents(&mut corners);
    corners.out
}

/// A mesh as the algorithm asks for it, corner by corner.
struct Corners<'a> {
    positions: &'a [Vec3],
    indices: &'a [[u32; 3]],
    mesh: &'a MeshAttributes,
    /// The mesh's normals, each made unit once, for each is asked for many times; 0 where it has no direction.
    units: Vec<Vec3>,
    out: Tangents,
}

/// The same bits on every machine.
struct SameEverywhere;

impl Ops for SameEverywhere {
    fn sqrt(x: f32) -> f32 {
        x.sqrt()
    }

    fn acos(x: f32) -> f32 {
        crate::math::acos(x)
    }
}

impl bevy_mikktspace::Geometry<SameEverywhere> for Corners<'_> {
    fn num_faces(&self) -> usize {
        self.indices.len()
    }

    fn num_vertices_of_face(&self, _: usize) -> usize {
        3
    }

    fn position(&self, face: usize, corner: usize) -> [f32; 3] {
        self.positions[self.indices[face][corner] as usize].to_array()
    }

    fn normal(&self, face: usize, corner: usize) -> [f32; 3] {
        let corners = self.indices[face];
        let own = at_corners(&self.units, &self.mesh.normal_indices, face as u32, corners);
        let own = own.map(|normals| normals[corner]).filter(|normal| *normal != Vec3::ZERO);
        let flat = || {
            let [a, b, c] = corners.map(|i| self.positions[i as usize]);
            (b - a).cross(c - a).normalize_or(Vec3::Z)
        };
        own.unwrap_or_else(flat).to_array()
    }

    fn tex_coord(&self, face: usize, corner: usize) -> [f32; 2] {
        let MeshAttributes { uvs, uv_indices, .. } = self.mesh;
        let own = at_corners(uvs, uv_indices, face as u32, self.indices[face]);
        own.map_or([0.0; 2], |uvs| uvs[corner].to_array())
    }

    fn set_tangent(&mut self, tangent: Option<TangentSpace>, face: usize, corner: usize) {
        self.out[face][corner] = tangent.map_or([0.0; 4], |tangent| tangent.tangent_encoded());
    }
}
