//! How many lines a text has, and how many of them with anything on them.

/// How many line feeds there are.
pub(super) fn count_lines(text: &[u8]) -> u64 {
    // Sums of bytes that cannot overflow one: the compiler counts many at a time.
    let sum = |part: &[u8]| part.iter().map(|b| u8::from(*b == b'\n')).sum::<u8>();
    text.chunks(255).map(|part| u64::from(sum(part))).sum()
}

/// How many lines there are, and how many with anything on them, or anything but a comment.
pub(super) fn count_rows(text: &[u8], comments: bool) -> (u64, u64) {
    let lines = count_lines(text);
    if text.ends_with(b"\n") && count_begun(text, if comments { b'#' } else { b' ' }) == lines {
        return (lines, lines);
    }
    let (mut lines, mut rows) = (0, 0);
    let (mut something, mut comment) = (false, false);
    for &byte in text {
        if byte == b'\n' {
            lines += 1;
            rows += u64::from(something && !comment);
            (something, comment) = (false, false);
        } else if byte > b' ' {
            comment |= comments && byte == b'#' && !something;
            something = true;
        }
    }
    (lines, rows + u64::from(something && !comment))
}

/// How many lines begin with anything but a blank or this byte.
fn count_begun(text: &[u8], but: u8) -> u64 {
    let Some((first, behind)) = text.split_first() else { return 0 };
    let begins = |byte: u8| u8::from(byte > b' ' && byte != but);
    // As in `count_lines`.
    let pairs = text.chunks(255).zip(behind.chunks(255));
    let sum = |(before, part): (&[u8], &[u8])| {
        let pairs = before.iter().zip(part);
        u64::from(pairs.map(|(b, byte)| u8::from(*b == b'\n') & begins(*byte)).sum::<u8>())
    };
    u64::from(begins(*first)) + pairs.map(sum).sum::<u64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_counted_as_they_are_one_by_one() {
        let one_by_one = |text: &str, comments: bool| {
            let rows = text.lines().filter(|line| {
                let line = line.trim_matches(|c| c <= ' ');
                !(line.is_empty() || comments && line.starts_with('#'))
            });
            (text.matches('\n').count() as u64, rows.count() as u64)
        };
        let long = "1 2 3\n".repeat(200);
        let texts =
            ["", "\n", "a", "a\n", " a\nb \n", "#\n1\n", "1\n #\n", "1\n\n2\n", "1\n2", &long];
        for text in texts {
            for comments in [false, true] {
                let text = text.as_bytes();
                let expected = one_by_one(str::from_utf8(text).unwrap(), comments);
                assert_eq!(count_rows(text, comments), expected, "{text:?}");
            }
        }
        let mixed = [&long, "\n \n", &long, "# no\n", &long].concat();
        assert_eq!(count_rows(mixed.as_bytes(), true), one_by_one(&mixed, true));
    }
}
