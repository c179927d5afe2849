//! What files hold and a [`Mesh`] must not: normals without a direction, triangles without area.

#![expect(clippy::needless_bitwise_bool, reason = "a branch for each number would cost more")]

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::{Field, Mesh, NO_INDEX, PIECE, Points};

impl Mesh {
    /// Takes the normals of length 0 away, whose corners get the geometric normal, and brings
    /// those to unit length whose squares f32 cannot hold; how many had no direction.
    pub(crate) fn mend_normals(&mut self) -> u64 {
        let mend = |n: &mut Vec3| {
            if n.length_squared().is_normal() {
                return 0;
            }
            let unit = n.as_dvec3().try_normalize();
            *n = unit.map_or(Vec3::ZERO, DVec3::as_vec3);
            u64::from(unit.is_none())
        };
        let mend_all = |piece: &mut [Vec3]| {
            let sound = piece.iter().fold(true, |all, n| all & n.length_squared().is_normal());
            if sound { 0 } else { piece.iter_mut().map(mend).sum::<u64>() }
        };
        let zeros = self.normals.par_chunks_mut(PIECE).map(mend_all).sum();
        if zeros > 0 {
            if self.normal_indices.is_empty() {
                self.normal_indices.clone_from(&self.indices);
            }
            let normals = &self.normals;
            self.normal_indices.par_iter_mut().with_min_len(PIECE).for_each(|corners| {
                for index in corners {
                    if normals.get(*index as usize).is_some_and(|n| *n == Vec3::ZERO) {
                        *index = NO_INDEX;
                    }
                }
            });
        }
        zeros
    }

    /// Takes the triangles away that use a vertex twice, and with them nothing that can be seen;
    /// how many there were.
    pub(crate) fn drop_collapsed(&mut self) -> u64 {
        let collapsed = |&[a, b, c]: &[u32; 3]| (a == b) | (b == c) | (c == a);
        let count = |piece: &[[u32; 3]]| piece.iter().map(|t| u64::from(collapsed(t))).sum::<u64>();
        let count: u64 = self.indices.par_chunks(PIECE).map(count).sum();
        if count == 0 {
            return 0;
        }
        let keep: Vec<bool> = self.indices.par_iter().map(|t| !collapsed(t)).collect();
        retain(&mut self.indices, &keep);
        retain(&mut self.normal_indices, &keep);
        retain(&mut self.uv_indices, &keep);
        retain(&mut self.face_materials, &keep);
        count
    }

    /// Whether there are triangles, and none of them has an area: then nothing of it can be seen.
    pub(crate) fn is_flat(&self) -> bool {
        // Corners are rounded to 24 bits: a smaller sine than this is no angle.
        let least = f64::from(f32::EPSILON) * 2.0;
        let corner = |i: u32| self.positions.get(i as usize).map_or(DVec3::ZERO, |p| p.as_dvec3());
        let on_a_line = |t: &[u32; 3]| {
            let [a, b, c] = t.map(corner);
            let (ab, ac) = (b - a, c - a);
            ab.cross(ac).length() <= least * ab.length() * ac.length()
        };
        let indices = self.indices.par_iter().with_min_len(PIECE);
        !self.indices.is_empty() && indices.all(on_a_line)
    }

    /// Bytes that the arrays take in memory.
    pub fn bytes(&self) -> u64 {
        let triples = self.indices.len() + self.normal_indices.len() + self.uv_indices.len();
        let vectors = self.positions.len() + self.normals.len() + self.colors.len();
        (12 * (triples + vectors) + 8 * self.uvs.len() + 4 * self.face_materials.len()) as u64
            + Field::bytes(&self.fields)
    }
}

impl Mesh {
    /// Which positions are no numbers; they become 0, for something to leave out.
    pub(crate) fn take_unplaced(&mut self) -> Option<Vec<bool>> {
        let placed = |piece: &[Vec3]| piece.iter().fold(true, |all, p| all & p.is_finite());
        let all = self.positions.par_chunks(PIECE).all(placed);
        if all {
            return None;
        }
        let unplaced = self.positions.iter().map(|p| !p.is_finite()).collect();
        self.positions.iter_mut().filter(|p| !p.is_finite()).for_each(|p| *p = Vec3::ZERO);
        Some(unplaced)
    }

    /// Whether every index is one of something, and the arrays are as long as they must be.
    pub(crate) fn has_sound_indices(&self) -> bool {
        let (vertices, triangles) = (self.positions.len(), self.indices.len());
        let all = |indices: &[[u32; 3]], count: usize, optional: bool| {
            let held = |&i: &u32| (i as usize) < count || optional && i == NO_INDEX;
            indices.par_iter().with_min_len(PIECE).all(|corners| corners.iter().all(held))
        };
        let kind = |indices: &[[u32; 3]], count: usize| match indices.len() {
            0 => count == 0 || count >= vertices,
            length => length == triangles && all(indices, count, true),
        };
        all(&self.indices, vertices, false)
            && kind(&self.normal_indices, self.normals.len())
            && kind(&self.uv_indices, self.uvs.len())
            && (self.face_materials.is_empty() || self.face_materials.len() == triangles)
    }
}

impl Points {
    /// Bytes that the arrays take in memory.
    pub fn bytes(&self) -> u64 {
        (16 * self.spheres.len() + 12 * self.colors.len()) as u64 + Field::bytes(&self.fields)
    }
}

/// Makes nothing of the faces of which a corner is `bad`: [`Mesh::drop_collapsed`] takes them away
/// with those that collapsed by themselves. `polygons` are the first triangle and the number of
/// corners of every face of more than three. How many faces, and how many triangles of them.
pub(crate) fn collapse_faces(
    indices: &mut [[u32; 3]],
    polygons: &mut Vec<[u32; 2]>,
    bad: impl Fn(u32) -> bool + Sync,
) -> [u64; 2] {
    let is_bad = |triangle: &[u32; 3]| triangle.iter().any(|&corner| bad(corner));
    if !indices.par_iter().with_min_len(PIECE).any(is_bad) {
        return [0; 2];
    }
    let (mut faces, mut triangles) = (0, 0);
    polygons.retain(|&[start, corners]| {
        let end = start.saturating_add(corners.saturating_sub(2)) as usize;
        let Some(fan) = indices.get_mut(start as usize..end) else { return true };
        let sound = !fan.iter().any(is_bad);
        if !sound {
            faces += 1;
            triangles += fan.len() as u64;
            fan.fill([0; 3]);
        }
        sound
    });
    for triangle in indices.iter_mut().filter(|t| **t != [0; 3] && is_bad(t)) {
        faces += 1;
        triangles += 1;
        *triangle = [0; 3];
    }
    [faces, triangles]
}

/// Keeps what is to be kept, if there is anything.
fn retain<T>(values: &mut Vec<T>, keep: &[bool]) {
    let mut keep = keep.iter();
    values.retain(|_| *keep.next().unwrap_or(&true));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normals_without_a_direction_leave_the_geometric_one() {
        let mut mesh = Mesh {
            positions: [Vec3::ZERO, Vec3::X, Vec3::Y].into(),
            indices: [[0, 1, 2]].into(),
            normals: [Vec3::ZERO, Vec3::Z * 1e-30, Vec3::Z * 1e30].into(),
            ..Mesh::default()
        };
        assert_eq!(mesh.mend_normals(), 1);
        assert_eq!(mesh.normal_indices, [[NO_INDEX, 1, 2]]);
        assert_eq!(mesh.normals[1..], [Vec3::Z, Vec3::Z]);
    }

    #[test]
    fn a_mesh_is_flat_if_all_corners_of_every_triangle_lie_on_a_line() {
        let mut mesh = Mesh {
            positions: [0.0, 0.1, 0.3, 0.1].map(|x| Vec3::new(1.0, 2.0, 3.3) * x).into(),
            indices: [[0, 1, 2], [0, 1, 3]].into(),
            ..Mesh::default()
        };
        assert!(mesh.is_flat());
        mesh.positions.push(Vec3::Y);
        mesh.indices.push([0, 1, 4]);
        assert!(!mesh.is_flat());
        assert!(!Mesh::default().is_flat());
    }

    #[test]
    fn collapsed_triangles_go_with_all_that_belongs_to_them() {
        let mut mesh = Mesh {
            positions: [Vec3::ZERO, Vec3::X, Vec3::Y].into(),
            indices: [[0, 1, 1], [0, 1, 2], [2, 1, 2]].into(),
            uv_indices: [[7; 3], [8; 3], [9; 3]].into(),
            face_materials: [1, 2, 3].into(),
            ..Mesh::default()
        };
        assert_eq!(mesh.drop_collapsed(), 2);
        assert_eq!(mesh.indices, [[0, 1, 2]]);
        assert_eq!((mesh.uv_indices[0], mesh.face_materials[0]), ([8; 3], 2));
        assert_eq!(mesh.bytes(), 36 + 12 + 12 + 4);
    }
}
