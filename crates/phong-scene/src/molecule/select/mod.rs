//! Selections: `chain A and not water`.
//!
//! | words | atoms |
//! |---|---|
//! | `all`, `none` | all of them, none |
//! | `protein`, `nucleic`, `water`, `ion`, `backbone` | those of residues or atoms of such names |
//! | `hydrogen` | hydrogens |
//! | `element C N`, `chain A B`, `name CA`, `residue ALA 10-20`, `COLUMN WORD` | those that have one of the values; `10-20` is a range of numbers |
//! | `x < 10`, `b-factor >= 50`, `COLUMN < NUMBER` | those whose number compares so |
//! | `index 1-100` | by their place in the file, from 1 |
//! | `not A`, `A and B`, `A or B`, `(A)` | `not` binds strongest, `or` weakest |

mod parse;

use std::ops::Range;

use super::residue::{is_backbone, is_ion, is_nucleic, is_protein, is_water};
use super::wrong::Wrong;
use super::{Molecule, Values, names};
use crate::diagnostic::Span;
use crate::elements::{HYDROGEN, number_of};

pub(crate) use parse::Misspelt;

/// Which atoms are meant.
#[derive(Clone, Debug)]
pub(crate) struct Selection {
    text: String,
    tests: Expression,
}

/// A selection as it is understood.
#[derive(Clone, Debug)]
enum Expression {
    All,
    None,
    Kind(Kind),
    /// Has one of these values of a field, which is named there.
    Values {
        field: String,
        at: Range<usize>,
        values: Vec<Value>,
    },
    /// Compares so with a number.
    Compare {
        field: String,
        at: Range<usize>,
        order: Order,
        number: f64,
    },
    Not(Box<Expression>),
    And(Box<Expression>, Box<Expression>),
    Or(Box<Expression>, Box<Expression>),
}

/// Atoms known by the names of their residues, or by their own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Protein,
    Nucleic,
    Water,
    Ion,
    Backbone,
    Hydrogen,
}

impl Kind {
    const WORDS: [(&'static str, Self); 7] = [
        ("protein", Self::Protein),
        ("nucleic", Self::Nucleic),
        ("water", Self::Water),
        ("ion", Self::Ion),
        ("backbone", Self::Backbone),
        ("hydrogen", Self::Hydrogen),
        ("hydrogens", Self::Hydrogen),
    ];
}

/// A value that a field may have.
#[derive(Clone, Debug, PartialEq)]
enum Value {
    Word(String),
    /// A number or a range of them, both ends included; as it was written.
    Numbers(f64, f64, String),
}

/// How numbers compare.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Order {
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
    Equal,
    NotEqual,
}

/// What is wrong with a selection of a molecule, and where.
type Misfit = (Range<usize>, Wrong);

impl Selection {
    /// Reads a selection.
    ///
    /// # Errors
    /// What is wrong with it, and where in the text.
    pub(crate) fn parse(text: &str) -> Result<Self, Misspelt> {
        Ok(Self { text: text.to_owned(), tests: parse::parse(text)? })
    }

    /// What was written.
    pub(crate) fn text(&self) -> &str {
        &self.text
    }

    /// Whether it asks for a column of this name.
    pub(crate) fn uses(&self, column: &str) -> bool {
        self.tests.uses(column)
    }

    /// Which atoms are meant.
    ///
    /// # Errors
    /// That the file does not say what is asked for, and where in the text that is.
    pub(crate) fn of(&self, molecule: &Molecule) -> Result<Vec<bool>, Misfit> {
        self.tests.of(molecule)
    }

    /// The span of a part of a text, if `span` is that of the text in quotes.
    pub(crate) fn narrow(text: &str, span: &Span, at: Range<usize>) -> Span {
        let start = span.range.start + 1;
        let written = span.excerpt.get(start..).is_some_and(|rest| rest.starts_with(text));
        if !written {
            return span.clone();
        }
        let mut narrow = span.clone();
        narrow.range = start + at.start..start + at.end;
        let before = &span.excerpt[span.range.start..narrow.range.start];
        narrow.place.column += before.chars().count() as u32;
        narrow
    }
}

impl Expression {
    fn uses(&self, column: &str) -> bool {
        match self {
            Self::All | Self::None | Self::Kind(_) => false,
            Self::Values { field, .. } | Self::Compare { field, .. } => field == column,
            Self::Not(inner) => inner.uses(column),
            Self::And(a, b) | Self::Or(a, b) => a.uses(column) || b.uses(column),
        }
    }

    fn of(&self, molecule: &Molecule) -> Result<Vec<bool>, Misfit> {
        let both = |a: &Self, b: &Self, join: fn(bool, bool) -> bool| {
            let (mut a, b) = (a.of(molecule)?, b.of(molecule)?);
            a.iter_mut().zip(b).for_each(|(a, b)| *a = join(*a, b));
            Ok(a)
        };
        match self {
            Self::All => Ok(vec![true; molecule.len()]),
            Self::None => Ok(vec![false; molecule.len()]),
            Self::Kind(kind) => Ok(of_kind(*kind, molecule)),
            Self::Not(inner) => {
                let mut chosen = inner.of(molecule)?;
                for chosen in &mut chosen {
                    *chosen = !*chosen;
                }
                Ok(chosen)
            }
            Self::And(a, b) => both(a, b, |a, b| a && b),
            Self::Or(a, b) => both(a, b, |a, b| a || b),
            Self::Values { field, at, values } => {
                has_values(molecule, field, values).map_err(|wrong| (at.clone(), wrong))
            }
            Self::Compare { field, at, order, number } => {
                let holds = |value: f64| match order {
                    Order::Less => value < *number,
                    Order::LessOrEqual => value <= *number,
                    Order::Greater => value > *number,
                    Order::GreaterOrEqual => value >= *number,
                    Order::Equal => value == *number,
                    Order::NotEqual => value != *number,
                };
                by_number(molecule, field, holds).map_err(|wrong| (at.clone(), wrong))
            }
        }
    }
}

fn of_kind(kind: Kind, molecule: &Molecule) -> Vec<bool> {
    let by_word = |column: &str, is: fn(&str) -> bool| match molecule.words(column) {
        Some(words) => {
            let of: Vec<bool> = words.names.iter().map(|name| is(name)).collect();
            words.numbers.iter().map(|number| of[*number as usize]).collect()
        }
        None => vec![false; molecule.len()],
    };
    match kind {
        Kind::Protein => by_word(names::RESIDUE, is_protein),
        Kind::Nucleic => by_word(names::RESIDUE, is_nucleic),
        Kind::Water => by_word(names::RESIDUE, is_water),
        Kind::Ion => by_word(names::RESIDUE, is_ion),
        Kind::Hydrogen => match molecule.elements[..] {
            [] => vec![false; molecule.len()],
            _ => molecule.elements.iter().map(|element| *element == HYDROGEN).collect(),
        },
        Kind::Backbone => {
            let mut chosen = by_word(names::NAME, is_backbone);
            let of_chain = by_word(names::RESIDUE, |name| is_protein(name) || is_nucleic(name));
            chosen.iter_mut().zip(of_chain).for_each(|(chosen, of)| *chosen &= of);
            chosen
        }
    }
}

/// Which atoms have one of the values of a field.
fn has_values(molecule: &Molecule, field: &str, values: &[Value]) -> Result<Vec<bool>, Wrong> {
    let in_ranges = |value: f64| {
        values.iter().any(|v| matches!(v, Value::Numbers(a, b, _) if value >= *a && value <= *b))
    };
    let is_number = |value: &Value| matches!(value, Value::Numbers(..));
    match field {
        "element" if !molecule.elements.is_empty() => {
            let mut wanted = Vec::new();
            for value in values {
                let (Value::Word(word) | Value::Numbers(.., word)) = value;
                let number = number_of(word.as_bytes()).ok_or_else(|| Wrong {
                    message: format!("there is no element `{word}`"),
                    help: None,
                })?;
                wanted.push(number);
            }
            return Ok(molecule.elements.iter().map(|e| wanted.contains(e)).collect());
        }
        "element" => {
            let message = "the file does not say which elements its atoms are of".to_owned();
            return Err(Wrong { message, help: None });
        }
        // Both the names and the numbers of residues are meant.
        names::RESIDUE
            if values.iter().any(is_number) && molecule.column(names::NUMBER).is_some() =>
        {
            let mut chosen = by_number(molecule, names::NUMBER, in_ranges)?;
            let words: Vec<Value> = values.iter().filter(|v| !is_number(v)).cloned().collect();
            if !words.is_empty() {
                let named = has_values(molecule, names::RESIDUE, &words)?;
                chosen.iter_mut().zip(named).for_each(|(chosen, named)| *chosen |= named);
            }
            return Ok(chosen);
        }
        "index" | "x" | "y" | "z" => return by_number(molecule, field, in_ranges),
        _ => {}
    }
    match &molecule.known(field)?.values {
        Values::Numbers(_) => by_number(molecule, field, in_ranges),
        Values::Words(words) => {
            let is = |name: &String| {
                let number = name.parse::<f64>().ok();
                values.iter().any(|value| match value {
                    Value::Word(word) => word == name,
                    Value::Numbers(.., word) if word == name => true,
                    Value::Numbers(a, b, _) => number.is_some_and(|n| n >= *a && n <= *b),
                })
            };
            let of: Vec<bool> = words.names.iter().map(is).collect();
            Ok(words.numbers.iter().map(|number| of[*number as usize]).collect())
        }
    }
}

/// Which atoms have a number of which `holds` says so.
fn by_number(
    molecule: &Molecule,
    field: &str,
    holds: impl Fn(f64) -> bool,
) -> Result<Vec<bool>, Wrong> {
    let count = molecule.len();
    match field {
        "index" => return Ok((1..=count).map(|index| holds(index as f64)).collect()),
        "x" => return Ok((0..count).map(|i| holds(molecule.place(i).x)).collect()),
        "y" => return Ok((0..count).map(|i| holds(molecule.place(i).y)).collect()),
        "z" => return Ok((0..count).map(|i| holds(molecule.place(i).z)).collect()),
        _ => {}
    }
    match &molecule.known(field)?.values {
        Values::Numbers(numbers) => Ok(numbers.iter().map(|n| holds(f64::from(*n))).collect()),
        Values::Words(words) => {
            let number = |name: &String| name.parse::<f64>().ok().map(&holds);
            let of: Vec<Option<bool>> = words.names.iter().map(number).collect();
            if of.iter().all(Option::is_none) {
                let message = format!("`{field}` is no number");
                return Err(Wrong { message, help: None });
            }
            Ok(words.numbers.iter().map(|n| of[*n as usize].unwrap_or(false)).collect())
        }
    }
}
