//! The gradient behind everything.

use glam::DVec3;

use super::texture::rgb;
use crate::camera::{Camera, CameraKind};
use crate::color::Rgb;

/// A background between two colours.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gradient {
    /// Whether directions count, and not the places that rays start from.
    pub(super) sphere: bool,
    pub(super) up: DVec3,
    /// Where along `up` the colours are reached: the top one's, the bottom one's.
    pub(super) values: [f64; 2],
    /// At the top, at the bottom.
    pub(super) colors: [[f32; 3]; 2],
}

impl Gradient {
    /// The colours at the upper and the lower edge of the picture, in its middle.
    pub(super) fn colors(&self, camera: &Camera) -> [Rgb; 2] {
        let view = (camera.look_at - camera.eye).normalize_or(DVec3::NEG_Z);
        let right = view.cross(camera.up).normalize_or(DVec3::X);
        let up = right.cross(view);
        let [above, below] = [1.0, -1.0].map(|side| {
            let (start, direction) = match camera.kind {
                CameraKind::Perspective { fov } => {
                    let height = libm::tan(0.5 * fov.to_radians());
                    (camera.eye, view + side * height * up)
                }
                CameraKind::Orthographic { height } => {
                    (camera.eye + 0.5 * side * height * up, view)
                }
                CameraKind::Fisheye { fov } => {
                    let angle = 0.5 * fov.to_radians();
                    (camera.eye, libm::cos(angle) * view + side * libm::sin(angle) * up)
                }
                CameraKind::Panorama => (camera.eye, side * up),
            };
            if self.sphere { direction.normalize_or(view) } else { start }
        });
        let [top, bottom] = self.colors.map(rgb);
        [above, below].map(|along| {
            let [high, low] = self.values;
            let share = (along.dot(self.up) - low) / (high - low);
            let share = if share.is_finite() { share.clamp(0.0, 1.0) as f32 } else { 1.0 };
            top * share + bottom * (1.0 - share)
        })
    }
}
