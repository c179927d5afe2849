//! The colours that a number from 0 to 1 runs through, and their mean over a range of it.

use phong_scene::Rgb;

/// Colours along t: linear between stops, and beyond them as they are.
#[derive(Clone, Debug)]
pub(super) struct Ramp {
    /// `t`, never falling, and the colour there.
    stops: Vec<(f32, Rgb)>,
    /// Of each stop the integral of the colours from t = 0 to there.
    sums: Vec<[f64; 3]>,
}

/// Half a range that is no wider than this counts as a point.
const POINT: f64 = 1e-6;

impl Ramp {
    pub(super) fn new(stops: &[(f32, Rgb)]) -> Self {
        let mut ramp = Self { stops: stops.to_vec(), sums: Vec::with_capacity(stops.len()) };
        for &(t, _) in stops {
            let sum = ramp.integral(t.into());
            ramp.sums.push(sum);
        }
        ramp
    }

    /// The colour at t; black where there are no stops.
    pub(super) fn at(&self, t: f32) -> Rgb {
        Rgb::of_stops(&self.stops, t)
    }

    /// The mean of the colours from `t − half` to `t + half`.
    pub(super) fn mean(&self, t: f64, half: f64) -> Rgb {
        if half.is_nan() || half <= POINT {
            return self.at(t as f32);
        }
        let (from, to) = (self.integral(t - half), self.integral(t + half));
        let channel = |c: usize| ((to[c] - from[c]) / (2.0 * half)).max(0.0) as f32;
        Rgb::new(channel(0), channel(1), channel(2))
    }

    /// The integral of the colours from 0 to t, over the stops whose sums are known.
    fn integral(&self, t: f64) -> [f64; 3] {
        let Some(&(_, first)) = self.stops.first() else { return [0.0; 3] };
        let known = &self.stops[..self.sums.len()];
        let next = known.partition_point(|&(at, _)| f64::from(at) <= t);
        let Some(last) = next.checked_sub(1) else {
            return first.to_array().map(|v| f64::from(v) * t);
        };
        let (at, a) = self.stops[last];
        let way = t - f64::from(at);
        let slope = match self.stops.get(next) {
            Some(&(to, b)) if to > at => [b.r - a.r, b.g - a.g, b.b - a.b]
                .map(|change| f64::from(change) / (f64::from(to) - f64::from(at))),
            _ => [0.0; 3],
        };
        let a = a.to_array();
        std::array::from_fn(|c| self.sums[last][c] + way * (f64::from(a[c]) + 0.5 * way * slope[c]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mean_is_that_of_many_places() {
        let stops = [
            (0.1, Rgb::BLACK),
            (0.5, Rgb::new(1.0, 0.2, 0.0)),
            (0.5, Rgb::grey(3.0)),
            (0.9, Rgb::WHITE),
        ];
        let ramp = Ramp::new(&stops);
        for (t, half) in [(0.5, 0.5), (0.3, 0.1), (0.05, 0.2), (0.95, 0.3), (0.5, 0.01)] {
            let count = 20_000;
            let place = |i: i32| t - half + 2.0 * half * (f64::from(i) + 0.5) / f64::from(count);
            let sum = (0..count).fold([0.0; 3], |sum: [f64; 3], i| {
                let color = ramp.at(place(i) as f32).to_array();
                std::array::from_fn(|c| sum[c] + f64::from(color[c]))
            });
            let mean = ramp.mean(t, half).to_array();
            for c in 0..3 {
                let want = sum[c] / f64::from(count);
                assert!((f64::from(mean[c]) - want).abs() < 1e-3, "{t} ± {half}: {mean:?}");
            }
        }
        assert_eq!(ramp.mean(0.3, 0.0), ramp.at(0.3));
        assert_eq!(Ramp::new(&[]).mean(0.5, 0.5), Rgb::BLACK);
    }
}
