//! Colours of triangles, which become those of vertices.

use std::collections::HashMap;

use glam::Vec3;

use super::Mesh;
use crate::color::Rgb;

impl Mesh {
    /// Gives every triangle its colour: vertices whose triangles have several become several, and what no
    /// triangle uses goes. `colors` holds one for each triangle.
    pub(crate) fn color_faces(&mut self, colors: &[Rgb]) {
        let mut numbers: HashMap<(u32, [u32; 3]), u32> = HashMap::new();
        let mut vertices = Vec::new();
        let mut linear = Vec::new();
        for (triangle, color) in self.indices.iter_mut().zip(colors) {
            for corner in triangle {
                let old = *corner;
                let key = (old, color.to_array().map(f32::to_bits));
                *corner = *numbers.entry(key).or_insert_with(|| {
                    vertices.push(old as usize);
                    linear.push(*color);
                    vertices.len() as u32 - 1
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
