//! `phong compare`: how different two images are.

use std::fs;
use std::path::{Path, PathBuf};

use phong::compare::{self, Comparison};
use phong::film::{Film, LayerKind, Window};
use phong::image::{self, Content, Encoding, Format, Picture};
use phong::render::RenderOptions;
use serde_json::json;

use crate::failure::Failure;
use crate::output::Output;
use crate::report;

const EXAMPLES: &str = "\
Examples:
  phong compare a.png b.png
  phong compare a.png b.png --tolerance 0.004 --diff difference.png
  phong compare a.exr b.exr --json

PNGs are compared as encoded values in [0, 1], EXR and PFM as linear ones.
Exit code 0: no value differs by more than the tolerance; 1: one does; 2: no comparison is possible.";

/// Two images: how different
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// One image (.png .pfm .exr)
    pub(crate) a: PathBuf,

    /// The other
    pub(crate) b: PathBuf,

    /// Write the absolute difference as an image
    #[arg(long, value_name = "FILE")]
    pub(crate) diff: Option<PathBuf>,

    /// The largest difference that still counts as the same
    #[arg(long, value_name = "T", default_value_t = 0.0)]
    pub(crate) tolerance: f64,

    /// One JSON object on standard output
    #[arg(long)]
    pub(crate) json: bool,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    if args.tolerance.is_nan() || args.tolerance < 0.0 {
        return Err(Failure::usage("--tolerance is a number from 0 on"));
    }
    let (a, b) = (read(&args.a)?, read(&args.b)?);
    let found = compare::compare(&a, &b).map_err(|error| Failure::usage(error.to_string()))?;
    if let Some(path) = &args.diff {
        write_map(path, a.size, &found)?;
    }
    let same = !compare::exceeds(found.max, args.tolerance);
    let Comparison { max, mean, rms, over_1_255, psnr, worst, channel, map: _ } = &found;
    if args.json {
        report::json(&json!({
            "max": max,
            "mean": mean,
            "rms": rms,
            "over_1_255": over_1_255,
            "psnr": psnr,
            "worst": worst,
            "channel": channel,
            "same_size": true,
            "within_tolerance": same,
        }))?;
    } else {
        let psnr = psnr.map_or("nothing differs".to_owned(), |psnr| format!("{psnr:.2} dB"));
        let [x, y] = worst;
        let text = format!(
            "max    {max:.6} ({channel} at {x}, {y})\nmean   {mean:.6}\nrms    {rms:.6}\n\
             > 1/255 {:.3} % of the values\npsnr   {psnr}\n",
            100.0 * over_1_255,
        );
        report::data(text.as_bytes())?;
    }
    if same { Ok(()) } else { Err(Failure::No) }
}

pub(crate) fn read(path: &Path) -> Result<Picture, Failure> {
    let at_fault = |why: String| Failure::usage(format!("{}: {why}", path.display()));
    let bytes = fs::read(path).map_err(|error| at_fault(error.to_string()))?;
    Picture::read(&bytes).map_err(|error| at_fault(error.to_string()))
}

/// The differences as a picture; in a PNG level 255 is a difference of 1.
fn write_map(path: &Path, size: [u32; 2], found: &Comparison) -> Result<(), Failure> {
    if found.map.is_empty() {
        return Err(Failure::usage("--diff needs pictures with colours"));
    }
    let kinds = [LayerKind::Picture];
    let mut film = Film::new(size, Window::full(size), RenderOptions::TILE, &kinds);
    film.layers[0].values.clone_from(&found.map);
    let format = Format::of_path(path).ok_or_else(|| {
        Failure::usage(format!("the name {} does not say what to write", path.display()))
            .with_help("end it in .png, .pfm or .exr")
    })?;
    let content = Content::of(&kinds, format)[0];
    let encoding = Encoding { linear: true, ..Encoding::default() };
    let mut output = Output::create(path)?;
    output.write(|mut out| image::write(&film, content, format, &encoding, &mut out))?;
    Output::commit(vec![output])
}
