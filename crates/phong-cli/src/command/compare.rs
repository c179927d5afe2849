//! `phong compare`: how different two images are.

use std::path::PathBuf;

use crate::failure::Failure;

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

pub(crate) fn run(_args: &Args) -> Result<(), Failure> {
    Err(Failure::not_yet("phong compare"))
}
