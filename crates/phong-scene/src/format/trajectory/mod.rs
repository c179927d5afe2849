//! Trajectories of which each frame says where atoms are. Which atoms they are is said by another file, whose places
//! they replace.

mod dcd;
mod frame;
mod sections;
#[cfg(test)]
mod tests;
mod xtc;

use self::frame::head_of;
pub(crate) use self::frame::{Fault, Frame};
pub(crate) use self::sections::{Sections, sections};
use crate::source::Blob;

/// Whether a file begins as DCD files of either order of bytes do, or as XTC or TRR files.
pub(crate) fn is_trajectory(head: &[u8]) -> bool {
    dcd::is_dcd(head) || xtc::is_xtc(head) || is_trr(head)
}

fn is_trr(head: &[u8]) -> bool {
    head.starts_with(&1993_u32.to_be_bytes())
}

/// Reads the first frame, or the last, of a trajectory of so many atoms.
pub(crate) fn read(blob: &dyn Blob, last: bool, atoms: u64) -> Result<Frame, Fault> {
    let head = head_of(blob)?;
    if xtc::is_xtc(&head) {
        // A source of single frames has no other before.
        return xtc::read(blob, atoms);
    }
    if is_trr(&head) {
        let message = "it is a TRR file, which is not read; `gmx trjconv -f a.trr -o a.xtc` makes an XTC of it";
        return Err(Fault::Broken(message.to_owned()));
    }
    dcd::read(blob, last, atoms)
}
