//! The command line as typed: nothing here is resolved or opened.
//!
//! Here stand the options that several rooms look at; what belongs to one command only stands in that
//! command's file.

mod picture;
mod values;

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use phong::image::Format;
use phong_scene::{Change, Exposure, Rgb, Scene, Tone, ToneCurve};

pub(crate) use picture::{ImageArgs, RenderArgs};
pub(crate) use values::{
    Crop, PictureSize, ShareOf, Vec3Arg, color, look, output_help, path, size, studio_help, vector,
    whole, written_endings, written_format, written_help,
};

/// What no command goes beyond.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Bounds")]
pub(crate) struct BoundArgs {
    /// Memory to use at most; over it is an error. Plain bytes, or with k, M or G (powers of 1024)
    /// [default: what the system has for the program]
    #[arg(long, global = true, value_name = "BYTES", value_parser = values::bytes)]
    #[arg(allow_hyphen_values = true)]
    pub(crate) max_memory: Option<u64>,

    /// Read nothing outside this folder, links followed: for scenes of people you do not know
    #[arg(long, global = true, value_name = "DIR")]
    pub(crate) jail: Option<PathBuf>,
}

/// What to read, and how.
#[derive(Args, Clone, Debug)]
pub(crate) struct InputArgs {
    #[arg(help = values::input_help(), value_parser = values::path())]
    pub(crate) input: String,

    #[arg(long, value_name = "NAME", value_parser = values::format, help = values::format_help())]
    pub(crate) format: Option<phong_scene::Format>,

    /// Make warnings errors
    #[arg(long)]
    pub(crate) strict: bool,

    /// Draw what can be drawn of a damaged model: what is there of a file that is cut short, and all
    /// faces but those that use vertices there are not
    #[arg(long, conflicts_with = "strict")]
    pub(crate) lenient: bool,

    /// Lay a value over the scene's: camera.fov=30, materials.red.color=tomato, light.2.color=0.5
    /// (lights and shapes count from 1); may be given several times
    #[arg(long, value_name = "KEY=VALUE", value_parser = Change::parse)]
    pub(crate) set: Vec<Change>,
}

/// A question about an input, for people or for programs.
#[derive(Args, Clone, Debug)]
pub(crate) struct QuestionArgs {
    #[command(flatten)]
    pub(crate) input: InputArgs,

    /// One JSON object on standard output
    #[arg(long)]
    pub(crate) json: bool,
}

/// How a bare model is looked at; a scene's camera is moved by the same words.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "View")]
pub(crate) struct ViewArgs {
    /// Where a bare model is seen from [default: iso]
    #[arg(long, value_name = "SIDE")]
    pub(crate) view: Option<View>,

    /// Position of the eye
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true)]
    pub(crate) eye: Option<Vec3Arg>,

    /// The point in the middle of the picture
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true)]
    pub(crate) look_at: Option<Vec3Arg>,

    /// What is up: x, y, z, -x, -y, -z, or a direction (z for data that are Z-up)
    #[arg(long, value_name = "AXIS", value_parser = values::up, allow_hyphen_values = true)]
    pub(crate) up: Option<Vec3Arg>,

    /// Vertical field of view in degrees
    #[arg(long, value_name = "DEGREES", value_parser = values::fov, allow_hyphen_values = true)]
    pub(crate) fov: Option<f64>,

    /// Colour of a bare model: "#rrggbb", a CSS name (both sRGB, decoded), or r,g,b (linear)
    #[arg(long, value_name = "COLOR", value_parser = values::color, allow_hyphen_values = true)]
    pub(crate) color: Option<Rgb>,
}

/// The side a bare model is seen from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum View {
    Front,
    Back,
    Left,
    Right,
    Top,
    Bottom,
    Iso,
}

/// How a picture becomes bytes.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "File")]
pub(crate) struct EncodingArgs {
    /// Linear values in a PNG, without the sRGB curve
    #[arg(long)]
    pub(crate) linear: bool,

    /// Bits a channel in a PNG [default: 8]
    #[arg(long, value_name = "8|16")]
    pub(crate) bits: Option<Bits>,

    /// What OUT is, whatever its name says
    #[arg(long, value_name = "NAME")]
    pub(crate) output_format: Option<OutputFormat>,
}

/// How light becomes what a PNG shows; EXR and PFM keep it as it is.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "File")]
pub(crate) struct ToneArgs {
    /// Stops of exposure in a PNG: every one doubles the light; `auto` makes the geometric mean of what is lit 0.18
    #[arg(long, value_name = "EV|auto", value_parser = values::exposure, allow_hyphen_values = true)]
    pub(crate) exposure: Option<Exposure>,

    /// How a PNG brings light beyond white into range: clamp, reinhard, reinhard:WHITE or filmic
    #[arg(long, value_name = "CURVE", value_parser = values::curve)]
    pub(crate) tone: Option<ToneCurve>,

    /// The light that a PNG shows as white: its temperature in kelvin, or its colour
    #[arg(long, value_name = "KELVIN|COLOR", value_parser = values::white_balance)]
    #[arg(allow_hyphen_values = true)]
    pub(crate) white_balance: Option<White>,
}

/// The light that is to look white.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum White {
    Kelvin(f64),
    Color(Rgb),
}

impl ToneArgs {
    /// What is typed, over what is written.
    pub(crate) fn over(&self, tone: &mut Tone) {
        tone.exposure = self.exposure.unwrap_or(tone.exposure);
        tone.curve = self.tone.unwrap_or(tone.curve);
        if let Some(white) = self.white_balance {
            (tone.white_balance, tone.neutral) = match white {
                White::Kelvin(kelvin) => (Some(kelvin), None),
                White::Color(color) => (None, Some(color)),
            };
        }
    }

    /// The same of a scene, which may have none.
    pub(crate) fn over_scene(&self, scene: &mut Scene) {
        let mut tone = scene.tone.unwrap_or_default();
        self.over(&mut tone);
        if tone != scene.tone.unwrap_or_default() {
            scene.tone = Some(tone);
        }
    }
}

/// Bits a channel in a PNG.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Bits {
    #[value(name = "8")]
    Eight,
    #[value(name = "16")]
    Sixteen,
}

impl Bits {
    pub(crate) fn is_sixteen(self) -> bool {
        self == Self::Sixteen
    }
}

/// Whose picture is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Stereo {
    /// The left eye's.
    Left,
    /// The right eye's.
    Right,
    /// Both, the left eye's to the left: twice as wide.
    SideBySide,
    /// Both in one, for glasses that are red on the left and cyan on the right.
    Anaglyph,
}

/// A picture file's format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum OutputFormat {
    Png,
    Pfm,
    Exr,
    /// A PNG, and over it outlines.
    Svg,
}

impl OutputFormat {
    /// The format that a picture is written in by the renderer; `None`: it is a figure around one.
    pub(crate) fn of_picture(self) -> Option<Format> {
        match self {
            Self::Png => Some(Format::Png),
            Self::Pfm => Some(Format::Pfm),
            Self::Exr => Some(Format::Exr),
            Self::Svg => None,
        }
    }
}
