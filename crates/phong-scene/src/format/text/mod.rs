//! What the readers of text formats share: lines in parallel, numbers, encodings, findings.

mod encoding;
mod lines;
mod number;
mod report;
mod rows;
mod words;

pub(crate) use encoding::{as_text, decode, head_of, name_of, open_text, read_text};
pub(crate) use lines::{Cursor, Lines, Piece, Rows};
pub(crate) use number::{BadNumber, Decimal, blame, take_digits};
pub(crate) use report::{Findings, TOLD, span, whole};
pub(crate) use words::{Fault, Parsed, Words};
