//! Spheres and lines whose radius was guessed: as thick as a picture needs them.

use glam::{DMat3, DVec3};

use crate::camera::{Camera, CameraKind};
use crate::scene::{Object, Scene};
use crate::shape::Shape;

/// Pixels of the radius, at least: of a sphere, and of a line.
const LEAST: [f64; 2] = [1.5, 0.75];

impl Scene {
    /// Gives what was guessed its radius, whatever an earlier picture needed.
    pub(super) fn restore_guessed(&mut self) {
        let of_groups = self.groups.iter_mut().flat_map(|group| &mut group.objects);
        for object in self.objects.iter_mut().chain(of_groups) {
            match &mut object.shape {
                Shape::Points(points) => points.set_radius(points.guessed),
                Shape::Cylinders(lines) => lines.set_radius(lines.guessed),
                _ => {}
            }
        }
    }

    /// Makes spheres and lines of a glTF file's scene whose radius was guessed as large as its camera and its
    /// picture's size need them, where these have changed since it was read: the file may bring its own camera,
    /// and is then not framed anew. Of other scenes nothing changes.
    pub fn fit_guessed(&mut self) {
        if self.is_of_gltf() {
            self.restore_guessed();
            self.enlarge_guessed();
        }
    }

    /// Makes spheres and lines whose radius was guessed large enough to be seen.
    pub(super) fn enlarge_guessed(&mut self) {
        if !self.all_objects().any(|object| object.shape.guessed().is_some()) {
            return;
        }
        let Camera { kind, eye, .. } = self.camera;
        let rows = f64::from(self.image.size[1].max(1));
        let pixel = match kind {
            CameraKind::Perspective { fov } => {
                // The farthest of them must be seen, too.
                let corners = self.bounds().corners().into_iter();
                let distance = corners.map(|corner| corner.distance(eye)).fold(0.0, f64::max);
                2.0 * distance * libm::tan(0.5 * fov.to_radians()) / rows
            }
            CameraKind::Orthographic { height } => height / rows,
            CameraKind::Fisheye { .. } | CameraKind::Panorama => return,
        };
        let scales = self.scales_of_groups();
        for object in &mut self.objects {
            object.enlarge_guessed(pixel);
        }
        for (group, scale) in self.groups.iter_mut().zip(scales) {
            for object in &mut group.objects {
                object.enlarge_guessed(pixel / scale);
            }
        }
    }

    /// The least scale that each group is placed with; infinite where it is not placed at all.
    fn scales_of_groups(&self) -> Vec<f64> {
        let mut scales = vec![f64::INFINITY; self.groups.len()];
        let place = |scales: &mut [f64], objects: &[Object], scale: f64| {
            for object in objects {
                if let Shape::Instance(group) = object.shape
                    && let Some(known) = scales.get_mut(group.0 as usize)
                {
                    *known = known.min(scale * scale_of(object.transform.matrix3));
                }
            }
        };
        place(&mut scales, &self.objects, 1.0);
        // A group holds instances of earlier groups only.
        for (number, group) in self.groups.iter().enumerate().rev() {
            let scale = scales[number];
            place(&mut scales, &group.objects, scale);
        }
        scales
    }
}

impl Object {
    /// The same of one object, where a pixel is so large.
    fn enlarge_guessed(&mut self, pixel: f64) {
        let [sphere, line] = LEAST.map(|least| {
            let least = (least * pixel / scale_of(self.transform.matrix3)) as f32;
            if least.is_finite() { least } else { 0.0 }
        });
        match &mut self.shape {
            Shape::Points(points) => points.set_radius(points.guessed.map(|own| own.max(sphere))),
            Shape::Cylinders(lines) => lines.set_radius(lines.guessed.map(|own| own.max(line))),
            _ => {}
        }
    }
}

/// How much larger a placement makes things: the root of the mean of the squares along three axes.
fn scale_of(matrix: DMat3) -> f64 {
    let squares = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(DVec3::length_squared);
    (squares.iter().sum::<f64>() / 3.0).sqrt()
}

#[cfg(test)]
mod tests {
    use glam::DAffine3;

    use super::*;
    use crate::frame::Framing;
    use crate::mesh::{Cylinders, Points};
    use crate::scene::Group;
    use crate::shape::GroupId;

    fn line(length: f32) -> Object {
        let end = |x: f32| [x, 0.0, 0.0, 1e-4];
        let segments = [[end(0.0), end(length)]].into();
        Object::from(Shape::from(Cylinders {
            segments,
            guessed: Some(1e-4),
            ..Cylinders::default()
        }))
    }

    fn scaled(object: Object, scale: f64) -> Object {
        Object { transform: DAffine3::from_scale(DVec3::splat(scale)), ..object }
    }

    /// The radius in the picture's scene of the first end, or sphere, of an object.
    fn radius(object: &Object) -> f64 {
        let own = match &object.shape {
            Shape::Cylinders(lines) => lines.segments[0][0][3],
            Shape::Points(points) => points.spheres[0][3],
            shape => panic!("{shape:?}"),
        };
        f64::from(own) * scale_of(object.transform.matrix3)
    }

    fn framed(objects: Vec<Object>, groups: Vec<Group>, height: u32) -> Scene {
        let mut scene = Scene { objects, groups, ..Scene::default() };
        scene.image.size = [height; 2];
        let _ = scene.frame(&Framing::default());
        scene
    }

    #[test]
    fn lines_are_seen_in_any_picture_and_as_they_were_guessed_in_large_ones() {
        let mut scene = framed(vec![line(1.0)], Vec::new(), 64);
        let thick = radius(&scene.objects[0]);
        assert!(thick > 0.5 / 64.0 && thick < 2.0 / 64.0, "{thick}");
        scene.image.size = [20_000; 2];
        let _ = scene.frame(&Framing::default());
        assert!((radius(&scene.objects[0]) - 1e-4).abs() < 1e-8);
        let meant = Cylinders { guessed: None, ..Cylinders::default() };
        let mut meant = Cylinders { segments: [[[0.0, 0.0, 0.0, 1e-6]; 2]].into(), ..meant };
        meant.set_radius(meant.guessed);
        let scene = framed(vec![line(1.0), meant.into()], Vec::new(), 64);
        assert!(radius(&scene.objects[1]) < 2e-6, "what was meant stays");
    }

    #[test]
    fn lines_of_gltf_with_its_own_camera_are_as_thick_as_a_picture_of_another_size_needs() {
        let mut scene = framed(vec![line(100.0)], Vec::new(), 540);
        let before = radius(&scene.objects[0]);
        scene.image.size = [54; 2];
        scene.fit_guessed();
        assert_eq!(radius(&scene.objects[0]), before);
        scene.objects[0].place.file = "a.gltf".into();
        scene.fit_guessed();
        let thick = radius(&scene.objects[0]);
        assert!((thick / before - 10.0).abs() < 0.01, "{before} {thick}");
        scene.image.size = [540; 2];
        scene.fit_guessed();
        assert_eq!(radius(&scene.objects[0]), before);
    }

    #[test]
    fn how_large_an_object_is_placed_counts_and_in_groups_the_smallest_of_all_places() {
        let plain = radius(&framed(vec![line(100.0)], Vec::new(), 64).objects[0]);
        let large = radius(&framed(vec![scaled(line(1.0), 100.0)], Vec::new(), 64).objects[0]);
        assert!((plain / large - 1.0).abs() < 1e-3, "{plain} {large}");

        let cloud = Points {
            spheres: [[0.0, 0.0, 0.0, 1e-4], [1.0, 0.0, 0.0, 1e-4]].into(),
            guessed: Some(1e-4),
            ..Points::default()
        };
        let instance = |group, scale| scaled(Object::from(Shape::Instance(GroupId(group))), scale);
        let group = |objects| Group { name: String::new(), objects };
        let groups = vec![
            group(vec![line(1.0), cloud.into()]),
            group(vec![instance(0, 50.0)]),
            group(vec![line(1.0)]),
        ];
        let scene = framed(vec![instance(1, 2.0), instance(0, 25.0)], groups, 64);
        let of = |number: usize| radius(&scene.groups[0].objects[number]) * 25.0;
        assert!((plain / of(0) - 1.0).abs() < 1e-2, "{plain} {}", of(0));
        assert!((of(1) / of(0) - 2.0).abs() < 1e-3);
        assert!(radius(&scene.groups[2].objects[0]) < 2e-4, "what is not placed stays");
    }
}
