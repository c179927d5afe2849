//! Pixel filters by importance: a sample's place in its pixel is drawn from the filter, so every
//! sample belongs to one pixel and, for filters that are never negative, weighs the same.

use phong_scene::FilterKind;

use crate::math::wide;
use crate::sampling::{Sampler, Use};

/// The least mean weight of a pixel's samples.
pub(crate) const LEAST_WEIGHT: f32 = 0.25;

/// The most samples of a pixel whose weights may have a smaller mean: those of more fall so evenly that too
/// few of them are where a filter is negative.
const MOST_UNEVEN: u32 = 32;

/// Steps of the tabulated distribution.
const STEPS: usize = 512;

/// A filter ready to draw from.
#[derive(Clone, Debug)]
pub(crate) struct Filter {
    shape: Option<Table>,
}

/// Where a sample lies and what it weighs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FilterSample {
    /// Offset from the pixel's centre in pixels, x to the right and y down.
    pub(crate) offset: [f32; 2],
    /// Weight, +1 or −1: the sign of the filter there. A pixel is Σ w·s / Σ w.
    pub(crate) weight: f32,
}

impl Filter {
    /// The filter of a kind.
    pub(crate) fn new(kind: FilterKind) -> Self {
        let shape = match kind {
            FilterKind::Box => None,
            FilterKind::Tent => Some(Table::new(1.0, |x| 1.0 - x)),
            FilterKind::Gaussian => Some(Table::new(1.5, |x| wide::exp(-2.0 * x * x))),
            FilterKind::Mitchell => Some(Table::new(2.0, mitchell)),
        };
        Self { shape }
    }

    /// [`Filter::sample`] of eight points: the offsets across, those down, and the weights.
    #[inline(always)]
    pub(crate) fn sample8(&self, [u, v]: [[f32; 8]; 2]) -> [[f32; 8]; 3] {
        let mut out = [[1.0; 8]; 3];
        if self.shape.is_none() {
            for lane in 0..8 {
                (out[0][lane], out[1][lane]) = (u[lane] - 0.5, v[lane] - 0.5);
            }
            return out;
        }
        for lane in 0..8 {
            let FilterSample { offset: [x, y], weight } = self.sample([u[lane], v[lane]]);
            (out[0][lane], out[1][lane], out[2][lane]) = (x, y, weight);
        }
        out
    }

    /// Whether the weights of a pixel's samples so nearly cancel that each is to weigh 1, for what is left of a
    /// surface that is even all over would not be like it. The sampler is that of any of the samples.
    pub(crate) fn is_uneven(&self, sampler: Sampler, samples: u32) -> bool {
        let is_signed = self.shape.as_ref().is_some_and(|table| table.negative.contains(&true));
        if !is_signed || samples > MOST_UNEVEN {
            return false;
        }
        let weight = |index| self.sample(sampler.at(index).pair(Use::Pixel)).weight;
        (0..samples).map(weight).sum::<f32>() < LEAST_WEIGHT * samples as f32
    }

    /// Draws a sample from a point of the unit square; (½, ½) is the pixel's centre.
    #[inline(always)]
    pub(crate) fn sample(&self, [u, v]: [f32; 2]) -> FilterSample {
        let Some(table) = &self.shape else {
            return FilterSample { offset: [u - 0.5, v - 0.5], weight: 1.0 };
        };
        let (x, wx) = table.draw(u);
        let (y, wy) = table.draw(v);
        FilterSample { offset: [x, y], weight: wx * wy }
    }
}

/// One dimension of a separable, even filter: the inverse of the distribution of its magnitude.
#[derive(Clone, Debug)]
struct Table {
    radius: f64,
    /// Share of the magnitude's integral over [0, radius] up to each step.
    cdf: Vec<f64>,
    /// Whether the filter is negative on each step.
    negative: Vec<bool>,
}

impl Table {
    fn new(radius: f64, f: impl Fn(f64) -> f64) -> Self {
        let middle = |i: usize| f((i as f64 + 0.5) / STEPS as f64 * radius);
        let mut cdf = vec![0.0];
        for i in 0..STEPS {
            cdf.push(cdf[i] + middle(i).abs());
        }
        let total = cdf[STEPS];
        for c in &mut cdf {
            *c /= total;
        }
        Self { radius, cdf, negative: (0..STEPS).map(|i| middle(i) < 0.0).collect() }
    }

    /// The place that `u` in [0, 1) leads to, and the sign there.
    fn draw(&self, u: f32) -> (f32, f32) {
        let signed = 2.0 * f64::from(u) - 1.0;
        let share = signed.abs();
        let step = self.cdf.partition_point(|&c| c <= share).clamp(1, STEPS) - 1;
        let (from, to) = (self.cdf[step], self.cdf[step + 1]);
        let within = if to > from { ((share - from) / (to - from)).min(1.0) } else { 0.0 };
        let x = (step as f64 + within) / STEPS as f64 * self.radius;
        let x = if signed < 0.0 { -x } else { x };
        (x as f32, if self.negative[step] { -1.0 } else { 1.0 })
    }
}

/// Mitchell and Netravali 1988, B = C = ⅓, radius 2.
fn mitchell(x: f64) -> f64 {
    if x < 1.0 {
        (21.0 * x * x * x - 36.0 * x * x + 16.0) / 18.0
    } else {
        (-7.0 * x * x * x + 36.0 * x * x - 60.0 * x + 32.0) / 18.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The filter's second moment along x, with signed weights, from a fine grid of draws.
    fn variance(kind: FilterKind) -> f64 {
        let filter = Filter::new(kind);
        let n = 4096;
        let (mut sum, mut weight) = (0.0, 0.0);
        for i in 0..n {
            let s = filter.sample([(i as f32 + 0.5) / n as f32, 0.5]);
            sum += f64::from(s.weight * s.offset[0] * s.offset[0]);
            weight += f64::from(s.weight);
        }
        sum / weight
    }

    #[test]
    fn the_centre_is_the_centre() {
        for kind in [FilterKind::Box, FilterKind::Tent, FilterKind::Gaussian, FilterKind::Mitchell]
        {
            let s = Filter::new(kind).sample([0.5, 0.5]);
            assert_eq!((s.offset, s.weight), ([0.0, 0.0], 1.0), "{kind:?}");
        }
    }

    #[test]
    fn each_filter_has_the_spread_of_its_formula() {
        // ∫x²f / ∫f: box 1/12, tent 1/6, Gaussian of σ ½ cut at 3σ: ¼ (1 − 6φ(3)/(2Φ(3) − 1)).
        for (kind, want) in [
            (FilterKind::Box, 1.0 / 12.0),
            (FilterKind::Tent, 1.0 / 6.0),
            (FilterKind::Gaussian, 0.25 * (1.0 - 6.0 * 0.004_431_848 / 0.997_300_2)),
            // Mitchell–Netravali's family has variance B/3 + … ; by quadrature of the polynomial:
            (FilterKind::Mitchell, quadrature()),
        ] {
            let got = variance(kind);
            assert!((got - want).abs() < 2e-3, "{kind:?}: {got} instead of {want}");
        }
    }

    fn quadrature() -> f64 {
        let n = 20_000;
        let at = |i: i32| (f64::from(i) + 0.5) / f64::from(n) * 2.0;
        let f = |x: f64| {
            let (b, c) = (1.0 / 3.0, 1.0 / 3.0);
            if x < 1.0 {
                (12.0 - 9.0 * b - 6.0 * c) * x * x * x
                    + (-18.0 + 12.0 * b + 6.0 * c) * x * x
                    + (6.0 - 2.0 * b)
            } else {
                (-b - 6.0 * c) * x * x * x
                    + (6.0 * b + 30.0 * c) * x * x
                    + (-12.0 * b - 48.0 * c) * x
                    + (8.0 * b + 24.0 * c)
            }
        };
        let second: f64 = (0..n).map(|i| at(i) * at(i) * f(at(i))).sum();
        second / (0..n).map(|i| f(at(i))).sum::<f64>()
    }
}
