//! A diagnostic as JSON.

use phong_scene::{Diagnostic, Place, Span};
use serde_json::{Value, json};

/// A diagnostic as `phong check --json` and the studio tell it: what is wrong, its file, line and
/// column (from 1; `null` where it has none), and what would help.
pub fn diagnostic(diagnostic: &Diagnostic) -> Value {
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
