//! A batch: which pictures are to be made of which inputs.
//!
//! ```toml
//! version = 1
//! inputs = ["balls.toml"]
//! output = "sweep"
//! name = "{scene}-{shininess}-{frame}.png"
//! options = "--size 320x180 --samples 4"
//!
//! [parameters]
//! "materials.red.shininess" = [1, 10, 100]
//! "camera.eye" = { from = [0, 2, 8], to = [4, 2, 8], steps = 5 }
//!
//! [slurm]
//! time = "0:30:00"
//! ```

use std::ops::Range;
use std::sync::Arc;

use crate::change::{Change, toml_string};
use crate::diagnostic::{Diagnostic, Span};

/// What a batch file says, every key of it checked; its inputs are not looked for yet.
#[derive(Clone, Debug)]
pub struct Batch {
    /// Scenes and models, or patterns of them, relative to the batch file's folder.
    pub inputs: Vec<Written>,
    /// The folder to write to, relative to the batch file's. `None`: named like the batch file.
    pub output: Option<Written>,
    /// The pattern of pictures' names. `None`: the input's name and the values of all parameters.
    pub name: Option<Written>,
    /// Options of `phong render`. `None`: there are none.
    pub options: Option<Written>,
    /// Whether inputs and parameters go in step, instead of each with every other.
    pub zip: bool,
    /// Tasks that each picture is divided into, at least 1.
    pub shares: u32,
    /// Threads of each task. `None`: one a core.
    pub threads: Option<u32>,
    /// What differs from picture to picture, in the order of the text.
    pub parameters: Vec<Parameter>,
    /// Options of `sbatch` and their values, in the order of the text. An empty value: the option
    /// has none.
    pub slurm: Vec<(Written, String)>,
}

/// Text of a batch file with its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Written {
    /// What is written.
    pub text: String,
    /// Where.
    pub span: Span,
}

/// What differs from picture to picture.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// The path of a scene's key.
    pub path: Written,
    /// Its values.
    pub values: ParameterValues,
    pub(crate) source: ChangeSource,
}

/// The values of a parameter.
#[derive(Clone, Debug)]
pub enum ParameterValues {
    /// These, at least one.
    Changes(Vec<Change>),
    /// The files that a pattern stands for, relative to the batch file's folder:
    /// [`Parameter::file`] makes a value of each.
    Files(Written),
}

/// The text that changes are written in.
#[derive(Clone, Debug)]
pub(crate) struct ChangeSource {
    pub(crate) file: Arc<str>,
    pub(crate) text: Arc<str>,
    pub(crate) path_at: usize,
    pub(crate) value_at: Range<usize>,
}

impl Parameter {
    /// The file at `path` as a value.
    pub fn file(&self, path: &str) -> Change {
        self.source.change(&self.path.text, toml_string(path), self.source.value_at.start)
    }
}

impl ChangeSource {
    pub(crate) fn change(&self, path: &str, value: String, value_at: usize) -> Change {
        Change {
            file: Arc::clone(&self.file),
            text: Arc::clone(&self.text),
            path: path.to_owned(),
            path_at: self.path_at,
            value,
            value_at,
        }
    }
}

/// A batch file as it was read.
#[derive(Clone, Debug, Default)]
pub struct BatchReading {
    /// The batch; `None` if a diagnostic is an error.
    pub batch: Option<Batch>,
    /// All there is to say about it.
    pub diagnostics: Vec<Diagnostic>,
}
