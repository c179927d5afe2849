//! `phong check`: read and validate, no more.

use phong_lab::tell::diagnostic;
use serde_json::json;

use crate::args::QuestionArgs;
use crate::failure::Failure;
use crate::{input, report};

const EXAMPLES: &str = "\
Examples:
  phong check scene.toml
  phong check scene.toml --json
  phong check model.obj --strict     # warnings are errors, too";

/// Read and validate only: every problem with file, line and column
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    question: QuestionArgs,
}

pub(crate) fn run(Args { question: args }: &Args) -> Result<(), Failure> {
    let reading = input::check(&args.input)?;
    let ok = reading.scene.is_some();
    if args.json {
        let diagnostics: Vec<_> = reading.diagnostics.iter().map(diagnostic).collect();
        report::json(&json!({ "ok": ok, "diagnostics": diagnostics }))?;
        return if ok { Ok(()) } else { Err(Failure::Told) };
    }
    if !ok {
        return Err(Failure::Input(reading.diagnostics));
    }
    report::diagnostics(&reading.diagnostics);
    if reading.diagnostics.is_empty() && report::is_watched() {
        report::say(&format!("{}: nothing to complain about", args.input.input));
    }
    Ok(())
}
