//! `[image]`, `[camera]` and `[ambient]`.

use super::notes::Notes;
use super::table::Values;
use crate::camera::{Camera, CameraKind};
use crate::check::settings as judge;
use crate::scene::{FilterKind, Image};

/// Below this many degrees a field of view is more likely one in radians, which end at π.
const RADIANS: f64 = 3.0;

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
        min_weight: v.number("min_weight")? as f32,
        terminator: v.flag("terminator")?,
    })
}

/// `[camera]`; says if it looks nowhere.
pub(super) fn camera(v: &Values, notes: &mut Notes) -> Option<Camera> {
    let (eye, look_at, up) = (v.vector("eye")?, v.vector("look_at")?, v.vector("up")?);
    let kind = match v.word("kind")? {
        "orthographic" => CameraKind::Orthographic { height: v.number("height")? },
        "fisheye" => CameraKind::Fisheye { fov: v.number("fov")? },
        "panorama" => CameraKind::Panorama,
        _ => CameraKind::Perspective { fov: v.number("fov")? },
    };
    let aperture = v.number("aperture").unwrap_or(0.0);
    let camera = Camera { kind, eye, look_at, up, aperture, focus: v.number("focus") };
    if let CameraKind::Perspective { fov } | CameraKind::Fisheye { fov } = kind
        && fov < RADIANS
        && v.has("fov")
    {
        let message = format!("a `fov` of {fov} degrees is very narrow: are these radians?");
        let degrees = (10.0 * fov.to_degrees()).round() / 10.0;
        let help = format!("`fov` is in degrees; {fov} radians are {degrees} of them");
        notes.warning(v.spot_of("fov"), message).help = Some(help);
    }
    let sound = notes.judge(|key| v.spot_of(key), |faults| judge::camera(&camera, faults));
    sound.then_some(camera)
}
