//! The same functions in f64, for what is set up once: cameras, lights, filters, bounds;
//! and for drawings.

/// Sine and cosine of `x` radians.
pub fn sin_cos(x: f64) -> (f64, f64) {
    libm::sincos(x)
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
