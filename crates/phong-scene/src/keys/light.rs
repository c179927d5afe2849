//! The lights' keys.

use super::field::{field, keyed};
use super::{Default, Key, Kind, Table};
use crate::light::{Light, LightKind};
use crate::limits::Range;
use crate::wording::Word;

keyed!(Light, |_| &LIGHT);

/// `[[light]]`.
pub(crate) static LIGHT: Table = Table {
    name: "light",
    doc: "One light of the sum over lights.",
    select: Some("kind"),
    keys: &[&[
        Key::new(
            "kind",
            Kind::Word(LightKind::WORDS),
            Default::Required,
            "Where its light comes from.",
        )
        .of(field!(Light.kind)),
        Key::new(
            "name",
            Kind::Text,
            Default::Said("`light N`, N from 1"),
            "What `explain` calls it.",
        )
        .of(field!(Light.name)),
        Key::new("position", Kind::Point, Default::Required, "Where it is, in scene units.")
            .of(field!(Light.kind = LightKind::{Point | Spot}.position))
            .only(&["point", "spot"]),
        Key::new(
            "direction",
            Kind::Direction,
            Default::Required,
            "The way the light travels; any length.",
        )
        .of(field!(Light.kind = LightKind::{Distant}.direction))
        .only(&["distant"]),
        Key::new("target", Kind::Point, Default::Required, "A point on the axis of the cone.")
            .of(field!(Light.kind = LightKind::{Spot}.target))
            .only(&["spot"]),
        Key::new(
            "cone",
            Kind::Number(LightKind::CONE),
            Default::Required,
            "Half-angle of full light, degrees.",
        )
        .of(field!(Light.kind = LightKind::{Spot}.cone))
        .only(&["spot"]),
        Key::new(
            "edge",
            Kind::Number(LightKind::EDGE),
            Default::Said("`cone`"),
            "Half-angle where the light ends, degrees, not below `cone`; between them \
             smoothstep in the cosine.",
        )
        .of(field!(Light.kind = LightKind::{Spot}.edge))
        .only(&["spot"]),
        Key::new(
            "color",
            Kind::Color,
            Default::Number(1.0),
            "`C_m,d` is this times the material's diffuse colour.",
        )
        .of(field!(Light.color)),
        Key::new(
            "specular_color",
            Kind::Color,
            Default::Said("`color`"),
            "`C_m,s` is this times the material's specular colour.",
        )
        .of(field!(Light.specular_color)),
        Key::new(
            "attenuation",
            Kind::Attenuation,
            Default::Vector([1.0, 0.0, 0.0]),
            "`[c, l, q]`: the light is divided by c + l d + q d², d the distance.",
        )
        .of(field!(Light.kind = LightKind::{Point | Spot}.attenuation))
        .only(&["point", "spot"]),
        Key::new(
            "shadows",
            Kind::Flag,
            Default::Flag(true),
            "Whether things in between take the light away.",
        )
        .of(field!(Light.shadows)),
        Key::new(
            "radius",
            Kind::Number(Range::NOT_NEGATIVE),
            Default::Number(0.0),
            "Radius of the luminous sphere, scene units; 0: hard shadows.",
        )
        .of(field!(Light.kind = LightKind::{Point | Spot}.radius))
        .only(&["point", "spot"]),
        Key::new(
            "angle",
            Kind::Number(LightKind::ANGLE),
            Default::Number(0.0),
            "Degrees across of the luminous disc; 0: hard shadows.",
        )
        .of(field!(Light.kind = LightKind::{Distant}.angle))
        .only(&["distant"]),
    ]],
};
