//! Files of points or atoms without a count, which go by the name of XYZ too.

use std::io;
use std::sync::Arc;

use super::plain;
use crate::elements::number_of_label;
use crate::format::atoms::{Layout, Slot, Table};
use crate::format::input::Input;
use crate::format::text::{Cursor, Decimal, Findings};
use crate::molecule::{Column, Drawing, Molecule};
use crate::source::Blob;

/// Reads the points or atoms that begin at `cursor`, or behind one line of words.
pub(super) fn read(
    blob: &dyn Blob,
    file: &Arc<str>,
    input: &Input<'_>,
    mut cursor: Cursor<'_>,
    drawing: &Drawing,
    findings: &mut Findings,
) -> io::Result<Option<Molecule>> {
    let first = cursor.clone();
    if layout(&cursor, drawing).is_none() {
        cursor.next_line();
    }
    let Some(layout) = layout(&cursor, drawing) else {
        let message = || {
            "the file is no XYZ: it begins neither with a count of atoms nor with points `x y z` or atoms `C x y z`"
                .to_owned()
        };
        findings.error("other files", || first.here(file), message);
        return Ok(None);
    };
    let (start, line) = (cursor.at() as u64, cursor.line);
    let table =
        Table { blob, file, limits: input.limits, start, line, count: None, layout, shares: false };
    Ok(Some(table.read(findings)?.0))
}

/// The layout that a line shows; `None`: it is neither of a point nor of an atom.
fn layout(cursor: &Cursor<'_>, drawing: &Drawing) -> Option<Layout> {
    let row = values(cursor);
    if row.len() < 3 {
        let mut place = cursor.clone();
        number_of_label(place.word())?;
        return (values(&place).len() >= 3).then(|| plain(&mut cursor.clone(), drawing));
    }
    let mut slots = vec![Slot::Place(0), Slot::Place(1), Slot::Place(2)];
    let mut columns = Vec::new();
    let are_bytes =
        |last: &[f64]| last.iter().all(|c| *c >= 0.0 && *c <= 255.0 && c.fract() == 0.0);
    let are_shares = |last: &[f64]| last.iter().all(|c| *c >= 0.0 && *c <= 1.0);
    let (last, bytes) = match row.len() {
        6 | 7 => (&row[row.len() - 3..], are_bytes(&row[row.len() - 3..])),
        _ => (&row[..0], false),
    };
    let colored = !last.is_empty() && (bytes || are_shares(last));
    if row.len() == 4 || row.len() == 7 && colored {
        slots.push(Slot::Column(0));
        columns.push(Column::of_numbers("value"));
    }
    if colored {
        slots.extend([0, 1, 2].map(Slot::Color));
    }
    Some(Layout { slots, columns, bytes })
}

/// The numbers of a line that holds nothing else.
fn values(cursor: &Cursor<'_>) -> Vec<f64> {
    let mut cursor = cursor.clone();
    let mut numbers = Vec::new();
    while cursor.more() && numbers.len() < 64 {
        match cursor.decimal().map(Decimal::to_f64) {
            Some(number) => numbers.push(number),
            None => return Vec::new(),
        }
    }
    numbers
}
