//! The camera of a bare model that goes once around it.

use super::{Framing, directions};
use crate::camera::Camera;
use crate::scene::Scene;

/// As many directions are tried; between two of them a model hardly reaches farther than from both.
const MOST_TRIED: u32 = 72;

impl Scene {
    /// Looks at a bare model from a camera that is to go once around it in so many equal steps
    /// ([`Camera::turned`]): at the middle of the model's box, from so far away that everything stays in
    /// the picture all the way. With an `eye` of one's own the camera stays where it is.
    ///
    /// It follows [`Scene::frame`] with the same framing; lights are those of its first place.
    pub fn frame_all_around(&mut self, framing: &Framing, steps: u32) {
        if framing.eye.is_some() {
            return;
        }
        let look_at = framing.look_at.unwrap_or_else(|| self.bounds().center());
        if !look_at.is_finite() {
            return;
        }
        let first = Camera { look_at, eye: look_at + self.backward(), ..self.camera.clone() };
        let framing = Framing { look_at: Some(look_at), ..framing.clone() };
        let tried = steps.clamp(1, MOST_TRIED);
        let distance = |step: u32| {
            let camera = first.turned(framing.up, step, tried);
            let to_eye =
                (camera.eye - look_at).normalize_or(directions(framing.side, framing.up).0);
            self.fit(&framing, to_eye, camera.up).eye.distance(look_at)
        };
        let farthest = (0..tried).map(distance).fold(0.0, f64::max);
        self.camera = Camera { eye: look_at + self.backward() * farthest, ..first };
        self.enlarge_guessed();
        self.light();
    }

    /// The unit direction from what the camera looks at to the camera.
    fn backward(&self) -> glam::DVec3 {
        (self.camera.eye - self.camera.look_at).normalize_or(glam::DVec3::Z)
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::camera::CameraKind;
    use crate::diagnostic::Place;
    use crate::fragment::Fragment;
    use crate::frame::{Side, frame};
    use crate::scene::Object;
    use crate::shape::Shape;

    /// How far from the middle of the picture a point is, as a share of the way to its edges.
    fn off(camera: &Camera, aspect: f64, p: DVec3) -> f64 {
        let CameraKind::Perspective { fov } = camera.kind else { panic!("{camera:?}") };
        let forward = (camera.look_at - camera.eye).try_normalize().expect("it looks somewhere");
        let right = forward.cross(camera.up).try_normalize().expect("up is aside");
        let d = p - camera.eye;
        let half = d.dot(forward) * libm::tan(0.5 * fov.to_radians());
        assert!(half > 0.0);
        (d.dot(right) / (half * aspect)).abs().max((d.dot(right.cross(forward)) / half).abs())
    }

    #[test]
    fn a_long_model_stays_in_the_picture_all_the_way_around() {
        let (min, max) = (DVec3::new(-9.0, 1.0, -1.0), DVec3::new(11.0, 2.0, 1.0));
        for (side, up) in [(Side::Front, DVec3::Y), (Side::Iso, DVec3::Z), (Side::Top, DVec3::Y)] {
            let mut scene = frame(Fragment::default(), &Framing::default(), &Place::default());
            scene.objects = vec![Object::from(Shape::Box { min, max })];
            scene.image.size = [160, 90];
            let framing = Framing { side, up, ..Framing::default() };
            let _ = scene.frame(&framing);
            scene.frame_all_around(&framing, 36);
            let corners = crate::bounds::Bounds { min, max }.corners();
            let farthest = (0..36).map(|step| {
                let camera = scene.camera.turned(up, step, 36);
                let off = corners.map(|corner| off(&camera, 160.0 / 90.0, corner));
                off.into_iter().fold(0.0, f64::max)
            });
            let farthest = farthest.fold(0.0, f64::max);
            assert!(farthest > 0.89 && farthest < 0.901, "{side:?}: {farthest}");
        }
    }
}
