//! The `phong` program.
//!
//! `args` (as typed) → `plan` (resolved: command line over file over defaults) → `command/*`.
//! `report` is the only part that talks. Standard output carries data, standard error talk.

mod args;
mod checkpoint;
mod command;
mod compile;
mod failure;
mod input;
mod interrupt;
mod output;
mod plan;
mod progress;
mod report;

use std::process::ExitCode;

use clap::Parser;

fn main() -> ExitCode {
    let cli = command::Cli::parse();
    interrupt::expect();
    match command::run(cli.command) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            report::failure(&failure);
            ExitCode::from(failure.code())
        }
    }
}
