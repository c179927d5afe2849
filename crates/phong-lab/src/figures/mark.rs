//! The marks that a drawing is made of: outlines, lines of text, and bitmaps.

use std::f64::consts::PI;

use glam::DVec2;
use phong::math::wide;

/// A place on the canvas.
pub(crate) type Point = DVec2;

/// A colour with an opacity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Ink {
    pub(crate) srgb: [u8; 3],
    pub(crate) opacity: f64,
}

impl Ink {
    pub(crate) const fn rgb(r: u8, g: u8, b: u8) -> Self {
        Self { srgb: [r, g, b], opacity: 1.0 }
    }

    /// The same colour, seen through.
    pub(crate) const fn fade(self, opacity: f64) -> Self {
        Self { opacity, ..self }
    }
}

/// A line's look.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stroke {
    pub(crate) ink: Ink,
    pub(crate) width: f64,
    pub(crate) dashed: bool,
}

impl Stroke {
    pub(crate) const fn new(ink: Ink, width: f64) -> Self {
        Self { ink, width, dashed: false }
    }

    pub(super) const fn dashed(self) -> Self {
        Self { dashed: true, ..self }
    }
}

/// One step of an outline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Step {
    Move(Point),
    Line(Point),
    Quad(Point, Point),
    Cubic(Point, Point, Point),
    Close,
}

/// An outline.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Path(pub(crate) Vec<Step>);

impl Path {
    pub(crate) fn move_to(&mut self, p: Point) {
        self.0.push(Step::Move(p));
    }
    pub(crate) fn line_to(&mut self, p: Point) {
        self.0.push(Step::Line(p));
    }
    pub(crate) fn quad_to(&mut self, c: Point, p: Point) {
        self.0.push(Step::Quad(c, p));
    }
    pub(crate) fn cubic_to(&mut self, c: Point, d: Point, p: Point) {
        self.0.push(Step::Cubic(c, d, p));
    }
    pub(crate) fn close(&mut self) {
        self.0.push(Step::Close);
    }

    /// The same elsewhere.
    pub(crate) fn moved(&self, by: Point) -> Self {
        Self(
            self.0
                .iter()
                .map(|step| match *step {
                    Step::Move(p) => Step::Move(p + by),
                    Step::Line(p) => Step::Line(p + by),
                    Step::Quad(c, p) => Step::Quad(c + by, p + by),
                    Step::Cubic(c, d, p) => Step::Cubic(c + by, d + by, p + by),
                    Step::Close => Step::Close,
                })
                .collect(),
        )
    }

    /// Every point of it, those that its curves are only drawn towards as well.
    pub(crate) fn points(&self) -> impl Iterator<Item = Point> {
        self.0.iter().flat_map(|step| match *step {
            Step::Move(p) | Step::Line(p) => vec![p],
            Step::Quad(c, p) => vec![c, p],
            Step::Cubic(c, d, p) => vec![c, d, p],
            Step::Close => Vec::new(),
        })
    }

    /// Straight from point to point.
    pub(crate) fn polyline(points: impl IntoIterator<Item = Point>) -> Self {
        let mut path = Self::default();
        for point in points {
            if path.0.is_empty() { path.move_to(point) } else { path.line_to(point) }
        }
        path
    }

    /// Straight from point to point and back to the first.
    pub(crate) fn polygon(points: impl IntoIterator<Item = Point>) -> Self {
        let mut path = Self::polyline(points);
        path.close();
        path
    }

    /// Part of a circle, from one angle to another; degrees, anticlockwise from the right.
    pub(crate) fn arc(center: Point, radius: f64, from: f64, to: f64) -> Self {
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

/// A stretch of text in one face and at one height.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Run {
    pub(super) words: String,
    pub(super) italic: bool,
    pub(super) script: Script,
}

/// Where a run stands against the line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Script {
    Line,
    Below,
    Above,
}

impl Script {
    /// Size relative to the line's.
    pub(super) fn scale(self) -> f64 {
        if self == Self::Line { 1.0 } else { 0.7 }
    }

    /// How far the baseline sinks, in ems of the line.
    pub(super) fn drop(self) -> f64 {
        match self {
            Self::Line => 0.0,
            Self::Below => 0.18,
            Self::Above => -0.38,
        }
    }
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
