//! The camera block.

use glam::{DVec3, Vec3};

use crate::camera::{Camera, CameraKind};
use crate::format::text::{Parsed, Words};

/// The radius of the lens as a share of aperture, distance and height. It fits the blur of Tachyon 0.99's
/// own pictures in two of three trials, so it is a rough one.
pub(super) const LENS: f64 = 0.58;

/// How directions become pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Projection {
    Perspective,
    Lens,
    Orthographic,
    Fisheye,
    /// One that is drawn in perspective instead.
    Other,
}

/// What the camera block says.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    projection: Projection,
    zoom: f64,
    aspect: f64,
    pub(super) antialiasing: u64,
    pub(super) depth: u64,
    center: DVec3,
    view: DVec3,
    up: DVec3,
    /// The distance that is sharp, and the size of the lens as a share of the picture there.
    lens: [f64; 2],
    /// Left, right, bottom and top of the picture at distance 1.
    frustum: Option<[f64; 4]>,
}

impl Frame {
    /// Reads the block behind its name.
    pub(super) fn read(words: &mut Words<'_>) -> Parsed<Self> {
        let mut frame = Self {
            projection: Projection::Perspective,
            zoom: 1.0,
            aspect: 1.0,
            antialiasing: 0,
            depth: 6,
            center: DVec3::ZERO,
            view: DVec3::NEG_Z,
            up: DVec3::Y,
            lens: [1.0, 0.0],
            frustum: None,
        };
        loop {
            let word = words.some("`END_CAMERA`")?;
            let is = |key: &str| word.eq_ignore_ascii_case(key.as_bytes());
            if is("END_CAMERA") {
                return Ok(frame);
            } else if is("PROJECTION") {
                let kind = words.some("a projection")?;
                let is = |key: &str| kind.eq_ignore_ascii_case(key.as_bytes());
                frame.projection = match () {
                    () if is("PERSPECTIVE") => Projection::Perspective,
                    () if is("PERSPECTIVE_DOF") => Projection::Lens,
                    () if is("ORTHOGRAPHIC") => Projection::Orthographic,
                    () if is("FISHEYE") => Projection::Fisheye,
                    () => Projection::Other,
                };
            } else if is("ZOOM") {
                frame.zoom = words.number()?.into();
            } else if is("ASPECTRATIO") {
                frame.aspect = words.number()?.into();
            } else if is("ANTIALIASING") {
                frame.antialiasing = words.whole()?;
            } else if is("RAYDEPTH") {
                frame.depth = words.whole()?;
            } else if is("FOCALLENGTH") || is("FOCALDIST") {
                frame.lens[0] = words.number()?.into();
            } else if is("APERTURE") {
                frame.lens[1] = words.number()?.into();
            } else if is("CENTER") {
                frame.center = words.vector()?.as_dvec3();
            } else if is("VIEWDIR") {
                frame.view = words.vector()?.as_dvec3();
            } else if is("UPDIR") {
                frame.up = words.vector()?.as_dvec3();
            } else if is("FRUSTUM") {
                let [left, right, bottom] = words.three()?.map(f64::from);
                frame.frustum = Some([left, right, bottom, words.number()?.into()]);
            } else {
                return Err(Words::wrong_word(word, "a key of the camera"));
            }
        }
    }

    /// The camera, and what of it is not the same.
    pub(super) fn camera(&self) -> (Camera, Vec<String>) {
        let mut told = Vec::new();
        let sound = |number: f64, else_: f64| if number > 0.0 { number } else { else_ };
        let zoom = sound(self.zoom, 1.0).clamp(1e-6, 1e6);
        let mut center = self.center;
        let view = self.view.normalize_or(DVec3::NEG_Z);
        let up = self.up.normalize_or(DVec3::Y);
        if (self.aspect - 1.0).abs() > 1e-4 {
            told.push(format!("pixels are square here, and not of the aspect {}", self.aspect));
        }
        let mut height = 1.0 / zoom;
        if let Some([left, right, bottom, top]) = self.frustum {
            let uneven = (left + right).abs().max((bottom + top).abs());
            height = sound((top - bottom).abs(), height);
            if uneven > 1e-4 * height && self.projection == Projection::Orthographic {
                let to_right = view.cross(up).normalize_or_zero();
                let to_top = to_right.cross(view);
                center += 0.5 * ((left + right) * to_right + (bottom + top) * to_top);
            } else if uneven > 1e-4 * height {
                told.push("the picture is in the middle of the view, and not beside it".to_owned());
            }
        }
        let fov = |height: f64| {
            let half = libm::atan(0.5 * height).to_degrees();
            (2.0 * half).clamp(1e-3, 179.0)
        };
        let distance = sound(self.lens[0], 1.0);
        let kind = match self.projection {
            Projection::Perspective | Projection::Lens => {
                CameraKind::Perspective { fov: fov(height) }
            }
            Projection::Orthographic => CameraKind::Orthographic { height },
            Projection::Fisheye => {
                told.push("the fisheye is equidistant, and not quite the format's".to_owned());
                CameraKind::Fisheye { fov: height.to_degrees().clamp(1.0, 360.0) }
            }
            Projection::Other => {
                told.push(
                    "the projection is none that is known; it is drawn in perspective".to_owned(),
                );
                CameraKind::Perspective { fov: fov(height) }
            }
        };
        let mut camera =
            Camera { kind, eye: center, look_at: center + view, up, ..Camera::default() };
        if self.projection == Projection::Lens && self.lens[1] > 0.0 {
            camera.aperture = LENS * self.lens[1] * distance * height;
            camera.focus = Some(distance);
        }
        (camera, told)
    }

    /// Where the eye is.
    pub(super) fn eye(&self) -> Vec3 {
        self.center.as_vec3()
    }
}
