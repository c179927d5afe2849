//! Where positions are counted from, so that f32 keeps the detail of data far from the origin.

use glam::DVec3;

/// How many samples along each way a reader takes: that many places, that many positions each.
pub(crate) const SAMPLES: usize = 64;

/// How many times farther from the origin than it is large a model must be to get its own.
const FAR: f64 = 64.0;

/// The origin for data of which `samples` are some: 0 for ordinary data.
///
/// An axis gets its own origin where the samples lie 64 times as far from 0 as they lie apart
/// (along the axis in which they are farthest apart), which would cost 6 of the 24 bits of an
/// f32. It is a multiple of a power of two about four times the samples' extent, so that it is a
/// short number and subtracting it rounds nothing that matters.
pub fn origin_of(samples: impl IntoIterator<Item = DVec3>) -> DVec3 {
    let (low, high) = samples
        .into_iter()
        .filter(|p| p.is_finite())
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
    let extent = (high - low).max_element();
    let middle = 0.5 * low + 0.5 * high;
    if !(extent > 0.0 && extent.is_finite() && middle.is_finite()) {
        return DVec3::ZERO;
    }
    // The exponent's bits alone: the largest power of two that is not larger.
    let unit = 8.0 * f64::from_bits(extent.to_bits() & 0x7ff0_0000_0000_0000);
    let axis = |middle: f64| {
        let origin = (middle / unit).round() * unit;
        if middle.abs() >= FAR * extent && origin.is_finite() { origin } else { 0.0 }
    };
    DVec3::new(axis(middle.x), axis(middle.y), axis(middle.z))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ordinary_data_keep_the_origin_they_have() {
        let at = |x: f64| DVec3::new(x, 5.0, -x);
        assert_eq!(origin_of([at(-1.0), at(30.0)]), DVec3::ZERO);
        assert_eq!(origin_of([at(1e9)]), DVec3::ZERO);
        assert_eq!(origin_of([]), DVec3::ZERO);
        assert_eq!(origin_of([DVec3::NAN, DVec3::INFINITY]), DVec3::ZERO);
    }

    #[test]
    fn data_far_away_get_a_short_origin_along_the_axes_that_need_it() {
        let corner = DVec3::new(4_500_003.0, 200.0, -5_100_000.0);
        let origin = origin_of([corner, corner + DVec3::new(3.0, 7.0, 1.0)]);
        assert_eq!(origin, (DVec3::new(4_500_000.0, 0.0, -5_100_000.0) / 32.0).round() * 32.0);
    }
}
