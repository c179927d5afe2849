//! One formula at every width: for a number, or for several side by side.
//!
//! What every ray needs is written once, over [`Lanes`]. Each lane takes the steps that a number alone
//! takes, so it has the same bits.

use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

use fearless_simd::{Simd, SimdBase, SimdFloat, f32x8, f64x4, mask32x8, mask64x4, prelude::*};

/// A number, or several numbers side by side: one lane each.
pub trait Lanes:
    Copy
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Add<Self::Scalar, Output = Self>
    + Sub<Self::Scalar, Output = Self>
    + Mul<Self::Scalar, Output = Self>
    + Div<Self::Scalar, Output = Self>
{
    /// The number in one lane.
    type Scalar: Copy;
    /// A truth value for each lane.
    type Mask: Copy
        + BitAnd<Output = Self::Mask>
        + BitOr<Output = Self::Mask>
        + Not<Output = Self::Mask>;

    /// `value` in every lane.
    #[must_use]
    fn splat(self, value: Self::Scalar) -> Self;

    /// The square root; NaN below 0.
    #[must_use]
    fn sqrt(self) -> Self;

    /// The absolute value.
    #[must_use]
    fn abs(self) -> Self;

    /// This where it is above 0, else 0; unspecified where it is NaN.
    #[must_use]
    fn above_zero(self) -> Self;

    /// Where this is less than `other`.
    fn lt(self, other: Self) -> Self::Mask;

    /// Where this is greater than `other`.
    fn gt(self, other: Self) -> Self::Mask;

    /// Where this equals `other`.
    fn eq(self, other: Self) -> Self::Mask;

    /// `yes` where the mask is set, else `no`.
    #[must_use]
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;

    /// Whether the mask is set in every lane.
    fn all(mask: Self::Mask) -> bool;

    /// `f` of each lane by itself: for what vector code cannot do.
    #[must_use]
    fn map(self, f: impl Fn(Self::Scalar) -> Self::Scalar) -> Self;

    /// `f` of each lane by itself where the mask is set, else `no`: for what is rare.
    #[must_use]
    fn map3_where(
        mask: Self::Mask,
        of: [Self; 3],
        no: [Self; 3],
        f: impl Fn([Self::Scalar; 3]) -> [Self::Scalar; 3],
    ) -> [Self; 3];

    /// This where it is greater than `other`, else `other`, also where either is NaN.
    #[must_use]
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self::select(self.gt(other), self, other)
    }

    /// This where it is greater than `least`, else `least`, also where it is NaN.
    #[must_use]
    #[inline(always)]
    fn at_least(self, least: Self::Scalar) -> Self {
        self.max(self.splat(least))
    }
}

macro_rules! lanes {
    ($scalar:ident, $vector:ident, $mask:ident, $width:literal) => {
        impl Lanes for $scalar {
            type Scalar = Self;
            type Mask = bool;

            #[inline(always)]
            fn splat(self, value: Self) -> Self {
                value
            }

            #[inline(always)]
            fn sqrt(self) -> Self {
                $scalar::sqrt(self)
            }

            #[inline(always)]
            fn abs(self) -> Self {
                $scalar::abs(self)
            }

            #[inline(always)]
            fn above_zero(self) -> Self {
                $scalar::max(self, 0.0)
            }

            #[inline(always)]
            fn lt(self, other: Self) -> bool {
                self < other
            }

            #[inline(always)]
            fn gt(self, other: Self) -> bool {
                self > other
            }

            #[inline(always)]
            fn eq(self, other: Self) -> bool {
                self == other
            }

            #[inline(always)]
            fn select(mask: bool, yes: Self, no: Self) -> Self {
                if mask { yes } else { no }
            }

            #[inline(always)]
            fn all(mask: bool) -> bool {
                mask
            }

            #[inline(always)]
            fn map(self, f: impl Fn(Self) -> Self) -> Self {
                f(self)
            }

            #[inline(always)]
            fn map3_where(
                mask: bool,
                of: [Self; 3],
                no: [Self; 3],
                f: impl Fn([Self; 3]) -> [Self; 3],
            ) -> [Self; 3] {
                if mask { f(of) } else { no }
            }
        }

        impl<S: Simd> Lanes for $vector<S> {
            type Scalar = $scalar;
            type Mask = $mask<S>;

            #[inline(always)]
            fn splat(self, value: $scalar) -> Self {
                SimdBase::splat(self.token(), value)
            }

            #[inline(always)]
            fn sqrt(self) -> Self {
                SimdFloat::sqrt(self)
            }

            #[inline(always)]
            fn abs(self) -> Self {
                SimdBase::abs(self)
            }

            #[inline(always)]
            fn above_zero(self) -> Self {
                let zero: Self = SimdBase::splat(self.token(), 0.0);
                SimdBase::max(self, zero)
            }

            #[inline(always)]
            fn lt(self, other: Self) -> $mask<S> {
                self.simd_lt(other)
            }

            #[inline(always)]
            fn gt(self, other: Self) -> $mask<S> {
                self.simd_gt(other)
            }

            #[inline(always)]
            fn eq(self, other: Self) -> $mask<S> {
                self.simd_eq(other)
            }

            #[inline(always)]
            fn select(mask: $mask<S>, yes: Self, no: Self) -> Self {
                mask.select(yes, no)
            }

            #[inline(always)]
            fn all(mask: $mask<S>) -> bool {
                mask.all_true()
            }

            #[inline(always)]
            fn map(self, f: impl Fn($scalar) -> $scalar) -> Self {
                let mut lanes: [$scalar; $width] = self.into();
                for lane in &mut lanes {
                    *lane = f(*lane);
                }
                Self::load_array(self.token(), lanes)
            }

            #[inline(always)]
            fn map3_where(
                mask: $mask<S>,
                [x, y, z]: [Self; 3],
                no: [Self; 3],
                f: impl Fn([$scalar; 3]) -> [$scalar; 3],
            ) -> [Self; 3] {
                let of: [[$scalar; $width]; 3] = [x.into(), y.into(), z.into()];
                let mut lanes: [[$scalar; $width]; 3] = [no[0].into(), no[1].into(), no[2].into()];
                let mut left = mask.to_bitmask();
                while left != 0 {
                    let i = left.trailing_zeros() as usize % $width;
                    left &= left - 1;
                    let [x, y, z] = f([of[0][i], of[1][i], of[2][i]]);
                    (lanes[0][i], lanes[1][i], lanes[2][i]) = (x, y, z);
                }
                let simd = x.token();
                [
                    Self::load_array(simd, lanes[0]),
                    Self::load_array(simd, lanes[1]),
                    Self::load_array(simd, lanes[2]),
                ]
            }
        }
    };
}

lanes!(f32, f32x8, mask32x8, 8);
lanes!(f64, f64x4, mask64x4, 4);

/// `a · b`.
#[inline(always)]
pub fn dot<F: Lanes>(a: [F; 3], b: [F; 3]) -> F {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// `a × b`.
#[inline(always)]
pub fn cross<F: Lanes>(a: [F; 3], b: [F; 3]) -> [F; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// `a + b`.
#[inline(always)]
pub fn add<F: Lanes>(a: [F; 3], b: [F; 3]) -> [F; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// `a − b`.
#[inline(always)]
pub fn sub<F: Lanes>(a: [F; 3], b: [F; 3]) -> [F; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// `−v`.
#[inline(always)]
pub fn neg<F: Lanes>(v: [F; 3]) -> [F; 3] {
    [-v[0], -v[1], -v[2]]
}

/// `k v`.
#[inline(always)]
pub fn scale<F: Lanes>(k: F, v: [F; 3]) -> [F; 3] {
    [k * v[0], k * v[1], k * v[2]]
}

/// The same three numbers in every lane of which `like` has one.
#[inline(always)]
pub fn splat3<F: Lanes>(like: F, v: [F::Scalar; 3]) -> [F; 3] {
    [like.splat(v[0]), like.splat(v[1]), like.splat(v[2])]
}

/// `yes` where the mask is set, else `no`.
#[inline(always)]
pub fn select3<F: Lanes>(mask: F::Mask, yes: [F; 3], no: [F; 3]) -> [F; 3] {
    [F::select(mask, yes[0], no[0]), F::select(mask, yes[1], no[1]), F::select(mask, yes[2], no[2])]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_operation_of_eight_lanes_has_the_bits_of_one() {
        let simd = fearless_simd::Fallback::new();
        let odd = [0.0, -0.0, 1.5, -2.25, 1e-40, f32::INFINITY, f32::NEG_INFINITY, f32::NAN];
        for turn in 0..8 {
            let mut other = odd;
            other.rotate_left(turn);
            let (a, b) = (f32x8::load_array(simd, odd), f32x8::load_array(simd, other));
            let all = |f: &dyn Fn(f32, f32) -> f32| -> [u32; 8] {
                std::array::from_fn(|i| f(odd[i], other[i]).to_bits())
            };
            let bits = |v: f32x8<_>| <[f32; 8]>::from(v).map(f32::to_bits);
            assert_eq!(bits(Lanes::max(a, b)), all(&|a, b| Lanes::max(a, b)));
            assert_eq!(bits(a.at_least(0.0)), all(&|a, _| a.at_least(0.0)));
            // Of −0 either 0 may come, and of NaN anything.
            let above = <[f32; 8]>::from(a.above_zero());
            assert!((0..8).all(|i| odd[i].is_nan() || above[i] == odd[i].above_zero()));
            assert_eq!(bits(Lanes::abs(a)), all(&|a, _| a.abs()));
            let select = |a, b| f32::select(Lanes::lt(a, b), a, b);
            assert_eq!(bits(f32x8::select(Lanes::lt(a, b), a, b)), all(&select));
            assert_eq!(bits(a.map(|x| x + 1.0)), all(&|a, _| a + 1.0));
        }
    }
}
