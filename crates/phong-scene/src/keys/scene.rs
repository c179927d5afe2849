//! The scene's own keys: the file as a whole, the picture, the ambient light.

use super::camera::CAMERA;
use super::field::{field, keyed};
use super::furniture::{AXES, FURNITURE, LABEL, LEGEND, SCALE_BAR, TITLE};
use super::light::LIGHT;
use super::material::MATERIAL;
use super::shape::{GROUP, SHAPES};
use super::sky::SKY;
use super::texture::TEXTURE;
use super::tone::TONE;
use super::{Default, Key, Kind, Table, VERSION};
use crate::ambient_occlusion::AmbientOcclusion;
use crate::clip::{Clip, ClipKind, Keep};
use crate::fog::{Fog, FogDistance, FogKind};
use crate::limits::Range;
use crate::outline::Outline;
use crate::scene::{FilterKind, Image};
use crate::wording::Word;

/// A scene file as a whole.
pub(crate) static SCENE: Table = Table {
    name: "scene",
    doc: "A scene file.",
    select: None,
    keys: &[
        &[
            VERSION,
            Key::new(
                "image",
                Kind::Table(&IMAGE),
                Default::Said("every key's default"),
                "The picture.",
            ),
            Key::new(
                "camera",
                Kind::Table(&CAMERA),
                Default::Required,
                "Where the picture is taken from.",
            ),
            Key::new(
                "ambient",
                Kind::Table(&AMBIENT),
                Default::Said("every key's default"),
                "The ambient light.",
            ),
            Key::new(
                "ambient_occlusion",
                Kind::Table(&AMBIENT_OCCLUSION),
                Default::Said("none"),
                "What takes ambient light away: a factor of the ambient term.",
            ),
            Key::new(
                "sky",
                Kind::Table(&SKY),
                Default::Said("none"),
                "A sky that the ambient light comes from.",
            ),
            Key::new(
                "fog",
                Kind::Table(&FOG),
                Default::Said("none"),
                "What is far away fades into a colour.",
            ),
            Key::new(
                "outline",
                Kind::Table(&OUTLINE),
                Default::Said("none"),
                "Lines around things, drawn when the picture is done.",
            ),
            Key::new(
                "furniture",
                Kind::Table(&FURNITURE),
                Default::Said("every key's default"),
                "What title, scale bar, axes, legend and labels have in common.",
            ),
            Key::new(
                "title",
                Kind::Table(&TITLE),
                Default::Said("none"),
                "A title, drawn onto the picture when it is done.",
            ),
            Key::new(
                "scale_bar",
                Kind::Table(&SCALE_BAR),
                Default::Said("none"),
                "A bar that shows a length.",
            ),
            Key::new(
                "axes",
                Kind::Table(&AXES),
                Default::Said("none"),
                "Three arrows that show which ways x, y and z point.",
            ),
            Key::new(
                "legend",
                Kind::Table(&LEGEND),
                Default::Said("none"),
                "What the colours of a map stand for.",
            ),
            Key::new(
                "label",
                Kind::Tables(&LABEL),
                Default::Said("none"),
                "Words at points of the scene.",
            ),
            Key::new(
                "tone",
                Kind::Table(&TONE),
                Default::Said("light as it is"),
                "How light becomes what a PNG shows.",
            ),
            Key::new("clip", Kind::Tables(&CLIP), Default::Said("none"), "What is cut away."),
            Key::new("light", Kind::Tables(&LIGHT), Default::Said("none"), "The lights."),
            Key::new(
                "materials",
                Kind::Named(&MATERIAL),
                Default::Said("none"),
                "The materials, by name.",
            ),
            Key::new(
                "textures",
                Kind::Named(&TEXTURE),
                Default::Said("none"),
                "The textures, by name.",
            ),
            Key::new(
                "groups",
                Kind::Named(&GROUP),
                Default::Said("none"),
                "Shapes to be placed together, by name.",
            ),
        ],
        SHAPES,
        &[Key::new(
            "include",
            Kind::Tables(&INCLUDE),
            Default::Said("none"),
            "Other files, at this place.",
        )],
    ],
};

keyed!(Image, |_| &IMAGE);

/// `[image]`.
pub(crate) static IMAGE: Table = Table {
    name: "image",
    doc: "The picture's own settings; the command line overrides them.",
    select: None,
    keys: &[&[
        Key::new("size", Kind::Size, Default::Size([960, 540]), "Width and height in pixels.")
            .of(field!(Image.size)),
        Key::new(
            "samples",
            Kind::Integer(1, Image::MOST_SAMPLES as u64),
            Default::Integer(16),
            "Samples a pixel; 1 is the pixel's centre.",
        )
        .of(field!(Image.samples)),
        Key::new(
            "background",
            Kind::Background,
            Default::Number(0.0),
            "What rays see that hit nothing; a table `{ top, bottom }` runs along the \
             picture's height.",
        )
        .of(field!(Image.background)),
        Key::new(
            "filter",
            Kind::Word(FilterKind::WORDS),
            Default::Word("box"),
            "How samples are weighted into a pixel.",
        )
        .of(field!(Image.filter)),
        Key::new(
            "seed",
            Kind::Integer(0, u64::MAX),
            Default::Integer(0),
            "Seed of the sampling pattern.",
        )
        .of(field!(Image.seed)),
        Key::new(
            "depth",
            Kind::Integer(0, Image::DEEPEST as u64),
            Default::Integer(8),
            "Mirror and glass bounces; beyond it a ray brings black.",
        )
        .of(field!(Image.depth)),
        Key::new(
            "min_weight",
            Kind::Number(Image::MIN_WEIGHT),
            Default::Number(1e-4),
            "Mirror and glass rays whose light would count less than this in every channel are \
             not followed; 0: all are.",
        )
        .of(field!(Image.min_weight)),
        Key::new(
            "terminator",
            Kind::Flag,
            Default::Flag(true),
            "Whether shadow rays from meshes with smooth normals start above the face, so that \
             faces do not show where light ends.",
        )
        .of(field!(Image.terminator)),
        Key::new(
            "dpi",
            Kind::Number(Range::POSITIVE),
            Default::Said("96, which no file says"),
            "Pixels an inch: how wide lines are whose width is in points; PNG files say it.",
        )
        .of(field!(Image.dpi)),
        Key::new(
            "cel",
            Kind::Integer(2, Image::MOST_STEPS as u64),
            Default::Said("none"),
            "The picture's luminance in so many steps from black to white, even to the eye, when it is done.",
        )
        .of(field!(Image.cel)),
    ]],
};

/// `background = { top, bottom }`.
pub(crate) static BACKGROUND: Table = Table {
    name: "background",
    doc: "A background that runs from one colour to another along the picture's height.",
    select: None,
    keys: &[&[
        Key::new("top", Kind::Color, Default::Required, "Colour at the upper edge."),
        Key::new("bottom", Kind::Color, Default::Required, "Colour at the lower edge."),
    ]],
};

/// `[ambient]`.
pub(crate) static AMBIENT: Table = Table {
    name: "ambient",
    doc: "The ambient light.",
    select: None,
    keys: &[&[Key::new(
        "color",
        Kind::Color,
        Default::Number(1.0),
        "`C_a` is this times the material's ambient colour.",
    )]],
};

keyed!(AmbientOcclusion, |_| &AMBIENT_OCCLUSION);

/// `[ambient_occlusion]`.
pub(crate) static AMBIENT_OCCLUSION: Table = Table {
    name: "ambient_occlusion",
    doc: "How much of the ambient light finds its way to a surface: the share of rays over it that \
          meet nothing.",
    select: None,
    keys: &[&[
        Key::new(
            "samples",
            Kind::Integer(1, AmbientOcclusion::MOST_SAMPLES as u64),
            Default::Integer(16),
            "Rays that look for open sky, from every surface that a ray meets.",
        )
        .of(field!(AmbientOcclusion.samples)),
        Key::new(
            "distance",
            Kind::NumberOr(Range::POSITIVE, "auto"),
            Default::Word("auto"),
            "How far they look, in scene units; beyond it nothing takes ambient light away. \
             `\"auto\"` is a quarter of the diagonal of the box around everything but planes.",
        )
        .of(field!(AmbientOcclusion.distance)),
    ]],
};

keyed!(Fog, |_| &FOG);

const LINEAR: &[&str] = &["linear"];
const EXPONENTIAL: &[&str] = &["exponential", "exponential-squared"];

/// `[fog]`.
pub(crate) static FOG: Table = Table {
    name: "fog",
    doc: "What is far away fades into a colour: the terms count 1 − f, and the term `fog` is f times \
          the colour.",
    select: Some("kind"),
    keys: &[&[
        Key::new(
            "kind",
            Kind::Word(FogKind::WORDS),
            Default::Word("linear"),
            "How the share f of the fog grows with the distance d: from 0 at `start` to 1 at `end`; \
             1 − e^(−density d); or 1 − e^(−(density d)²).",
        )
        .of(field!(Fog.kind)),
        Key::new(
            "color",
            Kind::Color,
            Default::Said("the background's or the sky's"),
            "Colour of the fog; of a background that runs down the picture the mean of its two, of \
             a transparent one black, of a sky the mean along its horizon.",
        )
        .of(field!(Fog.color)),
        Key::new(
            "start",
            Kind::Number(Range::NOT_NEGATIVE),
            Default::Number(0.0),
            "Where it begins, in scene units.",
        )
        .of(field!(Fog.kind = FogKind::{Linear}.start))
        .only(LINEAR),
        Key::new(
            "end",
            Kind::Number(Range::POSITIVE),
            Default::Required,
            "Where nothing but fog is seen; above `start`.",
        )
        .of(field!(Fog.kind = FogKind::{Linear}.end))
        .only(LINEAR),
        Key::new(
            "density",
            Kind::Number(Range::POSITIVE),
            Default::Required,
            "How dense it is, per scene unit.",
        )
        .of(field!(Fog.kind = FogKind::{Exponential | Squared}.density))
        .only(EXPONENTIAL),
        Key::new(
            "distance",
            Kind::Word(FogDistance::WORDS),
            Default::Word("radial"),
            "Whether the distance is that from the eye, or that along the camera's axis alone.",
        )
        .of(field!(Fog.distance)),
        Key::new(
            "strength",
            Kind::Number(Fog::STRENGTH),
            Default::Number(1.0),
            "The largest share; below 1 what is far away stays visible.",
        )
        .of(field!(Fog.strength)),
    ]],
};

keyed!(Outline, |_| &OUTLINE);

/// `[outline]`.
pub(crate) static OUTLINE: Table = Table {
    name: "outline",
    doc: "Lines around things, drawn when the picture is done: they are no term of the sum.",
    select: None,
    keys: &[&[
        Key::new(
            "width",
            Kind::Number(Range::POSITIVE),
            Default::Number(1.0),
            "Width of the lines in points: 72 are an inch, by the `dpi` of `[image]`.",
        )
        .of(field!(Outline.width)),
        Key::new("color", Kind::Color, Default::Number(0.0), "Colour of the lines.")
            .of(field!(Outline.color)),
        Key::new(
            "objects",
            Kind::Flag,
            Default::Flag(true),
            "Whether lines run where one object ends before another or before the background.",
        )
        .of(field!(Outline.objects)),
        Key::new(
            "depth",
            Kind::Number(Range::NOT_NEGATIVE),
            Default::Number(0.02),
            "Lines run within an object where the distance jumps by more than this share of it; 0: \
             nowhere.",
        )
        .of(field!(Outline.depth)),
        Key::new(
            "crease",
            Kind::Number(Outline::CREASE),
            Default::Number(40.0),
            "Lines run within an object where it turns by more than so many degrees from pixel to \
             pixel; 180: nowhere.",
        )
        .of(field!(Outline.crease)),
    ]],
};

keyed!(Clip, |_| &CLIP);

const PLANE: &[&str] = &["plane"];
const BOX: &[&str] = &["box"];

/// `[[clip]]`.
pub(crate) static CLIP: Table = Table {
    name: "clip",
    doc: "What is cut away of objects: it is neither seen nor does it cast a shadow.",
    select: Some("kind"),
    keys: &[&[
        Key::new(
            "kind",
            Kind::Word(ClipKind::WORDS),
            Default::Word("plane"),
            "What it cuts along.",
        )
        .of(field!(Clip.kind)),
        Key::new("point", Kind::Point, Default::Required, "Any point of the plane.")
            .of(field!(Clip.kind = ClipKind::{Plane}.point))
            .only(PLANE),
        Key::new(
            "normal",
            Kind::Direction,
            Default::Required,
            "What lies on the side that it points to is cut away; any length.",
        )
        .of(field!(Clip.kind = ClipKind::{Plane}.normal))
        .only(PLANE),
        Key::new("min", Kind::Point, Default::Required, "The corner with the lowest coordinates.")
            .of(field!(Clip.kind = ClipKind::{Box}.min))
            .only(BOX),
        Key::new("max", Kind::Point, Default::Required, "The corner with the highest coordinates.")
            .of(field!(Clip.kind = ClipKind::{Box}.max))
            .only(BOX),
        Key::new("keep", Kind::Word(Keep::WORDS), Default::Word("outside"), "Which part stays.")
            .of(field!(Clip.kind = ClipKind::{Box}.keep))
            .only(BOX),
        Key::new(
            "cap",
            Kind::Cap,
            Default::Flag(true),
            "Whether closed objects look solid where they are cut, in their own material or \
             another; false: one looks into them.",
        ),
        Key::new(
            "objects",
            Kind::Names,
            Default::Said("all objects"),
            "The names of the objects that it cuts, or of the instances they are in.",
        ),
    ]],
};

/// `[[include]]`.
pub(crate) static INCLUDE: Table = Table {
    name: "include",
    doc: "Another file's lights, materials, groups and shapes, at this place.",
    select: None,
    keys: &[&[Key::new("file", Kind::File, Default::Required, "The scene file.")]],
};
