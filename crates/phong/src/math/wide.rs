//! The same functions in f64, for what is set up once: cameras, lights, filters, bounds;
//! and for drawings.

use phong_bvh::Lanes;

/// Sine and cosine of `x` radians.
pub fn sin_cos(x: f64) -> (f64, f64) {
    libm::sincos(x)
}

/// Sine and cosine of up to an eighth of a turn, `|x| ≤ π/4`, of one number or of four: their series,
/// whose first term left out is below 1e-17 of them.
#[inline(always)]
pub(crate) fn sin_cos_of_eighth<F: Lanes<Scalar = f64>>(x: F) -> (F, F) {
    const FACTORIAL: [f64; 18] = {
        let mut all = [1.0; 18];
        let mut i = 1;
        while i < 18 {
            all[i] = all[i - 1] * i as f64;
            i += 1;
        }
        all
    };
    let square = x * x;
    let (mut sin, mut cos) = (x.splat(1.0 / FACTORIAL[17]), x.splat(1.0 / FACTORIAL[16]));
    for k in (0..8).rev() {
        let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
        sin = sin * square + sign / FACTORIAL[2 * k + 1];
        cos = cos * square + sign / FACTORIAL[2 * k];
    }
    (sin * x, cos)
}

/// Cosine of `x` radians.
pub fn cos(x: f64) -> f64 {
    libm::cos(x)
}

/// Tangent of `x` radians.
pub fn tan(x: f64) -> f64 {
    libm::tan(x)
}

/// The angle in [0, π] whose cosine is `x`; NaN outside [−1, 1].
pub fn acos(x: f64) -> f64 {
    libm::acos(x)
}

/// The angle in [−π/2, π/2] whose tangent is `x`.
pub fn atan(x: f64) -> f64 {
    libm::atan(x)
}

/// The angle of the point (`x`, `y`), in (−π, π].
pub fn atan2(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}

/// `x^y`.
pub fn pow(x: f64, y: f64) -> f64 {
    libm::pow(x, y)
}

/// The natural logarithm of `x`.
pub fn ln(x: f64) -> f64 {
    libm::log(x)
}

/// `e^x`.
pub fn exp(x: f64) -> f64 {
    libm::exp(x)
}

/// `2^x`.
pub fn exp2(x: f64) -> f64 {
    libm::exp2(x)
}

/// The smallest power of two that is greater than `x`, for finite `x` > 0.
pub fn power_of_two_above(x: f64) -> f64 {
    libm::ldexp(1.0, libm::frexp(x).1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_series_of_an_eighth_are_sine_and_cosine() {
        for i in -1000..=1000 {
            let x = f64::from(i) / 1000.0 * std::f64::consts::FRAC_PI_4;
            let (sin, cos) = sin_cos_of_eighth(x);
            let exact = sin_cos(x);
            assert!((sin - exact.0).abs() < 3e-16 && (cos - exact.1).abs() < 3e-16, "{x}");
        }
    }
}
