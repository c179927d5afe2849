//! Noises of several sizes, added up; and what of them a sample of the picture cannot show.

use glam::DVec3;
use phong_scene::Rgb;

use super::lattice::{FAR, noise};
use super::ramp::Ramp;

/// How far [`noise`] is from 0: the root of its mean square.
const DEVIATION: f64 = 0.27;

/// How far t of noise is from its mean, 0.5, likewise: 99 of 100 places are within 0 and 1.
const SPREAD: f64 = 0.2;

/// Noises that are added up, each finer and weaker than the one before.
#[derive(Clone, Copy, Debug)]
pub(super) struct Octaves {
    count: u32,
    lacunarity: f64,
    gain: f64,
    seed: u32,
}

/// A sum of noises.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sum {
    /// Of those that a sample can show: about as far from 0 as 1, were all of them shown.
    pub(super) value: f64,
    /// How far the others are from 0, likewise.
    pub(super) lost: f64,
}

impl Octaves {
    pub(super) fn new(count: u32, lacunarity: f64, gain: f64, seed: u32) -> Self {
        Self { count, lacunarity, gain, seed }
    }

    /// Their sum at a place in cells of the first, where a sample of the picture is so many of these wide.
    pub(super) fn sum(&self, p: DVec3, width: f64) -> Sum {
        let (mut fine, mut strength) = (1.0, 1.0);
        let (mut sum, mut shown, mut all) = (0.0, 0.0, 0.0);
        for octave in 0..self.count {
            let at = p * fine;
            let part = strength * shown_of(width * fine);
            if part > 0.0 && at.abs().max_element() < FAR {
                sum += part * noise(at, u64::from(self.seed) << 8 | u64::from(octave));
                shown += part * part;
            }
            all += strength * strength;
            fine *= self.lacunarity;
            strength *= self.gain;
        }
        Sum { value: sum / (DEVIATION * all.sqrt()), lost: (1.0 - shown / all).max(0.0).sqrt() }
    }
}

/// How much is left of a pattern where a sample of the picture is so many of its cells wide: all up to a
/// quarter of one, nothing from a whole one on, where its mean takes its place.
pub(super) fn shown_of(width: f64) -> f64 {
    let gone = ((width - 0.25) / 0.75).clamp(0.0, 1.0);
    if gone.is_nan() { 0.0 } else { 1.0 - gone * gone * (3.0 - 2.0 * gone) }
}

/// Noise as colours.
#[derive(Clone, Debug)]
pub(super) struct Noise {
    pub(super) ramp: Ramp,
    pub(super) octaves: Octaves,
}

impl Noise {
    pub(super) fn value(&self, p: DVec3, width: f64) -> Rgb {
        let Sum { value, lost } = self.octaves.sum(p, width);
        let t = (0.5 + SPREAD * value).clamp(0.0, 1.0);
        // What is lost counts as spread evenly, as far about t as it was.
        self.ramp.mean(t, 3.0_f64.sqrt() * SPREAD * lost)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn places() -> impl Iterator<Item = DVec3> {
        (0..20_000).map(|i| {
            let i = f64::from(i);
            DVec3::new(i * 0.754_877_666, i * 0.569_840_291, i * 0.339_887_499)
        })
    }

    fn grey(count: u32) -> Noise {
        let octaves = Octaves { count, lacunarity: 2.0, gain: 0.5, seed: 0 };
        Noise { ramp: Ramp::new(&[(0.0, Rgb::BLACK), (1.0, Rgb::WHITE)]), octaves }
    }

    #[test]
    fn the_mean_of_noise_is_the_middle_and_its_spread_is_as_stated() {
        for count in [1, 4] {
            let noise = grey(count);
            let values: Vec<_> = places().map(|p| f64::from(noise.value(p, 0.0).r)).collect();
            let n = values.len() as f64;
            let mean = values.iter().sum::<f64>() / n;
            let square = values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / n;
            let ends = values.iter().filter(|v| **v <= 0.0 || **v >= 1.0).count();
            assert!((mean - 0.5).abs() < 0.01, "{count}: mean {mean}");
            assert!((square.sqrt() - SPREAD).abs() < 0.01, "{count}: spread {}", square.sqrt());
            assert!(ends * 50 < values.len(), "{count}: {ends} at the ends");
        }
    }

    #[test]
    fn what_a_sample_cannot_show_becomes_the_mean() {
        // Of colours that do not run evenly: their mean is not the colour of the mean.
        let stops = [(0.0, Rgb::BLACK), (0.6, Rgb::BLACK), (0.7, Rgb::WHITE)];
        let noise = Noise { ramp: Ramp::new(&stops), ..grey(3) };
        let all = places().map(|p| noise.value(p, 0.0).r);
        let mean = all.sum::<f32>() / 20_000.0;
        let wide = noise.value(DVec3::new(1.3, 0.2, -5.1), 4.0).r;
        assert!((wide - mean).abs() < 0.05, "{wide} {mean}");
        for width in [0.0, 0.3, 1e300, f64::INFINITY, f64::NAN] {
            for p in [DVec3::splat(0.3), DVec3::splat(1e18), DVec3::splat(f64::INFINITY)] {
                let value = noise.value(p, width).r;
                assert!((0.0..=1.0).contains(&value), "{p} {width}: {value}");
            }
        }
    }
}
