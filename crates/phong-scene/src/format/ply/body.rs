//! What binary and ASCII bodies share: the plan, the limits, and what is said.

use std::sync::Arc;

use super::edges::{EdgePlan, Edges};
use super::header::{Element, Header};
use super::vertices::{Plan, Vertices};
use crate::diagnostic::{Diagnostic, Span};
use crate::format::faces::{Faces, Kind};
use crate::format::text::{Findings, whole};
use crate::limits::Limits;
use crate::source::Blob;

/// Positions that are looked at to find the origin.
pub(super) const ORIGIN_SAMPLES: u64 = 4096;

/// A body that is being read.
pub(super) struct Body<'a> {
    pub(super) blob: &'a dyn Blob,
    pub(super) file: &'a Arc<str>,
    pub(super) header: &'a Header,
    pub(super) limits: &'a Limits,
    pub(super) plan: Plan,
    /// How edges are read; `None`: they are not.
    pub(super) edges: Option<EdgePlan>,
    pub(super) vertex_count: u64,
    pub(super) findings: Findings,
}

/// What a body holds.
#[derive(Debug, Default)]
pub(super) struct Contents {
    pub(super) vertices: Vertices,
    pub(super) faces: Faces,
    pub(super) edges: Edges,
}

/// The property that lists a face's vertices.
#[derive(Clone, Copy, Debug)]
pub(super) struct FaceList {
    pub(super) property: usize,
    pub(super) kind: Kind,
}

/// What kind of faces an element holds, if any.
pub(super) fn face_kind(element: &Element) -> Option<Kind> {
    match element.name.as_str() {
        "face" => Some(Kind::Face),
        "tristrips" => Some(Kind::Strip),
        _ => None,
    }
}

/// The list that makes an element's rows faces; `None` if it holds none.
fn face_list(element: &Element) -> Option<FaceList> {
    let kind = face_kind(element)?;
    let named =
        |name: &str| element.properties.iter().position(|p| p.name == name && p.list.is_some());
    let property = named("vertex_indices").or_else(|| named("vertex_index"))?;
    Some(FaceList { property, kind })
}

impl Body<'_> {
    /// Whether `triangles` that take `bytes` are within the limits, beside the vertices; an error
    /// if not.
    pub(super) fn has_room(&mut self, triangles: u64, bytes: u64) -> bool {
        let Limits { bytes: most, vertices, triangles: most_triangles, .. } = *self.limits;
        let needed = self.vertex_count.saturating_mul(self.plan.bytes()).saturating_add(bytes);
        let message = if self.vertex_count > vertices {
            format!(
                "the model has {} vertices, more than the {vertices} allowed",
                self.vertex_count
            )
        } else if triangles > most_triangles {
            format!("the model has more than {most_triangles} triangles")
        } else if needed > most {
            format!("the model takes {needed} bytes of memory or more; {most} are allowed")
        } else {
            return true;
        };
        let span = self.whole();
        self.findings.error("limits exceeded", || span, || message);
        false
    }

    /// The list that makes an element's rows faces; `None` if it holds none, or none are wanted.
    pub(super) fn face_list(&self, element: &Element) -> Option<FaceList> {
        if self.edges.is_some() { None } else { face_list(element) }
    }

    /// Says what of faces cannot be read, and what is left out.
    pub(super) fn check_faces(&mut self) {
        let header = self.header;
        for element in header.elements.iter().filter(|e| face_kind(e).is_some() && e.count > 0) {
            if self.edges.is_some() {
                self.findings.warning(
                    "faces beside edges",
                    || element.span.clone(),
                    || "faces are not drawn where the edges are".to_owned(),
                );
                continue;
            }
            match face_list(element) {
                None => {
                    let name = &element.name;
                    self.findings.error(
                        "faces without vertices",
                        || element.span.clone(),
                        || format!("the element `{name}` has no list `vertex_indices`"),
                    );
                }
                Some(list) if element.properties[list.property].kind.is_float() => {
                    let span = &element.properties[list.property].span;
                    self.findings.error(
                        "faces without vertices",
                        || span.clone(),
                        || "vertex numbers must be integers".to_owned(),
                    );
                }
                Some(_) => {}
            }
            for property in &element.properties {
                let what = match property.name.as_str() {
                    "red" | "diffuse_red" => "colours of faces are",
                    "texcoord" => "texture coordinates of faces are",
                    "nx" => "normals of faces are",
                    _ => continue,
                };
                self.findings.warning(
                    "things of faces that are not used",
                    || property.span.clone(),
                    || format!("{what} not used, only those of vertices"),
                );
            }
        }
    }

    pub(super) fn tell_truncated(&mut self, element: &Element, there: u64) {
        let (name, count, span) = (&element.name, element.count, self.whole());
        let severity = self.plan.damage();
        self.findings.add(severity, "truncated bodies", || Diagnostic {
            severity,
            message: format!("the file ends after {there} of {count} rows of the element `{name}`"),
            span: Some(span),
            ..Diagnostic::default()
        });
    }

    pub(super) fn warn(&mut self, plural: &'static str, tell: impl FnOnce() -> String) {
        let span = self.whole();
        self.findings.warning(plural, || span, tell);
    }

    pub(super) fn whole(&self) -> Span {
        whole(self.file)
    }
}
