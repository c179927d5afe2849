//! Directions, and the only home of `pow`, `sin`, `cos` and their kin.

mod dir;

pub use dir::{Dir3, reflect};
