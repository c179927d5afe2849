//! A drawing: marks on a canvas, in the order they are painted.
//!
//! [`svg`](super::svg) and [`raster`](super::raster) write the same marks, so a figure's SVG and
//! PNG cannot differ in content. Units are CSS pixels, y down.

use std::f64::consts::PI;

use glam::DVec2;
use phong::math::wide;

use super::style;
use super::text::{self, Run};

/// A place on the canvas.
pub(super) type Point = DVec2;

/// A colour with an opacity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ink {
    pub(super) srgb: [u8; 3],
    pub(super) opacity: f64,
}

impl Ink {
    pub(super) const fn rgb(r: u8, g: u8, b: u8) -> Self {
        Self { srgb: [r, g, b], opacity: 1.0 }
    }

    /// The same colour, seen through.
    pub(super) const fn fade(self, opacity: f64) -> Self {
        Self { opacity, ..self }
    }
}

/// A line's look.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stroke {
    pub(super) ink: Ink,
    pub(super) width: f64,
    pub(super) dashed: bool,
}

impl Stroke {
    pub(super) const fn new(ink: Ink, width: f64) -> Self {
        Self { ink, width, dashed: false }
    }

    pub(super) const fn dashed(self) -> Self {
        Self { dashed: true, ..self }
    }
}

/// One step of an outline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Step {
    Move(Point),
    Line(Point),
    Quad(Point, Point),
    Cubic(Point, Point, Point),
    Close,
}

/// An outline.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Path(pub(super) Vec<Step>);

impl Path {
    pub(super) fn move_to(&mut self, p: Point) {
        self.0.push(Step::Move(p));
    }
    pub(super) fn line_to(&mut self, p: Point) {
        self.0.push(Step::Line(p));
    }
    pub(super) fn quad_to(&mut self, c: Point, p: Point) {
        self.0.push(Step::Quad(c, p));
    }
    pub(super) fn cubic_to(&mut self, c: Point, d: Point, p: Point) {
        self.0.push(Step::Cubic(c, d, p));
    }
    pub(super) fn close(&mut self) {
        self.0.push(Step::Close);
    }

    /// Straight from point to point.
    pub(super) fn polyline(points: impl IntoIterator<Item = Point>) -> Self {
        let mut path = Self::default();
        for point in points {
            if path.0.is_empty() { path.move_to(point) } else { path.line_to(point) }
        }
        path
    }

    /// Straight from point to point and back to the first.
    pub(super) fn polygon(points: impl IntoIterator<Item = Point>) -> Self {
        let mut path = Self::polyline(points);
        path.close();
        path
    }

    /// Part of a circle, from one angle to another; degrees, anticlockwise from the right.
    pub(super) fn arc(center: Point, radius: f64, from: f64, to: f64) -> Self {
        let pieces = ((to - from).abs() / 45.0).ceil().max(1.0);
        let step = (to - from) / pieces;
        // The control points' distance that keeps a cubic within 4e-6 radii of the circle.
        let reach = 4.0 / 3.0 * wide::tan(step * PI / 720.0) * radius;
        let mut path = Self::default();
        path.move_to(center + radius * heading(from));
        for piece in 0..pieces as u32 {
            let (a, b) = (from + step * f64::from(piece), from + step * f64::from(piece + 1));
            let (p, q) = (center + radius * heading(a), center + radius * heading(b));
            path.cubic_to(p + reach * heading(a + 90.0), q - reach * heading(b + 90.0), q);
        }
        path
    }
}

/// The direction at `degrees` anticlockwise from the right, on a canvas whose y runs down.
pub(super) fn heading(degrees: f64) -> Point {
    let (sin, cos) = wide::sin_cos(degrees.to_radians());
    Point::new(cos, -sin)
}

/// Which point of a line of text stands at its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// A line of text.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Text {
    /// Where the baseline starts, is halved, or ends.
    pub(super) at: Point,
    pub(super) anchor: Anchor,
    pub(super) size: f64,
    pub(super) ink: Ink,
    pub(super) bold: bool,
    /// Whether it runs upwards.
    pub(super) upright: bool,
    pub(super) runs: Vec<Run>,
}

/// A picture of 8-bit sRGB pixels with straight alpha, rows from the top.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Bitmap {
    pub(super) width: u32,
    pub(super) height: u32,
    pub(super) rgba: Vec<u8>,
}

/// One thing painted.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Mark {
    Shape { path: Path, fill: Option<Ink>, stroke: Option<Stroke> },
    Text(Text),
    Image { at: Point, size: Point, bitmap: Bitmap },
}

/// Marks on a canvas.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Drawing {
    pub(super) size: Point,
    pub(super) marks: Vec<Mark>,
}

impl Drawing {
    /// An empty slide.
    pub(super) fn slide() -> Self {
        Self::sized(style::WIDTH, style::HEIGHT)
    }

    /// An empty canvas.
    pub(super) fn sized(width: f64, height: f64) -> Self {
        Self { size: Point::new(width, height), marks: Vec::new() }
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
