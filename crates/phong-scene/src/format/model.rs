//! What a model file holds: geometry and the materials it names, without camera or lights.

use crate::material::Material;
use crate::mesh::{Mesh, Points};

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

/// What is said of a mesh in which no triangle has an area.
pub(crate) fn flat(triangles: usize) -> String {
    match triangles {
        1 => "nothing can be seen: its one triangle has no area".to_owned(),
        n => format!("nothing can be seen: none of its {n} triangles has an area"),
    }
}
