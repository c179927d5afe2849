//! Least squares over eyes, and a search that needs no luck.

use super::lobe::{LitLobe, Lobe, Model, Slice};

/// Eyes on either side of the mirror direction. They crowd towards it, so that lobes of a
/// hundredth of a degree are seen as well as those of a hemisphere.
const EYES: u32 = 240;
/// Numbers tried, evenly in their logarithm, before the best is narrowed down.
const TRIES: u32 = 64;
/// Golden sections: the bracket shrinks to 1e-8 of itself.
const SECTIONS: u32 = 38;

/// The best number, and whether it lies at an end of its model's range.
pub(super) struct Best {
    pub(super) number: f64,
    pub(super) at_the_end: bool,
}

/// A lobe over the eyes of a slice, 1 at its peak, and each eye's share of the slice.
struct Profile {
    values: Vec<f64>,
    shares: Vec<f64>,
}

impl Profile {
    fn of(lobe: Lobe, theta: f64, slice: Slice) -> Self {
        let shone = LitLobe::new(lobe, theta);
        let mut values = Vec::with_capacity(2 * EYES as usize);
        let mut shares = Vec::with_capacity(2 * EYES as usize);
        for end in slice.ends(theta) {
            for i in 0..EYES {
                let u = (f64::from(i) + 0.5) / f64::from(EYES);
                values.push(shone.at(slice, end * u * u * u));
                shares.push(end.abs() * u * u);
            }
        }
        let peak = values.iter().copied().fold(0.0, f64::max);
        if peak > 0.0 {
            for value in &mut values {
                *value /= peak;
            }
        }
        Self { values, shares }
    }

    /// `∫ A²`, or `∫ (A − B)²`, but for a factor.
    fn square(&self, less: Option<&Self>) -> f64 {
        let off = |i: usize| self.values[i] - less.map_or(0.0, |b| b.values[i]);
        self.shares.iter().enumerate().map(|(i, share)| share * off(i) * off(i)).sum()
    }
}

/// What is left of `from` when `to` is taken off, as a share of `from`.
pub(super) fn residual(from: Lobe, to: Lobe, theta: f64, slice: Slice) -> f64 {
    let [a, b] = [from, to].map(|lobe| Profile::of(lobe, theta, slice));
    (a.square(Some(&b)) / a.square(None)).sqrt()
}

/// The number of `model` that leaves least of `from`.
pub(super) fn best(from: Lobe, model: Model, theta: f64, slice: Slice) -> Best {
    let wanted = Profile::of(from, theta, slice);
    let [least, most] = model.range();
    let octaves = libm::log(most / least);
    let number = |t: f64| (least * libm::exp(t * octaves)).clamp(least, most);
    let cost = |t: f64| {
        let lobe = Lobe { model, number: number(t) };
        wanted.square(Some(&Profile::of(lobe, theta, slice)))
    };
    let tried = |i: u32| cost(f64::from(i) / f64::from(TRIES));
    let costs: Vec<f64> = (0..=TRIES).map(tried).collect();
    let start = (0..costs.len()).min_by(|a, b| costs[*a].total_cmp(&costs[*b])).unwrap_or(0);
    let step = 1.0 / f64::from(TRIES);
    let middle = start as f64 * step;
    let t = golden((middle - step).max(0.0), (middle + step).min(1.0), cost);
    Best { number: number(t), at_the_end: !(1e-6..=1.0 - 1e-6).contains(&t) }
}

/// The place of the least value between `low` and `high`, by golden sections.
fn golden(mut low: f64, mut high: f64, cost: impl Fn(f64) -> f64) -> f64 {
    let ratio = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut left, mut right) = (high - ratio * (high - low), low + ratio * (high - low));
    let (mut cost_left, mut cost_right) = (cost(left), cost(right));
    for _ in 0..SECTIONS {
        if cost_left <= cost_right {
            (high, right, cost_right) = (right, left, cost_left);
            left = high - ratio * (high - low);
            cost_left = cost(left);
        } else {
            (low, left, cost_left) = (left, right, cost_right);
            right = low + ratio * (high - low);
            cost_right = cost(right);
        }
    }
    0.5 * (low + high)
}
