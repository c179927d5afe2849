//! Numbers as an explanation writes them: all their digits or some, in columns.

use glam::DVec3;
use phong::math::Dir3;
use phong_scene::Rgb;

/// How numbers are written: with all their digits, or rounded to so many significant ones.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Numbers {
    /// Significant digits; `None`: all that an f32 has.
    pub(super) digits: Option<usize>,
}

impl Numbers {
    /// A number, in powers of ten where it would begin with many zeros.
    pub(super) fn one(self, v: f32) -> String {
        let v = self.rounded(f64::from(v)).map_or(v, |rounded| rounded as f32);
        if v == 0.0 || (1e-4..1e9).contains(&v.abs()) { v.to_string() } else { format!("{v:e}") }
    }

    pub(super) fn color(self, color: Rgb) -> String {
        self.triple(color.to_array())
    }

    pub(super) fn direction(self, dir: Dir3) -> String {
        self.triple(dir.to_array())
    }

    fn triple(self, triple: [f32; 3]) -> String {
        let [a, b, c] = triple.map(|v| self.one(v));
        format!("({a}, {b}, {c})")
    }

    /// A point in the world; f32s, moved in f64 only where the scene was far from the origin.
    pub(super) fn position(self, p: DVec3) -> String {
        let number = |v: f64| match self.rounded(v) {
            Some(rounded) => rounded.to_string(),
            None if f64::from(v as f32) == v => (v as f32).to_string(),
            None => v.to_string(),
        };
        let [x, y, z] = p.to_array().map(number);
        format!("({x}, {y}, {z})")
    }

    /// The nearest number of so many digits; `None`: all digits are wanted.
    fn rounded(self, v: f64) -> Option<f64> {
        let digits = self.digits?.max(1);
        format!("{v:.*e}", digits - 1).parse().ok()
    }
}

/// Triples under each other, their commas in line and room for a sign where one of them has one.
pub(super) fn columns(triples: &[String]) -> Vec<String> {
    let rows: Vec<Vec<&str>> = triples.iter().map(|t| t.split(", ").collect()).collect();
    let column = |i: usize| rows.iter().filter_map(move |row| row.get(i));
    let sign = |cell: &str| cell.trim_start_matches('(').starts_with('-');
    let signed: Vec<bool> = (0..3).map(|i| column(i).any(|cell| sign(cell))).collect();
    let dressed = |i: usize, cell: &str| {
        let space = if signed[i] && !sign(cell) { " " } else { "" };
        let comma = if i < 2 { ", " } else { "" };
        match cell.strip_prefix('(') {
            Some(number) => format!("({space}{number}{comma}"),
            None => format!("{space}{cell}{comma}"),
        }
    };
    let width = |i: usize| column(i).map(|cell| dressed(i, cell).len()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..3).map(width).collect();
    let line = |row: &Vec<&str>| {
        let cells = row.iter().zip(&widths).enumerate();
        let padded = cells.map(|(i, (cell, width))| format!("{:width$}", dressed(i, cell)));
        padded.collect::<Vec<String>>().concat()
    };
    rows.iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triples_stand_in_columns_with_room_for_signs() {
        let triples = ["(0.5, 1, -2)", "(-0.25, 12, 3)"].map(str::to_owned);
        assert_eq!(columns(&triples), ["( 0.5,  1,  -2)", "(-0.25, 12,  3)"]);
    }

    #[test]
    fn no_digit_of_a_number_is_lost_and_few_are_zeros() {
        let written = [0.1, 1e-5, 0.0, 1e9, -0.000_25].map(|v| Numbers::default().one(v));
        assert_eq!(written, ["0.1", "1e-5", "0", "1e9", "-0.00025"]);
    }

    #[test]
    fn numbers_are_rounded_to_significant_digits() {
        let three = Numbers { digits: Some(3) };
        let written = [0.123_456, 1.5e-9, 0.0, 98_765.0, -0.5].map(|v| three.one(v));
        assert_eq!(written, ["0.123", "1.5e-9", "0", "98800", "-0.5"]);
        assert_eq!(three.position(DVec3::new(1.234_5, -2.0, 1e-7)), "(1.23, -2, 0.0000001)");
    }
}
