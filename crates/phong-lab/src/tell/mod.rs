//! An [`Explanation`](phong::explain::Explanation) as text, JSON, LaTeX, SVG, and a page of HTML.
//!
//! Nothing is computed here that the picture is made of: what is written are the numbers that the
//! integrator told, and the factors they are products of.

mod diagnostic;
pub mod html;
mod json;
mod latex;
mod numbers;
mod packed;
mod product;
mod svg;
mod text;

pub use diagnostic::diagnostic;
pub use json::json;
pub use latex::latex;
pub use svg::svg;
pub use text::text;

/// How an explanation is told.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Telling {
    /// Which sample is told in full, from 0. `None`: all of them; where only one can be told, the
    /// first.
    pub sample: Option<usize>,
    /// Whether mirror and glass rays are told that bring less than half a level of 255.
    pub full: bool,
    /// Significant digits of every number. `None`: all there are; in LaTeX five.
    pub digits: Option<usize>,
}
