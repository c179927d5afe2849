//! What readers are given.

use crate::change::Change;
use crate::diagnostic::Diagnostic;
use crate::fragment::Fragment;
use crate::limits::Limits;
use crate::molecule::{Drawing, Topology};
use crate::scene::Reading;
use crate::source::Source;

/// A file to be read.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Input<'a> {
    /// Its path, as whoever names it wrote it.
    pub(crate) path: &'a str,
    /// Where it and the files that it names are opened.
    pub(crate) source: &'a dyn Source,
    pub(crate) limits: &'a Limits,
    /// Radius of the points for which the file gives none; `None`: the reader guesses one.
    pub(crate) radius: Option<f32>,
    /// What of it is wanted.
    pub(crate) wanted: Wanted,
    /// How atoms are drawn; `None`: as it suits them.
    pub(crate) drawing: Option<&'a Drawing>,
    /// What is laid over its text.
    pub(crate) changes: &'a [Change],
    /// Bonds of earlier frames; `None`: there are no frames.
    pub(crate) topology: Option<&'a Topology>,
    /// The properties of points that maps show; only files of points have some.
    pub(crate) fields: &'a [String],
}

/// What of a file is wanted, where it could be read in more than one way.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Wanted {
    /// Whatever it holds.
    #[default]
    Anything,
    /// Its points.
    Points,
    /// Its segments, as cylinders.
    Segments,
}

impl<'a> Input<'a> {
    /// The file at a path, where nobody says how large points are.
    pub(crate) fn new(path: &'a str, source: &'a dyn Source, limits: &'a Limits) -> Self {
        Self {
            path,
            source,
            limits,
            radius: None,
            wanted: Wanted::Anything,
            drawing: None,
            changes: &[],
            topology: None,
            fields: &[],
        }
    }
}

/// Reads a model; `None` if a diagnostic is an error.
pub(crate) type ReadModel = fn(&Input<'_>, &mut Vec<Diagnostic>) -> Option<Fragment>;

/// Reads a scene with its camera; the models that it names are found among these.
pub(crate) type ReadScene = fn(&Input<'_>, &'static Models) -> Reading;

/// The table of formats as scenes see it, which stands above all readers.
#[derive(Debug)]
pub(crate) struct Models {
    /// What a path names, by what the file begins with, or else by its ending.
    pub(crate) find: fn(&str, &dyn Source) -> Named,
    /// What models are read from, as a way out.
    pub(crate) help: fn() -> String,
}

/// What a file is.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Named {
    /// A model that this reads.
    Model(ReadModel),
    /// A scene of our own text.
    Scene,
    /// Of a format of this name that holds scenes, which nothing takes a part of.
    Foreign(&'static str),
    /// Of a format of this name that is known, but not read.
    Refused(&'static str),
    /// The name does not say.
    Unknown,
}
