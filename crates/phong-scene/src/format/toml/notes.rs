//! What there is to say about the files read, in the order of the text.

use std::collections::BTreeSet;
use std::sync::Arc;

use toml::de::DeTable;

use super::text::{Spot, Text};
use crate::check::fault::{Fault, Faults};
use crate::diagnostic::{Diagnostic, Place, Severity, Span};

/// Most diagnostics that are told; the rest is counted, and said to be. A generated file may be
/// wrong a million times in the same way, and each takes some 700 bytes to tell.
const MOST: usize = 100_000;

/// The files read and everything said about them.
#[derive(Debug, Default)]
pub(super) struct Notes {
    texts: Vec<Arc<Text>>,
    said: Vec<(Vec<usize>, Diagnostic)>,
    /// How many warnings and errors there were beyond those.
    untold: [usize; 2],
    /// What is not told is written here.
    spare: Diagnostic,
    /// Files and places where tables begin that lost a statement to a syntax error.
    lost: BTreeSet<(u32, usize)>,
}

impl Notes {
    /// Takes a file in; its number is what [`Spot::file`] says.
    pub(super) fn add(&mut self, text: Arc<Text>) -> u32 {
        self.texts.push(text);
        self.texts.len() as u32 - 1
    }

    /// The file of this number.
    pub(super) fn text(&self, file: u32) -> &Arc<Text> {
        &self.texts[file as usize]
    }

    /// Line and column.
    pub(super) fn place(&self, spot: Spot) -> Place {
        self.text(spot.file).place(spot.start)
    }

    /// The place with its line of text.
    pub(super) fn span(&self, spot: Spot) -> Span {
        self.text(spot.file).span(spot.start..spot.end)
    }

    /// Says that something is wrong there.
    pub(super) fn error(&mut self, spot: Spot, message: impl Into<String>) -> &mut Diagnostic {
        if self.is_full() {
            return self.count(Severity::Error);
        }
        let diagnostic = Diagnostic::error(message, self.span(spot));
        self.say(spot, diagnostic)
    }

    /// Says that something is worth knowing there.
    pub(super) fn warning(&mut self, spot: Spot, message: impl Into<String>) -> &mut Diagnostic {
        if self.is_full() {
            return self.count(Severity::Warning);
        }
        let diagnostic = Diagnostic::warning(message, self.span(spot));
        self.say(spot, diagnostic)
    }

    /// Says so where a file does not tell its version, unless something of its head was lost.
    pub(super) fn miss_version(&mut self, document: &DeTable<'_>, head: Spot) {
        if !document.contains_key("version") && !self.lost_something(head) {
            self.warning(head, "no `version` is given; read as version 1").help =
                Some("begin the file with `version = 1`".to_owned());
        }
    }

    /// Says this where `spot` is in the order of the text.
    pub(super) fn say(&mut self, spot: Spot, diagnostic: Diagnostic) -> &mut Diagnostic {
        if self.is_full() {
            return self.count(diagnostic.severity);
        }
        let mut order = self.text(spot.file).at.clone();
        order.push(spot.start);
        self.said.push((order, diagnostic));
        let last = self.said.len() - 1;
        &mut self.said[last].1
    }

    /// Whether no more is told, only counted: then no words need be found for it.
    pub(super) fn is_full(&self) -> bool {
        self.said.len() >= MOST
    }

    /// One more that is not told.
    pub(super) fn count(&mut self, severity: Severity) -> &mut Diagnostic {
        self.untold[usize::from(severity == Severity::Error)] += 1;
        &mut self.spare
    }

    /// Says what is wrong with a thing, each at the value of its key; whether nothing is.
    pub(super) fn judge(
        &mut self,
        spot_of: impl Fn(&str) -> Spot,
        judge: impl FnOnce(&mut Faults),
    ) -> bool {
        let mut faults = Faults::default();
        judge(&mut faults);
        let sound = faults.all.is_empty();
        for Fault { field, message, help } in faults.all {
            self.error(spot_of(field), message).help = help;
        }
        sound
    }

    /// Remembers that the tables which begin there lost a statement to a syntax error.
    pub(super) fn lose(&mut self, file: u32, lost: BTreeSet<usize>) {
        self.lost.extend(lost.into_iter().map(|start| (file, start)));
    }

    /// Whether the table at `spot` lost a statement: nothing can be said to be missing there.
    pub(super) fn lost_something(&self, spot: Spot) -> bool {
        self.lost.contains(&(spot.file, spot.start))
    }

    /// Says this where its place is, and shows the text that stands there.
    pub(super) fn say_located(&mut self, mut diagnostic: Diagnostic) {
        if self.is_full() {
            self.count(diagnostic.severity);
            return;
        }
        // What is of the scene as a whole is told where its text begins.
        if diagnostic.span.is_none() {
            let place = Place { file: self.texts[0].file.clone(), line: 1, column: 1 };
            diagnostic.span = Some(Span { place, ..Span::default() });
        }
        let mut at = Spot::new(0, 0..0);
        let labels = diagnostic.labels.iter_mut().map(|label| &mut label.span);
        for span in labels.chain(&mut diagnostic.span) {
            at = self.spot_of(&span.place);
            *span = self.span(at);
        }
        self.say(at, diagnostic);
    }

    /// The rest of the line from a place on, without a comment.
    fn spot_of(&self, place: &Place) -> Spot {
        let file = self.texts.iter().position(|text| text.file == place.file).unwrap_or(0);
        Spot::new(file as u32, self.texts[file].rest_of_line(place))
    }

    /// Whether an error was said.
    pub(super) fn has_errors(&self) -> bool {
        self.untold[1] > 0 || self.said.iter().any(|(_, diagnostic)| diagnostic.is_error())
    }

    /// All of it, in the order of the text, includes at their place; then how many more there are.
    pub(super) fn into_diagnostics(mut self) -> Vec<Diagnostic> {
        self.said.sort_by(|(a, _), (b, _)| a.cmp(b));
        let mut all: Vec<_> = self.said.into_iter().map(|(_, diagnostic)| diagnostic).collect();
        let [warnings, errors] = self.untold;
        let place = Place { file: Arc::clone(&self.texts[0].file), ..Place::default() };
        let span = Span { place, ..Span::default() };
        let more = |n: usize, what: &str| {
            let s = if n == 1 { "" } else { "s" };
            format!("and {n} more {what}{s}, beyond the first {MOST} problems, which are told")
        };
        if errors > 0 {
            all.push(Diagnostic::error(more(errors, "error"), span.clone()));
        }
        if warnings > 0 {
            all.push(Diagnostic::warning(more(warnings, "warning"), span));
        }
        all
    }
}
