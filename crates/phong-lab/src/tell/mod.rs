//! An [`Explanation`](phong::explain::Explanation) as text, JSON, LaTeX, SVG, and a page of HTML.
//!
//! Nothing is computed here that the picture is made of: what is written are the numbers that the
//! integrator told, and the factors they are products of.

pub mod html;
mod json;
mod latex;
mod numbers;
mod product;
mod svg;
mod text;

pub use json::json;
pub use latex::latex;
pub use svg::svg;
pub use text::text;
