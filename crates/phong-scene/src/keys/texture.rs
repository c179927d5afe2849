//! The textures' keys, and those of what names one.

use super::field::{field, keyed};
use super::{Default, Key, Kind, Table};
use crate::limits::Range;
use crate::texture::{
    Channel, Encoding, GradientBy, TexelFilter, Texture, TextureKind, TextureSpace, Wrap,
};
use crate::wording::Word;

keyed!(Texture, |_| &TEXTURE);

/// `[textures.NAME]`.
pub(crate) static TEXTURE: Table = Table {
    name: "texture",
    doc: "Values that vary over a surface.",
    select: Some("kind"),
    keys: &[&[
        Key::new("kind", Kind::Word(TextureKind::WORDS), Default::Required, "What it is.")
            .of(field!(Texture.kind))
            .later(&["noise", "marble", "wood", "bricks"]),
        Key::new(
            "colors",
            Kind::TwoColors,
            Default::Required,
            "A where ⌊x⌋ + ⌊y⌋ + ⌊z⌋ is even, B where it is odd; a coordinate less than 1e-4 \
             below a border counts as above it.",
        )
        .of(field!(Texture.kind = TextureKind::{Checker}.colors))
        .only(&["checker"]),
        Key::new("scale", Kind::Number(Range::POSITIVE), Default::Number(1.0), "Squares a unit.")
            .of(field!(Texture.kind = TextureKind::{Checker}.scale))
            .only(&["checker"]),
        Key::new(
            "by",
            Kind::Word(GradientBy::WORDS),
            Default::Word("axis"),
            "What it runs by: the distance along `axis`, or that from the place where the texture \
             is.",
        )
        .of(field!(Texture.kind = TextureKind::{Gradient}.by))
        .only(&["gradient"]),
        Key::new(
            "axis",
            Kind::Direction,
            Default::Vector([0.0, 1.0, 0.0]),
            "Along which it runs; any length.",
        )
        .of(field!(Texture.kind = TextureKind::{Gradient}.axis))
        .only(&["gradient"]),
        Key::new(
            "from",
            Kind::Number(Range::ANY),
            Default::Number(0.0),
            "Where t is 0: a distance.",
        )
        .of(field!(Texture.kind = TextureKind::{Gradient}.from))
        .only(&["gradient"]),
        Key::new("to", Kind::Number(Range::ANY), Default::Number(1.0), "Where t is 1.")
            .of(field!(Texture.kind = TextureKind::{Gradient}.to))
            .only(&["gradient"]),
        Key::new(
            "stops",
            Kind::Stops,
            Default::Required,
            "Its colours; between two stops they run linearly, beyond the last they stay. A colour \
             map has 33 of them.",
        )
        .of(field!(Texture.kind = TextureKind::{Gradient}.stops))
        .only(&["gradient"]),
        Key::new(
            "scale",
            Kind::Scale,
            Default::Said("1"),
            "First of its place: a factor, or one along each axis.",
        )
        .only(&["gradient", "image"]),
        Key::new(
            "file",
            Kind::File,
            Default::Required,
            "The image: PNG, JPEG, Radiance HDR or OpenEXR. Its left edge lies at 0 of the first \
             coordinate and its right edge at 1, its lower edge at 0 of the second and its upper \
             edge at 1.",
        )
        .of(field!(Texture.kind = TextureKind::{Image}.file))
        .only(&["image"]),
        Key::new(
            "wrap",
            Kind::Word(Wrap::WORDS),
            Default::Word("repeat"),
            "What is beside it: the image again, the image mirrored, its edge, or `border`.",
        )
        .of(field!(Texture.kind = TextureKind::{Image}.wrap))
        .only(&["image"]),
        Key::new(
            "border",
            Kind::Color,
            Default::Number(0.0),
            "The colour beside it with `wrap = \"border\"`; its opacity is 0.",
        )
        .of(field!(Texture.kind = TextureKind::{Image}.border))
        .only(&["image"]),
        Key::new("tint", Kind::Color, Default::Number(1.0), "What its colours are multiplied by.")
            .of(field!(Texture.kind = TextureKind::{Image}.tint))
            .only(&["image"]),
        Key::new(
            "filter",
            Kind::Word(TexelFilter::WORDS),
            Default::Word("auto"),
            "`nearest`: the pixel there; `linear`: between pixels; `auto`: that, and the mean of \
             all that a sample of the picture covers.",
        )
        .of(field!(Texture.kind = TextureKind::{Image}.filter))
        .only(&["image"]),
        Key::new(
            "encoding",
            Kind::Word(Encoding::WORDS),
            Default::Word("auto"),
            "What its numbers mean; `auto`: colours of bytes and 16-bit numbers are sRGB, all \
             else is linear.",
        )
        .of(field!(Texture.kind = TextureKind::{Image}.encoding))
        .only(&["image"]),
        Key::new(
            "space",
            Kind::Word(TextureSpace::WORDS),
            Default::Word("object"),
            "The space it lies in.",
        )
        .of(field!(Texture.space))
        .only(&["checker", "gradient"]),
        Key::new(
            "space",
            Kind::Word(TextureSpace::WORDS),
            Default::Word("uv"),
            "The space it lies in; `object` and `world`: along z.",
        )
        .of(field!(Texture.space))
        .only(&["image"]),
        Key::new(
            "rotate",
            Kind::Rotate,
            Default::Said("none"),
            "Turns it: right-handed about an axis; or a list of them, in order.",
        ),
        Key::new("translate", Kind::Point, Default::Vector([0.0; 3]), "Then: shifts it."),
        Key::new(
            "matrix",
            Kind::Matrix,
            Default::Said("those above"),
            "Instead of all that place it: four rows of four, for column vectors.",
        ),
    ]],
};

/// `{ texture = .. }`.
pub(crate) static TEXTURED: Table = Table {
    name: "texture reference",
    doc: "Instead of a material's number or colour: the values of a texture.",
    select: None,
    keys: &[&[
        Key::new("texture", Kind::Texture, Default::Required, "Where the values come from."),
        Key::new(
            "scale",
            Kind::Number(Range::ANY),
            Default::Number(1.0),
            "What they are multiplied by.",
        ),
        Key::new("offset", Kind::Number(Range::ANY), Default::Number(0.0), "What is added then."),
        Key::new(
            "channel",
            Kind::Word(Channel::WORDS),
            Default::Said("all three; of a number `r`"),
            "The channel that is taken.",
        ),
    ]],
};
