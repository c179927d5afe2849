//! Rows of words, one atom each, parsed in parallel.

use std::io;
use std::sync::Arc;

use glam::DVec3;

use super::{has_room, tell_truncated};
use crate::color::{Rgb, srgb_decode};
use crate::elements::number_of_label;
use crate::format::origin::{SAMPLES, origin_of};
use crate::format::text::{Cursor, Decimal, Findings, Lines, Piece, Rows, blame};
use crate::limits::{LARGEST, Limits};
use crate::molecule::{Column, Molecule};
use crate::source::Blob;

/// Bytes that are looked through for places at each point of the file that is sampled.
const SAMPLE: usize = 4 << 10;

/// What a word of a row is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Slot {
    /// Nothing that is used.
    Skip,
    /// A coordinate.
    Place(usize),
    /// An element's symbol or number, or a label that begins with a symbol.
    Element,
    /// The same, which is kept in a column as well.
    Label(usize),
    /// The value of a column.
    Column(usize),
    /// The colour's red, green or blue.
    Color(usize),
    /// The radius, or as much of it.
    Radius(f32),
}

/// How the words of rows follow one another.
#[derive(Clone, Debug)]
pub(crate) struct Layout {
    pub(crate) slots: Vec<Slot>,
    /// The columns, empty.
    pub(crate) columns: Vec<Column>,
    /// Whether colours are bytes.
    pub(crate) bytes: bool,
}

/// A table of atoms in a text.
pub(crate) struct Table<'a> {
    pub(crate) blob: &'a dyn Blob,
    pub(crate) file: &'a Arc<str>,
    pub(crate) limits: &'a Limits,
    /// Where the rows begin, and the number of their first line.
    pub(crate) start: u64,
    pub(crate) line: u64,
    /// How many there are; `None`: up to the end.
    pub(crate) count: Option<u64>,
    pub(crate) layout: Layout,
    /// Whether places are shares of a cell, which have no origin.
    pub(crate) shares: bool,
}

/// What a piece of the table holds.
#[derive(Debug, Default)]
struct Block {
    molecule: Molecule,
    rows: u64,
    /// Whether lines follow the last row.
    more: bool,
    findings: Findings,
}

impl Table<'_> {
    /// Reads all rows; and whether anything follows them.
    pub(crate) fn read(&self, findings: &mut Findings) -> io::Result<(Molecule, bool)> {
        let mut all = Molecule::default();
        let least = 2 * self.layout.slots.len().max(1) as u64;
        // As many as the file has room for; a last line may lack its end.
        let room = (self.blob.len().saturating_sub(self.start) + 1) / least;
        if let Some(count) = self.count.filter(|count| *count <= self.limits.vertices) {
            all.spheres.reserve_exact(count.min(room) as usize);
        }
        let origin = if self.shares { DVec3::ZERO } else { origin_of(self.sample()?) };
        let lines = Lines {
            blob: self.blob,
            start: self.start,
            line: self.line,
            joined: false,
            rows: Rows::All,
        };
        let (mut rows, mut more) = (0, false);
        lines.each(
            |piece| self.parse(piece, origin),
            |block| {
                rows += block.rows;
                more |= block.more;
                findings.append(block.findings);
                all.append(block.molecule);
                !block.more && has_room(&all, self.limits, self.file, findings)
            },
        )?;
        if let Some(count) = self.count.filter(|count| rows < *count)
            && !findings.any_error()
        {
            tell_truncated(rows, count, self.limits, self.file, findings);
        }
        all.origin = origin;
        Ok((all, more))
    }

    fn parse(&self, piece: Piece<'_>, origin: DVec3) -> Block {
        let mut block = Block::default();
        block.molecule.columns.clone_from(&self.layout.columns);
        let mut cursor = Cursor::new(piece, false);
        let mut row = piece.rows;
        let colored = self.layout.slots.iter().any(|slot| matches!(slot, Slot::Color(_)));
        while !cursor.is_done() {
            if cursor.is_blank() {
                cursor.next_line();
                continue;
            }
            if self.count.is_some_and(|count| row >= count) {
                block.more = true;
                break;
            }
            self.row(&mut cursor, origin, colored, &mut block);
            row += 1;
            block.rows += 1;
            cursor.next_line();
        }
        block
    }

    /// Reads a row; what cannot be used of it is said, and an atom without a place is NaN.
    fn row(&self, cursor: &mut Cursor<'_>, origin: DVec3, colored: bool, block: &mut Block) {
        let Block { molecule, findings, .. } = block;
        let mut sphere = [0.0; 4];
        let mut color = [f32::NAN; 3];
        let mut element = None;
        for slot in &self.layout.slots {
            if !cursor.more() {
                // A comment, or nothing: the row ends early.
                sphere[0] = f32::NAN;
                if findings.any_error() || *slot == Slot::Skip {
                    fill(*slot, molecule, &mut element);
                    continue;
                }
                let span = || cursor.here(self.file);
                let wanted = self.layout.slots.len();
                findings.error("rows that end early", span, || {
                    format!("the line ends before the {wanted} values of an atom")
                });
                fill(*slot, molecule, &mut element);
                continue;
            }
            match slot {
                Slot::Skip => skip(cursor),
                Slot::Place(axis) => {
                    sphere[*axis] = self.coordinate(cursor, origin[*axis], findings);
                }
                Slot::Radius(scale) => {
                    sphere[3] = match cursor.float(0.0) {
                        Some(radius) if radius > 0.0 => radius * scale,
                        _ => self.no_radius(cursor, findings),
                    };
                }
                Slot::Color(channel) => color[*channel] = number(cursor),
                Slot::Element => element = Some(element_of(cursor.word())),
                Slot::Label(column) => {
                    let word = cursor.word();
                    element = Some(element_of(word));
                    molecule.columns[*column].values.push_word(word);
                }
                Slot::Column(column) => match &mut molecule.columns[*column].values {
                    crate::molecule::Values::Numbers(numbers) => numbers.push(number(cursor)),
                    crate::molecule::Values::Words(words) => words.push(cursor.word()),
                },
            }
        }
        molecule.spheres.push(sphere);
        if let Some(element) = element {
            molecule.elements.push(element);
        }
        if colored {
            molecule.colors.push(self.color(color));
        }
    }

    /// The next number less `origin`; NaN if it is none, which is said.
    fn coordinate(&self, cursor: &mut Cursor<'_>, origin: f64, findings: &mut Findings) -> f32 {
        let place = cursor.clone();
        if let Some(value) = cursor.float(origin).filter(|c| c.abs() <= LARGEST as f32) {
            return value;
        }
        *cursor = place.clone();
        let number = cursor.decimal().is_some();
        *cursor = place.clone();
        if number || cursor.take_no_number() {
            if number {
                skip(cursor);
            }
            let what = if number { "is too large" } else { "is no number" };
            findings.warning(
                "atoms that are left out",
                || place.here(self.file),
                || format!("`{}` {what}: the atom is left out", place.quote()),
            );
        } else {
            skip(cursor);
            findings.error(
                "places that cannot be read",
                || place.here(self.file),
                || format!("`{}` {}", place.quote(), blame(place.rest())),
            );
        }
        f32::NAN
    }

    fn no_radius(&self, cursor: &mut Cursor<'_>, findings: &mut Findings) -> f32 {
        let place = cursor.clone();
        if !cursor.take_no_number() && cursor.decimal().is_none() && !cursor.is_blank() {
            skip(cursor);
        }
        findings.warning(
            "atoms that are left out",
            || place.here(self.file),
            || "the radius of an atom is not above 0: the atom is left out".to_owned(),
        );
        f32::NAN
    }

    fn color(&self, color: [f32; 3]) -> Rgb {
        let sound = color.iter().all(|c| c.is_finite() && *c >= 0.0);
        let color = if sound { color } else { [0.5; 3] };
        if self.layout.bytes && sound {
            return Rgb::from(color.map(|c| srgb_decode(f64::from(c.min(255.0) / 255.0)) as f32));
        }
        Rgb::from(color)
    }

    /// Places from all over the table.
    fn sample(&self) -> io::Result<Vec<DVec3>> {
        let mut samples = Vec::new();
        let mut text = vec![0; SAMPLE];
        let length = self.blob.len().saturating_sub(self.start);
        let step = (length / SAMPLES as u64).max(SAMPLE as u64);
        for place in 0..SAMPLES as u64 {
            let read = self.blob.read_full(&mut text, self.start + place * step)?;
            let whole = text[..read].iter().rposition(|&b| b == b'\n').map_or(read, |end| end + 1);
            let piece = Piece { text: &text[..whole], offset: 0, line: 1, rows: 0 };
            let mut cursor = Cursor::new(piece, false);
            if place > 0 {
                // It began before.
                cursor.next_line();
            }
            let wanted = samples.len() + SAMPLES;
            while !cursor.is_done() && samples.len() < wanted {
                let mut at = DVec3::NAN;
                for slot in &self.layout.slots {
                    if !cursor.more() {
                        break;
                    }
                    match slot {
                        Slot::Place(axis) => {
                            at[*axis] = cursor.decimal().map_or(f64::NAN, Decimal::to_f64);
                        }
                        _ => skip(&mut cursor),
                    }
                }
                if at.is_finite() {
                    samples.push(at);
                }
                cursor.next_line();
            }
            if read < SAMPLE {
                break;
            }
        }
        Ok(samples)
    }
}

/// What stands for a value that the row does not have.
fn fill(slot: Slot, molecule: &mut Molecule, element: &mut Option<u8>) {
    match slot {
        Slot::Element => *element = Some(0),
        Slot::Label(column) | Slot::Column(column) => {
            molecule.columns[column].values.push_word(b"");
            if matches!(slot, Slot::Label(_)) {
                *element = Some(0);
            }
        }
        Slot::Skip | Slot::Place(_) | Slot::Color(_) | Slot::Radius(_) => {}
    }
}

/// Whether a word is a whole number without a point.
pub(crate) fn is_integer(word: &[u8]) -> bool {
    let digits = word.strip_prefix(b"-").unwrap_or(word);
    !digits.is_empty() && digits.iter().all(u8::is_ascii_digit)
}

/// Goes over a word.
#[inline]
fn skip(cursor: &mut Cursor<'_>) {
    let rest = cursor.rest();
    cursor.skip(rest.iter().position(|b| *b <= b' ').unwrap_or(rest.len()));
}

/// The next word as a number; NaN if it is none.
fn number(cursor: &mut Cursor<'_>) -> f32 {
    if let Some(number) = cursor.float(0.0) {
        number
    } else {
        skip(cursor);
        f32::NAN
    }
}

/// The element that a symbol, a label or an atomic number stands for; 0: none that is known.
fn element_of(word: &[u8]) -> u8 {
    if word.first().is_some_and(u8::is_ascii_digit) {
        let number = str::from_utf8(word).ok().and_then(|word| word.parse::<u8>().ok());
        return number.filter(|number| *number <= 118).unwrap_or(0);
    }
    number_of_label(word).unwrap_or(0)
}
