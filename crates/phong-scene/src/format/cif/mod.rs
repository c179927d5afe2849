//! CIF: mmCIF of large molecules, and files of small ones with a cell and places as shares of it.
//!
//! | in the file | read as |
//! |---|---|
//! | the loop `_atom_site`, its columns in any order | the atoms; the first block of the file that has some is drawn, others are told |
//! | `Cartn_x`, … or `fract_x`, … | places in Å, or as shares of the cell; a deviation behind them, `0.25(3)`, is not used |
//! | `type_symbol`, or `label` | the element |
//! | `auth_` names of atom, residue, chain and number, else the `label_` ones | columns |
//! | `label_alt_id`, `disorder_group` | alternates: those of the highest occupancy are drawn, and of disorder the first group |
//! | `pdbx_PDB_model_num` | the first model; the others are told |
//! | the loop `_chem_comp_atom`, in a block without `_atom_site` | a ligand or a residue by itself: its ideal places, else those of the model |
//! | `_cell` | the cell |
//! | symmetry | not used: the asymmetric unit is drawn, which is told |
//!
//! An atom whose place is `?` or `.` is left out and counted.

mod sites;
mod tokens;

use std::collections::BTreeMap;
use std::sync::Arc;

use self::sites::Sites;
use self::tokens::{Token, Tokens};
use super::atoms::read_atoms;
use super::input::Input;
use super::text::{Findings, read_text, whole};
use crate::diagnostic::Diagnostic;
use crate::fragment::Fragment;
use crate::molecule::{Cell, Molecule};

/// Whether a file begins like one.
pub(crate) fn is_cif(head: &[u8]) -> bool {
    let mut lines = head.split(|b| *b == b'\n').map(<[u8]>::trim_ascii);
    let first = lines.find(|line| !line.is_empty() && !line.starts_with(b"#"));
    first.is_some_and(|line| line.len() > 5 && line[..5].eq_ignore_ascii_case(b"data_"))
}

/// Reads a CIF file; `None` if a diagnostic is an error.
pub(crate) fn read(input: &Input<'_>, out: &mut Vec<Diagnostic>) -> Option<Fragment> {
    read_atoms(input, out, |file, _, findings| {
        let text = read_text(input.source, input.path, input.limits)?;
        Ok(atoms(&text, file, input, findings))
    })
}

/// What is wanted of a block.
#[derive(Debug, Default)]
struct Block {
    /// Values outside of loops, by their names in small letters.
    items: BTreeMap<String, Vec<u8>>,
    sites: Option<Sites>,
    /// The atoms of a component, and what there is to say of them if they are drawn.
    component: Option<(Sites, Findings)>,
    operations: u64,
}

fn atoms(
    text: &[u8],
    file: &Arc<str>,
    input: &Input<'_>,
    findings: &mut Findings,
) -> Option<Molecule> {
    let mut tokens = Tokens::new(text);
    let mut block = Block::default();
    let mut others = 0;
    let mut next = tokens.next();
    while let Some(token) = next.take() {
        if token.is_heading(b"data_") {
            if block.has_atoms() {
                others += 1;
                // Only its name is of interest.
                next = skip_block(&mut tokens);
                continue;
            }
            block = Block::default();
            next = tokens.next();
        } else if token.is_word(b"loop_") {
            next = block.read_loop(&mut tokens, file, input, findings);
        } else if token.is_name() {
            next = tokens.next();
            if let Some(value) = next.filter(Token::is_value) {
                let name = String::from_utf8_lossy(token.text).to_ascii_lowercase();
                if name.starts_with("_cell") || name.starts_with("_atom_site") {
                    block.items.insert(name, value.text.to_vec());
                }
                next = tokens.next();
            }
        } else {
            next = tokens.next();
        }
        if findings.any_error() {
            return None;
        }
    }
    if let Some(line) = tokens.unclosed {
        findings.error(
            "texts without an end",
            || whole(file),
            || format!("the text that begins on line {line} does not end: the file is cut short"),
        );
        return None;
    }
    if others > 0 {
        let message = || format!("the first block with atoms is drawn; {others} others follow it");
        findings.note("blocks", || whole(file), message);
    }
    block.finish(file, findings)
}

/// Goes over a block; the token that begins the next.
fn skip_block<'a>(tokens: &mut Tokens<'a>) -> Option<Token<'a>> {
    loop {
        let token = tokens.next()?;
        if token.is_heading(b"data_") {
            return Some(token);
        }
    }
}

impl Block {
    fn has_atoms(&self) -> bool {
        let component = self.component.as_ref().map(|(sites, _)| sites);
        [self.sites.as_ref(), component].into_iter().flatten().any(|sites| sites.count() > 0)
    }

    /// Reads the names and rows of a loop; the token behind it.
    fn read_loop<'a>(
        &mut self,
        tokens: &mut Tokens<'a>,
        file: &Arc<str>,
        input: &Input<'_>,
        findings: &mut Findings,
    ) -> Option<Token<'a>> {
        let mut names = Vec::new();
        let mut next = tokens.next();
        while let Some(token) = next.filter(Token::is_name) {
            names.push(String::from_utf8_lossy(token.text).to_ascii_lowercase());
            next = tokens.next();
        }
        let begins = |name: &str| names.iter().any(|own| own.starts_with(name));
        let symmetry = begins("_symmetry_equiv") || begins("_space_group_symop");
        let component = Sites::of(&names, sites::COMPONENT).filter(|_| self.component.is_none());
        let is_component = component.is_some();
        let mut sites =
            component.or_else(|| Sites::of(&names, sites::ATOMS).filter(|_| self.sites.is_none()));
        let mut aside = Findings::default();
        let findings = if is_component { &mut aside } else { findings };
        let mut values = 0_u64;
        let mut last_line = 0;
        while let Some(token) = next.filter(Token::is_value) {
            if let Some(sites) = &mut sites {
                let column = (values % names.len().max(1) as u64) as usize;
                sites.value(column, &token, file, findings);
                if column + 1 == names.len() && !sites.has_room(file, input.limits, findings) {
                    return None;
                }
            }
            values += 1;
            last_line = token.line;
            next = tokens.next();
        }
        if let Some(mut sites) = sites {
            sites.settle(file, findings);
            if !values.is_multiple_of(names.len() as u64) {
                findings.error("truncated files", || whole(file), || {
                    format!(
                        "the atoms end in the middle of a row, on line {last_line}: the file is cut short or a value is missing"
                    )
                });
            }
            if is_component {
                self.component = Some((sites, aside));
            } else {
                self.sites = Some(sites);
            }
        }
        if symmetry {
            self.operations += values / names.len().max(1) as u64;
        }
        next
    }

    fn cell(&self) -> Option<Cell> {
        let number = |name: &str| {
            let value = self.items.get(&format!("_cell.{name}"));
            sites::number(value.or_else(|| self.items.get(&format!("_cell_{name}")))?)
        };
        let lengths = [number("length_a")?, number("length_b")?, number("length_c")?];
        let angles = ["angle_alpha", "angle_beta", "angle_gamma"];
        let angles = angles.map(|angle| number(angle).unwrap_or(90.0));
        Cell::of_angles(lengths, angles)
    }

    fn finish(mut self, file: &Arc<str>, findings: &mut Findings) -> Option<Molecule> {
        let cell = self.cell();
        let sites = self.sites.take().or_else(|| {
            // One atom alone stands without a loop.
            let names: Vec<String> = self.items.keys().cloned().collect();
            let mut sites = Sites::of(&names, sites::ATOMS)?;
            for (column, value) in self.items.values().enumerate() {
                let token = Token { text: value, line: 0, quoted: true };
                sites.value(column, &token, file, findings);
            }
            Some(sites)
        });
        let sites = sites.or_else(|| {
            let (sites, said) = self.component.take()?;
            findings.append(said);
            Some(sites)
        });
        let Some(sites) = sites else {
            let message = || "there is nothing to draw: the file has no `_atom_site`".to_owned();
            findings.error("files without atoms", || whole(file), message);
            return None;
        };
        let fractional = sites.fractional;
        if fractional && self.operations > 1 {
            let count = self.operations;
            let message = || {
                format!("the asymmetric unit is drawn: {count} symmetry operations are not applied")
            };
            findings.note("symmetry", || whole(file), message);
        }
        if fractional && cell.is_none() {
            let message = "the places are shares of a cell, but the file says none";
            if !sites.are_lengths() {
                findings.error("cells", || whole(file), || message.to_owned());
                return None;
            }
            let message = || format!("{message}: they are taken as Å, as Open Babel writes them");
            findings.warning("cells", || whole(file), message);
        }
        let mut molecule = sites.finish(cell, file, findings);
        molecule.cell = cell.filter(|cell| !cell.stands_for_none());
        Some(molecule)
    }
}
