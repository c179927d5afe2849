//! What shading needs of [`Lanes`] of f32 beyond their arithmetic, and three numbers of each lane in memory.

use fearless_simd::{Simd, f32x8, f64x4, mask32x8, prelude::*};
use glam::Vec3;
use phong_bvh::Lanes;
pub(crate) use phong_bvh::lanes::{add, cross, dot, neg, scale, select3, splat3, sub};

use super::dir::{Dir3, LARGE, SMALL};

/// The direction of `v`, as [`Dir3::new`] has it; 0 where there is none.
#[inline(always)]
pub(crate) fn normalize<F: Lanes<Scalar = f32>>(v: [F; 3]) -> [F; 3] {
    let square = dot(v, v);
    let plain = square.gt(square.splat(SMALL)) & square.lt(square.splat(LARGE));
    let length = square.sqrt();
    let unit = [v[0] / length, v[1] / length, v[2] / length];
    if F::all(plain) {
        return unit;
    }
    F::map3_where(!plain, v, unit, |v| Dir3::new(Vec3::from(v)).map_or([0.0; 3], Dir3::to_array))
}

/// `R = 2(L·N)N − L`: [`Dir3::mirror`].
#[inline(always)]
pub(crate) fn mirror<F: Lanes<Scalar = f32>>(n: [F; 3], l: [F; 3]) -> [F; 3] {
    let twice = dot(l, n) * 2.0;
    [twice * n[0] - l[0], twice * n[1] - l[1], twice * n[2] - l[2]]
}

/// Sine and cosine of up to an eighth of a turn, `|x| ≤ π/4`: their series, to rounding.
#[inline(always)]
pub(crate) fn sin_cos_of_eighth<F: Lanes<Scalar = f32>>(x: F) -> (F, F) {
    let square = x * x;
    let sin = square * (1.0 / 362_880.0) - 1.0 / 5_040.0;
    let sin = ((sin * square + 1.0 / 120.0) * square - 1.0 / 6.0) * square + 1.0;
    let cos = square * (1.0 / 40_320.0) - 1.0 / 720.0;
    let cos = ((cos * square + 1.0 / 24.0) * square - 0.5) * square + 1.0;
    (sin * x, cos)
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

/// Puts three coordinates into some lanes, a bit each, and leaves what is in the others.
///
/// Wherever it will do, all: processors write some lanes of eight slowly.
#[inline(always)]
pub(crate) fn put3<S: Simd>(simd: S, to: &mut Lanes3, lanes: u32, value: [f32x8<S>; 3]) {
    if lanes == 0xff {
        *to = store3(value);
    } else {
        let lanes = mask32x8::from_bitmask(simd, lanes.into());
        *to = store3(select3(lanes, value, load3(simd, to)));
    }
}

/// Three coordinates as f64, the first four lanes of each, then the last four.
#[inline(always)]
pub(crate) fn wide3<S: Simd>([x, y, z]: [f32x8<S>; 3]) -> [[f64x4<S>; 3]; 2] {
    let ((x, x_high), (y, y_high), (z, z_high)) = (x.widen(), y.widen(), z.widen());
    [[x, y, z], [x_high, y_high, z_high]]
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::wide;

    #[test]
    fn the_series_of_an_eighth_are_sine_and_cosine() {
        for i in -1000_i16..=1000 {
            let x = f32::from(i) / 1000.0 * std::f32::consts::FRAC_PI_4;
            let (sin, cos) = sin_cos_of_eighth(x);
            let exact = wide::sin_cos(f64::from(x));
            assert!((f64::from(sin) - exact.0).abs() < 1.2e-7, "{x}");
            assert!((f64::from(cos) - exact.1).abs() < 1.2e-7, "{x}");
        }
    }

    #[test]
    fn eight_directions_have_the_bits_of_one_the_extreme_ones_too() {
        let simd = fearless_simd::Fallback::new();
        let all = [0.3, -1.0, 1e-30, 0.0, 1e25, -2e-12, 7.0, f32::INFINITY];
        for turn in 0..8 {
            let mut v: Lanes3 = [all; 3];
            v[1].rotate_left(turn);
            v[2].rotate_right(3);
            let eight = store3(normalize(load3(simd, &v)));
            for i in 0..8 {
                let one = normalize([v[0][i], v[1][i], v[2][i]]);
                assert_eq!([eight[0][i], eight[1][i], eight[2][i]], one, "{v:?}");
            }
        }
    }
}
