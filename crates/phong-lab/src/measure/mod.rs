//! What a scene takes: memory, and time for its rays.

mod geometry;
pub mod memory;
mod rays;

pub use geometry::Holdings;
pub use rays::{RaySpeed, Speeds};
