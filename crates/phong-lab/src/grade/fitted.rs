//! Mistakes with a number of their own, which is found from the picture by least squares.

use phong::terms::Terms;
use phong_scene::{Rgb, srgb_decode};

use super::fault::{Change, Fault};
use super::hypotheses::Hypothesis;
use super::judge::Judge;
use super::shade::shade;
use super::wrong::{Shadows, Wrong};

/// Values of their picture from here on may be clipped.
const CLIPPED: f64 = 0.995;
/// A factor nearer to 1 is none.
const NO_FACTOR: f64 = 0.02;

/// A change of the sum by a number.
type Scaled = fn(&mut Wrong, f32);

/// Sums of products of what a mistake scales with what is left for it.
#[derive(Default)]
struct Squares {
    own: f64,
    with_rest: f64,
}

impl Squares {
    fn add(&mut self, scaled: Rgb, rest: [f64; 3]) {
        for (scaled, rest) in scaled.to_array().into_iter().zip(rest) {
            if rest.is_finite() {
                self.own += f64::from(scaled) * f64::from(scaled);
                self.with_rest += f64::from(scaled) * rest;
            }
        }
    }

    /// The factor, if there is something to scale and it is neither 0 nor 1.
    fn factor(&self) -> Option<f32> {
        let factor = self.with_rest / self.own;
        let told = self.own > 1e-9 && factor > NO_FACTOR && (factor - 1.0).abs() > NO_FACTOR;
        told.then_some(factor as f32)
    }
}

/// The mistakes, each with the number that fits best.
pub(super) fn fitted(judge: &Judge) -> Vec<Hypothesis> {
    let changed = |change: fn(&mut Wrong)| Fault::default().with(&Change::Sum(change));
    let right = Fault::default();
    let unshadowed = changed(|w| w.shadows = Shadows::Missing);
    let mut all = Squares::default();
    let mut blocked = Squares::default();
    let mut terms: [Squares; 3] = std::array::from_fn(|_| Squares::default());
    for &i in judge.inner {
        let point = &judge.right.points[i];
        let Some(drawn) = judge.theirs.at(i, judge.right.size, None) else { continue };
        // What may be clipped, and what is no number, says nothing.
        let drawn = drawn.map(|level| match f64::from(level.value) {
            v if v < CLIPPED => srgb_decode(v.max(0.0)),
            _ => f64::NAN,
        });
        let of = |fault: &Fault| shade(point, fault, &judge.right.facts);
        let sum = of(&right);
        let total = sum.total();
        let left = |part: Rgb| {
            let rest = total - part;
            let rest = rest.to_array();
            std::array::from_fn(|c| drawn[c] - f64::from(rest[c]))
        };
        all.add(total, drawn);
        if point.surface.is_none() {
            continue;
        }
        let Terms { ambient, diffuse, specular, .. } = sum;
        for (squares, term) in terms.iter_mut().zip([ambient, diffuse, specular]) {
            squares.add(term, left(term));
        }
        let shadow = of(&unshadowed).total() - total;
        blocked.add(shadow, std::array::from_fn(|c| drawn[c] - f64::from(total.to_array()[c])));
    }
    let told = |cause: &str, change: Change, factor: f32| {
        Hypothesis::of(cause, change, format!("× {factor:.2}"))
    };
    let ways: [(&str, Scaled); 3] = [
        ("ambient-factor", |w, by| w.ambient_factor = by),
        ("diffuse-factor", |w, by| w.diffuse_factor = by),
        ("specular-factor", |w, by| w.specular_factor = by),
    ];
    let mut out = Vec::new();
    for ((cause, way), squares) in ways.into_iter().zip(&terms) {
        out.extend(squares.factor().map(|by| told(cause, Change::Fitted(way, by), by)));
    }
    out.extend(all.factor().map(|by| told("exposure", Change::Gain(by), by)));
    if let Some(by) = blocked.factor().filter(|by| *by < 1.0) {
        let way: fn(&mut Wrong, f32) = |w, by| w.shadows = Shadows::Through(by, by);
        out.push(told("shadow-half", Change::Fitted(way, by), by));
    }
    out
}
