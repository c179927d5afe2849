//! The camera's keys.

use super::field::{field, keyed};
use super::{Default, Key, Kind, Table};
use crate::camera::{Camera, CameraKind};
use crate::limits::Range;
use crate::wording::Word;

keyed!(Camera, |_| &CAMERA);

/// `[camera]`.
pub(crate) static CAMERA: Table = Table {
    name: "camera",
    doc: "Where the picture is taken from.",
    select: Some("kind"),
    keys: &[&[
        Key::new(
            "kind",
            Kind::Word(CameraKind::WORDS),
            Default::Word("perspective"),
            "The projection.",
        )
        .of(field!(Camera.kind)),
        Key::new("eye", Kind::Point, Default::Required, "Position of the eye, in scene units.")
            .of(field!(Camera.eye)),
        Key::new(
            "look_at",
            Kind::Point,
            Default::Required,
            "The point in the middle of the picture.",
        )
        .of(field!(Camera.look_at)),
        Key::new(
            "up",
            Kind::Direction,
            Default::Vector([0.0, 1.0, 0.0]),
            "The direction that points up in the picture; any length.",
        )
        .of(field!(Camera.up)),
        Key::new(
            "fov",
            Kind::Number(CameraKind::PERSPECTIVE),
            Default::Number(40.0),
            "Vertical field of view, degrees.",
        )
        .of(field!(Camera.kind = CameraKind::{Perspective}.fov))
        .only(&["perspective"]),
        Key::new(
            "height",
            Kind::Number(Range::POSITIVE),
            Default::Required,
            "The picture's height in scene units.",
        )
        .of(field!(Camera.kind = CameraKind::{Orthographic}.height))
        .only(&["orthographic"]),
        Key::new(
            "fov",
            Kind::Number(CameraKind::FISHEYE),
            Default::Number(180.0),
            "Full angle of the image circle, degrees; it touches the nearer edges.",
        )
        .of(field!(Camera.kind = CameraKind::{Fisheye}.fov))
        .only(&["fisheye"]),
        Key::new(
            "aperture",
            Kind::Number(Range::NOT_NEGATIVE),
            Default::Number(0.0),
            "Radius of the lens in scene units; 0 is a pinhole.",
        )
        .of(field!(Camera.aperture))
        .only(&["perspective", "orthographic"]),
        Key::new(
            "focus",
            Kind::Number(Range::POSITIVE),
            Default::Said("the distance of `look_at`"),
            "Distance along forward that is sharp.",
        )
        .of(field!(Camera.focus))
        .only(&["perspective", "orthographic"]),
        Key::new(
            "shift",
            Kind::Pair,
            Default::Pair([0.0, 0.0]),
            "How far the picture is shifted in its plane, to the right and up, in heights of the picture: \
             `look_at` is so far beside its middle, and upright lines stay upright.",
        )
        .of(field!(Camera.shift))
        .only(&["perspective", "orthographic"]),
    ]],
};
