//! How footprints are covered by places that are looked up.

use fearless_simd::{Simd, f64x4, prelude::*};
use phong_bvh::Lanes;

use super::wrap::ceil;

/// The most look-ups side by side along the longer axis of a footprint: what is still longer is blurred.
const MOST_TAPS: f64 = 16.0;

/// How eight footprints are covered: by places along the longer side of each, each about as wide as the shorter.
pub(super) struct Spread {
    /// The longer side.
    pub(super) along: [[f64; 8]; 2],
    /// How many places along it: a whole number.
    pub(super) taps: [f64; 8],
    /// How often the image is halved, and the share of the next half.
    pub(super) level: [u32; 8],
    pub(super) part: [f32; 8],
}

impl Spread {
    /// One place each in the image itself.
    pub(super) const POINTS: Self =
        Self { along: [[0.0; 8]; 2], taps: [1.0; 8], level: [0; 8], part: [0.0; 8] };

    /// How parallelograms of these sides are covered by an image of this size, in some of eight lanes.
    #[inline(always)]
    pub(super) fn of<S: Simd>(
        simd: S,
        size: [u32; 2],
        lanes: u32,
        [a, b]: &[[[f64; 8]; 2]; 2],
    ) -> Self {
        let size = size.map(f64::from);
        let mut spread = Self::POINTS;
        for half in (0..2).filter(|half| lanes >> (4 * half) & 0xf != 0) {
            let four = 4 * half..4 * half + 4;
            let load = |all: &[f64; 8]| f64x4::from_slice(simd, &all[four.clone()]);
            let sides = [[load(&a[0]), load(&a[1])], [load(&b[0]), load(&b[1])]];
            let (along, taps, width) = covered(size, sides);
            along[0].store_slice(&mut spread.along[0][four.clone()]);
            along[1].store_slice(&mut spread.along[1][four.clone()]);
            taps.store_slice(&mut spread.taps[four.clone()]);
            let width: [f64; 4] = width.into();
            for (lane, width) in four.zip(width) {
                (spread.level[lane], spread.part[lane]) = level(size, width);
            }
        }
        spread
    }
}

/// How a parallelogram is covered by an image of this size: its longer side, how many places along it are looked up,
/// and how wide each is, in pixels, at least 1 and at most all of the image.
#[inline(always)]
pub(super) fn covered<F: Lanes<Scalar = f64>>(
    [width, height]: [f64; 2],
    [a, b]: [[F; 2]; 2],
) -> ([F; 2], F, F) {
    let length = |[x, y]: [F; 2]| {
        let (x, y) = (x * width, y * height);
        (x * x + y * y).sqrt()
    };
    let (of_a, of_b) = (length(a), length(b));
    let is_a = of_a.gt(of_b);
    let (long, short) = (F::select(is_a, of_a, of_b), F::select(is_a, of_b, of_a));
    let along = [F::select(is_a, a[0], b[0]), F::select(is_a, a[1], b[1])];
    let (one, none) = (long.splat(1.0), long.splat(0.0));
    let most = long.splat(width.max(height));
    // Of a footprint of less than a pixel, or NaN, one look-up in the image itself is enough; of one of all of the image,
    // many times, one in the last level.
    let is_wide = long.gt(one);
    let is_all = long.gt(most * MOST_TAPS);
    let short = short.max(long / MOST_TAPS).max(one);
    let taps = ceil(long / short);
    let taps = F::select(taps.lt(long.splat(MOST_TAPS)), taps, long.splat(MOST_TAPS));
    let is_long = is_wide & !is_all;
    let along = [F::select(is_long, along[0], none), F::select(is_long, along[1], none)];
    let width = F::select(is_wide, F::select(short.lt(most), short, most), one);
    (along, F::select(is_long, taps, one), width)
}

/// How often an image of this size is halved so that what is `width` pixels wide becomes one, and the share of the next
/// half: the logarithm to base 2, whose part in [0, 1) runs linearly between powers of two, which is all that mixing two
/// levels asks for.
#[inline(always)]
pub(super) fn level([w, h]: [f64; 2], width: f64) -> (u32, f32) {
    let exponent = |x: f64| (x.to_bits() >> 52) as u32 - 1023;
    // Each level has half the pixels of the one before along its longer side, rounded down.
    let (last, level) = (exponent(w.max(h)), exponent(width));
    let mantissa = f64::from_bits(width.to_bits() & ((1 << 52) - 1) | 1023 << 52);
    if level < last { (level, (mantissa - 1.0) as f32) } else { (last, 0.0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_exact_at_powers_of_two_and_grow_between() {
        let level = |width: f64| {
            let sides = [[width / 4096.0, 0.0], [0.0, width / 4096.0]];
            level([4096.0; 2], covered([4096.0; 2], sides).2)
        };
        let want = [(0, 0.0), (0, 0.0), (1, 0.0), (1, 0.5), (2, 0.0), (10, 0.0), (12, 0.0)];
        assert_eq!([0.3, 1.0, 2.0, 3.0, 4.0, 1024.0, 1e9].map(level), want);
    }
}
