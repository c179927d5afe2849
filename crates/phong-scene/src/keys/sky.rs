//! The sky's keys.

use super::field::{field, keyed};
use super::{Default, Key, Kind, Table};
use crate::ambient_occlusion::AmbientOcclusion;
use crate::limits::Range;
use crate::sky::{Sky, SkyKind};
use crate::wording::Word;

keyed!(Sky, |_| &SKY);

/// `[sky]`.
pub(crate) static SKY: Table = Table {
    name: "sky",
    doc: "A sky that the ambient light comes from: what a surface meets of it, as a matt surface weighs \
          it, is a factor of the ambient term. Rays that hit nothing see it.",
    select: Some("kind"),
    keys: &[&[
        Key::new("kind", Kind::Word(SkyKind::WORDS), Default::Word("constant"), "What it looks like.")
            .of(field!(Sky.kind)),
        Key::new(
            "color",
            Kind::Color,
            Default::Number(1.0),
            "What all of it is multiplied by; of a constant one its colour.",
        )
        .of(field!(Sky.color)),
        Key::new("zenith", Kind::Color, Default::Number(1.0), "Its colour straight up.")
            .of(field!(Sky.kind = SkyKind::{Gradient}.zenith))
            .only(&["gradient"]),
        Key::new(
            "horizon",
            Kind::Color,
            Default::Number(1.0),
            "Its colour at the horizon; between them by the sine of the height.",
        )
        .of(field!(Sky.kind = SkyKind::{Gradient}.horizon))
        .only(&["gradient"]),
        Key::new(
            "sun",
            Kind::Direction,
            Default::Required,
            "Towards the sun, any length, above the horizon. Its own light is a `distant` light, for you \
             to add.",
        )
        .of(field!(Sky.kind = SkyKind::{SunAndSky}.sun))
        .only(&["sun-and-sky"]),
        Key::new(
            "turbidity",
            Kind::Number(Sky::TURBIDITY),
            Default::Number(3.0),
            "How hazy the air is: 2 is clear, 6 hazy.",
        )
        .of(field!(Sky.kind = SkyKind::{SunAndSky}.turbidity))
        .only(&["sun-and-sky"]),
        Key::new(
            "ground",
            Kind::Color,
            Default::Said("`horizon`; of `sun-and-sky` 0.2"),
            "Its colour below the horizon.",
        )
        .of(field!(Sky.kind = SkyKind::{Gradient | SunAndSky}.ground))
        .only(&["gradient", "sun-and-sky"]),
        Key::new(
            "file",
            Kind::File,
            Default::Required,
            "The image: PNG, JPEG, Radiance HDR or OpenEXR. Its width is all around and its height from \
             straight up to straight down; its middle lies towards −Z, of an `up` along Z towards +Y.",
        )
        .of(field!(Sky.kind = SkyKind::{Image}.file))
        .only(&["image"]),
        Key::new(
            "rotation",
            Kind::Number(Range::ANY),
            Default::Number(0.0),
            "Degrees by which it is turned about `up`, right-handed.",
        )
        .of(field!(Sky.kind = SkyKind::{Image}.rotation))
        .only(&["image"]),
        Key::new("up", Kind::Direction, Default::Vector([0.0, 1.0, 0.0]), "Which way is up.")
            .of(field!(Sky.up)),
        Key::new(
            "samples",
            Kind::Integer(1, AmbientOcclusion::MOST_SAMPLES as u64),
            Default::Integer(16),
            "Rays from every surface that a ray meets, as far as there is anything; where there is \
             `[ambient_occlusion]`, that says how many and how far.",
        )
        .of(field!(Sky.samples)),
    ]],
};
