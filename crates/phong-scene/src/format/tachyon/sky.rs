//! The gradient behind everything, and fog before it.

use glam::DVec3;

use super::texture::rgb;
use crate::camera::{Camera, CameraKind};
use crate::color::Rgb;
use crate::fog::{Fog, FogDistance, FogKind};
use crate::format::text::{Parsed, Words};

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

/// Fog as the file says it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Haze {
    kind: Growth,
    start: f64,
    end: f64,
    density: f64,
    color: [f32; 3],
}

/// How fog grows with the distance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Growth {
    Off,
    Linear,
    Exponential,
    Squared,
}

impl Haze {
    /// Reads what stands behind `FOG`.
    pub(super) fn read(words: &mut Words<'_>) -> Parsed<Self> {
        let mut kind = Growth::Off;
        while !words.has("START") {
            let word = words.some("`START`")?;
            let is = |key: &str| word.eq_ignore_ascii_case(key.as_bytes());
            kind = match () {
                () if is("LINEAR") => Growth::Linear,
                () if is("EXP") => Growth::Exponential,
                () if is("EXP2") => Growth::Squared,
                () if is("OFF") => Growth::Off,
                () => kind,
            };
        }
        let start = words.number()?.into();
        let end = words.keyed_number("END")?.into();
        let density = words.keyed_number("DENSITY")?.into();
        words.key("COLOR")?;
        Ok(Self { kind, start, end, density, color: words.three()? })
    }

    /// The fog, if there is some, and whether it begins elsewhere than in the file.
    pub(super) fn fog(&self, planar: bool) -> (Option<Fog>, bool) {
        let Self { kind, start, end, density, color } = *self;
        let sound = |number: f64| number > 0.0 && number <= crate::limits::LARGEST;
        let kind = match kind {
            Growth::Linear if sound(end) && end > start => {
                FogKind::Linear { start: start.max(0.0), end }
            }
            Growth::Exponential if sound(density) => FogKind::Exponential { density },
            Growth::Squared if sound(density) => FogKind::Squared { density },
            _ => return (None, false),
        };
        let distance = if planar { FogDistance::Planar } else { FogDistance::Radial };
        let moved = match kind {
            FogKind::Linear { .. } => start < 0.0,
            _ => start != 0.0,
        };
        (Some(Fog { kind, color: Some(rgb(color)), distance, strength: 1.0 }), moved)
    }
}
