//! Linear values to the levels of a PNG: the sRGB curve, rounded, as two table look-ups.
//!
//! `round(levels · encode(v))` is a staircase. The smallest f32 on each step is found once with the
//! exact curve; after that a value needs no power. The bins are finer than the curve's steepest
//! step, so between a bin's start and a value lies at most one threshold.

use std::sync::OnceLock;

use fearless_simd::{Simd, f32x8, i32x8, prelude::*, u16x16};
use phong_bvh::Kernel;
use phong_scene::{srgb_decode, srgb_encode};
use rayon::prelude::*;

/// The sRGB curve as a staircase of `levels + 1` steps.
#[derive(Debug)]
pub(super) struct Curve {
    /// The highest level: 255 or 65535.
    levels: u16,
    /// The level at each bin's start; bins cut [0, 1) evenly.
    start: Vec<u16>,
    /// The smallest value on each step; above the last, none.
    threshold: Vec<f32>,
}

impl Curve {
    /// The curve to 255 levels.
    pub(super) fn eight() -> &'static Self {
        static EIGHT: OnceLock<Curve> = OnceLock::new();
        EIGHT.get_or_init(|| Self::new(255))
    }

    /// The curve to 65535 levels.
    pub(super) fn sixteen() -> &'static Self {
        static SIXTEEN: OnceLock<Curve> = OnceLock::new();
        SIXTEEN.get_or_init(|| Self::new(65535))
    }

    fn new(levels: u16) -> Self {
        let smallest = |level: u16| smallest_of(level, levels);
        let mut threshold: Vec<f32> = (0..=levels).into_par_iter().map(smallest).collect();
        threshold.push(f32::INFINITY);
        // Steeper than 12.92 the curve is nowhere.
        let bins = (13 * usize::from(levels)).next_power_of_two();
        let mut level = 0;
        let start = (0..bins).map(|bin| {
            let from = bin as f32 / bins as f32;
            while threshold[usize::from(level) + 1] <= from {
                level += 1;
            }
            level
        });
        Self { levels, start: start.collect(), threshold }
    }

    /// The level of a linear value: clamped, encoded, scaled, rounded half up. NaN is 0.
    pub(super) fn level(&self, v: f32) -> u16 {
        if v >= 1.0 {
            return self.levels;
        }
        // A power of two: the product is exact. Negative values and NaN become bin 0.
        let bin = (v * self.start.len() as f32) as usize;
        let level = self.start[bin];
        level + u16::from(v >= self.threshold[usize::from(level) + 1])
    }
}

/// The smallest f32 whose level is `level`.
fn smallest_of(level: u16, levels: u16) -> f32 {
    if level == 0 {
        return 0.0;
    }
    let edge = (f64::from(level) - 0.5) / f64::from(levels);
    let mut v = srgb_decode(edge) as f32;
    while rounded(v, levels) < level {
        v = v.next_up();
    }
    while rounded(v.next_down(), levels) >= level {
        v = v.next_down();
    }
    v
}

/// The definition: what [`Curve::level`] must give for `v` in [0, 1].
fn rounded(v: f32, levels: u16) -> u16 {
    (srgb_encode(f64::from(v)) * f64::from(levels) + 0.5) as u16
}

/// The level of a value that is not to be curved: clamped, scaled, rounded half up. NaN is 0.
pub(super) fn linear_level(v: f32, levels: u16) -> u16 {
    // To i32 and not to u16 at once: that is what the compiler makes vector code of.
    (f64::from(v.clamp(0.0, 1.0)) * f64::from(levels) + 0.5) as i32 as u16
}

/// [`linear_level`] of many values, of 255 levels: what a row of the usual picture takes.
pub(super) struct LinearLevels<'a> {
    pub(super) values: &'a [f32],
    /// What the values are multiplied by first.
    pub(super) gain: f32,
    /// As many.
    pub(super) to: &'a mut [u8],
}

impl Kernel for LinearLevels<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { values, gain, to } = self;
        let (values, last) = values.as_chunks::<32>();
        let (to, last_to) = to.as_chunks_mut::<32>();
        for (values, to) in values.iter().zip(to) {
            let [a, b, c, d] = [0, 8, 16, 24].map(|from| &values[from..from + 8]);
            let low = levels8(simd, a, gain).saturating_narrow(levels8(simd, b, gain));
            let high = levels8(simd, c, gain).saturating_narrow(levels8(simd, d, gain));
            let (low, high): (u16x16<S>, u16x16<S>) = (low.bitcast(), high.bitcast());
            low.narrow(high).store_slice(to);
        }
        for (value, to) in last.iter().zip(last_to) {
            *to = linear_level(value * gain, 255) as u8;
        }
    }
}

#[inline(always)]
fn levels8<S: Simd>(simd: S, values: &[f32], gain: f32) -> i32x8<S> {
    let v = f32x8::from_slice(simd, values) * gain;
    let (zero, one) = (f32x8::splat(simd, 0.0), f32x8::splat(simd, 1.0));
    // In this order NaN becomes 0.
    let v = v.simd_gt(zero).select(v, zero);
    let v = v.simd_lt(one).select(v, one);
    let (low, high) = v.widen();
    i32x8::truncate_from((low * 255.0 + 0.5).floor().narrow((high * 255.0 + 0.5).floor()))
}

#[cfg(test)]
mod tests {
    use phong_bvh::Level;

    use super::*;

    fn holds_around_every_step(curve: &Curve) {
        for level in 1..=curve.levels {
            let v = curve.threshold[usize::from(level)];
            assert_eq!(curve.level(v), level);
            assert_eq!(curve.level(v.next_down()), level - 1);
            assert_eq!(rounded(v, curve.levels), level);
            assert_eq!(rounded(v.next_down(), curve.levels), level - 1);
        }
    }

    #[test]
    fn the_staircase_steps_where_the_exact_curve_does() {
        holds_around_every_step(Curve::eight());
        holds_around_every_step(Curve::sixteen());
    }

    #[test]
    fn levels_between_the_steps_agree_with_the_exact_curve() {
        for curve in [Curve::eight(), Curve::sixteen()] {
            for i in 0..=100_000 {
                let v = i as f32 / 100_000.0;
                assert_eq!(curve.level(v), rounded(v, curve.levels), "{v}");
            }
        }
    }

    #[test]
    fn what_is_no_number_in_the_unit_interval_is_clamped_into_it() {
        for curve in [Curve::eight(), Curve::sixteen()] {
            for low in [-0.0, -1.0, f32::NEG_INFINITY, f32::NAN, f32::MIN_POSITIVE] {
                assert_eq!(curve.level(low), 0);
            }
            for high in [1.0, 1.000_1, 7.0, f32::INFINITY] {
                assert_eq!(curve.level(high), curve.levels);
            }
        }
        assert_eq!(linear_level(f32::NAN, 255), 0);
        assert_eq!(linear_level(-1.0, 255), 0);
        assert_eq!(linear_level(2.0, 65535), 65535);
    }

    #[test]
    fn linear_levels_of_many_are_those_of_each() {
        let mut values: Vec<f32> = (-100..2000).map(|i| i as f32 / 510.0 / 3.0).collect();
        values.extend([f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -0.0, 1e-40]);
        values.extend((0..=255).map(|i| ((f64::from(i) + 0.5) / 255.0) as f32));
        values.extend((0..=255).map(|i| ((f64::from(i) + 0.5) / 255.0) as f32).map(f32::next_down));
        for level in Level::ALL.into_iter().filter(|level| level.is_available()) {
            for gain in [1.0, 1.7] {
                let mut found = vec![7; values.len()];
                level.run(LinearLevels { values: &values, gain, to: &mut found });
                for (value, found) in values.iter().zip(found) {
                    assert_eq!(u16::from(found), linear_level(value * gain, 255), "{value}");
                }
            }
        }
    }

    #[test]
    fn halves_round_up() {
        assert_eq!(linear_level(0.5, 255), 128);
        assert_eq!(linear_level(0.25 / 255.0, 255), 0);
        assert_eq!(linear_level(0.5, 65535), 32768);
    }

    #[test]
    fn known_bytes_come_out() {
        // Numbers of IEC 61966-2-1 worked by hand: 0.5 → 0.735357, 0.18 → 0.461356.
        let curve = Curve::eight();
        assert_eq!(curve.level(0.5), 188);
        assert_eq!(curve.level(0.18), 118);
        assert_eq!(curve.level(0.002), 7);
    }
}
