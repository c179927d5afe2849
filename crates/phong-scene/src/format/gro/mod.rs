//! GRO, of GROMACS: a title, a count, and atoms with each value in its columns of characters.
//!
//! | in the file | read as |
//! |---|---|
//! | columns 1–5, 6–10, 11–15 | the residue's number and name, the atom's name |
//! | the coordinates | in nanometres, ten times that in Å; how wide they are is told by how far their points are apart |
//! | velocities | in nanometres a picosecond, as they are: the columns `vx`, `vy` and `vz`, read where they are asked for |
//! | the last line | the cell: three lengths, or nine numbers; none, where it is the cube of 1 Å |
//! | later frames | not drawn, which is told |
//!
//! Elements are those that the atoms' names begin with; `Me` is a methyl group in one, drawn as carbon. A file of fewer atoms than it says is an error,
//! unless it is read leniently.

use std::io;
use std::sync::Arc;

use glam::DVec3;

use super::atoms::{Fixed, fixed_lines, has_room, read_atoms, tell_truncated};
use super::input::Input;
use super::text::{Decimal, Findings, Lines, Piece, Rows, head_of, open_text, whole};
use crate::diagnostic::Diagnostic;
use crate::elements::{number_of, number_of_group};
use crate::fragment::Fragment;
use crate::molecule::{Cell, Column, Drawing, Molecule, names};
use crate::source::Blob;

/// Å in a nanometre.
const NANOMETRE: f64 = 10.0;

/// Bytes in which the title, the count and the first atom stand.
const HEAD: usize = 16 << 10;

/// The columns of velocities.
const VELOCITY: [&str; 3] = ["vx", "vy", "vz"];

/// Where coordinates begin.
const FIRST: usize = 20;

/// Reads a GRO file; `None` if a diagnostic is an error.
pub(crate) fn read(input: &Input<'_>, out: &mut Vec<Diagnostic>) -> Option<Fragment> {
    read_atoms(input, out, |file, drawing, findings| {
        let blob = open_text(input.source, input.path, input.limits)?;
        atoms(blob.as_ref(), file, input, drawing, findings)
    })
}

/// What a piece of the file holds.
#[derive(Debug, Default)]
struct Block {
    molecule: Molecule,
    places: Vec<DVec3>,
    cell: Option<Cell>,
    /// Whether another frame follows.
    more: bool,
    findings: Findings,
}

fn atoms(
    blob: &dyn Blob,
    file: &Arc<str>,
    input: &Input<'_>,
    drawing: &Drawing,
    findings: &mut Findings,
) -> io::Result<Option<Molecule>> {
    let head = head_of(blob, HEAD)?;
    let piece = Piece { text: &head, offset: 0, line: 1, rows: 0 };
    let mut lines = fixed_lines(piece).skip(1);
    let (count, first) = (lines.next(), lines.next());
    let said = count.and_then(|line| {
        let text = line.text.trim_ascii();
        let number = Decimal::scan(text).filter(|number| number.len() == text.len())?;
        u64::try_from(number.to_integer()?).ok()
    });
    let (Some(said), Some(first)) = (said.filter(|count| *count > 0), first) else {
        let message =
            || "the file is no GRO: its second line is not how many atoms it has".to_owned();
        let span = || count.map_or_else(|| whole(file), |line| line.span(file, 0, line.text.len()));
        findings.error("counts", span, message);
        return Ok(None);
    };
    // An atom takes 44 columns at least, and a line's end.
    let room = blob.len() / 45 + 1;
    if said > room {
        tell_truncated(room, said, input.limits, file, findings);
        if !input.limits.lenient {
            return Ok(None);
        }
    }
    let width = width_of(first);
    let columns = [names::NAME, names::RESIDUE].map(Column::of_words);
    let numbers =
        [names::NUMBER].into_iter().chain(VELOCITY.into_iter().filter(|v| drawing.uses(v)));
    let columns = columns.into_iter().chain(numbers.map(Column::of_numbers)).collect();
    let mut all = Molecule { columns, ..Molecule::default() };
    let mut places: Vec<DVec3> = Vec::new();
    let mut more = false;
    let lines = Lines { blob, start: 0, line: 1, joined: false, rows: Rows::Uncounted };
    let empty = all.clone();
    lines.each(
        |piece| {
            let mut block = Block { molecule: empty.clone(), ..Block::default() };
            for line in fixed_lines(piece).filter(|line| line.line > 2) {
                block.line(line, said, width, file);
            }
            block
        },
        |block| {
            findings.append(block.findings);
            all.append(block.molecule);
            places.extend(block.places);
            all.cell = all.cell.or(block.cell);
            more |= block.more;
            !block.more && has_room(&all, input.limits, file, findings)
        },
    )?;
    if (all.len() as u64) < said && !findings.any_error() && said <= room {
        tell_truncated(all.len() as u64, said, input.limits, file, findings);
    }
    if more {
        let message = || "the first frame is drawn; others follow it".to_owned();
        findings.note("frames", || whole(file), message);
    }
    all.place_all(&places);
    Ok(Some(all))
}

/// How many columns a coordinate takes: as many as from point to point.
fn width_of(line: Fixed<'_>) -> usize {
    let text = line.text.get(FIRST..).unwrap_or_default();
    let mut points = text.iter().enumerate().filter(|(_, b)| **b == b'.').map(|(i, _)| i);
    match (points.next(), points.next()) {
        (Some(first), Some(second)) => (second - first).clamp(3, 40),
        _ => 8,
    }
}

impl Block {
    fn line(&mut self, line: Fixed<'_>, said: u64, width: usize, file: &Arc<str>) {
        let row = line.line - 3;
        if row == said {
            self.cell = cell_of(line);
            return;
        }
        if row > said {
            self.more |= !line.text.is_empty();
            return;
        }
        if line.text.is_empty() {
            return;
        }
        let mut axis = |axis: usize| {
            let start = FIRST + width * axis;
            NANOMETRE * line.coordinate(axis, [start, start + width], file, &mut self.findings)
        };
        let place = DVec3::new(axis(0), axis(1), axis(2));
        let (residue, name) = (line.field(5, 10), line.field(10, 15));
        self.places.push(place);
        self.molecule.spheres.push([0.0; 4]);
        self.molecule.elements.push(element_of(name, residue));
        if let [names, residues, numbers, velocities @ ..] = &mut self.molecule.columns[..] {
            names.values.push_word(name);
            residues.values.push_word(residue);
            numbers.values.push_number(line.number(0, 5).unwrap_or(f64::NAN) as f32);
            for column in velocities {
                // Behind the coordinates, and as wide.
                let axis = VELOCITY.iter().position(|name| *name == column.name).unwrap_or(0);
                let start = FIRST + width * (3 + axis);
                let number = line.number(start, start + width).unwrap_or(f64::NAN);
                column.values.push_number(number as f32);
            }
        }
    }
}

/// The element of an atom's name: the whole of it where the residue is an ion of that name, else the
/// first letter that is a symbol.
fn element_of(name: &[u8], residue: &[u8]) -> u8 {
    let group = number_of_group(name);
    let letters =
        |text: &[u8]| -> Vec<u8> { text.iter().copied().filter(u8::is_ascii_alphabetic).collect() };
    let (name, residue) = (letters(name), letters(residue));
    if name == residue
        && let Some(number) = number_of(&name)
    {
        return number;
    }
    name.iter().find_map(|letter| number_of(&[*letter])).or(group).unwrap_or(0)
}

/// The cell: the lengths, then, if they are there, what the edges have along the other axes.
fn cell_of(line: Fixed<'_>) -> Option<Cell> {
    let text = str::from_utf8(line.text).ok()?;
    let numbers: Vec<f64> = text.split_ascii_whitespace().map_while(|n| n.parse().ok()).collect();
    let n: Vec<f64> = numbers.iter().map(|n| n * NANOMETRE).collect();
    let edges = match n.len() {
        3 => [DVec3::new(n[0], 0.0, 0.0), DVec3::new(0.0, n[1], 0.0), DVec3::new(0.0, 0.0, n[2])],
        9 => [
            DVec3::new(n[0], n[3], n[4]),
            DVec3::new(n[5], n[1], n[6]),
            DVec3::new(n[7], n[8], n[2]),
        ],
        _ => return None,
    };
    let cell = Cell { origin: DVec3::ZERO, edges };
    let sound =
        n.iter().all(|n| n.is_finite()) && cell.thickness() > 0.0 && !cell.stands_for_none();
    sound.then_some(cell)
}
