//! Colours of triangles, which become those of vertices.

use glam::Vec3;

use super::{Mesh, NO_INDEX};
use crate::color::Rgb;

/// How many vertices that came from one are compared with a colour: of a fan with a colour for each
/// triangle its middle becomes as many vertices, and comparing with all would take the square of their number.
const COMPARED: usize = 64;

impl Mesh {
    /// Gives every triangle its colour: vertices whose triangles have several become several, and what no
    /// triangle uses goes. `colors` holds one for each triangle.
    pub(crate) fn color_faces(&mut self, colors: &[Rgb]) {
        // For each vertex the latest that came from it; for each of these the one before.
        let mut latest = vec![NO_INDEX; self.positions.len()];
        let mut before = Vec::new();
        let mut vertices = Vec::new();
        let mut linear: Vec<Rgb> = Vec::new();
        for (triangle, color) in self.indices.iter_mut().zip(colors) {
            for corner in triangle {
                let latest = &mut latest[*corner as usize];
                let known =
                    std::iter::successors(Some(*latest), |i| before.get(*i as usize).copied());
                let mut known = known.take_while(|i| *i != NO_INDEX).take(COMPARED);
                *corner = known.find(|i| linear[*i as usize] == *color).unwrap_or_else(|| {
                    vertices.push(*corner as usize);
                    linear.push(*color);
                    before.push(std::mem::replace(latest, before.len() as u32));
                    *latest
                });
            }
        }
        let all =
            |values: &[Vec3]| vertices.iter().filter_map(|&i| values.get(i).copied()).collect();
        self.positions = all(&self.positions);
        if self.normal_indices.is_empty() {
            self.normals = all(&self.normals);
        }
        if self.uv_indices.is_empty() {
            self.uvs = vertices.iter().filter_map(|&i| self.uvs.get(i).copied()).collect();
        }
        for field in &mut self.fields {
            field.values = vertices.iter().filter_map(|&i| field.values.get(i).copied()).collect();
        }
        self.colors = linear.into();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vertices_become_as_many_as_they_have_colours_in_the_order_of_first_use() {
        let mut mesh = Mesh {
            positions: [0, 1, 2, 3, 4].map(|i| Vec3::splat(i as f32)).into(),
            indices: [[4, 1, 2], [1, 3, 2], [2, 4, 1], [3, 1, 2]].into(),
            ..Mesh::default()
        };
        let [red, blue] = [Rgb::new(1.0, 0.0, 0.0), Rgb::new(0.0, 0.0, 1.0)];
        mesh.color_faces(&[red, blue, red, red]);
        assert_eq!(mesh.indices[..], [[0, 1, 2], [3, 4, 5], [2, 0, 1], [6, 1, 2]]);
        let places: Vec<f32> = mesh.positions.iter().map(|p| p.x).collect();
        assert_eq!(places, [4.0, 1.0, 2.0, 1.0, 3.0, 2.0, 3.0]);
        assert_eq!(mesh.colors[..], [red, red, red, blue, blue, blue, red]);
    }

    #[test]
    fn of_very_many_colours_of_one_vertex_the_latest_are_compared() {
        let mut colors: Vec<Rgb> = (0..=COMPARED).map(|i| Rgb::grey(i as f32)).collect();
        colors.extend([colors[COMPARED], colors[0]]);
        let mut mesh = Mesh {
            positions: [Vec3::ZERO; 3].into(),
            indices: vec![[0, 1, 2]; colors.len()].into(),
            ..Mesh::default()
        };
        mesh.color_faces(&colors);
        assert_eq!(mesh.colors.len(), 3 * (COMPARED + 2));
        assert_eq!(mesh.indices[COMPARED], mesh.indices[COMPARED + 1]);
    }
}
