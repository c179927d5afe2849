//! `phong fit`: one model matched to another.

use crate::args::Anything;
use crate::failure::Failure;

/// The exponent or roughness with which model B best matches model A, with the residual
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    _anything: Anything,
}

pub(crate) fn run(_args: &Args) -> Result<(), Failure> {
    Err(Failure::not_yet("phong fit"))
}
