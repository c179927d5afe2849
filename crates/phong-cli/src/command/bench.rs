//! `phong bench`: how fast a scene is read, built and traced.

use crate::args::InputArgs;
use crate::failure::Failure;

const EXAMPLES: &str = "\
Examples:
  phong bench dragon.ply
  phong bench scene.toml --json";

/// Rays per second by kind, time by stage, bytes per primitive
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    pub(crate) input: InputArgs,

    /// One JSON object on standard output
    #[arg(long)]
    pub(crate) json: bool,
}

pub(crate) fn run(_args: &Args) -> Result<(), Failure> {
    Err(Failure::not_yet("phong bench"))
}
