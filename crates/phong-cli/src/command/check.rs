//! `phong check`: read and validate, no more.

use crate::args::InputArgs;
use crate::failure::Failure;

const EXAMPLES: &str = "\
Examples:
  phong check scene.toml
  phong check scene.toml --json
  phong check model.obj --strict     # warnings are errors, too";

/// Read and validate only: every problem with file, line and column
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
    Err(Failure::not_yet("phong check"))
}
