//! A table of the text, read by its table of keys.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::change::Laid;
use super::notes::Notes;
use super::text::Spot;
use super::value::ValueReader;
use crate::color::Rgb;
use crate::diagnostic::Severity;
use crate::keys::{BACKGROUND, Default, Field, Key, Keyed, Kind, TEXTURED, Table, Value};
use crate::scene::Background;
use crate::texture::{Channel, TextureId, TextureRef};
use crate::wording::{Word, list};
use glam::{DAffine3, DVec3, DVec4};

/// What one table of the text says: every value checked, every default at hand.
#[derive(Debug)]
pub(super) struct Values {
    table: &'static Table,
    /// The table's header.
    pub(super) spot: Spot,
    /// What the selecting key says; `None`: it says nothing valid.
    word: Option<&'static str>,
    entries: Vec<Entry>,
    /// The textures that stand for values, which are numbered by this list.
    textures: Vec<String>,
}

/// The value of a key, which may be a table of its own.
pub(super) fn read_value(
    table: &'static Table,
    key: &'static Key,
    value: &Spanned<DeValue<'_>>,
    file: u32,
    textures: &mut Vec<String>,
    notes: &mut Notes,
) -> Option<Value> {
    match (key.kind, value.get_ref()) {
        (Kind::Background, DeValue::Table(inside)) => {
            let spot = Spot::new(file, value.span());
            let ends = Values::read(&BACKGROUND, inside, spot, notes);
            let (top, bottom) = (ends.color("top")?, ends.color("bottom")?);
            Some(Value::Background(Background::Gradient { top, bottom }))
        }
        (_, DeValue::Table(inside)) if key.varies => {
            let spot = Spot::new(file, value.span());
            let by = Values::read(&TEXTURED, inside, spot, notes);
            let (name, texture) = (by.text("texture")?, TextureId(textures.len() as u32));
            let (scale, offset) = (by.number("scale")? as f32, by.number("offset")? as f32);
            let channel = by.word("channel").and_then(Channel::of_word);
            textures.push(name);
            Some(Value::Textured(TextureRef { texture, scale, offset, channel }))
        }
        _ => {
            let read = ValueReader { notes, file, table: table.name, key }.read(value)?;
            if let Some(bytes) = bytes(table, key, &read) {
                say_bytes(notes, Spot::new(file, value.span()), bytes);
            }
            Some(read)
        }
    }
}

#[derive(Debug)]
struct Entry {
    key: &'static Key,
    /// Where the value stands.
    spot: Spot,
    /// `None`: something is wrong with it, and that has been said.
    value: Option<Value>,
}

impl Values {
    /// Reads a table, and says of every key what is wrong with it.
    pub(super) fn read(
        table: &'static Table,
        text: &DeTable<'_>,
        spot: Spot,
        notes: &mut Notes,
    ) -> Self {
        Self::read_changed(table, text, spot, &[], notes)
    }

    /// Reads a table over whose keys these values are laid.
    pub(super) fn read_changed(
        table: &'static Table,
        text: &DeTable<'_>,
        spot: Spot,
        over: &[&Laid<'_>],
        notes: &mut Notes,
    ) -> Self {
        let entries = Vec::with_capacity(text.len());
        let mut values = Self { table, spot, word: None, entries, textures: Vec::new() };
        values.select(text, over, notes);
        for (name, value) in text {
            let (name, at) = (name.get_ref(), Spot::new(spot.file, name.span()));
            if !over.iter().any(|laid| laid.target.key.name == name) {
                values.entry_of(name, at, value, notes);
            }
        }
        for laid in over {
            values.entry_of(laid.target.key.name, laid.at, &laid.value, notes);
        }
        values.say_missing(notes);
        values
    }

    /// Reads the value of the key that stands at a place.
    fn entry_of(&mut self, name: &str, at: Spot, value: &Spanned<DeValue<'_>>, notes: &mut Notes) {
        if Some(name) == self.table.select {
            return; // read before
        }
        match self.table.find(name, self.word) {
            Some(key) => {
                let names = &mut self.textures;
                let read = read_value(self.table, key, value, at.file, names, notes);
                let spot = Spot::new(at.file, value.span());
                self.entries.push(Entry { key, spot, value: read });
            }
            None => self.unknown(name, at, notes),
        }
    }

    /// Reads the key that decides which of the others apply.
    fn select(&mut self, text: &DeTable<'_>, over: &[&Laid<'_>], notes: &mut Notes) {
        let Some(key) = self.table.select.and_then(|name| self.table.find(name, None)) else {
            return;
        };
        let laid = over.iter().find(|laid| laid.target.key.name == key.name);
        let laid = laid.map(|laid| (&laid.value, laid.at.file));
        if let Some((value, file)) = laid.or(text.get(key.name).map(|v| (v, self.spot.file))) {
            let read = read_value(self.table, key, value, file, &mut self.textures, notes);
            if let Some(Value::Word(word)) = read {
                self.word = Some(word);
            }
            let spot = Spot::new(file, value.span());
            self.entries.push(Entry { key, spot, value: read });
        } else if let Default::Word(word) = key.default {
            self.word = Some(word);
        }
    }

    fn unknown(&self, name: &str, at: Spot, notes: &mut Notes) {
        let Table { name: table, .. } = *self.table;
        let elsewhere: Vec<_> = self.table.keys().filter(|key| key.name == name).collect();
        if let (Some(word), [_, ..]) = (self.word, &elsewhere[..]) {
            let only = elsewhere.iter().flat_map(|key| key.only).copied();
            let help = format!("it is a key of {}", list(only, "and"));
            notes
                .error(at, format!("`{name}` means nothing to {} {word} {table}", article(word)))
                .help = Some(help);
            return;
        }
        say_unknown(notes, at, name, self.table, self.word);
    }

    fn say_missing(&self, notes: &mut Notes) {
        if notes.lost_something(self.spot) {
            return; // the key may be in what could not be read
        }
        for key in self.table.keys() {
            let applies = key.only.is_empty() || self.word.is_some() && key.applies(self.word);
            if applies && matches!(key.default, Default::Required) && !self.has(key.name) {
                let table = self.table.name;
                let message = format!("this `{table}` has no `{}`", key.name);
                notes.error(self.spot, message).help =
                    Some(format!("`{}` is {}", key.name, key.kind.words()));
            }
        }
    }

    /// Whether the key is written, rightly or wrongly.
    pub(super) fn has(&self, name: &str) -> bool {
        self.entry(name).is_some()
    }

    /// Where the key's value stands; where it is not written, the table's header.
    pub(super) fn spot_of(&self, name: &str) -> Spot {
        self.entry(name).map_or(self.spot, |entry| entry.spot)
    }

    fn entry(&self, name: &str) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.key.name == name)
    }

    /// The value or its default; `None`: wrong or missing, which has been said, or the default
    /// is for the caller to work out.
    fn get(&self, name: &str) -> Option<Value> {
        match self.entry(name) {
            Some(entry) => entry.value.clone(),
            None => self.table.find(name, self.word).and_then(default),
        }
    }

    /// Puts the value of every key, or its default, where it is kept; a default that is worked out
    /// is left to the caller. `None`: something is wrong or missing, which has been said.
    pub(super) fn fill<T: Keyed>(&self, to: &mut T) -> Option<()> {
        self.fill_textured(to, |by, _, _| by)
    }

    /// The same of what textures may vary: `texture` numbers the one of this name, which stands there.
    pub(super) fn fill_textured<T: Keyed>(
        &self,
        to: &mut T,
        mut texture: impl FnMut(TextureRef, &str, Spot) -> TextureRef,
    ) -> Option<()> {
        let mut whole = Some(());
        for key in self.table.keys().filter(|key| key.applies(self.word)) {
            let Some(access) = T::access(&key.field) else { continue };
            let set = match self.get(key.name) {
                Some(Value::Textured(by)) => {
                    let name = &self.textures[by.texture.0 as usize];
                    let by = texture(by, name, self.spot_of(key.name));
                    (access.set)(to, Value::Textured(by))
                }
                Some(value) => (access.set)(to, value),
                None if self.has(key.name) || matches!(key.default, Default::Required) => None,
                None => Some(()),
            };
            whole = whole.and(set);
        }
        whole
    }

    /// Whether a key of this name applies whose value is kept in a field.
    pub(super) fn has_own(&self, name: &str) -> bool {
        let key = self.table.find(name, self.word);
        key.is_some_and(|key| !matches!(key.field, Field::None))
    }

    /// Whether a key of this name applies.
    pub(super) fn takes(&self, name: &str) -> bool {
        self.table.find(name, self.word).is_some()
    }

    pub(super) fn flag(&self, name: &str) -> Option<bool> {
        let Value::Flag(flag) = self.get(name)? else { return None };
        Some(flag)
    }

    pub(super) fn integer(&self, name: &str) -> Option<u64> {
        let Value::Integer(n) = self.get(name)? else { return None };
        Some(n)
    }

    pub(super) fn number(&self, name: &str) -> Option<f64> {
        let Value::Number(n) = self.get(name)? else { return None };
        Some(n)
    }

    pub(super) fn vector(&self, name: &str) -> Option<DVec3> {
        let Value::Vector(v) = self.get(name)? else { return None };
        Some(v)
    }

    pub(super) fn rotations(&self, name: &str) -> Option<Vec<DVec4>> {
        let Value::Rotations(rotations) = self.get(name)? else { return None };
        Some(rotations)
    }

    pub(super) fn matrix(&self, name: &str) -> Option<DAffine3> {
        let Value::Matrix(matrix) = self.get(name)? else { return None };
        Some(matrix)
    }

    pub(super) fn color(&self, name: &str) -> Option<Rgb> {
        let Value::Color(color) = self.get(name)? else { return None };
        Some(color)
    }

    pub(super) fn word(&self, name: &str) -> Option<&'static str> {
        let Value::Word(word) = self.get(name)? else { return None };
        Some(word)
    }

    /// Texts, each with its bytes in the file.
    pub(super) fn texts(&self, name: &str) -> Option<Vec<(String, Range<usize>)>> {
        let Value::Texts(texts) = self.get(name)? else { return None };
        Some(texts)
    }

    /// One number or more.
    pub(super) fn numbers(&self, name: &str) -> Option<Vec<f64>> {
        let Value::Numbers(numbers) = self.get(name)? else { return None };
        Some(numbers)
    }

    pub(super) fn text(&self, name: &str) -> Option<String> {
        let Value::Text(text) = self.get(name)? else { return None };
        Some(text)
    }
}

/// What a key's default is as a value; `None` where the reader works it out.
pub(super) fn default(key: &Key) -> Option<Value> {
    match (key.default, key.kind) {
        (Default::Required | Default::Said(_), _) => None,
        (Default::Flag(flag), _) => Some(Value::Flag(flag)),
        (Default::Integer(n), _) => Some(Value::Integer(n)),
        (Default::Number(n), Kind::Number(_) | Kind::NumberOr(..)) => Some(Value::Number(n)),
        (Default::Number(n), _) => Some(Value::Color(Rgb::grey(n as f32))),
        (Default::Pair(v), _) => Some(Value::Pair(v.into())),
        (Default::Vector(v), _) => Some(Value::Vector(v.into())),
        (Default::Size(size), _) => Some(Value::Size(size)),
        (Default::Word(word), _) => Some(Value::Word(word)),
    }
}

/// Says that a table has no such key, and what may have been meant.
pub(super) fn say_unknown(
    notes: &mut Notes,
    at: Spot,
    name: &str,
    table: &'static Table,
    word: Option<&str>,
) {
    if notes.is_full() {
        notes.count(Severity::Error);
        return;
    }
    let (message, help) = table.unknown(name, word);
    notes.error(at, message).help = Some(help);
}

/// A colour that was most likely copied from a colour picker: three whole numbers up to 255.
///
/// Materials reflect no more than they get, so there 2 is enough to doubt it. Lights and what glows
/// may be brighter than white, so there one of the numbers has to be 100.
fn bytes(table: &Table, key: &Key, value: &Value) -> Option<[u8; 3]> {
    let least = match (table.name, key.name) {
        (_, "eta" | "k") => return None,
        ("material", "emission_color") => 100.0,
        ("material" | "texture", _) => 2.0,
        _ => 100.0,
    };
    let colors: Vec<Rgb> = match value {
        Value::Color(color) | Value::Background(Background::Color(color)) => vec![*color],
        Value::Colors(colors) => colors.to_vec(),
        Value::Stops(stops) => stops.iter().map(|(_, color)| *color).collect(),
        _ => return None,
    };
    let channels = || colors.iter().flat_map(|color| color.to_array());
    let whole = channels().all(|v| (0.0..=255.0).contains(&v) && v.fract() == 0.0);
    let doubted = colors.iter().find(|color| {
        let [r, g, b] = color.to_array();
        color.max_channel() >= least && !(r == g && g == b)
    });
    let doubted = doubted.filter(|_| whole)?;
    Some(doubted.to_array().map(|v| v as u8))
}

fn say_bytes(notes: &mut Notes, at: Spot, [r, g, b]: [u8; 3]) {
    let most = r.max(g).max(b);
    let message = format!("[{r}, {g}, {b}] is {most} times as bright as white: are these bytes?");
    notes.warning(at, message).help = Some(format!(
        "in `[r, g, b]` 1 is full light, and numbers are linear; bytes are written \"#{r:02x}{g:02x}{b:02x}\""
    ));
}

fn article(word: &str) -> &'static str {
    if word.starts_with(['a', 'e', 'i', 'o', 'u']) { "an" } else { "a" }
}
