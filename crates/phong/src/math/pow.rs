//! Powers, the one transcendental function on the road of every ray.
//!
//! The same bits on every machine: tables that the compiler works out from their definitions, and
//! two short polynomials in f64, with no fused multiply-add and no library function. As the f64
//! result is rounded once, to f32, it misses the true power by at most 0.51 ulp.

/// `x^y`, for bases that are lengths or cosines.
///
/// At most 0.51 ulp off for finite `y` and positive finite `x`, subnormals included, whether they
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
pub fn pow(x: f32, y: f32) -> f32 {
    if x > 0.0 && x < f32::INFINITY && y.is_finite() {
        exp2(f64::from(y) * log2(f64::from(x)))
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
pub fn lobe(x: f32, alpha: f32) -> f32 {
    if x >= 1.0 {
        1.0
    } else if x > 0.0 {
        pow(x, alpha)
    } else {
        0.0
    }
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

/// Steps of the table of logarithms between 1 and 2.
const LOG_STEPS: usize = 64;
/// Steps of the table of powers of two between 1 and 2.
const EXP_STEPS: usize = 64;
/// Bits of an f64's fraction.
const FRACTION_BITS: u32 = f64::MANTISSA_DIGITS - 1;

/// `(1/c, log₂ c)` at `c = 1 + i/64`, i = 0 ..= 64.
static LOG_TABLE: [(f64, f64); LOG_STEPS + 1] = {
    let mut table = [(1.0, 0.0); LOG_STEPS + 1];
    let mut i = 1;
    while i < LOG_STEPS {
        let c = 1.0 + i as f64 / LOG_STEPS as f64;
        table[i] = (1.0 / c, ln_by_series(c) * std::f64::consts::LOG2_E);
        i += 1;
    }
    table[LOG_STEPS] = (0.5, 1.0);
    table
};

/// `2^(i/64)`, i = 0 .. 63.
static EXP_TABLE: [f64; EXP_STEPS] = {
    let mut table = [1.0; EXP_STEPS];
    let mut i = 1;
    while i < EXP_STEPS {
        table[i] = exp_by_series(i as f64 / EXP_STEPS as f64 * std::f64::consts::LN_2);
        i += 1;
    }
    table
};

/// `log₂ x` of a positive normal number, to about 5e-12 of itself.
///
/// `x = 2^k z` with z in [1, 2); with c the table's nearest step, `log₂ x = k + log₂ c +
/// log₂(1 + r)`, where `r = z/c − 1` is at most 1/128. Just below 1, where k = −1 and c = 2, the
/// first two cancel exactly and r is exact, so that nothing is lost where highlights peak.
fn log2(x: f64) -> f64 {
    const ONE: u64 = 1.0_f64.to_bits();
    let bits = x.to_bits();
    let fraction = bits & ((1 << FRACTION_BITS) - 1);
    let k = (bits >> FRACTION_BITS) as i32 - 1023;
    let z = f64::from_bits(ONE | fraction);
    let nearest = ((fraction >> (FRACTION_BITS - 7)) + 1) >> 1;
    let (inverse, log_c) = LOG_TABLE[nearest as usize];
    let r = z * inverse - 1.0;
    // ln(1 + r) by Taylor: the first term left out is r⁶/6 < 4e-14.
    let r2 = r * r;
    let tail = (-0.5 + r * (1.0 / 3.0)) + r2 * (-0.25 + r * 0.2);
    (f64::from(k) + log_c) + std::f64::consts::LOG2_E * (r + r2 * tail)
}

/// `2^t`, rounded to f32.
///
/// `t = i/64 + s` with |s| ≤ 1/128, so `2^t` is a power of two, times one of 64 tabulated, times
/// `e^(s ln 2)`.
fn exp2(t: f64) -> f32 {
    /// Added and taken off again, it leaves the nearest whole number, also in the lowest bits.
    const ROUND: f64 = 1.5 * (1_u64 << FRACTION_BITS) as f64;
    const STEPS: f64 = EXP_STEPS as f64;
    // Beyond ±160 every f32 is 0 or ∞ already, and the f64's exponent is still far from its ends.
    let t = t.clamp(-160.0, 160.0);
    let shifted = t * STEPS + ROUND;
    let i = shifted.to_bits();
    let u = (t - (shifted - ROUND) / STEPS) * std::f64::consts::LN_2;
    // e^u by Taylor: the first term left out is u⁴/24 < 4e-11.
    let e_u = 1.0 + (u + u * u * (0.5 + u * (1.0 / 6.0)));
    let step = EXP_TABLE[i as usize % EXP_STEPS].to_bits();
    let whole = (i / EXP_STEPS as u64) << FRACTION_BITS;
    (f64::from_bits(step.wrapping_add(whole)) * e_u) as f32
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
