//! DCD, of CHARMM, NAMD and LAMMPS: where atoms are, frame by frame, in single precision. Which atoms they are
//! is said by another file, whose places it replaces.
//!
//! | in the file | read as |
//! |---|---|
//! | the order of the bytes | either |
//! | the number of frames | that which the file's length says; another number is a warning |
//! | fixed atoms | those of the first frame, in every frame |
//! | the cell | lengths with angles, or their cosines, or CHARMM's matrix; the topology's where there is none |
//! | a fourth coordinate | not used |
//!
//! A frame that is cut short, or records whose two lengths differ, are errors at their byte.

mod header;

use glam::DVec3;

pub(crate) use self::header::{Header, is_dcd};
use super::frame::{Fault, Frame};
use crate::source::Blob;

/// Reads the first frame, or the last, of a trajectory of so many atoms.
pub(crate) fn read(blob: &dyn Blob, last: bool, atoms: u64) -> Result<Frame, Fault> {
    let header = Header::read(blob)?;
    if header.atoms != atoms {
        let message = format!("it has {} atoms, but the file of atoms has {atoms}", header.atoms);
        return Err(Fault::Broken(message));
    }
    let count = header.count(blob.len());
    if count == 0 {
        let end = header.start + header.first_bytes();
        let message = if blob.len() == header.start {
            "it has no frame".to_owned()
        } else {
            format!(
                "its first frame is cut short: it would end at byte {end}, the file at {}",
                blob.len()
            )
        };
        return Err(Fault::Broken(message));
    }
    let number = if last { count - 1 } else { 0 };
    let mut places = vec![DVec3::ZERO; usize::try_from(atoms).unwrap_or(0)];
    if number > 0 && header.has_fixed() {
        header.frame(blob, 0, &mut places)?;
    }
    let cell = header.frame(blob, number, &mut places)?;
    Ok(Frame { places, cell, count, said: header.said, broken: None })
}
