//! `[image]`, `[camera]` and `[ambient]`.

use super::notes::Notes;
use super::table::Values;
use crate::camera::{Camera, CameraKind};
use crate::scene::{FilterKind, Image};

/// `[image]`; what is wrong with it has been said.
pub(super) fn image(v: &Values) -> Option<Image> {
    Some(Image {
        size: v.size("size")?,
        samples: v.integer("samples")? as u32,
        background: v.background("background")?,
        filter: match v.word("filter")? {
            "tent" => FilterKind::Tent,
            "gaussian" => FilterKind::Gaussian,
            "mitchell" => FilterKind::Mitchell,
            _ => FilterKind::Box,
        },
        seed: v.integer("seed")?,
        depth: v.integer("depth")? as u32,
    })
}

/// `[camera]`; says if it looks nowhere.
pub(super) fn camera(v: &Values, notes: &mut Notes) -> Option<Camera> {
    let (eye, look_at, up) = (v.vector("eye")?, v.vector("look_at")?, v.vector("up")?);
    let Some(forward) = (look_at - eye).try_normalize() else {
        let help = "the camera looks from `eye` to `look_at`; they must differ";
        notes.error(v.spot_of("look_at"), "`look_at` is where the eye is").help =
            Some(help.to_owned());
        return None;
    };
    // Below a millionth of a degree, "up" is decided by rounding.
    let sideways = up.try_normalize().map_or(0.0, |up| forward.cross(up).length());
    if sideways < 1e-8 {
        let help = "`up` must point elsewhere than the camera looks; try `up = [0, 0, 1]`";
        let help = if forward.z.abs() > 0.9 {
            help.replace("0, 0, 1", "0, 1, 0")
        } else {
            help.to_owned()
        };
        notes.error(v.spot_of("up"), "`up` is parallel to the view").help = Some(help);
        return None;
    }
    let kind = match v.word("kind")? {
        "orthographic" => CameraKind::Orthographic { height: v.number("height")? },
        "fisheye" => CameraKind::Fisheye { fov: v.number("fov")? },
        "panorama" => CameraKind::Panorama,
        _ => CameraKind::Perspective { fov: v.number("fov")? },
    };
    let aperture = v.number("aperture").unwrap_or(0.0);
    Some(Camera { kind, eye, look_at, up, aperture, focus: v.number("focus") })
}
