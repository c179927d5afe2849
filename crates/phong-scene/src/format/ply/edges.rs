//! Edges: pairs of vertex numbers become cylinders.

use super::header::Element;
use super::names::{Row, WIDTH};
use super::vertices::Transfer;
use crate::color::Rgb;
use crate::format::faces::out_of_range;
use crate::format::text::Findings;

/// What a number of an edge can be: places in [`Row`], whose others are not used.
const VERTEX: usize = 0;
const END_RADIUS: usize = 2;
const COLOR: usize = 4;

/// Names of each place of a row; the first that the file has counts.
const NAMES: [&[&str]; 7] = [
    &["vertex1"],
    &["vertex2"],
    &["radius1", "radius"],
    &["radius2", "radius"],
    &["red", "diffuse_red", "r"],
    &["green", "diffuse_green", "g"],
    &["blue", "diffuse_blue", "b"],
];

/// Which properties of edges are used, for what.
#[derive(Clone, Debug)]
pub(super) struct EdgePlan {
    /// For every place of a row the property that it comes from.
    pub(super) columns: [Option<usize>; WIDTH],
    color: Transfer,
    vertex_count: u64,
    /// The radius of edges that bring none; `None`: that of their vertices.
    pub(super) radius: Option<f32>,
}

/// Whether edges bring a radius of their own, or one for each end.
pub(super) fn have_radius(element: &Element) -> bool {
    element.find("radius").is_some()
        || (element.find("radius1").is_some() && element.find("radius2").is_some())
}

impl EdgePlan {
    /// Finds out what the properties are; `None` if `findings` hold an error about them.
    pub(super) fn new(
        element: &Element,
        vertex_count: u64,
        radius: Option<f32>,
        findings: &mut Findings,
    ) -> Option<Self> {
        let mut columns = [None; WIDTH];
        for (column, names) in columns.iter_mut().zip(NAMES) {
            *column = names.iter().find_map(|name| element.find(name));
        }
        for group in [END_RADIUS..COLOR, COLOR..COLOR + 3] {
            if columns[group.clone()].contains(&None) {
                columns[group].fill(None);
            }
        }
        for place in [VERTEX, VERTEX + 1] {
            let name = NAMES[place][0];
            match columns[place].map(|column| &element.properties[column]) {
                None => findings.error(
                    "edges without vertices",
                    || element.span.clone(),
                    || format!("the edges have no property `{name}`"),
                ),
                Some(property) if property.kind.is_float() => findings.error(
                    "edges without vertices",
                    || property.span.clone(),
                    || "vertex numbers must be integers".to_owned(),
                ),
                Some(_) => {}
            }
        }
        let kinds = [0, 1, 2].map(|i| columns[COLOR + i].map(|p| element.properties[p].kind));
        let color = Transfer::of(kinds);
        (!findings.any_error()).then_some(Self { columns, color, vertex_count, radius })
    }

    /// Whether cylinders get their radii from vertices.
    pub(super) fn uses_vertex_radii(&self) -> bool {
        self.columns[END_RADIUS].is_none() && self.radius.is_none()
    }

    pub(super) fn has_colors(&self) -> bool {
        self.columns[COLOR].is_some()
    }

    /// What is wrong with an edge; `None`: nothing.
    fn blame(&self, row: &Row) -> Option<String> {
        for number in &row[VERTEX..END_RADIUS] {
            let whole = *number as i64;
            if whole as f64 != *number {
                return Some(format!("`{number}` is no number of a vertex"));
            }
            if whole < 0 || whole as u64 >= self.vertex_count {
                return Some(out_of_range(whole, self.vertex_count));
            }
        }
        if self.columns[END_RADIUS].is_some() {
            for radius in &row[END_RADIUS..COLOR] {
                if !(*radius as f32).is_finite() || *radius as f32 <= 0.0 {
                    return Some(format!(
                        "its radius is {radius}, but must be a finite number above 0"
                    ));
                }
            }
        }
        if self.has_colors() && self.color.linear(&row[COLOR..COLOR + 3]).is_none() {
            return Some(format!("its colour is not {}", self.color.words()));
        }
        None
    }
}

/// Edges read so far.
#[derive(Debug, Default)]
pub(super) struct Edges {
    pub(super) ends: Vec<[u32; 2]>,
    /// Empty: the file has none.
    pub(super) radii: Vec<[f32; 2]>,
    /// Empty: the file has none.
    pub(super) colors: Vec<Rgb>,
}

impl Edges {
    /// Adds an edge; what is wrong with it, if anything.
    pub(super) fn add(&mut self, plan: &EdgePlan, row: &Row) -> Result<(), String> {
        if let Some(fault) = plan.blame(row) {
            return Err(fault);
        }
        self.ends.push([row[VERTEX] as u32, row[VERTEX + 1] as u32]);
        if plan.columns[END_RADIUS].is_some() {
            self.radii.push([row[END_RADIUS] as f32, row[END_RADIUS + 1] as f32]);
        }
        if plan.has_colors() {
            self.colors.push(plan.color.linear(&row[COLOR..COLOR + 3]).unwrap_or(Rgb::BLACK));
        }
        Ok(())
    }

    /// Makes room for so many more.
    pub(super) fn reserve(&mut self, plan: &EdgePlan, count: usize) {
        self.ends.reserve(count);
        if plan.columns[END_RADIUS].is_some() {
            self.radii.reserve(count);
        }
        if plan.has_colors() {
            self.colors.reserve(count);
        }
    }

    /// Adds those of a later piece.
    pub(super) fn append(&mut self, mut later: Self) {
        self.ends.append(&mut later.ends);
        self.radii.append(&mut later.radii);
        self.colors.append(&mut later.colors);
    }
}
