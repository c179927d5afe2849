//! The camera: where the eye is, what it looks at, and how directions become pixels.

use glam::DVec3;

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
