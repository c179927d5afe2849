//! The only place that talks: diagnostics and words on standard error, data on standard output.

use std::fmt::Write as _;
use std::io::{self, IsTerminal, Write};

use annotate_snippets::renderer::DecorStyle;
use annotate_snippets::{AnnotationKind, Element, Group, Level, Origin, Renderer, Snippet};
use phong_scene::{Diagnostic, Label, Severity, Span};

use crate::failure::Failure;

/// Bytes of diagnostics that are drawn; beyond that they are counted. A file may be wrong a hundred
/// thousand times, and nobody reads that.
const MOST_DRAWN: usize = 60 << 10;

/// Characters of a message that are drawn: one alone must not be too long, either.
const LONGEST: usize = 4096;

/// Draws diagnostics on standard error, with carets, and a count after them if there are several.
/// Where there are too many, errors are drawn before warnings, each in its order.
pub(crate) fn diagnostics(all: &[Diagnostic]) {
    write_stderr(&drawn(&renderer(), all));
}

/// What there is to say about a failure, without colours.
pub(crate) fn plain(failure: &Failure) -> String {
    let renderer = Renderer::plain();
    match failure {
        Failure::Usage { message, help } => titled(&renderer, message, help.as_deref()),
        Failure::Input(all) => drawn(&renderer, all),
        Failure::System(message) => titled(&renderer, message, None),
        _ => String::new(),
    }
}

fn drawn(renderer: &Renderer, all: &[Diagnostic]) -> String {
    let mut drawn: Vec<Option<String>> = vec![None; all.len()];
    let mut room = MOST_DRAWN;
    'all: for severity in [Severity::Error, Severity::Warning, Severity::Note] {
        let these = all.iter().zip(&mut drawn).filter(|(d, _)| d.severity == severity);
        for (diagnostic, place) in these {
            let mut text = String::new();
            draw(renderer, diagnostic, &mut text);
            let Some(left) = room.checked_sub(text.len()) else { break 'all };
            room = left;
            *place = Some(text);
        }
    }
    let untold = drawn.iter().filter(|text| text.is_none()).count();
    let mut text: String = drawn.into_iter().flatten().collect();
    if all.len() > 1 || untold > 0 {
        let severities = [Severity::Error, Severity::Warning, Severity::Note];
        let counts = severities.map(|severity| {
            (all.iter().filter(|d| d.severity == severity).count(), severity.word())
        });
        let counts: Vec<_> = counts.into_iter().filter(|&(n, _)| n > 0).map(count).collect();
        let _ = write!(text, "{}", counts.join(", "));
        if untold > 0 {
            let _ = write!(text, "; not shown: {untold}");
        }
        text.push('\n');
    }
    text
}

/// One error that is at no place in a file.
pub(crate) fn error(message: &str, help: Option<&str>) {
    write_stderr(&titled(&renderer(), message, help));
}

fn titled(renderer: &Renderer, message: &str, help: Option<&str>) -> String {
    let error = Group::with_title(Level::ERROR.primary_title(message));
    let help = help.map(|help| Group::with_title(Level::HELP.secondary_title(help)));
    // Drawn one by one: together they would be joined by a bar, as if there were a source.
    [Some(error), help].into_iter().flatten().fold(String::new(), |mut text, group| {
        let _ = writeln!(text, "{}", renderer.render(&[group]));
        text
    })
}

/// What there is to say about a failure.
pub(crate) fn failure(failure: &Failure) {
    match failure {
        Failure::Usage { message, help } => error(message, help.as_deref()),
        Failure::Input(all) => diagnostics(all),
        Failure::System(message) => error(message, None),
        Failure::Interrupted(_) if is_watched() => say("\ninterrupted"),
        Failure::No | Failure::Told | Failure::Interrupted(_) | Failure::ReaderGone => {}
    }
}

/// A line of talk.
pub(crate) fn say(line: &str) {
    write_stderr(&format!("{line}\n"));
}

/// Data, to standard output, all of it or a failure.
pub(crate) fn data(bytes: &[u8]) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    out.write_all(bytes).and_then(|()| out.flush()).map_err(|e| Failure::stdout(&e))
}

/// What there is to say about the command line alone, help among it; the exit code.
pub(crate) fn answer(answer: &clap::Error) -> Result<u8, Failure> {
    let printed = answer.print().and_then(|()| io::stdout().flush());
    match printed {
        // An error is said where nobody need listen; help was asked for.
        Err(error) if !answer.use_stderr() => Err(Failure::stdout(&error)),
        _ => Ok(answer.exit_code() as u8),
    }
}

/// One JSON object, to standard output.
pub(crate) fn json(value: &serde_json::Value) -> Result<(), Failure> {
    data(format!("{value:#}\n").as_bytes())
}

/// A number of bytes for people.
pub(crate) fn readable(bytes: u64) -> String {
    let units = ["bytes", "KiB", "MiB", "GiB", "TiB"];
    let mut value = bytes as f64;
    let mut unit = 0;
    while value >= 1024.0 && unit + 1 < units.len() {
        value /= 1024.0;
        unit += 1;
    }
    if unit == 0 { format!("{bytes} bytes") } else { format!("{value:.1} {}", units[unit]) }
}

/// Whether somebody is watching standard error.
pub(crate) fn is_watched() -> bool {
    io::stderr().is_terminal()
}

/// A closed standard error is no reason to stop, let alone to panic.
fn write_stderr(text: &str) {
    let _ = io::stderr().lock().write_all(text.as_bytes());
}

fn renderer() -> Renderer {
    let unwanted = std::env::var_os("NO_COLOR").is_some_and(|v| !v.is_empty())
        || std::env::var_os("TERM").is_some_and(|v| v == "dumb");
    if is_watched() && !unwanted {
        Renderer::styled().decor_style(DecorStyle::Unicode)
    } else {
        Renderer::plain()
    }
}

fn draw(renderer: &Renderer, diagnostic: &Diagnostic, text: &mut String) {
    let level = match diagnostic.severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
        Severity::Note => Level::NOTE,
    };
    let message = &diagnostic.message;
    let end = message.char_indices().nth(LONGEST).map_or(message.len(), |(i, _)| i);
    let mut group = Group::with_title(level.primary_title(&message[..end]));
    if let Some(span) = &diagnostic.span {
        group = group.element(element(span, AnnotationKind::Primary, None));
    }
    for Label { message, span } in &diagnostic.labels {
        group = group.element(element(span, AnnotationKind::Context, Some(message)));
    }
    if let Some(help) = &diagnostic.help {
        group = group.element(Element::from(Level::HELP.message(help.as_str())));
    }
    let _ = writeln!(text, "{}\n", renderer.render(&[group]));
}

fn element<'a>(span: &'a Span, kind: AnnotationKind, label: Option<&'a String>) -> Element<'a> {
    let place = &span.place;
    if place.line == 0 || span.excerpt.is_empty() {
        let origin = Origin::path(&*place.file);
        let origin = if place.line > 0 {
            origin.line(place.line as usize).char_column(place.column as usize)
        } else {
            origin
        };
        return origin.into();
    }
    let annotation = kind.span(span.range.clone());
    let annotation = label.map_or(annotation.clone(), |label| annotation.label(label.as_str()));
    Snippet::source(span.excerpt.as_str())
        .line_start(place.line as usize)
        .path(&*place.file)
        .annotation(annotation)
        .into()
}

fn count((n, what): (usize, &str)) -> String {
    format!("{n} {what}{}", if n == 1 { "" } else { "s" })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_too_many_diagnostics_the_errors_are_drawn_first_and_the_rest_is_counted() {
        let warning = Diagnostic::warning("odd ".repeat(20), None);
        let mut all = vec![warning; 10_000];
        all[9_000] = Diagnostic::error("wrong", None);
        let text = drawn(&Renderer::plain(), &all);
        assert!(text.len() < 64 << 10 && text.contains("error: wrong"), "{}", text.len());
        let drawn = text.matches("warning: odd").count();
        let end = format!("1 error, 9999 warnings; not shown: {}\n", 9_999 - drawn);
        assert!(drawn > 100 && text.ends_with(&end), "{end}");
    }

    #[test]
    fn bytes_read_well() {
        assert_eq!(readable(17), "17 bytes");
        assert_eq!(readable(1536), "1.5 KiB");
        assert_eq!(readable(3 << 40), "3.0 TiB");
    }
}
