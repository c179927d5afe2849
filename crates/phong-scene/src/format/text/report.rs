//! Findings about a file: at most a few of each kind are told in full, the rest are counted.

use std::ops::Range;
use std::sync::Arc;

use crate::diagnostic::{Diagnostic, Place, Severity, Span};

/// How many findings of one kind are told in full.
pub(crate) const TOLD: usize = 5;

/// Bytes of a line that an excerpt shows at most.
const EXCERPT: usize = 160;

/// What was found in one file, or in a piece of one, grouped by kind.
#[derive(Debug, Default)]
pub(crate) struct Findings {
    kinds: Vec<Kind>,
}

#[derive(Debug)]
struct Kind {
    severity: Severity,
    /// What they are, in the plural: "2 more `plural`".
    plural: &'static str,
    count: u64,
    told: Vec<Diagnostic>,
}

impl Findings {
    /// One more of a kind; `tell` is asked for it only if it will be told.
    pub(crate) fn add(
        &mut self,
        severity: Severity,
        plural: &'static str,
        tell: impl FnOnce() -> Diagnostic,
    ) {
        let kind = self.kind(severity, plural);
        kind.count += 1;
        if kind.told.len() < TOLD {
            let diagnostic = tell();
            debug_assert_eq!(diagnostic.severity, severity);
            kind.told.push(diagnostic);
        }
    }

    /// One more error of a kind.
    pub(crate) fn error(
        &mut self,
        plural: &'static str,
        span: impl FnOnce() -> Span,
        message: impl FnOnce() -> String,
    ) {
        self.add(Severity::Error, plural, || Diagnostic::error(message(), span()));
    }

    /// One more warning of a kind.
    pub(crate) fn warning(
        &mut self,
        plural: &'static str,
        span: impl FnOnce() -> Span,
        message: impl FnOnce() -> String,
    ) {
        self.add(Severity::Warning, plural, || Diagnostic::warning(message(), span()));
    }

    /// One more thing that is told.
    pub(crate) fn note(
        &mut self,
        plural: &'static str,
        span: impl FnOnce() -> Span,
        message: impl FnOnce() -> String,
    ) {
        self.add(Severity::Note, plural, || Diagnostic::note(message(), span()));
    }

    /// One more of a kind of damage that leaves something to be drawn: an error, or, where a file is
    /// read leniently, a warning.
    pub(crate) fn damage(
        &mut self,
        lenient: bool,
        plural: &'static str,
        span: impl FnOnce() -> Span,
        message: impl FnOnce() -> String,
    ) {
        if lenient {
            self.warning(plural, span, message);
        } else {
            self.error(plural, span, message);
        }
    }

    /// Takes over what was found in a later piece of the same file.
    pub(crate) fn append(&mut self, later: Self) {
        for kind in later.kinds {
            let mine = self.kind(kind.severity, kind.plural);
            mine.count += kind.count;
            let room = TOLD - mine.told.len();
            mine.told.extend(kind.told.into_iter().take(room));
        }
    }

    /// Whether any is an error.
    pub(crate) fn any_error(&self) -> bool {
        self.kinds.iter().any(|k| k.severity == Severity::Error)
    }

    /// Tells everything about `file` in the order of its lines, then how many more there are.
    pub(crate) fn tell(self, file: &Arc<str>, out: &mut Vec<Diagnostic>) {
        let mut told = Vec::new();
        let mut more = Vec::new();
        for kind in self.kinds {
            let untold = kind.count - kind.told.len() as u64;
            told.extend(kind.told);
            if untold > 0 {
                let span = whole(file);
                let message = format!("and {untold} more {}", kind.plural);
                more.push(Diagnostic {
                    severity: kind.severity,
                    ..Diagnostic::warning(message, span)
                });
            }
        }
        told.sort_by_key(|d| d.span.as_ref().map_or((0, 0), |s| (s.place.line, s.place.column)));
        out.append(&mut told);
        out.append(&mut more);
    }

    fn kind(&mut self, severity: Severity, plural: &'static str) -> &mut Kind {
        let same = |k: &Kind| k.plural == plural && k.severity == severity;
        let at = self.kinds.iter().position(same).unwrap_or_else(|| {
            self.kinds.push(Kind { severity, plural, count: 0, told: Vec::new() });
            self.kinds.len() - 1
        });
        &mut self.kinds[at]
    }
}

/// The span of a file as a whole.
pub(crate) fn whole(file: &Arc<str>) -> Span {
    Span { place: Place { file: Arc::clone(file), ..Place::default() }, ..Span::default() }
}

/// The span of bytes `range` of line `number`, whose text is `line` (without its end).
///
/// A long line is cut at both sides of what is meant; bytes that are no UTF-8 show as `�`.
pub(crate) fn span(file: &Arc<str>, number: u64, line: &[u8], range: Range<usize>) -> Span {
    let line = line.trim_ascii_end();
    let end = range.end.min(line.len());
    let start = range.start.min(end);
    let from = if start <= EXCERPT / 2 { 0 } else { start - EXCERPT / 4 };
    let meant_to = end.min(start + EXCERPT / 2);
    let to = line.len().min(from + EXCERPT).max(meant_to);
    let text = |range: Range<usize>| String::from_utf8_lossy(&line[range]).into_owned();
    let column = text(0..start).chars().count() as u32 + 1;
    let mut excerpt = String::new();
    if from > 0 {
        excerpt.push('…');
    }
    excerpt.push_str(&text(from..start));
    let first = excerpt.len();
    excerpt.push_str(&text(start..meant_to));
    let last = excerpt.len();
    excerpt.push_str(&text(meant_to..to));
    if to < line.len() {
        excerpt.push('…');
    }
    // Tabs and other controls would break the line that shows it.
    let excerpt = excerpt.replace(|c: char| c.is_ascii_control(), " ");
    let line = u32::try_from(number).unwrap_or(u32::MAX);
    Span { place: Place { file: Arc::clone(file), line, column }, excerpt, range: first..last }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_few_of_a_kind_are_told_and_the_rest_counted() {
        let file: Arc<str> = "a.obj".into();
        let mut all = Findings::default();
        for piece in 0..4 {
            let mut findings = Findings::default();
            for i in 0..3 {
                let line = piece * 10 + i;
                findings.warning(
                    "odd lines",
                    || span(&file, line, b"x", 0..1),
                    || format!("line {line} is odd"),
                );
            }
            all.append(findings);
        }
        let mut out = Vec::new();
        all.tell(&file, &mut out);
        let text: Vec<_> = out.iter().map(ToString::to_string).collect();
        assert_eq!(text.len(), 6);
        assert_eq!(text[4], "a.obj:11:1: warning: line 11 is odd");
        assert_eq!(text[5], "a.obj: warning: and 7 more odd lines");
    }

    #[test]
    fn an_excerpt_keeps_what_is_meant_and_cuts_the_rest() {
        let file: Arc<str> = "a".into();
        let line = format!("{}\u{e9}BAD{}", "x ".repeat(500), " y".repeat(500));
        let at = line.find("BAD").unwrap();
        let s = span(&file, 7, line.as_bytes(), at..at + 3);
        assert_eq!(&s.excerpt[s.range.clone()], "BAD");
        assert_eq!(s.place.column, 1002);
        assert!(s.excerpt.len() < 200);
        let s = span(&file, 7, b"ab\xff\tcd", 4..6);
        assert_eq!((&s.excerpt[s.range.clone()], s.excerpt.as_str()), ("cd", "ab\u{fffd} cd"));
    }
}
