//! The `phong` program, as a function: the binary calls it, and so does `python -m phong`.
//!
//! `args` (as typed) → `plan` (resolved: command line over file over defaults) → `command/*`.
//! `report` is the only part that talks. Standard output carries data, standard error talk.

mod args;
mod batch;
mod checkpoint;
mod command;
mod compile;
mod failure;
mod film;
mod input;
mod interrupt;
mod memory;
mod output;
mod plan;
mod progress;
mod report;
mod threads;

use std::ffi::OsString;

use clap::Parser;

/// Does what a command line asks for; the exit code.
///
/// `args` are all of them, the name of the program first. It is the program of its process: it heeds
/// interrupts, bounds the memory of the whole process, and talks on its standard streams.
pub fn main(args: impl IntoIterator<Item = OsString>) -> u8 {
    if cfg!(debug_assertions) {
        return run(args);
    }
    // Where memory runs out the runtime says so in one line, and users need no stack behind it.
    temp_env::with_var("RUST_BACKTRACE", Some("0"), || run(args))
}

fn run(args: impl IntoIterator<Item = OsString>) -> u8 {
    interrupt::expect();
    let done = match command::Cli::try_parse_from(args) {
        Ok(cli) => command::run(cli).map(|()| 0),
        Err(answer) => report::answer(&answer),
    };
    done.unwrap_or_else(|failure| {
        report::failure(&failure);
        failure.code()
    })
}
