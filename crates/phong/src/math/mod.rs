//! Directions, and the only home of `pow`, `sin`, `cos` and their kin.
//!
//! Std's and glam's transcendental functions differ between platforms; pictures may not. Square
//! roots are exact by IEEE 754, so `f32::sqrt` needs no home here.

mod dir;
mod elementary;
mod frame;
pub(crate) mod lanes;
mod pow;
pub mod wide;

pub use dir::{Dir3, reflect};
pub use elementary::{acos, asin, atan2, cos, erfc, exp, ln, sin, sin_cos, tan};
pub use frame::Frame;
pub(crate) use pow::Lobe;
pub use pow::{lobe, pow};
