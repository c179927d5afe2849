//! What writing a scene gives: files, and an account of what became of the scene.

pub(crate) mod flat;
pub(crate) mod merge;
mod split;
pub(crate) mod tessellate;
pub(crate) mod tint;

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::io::{self, Write};

pub(crate) use split::split_all;

use crate::diagnostic::Diagnostic;
use crate::scene::Scene;

/// How numbers stand in a PLY file that is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PlyEncoding {
    /// Bytes, least significant first: small, and fast to read.
    #[default]
    Binary,
    /// Text that reads back to the same bits.
    Ascii,
}

/// How a writer is to write.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Writing {
    /// The name of the format, for what is said.
    pub(crate) format: &'static str,
    /// How numbers stand in PLY files.
    pub(crate) ply: PlyEncoding,
    /// Whether the scene's camera and lights are automatic: then nothing is lost without them.
    pub(crate) bare: bool,
    /// Bytes of memory that unfolded instances may take.
    pub(crate) max_bytes: u64,
    /// Whether the images of textures are written beside a TOML file.
    pub(crate) images: bool,
}

/// Writes a scene as a file of this name and those beside it.
pub(crate) type WriteScene =
    fn(Scene, &Writing, &str, &mut Account) -> Result<Vec<File>, Box<Diagnostic>>;

/// What was carried over, how, and what the format cannot hold.
#[derive(Clone, Debug, Default)]
pub struct Account {
    /// How many things of each kind are in the files.
    pub carried: BTreeMap<&'static str, usize>,
    /// What is in the files in another form, a sentence each, with the formula.
    pub mapped: Vec<String>,
    /// What is not in the files: warnings at the places where it was written.
    pub dropped: Vec<Diagnostic>,
}

impl Account {
    /// So many more of a kind are carried over.
    pub(crate) fn carry(&mut self, kind: &'static str, count: usize) {
        if count > 0 {
            *self.carried.entry(kind).or_default() += count;
        }
    }

    pub(crate) fn map(&mut self, how: String) {
        self.mapped.push(how);
    }

    pub(crate) fn drop(&mut self, what: Diagnostic) {
        self.dropped.push(what);
    }
}

/// Writes a file's bytes.
type Content = Box<dyn Fn(&mut dyn Write) -> io::Result<()> + Send + Sync>;

/// A file to be written.
pub struct File {
    /// Its name: the one that was asked for, or that of one beside it.
    pub name: String,
    content: Content,
}

impl fmt::Debug for File {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("File").field("name", &self.name).finish_non_exhaustive()
    }
}

impl File {
    /// A file that `content` writes.
    pub(crate) fn new(
        name: impl Into<String>,
        content: impl Fn(&mut dyn Write) -> io::Result<()> + Send + Sync + 'static,
    ) -> Self {
        Self { name: name.into(), content: Box::new(content) }
    }

    /// A file of this text.
    pub(crate) fn text(name: impl Into<String>, text: String) -> Self {
        Self::new(name, move |to| to.write_all(text.as_bytes()))
    }

    /// Writes all of it.
    ///
    /// # Errors
    /// Whatever `to` says.
    pub fn write(&self, to: &mut dyn Write) -> io::Result<()> {
        (self.content)(to)
    }
}

/// The name, or with a number behind it the first that is not taken; it is then.
pub(crate) fn free_name(name: &str, taken: &mut BTreeSet<String>) -> String {
    let numbered = (2..).map(|n| format!("{name} {n}"));
    let free = std::iter::once(name.to_owned()).chain(numbered).find(|n| !taken.contains(n));
    let free = free.unwrap_or_default();
    taken.insert(free.clone());
    free
}
