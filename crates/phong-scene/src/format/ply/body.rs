//! What binary and ASCII bodies share: the plan, the limits, and what is said.

use std::sync::Arc;

use super::edges::{EdgePlan, Edges};
use super::extras::{Extras, ExtrasPlan, Use};
use super::header::{Element, Header};
use super::names::{COLOR, UV};
use super::textures::Skins;
use super::vertices::{Plan, Vertices};
use crate::diagnostic::{Diagnostic, Span};
use crate::format::faces::{Faces, Kind};
use crate::format::input::Input;
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
    /// What of faces is read besides their vertices; `None`: nothing.
    pub(super) extras: Option<ExtrasPlan>,
    /// The images that the mesh shows.
    pub(super) skins: Skins,
    pub(super) vertex_count: u64,
    pub(super) findings: Findings,
}

/// What a body holds.
#[derive(Debug, Default)]
pub(super) struct Contents {
    pub(super) vertices: Vertices,
    pub(super) faces: Faces,
    pub(super) extras: Extras,
    pub(super) edges: Edges,
}

/// The property that lists a face's vertices.
#[derive(Clone, Copy, Debug)]
pub(super) struct FaceList {
    pub(super) property: usize,
    pub(super) kind: Kind,
}

impl Contents {
    /// Appends those of a later piece.
    pub(super) fn append(&mut self, later: Self) {
        self.vertices.append(later.vertices);
        self.extras.append(self.faces.indices.len(), later.extras);
        self.faces.append(later.faces);
        self.edges.append(later.edges);
    }

    /// Bytes that the faces take in memory.
    pub(super) fn face_bytes(&self) -> u64 {
        self.faces.bytes() + self.extras.bytes()
    }
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
                let read = self.extras.as_ref().filter(|_| element.name == "face");
                let message = match property.name.as_str() {
                    "red" | "diffuse_red" if read.is_none_or(|e| !e.has(Use::Color(0))) => {
                        if self.skins.any() {
                            "colours of faces are not used where they have a texture"
                        } else {
                            "colours of faces are not used, only those of vertices"
                        }
                    }
                    "texcoord" if read.is_none_or(|e| !e.has(Use::Uvs)) => {
                        "texture coordinates of faces are not used, only those of vertices"
                    }
                    "nx" => "normals of faces are not used, only those of vertices",
                    _ => continue,
                };
                self.findings.warning(
                    "things of faces that are not used",
                    || property.span.clone(),
                    || message.to_owned(),
                );
            }
        }
    }

    /// Finds out what of faces is read besides their vertices, and reads the images that it is for.
    pub(super) fn dress(&mut self, input: &Input<'_>) {
        let header = self.header;
        let face = header.elements.iter().find(|e| e.name == "face" && e.count > 0);
        let face = face.filter(|_| !self.plan.spheres);
        let plan = |colors| face.and_then(|element| ExtrasPlan::new(element, colors));
        let colors = self.plan.columns[COLOR].is_none();
        self.extras = plan(colors);
        let of_faces = self.extras.as_ref().is_some_and(|extras| extras.has(Use::Uvs));
        if of_faces || self.plan.columns[UV].is_some() {
            self.skins = Skins::read(header, input, &mut self.findings);
            if self.skins.any() && colors {
                self.extras = plan(false);
            }
            return;
        }
        for (name, span) in &header.textures {
            self.findings.warning(
                "textures",
                || span.clone(),
                || {
                    format!(
                        "the file names a texture, `{name}`, but no place for it: it is left out"
                    )
                },
            );
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
