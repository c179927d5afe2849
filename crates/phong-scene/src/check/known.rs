//! Arrays that were found sound, so that they need not be read again.

use std::collections::BTreeMap;

use glam::{DAffine3, DVec3};

use crate::bounds::Bounds;
use crate::mesh::{Cylinders, Field, Mesh, Points, Shared};
use crate::shape::Shape;

/// The arrays of meshes, clouds and bundles of cylinders in which a check found nothing wrong. They
/// are held together with what they are known by, their addresses, so that nothing else gets those.
#[derive(Clone, Debug, Default)]
pub struct SoundArrays(BTreeMap<Key, Known>);

/// The addresses of the arrays, 0 for empty ones, the bits of what is added to positions, and the addresses
/// of names and numbers of fields.
type Key = ([usize; 8], [u64; 3], Vec<[usize; 2]>);

#[derive(Clone, Debug)]
struct Known {
    #[expect(dead_code, reason = "held so that nothing else gets the arrays' addresses")]
    shape: Shape,
    /// Where it lies, in its own space.
    bounds: Bounds,
    /// How many materials a scene must hold for its faces.
    materials: usize,
}

impl SoundArrays {
    /// Takes a shape over from `earlier`, if it is there and a scene of so many materials may hold it:
    /// whether it is now here.
    pub(super) fn take_over(&mut self, shape: &Shape, earlier: &Self, materials: usize) -> bool {
        let Some(key) = key(shape) else { return false };
        let known = |all: &Self| all.0.get(&key).filter(|k| k.materials <= materials).cloned();
        if known(self).is_some() {
            return true;
        }
        let taken = known(earlier);
        let is_known = taken.is_some();
        self.0.extend(taken.map(|known| (key, known)));
        is_known
    }

    /// Takes in a shape in which nothing is wrong.
    pub(super) fn add(&mut self, shape: &Shape) {
        let Some(key) = key(shape) else { return };
        let (bounds, materials) = match shape {
            Shape::Mesh(mesh) => {
                let highest = mesh.face_materials.iter().max();
                (mesh.bounds(), highest.map_or(0, |&highest| highest as usize + 1))
            }
            Shape::Points(points) => (points.bounds(), 0),
            shape => (shape.bounds(DAffine3::IDENTITY), 0),
        };
        self.0.insert(key, Known { shape: shape.clone(), bounds, materials });
    }

    /// Where a shape that is here lies, in its own space.
    pub(super) fn bounds(&self, shape: &Shape) -> Option<Bounds> {
        self.0.get(&key(shape)?).map(|known| known.bounds)
    }
}

/// What a shape of arrays is known by; `None`: it is none.
fn key(shape: &Shape) -> Option<Key> {
    fn at<T>(array: &Shared<T>) -> usize {
        if array.is_empty() { 0 } else { Shared::address(array) }
    }
    let (arrays, origin, fields) = match shape {
        Shape::Mesh(mesh) => {
            let Mesh { normals, normal_indices, uvs, uv_indices, colors, .. } = &**mesh;
            let [p, i, f] = [at(&mesh.positions), at(&mesh.indices), at(&mesh.face_materials)];
            let own = [at(normals), at(normal_indices), at(uvs), at(uv_indices), at(colors)];
            let [a, b, c, d, e] = own;
            ([p, i, f, a, b, c, d, e], mesh.origin, &mesh.fields)
        }
        Shape::Points(points) => {
            let Points { origin, spheres, colors, fields, .. } = &**points;
            ([at(spheres), at(colors), 0, 0, 0, 0, 0, 0], *origin, fields)
        }
        Shape::Cylinders(cylinders) => {
            let Cylinders { origin, segments, colors, fields, caps, .. } = &**cylinders;
            ([at(segments), at(colors), *caps as usize, 0, 0, 0, 0, 0], *origin, fields)
        }
        _ => return None,
    };
    let field = |field: &Field| [field.name.as_ptr().addr(), at(&field.values)];
    let fields = fields.iter().map(field).collect();
    Some((arrays, DVec3::to_array(&origin).map(f64::to_bits), fields))
}
