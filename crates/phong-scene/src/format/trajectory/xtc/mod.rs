//! XTC, of GROMACS: where atoms are, frame by frame, rounded and packed.
//!
//! | in the file | read as |
//! |---|---|
//! | the number of atoms | that of the file of atoms; another one is an error |
//! | places | in nanometres, times ten; of ten atoms and more unpacked, with the precision of the frame |
//! | the box | the cell; the topology's where there is none |
//! | step, time | not used |
//! | frames of both kinds, of 1995 and of 2023 | both: they differ in how long packed places may be |
//!
//! A frame that is cut short, places that contradict what is said of them, and more or fewer of them than there
//! are atoms, are errors.

mod bits;
mod places;

use glam::DVec3;

use self::bits::Bits;
use self::places::Packing;
use super::frame::{Fault, Frame};
use crate::molecule::Cell;
use crate::source::Blob;

/// What begins a frame: of files with packed places of less than 2 GiB a frame, and of others.
const SMALL: u32 = 1995;
const LARGE: u32 = 2023;

/// Bytes before the places: two numbers to know it by, step and time, the box, and how many places there are.
const HEAD: usize = 56;

/// Bytes before packed places, but for their length.
const PACKING: usize = 32;

/// So many places are not packed.
const FEW: u64 = 9;

/// Whether a file begins like one.
pub(super) fn is_xtc(head: &[u8]) -> bool {
    [SMALL, LARGE].iter().any(|magic| head.starts_with(&magic.to_be_bytes()))
}

/// What a frame says of itself.
#[derive(Debug)]
pub(super) struct Header {
    atoms: u64,
    cell: Option<Cell>,
    packing: Option<Packing>,
    /// The first byte of the places, and the first behind them.
    places: [u64; 2],
    /// The first byte behind the frame.
    pub(super) end: u64,
}

impl Header {
    /// Reads that of the frame that begins there; a frame that is cut short is an error.
    pub(super) fn read(blob: &dyn Blob, start: u64) -> Result<Self, Fault> {
        let broken = |what: &str| Err(Fault::Broken(format!("byte {start}: {what}")));
        let cut = "the frame is cut short";
        let mut head = [0; HEAD];
        if blob.read_full(&mut head, start)? < HEAD {
            return broken(cut);
        }
        if !is_xtc(&head) {
            return broken("no frame of an XTC begins here");
        }
        let large = head.starts_with(&LARGE.to_be_bytes());
        let word = |bytes: &[u8], i: usize| -> [u8; 4] {
            bytes.get(4 * i..).and_then(<[u8]>::first_chunk).copied().unwrap_or_default()
        };
        let number = |bytes: &[u8], i: usize| f64::from(f32::from_be_bytes(word(bytes, i)));
        let atoms = i32::from_be_bytes(word(&head, 1));
        let places = i32::from_be_bytes(word(&head, 13));
        let Some(count) = u64::try_from(atoms).ok().filter(|atoms| *atoms > 0) else {
            return broken(&format!("{atoms} is not how many atoms a frame has"));
        };
        if places != atoms {
            return broken(&format!("the frame has {atoms} atoms, but {places} places"));
        }
        let edges = [0, 3, 6]
            .map(|row| DVec3::from([0, 1, 2].map(|column| 10.0 * number(&head, 4 + row + column))));
        let cell = Cell { origin: DVec3::ZERO, edges };
        let sound = edges.iter().all(|edge| edge.is_finite()) && cell.thickness() > 1e-6;
        let begin = start + HEAD as u64;
        let mut header = Self {
            atoms: count,
            cell: sound.then_some(cell),
            packing: None,
            places: [begin, begin + 12 * count],
            end: begin + 12 * count,
        };
        if count > FEW {
            let mut words = [0; PACKING + 8];
            let length = PACKING + if large { 8 } else { 4 };
            if blob.read_full(&mut words[..length], begin)? < length {
                return broken(cut);
            }
            let whole = |i: usize| i32::from_be_bytes(word(&words, i));
            header.packing = Some(Packing {
                precision: f32::from_be_bytes(word(&words, 0)),
                least: [1, 2, 3].map(whole),
                greatest: [4, 5, 6].map(whole),
                index: u32::from_be_bytes(word(&words, 7)),
            });
            let mut bytes = u64::from(u32::from_be_bytes(word(&words, 8)));
            if large {
                bytes = bytes << 32 | u64::from(u32::from_be_bytes(word(&words, 9)));
            }
            let begin = begin + length as u64;
            let end = begin.checked_add(bytes).and_then(|end| {
                Some((end, begin.checked_add(bytes.checked_next_multiple_of(4)?)?))
            });
            let Some((end, padded)) = end else {
                return broken(&format!("its packed places would take {bytes} bytes"));
            };
            header.places = [begin, end];
            header.end = padded;
        }
        if header.end > blob.len() {
            return broken(&format!(
                "{cut}: it would end at byte {}, the file at {}",
                header.end,
                blob.len()
            ));
        }
        Ok(header)
    }

    /// The places of the frame, in ångström.
    fn unpack(&self, blob: &dyn Blob) -> Result<Vec<DVec3>, Fault> {
        let [start, end] = self.places;
        let mut bits = Bits::new(blob, start, end);
        let mut places = vec![DVec3::ZERO; usize::try_from(self.atoms).unwrap_or(0)];
        if let Some(packing) = &self.packing {
            packing.unpack(&mut bits, &mut places)?;
            return Ok(places);
        }
        for place in &mut places {
            for axis in 0..3 {
                place[axis] = 10.0 * f64::from(f32::from_bits(bits.take(32)?));
            }
        }
        Ok(places)
    }
}

/// Reads the first frame of a trajectory of so many atoms.
pub(super) fn read(blob: &dyn Blob, atoms: u64) -> Result<Frame, Fault> {
    let header = Header::read(blob, 0)?;
    if header.atoms != atoms {
        let message = format!("it has {} atoms, but the file of atoms has {atoms}", header.atoms);
        return Err(Fault::Broken(message));
    }
    let places = header.unpack(blob)?;
    let (mut count, mut next, mut broken) = (1, header.end, None);
    while next < blob.len() && broken.is_none() {
        match Header::read(blob, next) {
            Ok(header) => (count, next) = (count + 1, header.end),
            Err(Fault::Io(error)) => return Err(Fault::Io(error)),
            Err(Fault::Broken(message)) => broken = Some(message),
        }
    }
    Ok(Frame { places, cell: header.cell, count, said: 0, broken })
}
