//! Values written into a scene's text, of which nothing else is changed: no blank, no comment, no order.

use serde_json::{Map, Value as Json};
use toml_edit::{Array, ArrayOfTables, DocumentMut, InlineTable, Item, Table, TableLike, Value};

/// Tables that are made where a text lacks them; everything else stands in the text, or is not written.
const MADE: [&str; 4] = ["image", "camera", "ambient", "ambient_occlusion"];

/// A scene's text with these values in it, by the paths of their keys; `null` takes a key out.
///
/// # Errors
/// Which path leads nowhere.
pub(super) fn written(text: &str, set: &Map<String, Json>) -> Result<String, String> {
    let mut document = parsed(text)?;
    put_all(&mut document, set)?;
    Ok(as_text(&document, text))
}

/// A text as tables with all its blanks and comments.
///
/// # Errors
/// If it is no TOML.
pub(super) fn parsed(text: &str) -> Result<DocumentMut, String> {
    text.parse().map_err(|_| "the text is no TOML".to_owned())
}

/// Puts these values in, by the paths of their keys; `null` takes a key out.
///
/// # Errors
/// Which path leads nowhere.
pub(super) fn put_all(document: &mut DocumentMut, set: &Map<String, Json>) -> Result<(), String> {
    set.iter().try_for_each(|(path, value)| put(document, path, value))
}

/// The text again, its lines ended as those of `before`: the writer knows one end of line only.
pub(super) fn as_text(document: &DocumentMut, before: &str) -> String {
    let out = document.to_string();
    if before.contains("\r\n") { out.replace("\r\n", "\n").replace('\n', "\r\n") } else { out }
}

/// Makes a table in another one where the text lacks it.
pub(super) fn make_table(document: &mut DocumentMut, of: &str, name: &str) {
    let outer = document.entry(of).or_insert_with(|| {
        let mut outer = Table::new();
        outer.set_implicit(true);
        Item::Table(outer)
    });
    let has_it = outer.as_table_like().is_none_or(|outer| outer.contains_key(name));
    if let (false, Item::Table(outer)) = (has_it, outer) {
        outer.insert(name, Item::Table(Table::new()));
    }
}

/// How many tables a text has in the list of this name.
pub(super) fn count(text: &str, list: &str) -> usize {
    let Ok(document) = text.parse::<DocumentMut>() else { return 0 };
    match document.get(list) {
        Some(Item::ArrayOfTables(list)) => list.len(),
        Some(Item::Value(Value::Array(list))) => list.len(),
        _ => 0,
    }
}

fn put(document: &mut DocumentMut, path: &str, new: &Json) -> Result<(), String> {
    let missing = || format!("`{path}` does not stand in this text: change it in the text");
    let has_includes = document.contains_key("include");
    let mut parts = path.split('.').peekable();
    let mut table: &mut dyn TableLike = document.as_table_mut();
    let mut in_braces = false;
    let key = loop {
        let part = parts.next().filter(|part| !part.is_empty()).ok_or_else(missing)?;
        if parts.peek().is_none() {
            break part;
        }
        if MADE.contains(&part) && !table.contains_key(part) {
            table.insert(part, Item::Table(Table::new()));
        }
        let item = table.get_mut(part).ok_or_else(missing)?;
        in_braces |= item.is_value();
        table = match item {
            Item::ArrayOfTables(_) | Item::Value(Value::Array(_)) if has_includes => {
                return Err(format!(
                    "`{path}` may stand in an included file: change it in the text"
                ));
            }
            Item::ArrayOfTables(list) => {
                let which = parts.next().ok_or_else(missing)?;
                of_list(list, which).ok_or_else(missing)?
            }
            Item::Value(Value::Array(list)) => {
                let which = parts.next().ok_or_else(missing)?;
                of_array(list, which).ok_or_else(missing)?
            }
            item => item.as_table_like_mut().ok_or_else(missing)?,
        };
    };
    if key.parse::<usize>().is_ok() {
        return Err(missing());
    }
    match (table.get_mut(key), new) {
        (_, Json::Null) => drop(table.remove(key)),
        (Some(Item::Value(old)), new) => replace(old, new)?,
        (Some(_), new) => {
            table.remove(key);
            insert(table, key, new, in_braces)?;
        }
        (None, new) => insert(table, key, new, in_braces)?,
    }
    Ok(())
}

/// The table of a list that is called by its number from 1, or by its `name`.
fn of_list<'a>(list: &'a mut ArrayOfTables, which: &str) -> Option<&'a mut dyn TableLike> {
    let named = |table: &Table| table.get("name").and_then(Item::as_str) == Some(which);
    let place = list.iter().position(named).or_else(|| place(which))?;
    list.get_mut(place).map(|table| table as &mut dyn TableLike)
}

fn of_array<'a>(list: &'a mut Array, which: &str) -> Option<&'a mut dyn TableLike> {
    let named = |value: &Value| {
        let table = value.as_inline_table();
        table.and_then(|table| table.get("name")).and_then(Value::as_str) == Some(which)
    };
    let place = list.iter().position(named).or_else(|| place(which))?;
    let table = list.get_mut(place)?.as_inline_table_mut()?;
    Some(table as &mut dyn TableLike)
}

fn place(which: &str) -> Option<usize> {
    which.parse::<usize>().ok()?.checked_sub(1)
}

/// Puts a value in the place of another; where both are lists of the same length, or tables of the
/// same keys, what stands between their parts stays too.
fn replace(old: &mut Value, new: &Json) -> Result<(), String> {
    match (&mut *old, new) {
        (Value::Array(list), Json::Array(values)) if list.len() == values.len() => {
            list.iter_mut().zip(values).try_for_each(|(old, new)| replace(old, new))
        }
        (Value::InlineTable(table), Json::Object(values))
            if table.len() == values.len() && values.keys().all(|key| table.contains_key(key)) =>
        {
            table.iter_mut().try_for_each(|(key, old)| replace(old, &values[key.get()]))
        }
        (Value::Integer(same), new) if new.as_f64() == Some(*same.value() as f64) => Ok(()),
        (Value::Float(same), new) if new.as_f64() == Some(*same.value()) => Ok(()),
        (Value::String(same), Json::String(new)) if same.value() == new => Ok(()),
        (_, new) => {
            let is_float = old.is_float();
            let mut made = as_toml(new)?;
            if let (true, Some(whole)) = (is_float, made.as_integer()) {
                made = (whole as f64).into(); // a number that was written with a point keeps it
            }
            *made.decor_mut() = old.decor().clone();
            *old = made;
            Ok(())
        }
    }
}

/// Adds a key after the others of a table, as far from the edge as they are, or from the brace.
fn insert(table: &mut dyn TableLike, key: &str, new: &Json, in_braces: bool) -> Result<(), String> {
    let mut new = as_toml(new)?;
    let last =
        table.iter().filter(|(_, item)| item.is_value()).last().map(|(key, _)| key.to_owned());
    let mut indent = None;
    if let Some(last) = last {
        let prefix = table.key(&last).and_then(|key| key.leaf_decor().prefix()?.as_str());
        let line = prefix.and_then(|prefix| prefix.rsplit('\n').next()).unwrap_or_default();
        indent = line.chars().all(char::is_whitespace).then(|| line.to_owned());
        let value = table.get_mut(&last).and_then(Item::as_value_mut).filter(|_| in_braces);
        if let Some(value) = value {
            let blank = value.decor().suffix().and_then(|suffix| suffix.as_str()).unwrap_or("");
            new.decor_mut().set_prefix(" ");
            new.decor_mut().set_suffix(blank.to_owned());
            value.decor_mut().set_suffix("");
        }
    }
    table.insert(key, Item::Value(new));
    if let Some(indent) = indent.filter(|indent| !indent.is_empty() && !in_braces)
        && let Some(mut key) = table.key_mut(key)
    {
        key.leaf_decor_mut().set_prefix(indent);
    }
    Ok(())
}

fn as_toml(json: &Json) -> Result<Value, String> {
    Ok(match json {
        Json::Null => return Err("a list has no empty places".to_owned()),
        Json::Bool(truth) => (*truth).into(),
        Json::Number(number) => match (number.as_i64(), number.as_f64()) {
            (Some(whole), _) => whole.into(),
            // Numbers are written as by hand: 2, not 2.0.
            (None, Some(float)) if float.fract() == 0.0 && float.abs() < 1e15 => {
                (float as i64).into()
            }
            (None, Some(float)) => float.into(),
            (None, None) => return Err(format!("{number} is out of range")),
        },
        Json::String(text) => text.as_str().into(),
        Json::Array(values) => {
            Value::Array(values.iter().map(as_toml).collect::<Result<Array, String>>()?)
        }
        Json::Object(values) => {
            let mut table = InlineTable::new();
            for (key, value) in values {
                table.insert(key, as_toml(value)?);
            }
            Value::InlineTable(table)
        }
    })
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    const TEXT: &str = "\
# What this shows.
version = 1   # of the format

[camera]
  eye = [ 0, 2.0,   8 ] # from here
  look_at = [
    0, # across
    1,
    0,
  ]

# The key light.
[[light]]
kind = 'point'
position=[1,2,3]

[materials]
red = { color = \"#c00\", shininess = 10 } # shiny
blue.color = \"blue\"

[[sphere]]
center = [0, 1, 0]
radius = 1
name = \"ball\"
# the end
";

    fn put_into(text: &str, path: &str, value: Json) -> Result<String, String> {
        written(text, &[(path.to_owned(), value)].into_iter().collect())
    }

    fn changed(path: &str, value: Json, from: &str, to: &str) {
        assert!(TEXT.contains(from), "{from}");
        assert_eq!(put_into(TEXT, path, value).unwrap(), TEXT.replacen(from, to, 1), "{path}");
    }

    #[test]
    fn nothing_but_the_value_is_changed() {
        changed("camera.eye", json!([0, 2.5, 8.25]), "[ 0, 2.0,   8 ]", "[ 0, 2.5,   8.25 ]");
        changed("camera.eye", json!([0, 3, 8]), "2.0,", "3.0,");
        changed("camera.look_at", json!([0.5, 1, 0]), "0, # across", "0.5, # across");
        changed("light.1.position", json!([1, 2, -3.5]), "[1,2,3]", "[1,2,-3.5]");
        changed("light.1.kind", json!("spot"), "'point'", "\"spot\"");
        changed("materials.red.shininess", json!(20.0), "10 }", "20 }");
        changed(
            "materials.blue.color",
            json!("red"),
            "blue.color = \"blue\"",
            "blue.color = \"red\"",
        );
        changed("sphere.ball.radius", json!(0.1), "radius = 1", "radius = 0.1");
        changed("sphere.1.name", json!(null), "name = \"ball\"\n", "");
        changed("version", json!(1), "1", "1");
    }

    #[test]
    fn a_key_that_is_not_there_follows_the_others() {
        changed("camera.fov", json!(30), "    0,\n  ]\n", "    0,\n  ]\n  fov = 30\n");
        changed("materials.red.k_s", json!(0.5), "10 }", "10, k_s = 0.5 }");
        changed("light.1.color", json!([1, 0.5, 0]), "[1,2,3]\n", "[1,2,3]\ncolor = [1, 0.5, 0]\n");
        let made = put_into(TEXT, "image.size", json!([320, 180])).unwrap();
        let new = "\n[image]\nsize = [320, 180]\n";
        assert!(made.contains(new), "{made}");
        assert_eq!(made.replace(new, ""), TEXT);
    }

    #[test]
    fn a_path_that_leads_nowhere_is_refused() {
        for path in [
            "light.2.color",
            "light.0.color",
            "light.1",
            "light",
            "materials.green.color",
            "",
            "sphere",
            "a..b",
            "sphere.ball",
        ] {
            let put = put_into(TEXT, path, json!(1));
            assert!(put.is_err() || !TEXT.contains("light = "), "{path}: {put:?}");
        }
        let included = format!("{TEXT}[[include]]\nfile = \"b.toml\"\n");
        let said = put_into(&included, "light.1.color", json!(1)).unwrap_err();
        assert!(said.contains("included"), "{said}");
        assert!(put_into("a = [", "a", json!(1)).is_err());
    }

    #[test]
    fn lines_end_as_they_did() {
        let text = TEXT.replace('\n', "\r\n");
        let made = put_into(&text, "sphere.1.radius", json!(2)).unwrap();
        assert_eq!(made, text.replace("radius = 1", "radius = 2"));
    }

    #[test]
    fn every_scene_of_the_gallery_stays_as_it_is() {
        let gallery = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes");
        for file in std::fs::read_dir(gallery).unwrap() {
            let path = file.unwrap().path();
            if path.extension().is_some_and(|ending| ending == "toml") {
                let text = std::fs::read_to_string(&path).unwrap();
                assert_eq!(written(&text, &Map::new()).unwrap(), text, "{}", path.display());
            }
        }
    }
}
