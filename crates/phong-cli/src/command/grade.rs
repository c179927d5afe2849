//! `phong grade`: somebody else's rendering held against ours.

use crate::args::Anything;
use crate::failure::Failure;

/// Hold somebody else's rendering against ours, term by term: names the term that is wrong
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    _anything: Anything,
}

pub(crate) fn run(_args: &Args) -> Result<(), Failure> {
    Err(Failure::not_yet("phong grade"))
}
