//! `phong convert`: from one scene format to another.

use crate::args::Anything;
use crate::failure::Failure;

/// From one format to another, with a report of what was mapped and what was dropped
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    _anything: Anything,
}

pub(crate) fn run(_args: &Args) -> Result<(), Failure> {
    Err(Failure::not_yet("phong convert"))
}
