//! What is wrong with an input, and where: data, without terminal or colour.

use std::fmt;
use std::ops::Range;
use std::sync::Arc;

/// A place in an input.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Place {
    /// The file as the user named it; empty: nowhere (made by the program).
    pub file: Arc<str>,
    /// Line from 1; 0: the file has no lines (binary), or the whole file is meant.
    pub line: u32,
    /// Column in characters from 1; 0 where `line` is 0.
    pub column: u32,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.line, self.column) {
            (0, _) => write!(f, "{}", self.file),
            (line, 0) => write!(f, "{}:{line}", self.file),
            (line, column) => write!(f, "{}:{line}:{column}", self.file),
        }
    }
}

/// A place with the text that stands there, enough to draw a caret under it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Span {
    /// Where it begins.
    pub place: Place,
    /// The line it begins on, without its end, cut to a sane length; empty: none to show.
    pub excerpt: String,
    /// Bytes of `excerpt` that are meant; on character boundaries, within it.
    pub range: Range<usize>,
}

/// How bad it is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// What became of what a file holds, where nothing is wrong: water that is not drawn.
    Note,
    /// Worth knowing; the scene is still what was meant.
    #[default]
    Warning,
    /// There is no scene.
    Error,
}

impl Severity {
    /// `note`, `warning` or `error`.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Note => "note",
            Self::Warning => "warning",
            Self::Error => "error",
        }
    }
}

/// A second place that helps to understand a diagnostic.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Label {
    /// What is to be seen there.
    pub message: String,
    /// Where.
    pub span: Span,
}

/// One thing to say about an input.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Diagnostic {
    /// How bad it is.
    pub severity: Severity,
    /// One sentence, lower case, without a full stop.
    pub message: String,
    /// Where; `None` only where no file is at fault.
    pub span: Option<Span>,
    /// The way out, if one is known: "did you mean `radius`?".
    pub help: Option<String>,
    /// Other places that matter.
    pub labels: Vec<Label>,
}

impl Diagnostic {
    /// An error at a place.
    pub fn error(message: impl Into<String>, span: impl Into<Option<Span>>) -> Self {
        Self::new(Severity::Error, message, span)
    }

    /// A warning at a place.
    pub fn warning(message: impl Into<String>, span: impl Into<Option<Span>>) -> Self {
        Self::new(Severity::Warning, message, span)
    }

    /// A note about a place.
    pub fn note(message: impl Into<String>, span: impl Into<Option<Span>>) -> Self {
        Self::new(Severity::Note, message, span)
    }

    fn new(severity: Severity, message: impl Into<String>, span: impl Into<Option<Span>>) -> Self {
        let (message, span) = (message.into(), span.into());
        Self { severity, message, span, help: None, labels: Vec::new() }
    }

    /// The same with a way out.
    #[must_use]
    pub fn with_help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// The same with another place that matters.
    #[must_use]
    pub fn with_label(mut self, message: impl Into<String>, span: Span) -> Self {
        self.labels.push(Label { message: message.into(), span });
        self
    }

    /// Whether this is a note: nothing is wrong.
    pub fn is_note(&self) -> bool {
        self.severity == Severity::Note
    }

    /// Whether this is an error.
    pub fn is_error(&self) -> bool {
        self.severity == Severity::Error
    }
}

/// Why there is no scene: everything there is to say, at least one of it an error.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneError(pub Vec<Diagnostic>);

impl std::error::Error for SceneError {}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, diagnostic) in self.0.iter().enumerate() {
            let separator = if i == 0 { "" } else { "\n" };
            write!(f, "{separator}{diagnostic}")?;
        }
        Ok(())
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(span) = &self.span {
            write!(f, "{}: ", span.place)?;
        }
        write!(f, "{}: {}", self.severity.word(), self.message)?;
        self.help.as_ref().map_or(Ok(()), |help| write!(f, " ({help})"))
    }
}
