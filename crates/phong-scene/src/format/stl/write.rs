//! Meshes as binary STL.

use std::io::{self, BufWriter, Write};

use super::HEAD;
use crate::mesh::Mesh;

/// What stands at the beginning; it must not be `solid`, which text begins with.
const TITLE: &[u8] = b"binary STL";

impl Mesh {
    /// Writes the mesh as binary STL: a facet a triangle, with its geometric normal (0 where it has no
    /// area). Positions are rounded to f32 where the mesh has an origin; normals of corners, texture
    /// coordinates, colours and materials are not written: STL has none.
    ///
    /// # Errors
    /// Whatever `to` says; [`InvalidInput`](io::ErrorKind::InvalidInput) where an index is out of range.
    ///
    /// ```
    /// use glam::Vec3;
    /// use phong_scene::Mesh;
    /// let positions = [Vec3::ZERO, Vec3::X, Vec3::Y].into();
    /// let triangle = Mesh { positions, indices: [[0, 1, 2]].into(), ..Mesh::default() };
    /// let mut file = Vec::new();
    /// triangle.write_stl(&mut file)?;
    /// assert_eq!(file.len(), 84 + 50);
    /// # Ok::<(), std::io::Error>(())
    /// ```
    pub fn write_stl(&self, to: &mut dyn Write) -> io::Result<()> {
        let count = u32::try_from(self.indices.len()).ok().filter(|_| self.has_sound_indices());
        let Some(count) = count else {
            let message = "an index of the mesh is out of range, or there are too many triangles";
            return Err(io::Error::new(io::ErrorKind::InvalidInput, message));
        };
        let to = &mut BufWriter::with_capacity(1 << 16, to);
        let mut head = [b' '; HEAD as usize];
        head[..TITLE.len()].copy_from_slice(TITLE);
        head[HEAD as usize - 4..].copy_from_slice(&count.to_le_bytes());
        to.write_all(&head)?;
        for triangle in &self.indices {
            let corners = triangle.map(|i| self.origin + self.positions[i as usize].as_dvec3());
            let [a, b, c] = corners;
            let normal = (b - a).cross(c - a).normalize_or_zero();
            let mut facet = [0; super::FACET];
            let numbers = [normal, a, b, c].into_iter().flat_map(|v| v.as_vec3().to_array());
            for (place, number) in facet.as_chunks_mut::<4>().0.iter_mut().zip(numbers) {
                *place = number.to_le_bytes();
            }
            to.write_all(&facet)?;
        }
        to.flush()
    }
}
