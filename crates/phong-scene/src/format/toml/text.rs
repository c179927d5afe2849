//! A text file with its lines, and places in it.

use std::io::ErrorKind;
use std::ops::Range;
use std::sync::Arc;

use crate::diagnostic::{Diagnostic, Place, Span};
use crate::limits::Limits;
use crate::source::{Source, trouble};

/// Longest excerpt of a line, in characters; longer lines are cut around the place.
const EXCERPT: usize = 160;

/// Least memory that a byte of text takes while it is parsed: of comments in long lines. Of spheres
/// it is 40, of nothing but faults 84, and whoever sets a limit keeps to that in other ways.
const BYTES_PER_BYTE: u64 = 3;

/// Most bytes of a scene's text, whatever the limits say: a million spheres. More belong into a
/// file of points, which is read in a fraction of the memory.
const MOST_BYTES: u64 = 80 << 20;

/// A range of bytes in one of the files read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Spot {
    /// Which file, in the order they were opened.
    pub(super) file: u32,
    /// First byte.
    pub(super) start: usize,
    /// One past the last byte.
    pub(super) end: usize,
}

impl Spot {
    /// This range of bytes of that file.
    pub(super) fn new(file: u32, range: Range<usize>) -> Self {
        Self { file, start: range.start, end: range.end }
    }
}

/// A text file, held as long as something may have to be said about it.
#[derive(Debug)]
#[expect(clippy::struct_field_names, reason = "its text is its text")]
pub(super) struct Text {
    /// The file as the user named it.
    pub(super) file: Arc<str>,
    /// Its text.
    pub(super) text: String,
    /// Where the includes stand that led to it, outermost first: sorts what is said.
    pub(super) at: Vec<usize>,
    /// The first byte of every line.
    lines: Vec<usize>,
}

impl Text {
    /// The text of a file that is included `at` these offsets.
    pub(super) fn new(file: Arc<str>, text: String, at: Vec<usize>) -> Self {
        let ends = text.bytes().enumerate().filter(|&(_, byte)| byte == b'\n');
        let lines = std::iter::once(0).chain(ends.map(|(i, _)| i + 1)).collect();
        Self { file, text, at, lines }
    }

    /// Line and column of a byte.
    pub(super) fn place(&self, offset: usize) -> Place {
        let (line, start) = self.line_of(offset);
        let column = self.text.get(start..offset).map_or(0, |before| before.chars().count());
        Place { file: Arc::clone(&self.file), line: line as u32 + 1, column: column as u32 + 1 }
    }

    /// The bytes from a place of this text to the end of its line, without a comment.
    pub(super) fn rest_of_line(&self, place: &Place) -> Range<usize> {
        let line = (place.line.max(1) as usize - 1).min(self.lines.len() - 1);
        let next = self.lines.get(line + 1).copied().unwrap_or(self.text.len());
        let whole = &self.text[self.lines[line]..next];
        let before = whole.char_indices().nth(place.column.max(1) as usize - 1);
        let from = before.map_or(whole.len(), |(i, _)| i);
        let rest = whole[from..].split('#').next().unwrap_or_default().trim_end();
        self.lines[line] + from..self.lines[line] + from + rest.len()
    }

    /// A range of bytes, with the line it begins on.
    pub(super) fn span(&self, range: Range<usize>) -> Span {
        let start = self.boundary(range.start);
        let (line, line_start) = self.line_of(start);
        let next = self.lines.get(line + 1).copied().unwrap_or(self.text.len());
        let whole = self.text[line_start..next].trim_end_matches(['\n', '\r']);
        // What lies beyond the line's end (a break, or the end of the file) is at its end.
        let from = (start - line_start).min(whole.len());
        let to = (self.boundary(range.end.max(start)) - line_start).min(whole.len()).max(from);
        let (cut, excerpt) = cut_around(whole, from);
        let end = (to - cut).min(excerpt.len());
        Span { place: self.place(start), excerpt: excerpt.to_owned(), range: from - cut..end }
    }

    /// The first byte of the line that holds `offset`, and the line's number from 0.
    fn line_of(&self, offset: usize) -> (usize, usize) {
        let line = self.lines.partition_point(|&start| start <= offset) - 1;
        (line, self.lines[line])
    }

    /// The last character boundary up to `offset`.
    fn boundary(&self, offset: usize) -> usize {
        let mut offset = offset.min(self.text.len());
        while !self.text.is_char_boundary(offset) {
            offset -= 1;
        }
        offset
    }
}

/// The part of `line` around byte `at`, and where it begins.
fn cut_around(line: &str, at: usize) -> (usize, &str) {
    if line.len() <= EXCERPT {
        return (0, line);
    }
    let before = line[..at].char_indices().rev().nth(EXCERPT / 2).map_or(0, |(i, _)| i);
    let rest = &line[before..];
    let end = rest.char_indices().nth(EXCERPT).map_or(rest.len(), |(i, _)| i);
    (before, &rest[..end])
}

/// Reads a file that is read by itself; else what is to be said.
pub(super) fn open(
    path: &str,
    source: &dyn Source,
    limits: &Limits,
) -> Result<Arc<Text>, Box<Diagnostic>> {
    let text = load(path, source, limits).map_err(|why| Box::new(unreadable(path, &why)))?;
    Ok(Arc::new(Text::new(path.into(), text, Vec::new())))
}

/// What is said of a file that cannot be read, for this reason.
pub(super) fn unreadable(path: &str, why: &str) -> Diagnostic {
    let place = Place { file: path.into(), ..Place::default() };
    Diagnostic::error(format!("cannot be read: {why}"), Span { place, ..Span::default() })
}

/// Reads a whole text file.
///
/// # Errors
/// What to say about it, without a place.
pub(super) fn load(path: &str, source: &dyn Source, limits: &Limits) -> Result<String, String> {
    let blob = source.open(path).map_err(|e| trouble(&e))?;
    let len = blob.len();
    let most = MOST_BYTES.min(limits.text_bytes);
    let needed = len.saturating_mul(BYTES_PER_BYTE);
    if len > most {
        return Err(format!("it has {len} bytes; scene text has at most {most}"));
    }
    let too_large = || {
        let allowed = limits.bytes;
        format!(
            "to read its {len} bytes takes {needed} of memory at least, over the limit of {allowed}"
        )
    };
    if needed > limits.bytes {
        return Err(too_large());
    }
    let bytes = blob.read_whole(most).map_err(|error| match error.kind() {
        ErrorKind::OutOfMemory => too_large(),
        _ => trouble(&error),
    })?;
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return Err("it is UTF-16; save it as UTF-8".to_owned());
    }
    String::from_utf8(bytes).map_err(|e| {
        let before = &e.as_bytes()[..e.utf8_error().valid_up_to()];
        let line = before.split(|&byte| byte == b'\n').count();
        format!("it is not UTF-8 text: a stray byte on line {line}")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(s: &str) -> Text {
        Text::new("a.toml".into(), s.to_owned(), Vec::new())
    }

    #[test]
    fn columns_count_characters() {
        let t = text("x = 'é'\ny = 'éé' # here");
        let at = t.text.find("# here").unwrap();
        assert_eq!((t.place(at).line, t.place(at).column), (2, 10));
    }

    #[test]
    fn a_span_shows_its_line_without_the_line_end() {
        let t = text("a = 1\r\nbad = 2\r\n");
        let span = t.span(7..10);
        assert_eq!((span.excerpt.as_str(), span.range), ("bad = 2", 0..3));
    }

    #[test]
    fn a_span_of_several_lines_ends_with_the_first() {
        let t = text("a = [1,\n2]\n");
        assert_eq!(t.span(4..10).range, 4..7);
    }

    #[test]
    fn the_end_of_the_file_is_a_place() {
        let t = text("a = [");
        let span = t.span(5..5);
        assert_eq!((span.place.line, span.place.column, span.range), (1, 6, 5..5));
        let t = text("");
        assert_eq!(t.span(0..0).place.line, 1);
        let t = text("a\n");
        assert_eq!((t.span(2..2).place.line, t.span(2..2).place.column), (2, 1));
    }

    #[test]
    fn a_very_long_line_is_cut_around_the_place() {
        let t = text(&format!("{}bad{}", "é".repeat(5000), "é".repeat(5000)));
        let span = t.span(10_000..10_003);
        assert_eq!(&span.excerpt[span.range.clone()], "bad");
        assert!(span.excerpt.chars().count() <= EXCERPT);
        assert_eq!(span.place.column, 5001);
    }

    #[test]
    fn a_span_that_splits_a_character_is_widened() {
        let t = text("é = 1");
        assert_eq!(t.span(1..2).range, 0..2);
    }
}
