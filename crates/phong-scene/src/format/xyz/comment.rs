//! The second line of an XYZ file, which says in extended XYZ what the columns are.

use glam::DVec3;

use crate::format::atoms::{Layout, Slot};
use crate::molecule::{Cell, Column, Drawing, names};

/// What the line says.
#[derive(Debug, Default)]
pub(super) struct Comment {
    pub(super) properties: Option<Properties>,
    pub(super) cell: Option<Cell>,
}

/// The columns, as `Properties=` says them: names, kinds (`S R I L`) and how many values each.
#[derive(Debug)]
pub(super) struct Properties(String);

/// Values of one property, and properties, at most.
const MOST: usize = 64;

impl Comment {
    pub(super) fn parse(line: &[u8]) -> Self {
        let line = String::from_utf8_lossy(line);
        let numbers = |key: &str| -> Vec<f64> {
            let value = value_of(&line, key).unwrap_or_default();
            let words = value.split([' ', '\t', ',', '[', ']', '{', '}']);
            words.filter(|word| !word.is_empty()).map_while(|word| word.parse().ok()).collect()
        };
        let vector = |v: &[f64]| DVec3::from_slice(v);
        let lattice = numbers("Lattice");
        let origin = numbers("Origin");
        let cell = (lattice.len() == 9).then(|| Cell {
            origin: if origin.len() == 3 { vector(&origin) } else { DVec3::ZERO },
            edges: [vector(&lattice[..3]), vector(&lattice[3..6]), vector(&lattice[6..])],
        });
        let sound =
            |cell: &Cell| cell.edges.iter().all(|e| e.is_finite()) && cell.thickness() > 0.0;
        Self { properties: value_of(&line, "Properties").map(Properties), cell: cell.filter(sound) }
    }
}

impl Properties {
    /// The layout of rows; what is wrong with them.
    pub(super) fn layout(&self, drawing: &Drawing) -> Result<Layout, String> {
        let mut layout = Layout { slots: Vec::new(), columns: Vec::new(), bytes: false };
        let parts: Vec<&str> = self.0.split(':').collect();
        if !parts.len().is_multiple_of(3) || parts.len() > 3 * MOST {
            return Err("`Properties` is not a list of `name:kind:count`".to_owned());
        }
        for part in parts.chunks_exact(3) {
            let [name, kind, count] = [part[0], part[1], part[2]];
            let count = count.parse::<usize>().ok().filter(|count| (1..=MOST).contains(count));
            let Some(count) = count else {
                return Err(format!("`{name}` in `Properties` is not of 1 to {MOST} values"));
            };
            let known = match (name.to_ascii_lowercase().as_str(), count) {
                ("species" | "element" | "symbol" | "symbols", 1) => {
                    layout.columns.push(Column::of_words(names::NAME));
                    vec![Slot::Label(layout.columns.len() - 1)]
                }
                ("z" | "numbers", 1) => vec![Slot::Element],
                ("pos" | "positions", 3) => vec![Slot::Place(0), Slot::Place(1), Slot::Place(2)],
                ("color" | "colors", 3) => {
                    layout.bytes = kind == "I";
                    vec![Slot::Color(0), Slot::Color(1), Slot::Color(2)]
                }
                ("radius", 1) => vec![Slot::Radius(1.0)],
                _ => {
                    let column = |i: usize| match count {
                        1 => name.to_owned(),
                        _ => format!("{name}.{}", i + 1),
                    };
                    (0..count).map(|i| own(&column(i), kind, drawing, &mut layout)).collect()
                }
            };
            layout.slots.extend(known);
        }
        if !layout.slots.contains(&Slot::Place(0)) {
            return Err("`Properties` names no `pos:R:3`, the places of the atoms".to_owned());
        }
        while layout.slots.last() == Some(&Slot::Skip) {
            layout.slots.pop();
        }
        Ok(layout)
    }
}

/// The slot of a column of another name.
fn own(name: &str, kind: &str, drawing: &Drawing, layout: &mut Layout) -> Slot {
    let (name, always) = match name {
        "charge" | "charges" | "initial_charges" => (names::CHARGE, true),
        "type" | "particle_type" | "atom_types" => (names::TYPE, true),
        other => (other, false),
    };
    if !always && !drawing.uses(name) {
        return Slot::Skip;
    }
    let words = kind == "S" || name == names::TYPE;
    let column = if words { Column::of_words(name) } else { Column::of_numbers(name) };
    layout.columns.push(column);
    Slot::Column(layout.columns.len() - 1)
}

/// The value of `key=value`, in quotes or not; keys are known in any case.
fn value_of(line: &str, key: &str) -> Option<String> {
    let lower = line.to_ascii_lowercase();
    let key = format!("{}=", key.to_ascii_lowercase());
    let mut from = 0;
    loop {
        let at = from + lower.get(from..)?.find(&key)?;
        let begins = at == 0 || lower.as_bytes()[at - 1].is_ascii_whitespace();
        let rest = &line[at + key.len()..];
        if begins {
            let quote = rest.chars().next().filter(|c| "\"'".contains(*c));
            return Some(match quote {
                Some(quote) => rest[1..].split(quote).next().unwrap_or_default().to_owned(),
                None => rest.split_ascii_whitespace().next().unwrap_or_default().to_owned(),
            });
        }
        from = at + key.len();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_comment_says_cell_and_columns() {
        let line = b"energy=-1 Lattice=\"2 0 0 0 3 0 1 0 4\" Properties=species:S:1:pos:R:3:forces:R:3 pbc=\"T T T\"";
        let comment = Comment::parse(line);
        assert_eq!(comment.cell.unwrap().edges[2], DVec3::new(1.0, 0.0, 4.0));
        let drawing = Drawing { color_by: Some("forces.2".to_owned()), ..Drawing::default() };
        let layout = comment.properties.unwrap().layout(&drawing).unwrap();
        let place = Slot::Place;
        let expected = [Slot::Label(0), place(0), place(1), place(2), Slot::Skip, Slot::Column(1)];
        assert_eq!(layout.slots, expected);
        assert_eq!(Comment::parse(b"nolattice=\"1\" plain").cell, None);
    }
}
