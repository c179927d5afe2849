//! What stands before the frames, and where each of them is.

use glam::DVec3;

use super::super::frame::Fault;
use crate::molecule::Cell;
use crate::source::Blob;

/// Bytes of the first record.
const FIRST: u32 = 84;

/// Records between which a value stands: their length before and behind.
const MARKS: u64 = 8;

/// Bytes that are read at a time.
const PIECE: usize = 1 << 16;

/// Whether a file begins like one.
pub(crate) fn is_dcd(head: &[u8]) -> bool {
    let begins = |number: [u8; 4]| head.starts_with(&number);
    let marked = begins(FIRST.to_le_bytes()) || begins(FIRST.to_be_bytes());
    marked && head.get(4..8) == Some(b"CORD")
}

/// What the file says of its frames.
#[derive(Debug)]
pub(crate) struct Header {
    little: bool,
    /// How many frames it says to have.
    pub(super) said: u64,
    /// How many atoms a frame has.
    pub(super) atoms: u64,
    has_cell: bool,
    has_fourth: bool,
    /// The atoms that move, from 0; empty: all.
    pub(super) free: Vec<u32>,
    /// Where the first frame begins.
    pub(crate) start: u64,
}

/// A record: its first byte, and how many bytes it has.
#[derive(Clone, Copy)]
struct Record {
    start: u64,
    bytes: u64,
}

impl Header {
    /// Reads it; a file that is shorter than it says is an error.
    pub(crate) fn read(blob: &dyn Blob) -> Result<Self, Fault> {
        let mut first = [0; 4 + FIRST as usize];
        let length = blob.read_full(&mut first, 0)?;
        if length < first.len() || !is_dcd(&first) {
            return Err(Fault::Broken("it is no DCD: it does not begin as one".to_owned()));
        }
        let little = first[..4] == FIRST.to_le_bytes();
        let mut header = Self {
            little,
            said: 0,
            atoms: 0,
            has_cell: false,
            has_fourth: false,
            free: Vec::new(),
            start: 0,
        };
        let number = |i: usize| header.integer(&first[8 + 4 * i..]);
        let [said, fixed, cell, fourth, version] = [0, 8, 10, 11, 19].map(number);
        header.said = u64::try_from(said).unwrap_or(0);
        // X-PLOR's files are of version 0, and have neither cells nor a fourth coordinate.
        header.has_cell = version != 0 && cell != 0;
        header.has_fourth = version != 0 && fourth != 0;
        let first = header.record(blob, 0, Some(FIRST.into()))?;
        let titles = header.titles(blob, first.end())?;
        let count = header.record(blob, titles.end(), Some(4))?;
        let mut bytes = [0; 4];
        blob.read_full(&mut bytes, count.start)?;
        let atoms = header.integer(&bytes);
        let fault = |message: String| Err(Fault::Broken(message));
        let Some(atoms) = u64::try_from(atoms).ok().filter(|atoms| *atoms > 0) else {
            return fault(format!(
                "byte {}: {atoms} is not how many atoms a frame has",
                count.start
            ));
        };
        header.atoms = atoms;
        header.start = count.end();
        if fixed != 0 {
            let moving = u64::try_from(fixed).ok().and_then(|fixed| atoms.checked_sub(fixed));
            let Some(moving) = moving.filter(|moving| *moving > 0) else {
                return fault(format!(
                    "of its {atoms} atoms {fixed} are fixed, so that none moves"
                ));
            };
            let record = header.record(blob, header.start, Some(4 * moving))?;
            let mut free = Vec::with_capacity(usize::try_from(moving).unwrap_or(0));
            words(blob, record, |bytes| free.push(bytes))?;
            let known = |bytes: [u8; 4]| {
                let number = u64::try_from(header.integer(&bytes)).ok()?.checked_sub(1)?;
                u32::try_from(number).ok().filter(|number| u64::from(*number) < atoms)
            };
            let Some(free) = free.into_iter().map(known).collect() else {
                let at = record.start;
                return fault(format!("byte {at}: an atom that moves is not among the {atoms}"));
            };
            header.free = free;
            header.start = record.end();
        }
        Ok(header)
    }

    fn integer(&self, bytes: &[u8]) -> i32 {
        let bytes = bytes.first_chunk().copied().unwrap_or_default();
        if self.little { i32::from_le_bytes(bytes) } else { i32::from_be_bytes(bytes) }
    }

    fn number(&self, bytes: [u8; 4]) -> f32 {
        if self.little { f32::from_le_bytes(bytes) } else { f32::from_be_bytes(bytes) }
    }

    /// The whole number that stands there; `None`: it is below 0, or the file ends before.
    fn mark(&self, blob: &dyn Blob, at: u64) -> Result<Option<u64>, Fault> {
        let mut bytes = [0; 4];
        let whole = blob.read_full(&mut bytes, at)? == 4;
        Ok(u64::try_from(self.integer(&bytes)).ok().filter(|_| whole))
    }

    /// The record of the titles: how many there are, then 80 bytes each. Some programs write more titles than the
    /// record's length has room for, so that their number counts.
    fn titles(&self, blob: &dyn Blob, at: u64) -> Result<Record, Fault> {
        if let [Some(length), Some(count)] = [self.mark(blob, at)?, self.mark(blob, at + 4)?] {
            let record = Record { start: at + 4, bytes: 4 + 80 * count };
            if self.mark(blob, record.start + record.bytes)? == Some(length) {
                return Ok(record);
            }
        }
        self.record(blob, at, None)
    }

    /// The record that begins there, of this length if one is given.
    fn record(&self, blob: &dyn Blob, at: u64, wanted: Option<u64>) -> Result<Record, Fault> {
        let mark = |at: u64| self.mark(blob, at);
        let broken = |what: String| Err(Fault::Broken(format!("byte {at}: {what}")));
        let Some(bytes) = mark(at)? else {
            return broken("a record is missing, or its length is no number".to_owned());
        };
        if let Some(wanted) = wanted.filter(|wanted| *wanted != bytes) {
            return broken(format!("a record has {bytes} bytes, where {wanted} are wanted"));
        }
        let record = Record { start: at + 4, bytes };
        if mark(record.start + bytes)? != Some(bytes) {
            return broken(format!("a record of {bytes} bytes does not end where it says"));
        }
        Ok(record)
    }

    /// How many bytes a frame takes of so many atoms.
    fn bytes(&self, atoms: u64) -> u64 {
        let cell = if self.has_cell { 48 + MARKS } else { 0 };
        let coordinates = if self.has_fourth { 4 } else { 3 };
        cell + coordinates * (4 * atoms + MARKS)
    }

    /// The bytes of the first frame.
    pub(crate) fn first_bytes(&self) -> u64 {
        self.bytes(self.atoms)
    }

    /// The bytes of the others, in which fixed atoms are not told again.
    pub(crate) fn other_bytes(&self) -> u64 {
        self.bytes(if self.free.is_empty() { self.atoms } else { self.free.len() as u64 })
    }

    /// Whether frames tell of the atoms that move alone, but for the first.
    pub(crate) fn has_fixed(&self) -> bool {
        !self.free.is_empty()
    }

    /// How many whole frames there are in a file of this length.
    pub(crate) fn count(&self, length: u64) -> u64 {
        let rest = length.saturating_sub(self.start);
        rest.checked_sub(self.first_bytes()).map_or(0, |rest| 1 + rest / self.other_bytes())
    }

    /// Reads the places of a frame, of the atoms that it tells of; and its cell.
    pub(super) fn frame(
        &self,
        blob: &dyn Blob,
        number: u64,
        places: &mut [DVec3],
    ) -> Result<Option<Cell>, Fault> {
        let mut at = self.start;
        if number > 0 {
            at += self.first_bytes() + (number - 1) * self.other_bytes();
        }
        let mut cell = None;
        if self.has_cell {
            let record = self.record(blob, at, Some(48))?;
            let mut bytes = [0; 48];
            blob.read_full(&mut bytes, record.start)?;
            let (words, _) = bytes.as_chunks();
            let little = self.little;
            let number = |word: &[u8; 8]| {
                if little { f64::from_le_bytes(*word) } else { f64::from_be_bytes(*word) }
            };
            let mut numbers = [0.0; 6];
            numbers.iter_mut().zip(words).for_each(|(to, word)| *to = number(word));
            cell = cell_of(numbers);
            at = record.end();
        }
        let moving = number > 0 && !self.free.is_empty();
        let count = if moving { self.free.len() as u64 } else { self.atoms };
        for axis in 0..3 {
            let record = self.record(blob, at, Some(4 * count))?;
            let mut next = 0;
            words(blob, record, |word| {
                let atom =
                    if moving { self.free.get(next).map(|f| *f as usize) } else { Some(next) };
                if let Some(place) = atom.and_then(|atom| places.get_mut(atom)) {
                    place[axis] = self.number(word).into();
                }
                next += 1;
            })?;
            at = record.end();
        }
        Ok(cell)
    }
}

/// Hands over a record's words of four bytes, in order.
fn words(blob: &dyn Blob, record: Record, mut take: impl FnMut([u8; 4])) -> Result<(), Fault> {
    let mut buffer = vec![0; (record.bytes.min(PIECE as u64)) as usize];
    let mut at = 0;
    while at < record.bytes {
        let length = (record.bytes - at).min(PIECE as u64) as usize;
        let read = blob.read_full(&mut buffer[..length], record.start + at)?;
        if read < length {
            return Err(Fault::Broken("the file became shorter while it was read".to_owned()));
        }
        let (words, _) = buffer[..length].as_chunks();
        for word in words {
            take(*word);
        }
        at += length as u64;
    }
    Ok(())
}

impl Record {
    /// The first byte behind it.
    fn end(self) -> u64 {
        self.start + self.bytes + 4
    }
}

/// The cell: lengths and angles in the order `a γ b β α c`, with cosines in place of angles where all are so
/// small; or, where no angles could be so, CHARMM's symmetric matrix.
fn cell_of([a, gamma, b, beta, alpha, c]: [f64; 6]) -> Option<Cell> {
    let angles = [alpha, beta, gamma];
    if angles.iter().all(|angle| angle.abs() <= 1.0) {
        // Exactly right angles stay so.
        let degrees =
            |cosine: f64| if cosine == 0.0 { 90.0 } else { libm::acos(cosine).to_degrees() };
        return Cell::of_angles([a, b, c], angles.map(degrees));
    }
    if angles.iter().all(|angle| *angle > 0.0 && *angle < 180.0) {
        return Cell::of_angles([a, b, c], angles);
    }
    let edges = [[a, gamma, beta], [gamma, b, alpha], [beta, alpha, c]].map(DVec3::from);
    let cell = Cell { origin: DVec3::ZERO, edges };
    let sound = edges.iter().all(|edge| edge.is_finite()) && cell.thickness() > 1e-6;
    sound.then_some(cell)
}
