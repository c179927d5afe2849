//! The lights' keys.

use super::field::{field, keyed};
use super::{Default, Key, Kind, Table};
use crate::light::{Light, LightKind};
use crate::limits::Range;
use crate::wording::Word;

keyed!(Light, |_| &LIGHT);

/// The kinds that are somewhere.
const LOCAL: &[&str] = &["point", "spot", "rectangle", "disc", "sphere"];

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
            .of(field!(Light.kind = LightKind::{Point | Spot | Rectangle | Disc | Sphere}.position))
            .only(LOCAL),
        Key::new(
            "direction",
            Kind::Direction,
            Default::Required,
            "The way the light travels; any length.",
        )
        .of(field!(Light.kind = LightKind::{Distant}.direction))
        .only(&["distant"]),
        Key::new(
            "direction",
            Kind::Direction,
            Default::Required,
            "The way the light travels from its middle, across its surface; any length. It shines to \
             this side alone.",
        )
        .of(field!(Light.kind = LightKind::{Rectangle | Disc}.direction))
        .only(&["rectangle", "disc"]),
        Key::new(
            "up",
            Kind::Direction,
            Default::Said("`[0, 1, 0]`; `[0, 0, -1]` where the light travels along Y"),
            "Along its height, made perpendicular to `direction`; any length.",
        )
        .of(field!(Light.kind = LightKind::{Rectangle}.up))
        .only(&["rectangle"]),
        Key::new(
            "width",
            Kind::Number(Range::POSITIVE),
            Default::Required,
            "Across `up`, scene units.",
        )
        .of(field!(Light.kind = LightKind::{Rectangle}.width))
        .only(&["rectangle"]),
        Key::new(
            "height",
            Kind::Number(Range::POSITIVE),
            Default::Required,
            "Along `up`, scene units.",
        )
        .of(field!(Light.kind = LightKind::{Rectangle}.height))
        .only(&["rectangle"]),
        Key::new(
            "object",
            Kind::Text,
            Default::Required,
            "The name of the mesh that shines, from all of its triangles to both sides; it does not shade its \
             own light.",
        )
        .of(field!(Light.object))
        .only(&["mesh"]),
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
        .of(field!(Light.kind = LightKind::{Point | Spot | Rectangle | Disc | Sphere | Mesh}.attenuation))
        .only(&["point", "spot", "rectangle", "disc", "sphere", "mesh"]),
        Key::new(
            "range",
            Kind::Number(Range::POSITIVE),
            Default::Said("none"),
            "Distance from `position` beyond which there is nothing of it, scene units.",
        )
        .of(field!(Light.range))
        .only(LOCAL),
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
            "radius",
            Kind::Number(Range::POSITIVE),
            Default::Required,
            "Radius of the disc or sphere, scene units.",
        )
        .of(field!(Light.kind = LightKind::{Disc | Sphere}.radius))
        .only(&["disc", "sphere"]),
        Key::new(
            "visible",
            Kind::Flag,
            Default::Flag(true),
            "Whether rays see its surface, from the side to which it shines: an emission of `color`.",
        )
        .of(field!(Light.visible))
        .only(&["rectangle", "disc", "sphere"]),
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
