//! LAMMPS: dumps and data files.

mod boxes;
mod columns;
mod data;
mod dump;

use crate::diagnostic::Diagnostic;
use crate::fragment::Fragment;

use super::input::Input;

pub(crate) use dump::is_dump;

/// Reads a dump, or, if it does not begin like one, a data file; `None` if a diagnostic is an error.
pub(crate) fn read(input: &Input<'_>, out: &mut Vec<Diagnostic>) -> Option<Fragment> {
    let mut head = [0; 6];
    let read = input.source.open(input.path).and_then(|blob| blob.read_full(&mut head, 0));
    // What cannot be opened is said by the reader.
    if read.is_ok_and(|read| is_dump(&head[..read])) {
        dump::read(input, out)
    } else {
        data::read(input, out)
    }
}
