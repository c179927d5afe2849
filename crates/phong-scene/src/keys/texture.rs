//! The textures' keys, and those of what names one.

use super::field::{field, keyed};
use super::{Default, Key, Kind, Table};
use crate::limits::Range;
use crate::texture::{
    CellsBy, Channel, Encoding, GradientBy, GridAxes, TexelFilter, Texture, TextureKind,
    TextureSpace, Wrap,
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
            .later(&["bricks"]),
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
            "colors",
            Kind::TwoColors,
            Default::Said("black lines on white"),
            "That of the lines, and that of what is between them.",
        )
        .of(field!(Texture.kind = TextureKind::{Grid}.colors))
        .only(&["grid"]),
        Key::new(
            "colors",
            Kind::TwoColors,
            Default::Said("white and black"),
            "A where the stripes are counted even from 0, B where odd; what is less than 1e-4 of a \
             stripe below a border counts as above it.",
        )
        .of(field!(Texture.kind = TextureKind::{Stripes}.colors))
        .only(&["stripes"]),
        Key::new(
            "scale",
            Kind::Number(Range::POSITIVE),
            Default::Number(1.0),
            "How many cells, stripes, veins, rings or points a unit there are.",
        )
        .of(field!(Texture.kind = TextureKind::{Grid | Stripes | Noise | Marble | Wood | Cells}.scale))
        .only(&["grid", "stripes", "noise", "marble", "wood", "cells"]),
        Key::new(
            "width",
            Kind::Number(Range::POSITIVE),
            Default::Number(0.05),
            "How wide the lines are, in units; their middles are where a coordinate is a whole \
             number of cells.",
        )
        .of(field!(Texture.kind = TextureKind::{Grid}.width))
        .only(&["grid"]),
        Key::new(
            "axes",
            Kind::Word(GridAxes::WORDS),
            Default::Word("auto"),
            "Along which axes cells are counted; `auto`: x and z, as on a floor, and in `uv` both.",
        )
        .of(field!(Texture.kind = TextureKind::{Grid}.axes))
        .only(&["grid"]),
        Key::new(
            "by",
            Kind::Word(GradientBy::WORDS),
            Default::Word("axis"),
            "What stripes are counted by: the distance along `axis`, or that from the place where \
             the texture is.",
        )
        .of(field!(Texture.kind = TextureKind::{Stripes}.by))
        .only(&["stripes"]),
        Key::new(
            "by",
            Kind::Word(CellsBy::WORDS),
            Default::Word("distance"),
            "What t is: the distance to the nearest point in cells, how much farther away the next \
             one is (0 where two cells meet), or a number of each cell's own.",
        )
        .of(field!(Texture.kind = TextureKind::{Cells}.by))
        .only(&["cells"]),
        Key::new(
            "axis",
            Kind::Direction,
            Default::Vector([1.0, 0.0, 0.0]),
            "Across stripes and veins; any length.",
        )
        .of(field!(Texture.kind = TextureKind::{Stripes | Marble}.axis))
        .only(&["stripes", "marble"]),
        Key::new(
            "axis",
            Kind::Direction,
            Default::Vector([0.0, 1.0, 0.0]),
            "About which the rings lie; any length.",
        )
        .of(field!(Texture.kind = TextureKind::{Wood}.axis))
        .only(&["wood"]),
        Key::new(
            "turbulence",
            Kind::Number(Range::closed(0.0, 100.0)),
            Default::Number(1.0),
            "How many veins they are moved by noise, about.",
        )
        .of(field!(Texture.kind = TextureKind::{Marble}.turbulence))
        .only(&["marble"]),
        Key::new(
            "turbulence",
            Kind::Number(Range::closed(0.0, 100.0)),
            Default::Number(0.2),
            "How many rings they are moved by noise, about.",
        )
        .of(field!(Texture.kind = TextureKind::{Wood}.turbulence))
        .only(&["wood"]),
        Key::new(
            "octaves",
            Kind::Integer(1, TextureKind::MOST_OCTAVES as u64),
            Default::Integer(4),
            "How many noises are added up, each finer and weaker than the one before.",
        )
        .of(field!(Texture.kind = TextureKind::{Noise | Marble}.octaves))
        .only(&["noise", "marble"]),
        Key::new(
            "octaves",
            Kind::Integer(1, TextureKind::MOST_OCTAVES as u64),
            Default::Integer(2),
            "How many noises are added up, each finer and weaker than the one before.",
        )
        .of(field!(Texture.kind = TextureKind::{Wood}.octaves))
        .only(&["wood"]),
        Key::new(
            "lacunarity",
            Kind::Number(Range::closed(1.0, 8.0)),
            Default::Number(2.0),
            "How many times as fine each noise is as the one before.",
        )
        .of(field!(Texture.kind = TextureKind::{Noise | Marble | Wood}.lacunarity))
        .only(&["noise", "marble", "wood"]),
        Key::new(
            "gain",
            Kind::Number(Range::closed(0.0, 1.0)),
            Default::Number(0.5),
            "How many times as strong.",
        )
        .of(field!(Texture.kind = TextureKind::{Noise | Marble | Wood}.gain))
        .only(&["noise", "marble", "wood"]),
        Key::new(
            "stops",
            Kind::Stops,
            Default::Said("black to white"),
            "As a gradient's: the colours that t runs through from 0 to 1.",
        )
        .of(field!(Texture.kind = TextureKind::{Noise | Marble | Wood | Cells}.stops))
        .only(&["noise", "marble", "wood", "cells"]),
        Key::new(
            "of",
            Kind::Text,
            Default::Required,
            "Which number is shown: `height` (along `axis`), `radius` (from the place where the \
             texture is), `x`, `y`, `z`, `depth` (in front of the camera), `normal` (the cosine to \
             `axis`), or the name of a property that the vertices of a PLY file have.",
        )
        .of(field!(Texture.kind = TextureKind::{Map}.of))
        .only(&["map"]),
        Key::new(
            "range",
            Kind::Interval,
            Default::Word("auto"),
            "The numbers of the first colour and of the last; `auto`: the least and the largest of \
             what the map is on.",
        )
        .of(field!(Texture.kind = TextureKind::{Map}.range))
        .only(&["map"]),
        Key::new(
            "stops",
            Kind::Stops,
            Default::Required,
            "The colours, a colour map by name or a list as a gradient's; beyond the range they stay.",
        )
        .of(field!(Texture.kind = TextureKind::{Map}.stops))
        .only(&["map"]),
        Key::new("nan", Kind::Color, Default::Number(0.5), "The colour of what has no number.")
            .of(field!(Texture.kind = TextureKind::{Map}.nan))
            .only(&["map"]),
        Key::new(
            "axis",
            Kind::Direction,
            Default::Said("the camera's `up`"),
            "Along which heights are, and to which normals are held; any length.",
        )
        .of(field!(Texture.kind = TextureKind::{Map}.axis))
        .only(&["map"]),
        Key::new("unit", Kind::Text, Default::Said("none"), "The unit of the numbers, for legends.")
            .of(field!(Texture.kind = TextureKind::{Map}.unit))
            .only(&["map"]),
        Key::new(
            "seed",
            Kind::Integer(0, u32::MAX as u64),
            Default::Integer(0),
            "Which of many textures that are alike.",
        )
        .of(field!(Texture.kind = TextureKind::{Noise | Marble | Wood | Cells}.seed))
        .only(&["noise", "marble", "wood", "cells"]),
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
        .only(&["gradient", "image", "map"]),
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
            "wrap_v",
            Kind::Word(Wrap::WORDS),
            Default::Said("as `wrap`"),
            "What is above and below it.",
        )
        .of(field!(Texture.kind = TextureKind::{Image}.wrap_v))
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
        .only(&["checker", "gradient", "grid", "stripes", "noise", "marble", "wood", "cells"]),
        Key::new(
            "space",
            Kind::Word(TextureSpace::WORDS),
            Default::Word("uv"),
            "The space it lies in; `object` and `world`: along z.",
        )
        .of(field!(Texture.space))
        .only(&["image"]),
        Key::new(
            "space",
            Kind::Word(TextureSpace::WORDS),
            Default::Word("world"),
            "The space that heights, radii and coordinates are in.",
        )
        .of(field!(Texture.space))
        .only(&["map"]),
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
        Key::new(
            "offset",
            Kind::Number(Range::ANY),
            Default::Number(0.0),
            "What is added then; what comes below 0 is 0.",
        ),
        Key::new(
            "channel",
            Kind::Word(Channel::WORDS),
            Default::Said("all three; of a number `r`"),
            "The channel that is taken; `luminance`: 0.2126 r + 0.7152 g + 0.0722 b, of a colour in linear light, \
             of a number as the image holds them.",
        ),
    ]],
};
