//! The first word and the counts.

use std::io;
use std::sync::Arc;

use crate::diagnostic::Span;
use crate::format::text::{Cursor, Decimal, Findings, Piece, blame, whole};
use crate::source::Blob;

/// Bytes that are looked through for the counts.
const LONGEST: usize = 1 << 20;

/// Bytes of the shortest line of a vertex, and of a face.
const LEAST: [u64; 2] = [6, 2];

/// What the rows are.
#[derive(Clone, Debug)]
pub(super) struct Header {
    pub(super) has: Has,
    pub(super) vertices: u64,
    pub(super) faces: u64,
    /// Where the rows begin, in bytes and as a line.
    pub(super) body: u64,
    pub(super) line: u64,
    /// The counts.
    span: Span,
}

/// What every vertex has besides its place.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Has {
    pub(super) uv: bool,
    pub(super) color: bool,
    pub(super) normal: bool,
}

/// What a first word says.
#[derive(Debug, PartialEq, Eq)]
enum First<'a> {
    /// Vertices that have these, and what stands behind without a blank, as some programs write it.
    Off(Has, &'a [u8]),
    /// Vertices of another dimension.
    Dimension,
    /// It is not of this format.
    Other,
}

impl<'a> First<'a> {
    fn of(word: &'a [u8]) -> Self {
        let Some(at) = word.windows(3).position(|part| part.eq_ignore_ascii_case(b"off")) else {
            return Self::Other;
        };
        let (mut prefix, rest) = (&word[..at], &word[at + 3..]);
        if !rest.iter().all(u8::is_ascii_digit) {
            return Self::Other;
        }
        let mut has = Has::default();
        let mut dimension = false;
        while let [letter, behind @ ..] = prefix {
            prefix = match (letter, behind) {
                (b'S', [b'T', behind @ ..]) => {
                    has.uv = true;
                    behind
                }
                (b'C', _) => {
                    has.color = true;
                    behind
                }
                (b'N', _) => {
                    has.normal = true;
                    behind
                }
                (b'4' | b'n', _) => {
                    dimension = true;
                    behind
                }
                _ => return Self::Other,
            };
        }
        if dimension { Self::Dimension } else { Self::Off(has, rest) }
    }
}

/// Whether a file that begins so is surely OFF.
pub(crate) fn is_off(head: &[u8]) -> bool {
    let mut lines = head.split(|b| *b == b'\n').map(<[u8]>::trim_ascii);
    let first = lines.find(|line| !line.is_empty() && !line.starts_with(b"#")).unwrap_or_default();
    let word = first.split(u8::is_ascii_whitespace).next().unwrap_or_default();
    First::of(word) != First::Other
}

impl Header {
    /// Reads it; `None` if `findings` hold an error about it.
    pub(super) fn read(
        blob: &dyn Blob,
        file: &Arc<str>,
        findings: &mut Findings,
    ) -> io::Result<Option<Self>> {
        let mut head = vec![0; LONGEST.min(blob.len() as usize)];
        let read = blob.read_full(&mut head, 0)?;
        let piece = Piece { text: &head[..read], offset: 0, line: 1, rows: 0 };
        Ok(Self::parse(&mut Cursor::new(piece, false), file, findings))
    }

    fn parse(cursor: &mut Cursor<'_>, file: &Arc<str>, findings: &mut Findings) -> Option<Self> {
        if !to_word(cursor) {
            let message = || "there is nothing to draw: the file is empty".to_owned();
            findings.error("empty models", || whole(file), message);
            return None;
        }
        let start = cursor.clone();
        let mut has = Has::default();
        let refuse = |findings: &mut Findings, message: String| {
            findings.error("other files", || start.here(file), || message);
            None
        };
        match First::of(cursor.word()) {
            First::Off(of, rest) => {
                has = of;
                // `OFF8 6 0`: the digits are read as the first count.
                if !rest.is_empty() {
                    let digits = rest.len();
                    *cursor = start.clone();
                    let word = cursor.clone().word().len();
                    cursor.skip(word - digits);
                }
            }
            First::Dimension => {
                let word = start.quote();
                return refuse(
                    findings,
                    format!(
                        "`{word}` files hold points of another dimension than three, which cannot be drawn"
                    ),
                );
            }
            First::Other if start.clone().decimal().is_some() => {
                let message =
                    || "the file does not begin with `OFF`; it is read as if it did".to_owned();
                findings.warning("files without a first word", || start.here(file), message);
                *cursor = start.clone();
            }
            First::Other => {
                let word = start.quote();
                return refuse(findings, format!("the file is no OFF: it begins with `{word}`"));
            }
        }
        if cursor.more() && cursor.clone().word().eq_ignore_ascii_case(b"binary") {
            return refuse(findings, "binary OFF is not read: write the file as text".to_owned());
        }
        to_word(cursor);
        let span = cursor.here(file);
        let vertices = count(cursor, "vertices", file, findings)?;
        let faces = count(cursor, "faces", file, findings)?;
        cursor.next_line();
        let (body, line) = (cursor.at() as u64, cursor.line);
        Some(Self { has, vertices, faces, body, line, span })
    }

    /// Refuses counts that the file is too short for, before anything is read.
    pub(super) fn has_rows(&self, blob: &dyn Blob, findings: &mut Findings) -> bool {
        // A last line may lack its end.
        let there = blob.len().saturating_sub(self.body).saturating_add(1);
        let [vertex, face] = LEAST;
        let needed =
            self.vertices.saturating_mul(vertex).saturating_add(self.faces.saturating_mul(face));
        if needed > there {
            let Self { vertices, faces, .. } = self;
            findings.error("counts beyond the file", || self.span.clone(), || {
                format!(
                    "the file has no room for {vertices} vertices and {faces} faces: it is cut short \
                     or its counts are wrong"
                )
            });
        }
        needed <= there
    }
}

/// Goes to the next word, on whatever line; whether there is one.
fn to_word(cursor: &mut Cursor<'_>) -> bool {
    while !cursor.more() {
        if cursor.is_done() {
            return false;
        }
        cursor.next_line();
    }
    true
}

fn count(
    cursor: &mut Cursor<'_>,
    what: &str,
    file: &Arc<str>,
    findings: &mut Findings,
) -> Option<u64> {
    let there = to_word(cursor);
    let at = cursor.clone();
    let number = cursor.decimal();
    let value = number.and_then(Decimal::to_integer).and_then(|n| u64::try_from(n).ok());
    if value.is_none() {
        findings.error(
            "counts that cannot be read",
            || at.here(file),
            || {
                if !there {
                    return format!("the file ends before the number of {what}");
                }
                let word = at.quote();
                match number {
                    Some(_) => format!("`{word}` is no number of {what}"),
                    None => {
                        format!("the number of {what} is missing: `{word}` {}", blame(at.rest()))
                    }
                }
            },
        );
    }
    value
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_first_word_says_what_vertices_have() {
        let has = |uv, color, normal| Has { uv, color, normal };
        for (word, of) in [
            ("OFF", has(false, false, false)),
            ("off", has(false, false, false)),
            ("COFF", has(false, true, false)),
            ("NOFF", has(false, false, true)),
            ("CNOFF", has(false, true, true)),
            ("NCOFF", has(false, true, true)),
            ("STOFF", has(true, false, false)),
            ("STCNOFF", has(true, true, true)),
        ] {
            assert_eq!(First::of(word.as_bytes()), First::Off(of, b""), "{word}");
        }
        assert_eq!(First::of(b"OFF12"), First::Off(has(false, false, false), b"12"));
        for word in ["4OFF", "nOFF", "C4OFF", "4nOFF"] {
            assert_eq!(First::of(word.as_bytes()), First::Dimension, "{word}");
        }
        for word in ["", "OF", "OFFICE", "KOFF", "ply", "takeoff"] {
            assert_eq!(First::of(word.as_bytes()), First::Other, "{word}");
        }
        assert!(is_off(b"# made by hand\n\n COFF\n3 1 0\n") && !is_off(b"v 0 0 0\n"));
    }
}
