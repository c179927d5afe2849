//! Decimal numbers to the nearest float, fast.
//!
//! Digits are taken eight at a time, of short numbers without a loop. Up to 19 of them fit a `u64`
//! exactly, and where both that
//! integer and the power of ten are exact in f64, one multiplication or division rounds once
//! and rightly (Clinger 1990). An f32 is right whenever the f64 is not within a few units of the
//! middle between two f32s. All else, about one number in a million of ordinary files, goes to
//! the standard library.

use std::fmt;

const POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
    1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
];

const INTEGER_POWERS: [u64; 9] =
    [1, 10, 100, 1000, 10_000, 100_000, 1_000_000, 10_000_000, 100_000_000];

/// Eight times the digit 0.
const ZEROS: u64 = 0x3030_3030_3030_3030;

/// The digits of a decimal number, not yet rounded to a float.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Decimal<'a> {
    /// The number as written.
    token: &'a [u8],
    /// All digits as one integer, if there are at most 19.
    mantissa: u64,
    /// The power of ten that the integer is multiplied by.
    exponent: i32,
    negative: bool,
    /// Whether the integer above is exact.
    exact: bool,
}

/// Why a token is no number that can be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum BadNumber {
    /// It is not a decimal number at all.
    Malformed,
    /// It says NaN.
    NotANumber,
    /// It says infinity, or is larger than any float.
    Infinite,
}

impl fmt::Display for BadNumber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Malformed => "is not a number",
            Self::NotANumber => "is not a number that can be drawn",
            Self::Infinite => "is infinite or too large",
        })
    }
}

impl<'a> Decimal<'a> {
    /// The number at the beginning of `text`, up to the first byte that cannot belong to it;
    /// what follows is the caller's to judge. `None` if no digit stands there.
    // In registers: through memory, a number takes twice as long.
    #[inline(always)]
    pub(crate) fn scan(text: &'a [u8]) -> Option<Self> {
        let sign = *text.first()?;
        let mut at = usize::from(sign == b'-' || sign == b'+');
        let (mantissa, mut exponent, exact);
        if let Some(short) = Short::scan(text, at) {
            (mantissa, exponent, exact, at) = (short.mantissa, short.exponent, true, short.end);
        } else {
            (mantissa, exponent, exact, at) = long(text, at)?;
        }
        if let Some(b'e' | b'E') = text.get(at) {
            let (power, end) = take_exponent(text, at + 1)?;
            exponent = exponent.saturating_add(power);
            at = end;
        }
        Some(Self { token: &text[..at], mantissa, exponent, negative: sign == b'-', exact })
    }

    /// How many bytes the number takes.
    #[inline]
    pub(crate) fn len(&self) -> usize {
        self.token.len()
    }

    /// The nearest f64, ties to even; infinite if it is too large.
    #[inline]
    pub(crate) fn to_f64(self) -> f64 {
        if self.exact && self.mantissa <= 1 << 53 && self.exponent.unsigned_abs() <= 22 {
            self.scaled()
        } else {
            self.parse()
        }
    }

    /// The nearest f32, ties to even; infinite if it is too large.
    #[inline]
    pub(crate) fn to_f32(self) -> f32 {
        if self.exact && self.exponent.unsigned_abs() <= 22 {
            // Two roundings at most: within two units of the last place of an f64.
            let value = self.scaled();
            let beyond_f32 = (value.to_bits() & 0x1fff_ffff) as i32 - 0x1000_0000;
            let normal = value.abs() >= f64::from(f32::MIN_POSITIVE) && value.abs() < 1e38;
            if (normal && beyond_f32.abs() > 4) || self.mantissa == 0 {
                return value as f32;
            }
        }
        self.parse()
    }

    /// The integer that was written; `None` if it is none, or beyond ±(2⁵³).
    #[inline]
    pub(crate) fn to_integer(self) -> Option<i64> {
        let value = match self.exponent {
            0 if self.exact && self.mantissa <= 1 << 53 => {
                let magnitude = self.mantissa as i64;
                return Some(if self.negative { -magnitude } else { magnitude });
            }
            _ => self.to_f64(),
        };
        (value.trunc() == value && value.abs() <= (1_u64 << 53) as f64).then_some(value as i64)
    }

    #[inline]
    fn scaled(self) -> f64 {
        let power = POWERS[self.exponent.unsigned_abs() as usize];
        let mantissa = self.mantissa as f64;
        let value = if self.exponent < 0 { mantissa / power } else { mantissa * power };
        // Signs are often mixed: a branch would be taken wrongly half the time.
        f64::from_bits(value.to_bits() | u64::from(self.negative) << 63)
    }

    #[cold]
    fn parse<T: std::str::FromStr + Default>(self) -> T {
        // `scan` took only what this grammar knows too.
        str::from_utf8(self.token).ok().and_then(|text| text.parse().ok()).unwrap_or_default()
    }
}

/// The digits of a number with up to seven on either side of the point, behind which the text goes on: most
/// are so, and need no loop.
struct Short {
    mantissa: u64,
    exponent: i32,
    /// Where its digits end.
    end: usize,
}

impl Short {
    /// The number from `at` on, if it is one, without its exponent.
    #[inline(always)]
    fn scan(text: &[u8], at: usize) -> Option<Self> {
        let bytes = text.get(at..)?.first_chunk::<16>()?;
        let (integer, whole) = few_digits(bytes, 0)?;
        if bytes[whole] != b'.' {
            let end = at + whole;
            return (whole > 0).then_some(Self { mantissa: integer, exponent: 0, end });
        }
        let (fraction, count) = few_digits(bytes, whole + 1)?;
        let mantissa = integer * INTEGER_POWERS[count] + fraction;
        let end = at + whole + 1 + count;
        (whole + count > 0).then_some(Self { mantissa, exponent: -(count as i32), end })
    }
}

/// The digits from `at` on, as a number, and how many they are; `None` if they are eight or more.
#[inline(always)]
fn few_digits(bytes: &[u8; 16], at: usize) -> Option<(u64, usize)> {
    let eight = u64::from_le_bytes(*bytes.get(at..)?.first_chunk::<8>()?) ^ ZEROS;
    let others = no_digits(eight);
    let count = others.trailing_zeros() / 8;
    // In two steps, since there may be none.
    let digits = || eight_digits(eight << (56 - 8 * count) << 8);
    (others != 0).then(|| (digits(), count as usize))
}

/// The digits of any number from `at` on as one integer, the power of ten that it is multiplied by, whether
/// that is all of it, and where it ends; `None` without digits.
#[inline(never)]
fn long(text: &[u8], at: usize) -> Option<(u64, i32, bool, usize)> {
    let (mut mantissa, mut digits) = (0, 0);
    let mut at = take_digits(text, at, &mut mantissa, &mut digits);
    let mut exponent = 0;
    if text.get(at) == Some(&b'.') {
        let whole = digits;
        at = take_digits(text, at + 1, &mut mantissa, &mut digits);
        exponent = -((digits - whole) as i32);
    }
    (digits > 0).then_some((mantissa, exponent, digits <= 19, at))
}

/// What is wrong with a token that `scan` does not take as a whole.
pub(crate) fn blame(token: &[u8]) -> BadNumber {
    let bare = token.trim_ascii_start();
    let bare = bare.strip_prefix(b"-").or(bare.strip_prefix(b"+")).unwrap_or(bare);
    let says =
        |word: &[u8]| bare.len() >= word.len() && bare[..word.len()].eq_ignore_ascii_case(word);
    // Microsoft's runtime writes 1.#QNAN, -1.#IND and 1.#INF.
    if says(b"nan") || says(b"1.#qnan") || says(b"1.#snan") || says(b"1.#ind") {
        BadNumber::NotANumber
    } else if says(b"inf") || says(b"1.#inf") {
        BadNumber::Infinite
    } else {
        BadNumber::Malformed
    }
}

/// Appends the digits from `at` on to `mantissa` (which overflows unheeded beyond 19 digits) and
/// counts them; where they end.
#[inline]
pub(crate) fn take_digits(
    text: &[u8],
    mut at: usize,
    mantissa: &mut u64,
    digits: &mut usize,
) -> usize {
    loop {
        let eight = match text.get(at..).and_then(|rest| rest.first_chunk::<8>()) {
            Some(eight) => u64::from_le_bytes(*eight),
            None => last_bytes(text, at),
        } ^ ZEROS;
        let others = no_digits(eight);
        let count = (others.trailing_zeros() / 8) as usize;
        if count == 0 {
            return at;
        }
        // The first digit is in the lowest byte: shifted up, zeros lead.
        let value = eight_digits(eight << (64 - 8 * count));
        *mantissa = mantissa.wrapping_mul(INTEGER_POWERS[count]).wrapping_add(value);
        *digits += count;
        at += count;
        if count < 8 {
            return at;
        }
    }
}

/// The high bit of the first byte whose value is none of a digit, and of some of those behind it.
#[inline(always)]
fn no_digits(eight: u64) -> u64 {
    // Carries reach later bytes only.
    (eight.wrapping_add(0x7676_7676_7676_7676) | eight) & 0x8080_8080_8080_8080
}

/// Eight digits, each a byte of value 0–9, the first in the lowest: neighbours are joined to
/// pairs, pairs to fours, fours to the whole.
#[inline(always)]
fn eight_digits(digits: u64) -> u64 {
    let pairs = (digits * 10 + (digits >> 8)) & 0x00ff_00ff_00ff_00ff;
    let fours = (pairs * 100 + (pairs >> 16)) & 0x0000_ffff_0000_ffff;
    (fours * 10_000 + (fours >> 32)) & 0xffff_ffff
}

#[cold]
fn last_bytes(text: &[u8], at: usize) -> u64 {
    let rest = text.get(at..).unwrap_or_default();
    let mut eight = [0; 8];
    eight[..rest.len()].copy_from_slice(rest);
    u64::from_le_bytes(eight)
}

/// The exponent after an `e`, and where it ends; `None` without digits.
fn take_exponent(text: &[u8], at: usize) -> Option<(i32, usize)> {
    let sign = text.get(at).copied();
    let start = at + usize::from(matches!(sign, Some(b'-' | b'+')));
    let mut end = start;
    let mut power = 0_i32;
    while let Some(digit) = text.get(end).filter(|b| b.is_ascii_digit()) {
        power = power.saturating_mul(10).saturating_add(i32::from(digit - b'0'));
        end += 1;
    }
    (end > start).then_some((if sign == Some(b'-') { -power } else { power }, end))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn both(text: &str) -> (f64, f32) {
        let decimal = Decimal::scan(text.as_bytes()).unwrap();
        assert_eq!(decimal.len(), text.len(), "{text}");
        let (double, single) = (decimal.to_f64(), decimal.to_f32());
        for behind in [
            " 1.25 nor a word",
            "\n0123456789.0123",
            "\u{fe}\u{ff}\u{fe}\u{ff}\u{fe}\u{ff}\u{fe}\u{ff}",
        ] {
            let more = [text, behind].concat();
            let decimal = Decimal::scan(more.as_bytes()).unwrap();
            assert_eq!(decimal.len(), text.len(), "{more}");
            assert_eq!(decimal.to_f64().to_bits(), double.to_bits(), "{more}");
            assert_eq!(decimal.to_f32().to_bits(), single.to_bits(), "{more}");
        }
        (double, single)
    }

    fn agrees(text: &str) {
        let (double, single) = both(text);
        assert_eq!(double.to_bits(), text.parse::<f64>().unwrap().to_bits(), "{text}");
        assert_eq!(single.to_bits(), text.parse::<f32>().unwrap().to_bits(), "{text}");
    }

    #[test]
    fn every_way_to_write_a_number_is_read_as_the_standard_library_reads_it() {
        for text in [
            "0",
            "-0",
            "+0",
            "1",
            "-1",
            "+1",
            ".5",
            "-.5",
            "5.",
            "1e5",
            "1e+05",
            "1E-05",
            "1.e3",
            "0.1",
            "123456789",
            "0.123456789012345678901234567890",
            "9007199254740993",
            "16777217",
            "16777219",
            "1e-45",
            "1e-46",
            "1e38",
            "3.4028235e38",
            "3.4028236e38",
            "4e38",
            "1e308",
            "1e309",
            "1e-400",
            "1e999999999999",
            "0e999999999999",
            "00000000000000000000000000000001",
            "340282356779733661637539395458142568447.9",
            "1.00000005960464477539062500000001",
            "8.589973e9",
            "1.17549435e-38",
        ] {
            agrees(text);
        }
    }

    #[test]
    fn what_is_no_number_is_told_from_what_is_none_to_draw() {
        for text in ["", "-", ".", "e5", "x", "/", "1e", "1e+"] {
            assert!(Decimal::scan(text.as_bytes()).is_none(), "{text}");
            let more = [text, " 1.25 nor a word"].concat();
            assert!(Decimal::scan(more.as_bytes()).is_none(), "{more}");
        }
        assert_eq!(Decimal::scan(b"1.5x").unwrap().len(), 3);
        assert_eq!(blame(b"-NaN"), BadNumber::NotANumber);
        assert_eq!(blame(b"-1.#IND00"), BadNumber::NotANumber);
        assert_eq!(blame(b"+Infinity"), BadNumber::Infinite);
        assert_eq!(blame(b"one"), BadNumber::Malformed);
    }

    #[test]
    fn integers_may_be_written_with_a_point_or_an_exponent_but_not_with_a_fraction() {
        let integer = |text: &str| Decimal::scan(text.as_bytes()).unwrap().to_integer();
        assert_eq!(integer("-7"), Some(-7));
        assert_eq!(integer("3.0"), Some(3));
        assert_eq!(integer("2e3"), Some(2000));
        assert_eq!(integer("2.5"), None);
        assert_eq!(integer("99999999999999999999"), None);
    }

    proptest! {
        #[test]
        fn floats_written_shortest_come_back(bits in any::<u32>(), wide in any::<u64>()) {
            for text in [f32::from_bits(bits).to_string(), f64::from_bits(wide).to_string()] {
                if text.ends_with(|c: char| c.is_ascii_digit()) {
                    agrees(&text);
                }
            }
            let text = format!("{:e}", f32::from_bits(bits));
            if text.ends_with(|c: char| c.is_ascii_digit()) {
                agrees(&text);
            }
        }

        #[test]
        fn any_digits_round_rightly(text in "[-+]?[0-9]{1,20}(\\.[0-9]{0,20})?(e[-+]?[0-9]{1,2})?") {
            agrees(&text);
        }
    }
}
