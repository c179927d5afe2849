//! The camera's keys.

use super::{Default, Key, Kind, Table};
use crate::camera::CameraKind;
use crate::limits::Range;

/// `[camera]`.
pub(crate) static CAMERA: Table = Table {
    name: "camera",
    doc: "Where the picture is taken from.",
    select: Some("kind"),
    keys: &[&[
        Key::new(
            "kind",
            Kind::Word(&["perspective", "orthographic", "fisheye", "panorama"]),
            Default::Word("perspective"),
            "The projection.",
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
            Default::Number(40.0),
            "Vertical field of view, degrees.",
        )
        .only(&["perspective"]),
        Key::new(
            "height",
            Kind::Number(Range::POSITIVE),
            Default::Required,
            "The picture's height in scene units.",
        )
        .only(&["orthographic"]),
        Key::new(
            "fov",
            Kind::Number(CameraKind::FISHEYE),
            Default::Number(180.0),
            "Full angle of the image circle, degrees; it touches the nearer edges.",
        )
        .only(&["fisheye"]),
        Key::new(
            "aperture",
            Kind::Number(Range::NOT_NEGATIVE),
            Default::Number(0.0),
            "Radius of the lens in scene units; 0 is a pinhole.",
        )
        .only(&["perspective", "orthographic"]),
        Key::new(
            "focus",
            Kind::Number(Range::POSITIVE),
            Default::Said("the distance of `look_at`"),
            "Distance along forward that is sharp.",
        )
        .only(&["perspective", "orthographic"]),
    ]],
};
