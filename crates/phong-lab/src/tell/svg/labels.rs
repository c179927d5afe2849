//! Where letters go: beside what they name, and not upon anything else.

use std::f64::consts::TAU;

use glam::DVec2;
use phong::math::wide;

/// Letters closer than this touch.
const APART: f64 = 19.0;
/// A letter closer than this to a line is crossed by it.
const CLEAR: f64 = 11.0;
const DIRECTIONS: u32 = 24;

/// The lines of a drawing, and the letters put beside them so far.
pub(super) struct Labels {
    lines: Vec<[DVec2; 2]>,
    letters: Vec<DVec2>,
}

impl Labels {
    pub(super) fn new(lines: impl IntoIterator<Item = [DVec2; 2]>) -> Self {
        Self { lines: lines.into_iter().collect(), letters: Vec::new() }
    }

    /// Keeps letters off a line from point to point.
    pub(super) fn avoid(&mut self, line: &[DVec2]) {
        self.lines.extend(line.windows(2).map(|ends| [ends[0], ends[1]]));
    }

    /// The middle of a letter for what ends at `tip`; `beyond` is where it would best be.
    pub(super) fn place(&mut self, tip: DVec2, beyond: DVec2) -> DVec2 {
        let ahead = beyond.normalize_or(DVec2::NEG_Y);
        let mut best = (f64::INFINITY, tip);
        for distance in [16.0, 24.0, 34.0] {
            for turn in 0..DIRECTIONS {
                let (sin, cos) = wide::sin_cos(TAU * f64::from(turn) / f64::from(DIRECTIONS));
                let at = tip + distance * ahead.rotate(DVec2::new(cos, sin));
                let cost = self.crowding(at) + 0.3 * distance + 4.0 * (1.0 - cos);
                if cost < best.0 {
                    best = (cost, at);
                }
            }
        }
        self.letters.push(best.1);
        best.1
    }

    /// How much is in a letter's way.
    fn crowding(&self, at: DVec2) -> f64 {
        let letters = self.letters.iter().map(|letter| (APART - letter.distance(at)).max(0.0));
        let lines = self.lines.iter().map(|&line| (CLEAR - distance(line, at)).max(0.0));
        10.0 * letters.sum::<f64>() + 4.0 * lines.sum::<f64>()
    }
}

/// From a point to a stretch of line.
fn distance([from, to]: [DVec2; 2], at: DVec2) -> f64 {
    let along = to - from;
    let share = (at - from).dot(along) / along.length_squared().max(1e-12);
    at.distance(from + share.clamp(0.0, 1.0) * along)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_letter_alone_stands_ahead_of_its_arrow() {
        let mut labels = Labels::new([[DVec2::ZERO, DVec2::new(0.0, -100.0)]]);
        let at = labels.place(DVec2::new(0.0, -100.0), DVec2::NEG_Y);
        assert!(at.distance(DVec2::new(0.0, -116.0)) < 1e-9);
    }

    #[test]
    fn letters_of_arrows_that_nearly_meet_do_not_touch_and_no_line_crosses_them() {
        let tips = [DVec2::new(0.0, -100.0), DVec2::new(2.0, -90.0), DVec2::new(-3.0, -98.0)];
        let lines = tips.map(|tip| [DVec2::ZERO, tip]);
        let mut labels = Labels::new(lines);
        let at = tips.map(|tip| labels.place(tip, tip));
        for (i, a) in at.iter().enumerate() {
            assert!(at[..i].iter().all(|b| a.distance(*b) >= APART - 1e-9), "{at:?}");
            assert!(lines.iter().all(|line| distance(*line, *a) >= CLEAR - 1e-9), "{at:?}");
        }
    }
}
