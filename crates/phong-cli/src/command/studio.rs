//! `phong studio`: the browser studio.

use crate::args::{Anything, input_help};
use crate::failure::Failure;

/// The browser studio on 127.0.0.1
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    #[arg(help = input_help())]
    _input: Option<String>,

    #[command(flatten)]
    _anything: Anything,
}

pub(crate) fn run(_args: &Args) -> Result<(), Failure> {
    Err(Failure::not_yet("phong studio"))
}
