//! `phong check`: read and validate, no more.

use phong_scene::{Diagnostic, Place, Span};
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
    let (reading, _) = input::read(&args.input)?;
    let ok = reading.scene.is_some();
    if args.json {
        let diagnostics: Vec<_> = reading.diagnostics.iter().map(json).collect();
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

/// A diagnostic for programs.
pub(crate) fn json(diagnostic: &Diagnostic) -> serde_json::Value {
    let place = |span: &Span| {
        let Place { file, line, column } = &span.place;
        (file.to_string(), (*line > 0).then_some(*line), (*column > 0).then_some(*column))
    };
    let (file, line, column) =
        diagnostic.span.as_ref().map(place).map_or((None, None, None), |(f, l, c)| (Some(f), l, c));
    let labels = diagnostic.labels.iter().map(|label| {
        let (file, line, column) = place(&label.span);
        json!({ "message": label.message, "file": file, "line": line, "column": column })
    });
    json!({
        "severity": diagnostic.severity.word(),
        "message": diagnostic.message,
        "file": file,
        "line": line,
        "column": column,
        "help": diagnostic.help,
        "labels": labels.collect::<Vec<_>>(),
    })
}
