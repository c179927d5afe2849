//! PLY, the Stanford polygon format.

use crate::format::model::Model;
use crate::{Diagnostic, Limits, Source};

/// Reads a PLY file; `None` if a diagnostic is an error. A file without faces is a cloud of
/// points, drawn as spheres of `default_radius` where the file gives none.
pub(crate) fn read_ply(
    path: &str,
    source: &dyn Source,
    limits: &Limits,
    default_radius: Option<f32>,
    out: &mut Vec<Diagnostic>,
) -> Option<Model> {
    let _ = (path, source, limits, default_radius);
    out.push(Diagnostic::error("PLY files cannot be read yet", None));
    None
}
