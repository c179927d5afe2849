//! What is drawn with, by figures and by furniture: outlines and ink, as pixels and as SVG.

mod pen;
mod pixels;
mod svg;

use std::f64::consts::PI;

use glam::DVec2;
use phong::math::wide;

pub(crate) use pen::Pen;
pub(crate) use pixels::{color, fill, stroke};
pub(crate) use svg::{number, paint, shape};

/// The lengths of a dash and of the gap after it.
const DASH: [f64; 2] = [6.0, 6.0];

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

    pub(crate) const fn dashed(self) -> Self {
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
pub(crate) fn heading(degrees: f64) -> Point {
    let (sin, cos) = wide::sin_cos(degrees.to_radians());
    Point::new(cos, -sin)
}
