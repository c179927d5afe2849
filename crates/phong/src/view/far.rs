//! Rays of a camera that is far away, or looks through a long lens.

use glam::{DVec2, DVec3};
use phong_bvh::Ray;

use super::View;
use crate::light::Light;

/// Distance of the eye, in sizes of what it sees, from which on rays start near it.
const FAR: f64 = 1024.0;
/// Pixels side by side over a distance of 1, at distance 1, from which on they do: what rounding a
/// direction to f32 moves a ray by, 2⁻²⁴, is then more than 1/256 of a pixel.
const LONG_LENS: f64 = 65536.0;

/// A ray of the camera, and how far from the camera it starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StartedRay {
    /// The ray. Its distances are from where it starts.
    pub ray: Ray,
    /// How far it was moved along from the camera before it starts; mostly 0.
    pub start: f64,
}

impl View {
    /// The ray through a place of a picture of `size` pixels: [`Camera::ray`](crate::camera::Camera::ray).
    /// Where distances from the camera are too coarse in f32 for what it sees, it starts just before that, and
    /// before the surfaces of lights that it sees on the way there.
    pub fn camera_ray(&self, place: DVec2, size: [u32; 2], lens: [f32; 2]) -> Option<StartedRay> {
        let [origin, dir] = self.camera.line(place, size, lens)?;
        let start = if self.is_far(size) { self.world().approach(origin, dir) } else { 0.0 };
        // Lights are no part of the world.
        let before = |start, light: &Light| light.approach(origin, dir, start);
        let start = self.lights.iter().fold(start, before);
        // What was not moved keeps the sign of its zeros.
        let origin = if start > 0.0 { origin + start * dir } else { origin };
        Some(StartedRay { ray: Ray::new(origin, dir.as_vec3()), start })
    }

    /// Whether rays of pictures of this size are moved along before they start.
    pub(crate) fn is_far(&self, size: [u32; 2]) -> bool {
        let eye = self.camera.eye();
        let (distance, extent) = self.world().bounds().map_or((0.0, 0.0), |[low, high]| {
            let off = (low - eye).max(eye - high).max(DVec3::ZERO);
            (off.length(), (high - low).max_element())
        });
        let across = if self.camera.is_parallel() { distance } else { 1.0 };
        let is_long = |pixels: f64| pixels * across > LONG_LENS;
        distance > FAR * extent || self.camera.pixels_across(size[1]).is_some_and(is_long)
    }
}

#[cfg(test)]
mod tests {
    use phong_scene::{Camera, CameraKind, LightKind, Object, Scene, Shape};

    use super::*;

    fn view(eye: DVec3, fov: f64) -> View {
        let ball = Shape::Sphere { center: DVec3::ZERO, radius: 1.0 };
        let objects = vec![Object { shape: ball, ..Object::default() }];
        let kind = CameraKind::Perspective { fov };
        let camera = Camera { eye, kind, ..Camera::default() };
        View::of(&Scene { camera, objects, ..Scene::default() }).expect("a ball")
    }

    #[test]
    fn a_ray_from_far_away_starts_near_what_it_meets_and_one_from_near_at_the_eye() {
        let middle = DVec2::new(50.0, 50.0);
        let near = view(DVec3::new(0.0, 0.0, 500.0), 1.0);
        let ray = near.camera_ray(middle, [100, 100], [0.5; 2]).unwrap();
        assert_eq!((ray.start, ray.ray.origin.z), (0.0, 500.0));
        let far = view(DVec3::new(0.0, 0.0, 1e7), 1e-5);
        let StartedRay { ray, start } = far.camera_ray(middle, [100, 100], [0.5; 2]).unwrap();
        assert!(ray.origin.z < 100.0 && start > 9e6, "{ray:?}");
        let hit = far.world().intersect(&ray);
        assert!((f64::from(hit.t) + start - (1e7 - 1.0)).abs() < 1e-4, "{hit:?}");
    }

    #[test]
    fn a_ray_from_far_away_starts_before_the_lamp_that_it_sees() {
        let middle = DVec2::new(50.0, 50.0);
        let starts = |position: DVec3| {
            let attenuation = [1.0, 0.0, 0.0];
            let kind = LightKind::Disc { position, direction: DVec3::Z, radius: 1.0, attenuation };
            let far = view(DVec3::new(0.0, 0.0, 1e7), 1e-5);
            let lights = vec![phong_scene::Light { kind, ..phong_scene::Light::default() }];
            let look = crate::look::Look { lights, ..far.look().clone() };
            let far = View::new(std::sync::Arc::clone(far.geometry()), look).expect("a ball");
            let StartedRay { ray, start } = far.camera_ray(middle, [100, 100], [0.5; 2]).unwrap();
            (start, far.lamp(&ray, f32::INFINITY).map(|t| start + f64::from(t)))
        };
        let (start, seen) = starts(DVec3::new(0.1, 0.2, 5e6));
        assert!((4.9e6..5e6).contains(&start), "{start}");
        assert!((seen.expect("a lamp") - 5e6).abs() < 1e-3, "{seen:?}");
        // Beside the ray, and at the ball's front, nothing changes.
        let plain = starts(DVec3::new(1.5, 0.0, 5e6));
        assert_eq!(plain.1, None);
        let (start, seen) = starts(DVec3::new(0.0, 0.0, 1.001));
        assert_eq!(start, plain.0);
        assert!((seen.expect("a lamp") - (1e7 - 1.001)).abs() < 1e-4, "{seen:?}");
    }
}
