//! The marks that a drawing is made of: outlines, lines of text, and bitmaps.

pub(super) use crate::draw::{Ink, Path, Point, Stroke, heading};

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
