//! `phong completions`: what a shell needs to complete our command line.

use clap::CommandFactory;
use clap_complete::Shell;

use super::Cli;
use crate::failure::Failure;
use crate::report;

const EXAMPLES: &str = "\
Examples:
  phong completions bash > ~/.local/share/bash-completion/completions/phong
  phong completions zsh > ~/.zfunc/_phong
  phong completions fish > ~/.config/fish/completions/phong.fish";

/// Completions for a shell, on standard output
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// Which shell
    shell: Shell,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "phong", &mut script);
    report::data(&script)
}
