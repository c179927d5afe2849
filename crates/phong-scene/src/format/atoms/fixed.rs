//! Lines whose values stand in columns of characters.

use std::sync::Arc;

use crate::diagnostic::Span;
use crate::format::text::{Decimal, Findings, Piece, blame, span};
use crate::limits::LARGEST;

/// A line, by columns.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fixed<'a> {
    /// Its number.
    pub(crate) line: u64,
    /// What stands on it, without its end.
    pub(crate) text: &'a [u8],
}

/// The lines of a piece.
pub(crate) fn fixed_lines(piece: Piece<'_>) -> impl Iterator<Item = Fixed<'_>> {
    let lines = piece.text.split(|b| *b == b'\n');
    (piece.line..).zip(lines).map(|(line, text)| Fixed { line, text: text.trim_ascii_end() })
}

impl<'a> Fixed<'a> {
    /// What stands from column `start` to before column `end`, both counted from 0, without blanks around
    /// it; empty where the line ends before.
    pub(crate) fn field(&self, start: usize, end: usize) -> &'a [u8] {
        let end = end.min(self.text.len());
        self.text.get(start.min(end)..end).unwrap_or_default().trim_ascii()
    }

    /// The number that stands there; `None`: there is none.
    pub(crate) fn number(&self, start: usize, end: usize) -> Option<f64> {
        let field = self.field(start, end);
        let number = Decimal::scan(field)?;
        (number.len() == field.len()).then(|| number.to_f64()).filter(|n| n.is_finite())
    }

    /// The coordinate that stands there; NaN if it is none that can be drawn, which is said.
    pub(crate) fn coordinate(
        &self,
        axis: usize,
        [start, end]: [usize; 2],
        file: &Arc<str>,
        findings: &mut Findings,
    ) -> f64 {
        if let Some(number) = self.number(start, end).filter(|n| n.abs() <= LARGEST) {
            return number;
        }
        let field = self.field(start, end);
        let quote = || String::from_utf8_lossy(field);
        let axis = ["x", "y", "z"][axis];
        let span = || self.span(file, start, end);
        match blame(field) {
            _ if field.is_empty() => {
                let message = || format!("the line ends before the `{axis}` of the atom");
                findings.error("places that cannot be read", span, message);
            }
            crate::format::text::BadNumber::Malformed if self.number(start, end).is_none() => {
                let message = || {
                    format!("`{}` is not a number, but should be the `{axis}` of the atom", quote())
                };
                findings.error("places that cannot be read", span, message);
            }
            _ => {
                let message = || format!("`{}` is no place: the atom is left out", quote());
                findings.warning("atoms that are left out", span, message);
            }
        }
        f64::NAN
    }

    /// The span of columns.
    pub(crate) fn span(&self, file: &Arc<str>, start: usize, end: usize) -> Span {
        let blanks = self.text.get(start..end.min(self.text.len())).unwrap_or_default();
        let blanks = blanks.iter().take_while(|b| **b == b' ').count();
        span(file, self.line, self.text, start + blanks..end)
    }
}
