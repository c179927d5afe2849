//! Round numbers, and how they are written.

/// The digit to the left of the exponent's number, above the line.
const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];

/// About how many letters a power of ten takes behind a number.
const POWER: usize = 5;

/// A round number: 1, 2 or 5 times a power of ten.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Round {
    digit: u32,
    exponent: i32,
}

impl Round {
    /// The largest that is no more than `most`, a finite number above 0; `None`: there is none.
    pub(super) fn below(most: f64) -> Option<Self> {
        if !(most.is_finite() && most > 0.0) {
            return None;
        }
        let exponent = libm::floor(libm::log10(most)) as i32;
        // The logarithm is rounded: a step up may still fit, and one down may be needed.
        let rounds = (exponent - 1..=exponent + 1).rev();
        rounds
            .flat_map(|exponent| [5, 2, 1].map(|digit| Self { digit, exponent }))
            .find(|round| round.value() <= most)
    }

    /// It as a number: the nearest there is.
    pub(super) fn value(self) -> f64 {
        format!("{}e{}", self.digit, self.exponent).parse().unwrap_or(f64::NAN)
    }

    /// So many times it: the nearest number there is.
    pub(super) fn times(self, count: i64) -> f64 {
        format!("{}e{}", count * i64::from(self.digit), self.exponent).parse().unwrap_or(f64::NAN)
    }

    /// Its multiples from `first` times it to `last` times, fewer than 10¹² times, and how they are written: all of
    /// them plainly or all with the same power of ten, whichever is shorter.
    pub(super) fn multiples(self, first: i64, last: i64) -> Vec<(f64, String)> {
        let most = first.unsigned_abs().max(last.unsigned_abs()) * u64::from(self.digit);
        let behind = most.checked_ilog10().unwrap_or(0);
        let power = self.exponent + behind as i32;
        let decimals = self.decimals();
        let is_shorter = behind as usize + POWER < power.max(0) as usize + decimals;
        let scaled = Self { exponent: -(behind as i32), ..self };
        let written = |count| match count {
            0 if is_shorter => "0".to_owned(),
            _ if is_shorter => {
                let behind = behind as usize;
                of_power(&format!("{:.behind$}", scaled.times(count)), power).replace('-', "−")
            }
            _ => format!("{:.decimals$}", self.times(count)).replace('-', "−"),
        };
        (first..=last).map(|count| (self.times(count), written(count))).collect()
    }

    /// Digits behind the point of its multiples.
    pub(super) fn decimals(self) -> usize {
        usize::try_from(-self.exponent).unwrap_or(0)
    }
}

/// A number in as few digits as it has, with at most so many behind the point; very large and very small
/// ones as a power of ten.
pub(super) fn number(value: f64, decimals: usize) -> String {
    let size = value.abs();
    let plain = if size != 0.0 && !(1e-4..1e6).contains(&size) {
        let text = format!("{value:.5e}");
        let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        let digits = digits.trim_end_matches('0').trim_end_matches('.');
        of_power(digits, exponent.parse().unwrap_or(0))
    } else {
        format!("{value:.decimals$}")
    };
    plain.replace('-', "−")
}

/// So many times a power of ten.
fn of_power(digits: &str, exponent: i32) -> String {
    let raised = exponent.to_string();
    let raised = raised.chars().map(|digit| match digit.to_digit(10) {
        Some(digit) => RAISED[digit as usize],
        None => '⁻',
    });
    let power: String = "10".chars().chain(raised).collect();
    match digits {
        "1" => power,
        "-1" => format!("-{power}"),
        digits => format!("{digits} · {power}"),
    }
}

#[cfg(test)]
mod tests {
    use super::super::text::Font;
    use super::*;

    #[test]
    fn round_numbers_are_the_largest_that_fit() {
        let below = |most| Round::below(most).map(Round::value);
        let found = [0.99, 1.0, 1.99, 2.5, 7.0, 10.0, 49.9, 1e300, 3e-7].map(below);
        let wanted = [0.5, 1.0, 1.0, 2.0, 5.0, 10.0, 20.0, 1e300, 2e-7];
        assert_eq!(found, wanted.map(Some));
        assert_eq!([0.0, -1.0, f64::NAN, f64::INFINITY].map(below), [None; 4]);
    }

    #[test]
    fn all_that_numbers_are_written_with_is_drawn() {
        let font = Font::new();
        let powers =
            (-300..=300).map(|power| number(-1.234_567_89 * libm::exp10(f64::from(power)), 9));
        for letter in powers.flat_map(|written| written.chars().collect::<Vec<_>>()) {
            let words = font.words(&letter.to_string(), 100.0);
            assert!(words.width > 0.0, "{letter}");
            assert!(letter == ' ' || !words.path.0.is_empty(), "{letter}");
        }
        // A minus is as wide as a plus, and as high above the line.
        let [minus, plus] = ["−", "+"].map(|sign| {
            let words = font.words(sign, 1000.0);
            let heights = words.path.points().map(|point| point.y);
            let [low, high] =
                heights.fold([f64::MAX, f64::MIN], |[low, high], y| [low.min(y), high.max(y)]);
            [words.width, 0.5 * (low + high)]
        });
        let apart = [0, 1].map(|i| (minus[i] - plus[i]).abs());
        assert!(apart[0] == 0.0 && apart[1] < 1.0, "{minus:?} {plus:?}");
    }

    #[test]
    fn numbers_are_written_as_people_write_them() {
        let written = [number(0.0, 1), number(-2.5, 1), number(1500.0, 0), number(0.1 + 0.2, 1)];
        assert_eq!(written, ["0.0", "−2.5", "1500", "0.3"]);
        assert_eq!([number(2e-7, 7), number(1e9, 0)], ["2 · 10⁻⁷", "10⁹"]);
    }
}
