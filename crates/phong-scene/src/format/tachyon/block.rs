//! Pieces of a scene's text, read in parallel.
//!
//! A piece may begin within a statement. Its first lines are left for the piece before, up to one that
//! surely begins a statement of a kind of which there may be many; the last statement, where it does
//! not end, is left for the piece after.

use std::sync::Arc;

use super::statement::is_statement;
use super::things::Things;
use crate::format::text::{Fault, Findings, Piece, Words};

/// The words that a statement of which there may be many begins with.
const MANY: [(&[u8], &[u8]); 5] = [
    (b"sphere", b"center"),
    (b"tri", b"v0"),
    (b"stri", b"v0"),
    (b"vcstri", b"v0"),
    (b"fcylinder", b"base"),
];

/// What one piece holds.
#[derive(Debug, Default)]
pub(super) struct Block {
    /// Its first lines, not read.
    pub(super) head: Vec<u8>,
    /// The number of the first.
    pub(super) line: u64,
    /// What follows them; `None`: no statement surely begins here.
    pub(super) things: Option<Things>,
    /// What the last statement is of which the end is missing.
    pub(super) tail: Vec<u8>,
    /// The number of its line.
    pub(super) tail_line: u64,
    pub(super) findings: Findings,
}

impl Block {
    /// Reads a piece from the first statement that surely begins in it.
    pub(super) fn parse(piece: &Piece<'_>, file: &Arc<str>, lenient: bool) -> Self {
        let Some(start) = first(piece.text) else {
            return Self { head: piece.text.to_vec(), line: piece.line, ..Self::default() };
        };
        let (head, body) = piece.text.split_at(start);
        let line = piece.line + head.split(|b| *b == b'\n').count() as u64 - 1;
        let mut block = Self { head: head.to_vec(), line: piece.line, ..Self::default() };
        block.statements(body, line, false, file, lenient);
        block
    }

    /// Reads all of a text, of which nothing follows.
    pub(super) fn rest(text: &[u8], line: u64, file: &Arc<str>, lenient: bool) -> Self {
        let mut block = Self { line, ..Self::default() };
        block.statements(text, line, true, file, lenient);
        block
    }

    fn statements(&mut self, text: &[u8], line: u64, last: bool, file: &Arc<str>, lenient: bool) {
        let mut things = Things::default();
        let mut words = Words::of(text, line);
        loop {
            let mut start = words.clone();
            if !start.is_there() {
                break;
            }
            words = start.clone();
            let fault = match things.statement(&mut words) {
                Ok(true) => continue,
                Ok(false) => {
                    words = start.clone();
                    words.wrong("a statement")
                }
                Err(Fault::End) if !last => {
                    self.tail = text[start.at()..].to_vec();
                    self.tail_line = start.line();
                    break;
                }
                Err(fault) => fault,
            };
            let name = start.quote();
            let message = || match fault {
                Fault::Wrong(said) if said.contains("a statement") => said,
                Fault::Wrong(said) => format!("in `{name}`: {said}"),
                Fault::End => format!("the file ends within `{name}`"),
            };
            let place = if last && words.clone().word().is_empty() { &start } else { &words };
            let span = || place.here(file);
            self.findings.damage(lenient, "statements that cannot be read", span, message);
            skip(&mut words);
        }
        self.things = Some(things);
    }
}

/// Goes on to a line that begins with the name of a statement.
fn skip(words: &mut Words<'_>) {
    loop {
        words.next_line();
        let mut ahead = words.clone();
        if !ahead.is_there() || is_statement(ahead.word()) {
            return;
        }
    }
}

/// Where the first line begins that surely begins a statement of which there may be many.
fn first(text: &[u8]) -> Option<usize> {
    let mut at = 0;
    for line in text.split_inclusive(|b| *b == b'\n') {
        let mut words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        if let (Some(name), second) = (words.next(), words.next()) {
            // VMD writes the words behind the name on lines of their own.
            let is = |(first, behind): &(&[u8], &[u8])| {
                name.eq_ignore_ascii_case(first)
                    && second.is_some_and(|word| word.eq_ignore_ascii_case(behind))
            };
            if MANY.iter().any(is) {
                return Some(at);
            }
        }
        at += line.len();
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_piece_is_read_from_a_sure_beginning_to_the_last_whole_statement() {
        let text = b"0 1 RAD 2 A\nSphere Center 0 0 0\nRad 1 B\nTRI V0 0 0 0\nV1 1 1 1\n";
        let piece = Piece { text, offset: 0, line: 7, rows: 0 };
        let block = Block::parse(&piece, &"a".into(), false);
        assert_eq!((&block.head[..], block.line), (&b"0 1 RAD 2 A\n"[..], 7));
        assert_eq!((&block.tail[..], block.tail_line), (&b"TRI V0 0 0 0\nV1 1 1 1\n"[..], 10));
        let things = block.things.expect("a sphere");
        assert_eq!(things.spheres, [([0.0, 0.0, -0.0, 1.0], 0)]);
        assert!(!block.findings.any_error());
    }
}
