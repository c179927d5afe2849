//! A drawing: marks on a canvas, in the order they are painted.
//!
//! [`svg`](super::svg) and [`raster`](super::raster) write the same marks, so a figure's SVG and
//! PNG cannot differ in content. Units are CSS pixels, y down.

use super::mark::{Anchor, Bitmap, Ink, Mark, Path, Point, Stroke, Text, heading};
use super::{style, text};

/// Marks on a canvas.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Drawing {
    pub(super) size: Point,
    /// What the marks are painted on.
    pub(super) paper: Ink,
    pub(super) marks: Vec<Mark>,
}

impl Drawing {
    /// An empty slide.
    pub(super) fn slide() -> Self {
        Self::sized(style::WIDTH, style::HEIGHT)
    }

    /// An empty canvas.
    pub(super) fn sized(width: f64, height: f64) -> Self {
        Self { size: Point::new(width, height), paper: style::PAPER, marks: Vec::new() }
    }

    /// The same drawing on dark paper; pictures stay as they are.
    pub(super) fn on_dark(mut self) -> Self {
        self.paper = style::on_dark(self.paper);
        for mark in &mut self.marks {
            match mark {
                Mark::Shape { fill, stroke, .. } => {
                    *fill = fill.map(style::on_dark);
                    *stroke = stroke.map(|s| Stroke { ink: style::on_dark(s.ink), ..s });
                }
                Mark::Text(text) => text.ink = style::on_dark(text.ink),
                Mark::Image { .. } => {}
            }
        }
        self
    }

    pub(super) fn shape(&mut self, path: Path, fill: Option<Ink>, stroke: Option<Stroke>) {
        self.marks.push(Mark::Shape { path, fill, stroke });
    }

    pub(super) fn fill(&mut self, path: Path, ink: Ink) {
        self.shape(path, Some(ink), None);
    }

    pub(super) fn stroke(&mut self, path: Path, stroke: Stroke) {
        self.shape(path, None, Some(stroke));
    }

    pub(super) fn line(&mut self, from: Point, to: Point, stroke: Stroke) {
        self.stroke(Path::polyline([from, to]), stroke);
    }

    pub(super) fn circle(
        &mut self,
        center: Point,
        radius: f64,
        fill: Option<Ink>,
        stroke: Option<Stroke>,
    ) {
        let mut path = Path::arc(center, radius, 0.0, 360.0);
        path.close();
        self.shape(path, fill, stroke);
    }

    /// A point of the construction.
    pub(super) fn dot(&mut self, at: Point, ink: Ink) {
        self.circle(at, 4.5, Some(ink), None);
    }

    /// A shaft with a head at `to`.
    pub(super) fn arrow(&mut self, from: Point, to: Point, ink: Ink, width: f64) {
        let length = (to - from).length();
        if length < 1e-6 {
            return;
        }
        let along = (to - from) / length;
        let across = Point::new(-along.y, along.x);
        let head = (3.0 + 3.2 * width).min(length);
        let base = to - head * along;
        self.line(from, base + 0.5 * along, Stroke::new(ink, width));
        let wing = 0.42 * head * across;
        self.fill(Path::polygon([to, base + wing, base - wing]), ink);
    }

    /// A line of text; `markup` as in [`text::runs`].
    pub(super) fn text(&mut self, at: Point, anchor: Anchor, size: f64, ink: Ink, markup: &str) {
        self.put_text(Text {
            at,
            anchor,
            size,
            ink,
            bold: false,
            upright: false,
            runs: text::runs(markup),
        });
    }

    pub(super) fn put_text(&mut self, text: Text) {
        self.marks.push(Mark::Text(text));
    }

    /// A line of text whose middle, both ways, is `at`.
    pub(super) fn label(&mut self, at: Point, size: f64, ink: Ink, markup: &str) {
        self.text(at + Point::new(0.0, 0.33 * size), Anchor::Middle, size, ink, markup);
    }

    /// A point of a picture, and its letter on a plate that any picture leaves readable.
    pub(super) fn tag(&mut self, at: Point, aside: Point, markup: &str) {
        self.circle(at, 4.0, Some(style::PAPER), Some(Stroke::new(style::TEXT, 2.0)));
        self.circle(at + aside, 11.5, Some(style::PAPER.fade(0.92)), None);
        self.label(at + aside + Point::new(0.0, -2.0), 18.0, style::TEXT, markup);
    }

    pub(super) fn image(&mut self, at: Point, size: Point, bitmap: Bitmap) {
        self.marks.push(Mark::Image { at, size, bitmap });
    }

    /// Title and equation, at the same place in every figure.
    pub(super) fn header(&mut self, title: &str, equation: &str) {
        let y = 46.0;
        self.put_text(Text {
            at: Point::new(40.0, y),
            anchor: Anchor::Start,
            size: style::TITLE,
            ink: style::TEXT,
            bold: true,
            upright: false,
            runs: text::runs(title),
        });
        let right = Point::new(self.size.x - 40.0, y);
        self.text(right, Anchor::End, style::LETTER, style::TEXT, equation);
    }

    /// A panel's heading, over its middle.
    pub(super) fn heading(&mut self, at: Point, markup: &str) {
        self.text(at, Anchor::Middle, style::HEADING, style::TEXT, markup);
    }

    /// A muted remark, its middle at `at`.
    pub(super) fn note(&mut self, at: Point, markup: &str) {
        self.text(at, Anchor::Middle, style::NOTE, style::MUTED, markup);
    }

    /// An angle: an arc from one heading to another and a letter beyond its middle.
    pub(super) fn angle(
        &mut self,
        at: Point,
        radius: f64,
        [from, to]: [f64; 2],
        ink: Ink,
        markup: &str,
    ) {
        self.stroke(Path::arc(at, radius, from, to), Stroke::new(ink, style::LINE));
        let middle = at + (radius + 15.0) * heading(0.5 * (from + to));
        self.label(middle, 18.0, ink, markup);
    }

    /// A vector from `from` to `to` and its letter beyond the tip.
    pub(super) fn vector(&mut self, from: Point, to: Point, ink: Ink, markup: &str) {
        self.arrow(from, to, ink, style::VECTOR);
        let along = (to - from).normalize_or_zero();
        self.label(to + 16.0 * along, style::LETTER, ink, markup);
    }
}
