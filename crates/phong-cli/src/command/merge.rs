//! `phong merge`: shares of a picture put together.

use std::path::PathBuf;

use crate::args::EncodingArgs;
use crate::failure::Failure;

const EXAMPLES: &str = "\
Examples:
  phong render scene.toml --tile 0/2 -o a.part
  phong render scene.toml --tile 1/2 -o b.part
  phong merge a.part b.part -o scene.png      # the very bytes of an undivided render";

/// Shares of a picture, as `render --tile` writes them, put together
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// Every share of the picture, in any order
    #[arg(value_name = "PART", required = true)]
    pub(crate) parts: Vec<PathBuf>,

    /// The file to write (.png .pfm .exr); - is standard output
    #[arg(short, long, value_name = "OUT")]
    pub(crate) output: PathBuf,

    #[command(flatten)]
    pub(crate) encoding: EncodingArgs,
}

pub(crate) fn run(_args: &Args) -> Result<(), Failure> {
    Err(Failure::not_yet("phong merge"))
}
