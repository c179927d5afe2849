//! Words one after another, over the ends of lines: for formats in which lines count for nothing.

use std::sync::Arc;

use super::lines::{Cursor, Piece};
use super::number::Decimal;
use crate::diagnostic::Span;

/// Why a statement could not be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Fault {
    /// The text ends within it.
    End,
    /// Something else should stand at the place of the word.
    Wrong(String),
}

/// What was read, or why it could not be.
pub(crate) type Parsed<T> = Result<T, Fault>;

/// Walks over the words of a text; `#` begins a comment.
#[derive(Clone, Debug)]
pub(crate) struct Words<'a> {
    cursor: Cursor<'a>,
}

impl<'a> Words<'a> {
    /// Those of a text that begins on this line.
    pub(crate) fn of(text: &'a [u8], line: u64) -> Self {
        Self { cursor: Cursor::new(Piece { text, offset: 0, line, rows: 0 }, false) }
    }

    /// How many bytes were read.
    pub(crate) fn at(&self) -> usize {
        self.cursor.at()
    }

    /// The number of the line.
    pub(crate) fn line(&self) -> u64 {
        self.cursor.line
    }

    /// Goes to the next word; whether there is one.
    #[inline]
    pub(crate) fn is_there(&mut self) -> bool {
        while !self.cursor.more() {
            if self.cursor.is_done() {
                return false;
            }
            self.cursor.next_line();
        }
        true
    }

    /// Goes to the beginning of the next line.
    pub(crate) fn next_line(&mut self) {
        self.cursor.next_line();
    }

    /// The next word; empty at the end.
    #[inline]
    pub(crate) fn word(&mut self) -> &'a [u8] {
        self.is_there();
        self.cursor.word()
    }

    /// The word that stands here, as text.
    pub(crate) fn quote(&self) -> String {
        self.cursor.quote()
    }

    /// Where it stands.
    pub(crate) fn here(&self, file: &Arc<str>) -> Span {
        self.cursor.here(file)
    }

    /// What should stand here but does not.
    #[cold]
    pub(crate) fn wrong(&mut self, wanted: &str) -> Fault {
        if self.is_there() {
            Fault::Wrong(format!("`{}` stands where {wanted} should", self.quote()))
        } else {
            Fault::End
        }
    }

    /// What a word that was read should have been.
    #[cold]
    pub(crate) fn wrong_word(word: &[u8], wanted: &str) -> Fault {
        let word = String::from_utf8_lossy(&word[..word.len().min(40)]);
        Fault::Wrong(format!("`{word}` stands where {wanted} should"))
    }

    /// The next word, which must be there.
    pub(crate) fn some(&mut self, wanted: &str) -> Parsed<&'a [u8]> {
        if self.is_there() { Ok(self.cursor.word()) } else { Err(self.wrong(wanted)) }
    }

    /// Goes over this word, in capitals or not.
    #[inline]
    pub(crate) fn key(&mut self, key: &str) -> Parsed<()> {
        let before = self.cursor.clone();
        if self.is_there() && self.cursor.take(key.as_bytes()) {
            return Ok(());
        }
        self.cursor = before;
        Err(self.wrong(&format!("`{key}`")))
    }

    /// Goes over this word if it stands here; whether it does.
    pub(crate) fn has(&mut self, key: &str) -> bool {
        self.key(key).is_ok()
    }

    /// A number; infinite or NaN where the file says so, or where it is too large.
    #[inline]
    pub(crate) fn number(&mut self) -> Parsed<f32> {
        self.is_there();
        if let Some(value) = self.cursor.float(0.0) {
            return Ok(value);
        }
        if self.cursor.decimal().is_some() {
            return Ok(f32::INFINITY);
        }
        if self.cursor.take_no_number() { Ok(f32::NAN) } else { Err(self.wrong("a number")) }
    }

    /// A whole number from 0 on.
    pub(crate) fn whole(&mut self) -> Parsed<u64> {
        self.is_there();
        let before = self.cursor.clone();
        let number = self.cursor.decimal().and_then(Decimal::to_integer);
        if let Some(number) = number.and_then(|n| u64::try_from(n).ok()) {
            Ok(number)
        } else {
            self.cursor = before;
            Err(self.wrong("a whole number"))
        }
    }

    /// Three numbers as they stand.
    #[inline]
    pub(crate) fn three(&mut self) -> Parsed<[f32; 3]> {
        Ok([self.number()?, self.number()?, self.number()?])
    }

    /// A key and the number behind it.
    #[inline]
    pub(crate) fn keyed_number(&mut self, key: &str) -> Parsed<f32> {
        self.key(key)?;
        self.number()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_go_over_lines_and_comments() {
        let mut words = Words::of(b"# a\n\nCenter 1\n2 3 # b\nnan x", 1);
        assert_eq!((words.key("CENTER"), words.three()), (Ok(()), Ok([1.0, 2.0, 3.0])));
        assert!(words.number().is_ok_and(f32::is_nan));
        assert_eq!(words.number(), Err(Fault::Wrong("`x` stands where a number should".into())));
        assert_eq!((words.word(), words.line()), (&b"x"[..], 5));
        assert_eq!(words.number(), Err(Fault::End));
    }
}
