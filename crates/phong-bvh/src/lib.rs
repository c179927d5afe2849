//! Rays against primitives, eight at a time.
//!
//! The door is [`Bvh`]: build it from [`Primitives`], then ask [`Bvh::intersect`] (the closest hit)
//! or [`Bvh::occluded`] (any hit), for one ray or a bundle. This crate knows no colours, no scene
//! and no files, and never imports another crate of the project.
//!
//! Results are the same bits on every SIMD level, for every build preset and thread count.

mod aabb;
mod build;
mod bvh;
mod eights;
mod geometry;
pub mod lanes;
mod level;
mod node8;
mod primitives;
mod ray;
mod reference;
mod simd;
mod surface;
mod traverse;
#[cfg(test)]
mod validate;

pub use aabb::Aabb;
pub use bvh::{BuildError, BuildOptions, Bvh, Cost, Preset, Stats};
pub use eights::{Hits8, Rays8, lanes};
pub use geometry::{Canonical, Plane, Primitives, Solid, Sphere};
pub use lanes::Lanes;
pub use level::{Kernel, Level};
pub use ray::{Coordinates, Hit, Ray, Surface};
pub use surface::{Surfaces8, offset_origin};
