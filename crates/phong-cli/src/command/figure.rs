//! `phong figure`: the lecture's figures.

use crate::args::Anything;
use crate::failure::Failure;

/// The lecture's figures; without a name, lists them
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    _anything: Anything,
}

pub(crate) fn run(_args: &Args) -> Result<(), Failure> {
    Err(Failure::not_yet("phong figure"))
}
