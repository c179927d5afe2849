//! Some of a mesh's triangles as a mesh of their own.

use std::sync::Arc;

use super::{Field, Mesh, NO_INDEX};

impl Mesh {
    /// The triangles for whose number `keep` says so, with what belongs to them and no more.
    pub(crate) fn part(&self, keep: impl Fn(usize) -> bool) -> Self {
        let faces: Vec<usize> = (0..self.indices.len()).filter(|&face| keep(face)).collect();
        let chosen = |all: &[[u32; 3]]| -> Vec<[u32; 3]> {
            faces.iter().filter_map(|&face| all.get(face).copied()).collect()
        };
        let mut indices = chosen(&self.indices);
        // What is numbered like the positions must go on to be.
        let shared = |count: usize, own: &[[u32; 3]]| count > 0 && own.is_empty();
        let (like_positions_n, like_positions_t) = (
            shared(self.normals.len(), &self.normal_indices),
            shared(self.uvs.len(), &self.uv_indices),
        );
        let used = renumber(self.positions.len(), &mut indices);
        let mut normal_indices = chosen(&self.normal_indices);
        let mut uv_indices = chosen(&self.uv_indices);
        let normals = if like_positions_n {
            pick(&self.normals, &used)
        } else {
            pick(&self.normals, &renumber(self.normals.len(), &mut normal_indices))
        };
        let uvs = if like_positions_t {
            pick(&self.uvs, &used)
        } else {
            pick(&self.uvs, &renumber(self.uvs.len(), &mut uv_indices))
        };
        let face_materials =
            faces.iter().filter_map(|&face| self.face_materials.get(face).copied()).collect();
        Self {
            origin: self.origin,
            positions: pick(&self.positions, &used).into(),
            indices: indices.into(),
            normals: normals.into(),
            normal_indices: normal_indices.into(),
            uvs: uvs.into(),
            uv_indices: uv_indices.into(),
            colors: pick(&self.colors, &used).into(),
            face_materials,
            fields: self
                .fields
                .iter()
                .map(|Field { name, values }| Field {
                    name: Arc::clone(name),
                    values: pick(values, &used).into(),
                })
                .collect(),
        }
    }
}

/// Numbers what is used anew, in the order it had; the old numbers in the new order.
fn renumber(count: usize, corners: &mut [[u32; 3]]) -> Vec<u32> {
    let mut numbers = vec![NO_INDEX; count];
    for &index in corners.iter().flatten() {
        if let Some(number) = numbers.get_mut(index as usize) {
            *number = 0;
        }
    }
    let mut used = Vec::new();
    for (old, number) in numbers.iter_mut().enumerate() {
        if *number == 0 {
            *number = used.len() as u32;
            used.push(old as u32);
        }
    }
    for index in corners.iter_mut().flatten() {
        *index = numbers.get(*index as usize).copied().unwrap_or(NO_INDEX);
    }
    used
}

fn pick<T: Copy>(all: &[T], used: &[u32]) -> Vec<T> {
    used.iter().filter_map(|&i| all.get(i as usize).copied()).collect()
}

#[cfg(test)]
mod tests {
    use glam::{Vec2, Vec3};

    use super::*;
    use crate::color::Rgb;

    #[test]
    fn a_part_keeps_its_corners_and_nothing_else() {
        let mesh = Mesh {
            positions: (0..6).map(|i| Vec3::splat(i as f32)).collect(),
            indices: [[0, 1, 2], [5, 4, 3]].into(),
            normals: [Vec3::X, Vec3::Y].into(),
            normal_indices: [[0, 0, 0], [1, NO_INDEX, 1]].into(),
            uvs: (0..6).map(|i| Vec2::splat(i as f32)).collect(),
            colors: (0..6).map(|i| Rgb::grey(i as f32)).collect(),
            face_materials: [7, 8].into(),
            ..Mesh::default()
        };
        let part = mesh.part(|face| face == 1);
        assert_eq!(part.positions, [3.0, 4.0, 5.0].map(Vec3::splat));
        assert_eq!(part.indices, [[2, 1, 0]]);
        assert_eq!(part.normals, [Vec3::Y]);
        assert_eq!(part.normal_indices, [[0, NO_INDEX, 0]]);
        assert_eq!(part.uvs, [3.0, 4.0, 5.0].map(Vec2::splat));
        assert!(part.uv_indices.is_empty());
        assert_eq!(part.colors, [3.0, 4.0, 5.0].map(Rgb::grey));
        assert_eq!(part.face_materials, [8]);
    }
}
