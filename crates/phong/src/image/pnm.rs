//! Portable pixmaps and graymaps (PPM, PGM): a text header, then levels as bytes or as text. Read only.

use super::picture::{Picture, Plane, ReadError, Transfer, count, within};

/// Reads `P2`, `P3`, `P5` and `P6`. Levels are taken to be on the sRGB curve, as everybody writes them.
pub(super) fn read(bytes: &[u8], max_bytes: u64) -> Result<Picture, ReadError> {
    let broken = |what: String| ReadError::Broken(format!("PPM: {what}"));
    let (channels, as_text) = match bytes.get(1) {
        Some(b'2') => (1, true),
        Some(b'3') => (3, true),
        Some(b'5') => (1, false),
        _ => (3, false),
    };
    let mut words = Words { rest: &bytes[2..] };
    let mut number = |what: &str, most: u32| {
        let value = words.number().filter(|n| (1..=most).contains(n));
        value.ok_or_else(|| broken(format!("{what} must be a whole number from 1 to {most}")))
    };
    let (width, height) = (number("the width", u32::MAX)?, number("the height", u32::MAX)?);
    let most = number("the largest level", 65535)?;
    let values = count(width, height, channels)?;
    // The levels as floats, together and plane by plane.
    within([width, height], 8 * channels, max_bytes)?;
    let scale = |level: u32| (level.min(most) as f32) / most as f32;
    let levels: Vec<f32> = if as_text {
        // A level takes two bytes at least, its digit and what parts it from the next.
        if (words.rest.len() as u64).div_ceil(2) < values {
            return Err(broken(format!("fewer than {values} levels")));
        }
        let told = std::iter::from_fn(|| words.number());
        told.take(values as usize).map(scale).collect()
    } else {
        // One character of white space ends the header, and levels may begin with any byte.
        let data = words.rest.get(1..).unwrap_or_default();
        let level = |bytes: &[u8]| bytes.iter().fold(0, |sum, byte| sum << 8 | u32::from(*byte));
        let each = if most > 255 { 2 } else { 1 };
        data.chunks_exact(each).take(values as usize).map(|bytes| scale(level(bytes))).collect()
    };
    if (levels.len() as u64) < values {
        return Err(broken(format!("{} levels, not {values}", levels.len())));
    }
    let names: &[&str] = if channels == 1 { &["Y"] } else { &["R", "G", "B"] };
    let plane = |(c, name): (usize, &&str)| Plane {
        name: (*name).to_owned(),
        values: levels.iter().skip(c).step_by(names.len()).copied().collect(),
    };
    Ok(Picture {
        size: [width, height],
        planes: names.iter().enumerate().map(plane).collect(),
        transfer: Transfer::Srgb,
        levels: Some(most as u16),
        lossy: None,
    })
}

/// Numbers as text, with comments from `#` to the end of a line between them.
struct Words<'a> {
    rest: &'a [u8],
}

impl Words<'_> {
    /// The next number; `None` where there is none. What follows it is left.
    fn number(&mut self) -> Option<u32> {
        loop {
            match self.rest {
                [b'#', ..] => {
                    let end = self.rest.iter().position(|b| matches!(b, b'\n' | b'\r'));
                    self.rest = &self.rest[end.unwrap_or(self.rest.len())..];
                }
                [first, ..] if first.is_ascii_whitespace() => self.rest = &self.rest[1..],
                _ => break,
            }
        }
        let end = self.rest.iter().position(|b| !b.is_ascii_digit()).unwrap_or(self.rest.len());
        let (digits, rest) = self.rest.split_at(end);
        self.rest = rest;
        std::str::from_utf8(digits).ok()?.parse().ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_text_and_two_byte_levels_are_read_alike() {
        let files: [&[u8]; 3] = [
            b"P6\n# drawn by hand\n2 1\n255\n\xff\x00\x33\x00\xff\x00",
            b"P3 2 1 255 255 0 51\n0 # a comment\n255 0\n",
            b"P6 2 1 65535 \xff\xff\x00\x00\x33\x33\x00\x00\xff\xff\x00\x00",
        ];
        for file in files {
            let picture = read(file, u64::MAX).unwrap();
            assert_eq!((picture.size, picture.transfer), ([2, 1], Transfer::Srgb));
            assert_eq!(picture.plane("R"), Some(&[1.0, 0.0][..]));
            assert_eq!(picture.plane("G"), Some(&[0.0, 1.0][..]));
            assert_eq!(picture.plane("B"), Some(&[0.2, 0.0][..]));
        }
        assert_eq!(read(b"P5 1 1 100\n\x32", u64::MAX).unwrap().plane("Y"), Some(&[0.5][..]));
    }

    #[test]
    fn what_is_broken_is_said() {
        let said = |file: &[u8]| read(file, u64::MAX).unwrap_err().to_string();
        assert_eq!(said(b"P6 2 1 255 \xff"), "PPM: 1 levels, not 6");
        assert_eq!(said(b"P3 2 1 255 1 2 3"), "PPM: fewer than 6 levels");
        assert_eq!(said(b"P6 x"), "PPM: the width must be a whole number from 1 to 4294967295");
        assert_eq!(
            said(b"P6 2 1 70000 "),
            "PPM: the largest level must be a whole number from 1 to 65535"
        );
        let small = read(b"P6 2 1 255 abcdef", 47);
        assert!(matches!(small, Err(ReadError::Memory { needed: 48, .. })), "{small:?}");
        assert!(matches!(
            read(b"P6 4000000000 4000000000 255 ", u64::MAX),
            Err(ReadError::TooLarge { .. })
        ));
    }
}
