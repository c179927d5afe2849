//! Tangents of meshes, along which texture coordinates grow, by the convention of `MikkTSpace`: those that the
//! programs used which baked a mesh's normal map, in the very bits.
//!
//! `MikkTSpace` is by Morten S. Mikkelsen, copyright 2011, under the zlib licence. What is in this folder was written
//! anew after it, and after its translation `bevy_mikktspace`, to the same results in a fifth of the time: it is not
//! the original. Corners are welded (`weld`), triangles joined over their edges (`edges`), the corners about a point
//! put into groups (`groups`), and what the triangles of a group say of its tangent is summed up (`slopes`, `sums`).

mod edges;
mod groups;
mod slopes;
mod sums;
mod weld;

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use glam::{DVec3, Vec2, Vec3};
use phong_bvh::{Hit, Level, Primitives};
use phong_scene::Shared;

use super::Geometry;
use super::batch::{MeshAttributes, at_corners};
use edges::{NONE, beside};
use groups::Groups;
use slopes::Slopes;
use sums::Sums;
use weld::{Welded, weld};

/// The tangents at the corners of each triangle.
#[derive(Debug)]
pub(crate) struct Tangents {
    /// Where each corner has its own in `each`, or [`NONE`].
    of: Vec<[u32; 3]>,
    /// Unit vectors in the mesh's own space, and 1 where texture coordinates are right-handed about the normal, −1
    /// where they are mirrored.
    each: Vec<[f32; 4]>,
}

impl Tangents {
    /// Those at a triangle's corners: 0 where a corner has none, `None` where there is no such triangle.
    #[inline]
    pub(crate) fn get(&self, triangle: usize) -> Option<[[f32; 4]; 3]> {
        let [a, b, c] = *self.of.get(triangle)?;
        let of = |place: u32| self.each.get(place as usize).copied().unwrap_or_default();
        Some([of(a), of(b), of(c)])
    }
}

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
        let [a, b, c] = tangents.get(hit.prim as usize)?;
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

/// The tangents of a mesh; all 0 where there are more triangles than their corners can be numbered.
fn made(positions: &[Vec3], indices: &[[u32; 3]], mesh: &MeshAttributes) -> Tangents {
    if indices.len() > u32::MAX as usize / 3 {
        return Tangents { of: vec![[NONE; 3]; indices.len()], each: Vec::new() };
    }
    let units = mesh.normals.iter().map(|n| n.try_normalize().unwrap_or(Vec3::ZERO)).collect();
    let corners = Corners { positions, indices, mesh, units };
    let is_flat = |face: &u32| {
        let [a, b, c] = corners.positions_of(*face as usize);
        a == b || b == c || c == a
    };
    let all = 0..indices.len() as u32;
    let (mut order, flat): (Vec<u32>, Vec<u32>) = all.partition(|face| !is_flat(face));
    let count = order.len();
    order.extend(flat);
    let welded = weld(&corners, &order);
    let (faces, flat) = order.split_at(count);
    let mut hands = Vec::with_capacity(faces.len());
    let level = Level::detect();
    let slopes = level.run(Slopes { mesh: &corners, faces, hands: &mut hands });
    let beside = beside(&welded, faces);
    let mut groups = Groups::new(&beside, &mut hands);
    drop(beside);
    let sums = Sums {
        mesh: &corners,
        welded: &welded,
        faces,
        slopes: &slopes,
        hands: &hands,
        groups: &mut groups,
    };
    let each = level.run(sums);
    if flat.is_empty() {
        return Tangents { of: groups.of, each };
    }
    let mut of = vec![[NONE; 3]; indices.len()];
    for (&face, groups) in faces.iter().zip(&groups.of) {
        of[face as usize] = *groups;
    }
    take_over(&welded, faces, flat, &mut of);
    Tangents { of, each }
}

/// Gives triangles without an area the tangents of the first corners that are one with theirs.
fn take_over(welded: &Welded, faces: &[u32], flat: &[u32], of: &mut [[u32; 3]]) {
    let mut first = vec![NONE; welded.first.len()];
    for &face in faces.iter().rev() {
        for (i, number) in welded.numbers[face as usize].into_iter().enumerate().rev() {
            first[number as usize] = of[face as usize][i];
        }
    }
    for &face in flat {
        of[face as usize] = welded.numbers[face as usize].map(|number| first[number as usize]);
    }
}

/// A mesh, corner by corner.
struct Corners<'a> {
    positions: &'a [Vec3],
    indices: &'a [[u32; 3]],
    mesh: &'a MeshAttributes,
    /// The mesh's normals, each made unit once, for each is asked for many times; 0 where it has no direction.
    units: Vec<Vec3>,
}

impl Corners<'_> {
    /// The vertex at a corner: three times its triangle, and which of the three it is.
    #[inline]
    fn vertex(&self, corner: u32) -> u32 {
        self.indices.as_flattened()[corner as usize]
    }

    /// The positions of a triangle's corners.
    #[inline]
    fn positions_of(&self, face: usize) -> [[f32; 3]; 3] {
        let [a, b, c] = self.indices[face];
        [self.position(a), self.position(b), self.position(c)]
    }

    /// The position of a vertex.
    #[inline]
    fn position(&self, vertex: u32) -> [f32; 3] {
        self.positions[vertex as usize].to_array()
    }

    /// The texture coordinates of a triangle's corners.
    #[inline]
    fn uvs_of(&self, face: usize) -> [Vec2; 3] {
        let MeshAttributes { uvs, uv_indices, .. } = self.mesh;
        at_corners(uvs, uv_indices, face as u32, self.indices[face]).unwrap_or_default()
    }

    /// The normal and the texture coordinates at a corner.
    fn attributes(&self, corner: u32) -> (Vec3, Vec2) {
        let (face, i) = (corner / 3, corner as usize % 3);
        let corners = self.indices[face as usize];
        let own = at_corners(&self.units, &self.mesh.normal_indices, face, corners);
        let own = own.map(|normals| normals[i]).filter(|normal| *normal != Vec3::ZERO);
        let flat = || {
            let [a, b, c] = corners.map(|i| self.positions[i as usize]);
            (b - a).cross(c - a).normalize_or(Vec3::Z)
        };
        (own.unwrap_or_else(flat), self.uvs_of(face as usize)[i])
    }

    /// Whether all corners at a vertex are equal, whatever their triangles.
    fn is_one(&self, vertex: u32) -> bool {
        let MeshAttributes { normal_indices, uvs, uv_indices, .. } = self.mesh;
        let normal = self.units.get(vertex as usize);
        normal_indices.is_empty()
            && uv_indices.is_empty()
            && normal.is_some_and(|&normal| normal != Vec3::ZERO)
            && uvs.get(vertex as usize).is_some_and(|uv| !uv.is_nan())
    }
}

#[cfg(test)]
mod tests;
