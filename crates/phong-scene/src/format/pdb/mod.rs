//! PDB: atoms of large molecules, each value in its columns of characters.
//!
//! | record | read as |
//! |---|---|
//! | `ATOM`, `HETATM` | an atom: name, residue with number and insertion code, chain, place, occupancy, B-factor, segment, element and charge |
//! | no element, or none that there is (files before 1996 have other things there) | that of the atom's name: ` CA ` is carbon, `CA  ` calcium |
//! | alternate locations | those of the highest occupancy in each residue; the others are told |
//! | `MODEL`, `ENDMDL` | the first model; how many there are is told |
//! | `END` before an atom that is the first one again | the end of the first of several frames |
//! | numbers of atoms and residues with a digit too many | what stands behind them, a column to the right |
//! | `CONECT` | bonds, beside those by covalent radii; serial numbers are compared as they are written, so those past 99,999 may be in base 36, in base 16 or a column too far |
//! | files that end in `.pdbqt` | `AutoDock`'s: behind the B-factor the charge, then the atom's type, `A` for carbon in rings, `OA` for oxygen, … |
//! | `CRYST1` | the cell, unless it is the cube of 1 Å of structures without one |
//! | all others | not drawn |
//!
//! A place that is no number refuses the file; one that says NaN leaves the atom out.
//!
//! Own reader: `pdbtbx` refuses good files of older standards and holds every atom in a tree of objects.

mod atom;
mod connect;

use std::io;
use std::sync::Arc;

use glam::DVec3;

use self::atom::Record;
use self::connect::Serials;
use super::atoms::{Fixed, fixed_lines, has_room, leave_out_alternates, read_atoms};
use super::input::Input;
use super::text::{Findings, Lines, Piece, Rows, open_text, whole};
use crate::diagnostic::Diagnostic;
use crate::fragment::Fragment;
use crate::molecule::{Alternates, Cell, Column, Molecule, names};
use crate::source::{Blob, ending};

/// Whether a file begins like one.
pub(crate) fn is_pdb(head: &[u8]) -> bool {
    let records: [&[u8]; 5] = [b"HEADER    ", b"ATOM   ", b"HETATM ", b"CRYST1 ", b"MODEL   "];
    records.iter().any(|record| head.starts_with(record))
}

/// Reads a PDB file; `None` if a diagnostic is an error.
pub(crate) fn read(input: &Input<'_>, out: &mut Vec<Diagnostic>) -> Option<Fragment> {
    read_atoms(input, out, |file, _, findings| {
        let blob = open_text(input.source, input.path, input.limits)?;
        atoms(blob.as_ref(), file, input, findings)
    })
}

/// What a piece of the file holds.
#[derive(Debug, Default)]
struct Block {
    records: Vec<Record>,
    findings: Findings,
}

fn atoms(
    blob: &dyn Blob,
    file: &Arc<str>,
    input: &Input<'_>,
    findings: &mut Findings,
) -> io::Result<Option<Molecule>> {
    let lines = Lines { blob, start: 0, line: 1, joined: false, rows: Rows::Uncounted };
    let mut assembly = Assembly::new();
    let docked = is_docked(file);
    lines.each(
        |piece| parse(piece, docked, file),
        |block| {
            findings.append(block.findings);
            for record in block.records {
                assembly.add(record);
            }
            has_room(&assembly.molecule, input.limits, file, findings)
        },
    )?;
    Ok(Some(assembly.finish(file, findings)))
}

/// Whether it is a file of `AutoDock`'s, by its name, packed or not.
fn is_docked(file: &str) -> bool {
    ending(file).is_some_and(|ending| ending.eq_ignore_ascii_case("pdbqt"))
}

fn parse(piece: Piece<'_>, docked: bool, file: &Arc<str>) -> Block {
    let mut block = Block::default();
    for line in fixed_lines(piece) {
        let record = Record::parse(line, docked, file, &mut block.findings);
        block.records.extend(record);
    }
    block
}

/// The atoms so far.
struct Assembly {
    molecule: Molecule,
    places: Vec<DVec3>,
    alternates: Alternates,
    serials: Serials,
    models: u64,
    /// Whether the first model is over.
    over: bool,
    /// Whether an `END` was the last record.
    ended: bool,
    /// The first atom's number, name and residue, and how often it follows an `END`.
    first: ([u8; 5], [Vec<u8>; 2]),
    again: u64,
}

impl Assembly {
    fn new() -> Self {
        let columns = vec![
            Column::of_words(names::NAME),
            Column::of_words(names::RESIDUE),
            Column::of_numbers(names::NUMBER),
            Column::of_words(names::CHAIN),
            Column::of_words(names::SEGMENT),
            Column::of_numbers(names::OCCUPANCY),
            Column::of_numbers(names::B_FACTOR),
            Column::of_numbers(names::CHARGE),
            Column::of_words("record"),
        ];
        Self {
            molecule: Molecule { columns, ..Molecule::default() },
            places: Vec::new(),
            alternates: Alternates::default(),
            serials: Serials::default(),
            models: 0,
            over: false,
            ended: false,
            first: Default::default(),
            again: 0,
        }
    }

    fn add(&mut self, record: Record) {
        if let (Record::Atom(atom), true) = (&record, self.molecule.len() == 0 || self.ended) {
            let of = (atom.serial, [atom.name.clone(), atom.residue.clone()]);
            if self.molecule.len() == 0 {
                self.first = of;
            } else if self.first == of {
                self.again += 1;
                self.over = true;
            }
            self.ended = false;
        }
        match record {
            Record::End => self.ended = true,
            Record::Model => {
                self.models += 1;
                self.over |= self.models > 1;
            }
            Record::EndOfModel => {
                self.models = self.models.max(1);
                self.over |= self.molecule.len() > 0;
            }
            Record::Cell(cell) => self.molecule.cell = self.molecule.cell.or(Some(cell)),
            Record::Connect(serials) => self.serials.connect(&serials),
            Record::Atom(atom) if !self.over => {
                let molecule = &mut self.molecule;
                self.serials.atom(atom.serial);
                self.places.push(atom.place);
                molecule.spheres.push([0.0; 4]);
                molecule.elements.push(atom.element);
                self.alternates.letters.push((atom.alternate, atom.residue_key));
                let [name, residue, number, chain, segment, occupancy, b_factor, charge, record] =
                    &mut molecule.columns[..]
                else {
                    return;
                };
                name.values.push_word(&atom.name);
                residue.values.push_word(&atom.residue);
                number.values.push_number(atom.number);
                chain.values.push_word(&atom.chain);
                segment.values.push_word(&atom.segment);
                occupancy.values.push_number(atom.occupancy);
                b_factor.values.push_number(atom.b_factor);
                charge.values.push_number(atom.charge);
                record.values.push_word(atom.record.as_bytes());
            }
            Record::Atom(_) => {}
        }
    }

    fn finish(self, file: &Arc<str>, findings: &mut Findings) -> Molecule {
        let Self { mut molecule, places, alternates, serials, models, again, .. } = self;
        molecule.place_all(&places);
        let models = models.max(1 + again);
        if models > 1 {
            let message = || format!("the first of {models} models is drawn");
            findings.note("models", || whole(file), message);
        }
        let (bonds, unknown) = serials.bonds();
        molecule.bonds = bonds;
        if unknown > 0 {
            findings.warning("bonds to no atom", || whole(file), || {
                format!("bonds in `CONECT` records to atoms that are not there, or are there twice: {unknown}; they are not used")
            });
        }
        leave_out_alternates(&mut molecule, &alternates, file, findings);
        molecule
    }
}

/// The cell that a `CRYST1` record says.
fn cell_of(line: Fixed<'_>) -> Option<Cell> {
    let number = |start, end| line.number(start, end);
    let lengths = [number(6, 15)?, number(15, 24)?, number(24, 33)?];
    let angles = [number(33, 40)?, number(40, 47)?, number(47, 54)?];
    Cell::of_angles(lengths, angles).filter(|cell| !cell.stands_for_none())
}
