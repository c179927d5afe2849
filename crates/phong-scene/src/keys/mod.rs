//! The one table of keys of the scene text: names, kinds of value, ranges, defaults, meanings. Batch
//! files have theirs beside it.
//!
//! The reader, the writer, the check, the editor schema and the reference in the book are all made
//! from it, so what is read, written, suggested and documented cannot drift apart. Most rows say in
//! which field of what the table describes their value is kept; of such a key nothing else is written
//! anywhere.

mod batch;
mod camera;
mod camera_path;
mod field;
mod furniture;
mod hint;
mod kind;
mod light;
mod material;
mod reference;
mod scene;
mod schema;
mod shape;
mod sky;
mod texture;
mod tone;
mod value;

pub(crate) use batch::{BATCH, FILES, RANGE};
pub(crate) use camera_path::{CAMERA_KEY, CAMERA_PATH};
pub(crate) use field::{Access, Field, Keyed};
pub(crate) use furniture::LABEL;
pub(crate) use hint::of_word;
pub(crate) use kind::{Default, Kind};
pub(crate) use light::LIGHT;
pub(crate) use material::MATERIAL;
pub use reference::{batch_reference_markdown, reference_markdown};
pub(crate) use scene::{BACKGROUND, CLIP, INCLUDE, SCENE};
pub use schema::{batch_schema_json, schema_json};
pub(crate) use shape::{GROUP, MOLECULE};
pub(crate) use texture::{TEXTURE, TEXTURED};
pub(crate) use value::{Stored, Value, short};

use crate::wording::{closest, list, quoted};

/// One table of the scene text, such as `[camera]` or `[[sphere]]`.
#[derive(Debug)]
pub(crate) struct Table {
    /// Its name in the text; for shapes also what objects are called: `sphere 1`.
    pub(crate) name: &'static str,
    /// What it is, in one sentence.
    pub(crate) doc: &'static str,
    /// The key whose word decides which of the others apply (`kind`, `model`).
    pub(crate) select: Option<&'static str>,
    /// Its keys, in the order they are documented; several lists, since shapes share one.
    pub(crate) keys: &'static [&'static [Key]],
}

/// One key of a table. A name may stand several times for disjoint sets of kinds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Key {
    /// The key as it is written.
    pub(crate) name: &'static str,
    /// What may stand there.
    pub(crate) kind: Kind,
    /// What holds if it is not written.
    pub(crate) default: Default,
    /// The words of the selecting key it applies to; empty: all of them.
    pub(crate) only: &'static [&'static str],
    /// What it means, with its unit.
    pub(crate) doc: &'static str,
    /// Whether a texture may stand for the value.
    pub(crate) varies: bool,
    /// Words that are known but not built yet.
    pub(crate) later: &'static [&'static str],
    /// Where the value is kept.
    pub(crate) field: Field,
}

/// The first key of every file of ours.
const VERSION: Key = Key::new(
    "version",
    Kind::Integer(1, 1),
    Default::Said("1, with a warning"),
    "Version of this format; 1 is the only one so far.",
);

impl Key {
    /// A key for all kinds of its table.
    const fn new(name: &'static str, kind: Kind, default: Default, doc: &'static str) -> Self {
        Self { name, kind, default, only: &[], doc, varies: false, later: &[], field: Field::None }
    }

    /// The same, for these kinds alone.
    const fn only(self, only: &'static [&'static str]) -> Self {
        Self { only, ..self }
    }

    /// The same, for whose value a texture may stand.
    const fn varies(self) -> Self {
        Self { varies: true, ..self }
    }

    /// The same, of whose words these are not built yet.
    const fn later(self, later: &'static [&'static str]) -> Self {
        Self { later, ..self }
    }

    /// The same, whose value is kept there.
    const fn of(self, field: Field) -> Self {
        Self { field, ..self }
    }

    /// What may stand as its value, for the reference.
    pub(crate) fn words(&self) -> String {
        let words = self.kind.words();
        let is_more = self.varies && !matches!(self.kind, Kind::Map);
        if is_more { format!("{words}; or `{{ texture = .. }}`") } else { words }
    }

    /// Whether it applies where the selecting key says `word` (`None`: that is not known).
    pub(crate) fn applies(&self, word: Option<&str>) -> bool {
        self.only.is_empty() || word.is_none_or(|word| self.only.contains(&word))
    }
}

impl Table {
    /// All keys, in the order they are documented.
    pub(crate) fn keys(&self) -> impl Iterator<Item = &'static Key> {
        self.keys.iter().flat_map(|list| list.iter())
    }

    /// The key of this name that applies where the selecting key says `word`.
    pub(crate) fn find(&self, name: &str, word: Option<&str>) -> Option<&'static Key> {
        self.keys().find(|key| key.name == name && key.applies(word))
    }

    /// What is said of a key that the table does not have, and what may have been meant.
    pub(crate) fn unknown(&self, name: &str, word: Option<&str>) -> (String, String) {
        let known = || self.keys().filter(|key| key.applies(word)).map(|key| key.name);
        let help = match (hint::of_key(self.name, name), closest(name, known())) {
            (Some(hint), _) => hint.to_owned(),
            (None, Some(meant)) => format!("did you mean `{meant}`?"),
            (None, None) => format!("known here: {}", list(known(), "and")),
        };
        (format!("unknown key {} in this `{}`", quoted(name), self.name), help)
    }
}
