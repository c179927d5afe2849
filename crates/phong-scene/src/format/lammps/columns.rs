//! What the columns of a dump are, by their names.

use crate::format::atoms::{Layout, Slot};
use crate::molecule::{Column, Drawing, names};

/// How places are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Places {
    /// As they are.
    Plain,
    /// As shares of the box.
    Scaled,
}

/// The triples of names that places go by, the one that is taken first in front: the plain places show
/// the box as it is, unwrapped ones the paths of molecules.
const TRIPLES: [([&str; 3], Places); 6] = [
    (["x", "y", "z"], Places::Plain),
    (["xu", "yu", "zu"], Places::Plain),
    (["xs", "ys", "zs"], Places::Scaled),
    (["xsu", "ysu", "zsu"], Places::Scaled),
    (["X", "Y", "Z"], Places::Plain),
    (["c_x", "c_y", "c_z"], Places::Plain),
];

/// The layout of rows of columns of these names; `Err`: what is missing.
pub(super) fn layout(named: &[&str], drawing: &Drawing) -> Result<(Layout, Places), String> {
    let has = |name: &&str| named.contains(name);
    let Some((triple, places)) = TRIPLES.iter().find(|(triple, _)| triple.iter().all(has)) else {
        return Err("the columns hold no places: neither `x y z` nor `xu yu zu`, `xs ys zs` or `xsu ysu zsu`"
            .to_owned());
    };
    let mut layout = Layout { slots: Vec::new(), columns: Vec::new(), bytes: false };
    for name in named {
        let axis = triple.iter().position(|of| of == name);
        let slot = match (*name, axis) {
            (_, Some(axis)) => Slot::Place(axis),
            ("element", _) => Slot::Element,
            ("radius", _) => Slot::Radius(1.0),
            ("diameter", _) => Slot::Radius(0.5),
            ("type", _) => column(names::TYPE, true, &mut layout),
            ("mol", _) if drawing.uses(names::MOLECULE) => {
                column(names::MOLECULE, true, &mut layout)
            }
            ("q", _) if drawing.uses(names::CHARGE) => column(names::CHARGE, false, &mut layout),
            (other, _) if drawing.uses(other) => column(other, false, &mut layout),
            // A trajectory has the atoms in the order of their numbers.
            ("id", _) if drawing.trajectory.is_some() => column("id", false, &mut layout),
            _ => Slot::Skip,
        };
        layout.slots.push(slot);
    }
    while layout.slots.last() == Some(&Slot::Skip) {
        layout.slots.pop();
    }
    Ok((layout, *places))
}

fn column(name: &str, words: bool, layout: &mut Layout) -> Slot {
    let column = if words { Column::of_words(name) } else { Column::of_numbers(name) };
    layout.columns.push(column);
    Slot::Column(layout.columns.len() - 1)
}
