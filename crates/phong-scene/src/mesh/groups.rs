//! Shading normals by smoothing groups, which say themselves what is round and what is not.

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::smooth::places;
use super::{Mesh, NO_INDEX};

/// The group of faces that are flat.
pub(crate) const FLAT: u32 = 0;

impl Mesh {
    /// Gives every corner the mean of the normals of the faces of its own group that meet at the
    /// same position, weighted by area; faces of group [`FLAT`] keep the geometric normal.
    ///
    /// `groups` holds one for each triangle.
    pub(crate) fn smooth_groups(&mut self, groups: &[u32]) {
        let sound = groups.len() == self.indices.len() && self.has_sound_indices();
        if !sound || self.indices.len() > (u32::MAX / 3) as usize {
            return;
        }
        let areas = self.area_vectors();
        let places = places(&self.positions);
        let place = |i: u32| places.as_ref().map_or(i, |places| places[i as usize]);
        // Corners that get one normal stand together, in the order of the faces.
        let mut corners: Vec<(u32, u32, u32)> = self
            .indices
            .par_iter()
            .enumerate()
            .filter(|(face, _)| groups[*face] != FLAT)
            .flat_map_iter(|(face, corners)| {
                let group = groups[face];
                let number = move |k: usize| (3 * face + k) as u32;
                (0..3).map(move |k| (place(corners[k]), group, number(k)))
            })
            .collect();
        corners.par_sort_unstable();
        let mut indices = vec![[NO_INDEX; 3]; self.indices.len()];
        let mut normals: Vec<Vec3> = Vec::new();
        for alike in corners.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
            let sum = alike.iter().map(|(.., i)| areas[*i as usize / 3].as_dvec3()).sum::<DVec3>();
            let Some(normal) = sum.try_normalize() else { continue };
            for &(.., i) in alike {
                indices[i as usize / 3][i as usize % 3] = normals.len() as u32;
            }
            normals.push(normal.as_vec3());
        }
        if normals.is_empty() {
            // One that no corner uses says that the mesh is flat, and not that it has no normals.
            normals.push(Vec3::Z);
        }
        self.normals = normals.into();
        self.normal_indices = indices.into();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two faces of a roof at a right angle.
    fn roof() -> Mesh {
        Mesh {
            positions: [Vec3::Y, Vec3::Y + Vec3::Z, Vec3::X, -Vec3::X].into(),
            indices: [[0, 1, 2], [1, 0, 3]].into(),
            ..Mesh::default()
        }
    }

    #[test]
    fn one_group_is_round_whatever_its_angles_and_two_are_not() {
        let mut mesh = roof();
        mesh.smooth_groups(&[7, 7]);
        let ridge = mesh.normal_indices[0][0];
        assert_eq!(mesh.normals[ridge as usize], Vec3::Y);
        assert_eq!(mesh.normal_indices[1][1], ridge);
        let mut mesh = roof();
        mesh.smooth_groups(&[1, 2]);
        let normal = |face: usize| mesh.normals[mesh.normal_indices[face][0] as usize];
        assert!(normal(0).x > 0.7 && normal(1).x < -0.7);
    }

    #[test]
    fn faces_of_no_group_are_flat_and_stay_so() {
        let mut mesh = roof();
        mesh.smooth_groups(&[FLAT, FLAT]);
        assert_eq!(mesh.normal_indices, [[NO_INDEX; 3]; 2]);
        assert!(!mesh.normals.is_empty());
    }
}
