//! Letters as outlines.

use ttf_parser::OutlineBuilder;

use super::{Path, Point};

/// Collects the outlines of letters, font units up to the canvas's down.
pub(crate) struct Pen<'a> {
    /// What they are added to.
    pub(crate) path: &'a mut Path,
    /// Where the next letter stands.
    pub(crate) at: Point,
    /// Units of the canvas a unit of the font.
    pub(crate) scale: f64,
}

impl Pen<'_> {
    fn to(&self, x: f32, y: f32) -> Point {
        self.at + Point::new(f64::from(x), -f64::from(y)) * self.scale
    }
}

impl OutlineBuilder for Pen<'_> {
    fn move_to(&mut self, x: f32, y: f32) {
        self.path.move_to(self.to(x, y));
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.path.line_to(self.to(x, y));
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.path.quad_to(self.to(x1, y1), self.to(x, y));
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.path.cubic_to(self.to(x1, y1), self.to(x2, y2), self.to(x, y));
    }

    fn close(&mut self) {
        self.path.close();
    }
}
