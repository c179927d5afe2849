//! From a place in the picture to a ray.

use fearless_simd::{Simd, f32x8, f64x4, prelude::*};
use glam::{DVec2, DVec3, Vec3};
use phong_bvh::lanes::splat3;
use phong_bvh::{Lanes, Ray, Rays8, whole};
use phong_scene::CameraKind;

use crate::math::{Dir3, wide};
use crate::sampling::concentric_disc;
use crate::texture::Cone;

/// A camera set up in f64, in the world.
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
    /// How far the picture is shifted, to the right and up, in half heights of the picture.
    shift: DVec2,
}

impl Camera {
    /// Sets a camera up.
    pub fn new(camera: &phong_scene::Camera) -> Self {
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
            eye: camera.eye,
            right,
            up: right.cross(forward),
            forward,
            half,
            aperture: camera.aperture,
            focus: camera.focus.unwrap_or(view.length()),
            shift: 2.0 * camera.shift,
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
        let [origin, dir] = self.line(place, size, lens)?;
        Some(Ray::new(origin, dir.as_vec3()))
    }

    /// The place in a picture of `size` pixels where a point of the world is seen, as [`Camera::ray`]
    /// takes it: outside the picture as well. `None` behind a perspective camera, and of cameras that
    /// look around.
    pub fn place(&self, point: DVec3, size: [u32; 2]) -> Option<DVec2> {
        let (width, height) = (f64::from(size[0]), f64::from(size[1]));
        let to = point - self.eye;
        let depth = to.dot(self.forward);
        let away = match self.kind {
            CameraKind::Perspective { .. } if depth > 0.0 => depth,
            CameraKind::Orthographic { .. } => 1.0,
            _ => return None,
        };
        let pixels = height / (2.0 * self.half * away);
        let place = DVec2::new(to.dot(self.right), -to.dot(self.up)) * pixels;
        let shift = DVec2::new(-self.shift.x, self.shift.y) * (height / 2.0);
        let place = place + DVec2::new(width, height) / 2.0 + shift;
        place.is_finite().then_some(place)
    }

    /// The same of any camera, as far as its picture reaches: that of a fisheye ends at its circle, and of a
    /// panorama every point has a place. In these two what is straight in the world is not.
    pub fn seen_at(&self, point: DVec3, size: [u32; 2]) -> Option<DVec2> {
        let (width, height) = (f64::from(size[0]), f64::from(size[1]));
        if self.is_projective() {
            return self.place(point, size);
        }
        let to = (point - self.eye).try_normalize()?;
        let (x, y, z) = (to.dot(self.right), to.dot(self.up), to.dot(self.forward));
        if self.kind == CameraKind::Panorama {
            let turn = wide::atan2(x, z) / std::f64::consts::TAU + 0.5;
            let rise = wide::atan2(y, (x * x + z * z).sqrt()) / std::f64::consts::PI;
            // A full turn is none.
            let turn = if turn < 1.0 { turn } else { 0.0 };
            return Some(DVec2::new(turn * width, (0.5 - rise) * height));
        }
        let sin = (x * x + y * y).sqrt();
        let r = wide::atan2(sin, z) / self.half;
        // What is exactly behind is all around the circle.
        if r > 1.0 || (sin == 0.0 && z < 0.0) {
            return None;
        }
        let across = if sin > 0.0 { r / sin } else { 0.0 };
        let radius = width.min(height) / 2.0;
        let off = DVec2::new(x, -y) * (across * radius);
        Some(DVec2::new(width, height) / 2.0 + off)
    }

    /// The origin and the unit direction of [`Camera::ray`], neither of them rounded to f32.
    pub(crate) fn line(&self, place: DVec2, size: [u32; 2], lens: [f32; 2]) -> Option<[DVec3; 2]> {
        let (width, height) = (f64::from(size[0]), f64::from(size[1]));
        let dir = match self.kind {
            CameraKind::Perspective { .. } | CameraKind::Orthographic { .. } => {
                let lens = self.has_lens().then(|| concentric_disc(lens).map(f64::from));
                let [x, y] = on_screen(place.to_array(), size);
                let [origin, dir] = self.projective([x, y], lens);
                return Some([origin, dir].map(DVec3::from_array));
            }
            CameraKind::Fisheye { .. } => {
                let [x, y] = on_screen(place.to_array(), size);
                // The circle touches the nearer edges.
                let circle = (width / height).min(1.0);
                self.fisheye(x / circle, y / circle)?
            }
            CameraKind::Panorama => self.panorama(place.x / width - 0.5, 0.5 - place.y / height),
        };
        Some([self.eye, dir.normalize_or(self.forward)])
    }

    /// Whether all its rays have one direction.
    pub(crate) fn is_parallel(&self) -> bool {
        matches!(self.kind, CameraKind::Orthographic { .. })
    }

    /// Where it stands, in the world.
    pub(crate) fn eye(&self) -> DVec3 {
        self.eye
    }

    /// How many pixels lie side by side at distance 1 over a distance of 1, or anywhere of a camera whose
    /// rays are parallel, in a picture of `height` pixels. None of those that look around.
    pub(crate) fn pixels_across(&self, height: u32) -> Option<f64> {
        self.is_projective().then(|| f64::from(height) / (2.0 * self.half))
    }

    /// The cone about a ray of direction `dir` through a picture of `size` pixels, of each of which it is one of
    /// `samples`: as wide as what would be its share of the pixel.
    pub(crate) fn cone(&self, dir: Vec3, size: [u32; 2], samples: u32) -> Cone {
        let [width, height] = size.map(f64::from);
        let share = 1.0 / f64::from(samples.max(1)).sqrt();
        let pixel = 2.0 * self.half / height;
        let (width, spread) = match self.kind {
            // Of a pixel at distance 1 along the axis, which is further along the ray.
            CameraKind::Perspective { .. } => (0.0, pixel * dir.as_dvec3().dot(self.forward).abs()),
            CameraKind::Orthographic { .. } => (pixel, 0.0),
            CameraKind::Fisheye { .. } => (0.0, 2.0 * self.half / width.min(height)),
            CameraKind::Panorama => (0.0, std::f64::consts::PI / height),
        };
        Cone { width: (width * share) as f32, spread: (spread * share) as f32 }
    }

    /// Whether [`Camera::projective_rays`] draws its rays.
    pub(crate) fn is_projective(&self) -> bool {
        matches!(self.kind, CameraKind::Perspective { .. } | CameraKind::Orthographic { .. })
    }

    /// The rays of [`Camera::ray`] through eight places, of a camera that
    /// [is projective](Camera::is_projective); of one that [has a lens](Camera::has_lens) with places there.
    /// Places are [on screen](on_screen), x and y, in two halves.
    #[inline(always)]
    pub(crate) fn projective_rays<S: Simd>(
        &self,
        simd: S,
        [x, y]: [[f64x4<S>; 2]; 2],
        lens: Option<&[[f32; 8]; 2]>,
        to: &mut Rays8,
    ) {
        let [low_lens, high_lens] = match lens {
            Some(lens) => {
                let [u, v] = lens;
                let place = [f32x8::load_array_ref(simd, u), f32x8::load_array_ref(simd, v)];
                let [x, y] = concentric_disc(place);
                let (x, y) = (x.widen(), y.widen());
                [Some([x.0, y.0]), Some([x.1, y.1])]
            }
            None => [None, None],
        };
        let [low_o, low] = self.projective([x[0], y[0]], low_lens);
        let [high_o, high] = self.projective([x[1], y[1]], high_lens);
        for axis in 0..3 {
            to.origin[axis] = whole(low_o[axis], high_o[axis]);
            to.dir[axis] = low[axis].narrow(high[axis]).into();
        }
        (to.t_min, to.t_max, to.there) = (Rays8::NONE.t_min, Rays8::NONE.t_max, 0xff);
    }

    /// Origin and unit direction of the ray through a place of a projective picture, [on
    /// screen](on_screen). `lens`: a point of the unit disc; the ray starts there on the lens, and meets
    /// the plane of focus where it would have from the middle.
    #[inline(always)]
    fn projective<F: Lanes<Scalar = f64>>(
        &self,
        [x, y]: [F; 2],
        lens: Option<[F; 2]>,
    ) -> [[F; 3]; 2] {
        let Self { eye, right, up, forward, half, aperture, focus, shift, .. } = *self;
        // To add 0 would take the sign of −0.
        let [x, y] = if shift == DVec2::ZERO { [x, y] } else { [x + shift.x, y + shift.y] };
        let off = [
            (x * right.x + y * up.x) * half,
            (x * right.y + y * up.y) * half,
            (x * right.z + y * up.z) * half,
        ];
        let like = |v: DVec3| splat3(x, v.to_array());
        let moved = |by: DVec3| [off[0] + by.x, off[1] + by.y, off[2] + by.z];
        let (mut origin, mut dir) = match self.kind {
            CameraKind::Orthographic { .. } => (moved(eye), like(forward)),
            _ => (like(eye), moved(forward)),
        };
        if let Some([u, v]) = lens {
            let shift = [
                (u * right.x + v * up.x) * aperture,
                (u * right.y + v * up.y) * aperture,
                (u * right.z + v * up.z) * aperture,
            ];
            origin = [origin[0] + shift[0], origin[1] + shift[1], origin[2] + shift[2]];
            dir = [dir[0] * focus - shift[0], dir[1] * focus - shift[1], dir[2] * focus - shift[2]];
        }
        let [x, y, z] = dir;
        let inverse = x.splat(1.0) / (x * x + y * y + z * z).sqrt();
        [origin, [x * inverse, y * inverse, z * inverse]]
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
}

/// A place from the middle of a picture of `size` pixels, in half heights; y up.
#[inline(always)]
pub(crate) fn on_screen<F: Lanes<Scalar = f64>>([x, y]: [F; 2], size: [u32; 2]) -> [F; 2] {
    [across_screen(x, size), up_screen(y, size)]
}

/// The same of x alone.
#[inline(always)]
pub(crate) fn across_screen<F: Lanes<Scalar = f64>>(x: F, [width, height]: [u32; 2]) -> F {
    (x * 2.0 + -f64::from(width)) / f64::from(height)
}

/// The same of y alone.
#[inline(always)]
pub(crate) fn up_screen<F: Lanes<Scalar = f64>>(y: F, [_, height]: [u32; 2]) -> F {
    (y * -2.0 + f64::from(height)) / f64::from(height)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: [u32; 2] = [40, 20];
    const MIDDLE: [f32; 2] = [0.5, 0.5];

    #[test]
    fn a_point_is_seen_where_the_ray_to_it_goes_of_a_shifted_picture_as_well() {
        let kinds =
            [CameraKind::Perspective { fov: 37.0 }, CameraKind::Orthographic { height: 4.0 }];
        for kind in kinds {
            let shift = DVec2::new(0.3, -0.2);
            let camera = Camera::new(&phong_scene::Camera { shift, ..camera(kind) });
            let place = camera.place(DVec3::new(0.4, 0.3, 1.0), SIZE).unwrap();
            let [origin, dir] = camera.line(place, SIZE, MIDDLE).unwrap();
            let to = DVec3::new(0.4, 0.3, 1.0) - origin;
            assert!(to.normalize_or_zero().distance(dir) < 1e-12, "{kind:?}");
        }
        // What it looks at is three tenths of the height left of the middle.
        let kind = CameraKind::Perspective { fov: 37.0 };
        let shifted = phong_scene::Camera { shift: DVec2::new(0.3, 0.0), ..camera(kind) };
        let place = Camera::new(&shifted).place(DVec3::ZERO, SIZE).unwrap();
        assert!((place - DVec2::new(14.0, 10.0)).length() < 1e-12);
    }

    #[test]
    fn what_is_in_focus_is_at_the_same_place_for_both_eyes() {
        let middle = camera(CameraKind::Perspective { fov: 50.0 });
        let places = [-0.1, 0.1].map(|by| {
            let eye = Camera::new(&middle.beside(by).unwrap());
            [DVec3::new(0.5, 0.2, 0.0), DVec3::new(0.5, 0.2, 1.0)]
                .map(|point| eye.place(point, SIZE).unwrap())
        });
        assert!((places[0][0] - places[1][0]).length() < 1e-12, "{places:?}");
        assert!(places[0][1].x > places[1][1].x, "what is nearer is to the right of the left eye");
        assert_eq!(places[0][1].y, places[1][1].y, "never above one another");
    }

    fn camera(kind: CameraKind) -> phong_scene::Camera {
        phong_scene::Camera {
            kind,
            eye: DVec3::new(0.0, 0.0, 5.0),
            look_at: DVec3::ZERO,
            up: DVec3::Y,
            aperture: 0.0,
            focus: None,
            shift: DVec2::ZERO,
        }
    }

    fn dir(kind: CameraKind, x: f64, y: f64) -> Vec3 {
        let camera = Camera::new(&camera(kind));
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
    fn eight_projective_rays_have_the_bits_of_one() {
        let simd = fearless_simd::Fallback::new();
        let kinds =
            [CameraKind::Perspective { fov: 37.0 }, CameraKind::Orthographic { height: 4.0 }];
        for (kind, aperture) in kinds.into_iter().flat_map(|kind| [(kind, 0.0), (kind, 0.3)]) {
            let eye = DVec3::new(1.0, 2.5, 8.1);
            let camera = phong_scene::Camera { eye, aperture, ..camera(kind) };
            let camera = Camera::new(&camera);
            for i in 0..6 {
                let place = |lane: usize| DVec2::new(0.93, 0.41) * (8 * i + lane) as f64;
                let column = |axis: usize, from: usize| -> f64x4<_> {
                    let at = |k: usize| place(from + k)[axis];
                    [at(0), at(1), at(2), at(3)].simd_into(simd)
                };
                let places = [[column(0, 0), column(0, 4)], [column(1, 0), column(1, 4)]];
                let on_lens = |lane: usize| [0.5 - 0.06 * lane as f32, 0.5 + 0.08 * i as f32];
                let lens = [0, 1].map(|axis| std::array::from_fn(|lane| on_lens(lane)[axis]));
                let lens8 = camera.has_lens().then_some(&lens);
                let [x, y] = places;
                let [low, high] = [on_screen([x[0], y[0]], SIZE), on_screen([x[1], y[1]], SIZE)];
                let places = [[low[0], high[0]], [low[1], high[1]]];
                let mut rays = Rays8::NONE;
                camera.projective_rays(simd, places, lens8, &mut rays);
                for lane in 0..8 {
                    let one = camera.ray(place(lane), SIZE, on_lens(lane));
                    assert_eq!(Some(rays.get(lane)), one, "{kind:?}, {aperture}");
                }
            }
        }
    }

    #[test]
    fn a_point_on_a_ray_is_seen_where_the_ray_starts_in_the_picture() {
        for kind in
            [CameraKind::Perspective { fov: 37.0 }, CameraKind::Orthographic { height: 4.0 }]
        {
            let eye = DVec3::new(1.0, 2.5, 8.1);
            let camera = Camera::new(&phong_scene::Camera { eye, ..camera(kind) });
            for place in [DVec2::new(20.0, 10.0), DVec2::new(0.0, 0.0), DVec2::new(31.7, 2.2)] {
                let [origin, dir] = camera.line(place, SIZE, MIDDLE).unwrap();
                let seen = camera.place(origin + 7.5 * dir, SIZE).unwrap();
                assert!((seen - place).length() < 1e-9, "{kind:?}: {seen}");
            }
        }
        let perspective = Camera::new(&camera(CameraKind::Perspective { fov: 37.0 }));
        assert_eq!(perspective.place(DVec3::new(0.0, 0.0, 6.0), SIZE), None, "behind the eye");
        let around = Camera::new(&camera(CameraKind::Panorama));
        assert_eq!(around.place(DVec3::ZERO, SIZE), None);
    }

    #[test]
    fn cameras_that_look_around_see_a_point_on_a_ray_where_it_starts() {
        let kinds = [180.0, 300.0].map(|fov| CameraKind::Fisheye { fov });
        for kind in kinds.into_iter().chain([CameraKind::Panorama]) {
            let eye = DVec3::new(1.0, 2.5, 8.1);
            let made = Camera::new(&phong_scene::Camera { eye, ..camera(kind) });
            let places = [[20.0, 10.0], [12.5, 9.5], [20.0, 18.5], [27.1, 13.3]];
            for place in places.map(DVec2::from_array) {
                for size in [SIZE, [32, 48]] {
                    let [origin, dir] = made.line(place, size, MIDDLE).unwrap();
                    let seen = made.seen_at(origin + 7.5 * dir, size).unwrap();
                    assert!((seen - place).length() < 1e-9, "{kind:?}: {seen} for {place}");
                }
            }
            assert_eq!(made.seen_at(eye, SIZE), None, "where it stands nothing is seen");
        }
        let fisheye = Camera::new(&camera(CameraKind::Fisheye { fov: 180.0 }));
        assert_eq!(fisheye.seen_at(DVec3::new(0.0, 1.0, 6.0), SIZE), None, "behind it");
        let panorama = Camera::new(&camera(CameraKind::Panorama));
        let behind = panorama.seen_at(DVec3::new(0.0, 0.0, 9.0), SIZE).unwrap();
        assert_eq!(behind.x % 40.0, 0.0);
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
        let camera = Camera::new(&camera(CameraKind::Orthographic { height: 4.0 }));
        let ray = camera.ray(DVec2::new(20.0, 0.0), SIZE, MIDDLE).unwrap();
        assert_eq!((ray.origin, ray.dir), (DVec3::new(0.0, 2.0, 5.0), -Vec3::Z));
    }

    #[test]
    fn the_image_circle_touches_the_nearer_edges() {
        let d = dir(CameraKind::Fisheye { fov: 180.0 }, 30.0, 10.0);
        assert!((d - Vec3::X).length() < 1e-6, "90° off at the circle's edge");
        let camera = Camera::new(&camera(CameraKind::Fisheye { fov: 180.0 }));
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
        let camera = Camera::new(&lens);
        let at_focus = |lens| {
            let ray = camera.ray(DVec2::new(7.0, 3.0), SIZE, lens).unwrap();
            ray.at((2.0 - ray.origin.z) as f32 / ray.dir.z)
        };
        let sharp = at_focus(MIDDLE);
        for lens in [[0.0, 0.0], [0.9, 0.2], [0.5, 0.99]] {
            assert!((at_focus(lens) - sharp).length() < 1e-5);
        }
        let pinhole = camera.ray(DVec2::new(7.0, 3.0), SIZE, [0.0, 0.5]).unwrap();
        assert!((pinhole.origin.x.abs() - 0.5).abs() < 1e-6, "the lens has the aperture's radius");
    }
}
