//! XYZ: a count, a comment, and a line an atom; extended XYZ, whose comment says what the columns are;
//! and plain points, a line each.
//!
//! | in the file | read as |
//! |---|---|
//! | the first line, a whole number | how many atoms the first frame has; later frames are not drawn, which is told |
//! | `symbol x y z` | an atom; labels such as `C12` begin with the symbol, a number is the atomic number |
//! | `Properties=species:S:1:pos:R:3:…` | the columns of extended XYZ: `species` or `Z`, `pos`, `color` (0–1, or bytes), `radius`; others can be drawn by, those of several values as `forces.1`, … |
//! | `Lattice="…"`, `Origin="…"` | the cell |
//! | other columns | numbers that can be drawn by, called `column 5`, … |
//! | no count at all | points `x y z`, `x y z value`, `x y z r g b` or `x y z value r g b`; one line of words before them names the columns |
//!
//! An atom whose place is NaN or beyond 1e18 is left out and counted. A file of fewer atoms than it
//! says is an error, unless it is read leniently.

mod comment;
mod points;

use std::io;
use std::sync::Arc;

use self::comment::Comment;
use super::atoms::{Layout, Slot, Table, is_integer, read_atoms};
use super::input::Input;
use super::text::{Cursor, Decimal, Findings, Piece, head_of, open_text, whole};
use crate::diagnostic::Diagnostic;
use crate::fragment::Fragment;
use crate::molecule::{Column, Drawing, Molecule, names};
use crate::source::Blob;

/// Bytes from the beginning in which the count, the comment and the first atom stand.
const HEAD: usize = 64 << 10;

/// Reads an XYZ file; `None` if a diagnostic is an error.
pub(crate) fn read(input: &Input<'_>, out: &mut Vec<Diagnostic>) -> Option<Fragment> {
    read_atoms(input, out, |file, drawing, findings| {
        let blob = open_text(input.source, input.path, input.limits)?;
        atoms(blob.as_ref(), file, input, drawing, findings)
    })
}

fn atoms(
    blob: &dyn Blob,
    file: &Arc<str>,
    input: &Input<'_>,
    drawing: &Drawing,
    findings: &mut Findings,
) -> io::Result<Option<Molecule>> {
    let head = &head_of(blob, HEAD)?[..];
    let mut cursor = Cursor::new(Piece { text: head, offset: 0, line: 1, rows: 0 }, false);
    // Some programs leave blank lines before the count.
    while cursor.is_blank() && !cursor.is_done() {
        cursor.next_line();
    }
    let first = cursor.clone();
    let word = cursor.word();
    if !is_integer(word) || cursor.more() {
        return points::read(blob, file, input, first, findings);
    }
    let count = Decimal::scan(word).and_then(Decimal::to_integer).unwrap_or(-1);
    let Ok(count) = u64::try_from(count) else {
        let message = || "the count of atoms is below 0".to_owned();
        findings.error("counts", || first.here(file), message);
        return Ok(None);
    };
    if count == 0 {
        let message = || "there is nothing to draw: the file says that it has 0 atoms".to_owned();
        findings.error("counts", || first.here(file), message);
        return Ok(None);
    }
    cursor.next_line();
    let comment_at = cursor.clone();
    let comment = Comment::parse(cursor.rest_of_line());
    cursor.next_line();
    let (start, line) = (cursor.at() as u64, cursor.line);
    let layout = match &comment.properties {
        Some(properties) => match properties.layout(drawing) {
            Ok(layout) => layout,
            Err(message) => {
                findings.error("properties", || comment_at.here(file), || message);
                return Ok(None);
            }
        },
        None => plain(&mut cursor, drawing),
    };
    let table = Table {
        blob,
        file,
        limits: input.limits,
        start,
        line,
        count: Some(count),
        layout,
        shares: false,
    };
    let (mut molecule, more) = table.read(findings)?;
    if more {
        let message = || "the first frame is drawn; others follow it".to_owned();
        findings.note("frames", || whole(file), message);
    }
    molecule.cell = comment.cell;
    Ok(Some(molecule))
}

/// The layout that the first row shows: a symbol, a place, and whatever follows.
fn plain(cursor: &mut Cursor<'_>, drawing: &Drawing) -> Layout {
    let mut slots = Vec::new();
    let mut columns = Vec::new();
    let first = cursor.word();
    if first.contains(&b'.') && Decimal::scan(first).is_some_and(|d| d.len() == first.len()) {
        // No symbols at all.
        slots.extend([0, 1, 2].map(Slot::Place));
        cursor.word();
        cursor.word();
    } else {
        slots.push(Slot::Label(0));
        columns.push(Column::of_words(names::NAME));
        slots.extend([0, 1, 2].map(Slot::Place));
        for _ in 0..3 {
            cursor.word();
        }
    }
    while cursor.more() && slots.len() < 64 {
        let name = format!("column {}", slots.len() + 1);
        let number = cursor.float(0.0).is_some();
        if !number {
            cursor.word();
        }
        slots.push(Slot::Skip);
        if number && drawing.uses(&name) {
            let last = slots.len() - 1;
            slots[last] = Slot::Column(columns.len());
            columns.push(Column::of_numbers(&name));
        }
    }
    while slots.last() == Some(&Slot::Skip) {
        slots.pop();
    }
    Layout { slots, columns, bytes: false }
}
