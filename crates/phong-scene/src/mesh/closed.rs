//! Whether a mesh encloses anything.

use super::{Hash, Mesh, Weld};

impl Mesh {
    /// Whether it encloses what is inside: every edge of a face is, the other way round, that of another.
    /// Corners at one place are one, whatever their numbers are.
    pub fn is_closed(&self) -> bool {
        let mut weld = Weld::with_room(self.positions.len(), Hash::new());
        let place: Vec<u32> = self.positions.iter().map(|p| weld.number(*p)).collect();
        // Each edge from its lower corner, and whether the face has it that way round.
        let mut edges: Vec<(u64, bool)> = Vec::with_capacity(3 * self.indices.len());
        for &face in &*self.indices {
            let [a, b, c] = face.map(|corner| place[corner as usize]);
            for (from, to) in [(a, b), (b, c), (c, a)] {
                if from != to {
                    let (low, high) = (from.min(to), from.max(to));
                    edges.push((u64::from(low) << 32 | u64::from(high), from == low));
                }
            }
        }
        edges.sort_unstable();
        let evens_out = |same: &[(u64, bool)]| {
            2 * same.iter().filter(|(_, upwards)| *upwards).count() == same.len()
        };
        !edges.is_empty() && edges.chunk_by(|a, b| a.0 == b.0).all(evens_out)
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    #[test]
    fn a_tetrahedron_is_closed_and_without_a_face_it_is_open() {
        let positions = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
        let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let mesh = |faces: &[[u32; 3]]| Mesh {
            positions: positions.into(),
            indices: faces.to_vec().into(),
            ..Mesh::default()
        };
        assert!(mesh(&faces).is_closed());
        assert!(!mesh(&faces[1..]).is_closed());
        // A face that is turned inside out.
        assert!(!mesh(&[[0, 1, 2], faces[1], faces[2], faces[3]]).is_closed());
        // Corners of its own for every face, as in STL files.
        let corners: Vec<Vec3> = faces.iter().flatten().map(|&i| positions[i as usize]).collect();
        let indices: Vec<[u32; 3]> = (0..4).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]).collect();
        let apart = Mesh { positions: corners.into(), indices: indices.into(), ..Mesh::default() };
        assert!(apart.is_closed());
    }
}
