//! The `phong` program.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(phong_cli::main(std::env::args_os()))
}
