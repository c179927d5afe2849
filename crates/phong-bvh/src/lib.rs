//! Rays against primitives, eight at a time.
//!
//! The door is [`World`]: build it from [`Part`]s, which are [`Primitives`] written one by one or
//! instances of a [`Tree`], then ask [`World::intersect`] (the closest hit) or [`World::occluded`] (any
//! hit), for one ray or a bundle. This crate knows no colours, no scene and no files, and never imports
//! another crate of the project (but the stand-in for rayon where there are no threads).
//!
//! Results are the same bits on every SIMD level, for every build preset and thread count.

// It has no threads; everything else in this crate says `rayon`.
#[cfg(target_arch = "wasm32")]
extern crate serial as rayon;

mod aabb;
mod build;
mod eights;
mod frame;
mod geometry;
pub mod lanes;
mod level;
mod local;
mod node8;
mod primitives;
mod ray;
mod reference;
mod simd;
mod surface;
mod traverse;
mod tree;
#[cfg(test)]
mod validate;
mod world;

pub use aabb::Aabb;
pub use build::{BuildError, BuildOptions, Preset};
pub use eights::{Hits8, Rays8, halves, lanes, whole};
pub use geometry::{Canonical, Caps, Cylinder, Plane, Primitives, Solid, Sphere, Spheres};
pub use lanes::Lanes;
pub use level::{Kernel, Level};
pub use ray::{Coordinates, Cost, Hit, Ray, Surface};
pub use surface::{Surfaces8, offset_origin, offset_origins, offset_sides};
pub use tree::Tree;
pub use world::{Part, Stats, World};
