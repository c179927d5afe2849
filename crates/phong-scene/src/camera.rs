//! The camera: where the eye is, what it looks at, and how directions become pixels.
//!
//! ```toml
//! [camera]
//! kind = "perspective"            # or orthographic, fisheye, panorama
//! eye = [0, 2, 8]
//! look_at = [0, 1, 0]
//! fov = 40
//! ```
//!
//! | key | value | default | meaning |
//! |---|---|---|---|
//! | `kind` | `perspective`, `orthographic`, `fisheye` or `panorama` | `"perspective"` | The projection. |
//! | `eye` | three numbers, `[x, y, z]` | required | Position of the eye, in scene units. |
//! | `look_at` | three numbers, `[x, y, z]` | required | The point in the middle of the picture. |
//! | `up` | three numbers, `[x, y, z]`, not all 0 | `[0, 1, 0]` | The direction that points up in the picture; any length. |
//! | `fov` (perspective) | a number above 0 and below 180 | `40` | Vertical field of view, degrees. |
//! | `height` (orthographic) | a number above 0 | required | The picture's height in scene units. |
//! | `fov` (fisheye) | a number above 0 up to 360 | `180` | Full angle of the image circle, degrees; it touches the nearer edges. |
//! | `aperture` (perspective, orthographic) | a number 0 or above | `0` | Radius of the lens in scene units; 0 is a pinhole. |
//! | `focus` (perspective, orthographic) | a number above 0 | the distance of `look_at` | Distance along forward that is sharp. |
//! | `shift` (perspective, orthographic) | two numbers, `[x, y]` | `[0, 0]` | How far the picture is shifted in its plane, to the right and up, in heights of the picture: `look_at` is so far beside its middle, and upright lines stay upright. |

use glam::{DVec2, DVec3};

use crate::limits::Range;
use crate::wording::words;

/// Where the picture is taken from.
///
/// Right-handed: forward = `look_at − eye`, right = forward × up, image up = right × forward.
/// The three are finite, `eye ≠ look_at`, and `up` is not parallel to the view.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// The projection.
    pub kind: CameraKind,
    /// Position of the eye, in scene units.
    pub eye: DVec3,
    /// The point in the middle of the picture.
    pub look_at: DVec3,
    /// The direction that points up in the picture; any length.
    pub up: DVec3,
    /// Radius of the lens in scene units; 0 is a pinhole (everything sharp).
    pub aperture: f64,
    /// Distance along forward that is sharp; `None`: the distance of `look_at`.
    pub focus: Option<f64>,
    /// How far the picture is shifted in its plane, to the right and up, in heights of the picture. Of
    /// perspective and orthographic cameras. Default not at all.
    pub shift: DVec2,
}

impl Camera {
    /// The camera of one eye: so far to the right, or below 0 to the left, along its own right, and with the
    /// picture shifted so that what is in focus stays at its place. Both eyes look the same way. `None`: of a
    /// camera that is not perspective.
    ///
    /// ```
    /// use glam::DVec3;
    /// use phong_scene::Camera;
    /// let right = Camera::default().beside(0.1).expect("perspective");
    /// assert_eq!((right.eye, right.look_at), (DVec3::new(0.1, 0.0, 5.0), DVec3::new(0.1, 0.0, 0.0)));
    /// assert!(right.shift.x < 0.0);
    /// ```
    #[must_use]
    pub fn beside(&self, by: f64) -> Option<Self> {
        let CameraKind::Perspective { fov } = self.kind else { return None };
        let right = (self.look_at - self.eye).cross(self.up).try_normalize()?;
        let height = 2.0 * libm::tan(fov.to_radians() / 2.0) * self.focus_distance();
        let shift = DVec2::new(self.shift.x - by / height, self.shift.y);
        let [eye, look_at] = [self.eye, self.look_at].map(|point| point + by * right);
        Some(Self { eye, look_at, shift, ..self.clone() })
    }

    /// How far along its axis the camera is focused.
    pub fn focus_distance(&self) -> f64 {
        self.focus.unwrap_or((self.look_at - self.eye).length())
    }

    /// The camera after `step` of `steps` equal steps once around what it looks at, about the axis through
    /// `look_at` that points along `axis`: to its right where that is its up. All that it sees stays the
    /// same but the side; `step` 0 is the camera itself.
    ///
    /// ```
    /// use glam::DVec3;
    /// use phong_scene::Camera;
    /// let front = Camera::default();
    /// assert_eq!(front.turned(DVec3::Y, 1, 4).eye, DVec3::new(5.0, 0.0, 0.0));
    /// assert_eq!(front.turned(DVec3::Y, 6, 6), front);
    /// ```
    #[must_use]
    pub fn turned(&self, axis: DVec3, step: u32, steps: u32) -> Self {
        let (step, steps) = (u64::from(step), u64::from(steps.max(1)));
        let step = step % steps;
        if step == 0 {
            return self.clone();
        }
        let axis = axis.normalize_or(DVec3::Y);
        // Quarters are exact.
        let (sin, cos) = match (4 * step % steps, 4 * step / steps) {
            (0, 1) => (1.0, 0.0),
            (0, 2) => (0.0, -1.0),
            (0, _) => (-1.0, 0.0),
            _ => libm::sincos(std::f64::consts::TAU * step as f64 / steps as f64),
        };
        // By how much a direction changes: nothing along the axis.
        let change = |v: DVec3| {
            let across = v - axis * axis.dot(v);
            across * (cos - 1.0) + axis.cross(across) * sin
        };
        let along = self.up.cross(axis).length() <= 1e-12 * self.up.length();
        let up = if along { self.up } else { self.up + change(self.up) };
        Self { eye: self.eye + change(self.eye - self.look_at), up, ..self.clone() }
    }
}

impl Default for Camera {
    /// From (0, 0, 5) towards the origin, Y up, with a pinhole.
    fn default() -> Self {
        Self {
            kind: CameraKind::default(),
            eye: DVec3::new(0.0, 0.0, 5.0),
            look_at: DVec3::ZERO,
            up: DVec3::Y,
            aperture: 0.0,
            focus: None,
            shift: DVec2::ZERO,
        }
    }
}

/// How directions become pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CameraKind {
    /// Straight lines stay straight. `fov` is the vertical angle in degrees, in (0, 180).
    Perspective {
        /// Vertical field of view, degrees.
        fov: f64,
    },
    /// Parallel rays. `height` is the picture's height in scene units, > 0.
    Orthographic {
        /// The picture's height in scene units.
        height: f64,
    },
    /// Equidistant fisheye; `fov` is the full angle of the image circle in degrees, in (0, 360].
    Fisheye {
        /// Full angle of the image circle, degrees.
        fov: f64,
    },
    /// Equirectangular, 360° × 180°, forward in the middle.
    Panorama,
}

impl CameraKind {
    /// The angles of a perspective camera, degrees.
    pub(crate) const PERSPECTIVE: Range = Range::open(0.0, 180.0);
    /// The angles of a fisheye's image circle, degrees.
    pub(crate) const FISHEYE: Range = Range::above(0.0, 360.0);
}

words!(CameraKind {
    "perspective" = Perspective { fov: 40.0 },
    "orthographic" = Orthographic { height: 1.0 },
    "fisheye" = Fisheye { fov: 180.0 },
    "panorama" = Panorama,
});

impl Default for CameraKind {
    /// Perspective, 40° high.
    fn default() -> Self {
        Self::Perspective { fov: 40.0 }
    }
}
