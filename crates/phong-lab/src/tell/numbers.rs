//! Numbers as an explanation writes them: all their digits, in columns.

use std::fmt::{self, Display, Formatter};

use glam::DVec3;
use phong::math::Dir3;
use phong_scene::Rgb;

/// A number with all its digits, in powers of ten where they would begin with many zeros.
pub(super) struct Digits(pub(super) f32);

impl Display for Digits {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let v = self.0;
        if v == 0.0 || (1e-4..1e9).contains(&v.abs()) {
            write!(f, "{v}")
        } else {
            write!(f, "{v:e}")
        }
    }
}

/// A colour with all its digits.
pub(super) struct Color(pub(super) Rgb);

impl Display for Color {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let [r, g, b] = self.0.to_array();
        write!(f, "({}, {}, {})", Digits(r), Digits(g), Digits(b))
    }
}

/// A direction with all its digits.
pub(super) struct Direction(pub(super) Dir3);

impl Display for Direction {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.0.to_array();
        write!(f, "({}, {}, {})", Digits(x), Digits(y), Digits(z))
    }
}

/// A point in the world; f32s, moved in f64 only where the scene was far from the origin.
pub(super) struct Position(pub(super) DVec3);

impl Display for Position {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let number = |v: f64| {
            if f64::from(v as f32) == v { (v as f32).to_string() } else { v.to_string() }
        };
        let DVec3 { x, y, z } = self.0;
        write!(f, "({}, {}, {})", number(x), number(y), number(z))
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
        let written = [0.1, 1e-5, 0.0, 1e9, -0.000_25].map(|v| Digits(v).to_string());
        assert_eq!(written, ["0.1", "1e-5", "0", "1e9", "-0.00025"]);
    }
}
