//! The pixels of a page, packed: their numbers to four digits, each kind of number in a row of its own.
//!
//! Neighbouring pixels are told by the same words with other numbers. So the words are written once
//! (a pixel's JSON with 0 for every number), and of the numbers each one's change of change from
//! pixel to pixel: over a smooth surface nearly all of these are 0, which deflate makes nothing of.

use std::collections::BTreeMap;
use std::io::Write as _;

use flate2::Compression;
use flate2::write::ZlibEncoder;
use serde_json::{Value, json};

use crate::markup::base64;

/// Significant digits of the largest number of its kind within a run of pixels.
const DIGITS: i32 = 4;

/// Rows of pixels, packed together: text in base 64 of deflated JSON, `{"w": words, "r": rows}`. A
/// row is a list of runs, `[which words, [exponent, first, second, …], …]`, a list for each number.
pub(super) fn pack(rows: Vec<Vec<Value>>) -> String {
    let mut words = Words::default();
    let rows: Vec<Value> = rows.into_iter().map(|row| words.row(row)).collect();
    let Words { all, .. } = words;
    deflated(&json!({ "w": all, "r": rows }).to_string())
}

/// The words of pixels so far.
#[derive(Default)]
struct Words {
    all: Vec<Value>,
    numbers: BTreeMap<String, usize>,
}

impl Words {
    fn row(&mut self, pixels: Vec<Value>) -> Value {
        let mut runs: Vec<(usize, Vec<Vec<Number>>)> = Vec::new();
        for mut pixel in pixels {
            let mut numbers = Vec::new();
            take(&mut pixel, &mut numbers);
            let words = self.number(pixel);
            match runs.last_mut() {
                Some((last, all)) if *last == words => all.push(numbers),
                _ => runs.push((words, vec![numbers])),
            }
        }
        runs.iter().map(|(words, pixels)| run(*words, pixels)).collect()
    }

    /// The number of these words.
    fn number(&mut self, words: Value) -> usize {
        let next = self.all.len();
        let number = *self.numbers.entry(words.to_string()).or_insert(next);
        if number == next {
            self.all.push(words);
        }
        number
    }
}

/// A number of a pixel; whole ones keep all their digits.
#[derive(Clone, Copy)]
struct Number {
    value: f64,
    whole: bool,
}

/// Takes the numbers out of a pixel, in the order they are written, and leaves 0 for each.
fn take(value: &mut Value, numbers: &mut Vec<Number>) {
    match value {
        Value::Number(number) => {
            let whole = !number.is_f64();
            numbers.push(Number { value: number.as_f64().unwrap_or(0.0), whole });
            *value = json!(0);
        }
        Value::Array(items) => items.iter_mut().for_each(|item| take(item, numbers)),
        Value::Object(entries) => entries.values_mut().for_each(|item| take(item, numbers)),
        Value::Null | Value::Bool(_) | Value::String(_) => {}
    }
}

/// Pixels of the same words: a list for each of their numbers.
fn run(words: usize, pixels: &[Vec<Number>]) -> Value {
    let mut out = vec![json!(words)];
    let count = pixels.first().map_or(0, Vec::len);
    out.extend((0..count).map(|i| {
        let numbers: Vec<Number> = pixels.iter().map(|pixel| pixel[i]).collect();
        json!(changes(&numbers))
    }));
    // Words without numbers do not say how many pixels there are.
    if count == 0 {
        out.push(json!(pixels.len()));
    }
    Value::Array(out)
}

/// The power of ten that the numbers are whole multiples of, then the first one, and from then on
/// how much more each differs from the one before than that one did.
fn changes(numbers: &[Number]) -> Vec<i64> {
    let most = numbers.iter().map(|n| n.value.abs()).fold(0.0, f64::max);
    let whole = numbers.iter().all(|n| n.whole);
    let exponent =
        if whole || most == 0.0 { 0 } else { libm::ceil(libm::log10(most)) as i32 - DIGITS };
    // The very decimal power: a product of rounded ones would be off.
    let unit: f64 = format!("1e{}", exponent.abs()).parse().unwrap_or(1.0);
    let steps = |n: &Number| {
        let scaled = if exponent < 0 { n.value * unit } else { n.value / unit };
        libm::round(scaled) as i64
    };
    let (mut last, mut change) = (0, 0);
    let mut out = vec![i64::from(exponent)];
    for (i, number) in numbers.iter().enumerate() {
        let now = steps(number);
        if i == 0 {
            out.push(now);
        } else {
            out.push(now - last - change);
            change = now - last;
        }
        last = now;
    }
    out
}

/// Text, deflated with zlib's frame, in base 64.
fn deflated(text: &str) -> String {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::best());
    // Writing to a Vec cannot fail.
    let bytes = encoder.write_all(text.as_bytes()).and_then(|()| encoder.finish());
    base64(&bytes.unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_that_change_evenly_become_noughts() {
        let numbers = [0.25, 0.5, 0.75, 1.0].map(|value| Number { value, whole: false });
        assert_eq!(changes(&numbers), [-4, 2500, 2500, 0, 0]);
        let numbers = [7.0, 7.0, 9.0].map(|value| Number { value, whole: true });
        assert_eq!(changes(&numbers), [0, 7, 0, 2]);
        assert_eq!(changes(&[Number { value: 0.0, whole: false }]), [0, 0]);
    }

    #[test]
    fn pixels_of_the_same_words_are_one_run() {
        let mut words = Words::default();
        let pixel = |n: f64| json!({ "a": n, "b": "x" });
        let row = words.row(vec![pixel(0.5), pixel(0.5), json!(null), pixel(2.5)]);
        assert_eq!(row, json!([[0, [-4, 5000, 0]], [1, 1], [0, [-3, 2500]]]));
        assert_eq!(words.all, [json!({ "a": 0, "b": "x" }), json!(null)]);
    }
}
