//! From edges to cylinders.

use std::io;

use rayon::prelude::*;

use super::body::Body;
use super::edges::{EdgePlan, Edges};
use super::header::Element;
use super::names::RADIUS;
use super::vertices::{Vertices, tell};
use super::walk::Walk;
use crate::color::Rgb;
use crate::format::text::Findings;
use crate::mesh::{Cylinders, Field};

/// An end that is not there.
const NOWHERE: [f32; 4] = [f32::NAN; 4];

/// Bytes that an edge takes while it is read, in a piece and among all, and as a cylinder.
const BYTES: u64 = 28 + 28 + 56;

impl Body<'_> {
    /// Whether so many edges are within the limits; an error if not.
    pub(super) fn has_room_for_edges(&mut self) -> bool {
        let header = self.header;
        let edges = header.elements.iter().find(|e| e.name == "edge" && self.edges.is_some());
        let count = edges.map_or(0, |element| element.count);
        let most = self.limits.vertices;
        if count > most {
            let span = self.whole();
            self.findings.error(
                "limits exceeded",
                || span,
                || format!("the model has {count} edges, more than the {most} allowed"),
            );
            return false;
        }
        self.has_room(0, count.saturating_mul(BYTES))
    }

    /// Reads edges; where they end, or `None` after an error.
    pub(super) fn walk_edges(
        &mut self,
        plan: &EdgePlan,
        element: &Element,
        offset: u64,
        edges: &mut Edges,
    ) -> io::Result<Option<u64>> {
        let mut walk = Walk::new(self, offset);
        let mut findings = Findings::default();
        let mut values = Vec::with_capacity(element.properties.len());
        for number in 0..element.count {
            if !walk.row(element, &mut values)? {
                self.tell_truncated(element, number);
                return Ok(None);
            }
            let row = plan.columns.map(|column| column.map_or(0.0, |c| values[c]));
            if let Err(fault) = edges.add(plan, &row) {
                let severity = self.plan.damage();
                tell(&mut findings, severity, || self.whole(), "edge", number, &fault);
            }
        }
        self.findings.append(findings);
        Ok(Some(walk.offset()))
    }

    /// The cylinders along the edges.
    pub(super) fn cylinders(
        &mut self,
        plan: &EdgePlan,
        vertices: Vertices,
        edges: &Edges,
    ) -> Option<Cylinders> {
        if plan.uses_vertex_radii() && self.plan.columns[RADIUS].is_none() {
            let header = self.header;
            let edge = header.elements.iter().find(|element| element.name == "edge");
            let span = edge.map_or_else(|| self.whole(), |element| element.span.clone());
            self.findings.error(
                "edges without a radius",
                || span,
                || {
                    "the edges have no radius: neither they nor their vertices have a property \
                 `radius`; write `radius = ..`, that of the cylinders"
                        .to_owned()
                },
            );
            return None;
        }
        let (spheres, colors, of_ends) = vertices.into_ends(&self.plan);
        let each = || edges.ends.par_iter().enumerate();
        // A vertex without a place was left out, and one may be missing from a file cut short.
        let segment = |(i, ends): (usize, &[u32; 2])| {
            let mut segment = ends.map(|end| spheres.get(end as usize).copied().unwrap_or(NOWHERE));
            let radii =
                edges.radii.get(i).copied().or_else(|| plan.radius.map(|radius| [radius; 2]));
            if let Some([radius, radius_to]) = radii {
                (segment[0][3], segment[1][3]) = (radius, radius_to);
            }
            segment
        };
        let mut segments: Vec<[[f32; 4]; 2]> = each().map(segment).collect();
        let color = |end: u32| colors.get(end as usize).copied().unwrap_or(Rgb::BLACK);
        let mut pairs: Vec<[Rgb; 2]> = match (edges.colors.is_empty(), colors.is_empty()) {
            (false, _) => edges.colors.par_iter().map(|color| [*color; 2]).collect(),
            (true, false) => each().map(|(_, ends)| ends.map(color)).collect(),
            (true, true) => Vec::new(),
        };
        let of_field = |field: &Field| -> Vec<[f32; 2]> {
            let of = |end: u32| field.values.get(end as usize).copied().unwrap_or(f32::NAN);
            each().map(|(_, ends)| ends.map(of)).collect()
        };
        let mut fields: Vec<_> = of_ends.iter().map(of_field).collect();
        let sound = |end: &[f32; 4]| end.iter().all(|v| v.is_finite()) && end[3] > 0.0;
        let kept: Vec<bool> = segments.par_iter().map(|ends| ends.iter().all(sound)).collect();
        let gone = kept.iter().filter(|kept| !**kept).count();
        if gone > 0 {
            keep(&mut segments, &kept);
            keep(&mut pairs, &kept);
            for values in &mut fields {
                keep(values, &kept);
            }
            self.warn("edges without their vertices", || {
                format!("edges of which a vertex is left out: {gone}; they are left out")
            });
        }
        if segments.is_empty() {
            let span = self.whole();
            self.findings.error(
                "empty models",
                || span,
                || "there is nothing to draw: no edge is left".to_owned(),
            );
            return None;
        }
        Some(Cylinders {
            origin: self.plan.origin,
            segments: segments.into(),
            colors: pairs.into(),
            fields: (of_ends.into_iter().zip(fields))
                .map(|(field, values)| Field {
                    name: field.name,
                    values: values.into_flattened().into(),
                })
                .collect(),
            ..Cylinders::default()
        })
    }
}

/// Of these values those that are kept; there may be none at all.
fn keep<T>(values: &mut Vec<T>, kept: &[bool]) {
    let mut kept = kept.iter();
    values.retain(|_| kept.next().is_some_and(|kept| *kept));
}
