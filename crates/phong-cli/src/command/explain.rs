//! `phong explain`: why is this pixel this colour.

use crate::args::Anything;
use crate::failure::Failure;

/// Why is this pixel this colour: every vector, term, shadow test and ray, with numbers
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    _anything: Anything,
}

pub(crate) fn run(_args: &Args) -> Result<(), Failure> {
    Err(Failure::not_yet("phong explain"))
}
