//! From a place in the picture to a ray.

use std::ops::{Add, Div, Mul};

use fearless_simd::{Simd, f64x4, prelude::*};
use glam::{DVec2, DVec3, Vec3};
use phong_bvh::{Ray, Rays8};
use phong_scene::CameraKind;

use crate::math::lanes::store3;
use crate::math::{Dir3, wide};

/// A camera set up in f64, in the compiled scene's space.
#[derive(Clone, Debug)]
pub struct Camera {
    kind: CameraKind,
    eye: DVec3,
    right: DVec3,
    up: DVec3,
    forward: DVec3,
    /// Tangent of half the vertical field of view, or half the height, or half the full angle.
    half: f64,
    aperture: f64,
    focus: f64,
}

impl Camera {
    /// Sets a camera up, everything moved by `−center`.
    pub fn new(camera: &phong_scene::Camera, center: DVec3) -> Self {
        let view = camera.look_at - camera.eye;
        let forward = view.normalize_or(-DVec3::Z);
        let right = forward.cross(camera.up).normalize_or(forward.any_orthonormal_vector());
        let half = match camera.kind {
            CameraKind::Perspective { fov } => wide::tan(fov.to_radians() / 2.0),
            CameraKind::Orthographic { height } => height / 2.0,
            CameraKind::Fisheye { fov } => fov.to_radians() / 2.0,
            CameraKind::Panorama => 0.0,
        };
        Self {
            kind: camera.kind,
            eye: camera.eye - center,
            right,
            up: right.cross(forward),
            forward,
            half,
            aperture: camera.aperture,
            focus: camera.focus.unwrap_or(view.length()),
        }
    }

    /// To a viewer infinitely far along the camera's axis.
    pub fn backward(&self) -> Dir3 {
        Dir3::from_unit(-self.forward.as_vec3())
    }

    /// Whether the place on the lens matters.
    pub fn has_lens(&self) -> bool {
        self.aperture > 0.0
            && matches!(self.kind, CameraKind::Perspective { .. } | CameraKind::Orthographic { .. })
    }

    /// The picture's upward direction, unit.
    pub fn up(&self) -> Vec3 {
        self.up.as_vec3()
    }

    /// The ray through a place of a picture of `size` pixels, x to the right and y down, (0, 0)
    /// the upper left corner. `lens` in [0, 1)², (½, ½) its centre. `None` outside the image
    /// circle of a fisheye.
    #[inline]
    pub fn ray(&self, place: DVec2, size: [u32; 2], lens: [f32; 2]) -> Option<Ray> {
        let (width, height) = (f64::from(size[0]), f64::from(size[1]));
        let [x, y] = from_the_middle(place.to_array(), width, height);
        let (origin, dir) = match self.kind {
            CameraKind::Perspective { .. } if self.aperture == 0.0 => {
                return Some(Ray::new(self.eye.as_vec3(), Vec3::from(self.pinhole(x, y))));
            }
            CameraKind::Perspective { .. } => {
                let toward = self.half * (x * self.right + y * self.up) + self.forward;
                self.through_lens(self.eye, toward, lens)
            }
            CameraKind::Orthographic { .. } => {
                let origin = self.eye + self.half * (x * self.right + y * self.up);
                self.through_lens(origin, self.forward, lens)
            }
            CameraKind::Fisheye { .. } => {
                // The circle touches the nearer edges.
                let circle = (width / height).min(1.0);
                (self.eye, self.fisheye(x / circle, y / circle)?)
            }
            CameraKind::Panorama => {
                (self.eye, self.panorama(place.x / width - 0.5, 0.5 - place.y / height))
            }
        };
        Some(Ray::new(origin.as_vec3(), dir.normalize_or(self.forward).as_vec3()))
    }

    /// Whether [`Camera::pinhole_rays`] draws its rays.
    pub(crate) fn is_pinhole(&self) -> bool {
        matches!(self.kind, CameraKind::Perspective { .. }) && self.aperture == 0.0
    }

    /// The rays of [`Camera::ray`] through eight places, of a camera that
    /// [is a pinhole](Camera::is_pinhole).
    #[inline(always)]
    pub(crate) fn pinhole_rays<S: Simd>(
        &self,
        simd: S,
        [x, y]: [[f64x4<S>; 2]; 2],
        size: [u32; 2],
    ) -> Rays8 {
        let low = self.pinhole4(simd, [x[0], y[0]], size);
        let high = self.pinhole4(simd, [x[1], y[1]], size);
        let dir = [low[0].narrow(high[0]), low[1].narrow(high[1]), low[2].narrow(high[2])];
        let Vec3 { x, y, z } = self.eye.as_vec3();
        Rays8 { origin: [[x; 8], [y; 8], [z; 8]], dir: store3(dir), there: 0xff, ..Rays8::NONE }
    }

    /// [`Camera::pinhole`] through four places of a picture of `size` pixels.
    #[inline(always)]
    fn pinhole4<S: Simd>(&self, simd: S, place: [f64x4<S>; 2], size: [u32; 2]) -> [f64x4<S>; 3] {
        let [x, y] = from_the_middle(place, f64::from(size[0]), f64::from(size[1]));
        let [x, y, z] = self.toward(x, y);
        let inverse = f64x4::splat(simd, 1.0) / (x * x + y * y + z * z).sqrt();
        [x * inverse, y * inverse, z * inverse]
    }

    /// The direction through a place, half heights off the picture's middle: unit, since no
    /// direction is shorter than `forward`.
    fn pinhole(&self, x: f64, y: f64) -> [f32; 3] {
        let [x, y, z] = self.toward(x, y);
        let inverse = 1.0 / (x * x + y * y + z * z).sqrt();
        [(x * inverse) as f32, (y * inverse) as f32, (z * inverse) as f32]
    }

    /// A place of the picture, half heights off its middle, seen from the eye.
    #[inline(always)]
    fn toward<F: Wide>(&self, x: F, y: F) -> [F; 3] {
        let Self { right, up, forward, half, .. } = self;
        [
            (x * right.x + y * up.x) * *half + forward.x,
            (x * right.y + y * up.y) * *half + forward.y,
            (x * right.z + y * up.z) * *half + forward.z,
        ]
    }

    /// The direction at a place of the image circle, whose radius is 1; `None` outside.
    fn fisheye(&self, x: f64, y: f64) -> Option<DVec3> {
        let r = (x * x + y * y).sqrt();
        if r > 1.0 {
            return None;
        }
        let (sin, cos) = wide::sin_cos(r * self.half);
        let across = if r > 0.0 { sin / r } else { 0.0 };
        Some(across * (x * self.right + y * self.up) + cos * self.forward)
    }

    /// The direction `x` full turns to the right and `y` half turns up.
    fn panorama(&self, x: f64, y: f64) -> DVec3 {
        let (sin, cos) = wide::sin_cos(x * std::f64::consts::TAU);
        let (rise, level) = wide::sin_cos(y * std::f64::consts::PI);
        let around = cos * self.forward + sin * self.right;
        level * around + rise * self.up
    }

    /// Moves a ray's start across the lens so that it still meets the plane of focus where it did.
    /// `toward` has length 1 along forward.
    #[inline]
    fn through_lens(&self, origin: DVec3, toward: DVec3, lens: [f32; 2]) -> (DVec3, DVec3) {
        if self.aperture == 0.0 {
            return (origin, toward);
        }
        let [u, v] = disc(lens);
        let shift = self.aperture * (u * self.right + v * self.up);
        (origin + shift, toward * self.focus - shift)
    }
}

/// A number in f64, or four: what a place in the picture is worked out in.
trait Wide:
    Copy
    + Add<Output = Self>
    + Add<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
{
}

impl Wide for f64 {}
impl<S: Simd> Wide for f64x4<S> {}

/// A place from the picture's middle, in half heights; y up.
#[inline(always)]
fn from_the_middle<F: Wide>([x, y]: [F; 2], width: f64, height: f64) -> [F; 2] {
    [(x * 2.0 + -width) / height, (y * -2.0 + height) / height]
}

/// A point of the unit disc from one of the unit square, areas kept (Shirley and Chiu 1997).
/// (½, ½) is the middle.
pub(crate) fn disc([u, v]: [f32; 2]) -> [f64; 2] {
    let (a, b) = (2.0 * f64::from(u) - 1.0, 2.0 * f64::from(v) - 1.0);
    if a == 0.0 && b == 0.0 {
        return [0.0, 0.0];
    }
    let quarter = std::f64::consts::FRAC_PI_4;
    let (r, angle) = if a.abs() > b.abs() {
        (a, quarter * (b / a))
    } else {
        (b, 2.0 * quarter - quarter * (a / b))
    };
    let (sin, cos) = wide::sin_cos(angle);
    [r * cos, r * sin]
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: [u32; 2] = [40, 20];
    const MIDDLE: [f32; 2] = [0.5, 0.5];

    fn camera(kind: CameraKind) -> phong_scene::Camera {
        phong_scene::Camera {
            kind,
            eye: DVec3::new(0.0, 0.0, 5.0),
            look_at: DVec3::ZERO,
            up: DVec3::Y,
            aperture: 0.0,
            focus: None,
        }
    }

    fn dir(kind: CameraKind, x: f64, y: f64) -> Vec3 {
        let camera = Camera::new(&camera(kind), DVec3::ZERO);
        camera.ray(DVec2::new(x, y), SIZE, MIDDLE).unwrap().dir
    }

    #[test]
    fn the_middle_of_every_picture_looks_forward() {
        for kind in [
            CameraKind::Perspective { fov: 40.0 },
            CameraKind::Orthographic { height: 4.0 },
            CameraKind::Fisheye { fov: 180.0 },
            CameraKind::Panorama,
        ] {
            assert_eq!(dir(kind, 20.0, 10.0), -Vec3::Z, "{kind:?}");
        }
    }

    #[test]
    fn many_pinhole_rays_have_the_bits_of_one() {
        let camera = Camera::new(
            &phong_scene::Camera {
                eye: DVec3::new(1.0, 2.5, 8.1),
                ..camera(CameraKind::Perspective { fov: 37.0 })
            },
            DVec3::new(0.25, 0.0, 0.0),
        );
        assert!(camera.is_pinhole());
        let simd = fearless_simd::Fallback::new();
        for i in 0..6 {
            let place = |lane: usize| DVec2::new(0.93, 0.41) * (8 * i + lane) as f64;
            let column = |axis: usize, from: usize| -> f64x4<_> {
                let at = |k: usize| place(from + k)[axis];
                [at(0), at(1), at(2), at(3)].simd_into(simd)
            };
            let places = [[column(0, 0), column(0, 4)], [column(1, 0), column(1, 4)]];
            let rays = camera.pinhole_rays(simd, places, SIZE);
            for lane in 0..8 {
                assert_eq!(Some(rays.get(lane)), camera.ray(place(lane), SIZE, MIDDLE));
            }
        }
    }

    #[test]
    fn the_upper_edge_is_half_the_field_of_view_up() {
        let d = dir(CameraKind::Perspective { fov: 90.0 }, 20.0, 0.0);
        assert!((d - Vec3::new(0.0, 0.5, -0.5) * 2.0_f32.sqrt()).length() < 1e-6);
        let d = dir(CameraKind::Perspective { fov: 90.0 }, 30.0, 10.0);
        assert!((d - Vec3::new(0.5, 0.0, -0.5) * 2.0_f32.sqrt()).length() < 1e-6, "x to the right");
    }

    #[test]
    fn orthographic_rays_are_parallel_and_span_the_height() {
        let camera = Camera::new(&camera(CameraKind::Orthographic { height: 4.0 }), DVec3::ZERO);
        let ray = camera.ray(DVec2::new(20.0, 0.0), SIZE, MIDDLE).unwrap();
        assert_eq!((ray.origin, ray.dir), (Vec3::new(0.0, 2.0, 5.0), -Vec3::Z));
    }

    #[test]
    fn the_image_circle_touches_the_nearer_edges() {
        let d = dir(CameraKind::Fisheye { fov: 180.0 }, 30.0, 10.0);
        assert!((d - Vec3::X).length() < 1e-6, "90° off at the circle's edge");
        let camera = Camera::new(&camera(CameraKind::Fisheye { fov: 180.0 }), DVec3::ZERO);
        assert!(camera.ray(DVec2::new(30.1, 10.0), SIZE, MIDDLE).is_none());
    }

    #[test]
    fn a_panorama_sees_behind_at_its_sides() {
        assert!((dir(CameraKind::Panorama, 0.0, 10.0) - Vec3::Z).length() < 1e-6);
        assert!((dir(CameraKind::Panorama, 30.0, 10.0) - Vec3::X).length() < 1e-6);
        assert!((dir(CameraKind::Panorama, 20.0, 0.0) - Vec3::Y).length() < 1e-6);
    }

    #[test]
    fn rays_through_the_lens_meet_in_the_plane_of_focus() {
        let lens = phong_scene::Camera {
            aperture: 0.5,
            focus: Some(3.0),
            ..camera(CameraKind::Perspective { fov: 40.0 })
        };
        let camera = Camera::new(&lens, DVec3::ZERO);
        let at_focus = |lens| {
            let ray = camera.ray(DVec2::new(7.0, 3.0), SIZE, lens).unwrap();
            ray.at((2.0 - ray.origin.z) / ray.dir.z)
        };
        let sharp = at_focus(MIDDLE);
        for lens in [[0.0, 0.0], [0.9, 0.2], [0.5, 0.99]] {
            assert!((at_focus(lens) - sharp).length() < 1e-5);
        }
        let pinhole = camera.ray(DVec2::new(7.0, 3.0), SIZE, [0.0, 0.5]).unwrap();
        assert!((pinhole.origin.x.abs() - 0.5).abs() < 1e-6, "the lens has the aperture's radius");
    }
}
