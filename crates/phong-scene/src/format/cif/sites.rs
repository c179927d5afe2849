//! The rows of `_atom_site`.

use std::collections::BTreeSet;
use std::sync::Arc;

use glam::DVec3;

use super::tokens::Token;
use crate::diagnostic::{Place, Span};
use crate::elements::{number_of, number_of_label};
use crate::format::atoms::{has_room, leave_out_alternates};
use crate::format::text::{Decimal, Findings, whole};
use crate::limits::{LARGEST, Limits};
use crate::molecule::{Alternates, Cell, Column, Molecule, Values, names};

/// What a column of the loop is.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Role {
    Skip,
    Place(usize),
    /// A coordinate of the place that counts where the others are not there.
    Spare(usize),
    Symbol,
    /// Its value is kept in the column of this number.
    Column(usize),
    /// A label, of which the element is known if there is no symbol.
    Label(usize),
    Alternate,
    Disorder,
    Model,
    Insertion,
}

/// The atoms of a block.
#[derive(Debug)]
pub(super) struct Sites {
    roles: Vec<Role>,
    /// Whether places are shares of the cell.
    pub(super) fractional: bool,
    molecule: Molecule,
    places: Vec<DVec3>,
    /// Where the atoms are if the other places are not there, what was said of these, and whether there
    /// are such.
    spares: Vec<DVec3>,
    said_of_spares: Findings,
    has_spares: bool,
    alternates: Alternates,
    row: Row,
    symbols: bool,
    /// The model of the first atom, that of the last one, and all there are.
    models: [Option<Vec<u8>>; 2],
    all_models: BTreeSet<Vec<u8>>,
    disorder: u64,
}

/// What of a row has been read.
#[derive(Clone, Debug, Default)]
struct Row {
    place: DVec3,
    spare: DVec3,
    element: u8,
    alternate: u8,
    insertion: u8,
    /// Whether it is of the first model.
    first: bool,
    /// Whether it is of the second or a later group of disorder.
    disordered: bool,
    line: u64,
}

/// Columns by the names that they may have, those that are taken first in front.
const COLUMNS: [(&str, bool, &[&str]); 8] = [
    (names::NAME, true, &["auth_atom_id", "label_atom_id", "label", "atom_id"]),
    (names::RESIDUE, true, &["auth_comp_id", "label_comp_id", "comp_id"]),
    (names::NUMBER, false, &["auth_seq_id", "label_seq_id"]),
    (names::CHAIN, true, &["auth_asym_id", "label_asym_id"]),
    (names::OCCUPANCY, false, &["occupancy"]),
    (names::B_FACTOR, false, &["b_iso_or_equiv", "u_iso_or_equiv"]),
    (names::CHARGE, false, &["pdbx_formal_charge"]),
    ("record", true, &["group_pdb"]),
];

/// What the names of the atoms of a structure begin with, and of those of a component: a ligand or a
/// residue by itself.
pub(super) const ATOMS: &str = "_atom_site";
pub(super) const COMPONENT: &str = "_chem_comp_atom";

impl Sites {
    /// Of a loop of these names, which begin so; `None`: it is another.
    pub(super) fn of(names: &[String], category: &str) -> Option<Self> {
        let short = |name: &String| {
            let rest = name.strip_prefix(category)?;
            rest.strip_prefix(['.', '_']).map(str::to_owned)
        };
        let short: Vec<Option<String>> = names.iter().map(short).collect();
        let find = |wanted: &str| short.iter().position(|name| name.as_deref() == Some(wanted));
        let axes = |before: &str, behind: &str| -> Option<Vec<usize>> {
            ["x", "y", "z"].iter().map(|axis| find(&format!("{before}{axis}{behind}"))).collect()
        };
        let (cartesian, spare) = if category == COMPONENT {
            let all = [("pdbx_model_cartn_", "_ideal"), ("model_cartn_", ""), ("", "")];
            let mut there = all.into_iter().filter_map(|(before, behind)| axes(before, behind));
            (Some(there.next()?), there.next())
        } else {
            (axes("cartn_", ""), None)
        };
        let fractional = cartesian.is_none();
        let places = cartesian.or_else(|| axes("fract_", ""))?;
        let mut roles = vec![Role::Skip; names.len()];
        for (axis, column) in places.into_iter().enumerate() {
            roles[column] = Role::Place(axis);
        }
        let has_spares = spare.is_some();
        for (axis, column) in spare.into_iter().flatten().enumerate() {
            roles[column] = Role::Spare(axis);
        }
        let mut molecule = Molecule::default();
        for (name, words, known) in COLUMNS {
            let Some(at) = known.iter().find_map(|name| find(name)) else { continue };
            let column = if words { Column::of_words(name) } else { Column::of_numbers(name) };
            let number = molecule.columns.len();
            roles[at] =
                if name == names::NAME { Role::Label(number) } else { Role::Column(number) };
            molecule.columns.push(column);
        }
        let symbol = find("type_symbol");
        for (at, role) in [
            (symbol, Role::Symbol),
            (find("label_alt_id"), Role::Alternate),
            (find("disorder_group"), Role::Disorder),
            (find("pdbx_pdb_model_num"), Role::Model),
            (find("pdbx_pdb_ins_code"), Role::Insertion),
        ] {
            if let Some(at) = at {
                roles[at] = role;
            }
        }
        Some(Self {
            roles,
            fractional,
            molecule,
            places: Vec::new(),
            spares: Vec::new(),
            said_of_spares: Findings::default(),
            has_spares,
            alternates: Alternates::default(),
            row: Row { first: true, ..Row::default() },
            symbols: symbol.is_some(),
            models: [None, None],
            all_models: BTreeSet::new(),
            disorder: 0,
        })
    }

    /// How many atoms there are.
    pub(super) fn count(&self) -> usize {
        self.places.len()
    }

    pub(super) fn has_room(
        &self,
        file: &Arc<str>,
        limits: &Limits,
        findings: &mut Findings,
    ) -> bool {
        has_room(&self.molecule, limits, file, findings)
    }

    /// Takes the value of the next column.
    pub(super) fn value(
        &mut self,
        column: usize,
        token: &Token<'_>,
        file: &Arc<str>,
        findings: &mut Findings,
    ) {
        let text = token.text;
        let none = !token.quoted && (text == b"?" || text == b".");
        let given = if none { &b""[..] } else { text };
        match self.roles[column] {
            Role::Skip => {}
            Role::Place(axis) => {
                self.row.place[axis] = coordinate(token, none, file, findings);
                self.row.line = token.line;
            }
            Role::Spare(axis) => {
                self.row.spare[axis] = coordinate(token, none, file, &mut self.said_of_spares);
            }
            Role::Symbol => {
                self.row.element = number_of(given).or_else(|| number_of_label(given)).unwrap_or(0);
            }
            Role::Label(at) => {
                if !self.symbols {
                    self.row.element = number_of_label(given).unwrap_or(0);
                }
                self.molecule.columns[at].values.push_word(given);
            }
            Role::Column(at) => match &mut self.molecule.columns[at].values {
                Values::Words(words) => words.push(given),
                Values::Numbers(numbers) => {
                    numbers.push(number(given).map_or(f32::NAN, |number| number as f32));
                }
            },
            Role::Alternate => self.row.alternate = given.first().copied().unwrap_or(0),
            Role::Disorder => {
                // Negative groups lie on a symmetry element.
                let group = number(given).unwrap_or(0.0).abs();
                self.row.disordered = group > 1.0;
            }
            Role::Model => {
                let [first, last] = &mut self.models;
                if last.as_deref() != Some(given) {
                    *last = Some(given.to_vec());
                    self.all_models.insert(given.to_vec());
                }
                self.row.first = first.get_or_insert_with(|| given.to_vec()) == given;
            }
            Role::Insertion => self.row.insertion = given.first().copied().unwrap_or(0),
        }
        if column + 1 == self.roles.len() {
            self.end_row();
        }
    }

    fn end_row(&mut self) {
        let row = std::mem::replace(&mut self.row, Row { first: true, ..Row::default() });
        self.disorder += u64::from(row.disordered);
        if !row.first || row.disordered {
            let last = self.molecule.len();
            for column in &mut self.molecule.columns {
                match &mut column.values {
                    Values::Numbers(numbers) => numbers.truncate(last),
                    Values::Words(words) => words.numbers.truncate(last),
                }
            }
            return;
        }
        let molecule = &mut self.molecule;
        let last = molecule.spheres.len();
        let number = molecule.numbers(names::NUMBER).map_or(0.0, |numbers| numbers[last]);
        let chain = molecule.words(names::CHAIN).map_or(0, |chains| chains.numbers[last]);
        let residue = (u64::from(chain) << 40)
            | ((f64::from(number) as i64 as u64 & 0xffff_ffff) << 8)
            | u64::from(row.insertion);
        self.alternates.letters.push((row.alternate, residue));
        self.places.push(row.place);
        if self.has_spares {
            self.spares.push(row.spare);
        }
        molecule.spheres.push([0.0; 4]);
        molecule.elements.push(row.element);
    }

    /// Takes the other places where more of them are there, and what was said of them in place of
    /// `findings`.
    pub(super) fn settle(&mut self, file: &Arc<str>, findings: &mut Findings) {
        let there = |places: &[DVec3]| places.iter().filter(|place| place.is_finite()).count();
        if there(&self.spares) > there(&self.places) {
            self.places = std::mem::take(&mut self.spares);
            *findings = std::mem::take(&mut self.said_of_spares);
            let message = || {
                "the file says no ideal places of these atoms: they are where its model has them"
                    .to_owned()
            };
            findings.note("places", || whole(file), message);
        }
    }

    /// Whether its places, which the file calls shares of a cell, are lengths: shares are hardly beyond 2.
    pub(super) fn are_lengths(&self) -> bool {
        self.places.iter().any(|place| place.abs().max_element() > 2.0)
    }

    /// The atoms, put where they are in the cell.
    pub(super) fn finish(
        self,
        cell: Option<Cell>,
        file: &Arc<str>,
        findings: &mut Findings,
    ) -> Molecule {
        let Self { mut molecule, mut places, alternates, all_models, disorder, fractional, .. } =
            self;
        if let Some(cell) = cell.filter(|_| fractional) {
            for place in &mut places {
                *place = cell.place(*place);
            }
        }
        molecule.place_all(&places);
        if all_models.len() > 1 {
            let count = all_models.len();
            let message = || format!("the first of {count} models is drawn");
            findings.note("models", || whole(file), message);
        }
        if disorder > 0 {
            let message =
                || format!("of disorder the first group is drawn; {disorder} atoms are not");
            findings.note("disorder", || whole(file), message);
        }
        leave_out_alternates(&mut molecule, &alternates, file, findings);
        molecule
    }
}

/// A number, perhaps with a deviation behind it in parentheses.
pub(super) fn number(text: &[u8]) -> Option<f64> {
    let number = Decimal::scan(text)?;
    let rest = &text[number.len()..];
    let deviation = rest.first() == Some(&b'(') && rest.last() == Some(&b')');
    (rest.is_empty() || deviation).then(|| number.to_f64()).filter(|number| number.is_finite())
}

/// A coordinate; NaN if it is none, which is said.
fn coordinate(token: &Token<'_>, none: bool, file: &Arc<str>, findings: &mut Findings) -> f64 {
    if let Some(number) = number(token.text).filter(|number| number.abs() <= LARGEST) {
        return number;
    }
    let text = String::from_utf8_lossy(&token.text[..token.text.len().min(40)]).into_owned();
    let span = || {
        let line = u32::try_from(token.line).unwrap_or(u32::MAX);
        Span { place: Place { file: Arc::clone(file), line, column: 0 }, ..Span::default() }
    };
    if none || crate::format::text::blame(token.text) != crate::format::text::BadNumber::Malformed {
        let message = || format!("`{text}` is no place: the atom is left out");
        findings.warning("atoms that are left out", span, message);
    } else {
        let message = || format!("`{text}` is not a number, but should be a coordinate");
        findings.error("places that cannot be read", span, message);
    }
    f64::NAN
}
