//! Lines around things, drawn when the picture is done.
//!
//! ```toml
//! [outline]
//! width = 1.5
//! color = "#203040"
//! ```
//!
//! | key | value | default | meaning |
//! |---|---|---|---|
//! | `width` | a number above 0 | `1` | Width of the lines in points: 72 are an inch, by the `dpi` of `[image]`. |
//! | `color` | a colour: a number, `[r, g, b]`, "#rrggbb" or a CSS name | `0` | Colour of the lines. |
//! | `objects` | `true` or `false` | `true` | Whether lines run where one object ends before another or before the background. |
//! | `depth` | a number 0 or above | `0.02` | Lines run within an object where the distance jumps by more than this share of it; 0: nowhere. |
//! | `crease` | a number from 0 to 180 | `40` | Lines run within an object where it turns by more than so many degrees from pixel to pixel; 180: nowhere. |

use crate::color::Rgb;
use crate::limits::Range;

/// Lines around things, drawn when the picture is done: they are no term of the sum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outline {
    /// Width in points, > 0. Default 1.
    pub width: f64,
    /// Colour, linear. Default black.
    pub color: Rgb,
    /// Whether lines run where one object ends. Default true.
    pub objects: bool,
    /// The least jump of the distance within an object, as a share of it, ≥ 0; 0: none counts.
    /// Default 0.02.
    pub depth: f64,
    /// The least angle by which an object turns from pixel to pixel, degrees, 0 to 180; 180: none
    /// counts. Default 40.
    pub crease: f64,
}

impl Outline {
    /// Angles.
    pub(crate) const CREASE: Range = Range::closed(0.0, 180.0);
}

impl Default for Outline {
    fn default() -> Self {
        Self { width: 1.0, color: Rgb::BLACK, objects: true, depth: 0.02, crease: 40.0 }
    }
}
