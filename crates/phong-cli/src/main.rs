//! The `phong` program.
//!
//! `args` (as typed) → `plan` (resolved: command line over file over defaults) → `command/*`.
//! `report` is the only part that talks. Standard output carries data, standard error talk.

#![expect(dead_code, reason = "the commands that use it land next")]

mod args;
mod command;
mod failure;
mod report;

use std::process::ExitCode;

use clap::Parser;

fn main() -> ExitCode {
    let cli = args::Cli::parse();
    match command::run(cli.command) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => ExitCode::from(failure.tell()),
    }
}
