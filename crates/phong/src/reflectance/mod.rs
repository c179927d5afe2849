//! How a surface answers one light: the lecture's terms, one model a file.
//!
//! The letters are the lecture's: `n` normal, `l` to the light, `r` its mirror image, `e` to the
//! eye, `h` halfway; all unit, all away from the surface.

mod terms;

pub use terms::{Incident, Terms};
