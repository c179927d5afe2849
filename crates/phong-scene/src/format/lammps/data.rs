//! Data files: a header of counts and the box, then sections.
//!
//! | in the file | read as |
//! |---|---|
//! | `N atoms`, `xlo xhi`, `xy xz yz`, … | counts and the cell |
//! | `Atoms # style` | atoms of the styles that are told below; without the comment the style is that which fits what the first of them hold; where others fit, too, a warning |
//! | lines of comment before the first atom | nothing |
//! | `Masses` | masses in g/mol, by which the elements are known where there is one so heavy |
//! | `Bonds` | all bonds |
//! | other sections | not drawn |

use std::io;
use std::sync::Arc;

use glam::DVec3;

use super::boxes::cell_of;
use super::guess::{Guess, Sample};
use crate::diagnostic::Diagnostic;
use crate::elements::number_of_mass;
use crate::format::atoms::{Layout, Slot, Table, read_atoms};
use crate::format::input::Input;
use crate::format::text::{Cursor, Decimal, Findings, Lines, Piece, Rows, open_text, whole};
use crate::fragment::Fragment;
use crate::molecule::{Cell, Column, Molecule, Values, names};
use crate::source::Blob;

/// Reads a data file; `None` if a diagnostic is an error.
pub(crate) fn read(input: &Input<'_>, out: &mut Vec<Diagnostic>) -> Option<Fragment> {
    read_atoms(input, out, |file, _, findings| {
        let blob = open_text(input.source, input.path, input.limits)?;
        atoms(blob.as_ref(), file, input, findings)
    })
}

/// A line that begins with a letter: a section, or one of the header.
#[derive(Debug)]
struct Heading {
    text: String,
    /// Where the lines that follow begin.
    start: u64,
    line: u64,
}

/// The largest number of an atom that is told from the next one.
pub(super) const MOST_IDS: f32 = (1 << 24) as f32;

/// Headings of a file, at most.
const MOST: usize = 1000;

fn atoms(
    blob: &dyn Blob,
    file: &Arc<str>,
    input: &Input<'_>,
    findings: &mut Findings,
) -> io::Result<Option<Molecule>> {
    let mut header = Header::default();
    let mut sections: Vec<Heading> = Vec::new();
    let lines = Lines { blob, start: 0, line: 1, joined: false, rows: Rows::Uncounted };
    lines.each(headings, |found| {
        for heading in found {
            if !header.line(&heading.text) {
                sections.push(heading);
            }
        }
        sections.len() < MOST
    })?;
    let section = |name: &str| {
        let is = |heading: &&Heading| heading.text.split('#').next().unwrap_or("").trim() == name;
        sections.iter().find(is)
    };
    let (Some(heading), Some(count)) = (section("Atoms"), header.atoms) else {
        let message = || {
            "there is nothing to draw: the file has no section `Atoms`, or does not say how many there are"
                .to_owned()
        };
        findings.error("files without atoms", || whole(file), message);
        return Ok(None);
    };
    let (first, [behind, lines]) = first_rows(blob, heading)?;
    let cell = header.cell();
    let is_whole = heading.start + behind + first.len() as u64 >= blob.len();
    let sample = Sample::new(&first, is_whole, header.types, cell.as_ref());
    let layout = match style(&sample, heading) {
        Ok((layout, doubt)) => {
            if let Some(doubt) = doubt {
                findings.warning("styles", || whole(file), || doubt);
            }
            layout
        }
        Err(message) => {
            findings.error("styles", || whole(file), || message);
            return Ok(None);
        }
    };
    let (start, line) = (heading.start + behind, heading.line + lines);
    let limits = input.limits;
    let table =
        Table { blob, file, limits, start, line, count: Some(count), layout, shares: false };
    let (mut molecule, _) = table.read(findings)?;
    molecule.cell = cell;
    if input.drawing.is_some_and(|drawing| drawing.trajectory.is_some()) {
        // A trajectory has the atoms in the order of their numbers.
        molecule.sort_by_column("id");
    }
    if let Some(masses) = section("Masses") {
        give_elements(&mut molecule, &rows::<2>(blob, masses, header.types)?);
    }
    if let Some(bonds) = section("Bonds") {
        let ids = molecule.numbers("id").map(<[f32]>::to_vec).unwrap_or_default();
        if ids.iter().any(|id| *id > MOST_IDS) {
            let message = || format!("atoms are numbered beyond {MOST_IDS}: bonds are not drawn");
            findings.warning("bonds", || whole(file), message);
            molecule.columns.retain(|column| column.name != "id");
            return Ok(Some(molecule));
        }
        let mut sorted: Vec<(u64, u32)> = ids.iter().map(|id| *id as u64).zip(0..).collect();
        sorted.sort_unstable();
        let find = |id: f64| {
            let at = sorted.binary_search_by_key(&(id as u64), |(id, _)| *id).ok()?;
            Some(sorted[at].1)
        };
        let rows = rows::<4>(blob, bonds, header.bonds)?;
        let bond = |row: &[f64; 4]| Some([find(row[2])?, find(row[3])?]);
        molecule.bonds = rows.iter().filter_map(bond).collect();
        molecule.all_bonds = true;
    }
    molecule.columns.retain(|column| column.name != "id");
    Ok(Some(molecule))
}

/// The headings of a piece.
fn headings(piece: Piece<'_>) -> Vec<Heading> {
    let mut found = Vec::new();
    let mut at = 0;
    for (line, text) in (piece.line..).zip(piece.text.split_inclusive(|b| *b == b'\n')) {
        at += text.len();
        // The first line is a title, whatever it says.
        let trimmed = text.trim_ascii();
        let headed = trimmed.iter().any(u8::is_ascii_alphabetic) && trimmed.len() < 200;
        let row = trimmed
            .iter()
            .take_while(|b| **b != b'#')
            .all(|b| !b.is_ascii_alphabetic() || *b == b'e' || *b == b'E');
        if line > 1 && headed && !row && found.len() < MOST {
            let text = String::from_utf8_lossy(trimmed).into_owned();
            found.push(Heading { text, start: piece.offset + at as u64, line: line + 1 });
        }
    }
    found
}

/// What the lines before the sections say.
#[derive(Debug, Default)]
struct Header {
    atoms: Option<u64>,
    bonds: u64,
    types: u64,
    low: DVec3,
    high: DVec3,
    tilts: [f64; 3],
}

impl Header {
    /// Takes a line in, if it is one of a header.
    fn line(&mut self, text: &str) -> bool {
        let words: Vec<&str> =
            text.split('#').next().unwrap_or_default().split_ascii_whitespace().collect();
        let number = |i: usize| words.get(i).and_then(|word| word.parse::<f64>().ok());
        let count = || words.first().and_then(|word| word.parse::<u64>().ok());
        match words[..] {
            [_, "atoms"] => self.atoms = self.atoms.or(count()),
            [_, "bonds"] => self.bonds = count().unwrap_or(0),
            [_, "atom", "types"] => self.types = count().unwrap_or(0),
            [.., "xlo", "xhi"] => self.bounds(0, number(0), number(1)),
            [.., "ylo", "yhi"] => self.bounds(1, number(0), number(1)),
            [.., "zlo", "zhi"] => self.bounds(2, number(0), number(1)),
            [.., "xy", "xz", "yz"] => {
                self.tilts = [0, 1, 2].map(|i| number(i).unwrap_or(f64::NAN));
            }
            [first, ..] => return first.parse::<f64>().is_ok(),
            [] => return true,
        }
        true
    }

    fn bounds(&mut self, axis: usize, low: Option<f64>, high: Option<f64>) {
        self.low[axis] = low.unwrap_or(f64::NAN);
        self.high[axis] = high.unwrap_or(f64::NAN);
    }

    fn cell(&self) -> Option<Cell> {
        cell_of(self.low, self.high, self.tilts)
    }
}

/// The styles of atoms that are read, and what stands before the place: `i` the number, `m` the molecule,
/// `t` the type, `q` the charge, `d` the diameter.
const STYLES: [(&str, &str); 28] = [
    ("amoeba", "imtq"),
    ("angle", "imt"),
    ("atomic", "it"),
    ("body", "it--"),
    ("bond", "imt"),
    ("bpm/sphere", "imtd-"),
    ("charge", "itq"),
    ("dielectric", "imtq"),
    ("dipole", "itq"),
    ("dpd", "it-"),
    ("edpd", "it--"),
    ("electron", "itq--"),
    ("ellipsoid", "it--"),
    ("full", "imtq"),
    // What its styles have stands behind the place.
    ("hybrid", "it"),
    ("line", "imt--"),
    ("mdpd", "it-"),
    ("mesont", "imt------"),
    ("molecular", "imt"),
    ("peri", "it--"),
    ("smd", "itm-------"),
    ("sph", "it---"),
    ("sphere", "itd-"),
    ("spin", "it"),
    ("tdpd", "it"),
    ("template", "im--t"),
    ("tri", "imt--"),
    ("wavepacket", "itq-----"),
];

/// The layout of atoms of the style that the heading says, or that fits the first of them; and what is to be
/// said of that.
fn style(first: &Sample<'_>, heading: &Heading) -> Result<(Layout, Option<String>), String> {
    // A style is one word; several are a remark, unless the first is a style: `hybrid` names others.
    let named = heading.text.split('#').nth(1).map(str::trim).unwrap_or_default();
    let mut words = named.split_ascii_whitespace();
    let named = match (words.next(), words.next()) {
        (Some(first @ "hybrid"), Some(_)) => first,
        (Some(first), Some(_)) if STYLES.iter().any(|(style, _)| *style == first) => {
            return Err(format!("atoms of the style `{named}` are not read"));
        }
        (Some(style), None) => style,
        // What its columns are may stand behind a colon.
        (Some(first), Some(_)) if first.ends_with(':') => first.trim_end_matches(':'),
        _ => "",
    };
    if named.is_empty() {
        let Guess { before, doubt } = first.guess()?;
        return Ok((layout(before), doubt));
    }
    let known = STYLES.iter().find(|(style, _)| *style == named);
    let unread = || format!("atoms of the style `{named}` are not read");
    known.map(|(_, before)| (layout(before), None)).ok_or_else(unread)
}

/// The layout of rows with this before the place, as in [`STYLES`].
fn layout(before: &str) -> Layout {
    let mut layout = Layout { slots: Vec::new(), columns: Vec::new(), bytes: false };
    for letter in before.chars() {
        let (name, words) = match letter {
            'i' => ("id", false),
            'm' => (names::MOLECULE, true),
            't' => (names::TYPE, true),
            'q' => (names::CHARGE, false),
            'd' => {
                layout.slots.push(Slot::Radius(0.5));
                continue;
            }
            _ => {
                layout.slots.push(Slot::Skip);
                continue;
            }
        };
        layout.slots.push(Slot::Column(layout.columns.len()));
        layout.columns.push(if words { Column::of_words(name) } else { Column::of_numbers(name) });
    }
    layout.slots.extend([0, 1, 2].map(Slot::Place));
    layout
}

/// Where the line of the first row of a section begins: how far behind the heading, and how many lines; and
/// the text from there on.
fn first_rows(blob: &dyn Blob, heading: &Heading) -> io::Result<(Vec<u8>, [u64; 2])> {
    let mut text = vec![0; 16 << 10];
    let read = blob.read_full(&mut text, heading.start)?;
    let piece = Piece { text: &text[..read], offset: 0, line: 1, rows: 0 };
    let mut cursor = Cursor::new(piece, false);
    let is_remark = |cursor: &Cursor<'_>| {
        let mut cursor = cursor.clone();
        !cursor.more() || cursor.rest().starts_with(b"#")
    };
    while is_remark(&cursor) && !cursor.is_done() {
        cursor.next_line();
    }
    let at = [cursor.at() as u64, cursor.line - 1];
    Ok((text[cursor.at()..read].to_vec(), at))
}

/// The first `N` numbers of each of so many rows of a section.
fn rows<const N: usize>(
    blob: &dyn Blob,
    heading: &Heading,
    count: u64,
) -> io::Result<Vec<[f64; N]>> {
    let Heading { start, line, .. } = *heading;
    let lines = Lines { blob, start, line, joined: false, rows: Rows::All };
    let mut all = Vec::new();
    lines.each(
        |piece| {
            let mut cursor = Cursor::new(piece, false);
            let mut found = Vec::new();
            let mut row = piece.rows;
            while !cursor.is_done() && row < count {
                if !cursor.is_blank() {
                    let mut numbers = [f64::NAN; N];
                    for number in &mut numbers {
                        if cursor.more() {
                            *number = cursor.decimal().map_or(f64::NAN, Decimal::to_f64);
                        }
                    }
                    found.push(numbers);
                    row += 1;
                }
                cursor.next_line();
            }
            (found, row < count)
        },
        |(mut found, go_on)| {
            all.append(&mut found);
            go_on
        },
    )?;
    Ok(all)
}

/// Gives atoms the elements that the masses of their types are nearest to, if every type has one.
fn give_elements(molecule: &mut Molecule, masses: &[[f64; 2]]) {
    let Some(Values::Words(types)) = molecule.column(names::TYPE).map(|column| &column.values)
    else {
        return;
    };
    let element = |name: &String| {
        let number = name.parse::<f64>().ok()?;
        let [_, mass] = masses.iter().find(|[of, _]| *of == number)?;
        number_of_mass(*mass)
    };
    let elements: Option<Vec<u8>> = types.names.iter().map(element).collect();
    if let Some(elements) = elements {
        molecule.elements = types.numbers.iter().map(|number| elements[*number as usize]).collect();
    }
}
