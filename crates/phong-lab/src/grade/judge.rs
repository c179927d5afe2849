//! How well a mistake explains a picture.
//!
//! A mistake is made on purpose, the picture computed with it, and held against theirs. What is left
//! is measured in steps of 8 bits, pixel by pixel, each capped, so that a few pixels that a program
//! sees otherwise do not outweigh all others.

use rayon::prelude::*;

use super::elsewhere::Elsewhere;
use super::fault::{Change, Fault};
use super::picture::{Layout, Residual, Theirs};
use super::points::Point;
use super::prepared::Prepared;
use super::shade::shade;
use super::tone::encode;

/// An explained picture may have this share of pixels that are off, and two, that programs see otherwise.
const MOST_OVER: f64 = 5e-4;
/// The same where pixels at edges are looked at too.
const MOST_OVER_AT_EDGES: f64 = 0.01;
/// An explained picture is at most this far off, rms.
pub(super) const MOST_RMS: f64 = 1.0 / 255.0;
/// No more is counted of a channel's difference, squared steps of 8 bits.
const CAP: f64 = 16.0;
/// What rounding to 8 bits leaves of a pixel: three channels with a variance of 1/12 each, and a
/// third more for what programs round otherwise.
pub(super) const ROUNDED: f64 = 0.33;
/// So many before a mistake is given up, that the error which is told is about right.
const LEAST_PIXELS: usize = 192;

/// What is left of a picture, summed.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Tally {
    pub(super) pixels: usize,
    /// Sum of the squares of all channels, encoded.
    squares: f64,
    /// Sum of capped squares, in steps of 8 bits: as they are, and if their levels were cut to whole
    /// numbers instead of rounded.
    capped: [f64; 2],
    /// Pixels notably off.
    pub(super) over: usize,
    /// Whether all pixels were looked at.
    pub(super) complete: bool,
}

impl Tally {
    pub(super) fn rms(&self) -> f64 {
        (self.squares / (3.0 * self.pixels.max(1) as f64)).sqrt()
    }

    /// What is left of a pixel on the whole: squared steps of 8 bits.
    pub(super) fn score(&self) -> f64 {
        self.capped[0].min(self.capped[1]) / self.pixels.max(1) as f64
    }

    pub(super) fn share_over(&self) -> f64 {
        self.over as f64 / self.pixels.max(1) as f64
    }

    /// Whether a picture with so little left is explained, that had `without` left.
    pub(super) fn explains(&self, without: &Self, at_edges: bool) -> bool {
        let most = if at_edges { MOST_OVER_AT_EDGES } else { MOST_OVER };
        let few = self.over as f64 <= (most * self.pixels as f64).max(2.0);
        let near = at_edges || self.rms() <= MOST_RMS;
        let gained = without.score() - self.score();
        let enough = gained * self.pixels as f64 >= LEAST_GAIN && self.fit(without) >= LEAST_FIT;
        self.complete && few && near && enough && self.pixels >= LEAST_LEFT
    }

    /// The share of the error that is explained, but for rounding.
    pub(super) fn fit(&self, without: &Self) -> f64 {
        let (left, before) = (self.score(), without.score());
        let floor = left.min(ROUNDED);
        ((before - left) / (before - floor).max(1e-9)).clamp(0.0, 1.0)
    }
}

/// What rounding alone may seem to gain stays far below this: squared steps of 8 bits.
const LEAST_GAIN: f64 = 30.0;
/// Less than this share of the error is no explanation.
const LEAST_FIT: f64 = 0.8;
/// Fewer pixels explain nothing.
const LEAST_LEFT: usize = 50;

/// Their picture beside the right one.
pub(super) struct Judge<'a> {
    pub(super) right: &'a Prepared,
    pub(super) theirs: &'a Theirs,
    /// Pixels that are looked at: not at edges.
    pub(super) inner: &'a [usize],
    /// The same, edges and all.
    all: &'a [usize],
    /// What is left without any mistake, of either.
    pub(super) without: [Tally; 2],
}

impl<'a> Judge<'a> {
    pub(super) fn new(right: &'a Prepared, theirs: &'a Theirs) -> Self {
        let (inner, all) = (&*right.some_inner, &*right.some);
        let mut judge = Self { right, theirs, inner, all, without: [Tally::default(); 2] };
        let ours = |_, i: usize| Some(right.ours[i]);
        judge.without = [inner, all].map(|at| judge.tally(at, None, usize::MAX, ours));
        judge
    }

    /// What is left where the picture is `predicted` at pixels, which are given their place in
    /// `pixels` and their number. Given up after `give_up` pixels where too many are off.
    fn tally(
        &self,
        pixels: &[usize],
        layout: Option<Layout>,
        give_up: usize,
        predicted: impl Fn(usize, usize) -> Option<[f32; 3]>,
    ) -> Tally {
        let size = self.right.size;
        let most = (MOST_OVER * pixels.len() as f64).max(2.0) as usize;
        let mut out = Tally { complete: true, ..Tally::default() };
        for (k, &i) in pixels.iter().enumerate() {
            if out.over > most && k >= give_up {
                out.complete = false;
                break;
            }
            let (Some(drawn), Some(predicted)) = (self.theirs.at(i, size, layout), predicted(k, i))
            else {
                continue;
            };
            if drawn.iter().any(|level| level.value.is_nan()) {
                continue;
            }
            out.pixels += 1;
            let mut worst = 0.0_f64;
            for (drawn, predicted) in drawn.iter().zip(predicted) {
                let off = drawn.apart(predicted);
                out.squares += off * off;
                let steps = 255.0 * off;
                let signed = 255.0 * (f64::from(predicted) - f64::from(drawn.value)) - 0.5;
                let cut = (signed.abs() - 255.0 * f64::from(drawn.rounding)).max(0.0);
                out.capped[0] += (steps * steps).min(CAP);
                out.capped[1] += (cut * cut).min(CAP);
                worst = worst.max(off);
            }
            if worst > Residual::NOTICED {
                let smoothed = Residual::SMOOTHED * self.theirs.standing_out(i, size[0] as usize);
                out.over += usize::from(worst > Residual::NOTICED + smoothed);
            }
        }
        out
    }

    /// What is left with a fault, at the points of the right picture.
    pub(super) fn with(&self, fault: &Fault) -> Tally {
        self.with_until(fault, LEAST_PIXELS)
    }

    fn with_until(&self, fault: &Fault, give_up: usize) -> Tally {
        let facts = &self.right.facts;
        self.tally(self.inner, fault.layout, give_up, |_, i| {
            let point = &self.right.points[i];
            if fault.any_background && point.surface.is_none() {
                return None;
            }
            let color = shade(point, fault, facts).total() * fault.gain;
            Some(encode(color, fault.tone))
        })
    }

    /// What is left with both of two changes; soon given up.
    pub(super) fn with_both(&self, first: &Change, second: &Change) -> Tally {
        self.with_until(&Fault::default().with(first).with(second), 16)
    }

    /// The shift by whole pixels that explains most, edges and all.
    pub(super) fn shifted(&self) -> (Layout, Tally) {
        let few = &self.all[..self.all.len().min(512)];
        let reach = MOST_SHIFTED.min(self.right.size[0].min(self.right.size[1]) as i32 / 4);
        let ours = |_: usize, i: usize| Some(self.right.ours[i]);
        let shifts: Vec<(i32, i32)> =
            (-reach..=reach).flat_map(|y| (-reach..=reach).map(move |x| (x, y))).collect();
        let score = |&(x, y): &(i32, i32)| {
            let tally = self.tally(few, Some(Layout::Shifted(x, y)), usize::MAX, ours);
            ((x, y), tally.score())
        };
        let scores: Vec<_> = shifts.par_iter().filter(|s| **s != (0, 0)).map(score).collect();
        let best = scores.iter().min_by(|a, b| a.1.total_cmp(&b.1)).map_or((1, 0), |best| best.0);
        let layout = Layout::Shifted(best.0, best.1);
        (layout, self.tally(self.all, Some(layout), usize::MAX, ours))
    }

    /// What is left where rays go elsewhere, with a fault besides; edges and all, or else without;
    /// and what was left there without either.
    pub(super) fn elsewhere(&self, way: &Traced, fault: &Fault) -> (Tally, Tally, bool) {
        let facts = &self.right.facts;
        let predicted = |k: usize, _: usize| {
            let point = way.points.get(k)?.as_ref()?;
            let color = shade(point, fault, facts).total() * fault.gain;
            Some(encode(color, fault.tone))
        };
        let pixels = &self.all[..way.points.len().min(self.all.len())];
        let tally = self.tally(pixels, fault.layout, usize::MAX, predicted);
        let known = |k: usize, i: usize| {
            way.points.get(k)?.as_ref()?;
            Some(self.right.ours[i])
        };
        let without = self.tally(pixels, None, usize::MAX, known);
        if tally.explains(&without, true) || tally.share_over() > MOST_AT_EDGES {
            return (tally, without, true);
        }
        let inner = |k: usize, i: usize| {
            let point = way.points.get(k)?.as_ref()?;
            way.tracer.is_inner(i, point).then_some(())
        };
        let at: Vec<bool> =
            pixels.par_iter().enumerate().map(|(k, &i)| inner(k, i).is_some()).collect();
        let tally = self.tally(pixels, fault.layout, usize::MAX, |k, i| {
            if at[k] { predicted(k, i) } else { None }
        });
        let without = self.tally(pixels, None, usize::MAX, |k, i| {
            if at[k] && self.right.inner[i] { Some(self.right.ours[i]) } else { None }
        });
        (tally, without, false)
    }

    /// What is left of a picture whose pixels are told.
    pub(super) fn held_against(&self, predicted: impl Fn(usize) -> [f32; 3]) -> Tally {
        self.tally(self.inner, None, usize::MAX, |_, i| Some(predicted(i)))
    }

    /// [`Judge::elsewhere`], edges and all, of the first pixels; `None` where those do not agree.
    pub(super) fn elsewhere_few(&self, way: &Traced, fault: &Fault) -> Option<(Tally, Tally)> {
        let facts = &self.right.facts;
        let pixels = &self.all[..way.points.len().min(FEW)];
        let most = (MOST_OVER_AT_EDGES * pixels.len() as f64) as usize;
        let predicted = |k: usize, _: usize| {
            let point = way.points.get(k)?.as_ref()?;
            Some(encode(shade(point, fault, facts).total() * fault.gain, fault.tone))
        };
        let soon = self.tally(&pixels[..pixels.len().min(48)], fault.layout, 16, predicted);
        if soon.over > most {
            return None;
        }
        let tally = self.tally(pixels, fault.layout, usize::MAX, predicted);
        let ours = |_, i: usize| Some(self.right.ours[i]);
        Some((tally, self.tally(pixels, None, usize::MAX, ours)))
    }

    /// Traces the rest of rays that go elsewhere, where the first few look likely.
    pub(super) fn trace_on<'b>(&self, tracer: Elsewhere<'b>, few: &[Option<Point>]) -> Traced<'b> {
        let mut traced = Traced { points: few.to_vec(), tracer };
        let (tally, without, _) = self.elsewhere(&traced, &Fault::default());
        let likely = tally.share_over() < 0.25 && tally.share_over() <= without.share_over();
        if likely && few.len() < self.all.len() {
            let rest = traced.tracer.trace(&self.all[few.len()..]);
            traced.points.extend(rest);
        }
        traced
    }
}

/// Shifts by more pixels are not looked for.
const MOST_SHIFTED: i32 = 6;
/// So many pixels say whether rays that go elsewhere are likely.
pub(super) const FEW: usize = 768;
/// With more pixels off than these, edges are not the reason.
const MOST_AT_EDGES: f64 = 0.25;

/// What rays that go elsewhere met.
pub(super) struct Traced<'a> {
    points: Vec<Option<Point>>,
    tracer: Elsewhere<'a>,
}
