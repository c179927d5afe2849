//! What is laid over the text of a scene, by the tables that it changes.

use std::cell::Cell;
use std::sync::Arc;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::notes::Notes;
use super::text::{Spot, Text};
use crate::change::Change;
use crate::keys::{Key, Kind, SCENE, Table};
use crate::wording::{closest, list, quoted};

/// What may be wrong with a path: where in it, what, and the way out.
pub(super) type Wrong = (usize, String, Option<String>);

/// The key that a path leads to.
#[derive(Clone, Copy, Debug)]
pub(super) struct Target<'p> {
    /// The scene's key whose table it is in: `camera`, `light`, `materials`.
    pub(super) list: &'static Key,
    /// Its table.
    pub(super) table: &'static Table,
    /// Which of several: a name, or a number from 1.
    pub(super) of: Option<&'p str>,
    /// The key in that table.
    pub(super) key: &'static Key,
}

impl<'p> Target<'p> {
    /// Follows a path by the table of keys.
    pub(super) fn of(path: &'p str) -> Result<Self, Wrong> {
        let Some((first, rest)) = path.split_once('.') else {
            let help = "write a path, like `camera.eye`, `light.1.color` or `materials.red.color`";
            return Err((0, format!("{} is no path of a key", quoted(path)), Some(help.into())));
        };
        let is_open = |key: &&Key| match key.kind {
            Kind::Table(_) | Kind::Tables(_) => key.name != "include",
            Kind::Named(_) => key.name != "groups",
            _ => false,
        };
        let open = || SCENE.keys().filter(is_open);
        let Some(list) = open().find(|key| key.name == first) else {
            let near = closest(first, open().map(|key| key.name));
            let help = match near {
                Some(near) => format!("did you mean `{near}`?"),
                None => format!("there are {}", list(open().map(|key| key.name), "and")),
            };
            let message = format!("a scene has no table {} whose keys can be set", quoted(first));
            return Err((0, message, Some(help)));
        };
        let (table, of, name) = match list.kind {
            Kind::Tables(table) | Kind::Named(table) => {
                let Some((of, name)) = rest.rsplit_once('.') else {
                    let which = if matches!(list.kind, Kind::Named(_)) { "NAME" } else { "1" };
                    let message = format!("{} does not say which one", quoted(path));
                    let help = format!("write `{first}.{which}.{rest}`");
                    return Err((0, message, Some(help)));
                };
                (table, Some(of), name)
            }
            Kind::Table(table) => (table, None, rest),
            _ => return Err((0, format!("{} is no path of a key", quoted(path)), None)),
        };
        let at = path.len() - name.len();
        if let (None, Some((key, _))) = (of, name.split_once('.')) {
            let help = format!("write `{first}.{key}`, and all of its value");
            return Err((at, "a value is set as a whole".to_owned(), Some(help)));
        }
        let Some(key) = table.find(name, None) else {
            let (message, help) = table.unknown(name, None);
            return Err((at, message, Some(help)));
        };
        Ok(Self { list, table, of, key })
    }

    /// Whether the one key of this name is the same for every kind of its table.
    pub(super) fn is_single(&self) -> bool {
        self.table.keys().filter(|key| key.name == self.key.name).count() == 1
    }
}

/// A value laid over the text.
#[derive(Debug)]
pub(super) struct Laid<'c> {
    pub(super) target: Target<'c>,
    /// Where the path stands.
    pub(super) at: Spot,
    pub(super) value: Spanned<DeValue<'c>>,
    used: Cell<bool>,
}

/// All that is laid over a scene's text.
#[derive(Debug, Default)]
pub(super) struct Changes<'c> {
    all: Vec<Laid<'c>>,
}

impl<'c> Changes<'c> {
    /// Changes whose values stand in these documents; says what is wrong with them.
    pub(super) fn new(changes: &'c [Change], documents: &'c [String], notes: &mut Notes) -> Self {
        let mut all: Vec<Laid<'c>> = Vec::with_capacity(changes.len());
        for (change, document) in changes.iter().zip(documents) {
            // Told behind whatever the scene's own text says.
            let (file, text) = (Arc::clone(&change.file), change.text.to_string());
            let file = notes.add(Arc::new(Text::new(file, text, vec![usize::MAX])));
            let at = Spot::new(file, change.path_range());
            match Target::of(&change.path) {
                Ok(target) => {
                    let value = DeTable::parse(document).ok();
                    let value = value.and_then(|text| text.get_ref().get("v").cloned());
                    let Some(value) = value else {
                        notes.error(at, format!("{} is no value", quoted(&change.value)));
                        continue;
                    };
                    let same = |laid: &Laid<'_>| {
                        std::ptr::eq(laid.target.key, target.key)
                            && std::ptr::eq(laid.target.list, target.list)
                            && laid.target.of == target.of
                    };
                    // The last of several counts.
                    all.retain(|laid| !same(laid));
                    all.push(Laid { target, at, value, used: Cell::new(false) });
                }
                Err((from, message, help)) => {
                    let at = Spot { start: at.start + from, ..at };
                    notes.error(at, message).help = help;
                }
            }
        }
        Self { all }
    }

    /// What is laid over a table of this list that goes by one of these names.
    pub(super) fn over(&self, list: &str, names: &[&str]) -> Vec<&Laid<'c>> {
        let is = |laid: &&Laid<'c>| {
            laid.target.list.name == list && laid.target.of.is_none_or(|of| names.contains(&of))
        };
        self.all.iter().filter(is).inspect(|laid| laid.used.set(true)).collect()
    }

    /// What no table has taken.
    pub(super) fn unused(&self) -> impl Iterator<Item = &Laid<'c>> {
        self.all.iter().filter(|laid| !laid.used.get())
    }
}
