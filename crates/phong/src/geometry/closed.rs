//! Which objects enclose what is inside: where a clip cuts through them, they have caps.

use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

use phong_scene::{Mesh, Shape, Shared};

use super::flatten::Placed;

/// Which objects enclose what is inside.
///
/// A look may ask for caps whatever the clips of the scene were that the geometry was built of, so nothing is
/// decided here. Meshes are looked at when they are first asked for: it takes a sort of all their edges.
#[derive(Debug, Default)]
pub(super) struct Closed {
    objects: Vec<Answer>,
    /// Meshes by the addresses of their positions and indices, each once however many objects share it.
    meshes: BTreeMap<[usize; 2], Arc<AskedMesh>>,
}

/// Whether one object encloses what is inside.
#[derive(Debug)]
enum Answer {
    Known(bool),
    OfMesh(Arc<AskedMesh>),
}

/// A mesh, and whether it is closed, once that was asked for.
#[derive(Debug)]
struct AskedMesh {
    /// Positions and indices. As long as they are held, nothing else has their address.
    mesh: Mesh,
    is_closed: OnceLock<bool>,
}

impl Closed {
    /// That of some objects. What `earlier` knows of meshes whose arrays are the very same is kept.
    pub(super) fn of(placed: &[Placed<'_>], earlier: &Self) -> Self {
        let mut meshes = BTreeMap::new();
        let answer = |placed: &Placed<'_>| match &placed.object.shape {
            Shape::Mesh(mesh) => {
                let key = [Shared::address(&mesh.positions), Shared::address(&mesh.indices)];
                let asked = meshes.entry(key).or_insert_with(|| match earlier.meshes.get(&key) {
                    Some(asked) => Arc::clone(asked),
                    None => Arc::new(AskedMesh::new(mesh)),
                });
                Answer::OfMesh(Arc::clone(asked))
            }
            shape => Answer::Known(shape.is_closed()),
        };
        let objects = placed.iter().map(answer).collect();
        Self { objects, meshes }
    }

    /// Whether the object of this number encloses what is inside.
    pub(super) fn of_object(&self, object: u32) -> bool {
        match self.objects.get(object as usize) {
            Some(Answer::Known(is_closed)) => *is_closed,
            Some(Answer::OfMesh(asked)) => *asked.is_closed.get_or_init(|| asked.mesh.is_closed()),
            None => false,
        }
    }
}

impl AskedMesh {
    fn new(mesh: &Mesh) -> Self {
        let (positions, indices) = (mesh.positions.clone(), mesh.indices.clone());
        let mesh = Mesh { positions, indices, ..Mesh::default() };
        Self { mesh, is_closed: OnceLock::new() }
    }
}

#[cfg(test)]
mod tests {
    use glam::{DAffine3, Vec3};
    use phong_scene::Object;

    use super::*;

    #[test]
    fn a_mesh_is_looked_at_when_it_is_asked_for_and_once_for_all_that_share_it() {
        let positions = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z].into();
        let indices = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]].into();
        let mesh = Mesh { positions, indices, ..Mesh::default() };
        let object = Object { shape: Shape::Mesh(Box::new(mesh)), ..Object::default() };
        let copy = object.clone();
        let placed = [&object, &copy].map(|object| Placed {
            object,
            name: String::new(),
            to_world: DAffine3::IDENTITY,
        });
        let closed = Closed::of(&placed, &Closed::default());
        let known = |closed: &Closed| -> Vec<Option<bool>> {
            closed.meshes.values().map(|asked| asked.is_closed.get().copied()).collect()
        };
        assert_eq!(known(&closed), [None]);
        assert!(closed.of_object(1));
        assert_eq!(known(&closed), [Some(true)]);
        let updated = Closed::of(&placed[..1], &closed);
        assert_eq!(known(&updated), [Some(true)], "what is known is kept");
        assert!(updated.of_object(0) && !updated.of_object(1));
    }
}
