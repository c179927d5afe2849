//! Our own scene text.
//!
//! Reading gives everything there is to say in one go, in the order of the text (at most 20 syntax
//! errors a file, and 100,000 diagnostics in all, to bound memory; beyond that their number):
//! `syntax` tells all syntax errors and takes the faulty statements out, `table` and `value` hold
//! every table against its table of [`keys`](crate::keys), the concepts' files (`settings
//! material texture shape file`) say what only several keys together can be wrong about, `resolve` and
//! `groups` look every name up, and [`check`](crate::check) adds what can hardly be meant.

pub(crate) mod batch;
pub(crate) mod camera_path;
mod change;
mod draft;
mod file;
mod groups;
mod material;
mod molecule;
mod notes;
mod path;
mod reader;
mod resolve;
mod reuse;
mod settings;
mod shape;
mod syntax;
mod table;
mod text;
mod texture;
mod value;
pub(crate) mod write;

use crate::change::Change;
use crate::diagnostic::Diagnostic;
use crate::format::input::{Input, Models, ReadModel};
use crate::fragment::Fragment;
use crate::scene::Reading;

/// Reads a scene and what it includes.
pub(crate) fn read(input: &Input<'_>, models: &'static Models) -> Reading {
    let Input { path, source, limits, changes, topology, .. } = *input;
    let values: Vec<String> = changes.iter().map(Change::document).collect();
    match text::load(path, source, limits) {
        Ok(text) => {
            let mut reader = reader::Reader::new(source, limits, models);
            reader.topology = topology;
            let (scene, diagnostics) = reader.read(path, text, changes, &values);
            Reading { scene, bare: false, diagnostics }
        }
        Err(message) => {
            Reading { diagnostics: vec![text::unreadable(path, &message)], ..Reading::default() }
        }
    }
}

/// Reads a bare file of atoms as a `[[molecule]]` that has nothing but this file, and over which the input's changes
/// lie; `None` if a diagnostic is an error.
pub(crate) fn read_molecule(
    input: &Input<'_>,
    read: ReadModel,
    models: &'static Models,
    out: &mut Vec<Diagnostic>,
) -> Option<Fragment> {
    let Input { source, limits, changes, topology, .. } = *input;
    let values: Vec<String> = changes.iter().map(Change::document).collect();
    let mut reader = reader::Reader::new(source, limits, models);
    reader.topology = topology;
    reader.bare_molecule(input, read, changes, &values, out)
}
