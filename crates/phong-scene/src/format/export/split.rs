//! Meshes of several materials, cut into one for each.

use std::collections::BTreeSet;

use super::Account;
use crate::material::MaterialId;
use crate::scene::Object;
use crate::shape::Shape;

/// Every object, those of several materials cut into one for each, which is told.
pub(crate) fn split_all(objects: Vec<Object>, account: &mut Account) -> Vec<Object> {
    objects.into_iter().flat_map(|object| split(object, account)).collect()
}

fn split(mut object: Object, account: &mut Account) -> Vec<Object> {
    let Shape::Mesh(mesh) = &mut object.shape else { return vec![object] };
    let faces = std::mem::take(&mut mesh.face_materials);
    let used: BTreeSet<u32> = faces.iter().copied().collect();
    if let [only] = used.iter().copied().collect::<Vec<_>>()[..] {
        object.material = MaterialId(only);
    }
    if used.len() <= 1 {
        return vec![object];
    }
    let Object { name, shape: Shape::Mesh(mesh), transform, place, .. } = &object else {
        return vec![object];
    };
    account.map(format!("{name} of {} materials becomes as many meshes", used.len()));
    let part = |material: u32| Object {
        name: name.clone(),
        shape: Shape::Mesh(Box::new(mesh.part(|face| faces[face] == material))),
        material: MaterialId(material),
        transform: *transform,
        place: place.clone(),
    };
    used.into_iter().map(part).collect()
}
