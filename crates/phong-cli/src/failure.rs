//! Why a command did not do what was asked, and the exit code that says so.

use std::io;
use std::path::Path;

use phong::render::OptionsError;
use phong_scene::{Diagnostic, trouble};

/// Why a command did not do what was asked.
#[derive(Debug)]
pub(crate) enum Failure {
    /// The answer is "no", and has been given. Exit code 1.
    No,
    /// The command line is at fault. Exit code 2.
    Usage {
        message: String,
        /// The way out.
        help: Option<String>,
    },
    /// The input is at fault. Exit code 2.
    Input(Vec<Diagnostic>),
    /// The input is at fault, and that has been told in full. Exit code 2.
    Told,
    /// Something else went wrong. Exit code 3.
    System(String),
    /// A signal interrupted the work, such as 2, Ctrl-C. Exit code 128 and its number.
    Interrupted(u8),
    /// Whoever read standard output has had enough. Nothing to say; exit code 0.
    ReaderGone,
}

impl From<OptionsError> for Failure {
    fn from(error: OptionsError) -> Self {
        Self::usage(error.to_string())
    }
}

impl From<Box<Diagnostic>> for Failure {
    fn from(error: Box<Diagnostic>) -> Self {
        Self::Input(vec![*error])
    }
}

impl Failure {
    /// The command line is at fault.
    pub(crate) fn usage(message: impl Into<String>) -> Self {
        Self::Usage { message: message.into(), help: None }
    }

    /// The same with a way out.
    #[must_use]
    pub(crate) fn with_help(self, way_out: impl Into<String>) -> Self {
        match self {
            Self::Usage { message, .. } => Self::Usage { message, help: Some(way_out.into()) },
            other => other,
        }
    }

    /// Standard input failed.
    pub(crate) fn stdin(error: &io::Error) -> Self {
        let message = format!("cannot read standard input: {}", trouble(error));
        match error.kind() {
            io::ErrorKind::IsADirectory => {
                Self::usage(message).with_help("give it a file, or the output of a program")
            }
            _ => Self::System(message),
        }
    }

    /// Standard output failed.
    pub(crate) fn stdout(error: &io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::BrokenPipe => Self::ReaderGone,
            _ => Self::System(format!("cannot write to standard output: {}", trouble(error))),
        }
    }

    /// A file that is there could not be read.
    pub(crate) fn reading(path: &Path, error: &io::Error) -> Self {
        Self::System(format!("cannot read {}: {}", path.display(), trouble(error)))
    }

    /// What went wrong, in one line.
    pub(crate) fn summary(&self) -> String {
        match self {
            Self::Usage { message, .. } | Self::System(message) => message.clone(),
            Self::Input(diagnostics) => {
                diagnostics.first().map(ToString::to_string).unwrap_or_default()
            }
            Self::No | Self::Told | Self::Interrupted(_) | Self::ReaderGone => String::new(),
        }
    }

    /// The exit code that says so.
    pub(crate) fn code(&self) -> u8 {
        match self {
            Self::ReaderGone => 0,
            Self::No => 1,
            Self::Usage { .. } | Self::Input(_) | Self::Told => 2,
            Self::System(_) => 3,
            Self::Interrupted(signal) => 128 + signal,
        }
    }
}
