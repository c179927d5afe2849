//! `phong man`: the manual page.

use clap::CommandFactory;
use clap_mangen::Man;
use phong_scene::{closest, trouble};

use super::Cli;
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
        None => Man::new(program),
        Some(name) => page_of(&program, name)?,
    };
    let mut troff = Vec::new();
    page.source(concat!("phong ", env!("CARGO_PKG_VERSION")))
        .render(&mut troff)
        .map_err(|e| Failure::System(format!("no manual page: {}", trouble(&e))))?;
    report::data(&troff)
}

/// A command's own page, called as one looks it up: `phong-render`.
fn page_of(program: &clap::Command, name: &str) -> Result<Man, Failure> {
    let found = program.find_subcommand(name).cloned().ok_or_else(|| {
        let names = program.get_subcommands().map(clap::Command::get_name);
        let help = closest(name, names).map_or_else(
            || "`phong --help` lists the commands".to_owned(),
            |name| format!("did you mean `{name}`?"),
        );
        Failure::usage(format!("there is no command `{name}`")).with_help(help)
    })?;
    Ok(Man::new(found).title(format!("phong-{name}")))
}
