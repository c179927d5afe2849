//! Where positions are counted from, so that f32 keeps the detail of data far from the origin.

use std::io;

use glam::DVec3;

use super::text::{Cursor, Decimal, Piece};
use crate::source::Blob;

/// Bytes that are looked through for positions at each of the places that are sampled.
const SAMPLE: usize = 4 << 10;

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

/// Positions from places all over a text: three numbers behind what `is_position` goes over, on lines
/// of which it says that there are some. `joined` as in [`Lines`](super::text::Lines).
pub(crate) fn sample(
    blob: &dyn Blob,
    joined: bool,
    is_position: impl Fn(&mut Cursor<'_>) -> bool,
) -> io::Result<Vec<DVec3>> {
    let mut samples = Vec::new();
    let mut text = vec![0; SAMPLE];
    let step = (blob.len() / SAMPLES as u64).max(SAMPLE as u64);
    for place in 0..SAMPLES as u64 {
        let read = blob.read_full(&mut text, place * step)?;
        let whole = text[..read].iter().rposition(|&b| b == b'\n').map_or(read, |end| end + 1);
        let piece = Piece { text: &text[..whole], offset: 0, line: 1, rows: 0 };
        let mut cursor = Cursor::new(piece, joined);
        if place > 0 {
            // It began before.
            cursor.next_line();
        }
        let wanted = samples.len() + SAMPLES;
        while !cursor.is_done() && samples.len() < wanted {
            if is_position(&mut cursor) {
                let mut number =
                    || if cursor.more() { cursor.decimal().map(Decimal::to_f64) } else { None };
                if let (Some(x), Some(y), Some(z)) = (number(), number(), number()) {
                    samples.push(DVec3::new(x, y, z));
                }
            }
            cursor.next_line();
        }
        if read < SAMPLE {
            break;
        }
    }
    Ok(samples)
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
