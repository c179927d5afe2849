//! Marble and wood: waves along an axis and rings about one, which noise bends.

use glam::DVec3;
use phong_scene::Rgb;

use super::noise::{Octaves, shown_of};
use super::ramp::Ramp;

/// How far noise moves veins: what is rarely met counts as the most.
const RARE: f64 = 2.5;

/// How many places the mean over a wave is of.
const STEPS: u32 = 256;

/// What part of a ring rises, slowly; the rest falls.
const RISING: f64 = 0.85;

/// Veins or rings.
#[derive(Clone, Debug)]
pub(super) struct Veins {
    rings: bool,
    /// Unit.
    axis: DVec3,
    turbulence: f64,
    octaves: Octaves,
    ramp: Ramp,
    /// The mean of the colours of a wave.
    mean: Rgb,
}

impl Veins {
    /// `axis` may have any length.
    pub(super) fn new(
        rings: bool,
        axis: DVec3,
        turbulence: f64,
        octaves: Octaves,
        ramp: Ramp,
    ) -> Self {
        let axis = axis.normalize_or(DVec3::Y);
        let place = |i: u32| wave(rings, (f64::from(i) + 0.5) / f64::from(STEPS));
        let sum = (0..STEPS).map(|i| ramp.at(place(i) as f32)).sum::<Rgb>();
        let mean = sum / STEPS as f32;
        Self { rings, axis, turbulence, octaves, ramp, mean }
    }

    /// The colour at a place in veins, where a sample of the picture is so many of them wide.
    pub(super) fn value(&self, p: DVec3, width: f64) -> Rgb {
        let along = self.axis.dot(p);
        let across = if self.rings { (p - along * self.axis).length() } else { along };
        let moved = self.turbulence / RARE * self.octaves.sum(p, width).value;
        // Where they are bent they are narrower.
        let shown = shown_of(width * (1.0 + self.turbulence));
        let at = across + moved;
        if shown <= 0.0 || !at.is_finite() {
            return self.mean;
        }
        let color = self.ramp.at(wave(self.rings, at - at.floor()) as f32);
        self.mean + shown as f32 * (color - self.mean)
    }
}

/// t at a part of a wave, from 0 to 1.
fn wave(rings: bool, part: f64) -> f64 {
    let smooth = |x: f64| x * x * (3.0 - 2.0 * x);
    if !rings {
        return smooth((2.0 * part - 1.0).abs());
    }
    if part < RISING {
        let risen = part / RISING;
        risen * risen
    } else {
        smooth(((1.0 - part) / (1.0 - RISING)).max(0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn veins(rings: bool, turbulence: f64) -> Veins {
        let octaves = Octaves::new(3, 2.0, 0.5, 0);
        let ramp = Ramp::new(&[(0.0, Rgb::BLACK), (1.0, Rgb::WHITE)]);
        Veins::new(rings, DVec3::Z, turbulence, octaves, ramp)
    }

    #[test]
    fn without_noise_veins_lie_along_the_axis_and_rings_about_it() {
        let marble = veins(false, 0.0);
        let at = |p: [f64; 3]| marble.value(DVec3::from(p), 0.0).r;
        assert_eq!(
            [at([3.3, 1.0, 0.0]), at([0.1, 2.2, 0.5]), at([0.0, 0.0, 7.0])],
            [1.0, 0.0, 1.0]
        );
        let wood = veins(true, 0.0);
        let at = |p: [f64; 3]| wood.value(DVec3::from(p), 0.0).r;
        assert_eq!(at([0.3, 0.4, 9.0]), at([0.5, 0.0, -2.0]));
        assert!(at([0.84, 0.0, 0.0]) > 0.95 && at([0.999, 0.0, 0.0]) < 0.01);
    }

    #[test]
    fn far_away_veins_become_their_mean() {
        for rings in [false, true] {
            let veins = veins(rings, 0.7);
            let place = |i: i32| f64::from(i) * DVec3::new(0.618, 0.414, 0.732);
            let all = (0..5000).map(|i| veins.value(place(i), 0.0).r).sum::<f32>() / 5000.0;
            let wide = veins.value(DVec3::splat(0.2), 1.0).r;
            assert!((wide - all).abs() < 0.02, "{wide} {all}");
            for p in [DVec3::splat(1e18), DVec3::splat(f64::INFINITY), DVec3::NAN] {
                let value = veins.value(p, f64::NAN).r;
                assert!((0.0..=1.0).contains(&value), "{p}: {value}");
            }
        }
    }
}
