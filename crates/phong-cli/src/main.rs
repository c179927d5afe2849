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
mod memory;
mod output;
mod plan;
mod progress;
mod report;
mod threads;

use std::process::ExitCode;

use clap::Parser;

fn main() -> ExitCode {
    if cfg!(debug_assertions) {
        return run();
    }
    // Where memory runs out the runtime says so in one line, and users need no stack behind it.
    temp_env::with_var("RUST_BACKTRACE", Some("0"), run)
}

fn run() -> ExitCode {
    interrupt::expect();
    let done = match command::Cli::try_parse() {
        Ok(cli) => command::run(cli).map(|()| 0),
        Err(answer) => report::answer(&answer),
    };
    match done {
        Ok(code) => ExitCode::from(code),
        Err(failure) => {
            report::failure(&failure);
            ExitCode::from(failure.code())
        }
    }
}
