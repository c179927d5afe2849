//! The shapes rays can meet, one a file: its derivation, then its code.
//!
//! Planes and solids are solved in f64. A solid is a [canonical shape](crate::Canonical) under an
//! affine transform, so its ray is taken to the shape's own space, where
//!
//! 1. the ray starts anew at the point closest to the shape's middle. Seen from far away the roots
//!    of a quadratic or quartic differ by little from each other and much from zero, and their
//!    difference drowns in rounding; seen from the shape itself they do not;
//! 2. the shape's file lists all [`Crossings`](crossing::Crossings) of the whole line, in order;
//! 3. the first one strictly inside the ray's interval *as f32* is the hit, so that what is compared
//!    is what is returned.
//!
//! An affine map keeps `t`: the point at `t` in one space is the point at `t` in the other.

mod box_;
pub(crate) mod capsule;
mod cone;
pub(crate) mod crossing;
mod cylinder;
mod disc;
pub(crate) mod ellipsoid;
mod facet;
pub(crate) mod patch;
pub(crate) mod plane;
pub(crate) mod ray_frame;
pub(crate) mod solid;
pub(crate) mod sphere;
pub(crate) mod tapered;
mod torus;
pub(crate) mod triangle;

use fearless_simd::{Simd, f32x8, prelude::*};

/// Three numbers, each in eight lanes.
///
/// Kernels spell such steps out: what `array::map` calls is compiled apart, without the level's
/// instructions, and cost half of the speed.
#[inline(always)]
pub(crate) fn splat3<S: Simd>(simd: S, [x, y, z]: [f32; 3]) -> [f32x8<S>; 3] {
    [f32x8::splat(simd, x), f32x8::splat(simd, y), f32x8::splat(simd, z)]
}
