//! A look by its name, put on what is open: written into its text, or put on a bare model itself.

use phong::scene::{NamedLook, Scene, closest};
use serde_json::{Map, Value as Json};
use toml_edit::{DocumentMut, Item, Table};

use super::look;
use super::opened::{Files, Opened};
use super::writing::{as_text, make_table, parsed, put_all};

/// The tables that a look replaces as they are.
const TABLES: [&str; 6] = ["light", "ambient", "ambient_occlusion", "sky", "fog", "outline"];

/// What of a look a text cannot say.
const COLORS_STAY: &str = "colours that objects bring along stay: a text does not take them away";

/// The look of this name.
pub(super) fn look_of(name: &str) -> Result<NamedLook, String> {
    NamedLook::from_name(name).ok_or_else(|| {
        let names = NamedLook::ALL.map(NamedLook::name);
        let meant = closest(name, names).map(|known| format!(": did you mean `{known}`?"));
        let meant = meant.unwrap_or_else(|| format!(" (there are {})", names.join(", ")));
        format!("there is no look `{name}`{meant}")
    })
}

impl Opened {
    /// The same with a look on, as [`Self::dress`] or [`Self::put_on`] would have it.
    pub(super) fn with_look(&self, look: NamedLook, files: Files<'_>) -> Result<Self, String> {
        let mut next = self.clone();
        if self.text().is_none() {
            next.dress(Some(look), files)?;
        } else {
            next.put_on(look, files)?;
        }
        Ok(next)
    }

    /// Puts a look on a bare model, or takes it off; after an error it is to be put back as it was.
    pub(super) fn dress(
        &mut self,
        look: Option<NamedLook>,
        files: Files<'_>,
    ) -> Result<(), String> {
        self.dressed = look;
        let set = std::mem::take(&mut self.set);
        self.read(files)?;
        self.lay(set, files)
    }

    /// Writes a look into the text, seen as the picture is seen now; what there is to say about it.
    /// Where the text has no place for it, all is as it was.
    pub(super) fn put_on(
        &mut self,
        look: NamedLook,
        files: Files<'_>,
    ) -> Result<Option<&'static str>, String> {
        let text = self.text().ok_or("a bare model has no text")?;
        if !self.is_sound() {
            return Err("a look is not written into a text that cannot be read".to_owned());
        }
        let said = |diagnostic: Box<phong::scene::Diagnostic>| look::in_short(&diagnostic);
        let before = self.base()?.scene.look_text().map_err(said)?;
        let mut wanted = self.scene()?;
        wanted.put_on(look);
        let after = wanted.look_text().map_err(said)?;
        let elsewhere = || {
            let name = look.name();
            format!(
                "the look cannot be written here: some of what it changes stands in another file; \
                 `phong render --look {name}` draws it"
            )
        };
        let text = dressed(text, &before, &after).map_err(|_| elsewhere())?;
        let mut next = self.with_text(text);
        next.read(files)?;
        if !next.is_sound() {
            return Err(elsewhere());
        }
        // The view stays laid over the text; what is laid over the rest would hide the look.
        let mut set = self.set.clone();
        set.retain(|path, _| !is_changed(path));
        next.lay(set, files)?;
        let now = next.scene()?;
        if now.look_text().map_err(said)? != after {
            return Err(elsewhere());
        }
        let note = (brings_colors(&now) && !brings_colors(&wanted)).then_some(COLORS_STAY);
        *self = next;
        Ok(note)
    }
}

/// Whether a look changes the value of this path.
fn is_changed(path: &str) -> bool {
    let first = path.split('.').next().unwrap_or_default();
    TABLES.contains(&first) || first == "materials" || path.starts_with("image.background")
}

/// Whether any object has colours of its own beside its material's.
fn brings_colors(scene: &Scene) -> bool {
    scene.all_objects().any(|object| object.shape.has_colors())
}

/// A text with what changes from one text of a look to the other; all else of it stays.
fn dressed(text: &str, before: &str, after: &str) -> Result<String, String> {
    let (mut document, before, after) = (parsed(text)?, parsed(before)?, parsed(after)?);
    for name in TABLES {
        let [old, new] = [&before, &after].map(|document| document.get(name));
        if old.map(Item::to_string) == new.map(Item::to_string) {
            continue;
        }
        let gone = document.remove(name);
        if let Some(new) = new {
            let mut new = new.clone();
            stand_where(&mut new, gone.as_ref());
            document.insert(name, new);
        }
    }
    let mut set = Map::new();
    let image = |document: &DocumentMut| document.get("image")?.get("background").map(json);
    if image(&before) != image(&after) {
        let background = image(&after).unwrap_or(Json::Null);
        set.insert("image.background".to_owned(), background);
    }
    for (name, new) in
        after.get("materials").and_then(Item::as_table_like).into_iter().flat_map(|t| t.iter())
    {
        let old = before.get("materials").and_then(|all| all.get(name));
        let values = |item: Option<&Item>| -> Map<String, Json> {
            let table = item.and_then(Item::as_table_like);
            table
                .into_iter()
                .flat_map(|t| t.iter())
                .map(|(key, value)| (key.to_owned(), json(value)))
                .collect()
        };
        let (old, new) = (values(old), values(Some(new)));
        let gone = old.keys().filter(|key| !new.contains_key(*key));
        let mut changes: Map<String, Json> =
            gone.map(|key| (format!("materials.{name}.{key}"), Json::Null)).collect();
        let differ = new.into_iter().filter(|(key, value)| old.get(key) != Some(value));
        changes.extend(differ.map(|(key, value)| (format!("materials.{name}.{key}"), value)));
        if changes.is_empty() {
            continue;
        }
        make_table(&mut document, "materials", name);
        set.append(&mut changes);
    }
    put_all(&mut document, &set)?;
    Ok(as_text(&document, text))
}

/// Puts new tables in the place of the one that is gone, under the comment that stood above it.
fn stand_where(new: &mut Item, gone: Option<&Item>) {
    let first = match gone {
        Some(Item::Table(table)) => Some(table),
        Some(Item::ArrayOfTables(list)) => list.get(0),
        _ => None,
    };
    let place = first.and_then(Table::position);
    let above = first.and_then(|table| table.decor().prefix()?.as_str()).map(str::to_owned);
    let put = |table: &mut Table, above: &str| {
        table.set_position(place);
        table.decor_mut().set_prefix(above);
    };
    match new {
        Item::Table(table) => put(table, above.as_deref().unwrap_or("\n")),
        Item::ArrayOfTables(list) => {
            for (number, table) in list.iter_mut().enumerate() {
                put(table, above.as_deref().filter(|_| number == 0).unwrap_or("\n"));
            }
        }
        _ => {}
    }
}

/// A value of TOML as the other texts have it.
fn json(item: &Item) -> Json {
    let of_value = |text: String| -> Option<Json> {
        let table: toml::Table = toml::from_str(&format!("v = {}", text.trim())).ok()?;
        serde_json::to_value(table.get("v")?).ok()
    };
    match item {
        Item::Value(value) => of_value(value.to_string()).unwrap_or(Json::Null),
        item => item.as_table_like().map_or(Json::Null, |table| {
            table
                .iter()
                .map(|(key, item)| (key.to_owned(), json(item)))
                .collect::<Map<_, _>>()
                .into()
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "\
# What this shows.
version = 1 # of the format

[image]
size = [320, 180] # small

# The key light.
[[light]]
kind = 'point'
position = [1, 2, 3]

# Plastic.
[materials.red]
color = \"#c00\" # shiny
k_s = 0.5 # this much

# The ball.
[[sphere]]
center = [0, 1, 0]
material = \"red\"
";

    #[test]
    fn what_a_look_does_not_change_stays_with_its_comments() {
        let before = "[[light]]\nkind = \"point\"\nposition = [1, 2, 3]\n[materials.red]\ncolor = \"#c00\"\nk_s = 0.5\n";
        let after = "[image]\nbackground = 1\n[fog]\nstart = 1\nend = 2\n[[light]]\nkind = \"distant\"\n[[light]]\nkind = \"spot\"\n\
            [materials.red]\ncolor = \"#c00\"\nk_s = 0.2\nk_a = 0.5\n";
        let out = dressed(TEXT, before, after).unwrap();
        let wanted = TEXT
            .replace("# small\n", "# small\nbackground = 1\n")
            .replace(
                "kind = 'point'\nposition = [1, 2, 3]\n",
                "kind = \"distant\"\n\n[[light]]\nkind = \"spot\"\n",
            )
            .replace("k_s = 0.5 # this much\n", "k_s = 0.2 # this much\nk_a = 0.5\n");
        assert!(out.contains("[fog]\nstart = 1\nend = 2\n"), "{out}");
        assert_eq!(out.replace("\n[fog]\nstart = 1\nend = 2\n", ""), wanted);
        let windows = dressed(&TEXT.replace('\n', "\r\n"), before, after).unwrap();
        assert_eq!(windows, out.replace('\n', "\r\n"));
    }

    #[test]
    fn a_look_that_nobody_knows_is_refused_with_the_one_that_was_meant() {
        assert_eq!(look_of("ink"), Ok(NamedLook::Ink));
        assert!(look_of("inc").unwrap_err().contains("did you mean `ink`"));
        assert!(look_of("photograph").unwrap_err().contains("publication"));
    }
}
