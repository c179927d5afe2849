//! `phong eval`: a formula at given vectors.

use crate::args::Anything;
use crate::failure::Failure;

/// A formula at given vectors: JSON lines in, JSON lines out
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    _anything: Anything,
}

pub(crate) fn run(_args: &Args) -> Result<(), Failure> {
    Err(Failure::not_yet("phong eval"))
}
