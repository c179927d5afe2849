//! Directions, and the only home of `pow`, `sin`, `cos` and their kin.
//!
//! Std's and glam's transcendental functions differ between platforms; pictures may not. Square
//! roots are exact by IEEE 754, so `f32::sqrt` needs no home here.

mod dir;
mod pow;

pub use dir::{Dir3, reflect};
pub use pow::{lobe, pow};
