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
//! | a title behind the count, and rows of `number name x y z type bonds…` | atoms as Tinker writes them, whose bonds are those of their distances |
//! | no count at all | points `x y z`, `x y z value`, `x y z r g b` or `x y z value r g b`, or atoms `symbol x y z`; there may be one line of words before them |
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
use crate::elements::number_of_label;
use crate::fragment::Fragment;
use crate::molecule::{Column, Drawing, Molecule, Words, names};
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
    let tinker = tinker_rows(&cursor);
    if !is_integer(word) || cursor.more() && tinker.is_none() {
        return points::read(blob, file, input, first, drawing, findings);
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
    let comment = if let Some(rows) = &tinker {
        cursor = rows.clone();
        Comment::default()
    } else {
        let comment = Comment::parse(cursor.rest_of_line());
        cursor.next_line();
        comment
    };
    let (start, line) = (cursor.at() as u64, cursor.line);
    let layout = match &comment.properties {
        Some(properties) => match properties.layout(drawing) {
            Ok(layout) => layout,
            Err(message) => {
                findings.error("properties", || comment_at.here(file), || message);
                return Ok(None);
            }
        },
        None if tinker.is_some() => {
            let slots =
                vec![Slot::Skip, Slot::Label(0), Slot::Place(0), Slot::Place(1), Slot::Place(2)];
            Layout { slots, columns: vec![Column::of_words(names::NAME)], bytes: false }
        }
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
    if tinker.is_some() {
        molecule.elements = molecule.words(names::NAME).map(elements_of_tinker).unwrap_or_default();
    }
    if more {
        let message = || "the first frame is drawn; others follow it".to_owned();
        findings.note("frames", || whole(file), message);
    }
    molecule.cell = comment.cell;
    Ok(Some(molecule))
}

/// Where the rows begin that follow the line of this count, if Tinker wrote them: behind a line of the
/// cell's three lengths and three angles, if there is one, the number 1, a name, a place and a type.
fn tinker_rows<'a>(count: &Cursor<'a>) -> Option<Cursor<'a>> {
    let mut row = count.clone();
    row.next_line();
    let mut box_of = row.clone();
    if (0..6).all(|_| box_of.more() && box_of.decimal().is_some()) && !box_of.more() {
        row.next_line();
    }
    let mut words = row.clone();
    let is_first =
        words.word() == b"1" && words.word().first().is_some_and(u8::is_ascii_alphabetic);
    let has_place = (0..3).all(|_| words.more() && words.word().contains(&b'.'));
    (is_first && has_place && words.more() && is_integer(words.word())).then_some(row)
}

/// The elements of Tinker's names: `CA` and `HN` are of carbon and hydrogen, `Na+` is of sodium.
fn elements_of_tinker(words: &Words) -> Vec<u8> {
    let of = |name: &String| {
        let name = name.as_bytes();
        let first = match name {
            [_, second, ..] if second.is_ascii_uppercase() => {
                let known = [b"CL", b"BR", b"MG", b"ZN", b"FE"];
                if known.iter().any(|known| name.starts_with(*known)) { 2 } else { 1 }
            }
            _ => name.len(),
        };
        number_of_label(&name[..first]).unwrap_or(0)
    };
    let elements: Vec<u8> = words.names.iter().map(of).collect();
    words.numbers.iter().map(|number| elements[*number as usize]).collect()
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
