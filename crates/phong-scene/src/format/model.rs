//! What a model file holds: geometry and the materials it names, without camera or lights.

use crate::{Material, Mesh, Points};

/// The contents of one model file.
#[derive(Debug, Default)]
pub(crate) struct Model {
    /// Its pieces, in the order of the file.
    pub(crate) parts: Vec<Part>,
    /// The materials that [`Mesh::face_materials`] indexes.
    pub(crate) materials: Vec<Material>,
}

/// One piece of a model. A mesh without `face_materials` is of the default material.
#[derive(Debug)]
pub(crate) enum Part {
    /// Triangles.
    Mesh {
        /// What the file calls it; empty: nothing.
        name: String,
        /// The triangles; `face_materials` indexes [`Model::materials`].
        mesh: Mesh,
    },
    /// Spheres.
    Points {
        /// What the file calls them; empty: nothing.
        name: String,
        /// The spheres.
        points: Points,
    },
}
