//! The lights' keys.

use super::{Default, Key, Kind, Table};
use crate::light::LightKind;
use crate::limits::Range;

/// `[[light]]`.
pub(crate) static LIGHT: Table = Table {
    name: "light",
    doc: "One light of the sum over lights.",
    select: Some("kind"),
    keys: &[&[
        Key::new(
            "kind",
            Kind::Word(&["point", "distant", "spot"]),
            Default::Required,
            "Where its light comes from.",
        ),
        Key::new(
            "name",
            Kind::Text,
            Default::Said("`light N`, N from 1"),
            "What `explain` calls it.",
        ),
        Key::new("position", Kind::Point, Default::Required, "Where it is, in scene units.")
            .only(&["point", "spot"]),
        Key::new(
            "direction",
            Kind::Direction,
            Default::Required,
            "The way the light travels; any length.",
        )
        .only(&["distant"]),
        Key::new("target", Kind::Point, Default::Required, "A point on the axis of the cone.")
            .only(&["spot"]),
        Key::new(
            "cone",
            Kind::Number(LightKind::CONE),
            Default::Required,
            "Half-angle of full light, degrees.",
        )
        .only(&["spot"]),
        Key::new(
            "edge",
            Kind::Number(LightKind::EDGE),
            Default::Said("`cone`"),
            "Half-angle where the light ends, degrees, not below `cone`; between them \
             smoothstep in the cosine.",
        )
        .only(&["spot"]),
        Key::new(
            "color",
            Kind::Color,
            Default::Number(1.0),
            "`C_m,d` is this times the material's diffuse colour.",
        ),
        Key::new(
            "specular_color",
            Kind::Color,
            Default::Said("`color`"),
            "`C_m,s` is this times the material's specular colour.",
        ),
        Key::new(
            "attenuation",
            Kind::Attenuation,
            Default::Vector([1.0, 0.0, 0.0]),
            "`[c, l, q]`: the light is divided by c + l d + q d², d the distance.",
        )
        .only(&["point", "spot"]),
        Key::new(
            "shadows",
            Kind::Flag,
            Default::Flag(true),
            "Whether things in between take the light away.",
        ),
        Key::new(
            "radius",
            Kind::Number(Range::NOT_NEGATIVE),
            Default::Number(0.0),
            "Radius of the luminous sphere, scene units; 0: hard shadows.",
        )
        .only(&["point", "spot"]),
        Key::new(
            "angle",
            Kind::Number(LightKind::ANGLE),
            Default::Number(0.0),
            "Degrees across of the luminous disc; 0: hard shadows.",
        )
        .only(&["distant"]),
    ]],
};
