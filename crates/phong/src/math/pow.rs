//! Powers, the one transcendental function on the road of every ray.
//!
//! The same bits on every machine: tables that the compiler works out from their definitions, and
//! two short polynomials in f64, with no fused multiply-add and no library function. As the f64
//! result is rounded once, to f32, it misses the true power by at most 0.503 ulp.

use std::f64::consts::{LN_2, LOG2_E};

use fearless_simd::{Simd, f32x8, f64x4, prelude::*, u32x8};
use phong_bvh::lanes;

/// `x^y`, for bases that are lengths or cosines.
///
/// At most 0.503 ulp off for finite `y` and positive finite `x`, subnormals included, whether they
/// are the base or the result; it overflows to ∞ and underflows to 0. Elsewhere as IEEE 754 has
/// it: `x⁰ = 1` and `1^y = 1` whatever the other; `0^y` is 0 for `y > 0` and ∞ for `y < 0`; `∞^y`
/// the reverse; `x^∞` is 0 below 1 and ∞ above. NaN brings NaN. The one departure: a *negative*
/// base is a mistake here, and brings NaN for every `y` but 0 (−0 counts as 0).
///
/// ```
/// use phong::math::pow;
/// assert_eq!(pow(0.5, 3.0), 0.125);
/// assert_eq!(pow(0.0, 0.0), 1.0); // the lecture's lobe wants 0 here: see `lobe`
/// ```
#[inline]
pub fn pow(x: f32, y: f32) -> f32 {
    if x > 0.0 && x < f32::INFINITY && y.is_finite() {
        exp2_of_steps(f64::from(y) * log2_in_steps(f64::from(x)))
    } else {
        pow_at_the_edge(x, y)
    }
}

/// `cos^α`, the falloff of a highlight: `x^α` for a cosine `x`, and 0 for `x ≤ 0`, α = 0 included.
///
/// 1 for `x ≥ 1`, so that rounding in a dot product never lifts a highlight above its peak.
/// `alpha` ≥ 0. NaN brings 0.
///
/// ```
/// use phong::math::lobe;
/// assert_eq!(lobe(0.5, 2.0), 0.25);
/// assert_eq!(lobe(0.0, 0.0), 0.0);
/// assert_eq!(lobe(-0.5, 2.0), 0.0);
/// ```
#[inline]
pub fn lobe(x: f32, alpha: f32) -> f32 {
    if x >= 1.0 {
        1.0
    } else if x > 0.0 {
        pow(x, alpha)
    } else {
        0.0
    }
}

/// [`lobe`] at every width.
pub(crate) trait Lobe: lanes::Lanes<Scalar = f32> {
    /// [`lobe`] of each lane: the same bits.
    #[must_use]
    fn lobe(self, alpha: f32) -> Self;
}

impl Lobe for f32 {
    #[inline(always)]
    fn lobe(self, alpha: f32) -> Self {
        lobe(self, alpha)
    }
}

impl<S: Simd> Lobe for f32x8<S> {
    #[inline(always)]
    fn lobe(self, alpha: f32) -> Self {
        lobe8(self.token(), self, alpha)
    }
}

/// [`lobe`] of eight cosines.
#[inline(always)]
fn lobe8<S: Simd>(simd: S, x: f32x8<S>, alpha: f32) -> f32x8<S> {
    let (zero, one) = (f32x8::splat(simd, 0.0), f32x8::splat(simd, 1.0));
    // Subnormal bases have another exponent as f32 than as f64.
    let normal = x.simd_ge(f32x8::splat(simd, f32::MIN_POSITIVE)) & x.simd_lt(one);
    if !(normal | x.simd_le(zero) | x.simd_ge(one)).all_true() || !alpha.is_finite() {
        return lanes::Lanes::map(x, |x| lobe(x, alpha));
    }
    if !normal.any_true() {
        return x.simd_ge(one).select(one, zero);
    }
    let base = normal.select(x, f32x8::splat(simd, 0.5));
    let power = exp2_of_steps8(simd, log2_in_steps8(simd, base), f64::from(alpha));
    normal.select(power, x.simd_ge(one).select(one, zero))
}

/// The cases without a logarithm.
#[cold]
fn pow_at_the_edge(x: f32, y: f32) -> f32 {
    if y == 0.0 || x == 1.0 {
        1.0
    } else if x.is_nan() || y.is_nan() || x < 0.0 {
        f32::NAN
    } else if (x > 1.0) == (y > 0.0) {
        f32::INFINITY // 0^−, ∞^+, small^−∞, large^∞
    } else {
        0.0
    }
}

/// Steps of the table of logarithms.
const LOG_STEPS: usize = 128;
/// Steps of the table of powers of two, in which logarithms are counted, to save multiplications.
const STEPS: usize = 256;
/// Bits of an f64's fraction.
const FRACTION_BITS: u32 = f64::MANTISSA_DIGITS - 1;
/// `log₂ e`, in steps.
const STEPS_PER_E: f64 = STEPS as f64 * LOG2_E;
/// `ln 2` of a step.
const E_PER_STEP: f64 = LN_2 / STEPS as f64;

/// Square of the largest r.
const R2: f64 = 1.0 / (4 * LOG_STEPS * LOG_STEPS) as f64;
/// `ln(1 + r) = r − r²/2 + r³/3 − r⁴/4 + r⁵/5`, of which the last term is economised:
/// Chebyshev's `r⁴ ≈ R² r² − R⁴/8`, which is off by at most R⁴/8.
const A: [f64; 4] = [
    STEPS_PER_E * (1.0 - R2 * R2 / 40.0),
    STEPS_PER_E * (-1.0 / 2.0),
    STEPS_PER_E * (1.0 / 3.0 + R2 / 5.0),
    STEPS_PER_E * (-1.0 / 4.0),
];

/// Added and taken off again, it leaves the nearest whole number, also in the lowest bits.
const ROUND: f64 = 1.5 * (1_u64 << FRACTION_BITS) as f64;
/// Beyond 2^±160 every f32 is 0 or ∞, and the f64's exponent is still far from its ends.
const FAR: f64 = 160.0 * STEPS as f64;
/// Square of the largest u.
const U2: f64 = E_PER_STEP * E_PER_STEP / 4.0;
/// `e^u = 1 + u + u²/2 + u³/6`, of which the last term is economised: Chebyshev's
/// `u³ ≈ ¾ U² u`, which is off by at most U³/4.
const B: [f64; 2] = [E_PER_STEP * (1.0 + U2 / 8.0), E_PER_STEP * E_PER_STEP / 2.0];

/// `(1/c, 256 log₂ c)` at `c = 1 + i/128`, i = 0 ..= 128.
static LOG_TABLE: [(f64, f64); 2 * LOG_STEPS] = {
    // A power of two of entries, so that a masked index needs no check.
    let mut table = [(1.0, 0.0); 2 * LOG_STEPS];
    let mut i = 1;
    while i < LOG_STEPS {
        let c = 1.0 + i as f64 / LOG_STEPS as f64;
        table[i] = (1.0 / c, ln_by_series(c) * STEPS_PER_E);
        i += 1;
    }
    table[LOG_STEPS] = (0.5, STEPS as f64);
    table
};

/// `2^(i/256)`, i = 0 .. 255.
static EXP_TABLE: [f64; STEPS] = {
    let mut table = [1.0; STEPS];
    let mut i = 1;
    while i < STEPS {
        table[i] = exp_by_series(i as f64 * E_PER_STEP);
        i += 1;
    }
    table
};

/// `256 log₂ x` of a positive normal number, to 6e-12 of itself.
///
/// `x = 2^k z` with z in [1, 2); with c the table's nearest step, `log₂ x = k + log₂ c +
/// log₂(1 + r)`, where `r = z/c − 1` is at most 1/256. Just below 1, where k = −1 and c = 2, the
/// first two cancel exactly and r is exact, so that nothing is lost where highlights peak.
#[inline]
fn log2_in_steps(x: f64) -> f64 {
    const ONE: u64 = 1.0_f64.to_bits();
    let bits = x.to_bits();
    let fraction = bits & ((1 << FRACTION_BITS) - 1);
    let k = (bits >> FRACTION_BITS) as i32 - 1023;
    let z = f64::from_bits(ONE | fraction);
    let nearest = ((fraction >> (FRACTION_BITS - LOG_STEPS.ilog2() - 1)) + 1) >> 1;
    let (inverse, log_c) = LOG_TABLE[nearest as usize & (2 * LOG_STEPS - 1)];
    let whole = f64::from(k * STEPS as i32) + log_c;
    let r = z * inverse - 1.0;
    // Not Horner's nesting: independent products overlap in the processor.
    (whole + A[0] * r) + (r * r) * ((A[1] + A[2] * r) + (r * r) * A[3])
}

/// `2^(t/256)`, rounded to f32; 1e-10 of itself off before that.
///
/// `t = i + s` with i whole and |s| ≤ 1/2: a power of two, times one of 256 tabulated, times
/// `e^u` with `u = s ln 2 / 256`.
#[inline]
fn exp2_of_steps(t: f64) -> f32 {
    let t = t.clamp(-FAR, FAR);
    let shifted = t + ROUND;
    let s = t - (shifted - ROUND);
    let scale = scale_of(shifted);
    (scale + scale * (s * (B[0] + B[1] * s))) as f32
}

/// `2^(i/256)` of the whole number i that `shifted` holds in its lowest bits.
#[inline(always)]
fn scale_of(shifted: f64) -> f64 {
    let i = shifted.to_bits();
    let octaves = (i / STEPS as u64) << FRACTION_BITS;
    let step = EXP_TABLE[i as usize % STEPS].to_bits();
    f64::from_bits(step.wrapping_add(octaves))
}

/// [`log2_in_steps`] of eight positive normal f32.
#[inline(always)]
fn log2_in_steps8<S: Simd>(simd: S, x: f32x8<S>) -> [f64x4<S>; 2] {
    const FRACTION: u32 = (1 << (f32::MANTISSA_DIGITS - 1)) - 1;
    let bits: u32x8<S> = x.bitcast();
    let fraction = bits & FRACTION;
    let z: f32x8<S> = (fraction | 1.0_f32.to_bits()).bitcast();
    let nearest = ((fraction >> (f32::MANTISSA_DIGITS - 1 - LOG_STEPS.ilog2() - 1)) + 1) >> 1;
    let nearest: [u32; 8] = nearest.into();
    let k = bits >> (f32::MANTISSA_DIGITS - 1);
    // Whole numbers of up to 2^17: exact.
    let k = (k.to_float::<f32x8<S>>() - 127.0) * STEPS as f32;
    let ((z0, z1), (k0, k1)) = (z.widen(), k.widen());
    let [n0, n1, n2, n3, n4, n5, n6, n7] = nearest;
    [log2_of_parts(simd, z0, k0, [n0, n1, n2, n3]), log2_of_parts(simd, z1, k1, [n4, n5, n6, n7])]
}

/// The last lines of [`log2_in_steps`], for four.
#[inline(always)]
fn log2_of_parts<S: Simd>(simd: S, z: f64x4<S>, k: f64x4<S>, [a, b, c, d]: [u32; 4]) -> f64x4<S> {
    let entry = |nearest: u32| LOG_TABLE[nearest as usize & (2 * LOG_STEPS - 1)];
    let [a, b, c, d] = [entry(a), entry(b), entry(c), entry(d)];
    let inverse: f64x4<S> = [a.0, b.0, c.0, d.0].simd_into(simd);
    let log_c: f64x4<S> = [a.1, b.1, c.1, d.1].simd_into(simd);
    let whole = k + log_c;
    let r = z * inverse - 1.0;
    (whole + A[0] * r) + (r * r) * ((A[1] + A[2] * r) + (r * r) * A[3])
}

/// [`exp2_of_steps`] of `factor` times eight numbers.
#[inline(always)]
fn exp2_of_steps8<S: Simd>(simd: S, [low, high]: [f64x4<S>; 2], factor: f64) -> f32x8<S> {
    exp2_of_steps4(simd, factor * low).narrow(exp2_of_steps4(simd, factor * high))
}

/// [`exp2_of_steps`] of four, before it is rounded.
#[inline(always)]
fn exp2_of_steps4<S: Simd>(simd: S, t: f64x4<S>) -> f64x4<S> {
    let t = t.max(f64x4::splat(simd, -FAR)).min(f64x4::splat(simd, FAR));
    let shifted = t + ROUND;
    let s = t - (shifted - ROUND);
    let [a, b, c, d]: [f64; 4] = shifted.into();
    let scale: f64x4<S> = [scale_of(a), scale_of(b), scale_of(c), scale_of(d)].simd_into(simd);
    scale + scale * (s * (B[0] + B[1] * s))
}

/// `ln c` for c in [1, 2] by `2 artanh((c − 1)/(c + 1))`, for tables only.
const fn ln_by_series(c: f64) -> f64 {
    let q = (c - 1.0) / (c + 1.0);
    let mut sum = 0.0;
    let mut k = 41; // (1/3)^43 is far below f64's last bit
    while k >= 1 {
        sum = sum * q * q + 1.0 / k as f64;
        k -= 2;
    }
    2.0 * q * sum
}

/// `e^u` for u in [0, 1], for tables only.
const fn exp_by_series(u: f64) -> f64 {
    let mut sum = 1.0;
    let mut k = 20; // 0.7^21/21! is far below f64's last bit
    while k >= 1 {
        sum = 1.0 + sum * u / k as f64;
        k -= 1;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// How many units in the last place `pow(x, y)` is off; libm's f64 `pow` shares no code with
    /// ours and is itself within 1e-8 of such a unit.
    fn error_in_ulps(x: f32, y: f32) -> f64 {
        let truth = libm::pow(f64::from(x), f64::from(y));
        let found = pow(x, y);
        if truth > f64::from(f32::MAX) {
            // Beyond MAX by half a unit, rounding goes to ∞.
            assert!(found == f32::INFINITY || found == f32::MAX, "{x}^{y} = {found}, not {truth}");
            return 0.0;
        }
        let ulp = {
            let near = (truth as f32).max(f32::MIN_POSITIVE);
            f64::from(near.next_up()) - f64::from(near)
        };
        ((f64::from(found) - truth) / ulp).abs()
    }

    /// The worst error over `bases`, given as bit patterns, for some exponents.
    fn worst(bases: &(impl Iterator<Item = u32> + Clone), exponents: &[f32]) -> f64 {
        let mut worst = (0.0, 0.0, 0.0);
        for &y in exponents {
            for bits in bases.clone() {
                let x = f32::from_bits(bits);
                let error = error_in_ulps(x, y);
                if error > worst.0 {
                    worst = (error, x, y);
                }
            }
        }
        println!("worst: {} ulp at {}^{}", worst.0, worst.1, worst.2);
        worst.0
    }

    const EXPONENTS: [f32; 12] = [0.1, 0.5, 1.0, 2.4, 3.0, 5.0, 9.0, 32.0, 200.0, 1000.0, 1e4, 1e7];

    #[test]
    fn powers_of_cosines_are_at_most_half_a_unit_and_a_bit_off() {
        let cosines = (0.5_f32.to_bits()..=1.0_f32.to_bits()).step_by(97);
        assert!(worst(&cosines, &EXPONENTS) <= 0.503);
        let next_to_one = 1.0_f32.to_bits() - 20_000..=1.0_f32.to_bits() + 20_000;
        assert!(worst(&next_to_one, &EXPONENTS) <= 0.503);
        let small = (1e-6_f32.to_bits()..0.5_f32.to_bits()).step_by(3001);
        assert!(worst(&small, &EXPONENTS) <= 0.503);
    }

    #[test]
    fn so_are_powers_of_everything_else() {
        let all = (1..f32::INFINITY.to_bits()).step_by(200_003); // subnormals included
        let negative = EXPONENTS.map(|y| -y);
        assert!(worst(&all, &EXPONENTS) <= 0.503);
        assert!(worst(&all, &negative) <= 0.503);
    }

    #[test]
    fn results_go_through_the_subnormals_down_to_0() {
        assert_eq!(pow(0.5, 149.0), f32::from_bits(1));
        assert_eq!(pow(0.5, 148.5), f32::from_bits(1)); // √2 of the smallest
        assert_eq!(pow(0.5, 151.0), 0.0);
        assert_eq!(pow(0.5, f32::MAX), 0.0);
        assert_eq!(pow(2.0, 127.0), f32::from_bits(254 << 23));
        assert_eq!(pow(2.0, 128.0), f32::INFINITY);
        assert_eq!(pow(2.0, f32::MAX), f32::INFINITY);
        assert_eq!(pow(f32::from_bits(1), 1.0), f32::from_bits(1));
    }

    #[test]
    fn the_edges_are_those_of_ieee_754() {
        let inf = f32::INFINITY;
        for y in [0.0, -0.0] {
            for x in [0.0, 0.3, 1.0, inf, -2.0, f32::NAN] {
                assert_eq!(pow(x, y), 1.0, "{x}^{y}");
            }
        }
        for y in [inf, -inf, f32::NAN, 5.0] {
            assert_eq!(pow(1.0, y), 1.0, "1^{y}");
        }
        for zero in [0.0, -0.0] {
            assert_eq!([pow(zero, 2.0), pow(zero, -2.0)], [0.0, inf]);
            assert_eq!([pow(zero, inf), pow(zero, -inf)], [0.0, inf]);
        }
        assert_eq!([pow(inf, 2.0), pow(inf, -2.0)], [inf, 0.0]);
        assert_eq!([pow(inf, inf), pow(inf, -inf)], [inf, 0.0]);
        assert_eq!([pow(0.5, inf), pow(0.5, -inf)], [0.0, inf]);
        assert_eq!([pow(1.5, inf), pow(1.5, -inf)], [inf, 0.0]);
        for (x, y) in [(f32::NAN, 2.0), (2.0, f32::NAN), (-1.0, 2.0), (-inf, 2.0)] {
            assert!(pow(x, y).is_nan(), "{x}^{y}");
        }
    }

    #[test]
    fn a_lobe_is_0_behind_1_at_its_peak_and_a_power_between() {
        for alpha in [0.0, 1.0, 32.0, 1e6] {
            assert_eq!([lobe(0.0, alpha), lobe(-0.5, alpha)], [0.0, 0.0]);
            assert_eq!([lobe(1.0, alpha), lobe(1.000_000_1, alpha)], [1.0, 1.0]);
            assert_eq!(lobe(0.7, alpha), pow(0.7, alpha));
        }
        assert_eq!(lobe(1e-30, 0.0), 1.0);
        assert_eq!(lobe(f32::NAN, 2.0), 0.0);
    }

    #[test]
    fn eight_lobes_have_the_bits_of_one() {
        let simd = fearless_simd::Fallback::new();
        let odd = [0.0, -0.0, -0.5, 1.0, 1.000_000_1, 1e-40, f32::MIN_POSITIVE, f32::NAN];
        let cosines = (0.001_f32.to_bits()..1.0_f32.to_bits()).step_by(20_011).map(f32::from_bits);
        let all: Vec<f32> = odd.into_iter().chain(cosines).collect();
        for alpha in EXPONENTS.into_iter().chain([0.0, 1e30, f32::INFINITY, f32::NAN]) {
            for x in all.as_chunks::<8>().0 {
                let eight: [f32; 8] = lobe8(simd, (*x).simd_into(simd), alpha).into();
                let one = x.map(|x| lobe(x, alpha));
                assert_eq!(eight.map(f32::to_bits), one.map(f32::to_bits), "{x:?}^{alpha}");
            }
        }
    }

    #[test]
    fn a_lobe_never_rises_with_the_angle() {
        for alpha in EXPONENTS {
            let mut last = 1.0;
            for bits in (0.9_f32.to_bits()..=1.0_f32.to_bits()).rev().step_by(7) {
                let now = lobe(f32::from_bits(bits), alpha);
                assert!(now <= last, "α = {alpha}, x = {}", f32::from_bits(bits));
                last = now;
            }
        }
    }
}
