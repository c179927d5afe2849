//! Records: which there are, and what their columns hold.

use std::sync::Arc;

use glam::DVec3;

use super::cell_of;
use crate::elements::{HYDROGEN, number_of, number_of_group};
use crate::format::atoms::Fixed;
use crate::format::text::Findings;
use crate::molecule::Cell;

/// A record that is used.
#[derive(Debug)]
pub(super) enum Record {
    Model,
    EndOfModel,
    /// The end of the file, or, in files of programs of dynamics, of a frame.
    End,
    Cell(Cell),
    Atom(Box<Atom>),
    /// The serial numbers of an atom and of those that it is bound to, as they are written.
    Connect(Vec<[u8; 5]>),
}

/// An atom as its record has it.
#[derive(Debug)]
pub(super) struct Atom {
    pub(super) record: &'static str,
    pub(super) serial: [u8; 5],
    pub(super) name: Vec<u8>,
    /// The letter of the alternate location; 0: none.
    pub(super) alternate: u8,
    pub(super) residue: Vec<u8>,
    pub(super) chain: Vec<u8>,
    pub(super) number: f32,
    /// The same for the atoms of a residue, whatever its name.
    pub(super) residue_key: u64,
    pub(super) place: DVec3,
    pub(super) occupancy: f32,
    pub(super) b_factor: f32,
    pub(super) segment: Vec<u8>,
    pub(super) element: u8,
    /// In elementary charges.
    pub(super) charge: f32,
}

impl Record {
    /// The record of a line; `None`: it is not used.
    pub(super) fn parse(
        line: Fixed<'_>,
        docked: bool,
        file: &Arc<str>,
        findings: &mut Findings,
    ) -> Option<Self> {
        let text = line.text;
        let is = |record: &[u8]| {
            text.len() >= record.len() && text[..record.len()].eq_ignore_ascii_case(record)
        };
        if is(b"ATOM  ") || is(b"HETATM") {
            let record = if is(b"ATOM  ") { "ATOM" } else { "HETATM" };
            let (narrow, number) = narrowed(line);
            let line = Fixed { text: narrow.as_deref().unwrap_or(text), ..line };
            let mut atom = Atom::parse(line, record, file, findings);
            atom.number = number.unwrap_or(atom.number);
            if docked {
                atom.dock(line);
            }
            return Some(Self::Atom(Box::new(atom)));
        }
        if is(b"CONECT") {
            // Eleven columns may hold hydrogen bonds in files before 1996; the first four are bonds.
            let field = |i: usize| serial(text, 6 + 5 * i);
            let serials: Vec<[u8; 5]> = (0..5).map(field).take_while(|s| *s != [b' '; 5]).collect();
            return (serials.len() > 1).then_some(Self::Connect(serials));
        }
        if is(b"ENDMDL") {
            return Some(Self::EndOfModel);
        }
        if is(b"MODEL ") {
            return Some(Self::Model);
        }
        if is(b"END") && text.len() == 3 {
            return Some(Self::End);
        }
        is(b"CRYST1").then(|| cell_of(line)).flatten().map(Self::Cell)
    }
}

/// The record of an atom whose numbers have a digit too many, so that all behind them stands a column too
/// far to the right, with every value in its columns; and the number of the residue, if it is that.
///
/// A digit behind the residue's number may be an insertion code: then there are places in their columns.
fn narrowed(line: Fixed<'_>) -> (Option<Vec<u8>>, Option<f32>) {
    let digit = |at: usize| line.text.get(at).is_some_and(u8::is_ascii_digit);
    if !digit(11) && !digit(26) || line.number(38, 46).is_some() {
        return (None, None);
    }
    let mut narrow = line.text.to_vec();
    if digit(11) {
        narrow.remove(6);
    }
    let number = Fixed { text: &narrow, ..line }.number(22, 27).map(|number| number as f32);
    let too_wide = narrow.get(22..27).is_some_and(|field| field.iter().all(u8::is_ascii_digit));
    if too_wide {
        narrow.remove(22);
    }
    (Some(narrow), number.filter(|_| too_wide))
}

/// The five columns of a serial number.
fn serial(text: &[u8], start: usize) -> [u8; 5] {
    let mut serial = [b' '; 5];
    let field = text.get(start..(start + 5).min(text.len())).unwrap_or_default().trim_ascii();
    serial[5 - field.len()..].copy_from_slice(field);
    serial
}

impl Atom {
    fn parse(
        line: Fixed<'_>,
        record: &'static str,
        file: &Arc<str>,
        findings: &mut Findings,
    ) -> Self {
        let text = line.text;
        let mut axis = |axis: usize| {
            let start = 30 + 8 * axis;
            line.coordinate(axis, [start, start + 8], file, findings)
        };
        let place = DVec3::new(axis(0), axis(1), axis(2));
        let name = line.field(12, 16);
        let residue = line.field(17, 21);
        // A fourth letter of the residue's name may stand before the chain.
        let (residue, chain) = match residue {
            [first @ .., b' ', last]
                if first.trim_ascii().len() <= 3 && text.get(20) != Some(&b' ') =>
            {
                (first.trim_ascii(), std::slice::from_ref(last))
            }
            _ => (residue, &[][..]),
        };
        let chain = [chain, line.field(21, 22)].concat();
        let number = residue_number(line.field(22, 26));
        let alternate = text.get(16).copied().filter(|b| *b > b' ').unwrap_or(0);
        let code = text.get(26).copied().unwrap_or(b' ');
        let numbers = |start: usize, end: usize| line.number(start, end).unwrap_or(f64::NAN) as f32;
        Self {
            record,
            serial: serial(text, 6),
            element: element_of(line, name, record),
            alternate,
            residue_key: key_of(&chain, line.field(22, 26), code),
            name: name.to_vec(),
            residue: residue.to_vec(),
            chain,
            number,
            place,
            occupancy: numbers(54, 60),
            b_factor: numbers(60, 66),
            segment: line.field(72, 76).to_vec(),
            charge: charge_of(line.field(78, 80)),
        }
    }
}

impl Atom {
    /// Takes what files of `AutoDock` have in their last columns: the charge and the type.
    fn dock(&mut self, line: Fixed<'_>) {
        self.segment.clear();
        self.charge = line.number(66, 76).unwrap_or(f64::NAN) as f32;
        if let Some(element) = of_type(line.field(77, 79)) {
            self.element = element;
        }
    }
}

/// The element of one of `AutoDock`'s types: a symbol, or its first letter with what it does behind it.
fn of_type(name: &[u8]) -> Option<u8> {
    match name {
        b"A" | b"G" | b"GA" | b"J" => number_of(b"C"),
        b"HD" | b"HS" | b"NA" | b"NS" | b"OA" | b"OS" | b"SA" => number_of(&name[..1]),
        _ => number_of(name),
    }
}

/// A number that is the same for the atoms of a residue.
fn key_of(chain: &[u8], number: &[u8], code: u8) -> u64 {
    let bytes = chain.iter().rev().take(2).chain(number).chain([&code]);
    bytes.fold(0, |key, byte| (key << 8) | u64::from(*byte))
}

/// The number of a residue: four digits, or, from 10,000 on, a letter and three digits in base 36.
fn residue_number(field: &[u8]) -> f32 {
    let text = str::from_utf8(field).unwrap_or_default();
    if let Ok(number) = text.parse::<i32>() {
        return number as f32;
    }
    let letter = field.first().copied().unwrap_or(b' ');
    let Ok(number) = i64::from_str_radix(text, 36) else { return f32::NAN };
    match (field.len(), letter) {
        // Capitals follow 9999, small letters follow them.
        (4, b'A'..=b'Z') => (number - 10 * 36_i64.pow(3) + 10_000) as f32,
        (4, b'a'..=b'z') => (number + 16 * 36_i64.pow(3) + 10_000) as f32,
        _ => f32::NAN,
    }
}

/// The charge, written as `2+`, `+2` or `-`.
fn charge_of(field: &[u8]) -> f32 {
    let sign = match field {
        [.., b'+'] | [b'+', ..] => 1.0,
        [.., b'-'] | [b'-', ..] => -1.0,
        _ => return f32::NAN,
    };
    let digits = field.iter().filter(|b| b.is_ascii_digit());
    let number = digits.fold(0.0, |number, digit| 10.0 * number + f32::from(digit - b'0'));
    sign * if number == 0.0 { 1.0 } else { number }
}

/// The element: as it is written, if that can be one of an atom of this name; else as the name says.
fn element_of(line: Fixed<'_>, name: &[u8], record: &str) -> u8 {
    let written = line.field(76, 78);
    let letters = || name.iter().filter(|b| b.is_ascii_alphabetic());
    let fits = |symbol: &[u8]| {
        let first = symbol.first().map(u8::to_ascii_uppercase);
        letters().any(|letter| Some(letter.to_ascii_uppercase()) == first) || letters().count() == 0
    };
    if let Some(number) = number_of(written).filter(|_| fits(written)) {
        return number;
    }
    let columns = line.text.get(12..14.min(line.text.len())).unwrap_or_default();
    let first = || {
        let symbol = letters().next().and_then(|letter| number_of(&[*letter]));
        symbol.or_else(|| number_of_group(name)).unwrap_or(0)
    };
    match columns {
        // The symbol ends in the second column.
        [b' ' | b'0'..=b'9' | b'*' | b'\'', ..] => first(),
        // Four letters leave no room: hydrogens of residues stand a column too far to the left.
        [b'H', ..] if name.len() == 4 => HYDROGEN,
        two => match number_of(two.trim_ascii()) {
            // Names that begin in the first column by mistake are those of the residues' own atoms.
            Some(_) if record == "ATOM" && is_of_residues(name) => first(),
            // Far more often these are hydrogen epsilon and the like, a column too far to the left.
            Some(_) if RARE.contains(&two) => first(),
            Some(number) => number,
            None => first(),
        },
    }
}

/// Symbols that hardly any file means.
const RARE: [&[u8]; 22] = [
    b"HO", b"HE", b"HF", b"HS", b"NB", b"NE", b"ND", b"NP", b"NO", b"SC", b"SB", b"SM", b"PO",
    b"PR", b"PM", b"PA", b"PU", b"CE", b"CM", b"CF", b"CN", b"OG",
];

/// Whether a name is that of an atom of the usual residues, if it is not that of a metal.
fn is_of_residues(name: &[u8]) -> bool {
    let carbons: [&[u8]; 16] = [
        b"CA", b"CB", b"CD", b"CD1", b"CD2", b"CE", b"CE1", b"CE2", b"CE3", b"CG", b"CG1", b"CG2",
        b"CH2", b"CZ", b"CZ2", b"CZ3",
    ];
    let others: [&[u8]; 16] = [
        b"ND1", b"ND2", b"NE", b"NE1", b"NE2", b"NH1", b"NH2", b"OD1", b"OD2", b"OE1", b"OE2",
        b"OG", b"OG1", b"OH", b"SD", b"SG",
    ];
    let hydrogens: [&[u8]; 6] = [b"HA", b"HB", b"HD", b"HE", b"HG", b"HH"];
    let begins = |hydrogen: &&[u8]| name.starts_with(hydrogen);
    carbons.contains(&name) || others.contains(&name) || hydrogens.iter().any(begins)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn residues_past_9999_are_numbered_in_base_36() {
        let number = |text: &str| residue_number(text.as_bytes());
        assert_eq!([number("9999"), number("-5"), number("A000")], [9999.0, -5.0, 10_000.0]);
        assert_eq!([number("ZZZZ"), number("a000")], [1_223_055.0, 1_223_056.0]);
        assert!(number("").is_nan() && number("12").is_finite());
    }

    #[test]
    fn the_element_is_that_of_the_columns_or_of_the_name() {
        let element = |record: &'static str, name: &str, written: &str| {
            let text = format!(
                "{record:<6}    1 {name:<4} ALA A   1       0.000   0.000   0.000  1.00  0.00          {written:>2}"
            );
            let line = Fixed { line: 1, text: text.as_bytes() };
            element_of(line, name.trim().as_bytes(), record)
        };
        let of = |symbol: &str| number_of(symbol.as_bytes()).unwrap();
        for (record, name, written, symbol) in [
            ("ATOM", " CA ", "", "C"),
            ("HETATM", "CA  ", "", "Ca"),
            ("ATOM", "CA  ", "", "C"),
            ("ATOM", "HG11", "", "H"),
            ("ATOM", "1HB ", "", "H"),
            ("HETATM", "ZN  ", "", "Zn"),
            ("HETATM", "FE  ", "12", "Fe"),
            ("ATOM", " CA ", "N", "C"),
            ("ATOM", " CA ", "C", "C"),
            ("HETATM", " D1 ", "D", "H"),
        ] {
            assert_eq!(element(record, name, written), of(symbol), "{record} {name} {written}");
        }
    }

    #[test]
    fn records_with_numbers_too_wide_may_end_anywhere() {
        let file: Arc<str> = "cut.pdb".into();
        for text in [
            "ATOM  123456 CA  ALA A123456      11.104   6.134  -6.504  1.00",
            "ATOM      1  CA  ALA A123456      11.104   6.134  -6.504  1.00",
            "ATOM  123456 CA  ALA A12345678901234567890",
        ] {
            for end in 6..=text.len() {
                let line = Fixed { line: 1, text: &text.as_bytes()[..end] };
                let record = Record::parse(line, false, &file, &mut Findings::default());
                assert!(matches!(record, Some(Record::Atom(_))), "{text:?} up to {end}");
            }
        }
    }

    #[test]
    fn the_types_of_docked_atoms_are_elements() {
        for (name, symbol) in [
            ("A", "C"),
            ("OA", "O"),
            ("HD", "H"),
            ("NA", "N"),
            ("SA", "S"),
            ("Cl", "Cl"),
            ("ZN", "Zn"),
        ] {
            assert_eq!(of_type(name.as_bytes()), number_of(symbol.as_bytes()), "{name}");
        }
        assert_eq!(of_type(b"W"), number_of(b"W"));
        assert_eq!(of_type(b""), None);
    }

    #[test]
    fn charges_stand_before_or_behind_their_sign() {
        assert_eq!([b"2+", b"+2", b"1-"].map(|c| charge_of(c)), [2.0, 2.0, -1.0]);
        assert_eq!(charge_of(b"-"), -1.0);
        assert!(charge_of(b"").is_nan());
    }
}
