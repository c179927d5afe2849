//! The keys of a camera's way.

use super::{Default, Key, Kind, Table, VERSION};
use crate::camera::CameraKind;
use crate::limits::Range;

/// A file with a camera's way as a whole.
pub(crate) static CAMERA_PATH: Table = Table {
    name: "path",
    doc: "A way that the camera goes.",
    select: None,
    keys: &[&[
        VERSION,
        Key::new(
            "pictures",
            Kind::Integer(1, 1_000_000),
            Default::Required,
            "Pictures at even times from the first key to the last, both counted.",
        ),
        Key::new(
            "key",
            Kind::Tables(&CAMERA_KEY),
            Default::Required,
            "Where the camera is at which time; two at least.",
        ),
    ]],
};

/// `[[key]]`.
pub(crate) static CAMERA_KEY: Table = Table {
    name: "key",
    doc: "Where the camera is at one time.",
    select: None,
    keys: &[&[
        Key::new(
            "time",
            Kind::Number(Range::NOT_NEGATIVE),
            Default::Required,
            "When it is there, in any unit; later than the key before.",
        ),
        Key::new("eye", Kind::Point, Default::Required, "Position of the eye, in scene units."),
        Key::new(
            "look_at",
            Kind::Point,
            Default::Required,
            "The point in the middle of the picture.",
        ),
        Key::new(
            "up",
            Kind::Direction,
            Default::Vector([0.0, 1.0, 0.0]),
            "The direction that points up in the picture; any length.",
        ),
        Key::new(
            "fov",
            Kind::Number(CameraKind::PERSPECTIVE),
            Default::Said("the camera's own"),
            "Vertical field of view of a perspective camera, degrees.",
        ),
        Key::new(
            "height",
            Kind::Number(Range::POSITIVE),
            Default::Said("the camera's own"),
            "The picture's height of an orthographic camera, scene units.",
        ),
    ]],
};
