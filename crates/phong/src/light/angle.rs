//! Angles and their cosines and sines, at every width.

use std::f32::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use phong_bvh::Lanes;

use crate::math::lanes::sin_cos_of_eighth;

/// The angle of a point of the plane, in [0, 2π); a hair below 0 is 0.
#[inline(always)]
pub(super) fn turn<F: Lanes<Scalar = f32>>([x, y]: [F; 2]) -> F {
    let zero = x.splat(0.0);
    let angle = half_turn([x, y.abs()]);
    let rounding = angle.lt(zero.splat(1e-5));
    let below = F::select(rounding, zero, -angle + 2.0 * PI);
    F::select(y.lt(zero), below, angle)
}

/// The angle of a point of the upper half of the plane, in [0, π].
#[inline(always)]
pub(super) fn half_turn<F: Lanes<Scalar = f32>>([x, y]: [F; 2]) -> F {
    const TAN_OF_EIGHTH: f32 = 0.414_213_57;
    // Most often all are small, and the steps below would leave them as they are.
    if F::all(y.lt(x * TAN_OF_EIGHTH)) {
        return arc_tangent(y / x);
    }
    let (zero, a) = (x.splat(0.0), x.abs());
    let steep = y.gt(a);
    let (low, high) = (F::select(steep, a, y), F::select(steep, y, a));
    // Beyond the tangent of π/8 it is counted from π/4.
    let large = low.gt(high * TAN_OF_EIGHTH);
    let t = F::select(large, low - high, low) / F::select(large, low + high, high);
    let angle = arc_tangent(t) + F::select(large, zero.splat(FRAC_PI_4), zero);
    let angle = F::select(steep, -angle + FRAC_PI_2, angle);
    F::select(x.lt(zero), -angle + PI, angle)
}

/// The arc tangent to rounding, of at most the tangent of π/8: the polynomial of `atanf` in Moshier's Cephes.
#[inline(always)]
fn arc_tangent<F: Lanes<Scalar = f32>>(t: F) -> F {
    let square = t * t;
    let sum = (square * 8.053_744_5e-2 - 1.387_768_6e-1) * square + 1.997_771_1e-1;
    (sum * square - 3.333_295e-1) * square * t + t
}

/// Cosine and sine of an angle from 0 to 2π.
#[inline(always)]
pub(super) fn on_circle<F: Lanes<Scalar = f32>>(angle: F) -> [F; 2] {
    let is_small = angle.lt(angle.splat(FRAC_PI_4));
    let small = sin_cos_of_eighth(angle);
    if F::all(is_small) {
        return [small.1, small.0];
    }
    let (mut sin, mut cos) = sin_cos_of_eighth(angle * 0.125);
    for _ in 0..3 {
        (sin, cos) = (sin * cos * 2.0, cos * cos - sin * sin);
    }
    [F::select(is_small, small.1, cos), F::select(is_small, small.0, sin)]
}

#[cfg(test)]
mod tests {
    use fearless_simd::{f32x8, prelude::*};

    use super::*;
    use crate::math::wide;

    #[test]
    fn angles_and_their_cosines_and_sines_are_exact_to_rounding() {
        for i in 0..4000_u16 {
            let exact = f64::from(i) * (std::f64::consts::TAU / 4000.0);
            let (sin, cos) = wide::sin_cos(exact);
            let angle = turn([3.0 * cos as f32, 3.0 * sin as f32]);
            assert!((f64::from(angle) - exact).abs() < 1e-6, "{exact}: {angle}");
            let [x, y] = on_circle(exact as f32);
            assert!((f64::from(x) - cos).abs() < 1e-6, "{exact}: {x}");
            assert!((f64::from(y) - sin).abs() < 1e-6, "{exact}: {y}");
        }
    }

    #[test]
    fn eight_angles_have_the_bits_of_one_small_and_large_together() {
        let simd = fearless_simd::Fallback::new();
        let angles = [0.0, 1e-6, 0.1, 0.39, 0.4, 1.0, 3.0, 6.0];
        for small in 1..=8 {
            let angles: [f32; 8] = std::array::from_fn(|i| angles[i % small]);
            let [x, y] = on_circle(f32x8::load_array(simd, angles));
            let turned: [f32; 8] = turn([x, y]).into();
            let (x, y): ([f32; 8], [f32; 8]) = (x.into(), y.into());
            for i in 0..8 {
                assert_eq!([x[i], y[i]], on_circle(angles[i]), "{angles:?}");
                assert_eq!(turned[i], turn([x[i], y[i]]), "{angles:?}");
            }
        }
    }
}
