//! Wavefront OBJ.

use crate::format::model::Model;
use crate::{Diagnostic, Limits, Source};

/// Reads an OBJ file and the MTL files it names; `None` if a diagnostic is an error.
pub(crate) fn read_obj(
    path: &str,
    source: &dyn Source,
    limits: &Limits,
    out: &mut Vec<Diagnostic>,
) -> Option<Model> {
    let _ = (path, source, limits);
    out.push(Diagnostic::error("OBJ files cannot be read yet", None));
    None
}
