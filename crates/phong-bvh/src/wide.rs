//! One formula in f64 at two widths: for a number, or for four side by side.

use std::ops::{Add, Div, Mul, Sub};

use fearless_simd::{Simd, f64x4, prelude::*};

/// A number in f64, or four: a formula written for it takes the same steps for both, and has the same
/// bits.
pub trait Wide:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Add<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
{
    /// `value`, as often as this is wide.
    #[must_use]
    fn like(self, value: f64) -> Self;
    /// The square root.
    #[must_use]
    fn root(self) -> Self;
    /// Without its sign.
    #[must_use]
    fn size(self) -> Self;
    /// `yes` where this is above `other`, else `no`.
    #[must_use]
    fn above(self, other: Self, yes: Self, no: Self) -> Self;

    /// The larger one.
    #[must_use]
    #[inline(always)]
    fn or_larger(self, other: Self) -> Self {
        self.above(other, self, other)
    }
}

impl Wide for f64 {
    #[inline(always)]
    fn like(self, value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn root(self) -> Self {
        self.sqrt()
    }
    #[inline(always)]
    fn size(self) -> Self {
        self.abs()
    }
    #[inline(always)]
    fn above(self, other: Self, yes: Self, no: Self) -> Self {
        if self > other { yes } else { no }
    }
}

impl<S: Simd> Wide for f64x4<S> {
    #[inline(always)]
    fn like(self, value: f64) -> Self {
        Self::splat(self.token(), value)
    }
    #[inline(always)]
    fn root(self) -> Self {
        self.sqrt()
    }
    #[inline(always)]
    fn size(self) -> Self {
        self.abs()
    }
    #[inline(always)]
    fn above(self, other: Self, yes: Self, no: Self) -> Self {
        self.simd_gt(other).select(yes, no)
    }
}
