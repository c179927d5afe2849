//! What is read before names are looked up.

use std::collections::BTreeMap;

use glam::DAffine3;

use super::notes::Notes;
use super::text::Spot;
use crate::diagnostic::{Diagnostic, Place, Severity};
use crate::material::{Material, MaterialId};
use crate::shape::Shape;
use crate::texture::Texture;
use crate::wording::{closest, list, quoted};

/// Most names that a message lists.
const MOST_LISTED: usize = 12;

/// Most names that a near miss is looked for among: each wrong name is held against all of them.
const MOST_COMPARED: usize = 500;

/// Things by name, in the order of the text.
#[derive(Debug)]
pub(super) struct Named<T> {
    pub(super) items: Vec<(String, Spot, Option<T>)>,
    numbers: BTreeMap<String, u32>,
}

impl<T> Named<T> {
    pub(super) const fn new() -> Self {
        Self { items: Vec::new(), numbers: BTreeMap::new() }
    }

    /// The number of the thing of this name.
    pub(super) fn find(&self, name: &str) -> Option<u32> {
        self.numbers.get(name).copied()
    }

    /// All names.
    pub(super) fn names(&self) -> impl Iterator<Item = &str> {
        self.numbers.keys().map(String::as_str)
    }

    /// Takes a name in, for the thing to follow; says if it is there already.
    pub(super) fn declare(
        &mut self,
        what: &str,
        name: &str,
        spot: Spot,
        notes: &mut Notes,
    ) -> Option<u32> {
        if let Some(first) = self.find(name) {
            let label = notes.span(self.items[first as usize].1);
            let message = format!("the {what} {} is defined twice", quoted(name));
            let error = Diagnostic::error(message, notes.span(spot));
            notes.say(spot, error.with_label("first defined here", label));
            return None;
        }
        let number = self.items.len() as u32;
        self.items.push((name.to_owned(), spot, None));
        self.numbers.insert(name.to_owned(), number);
        Some(number)
    }
}

/// What the objects of a fragment are made of, where its materials and textures are numbered.
#[derive(Debug, Default)]
pub(super) struct Looks {
    /// The materials but for number 0.
    pub(super) materials: Vec<Material>,
    pub(super) textures: Vec<Texture>,
}

/// An object whose names are still to be looked up.
#[derive(Debug)]
pub(super) struct Draft {
    pub(super) name: String,
    pub(super) shape: DraftShape,
    /// Where in the reader's list of materials that shapes name its own is, if it names one.
    pub(super) material: Option<usize>,
    pub(super) transform: DAffine3,
    pub(super) place: Place,
}

/// One of the shapes that a table stands for: several where it names a file.
#[derive(Debug)]
pub(super) struct Part {
    /// What the file calls it; empty: nothing.
    pub(super) name: String,
    pub(super) shape: DraftShape,
    /// Where it is in the file.
    pub(super) transform: DAffine3,
}

impl From<DraftShape> for Part {
    fn from(shape: DraftShape) -> Self {
        Self { name: String::new(), shape, transform: DAffine3::IDENTITY }
    }
}

/// A shape, or what names stand for it.
#[derive(Debug)]
pub(super) enum DraftShape {
    /// A shape.
    Shape(Shape),
    /// A shape of this fragment, where its materials are numbered.
    Part(Shape, MaterialId, usize),
    /// An instance of the group of this name.
    Instance(String, Spot),
}

/// Says that there is nothing of this name, and what may have been meant.
pub(super) fn say_unknown_name<'n>(
    notes: &mut Notes,
    what: &str,
    name: &str,
    known: impl Iterator<Item = &'n str>,
    spot: Spot,
) {
    if notes.is_full() {
        notes.count(Severity::Error);
        return;
    }
    let known: Vec<_> = known.take(MOST_COMPARED + 1).collect();
    let few = known.len() <= MOST_COMPARED;
    let near = few.then(|| closest(name, known.iter().copied())).flatten();
    let help = match near {
        Some(meant) => format!("did you mean `{meant}`?"),
        None if known.is_empty() => format!("`[{what}s.NAME]` defines one"),
        None if known.len() > MOST_LISTED => {
            format!("there are {}, …", list(known.into_iter().take(MOST_LISTED), ","))
        }
        None if known.len() > 1 => format!("there are {}", list(known, "and")),
        None => format!("there is {}", list(known, "and")),
    };
    notes.error(spot, format!("there is no {what} {}", quoted(name))).help = Some(help);
}
