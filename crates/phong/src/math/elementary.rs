//! The transcendental functions beside `pow`: libm's, the same bits on every platform.
//!
//! All angles in radians. Within 1 ulp; the inverse functions go through f64, as libm's f32 ones
//! miss even `acos(−1) = π`.

/// Sine.
pub fn sin(x: f32) -> f32 {
    libm::sinf(x)
}

/// Cosine.
pub fn cos(x: f32) -> f32 {
    libm::cosf(x)
}

/// Sine and cosine at once.
pub fn sin_cos(x: f32) -> (f32, f32) {
    libm::sincosf(x)
}

/// Tangent.
pub fn tan(x: f32) -> f32 {
    libm::tanf(x)
}

/// The angle in [−π/2, π/2] whose sine is `x`; arguments beyond ±1 count as ±1.
pub fn asin(x: f32) -> f32 {
    libm::asin(f64::from(x.clamp(-1.0, 1.0))) as f32
}

/// The angle in [0, π] whose cosine is `x`; arguments beyond ±1, as rounding makes them from
/// unit vectors, count as ±1.
pub fn acos(x: f32) -> f32 {
    libm::acos(f64::from(x.clamp(-1.0, 1.0))) as f32
}

/// The angle of the point `(x, y)` in [−π, π].
pub fn atan2(y: f32, x: f32) -> f32 {
    libm::atan2(f64::from(y), f64::from(x)) as f32
}

/// `e^x`.
pub fn exp(x: f32) -> f32 {
    libm::expf(x)
}

/// The natural logarithm.
pub fn ln(x: f32) -> f32 {
    libm::logf(x)
}

/// `1 − erf(x)`, the share of a Gaussian beyond `x`; accurate where erf itself is nearly 1.
pub fn erfc(x: f32) -> f32 {
    libm::erfcf(x)
}

#[cfg(test)]
mod tests {
    use std::f32::consts::{FRAC_PI_2, FRAC_PI_4, PI};

    use super::*;

    #[test]
    fn each_name_is_the_function_it_says() {
        assert_eq!(sin(FRAC_PI_2), 1.0);
        assert_eq!(cos(PI), -1.0);
        assert_eq!(sin_cos(0.5), (sin(0.5), cos(0.5)));
        assert_eq!(tan(FRAC_PI_4), 1.0);
        assert_eq!(asin(1.0), FRAC_PI_2);
        assert_eq!(acos(-1.0), PI);
        assert_eq!(atan2(1.0, 1.0), FRAC_PI_4);
        assert_eq!(exp(0.0), 1.0);
        assert_eq!(ln(1.0), 0.0);
        assert!((erfc(1.0) - 0.157_299_2).abs() < 1e-7);
    }

    #[test]
    fn a_cosine_just_over_1_has_the_angle_0() {
        assert_eq!(acos(1.000_000_1), 0.0);
        assert_eq!(asin(-1.000_000_1), -FRAC_PI_2);
    }
}
