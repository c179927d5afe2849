//! `phong info`: what an input holds.

use crate::args::InputArgs;
use crate::failure::Failure;

const EXAMPLES: &str = "\
Examples:
  phong info dragon.ply
  phong info scene.toml --json";

/// What is in it: counts, bounds, materials, memory, build time
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
    Err(Failure::not_yet("phong info"))
}
