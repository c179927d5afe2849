//! What a picture is, and how the work on it is done.

use std::path::PathBuf;

use phong::render::RenderOptions;
use phong_scene::Image;

use super::values::{self, Crop, PictureSize, ShareOf};
use super::{EncodingArgs, InputArgs, Stereo, ToneArgs, ViewArgs};

const EXAMPLES: &str = "\
Examples:
  phong render scene.toml
  phong render scene.toml -o large.png --size 1920x1080 --samples 64
  phong render dragon.ply --view front --color \"#c8402f\"
  phong render scene.toml -o all.exr --terms --aov depth,normal
  phong render scene.toml -o a.part --tile 0/2     # and 1/2 elsewhere, then: phong merge
  phong render scene.toml -o - | display           # to another program
  phong render scene.toml --size 480x270 --watch      again at every change
  phong render dragon.ply --turntable 100 -o dragon-%04d.png    a film, a file a picture
  phong render dragon.ply --turntable 50 -o dragon.gif          the same in one file
  phong render run.xyz --frames 0:1000:10 -o run-%04d.png       frames of a trajectory
  cat scene.toml | phong render - --format toml -o scene.png";

/// A picture of a scene or a bare model
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct RenderArgs {
    #[command(flatten)]
    pub(crate) input: InputArgs,

    /// The file to write (.png .pfm .exr .svg); - is standard output
    /// [default: INPUT's stem + .png, in the current folder]
    #[arg(short, long, value_name = "OUT")]
    pub(crate) output: Option<PathBuf>,

    #[command(flatten)]
    pub(crate) image: ImageArgs,

    #[command(flatten)]
    pub(crate) view: ViewArgs,

    #[command(flatten)]
    pub(crate) encoding: EncodingArgs,

    #[command(flatten)]
    pub(crate) tone: ToneArgs,

    /// Print what the scene looks like (camera, lights, materials, and what --look has set) as scene
    /// text on standard output, and draw nothing
    #[arg(long, help_heading = "File")]
    #[arg(conflicts_with_all = ["json", "output", "watch", "turntable", "frames", "path", "tile"])]
    pub(crate) toml: bool,

    /// Also every term by itself: layers of an EXR, else files STEM.TERM.ext beside OUT
    #[arg(long, help_heading = "File")]
    pub(crate) terms: bool,

    /// Also depth, normal, position, albedo, uv, object, material, shadow, openness or cost
    #[arg(long, value_name = "NAME,...", value_delimiter = ',', value_parser = values::aov)]
    #[arg(help_heading = "File")]
    pub(crate) aov: Vec<phong::aov::Aov>,

    /// Also what each light brought, and `light.rest`, what none did: layers of an EXR, else files
    /// STEM.light.N.ext beside OUT, N from 1; they sum to the picture
    #[arg(long, help_heading = "File")]
    pub(crate) lights: bool,

    /// The picture of one eye, or of both: left, right, side-by-side (twice as wide) or anaglyph (for
    /// glasses with red before the left eye and cyan before the right). Both eyes look the same way, and what
    /// is in focus (`look_at`, unless the camera says `focus`) is at the same place for both
    #[arg(
        long,
        value_name = "VIEW",
        value_enum,
        hide_possible_values = true,
        help_heading = "Picture"
    )]
    pub(crate) stereo: Option<Stereo>,

    /// How far apart the eyes are, in scene units [default: a thirtieth of the distance in focus]
    #[arg(long, value_name = "D", value_parser = values::eye_distance, allow_hyphen_values = true)]
    #[arg(requires = "stereo", help_heading = "Picture")]
    pub(crate) eye_distance: Option<f64>,

    #[command(flatten)]
    pub(crate) film: FilmArgs,

    #[command(flatten)]
    pub(crate) work: WorkArgs,
}

/// Which pictures there are, if more than one.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Film")]
pub(crate) struct FilmArgs {
    /// Turn once around what is seen, in N pictures: a file each, OUT with %d or %04d for its number,
    /// or all in one, OUT in .gif or .png (animated). With --resume, pictures that are there are kept
    #[arg(long, value_name = "N", value_parser = values::whole(1_u32, 1_000_000))]
    #[arg(conflicts_with_all = ["tile", "watch"], allow_hyphen_values = true)]
    pub(crate) turntable: Option<u32>,

    /// Frames A, A + S, ... below B of a trajectory, counted from 0: 0:100:10, 50:, or one, 7.
    /// XYZ, PDB of several models, GRO, LAMMPS dumps, and DCD or XTC beside a molecule, also where a scene
    /// names them. Files as for --turntable, with the frame's number
    #[arg(long, value_name = "A:B:S", value_parser = values::frames)]
    #[arg(conflicts_with_all = ["tile", "watch", "turntable"], allow_hyphen_values = true)]
    pub(crate) frames: Option<phong_scene::FrameRange>,

    /// Along the way that the camera goes by this file: each `[[key]]` says time, eye, `look_at`, up and fov,
    /// `pictures` how many. Files as for --turntable
    #[arg(long, value_name = "FILE", conflicts_with_all = ["tile", "watch", "turntable", "frames"])]
    pub(crate) path: Option<String>,

    /// Pictures a second, where all are in one file [default: 25]
    #[arg(long, value_name = "N", value_parser = values::whole(1_u16, 1000))]
    #[arg(allow_hyphen_values = true)]
    pub(crate) fps: Option<u16>,
}

impl FilmArgs {
    /// Whether there is more than the one picture.
    pub(crate) fn is_asked_for(&self) -> bool {
        self.turntable.is_some() || self.frames.is_some() || self.path.is_some()
    }
}

/// What the picture is; the scene's own settings hold where nothing is said.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Picture")]
pub(crate) struct ImageArgs {
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", value_parser = values::size, allow_hyphen_values = true)]
    pub(crate) size: Option<PictureSize>,

    /// Samples a pixel
    #[arg(long, value_name = "N", value_parser = values::whole(1, Image::MOST_SAMPLES), allow_hyphen_values = true)]
    pub(crate) samples: Option<u32>,

    /// Seed of the sampling pattern
    #[arg(long, value_name = "N", value_parser = values::whole(0, u64::MAX), allow_hyphen_values = true)]
    pub(crate) seed: Option<u64>,

    /// Mirror and glass bounces; beyond it a ray brings black
    #[arg(long, value_name = "N", value_parser = values::whole(0, RenderOptions::MOST_DEPTH), allow_hyphen_values = true)]
    pub(crate) depth: Option<u32>,

    /// Every light reaches everything
    #[arg(long)]
    pub(crate) no_shadows: bool,

    /// What rays see that hit nothing: a colour as for --color, or transparent
    #[arg(long, value_name = "COLOR", value_parser = values::background, allow_hyphen_values = true)]
    pub(crate) background: Option<phong_scene::Background>,

    /// A look that makes a good figure of a bare model, and replaces a scene's own lights, background
    /// and factors of materials: lecture, publication, clay, flat, ink, tachyon, vmd, pymol or technical
    #[arg(long, value_name = "NAME", value_parser = values::look)]
    pub(crate) look: Option<phong_scene::NamedLook>,

    /// Pixels an inch: how wide lines are, and what a PNG says [default: 96, which none says]
    #[arg(long, value_name = "N", value_parser = values::dpi, allow_hyphen_values = true)]
    pub(crate) dpi: Option<f64>,

    /// Only these pixels; X1 and Y1 lie outside, and the file has the size of the crop
    #[arg(long, value_name = "X0,Y0,X1,Y1", value_parser = values::crop, allow_hyphen_values = true)]
    pub(crate) crop: Option<Crop>,
}

/// How the work is done.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Work")]
#[expect(clippy::struct_excessive_bools, reason = "each is a switch of its own")]
pub(crate) struct WorkArgs {
    /// Threads to use [default: all cores]
    #[arg(long, value_name = "N", value_parser = values::whole(1_u32, 4096), allow_hyphen_values = true)]
    pub(crate) threads: Option<u32>,

    /// Only share I (from 0) of N; OUT becomes a part, which `phong merge` takes
    #[arg(long, value_name = "I/N", value_parser = values::share, allow_hyphen_values = true)]
    pub(crate) tile: Option<ShareOf>,

    /// Draw all of the picture coarsely first, then with 1, 2, 4, ... samples a pixel; the end is the
    /// same. A checkpoint of --resume then holds a whole picture soon, and some 200 bytes a pixel more
    #[arg(long)]
    pub(crate) passes: bool,

    /// Keep a checkpoint OUT.part while rendering, and go on from it if there is one
    #[arg(long)]
    pub(crate) resume: bool,

    /// Begin anew where the checkpoint cannot be gone on from.
    #[arg(skip)]
    pub(crate) replace: bool,

    /// Draw again whenever the scene or a file it names changes, until interrupted
    #[arg(long, conflicts_with_all = ["tile", "resume"])]
    pub(crate) watch: bool,

    /// One JSON object about the work, on standard output
    #[arg(long)]
    pub(crate) json: bool,

    /// No talk but errors
    #[arg(short, long)]
    pub(crate) quiet: bool,
}
