//! A later frame, seen as the first one is.

use crate::mesh::{Cylinders, Mesh, Points};
use crate::scene::Scene;
use crate::shape::Shape;

impl Scene {
    /// Makes it a later frame of `first`: seen by the same camera, and, of a bare model, with the same
    /// lights and the same guessed radii.
    ///
    /// Arrays that are equal become the very same, so that trees over them can be taken over.
    pub fn follow(&mut self, first: &Self, bare: bool) {
        self.camera = first.camera.clone();
        if bare {
            self.lights.clone_from(&first.lights);
        }
        let groups = self.groups.iter_mut().zip(&first.groups);
        let in_groups =
            groups.flat_map(|(mine, first)| mine.objects.iter_mut().zip(&first.objects));
        for (mine, first) in self.objects.iter_mut().zip(&first.objects).chain(in_groups) {
            follow(&mut mine.shape, &first.shape);
        }
    }
}

/// Makes a shape follow the one in its place.
fn follow(mine: &mut Shape, first: &Shape) {
    if let (Shape::Points(mine), Shape::Points(first)) = (&mut *mine, first)
        && mine.guessed.is_some()
        && first.guessed.is_some()
    {
        mine.guessed = first.guessed;
        mine.set_radius(first.spheres.first().map(|sphere| sphere[3]));
    }
    if let (Shape::Cylinders(mine), Shape::Cylinders(first)) = (&mut *mine, first)
        && mine.guessed.is_some()
        && first.guessed.is_some()
    {
        mine.guessed = first.guessed;
        mine.set_radius(first.segments.first().map(|ends| ends[0][3]));
    }
    mine.share(first);
}

impl Shape {
    /// Takes the arrays of another shape where all of them are equal to its own, so that trees over them can
    /// be taken over. Where anything differs, nothing is taken.
    pub fn share(&mut self, other: &Self) {
        match (self, other) {
            (Self::Mesh(mine), Self::Mesh(other)) if are_same_meshes(mine, other) => {
                mine.clone_from(other);
            }
            (Self::Points(mine), Self::Points(other)) if are_same_points(mine, other) => {
                mine.clone_from(other);
            }
            (Self::Cylinders(mine), Self::Cylinders(other)) if are_same_cylinders(mine, other) => {
                mine.clone_from(other);
            }
            _ => {}
        }
    }
}

fn are_same_meshes(a: &Mesh, b: &Mesh) -> bool {
    a.origin == b.origin
        && a.positions == b.positions
        && a.indices == b.indices
        && a.normals == b.normals
        && a.normal_indices == b.normal_indices
        && a.uvs == b.uvs
        && a.uv_indices == b.uv_indices
        && a.colors == b.colors
        && a.face_materials == b.face_materials
        && a.fields == b.fields
}

fn are_same_points(a: &Points, b: &Points) -> bool {
    a.origin == b.origin
        && a.spheres == b.spheres
        && a.colors == b.colors
        && a.guessed == b.guessed
        && a.fields == b.fields
}

fn are_same_cylinders(a: &Cylinders, b: &Cylinders) -> bool {
    a.origin == b.origin
        && a.segments == b.segments
        && a.colors == b.colors
        && a.caps == b.caps
        && a.guessed == b.guessed
        && a.fields == b.fields
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::mesh::Shared;
    use crate::scene::Object;

    fn cloud(z: f32) -> Object {
        let spheres = vec![[0.0, 0.0, z, 0.5], [1.0, 0.0, 0.0, 0.5]];
        let guessed = Some(0.5);
        Object::from(Shape::from(Points { spheres: spheres.into(), guessed, ..Points::default() }))
    }

    fn points(object: &Object) -> &Points {
        let Shape::Points(points) = &object.shape else { panic!("{object:?}") };
        points
    }

    #[test]
    fn what_has_not_moved_is_shared_and_what_was_guessed_stays() {
        let mut first = Scene { objects: vec![cloud(0.0), cloud(0.0)], ..Scene::default() };
        first.camera.eye = DVec3::new(1.0, 2.0, 3.0);
        let Shape::Points(enlarged) = &mut first.objects[0].shape else { panic!() };
        enlarged.set_radius(Some(0.75));
        let mut later = Scene { objects: vec![cloud(2.0), cloud(0.0)], ..Scene::default() };
        later.follow(&first, true);
        assert_eq!(later.camera, first.camera);
        let [moved, still] = [0, 1].map(|i| points(&later.objects[i]));
        assert_eq!(moved.spheres[0], [0.0, 0.0, 2.0, 0.75]);
        assert!(Shared::is_same(&still.spheres, &points(&first.objects[1]).spheres));
    }
}
