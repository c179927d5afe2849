//! Diagnostics as text, with the mark under what is meant.

use phong_scene::{Diagnostic, Span};

/// All of them, one after another.
pub(crate) fn all(diagnostics: &[Diagnostic]) -> String {
    diagnostics.iter().map(one).collect::<Vec<_>>().join("\n")
}

fn one(diagnostic: &Diagnostic) -> String {
    let Diagnostic { severity, message, span, help, labels } = diagnostic;
    let mut lines = vec![format!("{}: {message}", severity.word())];
    lines.extend(span.iter().flat_map(marked));
    for label in labels {
        lines.push(format!("  {}:", label.message));
        lines.extend(marked(&label.span));
    }
    lines.extend(help.iter().map(|help| format!("  = {help}")));
    lines.join("\n") + "\n"
}

/// The place, the line, and the mark under it.
fn marked(span: &Span) -> Vec<String> {
    let Span { place, excerpt, range } = span;
    let mut lines = vec![format!("  --> {place}")];
    if !excerpt.is_empty() {
        // Panics unless within the excerpt and on character boundaries.
        let before = " ".repeat(excerpt[..range.start].chars().count());
        let mark = "^".repeat(excerpt[range.clone()].chars().count().max(1));
        lines.extend([format!("   | {excerpt}"), format!("   | {before}{mark}")]);
    }
    lines
}
