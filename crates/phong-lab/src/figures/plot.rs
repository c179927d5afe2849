//! Axes, ticks and curves.

use super::drawing::Drawing;
use super::mark::{Anchor, Ink, Path, Point, Stroke, Text};
use super::{style, text};

/// A pair of axes on a drawing: the rectangle they span, and the numbers at its edges.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plot {
    /// Top left and bottom right, canvas units.
    pub(super) corners: [Point; 2],
    pub(super) x: [f64; 2],
    pub(super) y: [f64; 2],
}

impl Plot {
    /// Where the numbers `(x, y)` are drawn.
    pub(super) fn at(&self, x: f64, y: f64) -> Point {
        let share = |value: f64, [low, high]: [f64; 2]| (value - low) / (high - low);
        let [Point { x: left, y: top }, Point { x: right, y: bottom }] = self.corners;
        let (across, up) = (share(x, self.x), share(y, self.y));
        Point::new(left + across * (right - left), bottom - up * (bottom - top))
    }

    /// Grid, axes, and a number with its words at each tick.
    pub(super) fn axes(
        &self,
        drawing: &mut Drawing,
        x_ticks: &[(f64, String)],
        y_ticks: &[(f64, String)],
    ) {
        let [x_low, x_high] = self.x;
        let [y_low, y_high] = self.y;
        let grid = Stroke::new(style::GRID, style::THIN);
        for (x, words) in x_ticks {
            drawing.line(self.at(*x, y_low), self.at(*x, y_high), grid);
            let under = self.at(*x, y_low) + Point::new(0.0, 18.0);
            drawing.text(under, Anchor::Middle, style::TICK, style::MUTED, words);
        }
        for (y, words) in y_ticks {
            drawing.line(self.at(x_low, *y), self.at(x_high, *y), grid);
            let beside = self.at(x_low, *y) + Point::new(-8.0, 4.5);
            drawing.text(beside, Anchor::End, style::TICK, style::MUTED, words);
        }
        let corner = self.at(x_low, y_low);
        let axes = Path::polyline([self.at(x_low, y_high), corner, self.at(x_high, y_low)]);
        drawing.stroke(axes, Stroke::new(style::SURFACE, style::LINE));
    }

    /// The names of the axes: under the ticks, and beside them, upwards.
    pub(super) fn names(&self, drawing: &mut Drawing, x: &str, y: &str, room: f64) {
        let [top_left, bottom_right] = self.corners;
        let middle = 0.5 * (top_left + bottom_right);
        let under = Point::new(middle.x, bottom_right.y + 42.0);
        drawing.text(under, Anchor::Middle, style::NOTE, style::TEXT, x);
        drawing.put_text(Text {
            at: Point::new(top_left.x - room, middle.y),
            anchor: Anchor::Middle,
            size: style::NOTE,
            ink: style::TEXT,
            bold: false,
            upright: true,
            runs: text::runs(y),
        });
    }

    /// A curve through `f` at `steps + 1` evenly spaced places from `from` to `to`.
    pub(super) fn curve(
        &self,
        drawing: &mut Drawing,
        [from, to]: [f64; 2],
        steps: u32,
        f: impl Fn(f64) -> f64,
        stroke: Stroke,
    ) {
        let at = |i| from + (to - from) * f64::from(i) / f64::from(steps);
        let points = (0..=steps).map(|i| self.at(at(i), f(at(i))));
        drawing.stroke(Path::polyline(points), stroke);
    }

    /// A measured point.
    pub(super) fn dot(&self, drawing: &mut Drawing, x: f64, y: f64, ink: Ink) {
        drawing.circle(self.at(x, y), 3.2, Some(ink), None);
    }
}

/// Ticks whose words are the numbers themselves, and a unit.
pub(super) fn ticks(values: &[f64], unit: &str) -> Vec<(f64, String)> {
    values.iter().map(|&value| (value, format!("{}{unit}", signed(value)))).collect()
}

/// A number as people write it: a true minus sign, no trailing zeros.
pub(super) fn signed(value: f64) -> String {
    value.to_string().replace('-', "−")
}

/// A number rounded to `digits` decimals, with a true minus sign.
pub(super) fn fixed(value: f64, digits: usize) -> String {
    let words = format!("{value:.digits$}");
    let zero = words.trim_start_matches('-').chars().all(|c| matches!(c, '0' | '.'));
    if zero { words.trim_start_matches('-').to_owned() } else { words.replace('-', "−") }
}

/// A number to six significant digits, as people write it: markup.
pub(super) fn six(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    if !(1e-3..1e7).contains(&value.abs()) {
        let scientific = format!("{value:.2e}");
        let (digits, power) = scientific.split_once('e').unwrap_or((&scientific, "0"));
        return format!("{digits} × 10^{{{power}}}").replace('-', "−");
    }
    let whole = (value.abs() as u64).to_string().len() - 1;
    let words = fixed(value, 5_usize.saturating_sub(whole));
    if words.contains('.') {
        words.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        words
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plot_puts_the_corners_of_its_ranges_at_its_own() {
        let corners = [Point::new(100.0, 50.0), Point::new(300.0, 250.0)];
        let plot = Plot { corners, x: [-1.0, 1.0], y: [0.0, 2.0] };
        assert_eq!(plot.at(-1.0, 2.0), corners[0]);
        assert_eq!(plot.at(1.0, 0.0), corners[1]);
    }

    #[test]
    fn six_digits_are_enough_for_any_number() {
        let values = [0.0, 23.508_048_9, 0.5, -1.25, 18600.0, 1.192e-7];
        let words = ["0", "23.508", "0.5", "−1.25", "18600", "1.19 × 10^{−7}"];
        assert_eq!(values.map(six), words);
    }

    #[test]
    fn numbers_have_a_true_minus_sign_and_no_negative_zero() {
        assert_eq!(fixed(-0.001, 2), "0.00");
        assert_eq!(fixed(-1.5, 1), "−1.5");
        assert_eq!(signed(-90.0), "−90");
    }
}
