//! Dumps, as text: a header with the box, then a row an atom, of columns that the header names.
//!
//! | in the file | read as |
//! |---|---|
//! | `ITEM: NUMBER OF ATOMS` | how many rows follow; fewer are an error, unless read leniently |
//! | `ITEM: BOX BOUNDS` | the cell: of right angles, with tilts `xy xz yz`, or three edges `abc origin` |
//! | `ITEM: ATOMS …` | the columns, by name: `x y z`, else `xu yu zu`, else `xs ys zs` or `xsu ysu zsu`, which are shares of the box; `type`, `element`, `radius`, `diameter`; others can be drawn by, `q` as `charge` and `mol` as `molecule` |
//! | later time steps | not drawn, which is told |
//!
//! A place that is NaN leaves the atom out. Without `radius` and `element`, spheres just touch.

use std::io;
use std::sync::Arc;

use glam::DVec3;

use super::boxes::{cell_of, cell_of_bounds};
use super::columns::{Places, layout};
use super::data::MOST_IDS;
use crate::diagnostic::Diagnostic;
use crate::format::atoms::{Table, read_atoms};
use crate::format::input::Input;
use crate::format::text::{Cursor, Decimal, Findings, Piece, head_of, open_text, whole};
use crate::fragment::Fragment;
use crate::molecule::{Cell, Drawing, Molecule};
use crate::source::Blob;

/// Bytes in which the header of the first time step stands.
const HEAD: usize = 64 << 10;

/// Whether a file begins like one.
pub(crate) fn is_dump(head: &[u8]) -> bool {
    head.starts_with(b"ITEM: ")
}

/// Reads a dump; `None` if a diagnostic is an error.
pub(crate) fn read(input: &Input<'_>, out: &mut Vec<Diagnostic>) -> Option<Fragment> {
    read_atoms(input, out, |file, drawing, findings| {
        let blob = open_text(input.source, input.path, input.limits)?;
        atoms(blob.as_ref(), file, input, drawing, findings)
    })
}

/// What the header says.
#[derive(Debug, Default)]
struct Header {
    count: Option<u64>,
    cell: Option<Cell>,
    /// Names of the columns.
    columns: Vec<String>,
    /// Where the rows begin.
    start: u64,
    line: u64,
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
    let Some(header) = Header::parse(piece, file, findings) else { return Ok(None) };
    let Header { count, cell, columns, start, line } = header;
    let names: Vec<&str> = columns.iter().map(String::as_str).collect();
    let (layout, places) = match layout(&names, drawing) {
        Ok(found) => found,
        Err(message) => {
            findings.error("columns", || whole(file), || message);
            return Ok(None);
        }
    };
    if drawing.trajectory.is_some() && !names.contains(&"id") {
        let message = || {
            "the atoms have no `id`, by which a trajectory orders them: dumps have them in any order"
                .to_owned()
        };
        findings.error("columns", || whole(file), message);
        return Ok(None);
    }
    let shares = places == Places::Scaled;
    if shares && cell.is_none() {
        let message =
            || "the places are shares of a box, but the file says none that can be used".to_owned();
        findings.error("boxes", || whole(file), message);
        return Ok(None);
    }
    let table = Table { blob, file, limits: input.limits, start, line, count, layout, shares };
    let (mut molecule, more) = table.read(findings)?;
    if more {
        let message = || "the first time step is drawn; others follow it".to_owned();
        findings.note("frames", || whole(file), message);
    }
    if let Some(cell) = cell.filter(|_| shares) {
        molecule.origin = cell.origin;
        let from_corner = Cell { origin: DVec3::ZERO, ..cell };
        for sphere in &mut molecule.spheres {
            let [x, y, z, _] = sphere.map(f64::from);
            let place = from_corner.place(DVec3::new(x, y, z)).as_vec3();
            (sphere[0], sphere[1], sphere[2]) = (place.x, place.y, place.z);
        }
    }
    molecule.cell = cell;
    if drawing.trajectory.is_some() {
        let ids = molecule.numbers("id").unwrap_or_default();
        if ids.iter().any(|id| *id > MOST_IDS) {
            let message =
                || format!("atoms are numbered beyond {MOST_IDS}: a trajectory cannot order them");
            findings.error("trajectories", || whole(file), message);
            return Ok(None);
        }
        molecule.sort_by_column("id");
        if !drawing.uses("id") {
            molecule.columns.retain(|column| column.name != "id");
        }
    }
    Ok(Some(molecule))
}

impl Header {
    fn parse(piece: Piece<'_>, file: &Arc<str>, findings: &mut Findings) -> Option<Self> {
        let mut header = Self::default();
        let mut cursor = Cursor::new(piece, false);
        while !cursor.is_done() {
            let at = cursor.clone();
            let line = cursor.rest_of_line();
            cursor.next_line();
            let Some(item) = line.strip_prefix(b"ITEM: ") else {
                continue;
            };
            let item = String::from_utf8_lossy(item);
            if item == "NUMBER OF ATOMS" {
                let number = cursor.decimal().and_then(Decimal::to_integer);
                header.count = number.and_then(|count| u64::try_from(count).ok());
                if header.count.is_none() {
                    let message = || "the number of atoms is no number".to_owned();
                    findings.error("counts", || cursor.here(file), message);
                    return None;
                }
            } else if let Some(words) = item.strip_prefix("BOX BOUNDS") {
                header.cell = bounds(words, &mut cursor);
            } else if let Some(names) = item.strip_prefix("ATOMS") {
                header.columns = names.split_ascii_whitespace().map(str::to_owned).collect();
                (header.start, header.line) = (cursor.at() as u64, cursor.line);
                if header.count.is_none() {
                    let message =
                        || "`ITEM: NUMBER OF ATOMS` is missing before the atoms".to_owned();
                    findings.error("counts", || at.here(file), message);
                    return None;
                }
                return Some(header);
            }
        }
        let message = || "there is nothing to draw: the file has no `ITEM: ATOMS`".to_owned();
        findings.error("files without atoms", || whole(file), message);
        None
    }
}

/// The box that the next three lines say.
fn bounds(words: &str, cursor: &mut Cursor<'_>) -> Option<Cell> {
    let mut rows = [[0.0; 4]; 3];
    for row in &mut rows {
        for value in row {
            if !cursor.more() {
                break;
            }
            *value = cursor.decimal().map_or(f64::NAN, Decimal::to_f64);
        }
        cursor.next_line();
    }
    let column = |i: usize| DVec3::from(rows.map(|row| row[i]));
    if words.contains("abc origin") {
        let edges = rows.map(|[x, y, z, _]| DVec3::new(x, y, z));
        let cell = Cell { origin: column(3), edges };
        let sound = cell.origin.is_finite() && edges.iter().all(|edge| edge.is_finite());
        return (sound && cell.thickness() > 0.0).then_some(cell);
    }
    if words.contains("xy xz yz") {
        return cell_of_bounds(column(0), column(1), column(2).to_array());
    }
    cell_of(column(0), column(1), [0.0; 3])
}
