//! LAMMPS: dumps and data files.

mod boxes;
mod columns;
mod data;
mod dump;
mod guess;

use crate::diagnostic::Diagnostic;
use crate::fragment::Fragment;

use super::input::Input;

pub(crate) use dump::is_dump;

/// Whether a file that begins so is surely one: a dump, or a data file with its number of atoms and its box.
pub(crate) fn is_lammps(head: &[u8]) -> bool {
    let (mut atoms, mut edge) = (false, false);
    // The first line of a data file is a title.
    for line in head.split(|b| *b == b'\n').skip(1) {
        let line = line.split(|b| *b == b'#').next().unwrap_or_default();
        let mut words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        let is_count = words.next().is_some_and(|word| word.iter().all(u8::is_ascii_digit));
        atoms |= is_count && words.eq([b"atoms"]);
        edge |= line.trim_ascii_end().ends_with(b"xlo xhi");
    }
    is_dump(head) || atoms && edge
}

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn data_files_are_told_by_their_count_and_box() {
        assert!(is_lammps(b"ITEM: TIMESTEP\n0\n"));
        assert!(is_lammps(b"2 atoms\n\n 17 atoms # all\r\n1 atom types\n\n0.0 1e1 xlo xhi\r\n"));
        assert!(!is_lammps(b"17 atoms\n\n0 1 xlo xhi\n"), "the first line is a title");
        assert!(!is_lammps(b"\nof atoms\n0 1 xlo xhi\n"));
        assert!(!is_lammps(b""));
    }
}
