//! One formula at two widths: for a number, or for eight numbers side by side.
//!
//! What every ray needs is written once, for any [`Real`]. Eight numbers take the very steps that
//! one takes, so each has the same bits; only the choice of the rare road differs.

use std::ops::{Add, Div, Mul, Sub};

use fearless_simd::{Simd, f32x8, mask32x8, prelude::*};
use glam::Vec3;

use super::dir::{Dir3, LARGE, SMALL};
use super::pow::{lobe, lobe8};

/// A number, or eight.
pub(crate) trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Add<f32, Output = Self>
    + Mul<f32, Output = Self>
{
    /// `value`, as often as this is wide.
    fn like(self, value: f32) -> Self;

    /// This where it is above 0, else 0.
    fn positive(self) -> Self;

    /// The square root; of what is below 0, that of 0.
    fn root(self) -> Self;

    /// `yes` where this is below `other`, else `no`.
    fn below(self, other: Self, yes: Self, no: Self) -> Self;

    /// [`lobe`].
    fn lobe(self, alpha: f32) -> Self;

    /// `f` of each number: the way to do what eight cannot do at once.
    fn each(self, f: impl Fn(f32) -> f32) -> Self;

    /// The direction of `v`, as [`Dir3::new`] has it; 0 where there is none.
    fn unit(v: [Self; 3]) -> [Self; 3];
}

impl Real for f32 {
    #[inline(always)]
    fn like(self, value: f32) -> Self {
        value
    }

    #[inline(always)]
    fn positive(self) -> Self {
        self.max(0.0)
    }

    #[inline(always)]
    fn root(self) -> Self {
        self.positive().sqrt()
    }

    #[inline(always)]
    fn below(self, other: Self, yes: Self, no: Self) -> Self {
        if self < other { yes } else { no }
    }

    #[inline(always)]
    fn lobe(self, alpha: f32) -> Self {
        lobe(self, alpha)
    }

    #[inline(always)]
    fn each(self, f: impl Fn(f32) -> f32) -> Self {
        f(self)
    }

    #[inline(always)]
    fn unit(v: [Self; 3]) -> [Self; 3] {
        Dir3::new(Vec3::from(v)).map_or([0.0; 3], Dir3::to_array)
    }
}

impl<S: Simd> Real for f32x8<S> {
    #[inline(always)]
    fn like(self, value: f32) -> Self {
        Self::splat(self.token(), value)
    }

    #[inline(always)]
    fn positive(self) -> Self {
        let zero = self.like(0.0);
        self.simd_gt(zero).select(self, zero)
    }

    #[inline(always)]
    fn root(self) -> Self {
        self.positive().sqrt()
    }

    #[inline(always)]
    fn below(self, other: Self, yes: Self, no: Self) -> Self {
        self.simd_lt(other).select(yes, no)
    }

    #[inline(always)]
    fn lobe(self, alpha: f32) -> Self {
        lobe8(self.token(), self, alpha)
    }

    #[inline(always)]
    fn each(self, f: impl Fn(f32) -> f32) -> Self {
        let mut lanes: [f32; 8] = self.into();
        for lane in &mut lanes {
            *lane = f(*lane);
        }
        Self::simd_from(self.token(), lanes)
    }

    #[inline(always)]
    fn unit(v: [Self; 3]) -> [Self; 3] {
        let simd = v[0].token();
        let square = dot(v, v);
        let plain = square.simd_gt(square.like(SMALL)) & square.simd_lt(square.like(LARGE));
        let length = square.sqrt();
        let unit = [v[0] / length, v[1] / length, v[2] / length];
        if plain.all_true() {
            return unit;
        }
        // One of them is tiny, huge or none: those few one by one.
        let (mut lanes, v) = (store3(unit), store3(v));
        let plain = plain.to_bitmask();
        for i in (0..8).filter(|i| plain >> i & 1 == 0) {
            let [x, y, z] = f32::unit([v[0][i], v[1][i], v[2][i]]);
            (lanes[0][i], lanes[1][i], lanes[2][i]) = (x, y, z);
        }
        load3(simd, &lanes)
    }
}

/// Three coordinates, eight of each.
pub(crate) type Lanes3 = [[f32; 8]; 3];

/// Three coordinates from memory.
#[inline(always)]
pub(crate) fn load3<S: Simd>(simd: S, [x, y, z]: &Lanes3) -> [f32x8<S>; 3] {
    [f32x8::load_array_ref(simd, x), f32x8::load_array_ref(simd, y), f32x8::load_array_ref(simd, z)]
}

/// Three coordinates to memory.
#[inline(always)]
pub(crate) fn store3<S: Simd>([x, y, z]: [f32x8<S>; 3]) -> Lanes3 {
    [x.into(), y.into(), z.into()]
}

/// The same three numbers eight times.
#[inline(always)]
pub(crate) fn splat3<S: Simd>(simd: S, [x, y, z]: [f32; 3]) -> [f32x8<S>; 3] {
    [f32x8::splat(simd, x), f32x8::splat(simd, y), f32x8::splat(simd, z)]
}

/// Three coordinates, of each eight `lanes` from `yes`, the others from `no`.
#[inline(always)]
pub(crate) fn select3<S: Simd>(
    lanes: mask32x8<S>,
    yes: [f32x8<S>; 3],
    no: [f32x8<S>; 3],
) -> [f32x8<S>; 3] {
    [lanes.select(yes[0], no[0]), lanes.select(yes[1], no[1]), lanes.select(yes[2], no[2])]
}

/// Three numbers of one lane.
#[inline]
pub(crate) fn get(lanes: &Lanes3, lane: usize) -> [f32; 3] {
    [lanes[0][lane], lanes[1][lane], lanes[2][lane]]
}

/// Three numbers into one lane.
#[inline]
pub(crate) fn set(lanes: &mut Lanes3, lane: usize, [x, y, z]: [f32; 3]) {
    (lanes[0][lane], lanes[1][lane], lanes[2][lane]) = (x, y, z);
}

/// The direction in one lane, unit.
#[inline]
pub(crate) fn direction(lanes: &Lanes3, lane: usize) -> Dir3 {
    Dir3::from_unit(Vec3::from(get(lanes, lane)))
}

/// The dot product.
#[inline(always)]
pub(crate) fn dot<F: Real>([ax, ay, az]: [F; 3], [bx, by, bz]: [F; 3]) -> F {
    ax * bx + ay * by + az * bz
}

/// The sum.
#[inline(always)]
pub(crate) fn add<F: Real>([ax, ay, az]: [F; 3], [bx, by, bz]: [F; 3]) -> [F; 3] {
    [ax + bx, ay + by, az + bz]
}

/// `k v`.
#[inline(always)]
pub(crate) fn times<F: Real>(k: F, [x, y, z]: [F; 3]) -> [F; 3] {
    [k * x, k * y, k * z]
}

/// `R = 2(L·N)N − L`: [`Dir3::mirror`].
#[inline(always)]
pub(crate) fn mirror<F: Real>(n: [F; 3], l: [F; 3]) -> [F; 3] {
    let twice = dot(l, n) * 2.0;
    [twice * n[0] - l[0], twice * n[1] - l[1], twice * n[2] - l[2]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eight_directions_have_the_bits_of_one_the_extreme_ones_too() {
        let simd = fearless_simd::Fallback::new();
        let all = [0.3, -1.0, 1e-30, 0.0, 1e25, -2e-12, 7.0, f32::INFINITY];
        for turn in 0..8 {
            let mut v: Lanes3 = [all; 3];
            v[1].rotate_left(turn);
            v[2].rotate_right(3);
            let eight = store3(f32x8::unit(load3(simd, &v)));
            for i in 0..8 {
                let one = f32::unit([v[0][i], v[1][i], v[2][i]]);
                assert_eq!([eight[0][i], eight[1][i], eight[2][i]], one, "{v:?}");
            }
        }
    }
}
