//! `phong man`: the manual page.

use std::io;

use clap::CommandFactory;
use clap_mangen::Man;

use crate::args::Cli;
use crate::failure::Failure;
use crate::report;

const EXAMPLES: &str = "\
Examples:
  phong man > phong.1
  phong man | man -l -
  phong man render | man -l -";

/// The manual page, in troff, on standard output
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// The page of one command instead of the whole program's
    command: Option<String>,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let mut program = Cli::command();
    program.build();
    let page = match &args.command {
        None => program,
        Some(name) => program.find_subcommand(name).cloned().ok_or_else(|| {
            Failure::usage(format!("there is no command `{name}`"))
                .with_help("`phong --help` lists the commands")
        })?,
    };
    let mut troff = Vec::new();
    render(page, &mut troff).map_err(|e| Failure::System(format!("no manual page: {e}")))?;
    report::data(&troff)
}

fn render(page: clap::Command, out: &mut Vec<u8>) -> io::Result<()> {
    Man::new(page).render(out)
}
