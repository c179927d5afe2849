//! The lines of a text of any size, parsed in parallel in bounded memory.
//!
//! The text is read in waves of a few pieces a thread. A piece ends where a line ends; its lines
//! are counted before it is parsed, so every parser knows where in the file it is. Results are
//! taken in the order of the text, those of one wave while the next is parsed. How the text falls
//! into pieces depends on the number of threads; what is read must not.

use std::io;
use std::sync::Arc;

use rayon::prelude::*;

use super::number::{BadNumber, Decimal, blame};
use super::report::span;
use super::rows::{count_lines, count_rows};
use crate::diagnostic::Span;
use crate::source::Blob;

/// Bytes of a piece, about.
const PIECE: usize = 512 << 10;

/// Bytes of the longest line that is read.
const LONGEST_LINE: usize = 64 << 20;

/// The lines of a text, to be parsed.
#[derive(Clone, Copy)]
pub(crate) struct Lines<'a> {
    /// The text.
    pub(crate) blob: &'a dyn Blob,
    /// Where in it the lines begin.
    pub(crate) start: u64,
    /// The number of the first line, from 1.
    pub(crate) line: u64,
    /// Whether a backslash at its end joins a line to the next.
    pub(crate) joined: bool,
    /// Which lines are counted as rows.
    pub(crate) rows: Rows,
}

/// Which lines are counted as rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Rows {
    /// None.
    Uncounted,
    /// Those with anything on them.
    All,
    /// Those with anything on them but a comment.
    WithoutComments,
}

/// A run of whole lines.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece<'a> {
    /// The lines.
    pub(crate) text: &'a [u8],
    /// Where in the text they begin.
    pub(crate) offset: u64,
    /// The number of the first.
    pub(crate) line: u64,
    /// How many rows stand before the first, if they are counted.
    pub(crate) rows: u64,
}

impl Lines<'_> {
    /// Parses all pieces and takes their results in order, until `take` says `false`.
    ///
    /// # Errors
    /// What the blob says, or that a line is too long.
    pub(crate) fn each<T: Send>(
        &self,
        parse: impl Fn(Piece<'_>) -> T + Sync,
        mut take: impl FnMut(T) -> bool + Send,
    ) -> io::Result<()> {
        let pieces = (2 * rayon::current_num_threads()).clamp(4, 64);
        let end = self.blob.len();
        let size = (end.saturating_sub(self.start)).min((pieces * PIECE) as u64) as usize;
        let mut buffer = vec![0; size.max(1)];
        let (mut offset, mut line, mut rows) = (self.start, self.line, 0);
        let mut kept = 0;
        let mut parsed = Vec::new();
        loop {
            let wanted = (end.saturating_sub(offset)).min(buffer.len() as u64) as usize;
            let filled = kept + self.fill(&mut buffer[kept..wanted], offset + kept as u64)?;
            let last = filled < wanted || offset + filled as u64 >= end;
            let whole = if last { filled } else { self.last_end(&buffer[..filled]) };
            if whole == 0 && !last {
                if buffer.len() >= LONGEST_LINE {
                    let message = format!("has a line of more than {LONGEST_LINE} bytes");
                    return Err(io::Error::new(io::ErrorKind::InvalidData, message));
                }
                kept = filled;
                buffer.resize(2 * buffer.len(), 0);
                continue;
            }
            let mut wave = self.split(&buffer[..whole], offset);
            wave.par_iter_mut().for_each(|piece| {
                (piece.line, piece.rows) = match self.rows {
                    Rows::Uncounted => (count_lines(piece.text), 0),
                    Rows::All => count_rows(piece.text, false),
                    Rows::WithoutComments => count_rows(piece.text, true),
                };
            });
            for piece in &mut wave {
                (line, piece.line) = (line + piece.line, line);
                (rows, piece.rows) = (rows + piece.rows, rows);
            }
            let (go_on, next) = rayon::join(
                || parsed.drain(..).all(&mut take),
                || wave.into_par_iter().map(&parse).collect::<Vec<T>>(),
            );
            if !go_on {
                return Ok(());
            }
            parsed = next;
            buffer.copy_within(whole..filled, 0);
            (kept, offset) = (filled - whole, offset + whole as u64);
            if last {
                parsed.into_iter().all(take);
                return Ok(());
            }
        }
    }

    /// Reads in parallel until `buffer` is full or the text ends; the bytes read.
    fn fill(&self, buffer: &mut [u8], offset: u64) -> io::Result<usize> {
        let read = buffer
            .par_chunks_mut(PIECE)
            .enumerate()
            .map(|(i, part)| {
                Ok((part.len(), self.blob.read_full(part, offset + (i * PIECE) as u64)?))
            })
            .collect::<io::Result<Vec<_>>>()?;
        let mut total = 0;
        for (wanted, got) in read {
            total += got;
            if got < wanted {
                break;
            }
        }
        Ok(total)
    }

    /// Whether the line feed at `at` ends a line.
    fn ends(&self, text: &[u8], at: usize) -> bool {
        let before = text[..at].strip_suffix(b"\r").unwrap_or(&text[..at]);
        !(self.joined && before.ends_with(b"\\"))
    }

    /// Just behind the last line end; 0 if there is none.
    fn last_end(&self, text: &[u8]) -> usize {
        let mut end = text.len();
        while let Some(at) = text[..end].iter().rposition(|&b| b == b'\n') {
            if self.ends(text, at) {
                return at + 1;
            }
            end = at;
        }
        0
    }

    /// Cuts whole lines into pieces, whose counts are still to be filled in.
    fn split<'a>(&self, mut text: &'a [u8], mut offset: u64) -> Vec<Piece<'a>> {
        let mut pieces = Vec::new();
        while !text.is_empty() {
            let mut end = text.len().min(PIECE);
            while let Some(feed) = text[end..].iter().position(|&b| b == b'\n') {
                end += feed + 1;
                if self.ends(text, end - 1) {
                    break;
                }
            }
            if !text[..end].ends_with(b"\n") {
                end = text.len();
            }
            let (piece, rest) = text.split_at(end);
            pieces.push(Piece { text: piece, offset, line: 0, rows: 0 });
            (text, offset) = (rest, offset + end as u64);
        }
        pieces
    }
}

/// Walks over the lines of a piece.
#[derive(Clone, Debug)]
pub(crate) struct Cursor<'a> {
    text: &'a [u8],
    at: usize,
    /// The number of the line it stands on.
    pub(crate) line: u64,
    line_start: usize,
    joined: bool,
}

impl<'a> Cursor<'a> {
    /// At the beginning of `piece`; `joined` as in [`Lines`].
    pub(crate) fn new(piece: Piece<'a>, joined: bool) -> Self {
        Self { text: piece.text, at: 0, line: piece.line, line_start: 0, joined }
    }

    /// At byte `at` of a piece, on line `line`, whose beginning is sought.
    pub(crate) fn resumed(piece: Piece<'a>, joined: bool, at: usize, line: u64) -> Self {
        let at = at.min(piece.text.len());
        let line_start = piece.text[..at].iter().rposition(|&b| b == b'\n').map_or(0, |i| i + 1);
        Self { text: piece.text, at, line, line_start, joined }
    }

    /// How far it has come.
    pub(crate) fn at(&self) -> usize {
        self.at
    }

    /// Whether everything was read.
    pub(crate) fn is_done(&self) -> bool {
        self.at >= self.text.len()
    }

    /// Whether nothing stands on the rest of the line, as [`Piece::rows`] counts.
    pub(crate) fn is_blank(&self) -> bool {
        self.rest().iter().take_while(|b| **b != b'\n').all(|b| *b <= b' ')
    }

    /// What has not been read yet.
    #[inline]
    pub(crate) fn rest(&self) -> &'a [u8] {
        self.text.get(self.at..).unwrap_or_default()
    }

    /// Goes on by `count` bytes.
    #[inline]
    pub(crate) fn skip(&mut self, count: usize) {
        self.at += count;
    }

    /// Goes to the next thing on the line; whether there is one.
    #[inline]
    pub(crate) fn more(&mut self) -> bool {
        loop {
            match self.text.get(self.at) {
                None | Some(b'\n' | b'#') => return false,
                Some(..=b' ') => self.at += 1,
                Some(b'\\') if self.joins() => {}
                Some(_) => return true,
            }
        }
    }

    /// Goes over a backslash that joins this line to the next, if it does.
    #[cold]
    fn joins(&mut self) -> bool {
        let end = match self.text.get(self.at + 1..) {
            Some([b'\n', ..]) => 2,
            Some([b'\r', b'\n', ..]) => 3,
            _ => return false,
        };
        if self.joined {
            self.at += end;
            self.line += 1;
            self.line_start = self.at;
        }
        self.joined
    }

    /// The next word, up to a blank or the end of the line; empty at the end.
    pub(crate) fn word(&mut self) -> &'a [u8] {
        if !self.more() {
            return b"";
        }
        let rest = self.rest();
        let length = self.word_length();
        self.at += length;
        &rest[..length]
    }

    /// The rest of the line but for blanks around it; comments are part of it.
    pub(crate) fn rest_of_line(&mut self) -> &'a [u8] {
        let rest = self.rest();
        let length = rest.iter().position(|&b| b == b'\n').unwrap_or(rest.len());
        self.at += length;
        rest[..length].trim_ascii()
    }

    /// The number that stands here, if it ends where a number may end. Else it stays.
    #[inline(always)]
    pub(crate) fn decimal(&mut self) -> Option<Decimal<'a>> {
        let decimal = Decimal::scan(self.rest())?;
        let end = self.at + decimal.len();
        self.ends_word(end).then(|| {
            self.at = end;
            decimal
        })
    }

    /// The next number of the line less `origin`, if it is a finite f32. Else it stays.
    #[inline]
    pub(crate) fn float(&mut self, origin: f64) -> Option<f32> {
        if !self.more() {
            return None;
        }
        let start = self.at;
        let decimal = self.decimal()?;
        // One rounding where there is nothing to subtract.
        let value =
            if origin == 0.0 { decimal.to_f32() } else { (decimal.to_f64() - origin) as f32 };
        if !value.is_finite() {
            self.at = start;
            return None;
        }
        Some(value)
    }

    /// Goes to the beginning of the next line, over lines that this one is joined to.
    #[inline]
    pub(crate) fn next_line(&mut self) {
        self.finish_line();
        if self.at < self.text.len() {
            self.at += 1;
            self.line += 1;
            self.line_start = self.at;
        }
    }

    /// Goes to the end of the line, over lines that this one is joined to.
    #[inline]
    pub(crate) fn finish_line(&mut self) {
        let mut comment = false;
        while let Some(&byte) = self.text.get(self.at) {
            match byte {
                b'\n' => return,
                b'\\' if !comment && self.joins() => continue,
                // A path in a comment may end in a backslash; it joins nothing.
                b'#' => comment = true,
                _ => {}
            }
            self.at += 1;
        }
    }

    /// The span of the word that stands here.
    pub(crate) fn here(&self, file: &Arc<str>) -> Span {
        self.span(file, self.at, self.at + self.word_length().max(1))
    }

    /// Goes over this word, in capitals or not, if it stands here; whether it does.
    #[inline]
    pub(crate) fn take(&mut self, word: &[u8]) -> bool {
        let end = self.at + word.len();
        let there = self.text.get(self.at..end);
        let taken =
            there.is_some_and(|there| there.eq_ignore_ascii_case(word)) && self.ends_word(end);
        if taken {
            self.at = end;
        }
        taken
    }

    #[inline]
    fn word_length(&self) -> usize {
        let may_end = |byte: &u8| *byte <= b' ' || matches!(byte, b'#' | b'\\');
        let mut end = self.at;
        while let Some(next) = self.text.get(end..).and_then(|rest| rest.iter().position(may_end)) {
            end += next;
            if self.ends_word(end) {
                return end - self.at;
            }
            end += 1;
        }
        self.text.len().saturating_sub(self.at)
    }

    /// Whether a word ends before `at`: at a blank, a comment, or a backslash that joins lines.
    #[inline]
    pub(crate) fn ends_word(&self, at: usize) -> bool {
        match self.text.get(at) {
            // Microsoft's runtime writes NaN as 1.#QNAN, which is no comment.
            Some(b'#') => at == 0 || self.text[at - 1] != b'.',
            None | Some(..=b' ') => true,
            Some(b'\\') if self.joined => {
                matches!(self.text.get(at + 1..), Some([b'\n', ..] | [b'\r', b'\n', ..]))
            }
            Some(_) => false,
        }
    }

    fn span(&self, file: &Arc<str>, start: usize, end: usize) -> Span {
        let text = &self.text[self.line_start..];
        let length = text.iter().position(|&b| b == b'\n').unwrap_or(text.len());
        let start = start.saturating_sub(self.line_start);
        span(file, self.line, &text[..length], start..end.saturating_sub(self.line_start))
    }

    /// Takes a word that says NaN or infinity, which programs write where they have no number;
    /// whether there is one.
    pub(crate) fn take_no_number(&mut self) -> bool {
        let none = self.more() && blame(self.rest()) != BadNumber::Malformed;
        if none {
            self.word();
        }
        none
    }

    /// The word that stands here as text to be quoted, cut to a sane length.
    pub(crate) fn quote(&self) -> String {
        let word = self.clone().word();
        let text = String::from_utf8_lossy(&word[..word.len().min(40)]).into_owned();
        if word.len() > 40 { format!("{text}…") } else { text }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::{Memory, Source};

    /// Every line of a text as the parsers meet it, with its number.
    fn walk(text: &str, joined: bool) -> Vec<(u64, u64, String)> {
        let source = Memory::new().with("a", text.as_bytes());
        let blob = source.open("a").unwrap();
        let lines = Lines { blob: blob.as_ref(), start: 0, line: 1, joined, rows: Rows::All };
        let mut seen = Vec::new();
        let parse = |piece: Piece<'_>| {
            let mut cursor = Cursor::new(piece, joined);
            let mut found = Vec::new();
            let mut row = piece.rows;
            while !cursor.is_done() {
                let line = cursor.line;
                let mut words = Vec::new();
                while cursor.more() {
                    words.push(String::from_utf8_lossy(cursor.word()).into_owned());
                }
                cursor.next_line();
                if !words.is_empty() {
                    found.push((line, row, words.join(" ")));
                    row += 1;
                }
            }
            found
        };
        lines
            .each(parse, |mut found| {
                seen.append(&mut found);
                true
            })
            .unwrap();
        seen
    }

    #[test]
    fn lines_are_joined_by_backslashes_and_keep_their_numbers() {
        let seen = walk("a b\\\r\n c\n\n# x \\\nd \\e # f\nlast\\", true);
        let expected = [(1, "a b c"), (5, "d \\e"), (6, "last\\")];
        assert_eq!(seen.iter().map(|(l, _, t)| (*l, t.as_str())).collect::<Vec<_>>(), expected);
    }

    #[test]
    fn a_long_text_is_walked_as_if_it_were_one_piece() {
        let mut text = String::new();
        for i in 0..300_000 {
            let end = if i % 7 == 0 { "\n\n" } else { "\r\n" };
            let word = "x".repeat(i % 31);
            text.extend([&i.to_string(), " ", &word, end]);
        }
        text.push_str("the end");
        let seen = walk(&text, true);
        assert_eq!(seen.len(), 300_001);
        let mut line = 1;
        for (i, (at, row, words)) in seen.iter().enumerate() {
            assert_eq!((*at, *row), (line, i as u64), "{words}");
            line += if i % 7 == 0 { 2 } else { 1 };
        }
    }

    #[test]
    fn a_line_longer_than_all_pieces_of_a_wave_is_one_line() {
        let long = "y".repeat(9 << 20);
        let seen = walk(&format!("a\n{long}\nb\n"), false);
        assert_eq!(seen.len(), 3);
        assert_eq!((seen[1].0, seen[1].2.len()), (2, 9 << 20));
        assert_eq!(seen[2], (3, 2, "b".to_owned()));
    }
}
