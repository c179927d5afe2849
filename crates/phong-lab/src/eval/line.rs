//! A line of JSON: read so that no key stands twice in any object, and its `id` found whatever else
//! is wrong with it.

use std::fmt::{self, Formatter};

use serde::Deserializer as _;
use serde::de::{DeserializeSeed, Error, IgnoredAny, MapAccess, SeqAccess, Visitor};
use serde_json::error::Category;
use serde_json::{Deserializer, Map, Value as Json};

/// What others write for values that JSON does not have; the longer of two before its beginning.
const NO_NUMBERS: [&str; 6] = ["NaN", "nan", "Infinity", "infinity", "inf", "Inf"];

/// The value that a line is.
///
/// # Errors
/// Why it is none, with the column.
pub(super) fn read(line: &[u8]) -> Result<Json, String> {
    let mut text = Deserializer::from_slice(line);
    let read = Strict.deserialize(&mut text).and_then(|value| text.end().map(|()| value));
    read.map_err(|error| wrong(line, &error))
}

/// The `id` of a line that cannot be read, as far as it can be told.
pub(super) fn id(line: &[u8]) -> Json {
    let mut id = None;
    // What follows the id may be anything: what was found before it broke off is what counts.
    let text = &zeros_for_no_numbers(line);
    let _ = Deserializer::from_slice(text).deserialize_map(IdOnly(&mut id));
    id.unwrap_or(Json::Null)
}

fn wrong(line: &[u8], error: &serde_json::Error) -> String {
    let column = error.column();
    let rest = &line[column.saturating_sub(1).min(line.len())..];
    let rest = rest.strip_prefix(b"-").unwrap_or(rest);
    if let Some(name) = NO_NUMBERS.iter().find(|name| rest.starts_with(name.as_bytes())) {
        return format!("{name} is not a number (column {column}): all must be finite");
    }
    let said = error.to_string();
    let said = said.split(" at line").next().unwrap_or(&said);
    match error.classify() {
        Category::Data => format!("{said} (column {column})"),
        _ if said == "number out of range" => {
            format!("a number is beyond what can be read (column {column}): all must be finite")
        }
        _ => format!("not JSON: {said} (column {column})"),
    }
}

/// The line with 0 for every such word outside a text, each as long as before.
fn zeros_for_no_numbers(line: &[u8]) -> Vec<u8> {
    let mut out = line.to_vec();
    let (mut at, mut in_text) = (0, false);
    while at < out.len() {
        match out[at] {
            b'\\' if in_text => at += 1,
            b'"' => in_text = !in_text,
            _ if in_text => {}
            _ => {
                let word = NO_NUMBERS.iter().find(|name| out[at..].starts_with(name.as_bytes()));
                if let Some(word) = word {
                    out[at..at + word.len()].fill(b' ');
                    out[at] = b'0';
                    at += word.len() - 1;
                }
            }
        }
        at += 1;
    }
    out
}

/// Reads any value, and refuses objects with a key twice.
struct Strict;

impl<'de> DeserializeSeed<'de> for Strict {
    type Value = Json;

    fn deserialize<D: serde::Deserializer<'de>>(self, from: D) -> Result<Json, D::Error> {
        from.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Strict {
    type Value = Json;

    fn expecting(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str("any JSON value")
    }

    fn visit_unit<E: Error>(self) -> Result<Json, E> {
        Ok(Json::Null)
    }

    fn visit_bool<E: Error>(self, value: bool) -> Result<Json, E> {
        Ok(value.into())
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<Json, E> {
        Ok(value.into())
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<Json, E> {
        Ok(value.into())
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<Json, E> {
        Ok(value.into())
    }

    fn visit_str<E: Error>(self, value: &str) -> Result<Json, E> {
        Ok(value.into())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Json, A::Error> {
        let mut list = Vec::new();
        while let Some(item) = items.next_element_seed(Self)? {
            list.push(item);
        }
        Ok(Json::Array(list))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Json, A::Error> {
        let mut object = Map::new();
        while let Some(key) = entries.next_key::<String>()? {
            if object.contains_key(&key) {
                return Err(A::Error::custom(format!("the key {key:?} stands twice")));
            }
            object.insert(key, entries.next_value_seed(Self)?);
        }
        Ok(Json::Object(object))
    }
}

/// Finds the `id` of an object; one that stands twice is none.
struct IdOnly<'a>(&'a mut Option<Json>);

impl<'de> Visitor<'de> for IdOnly<'_> {
    type Value = ();

    fn expecting(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str("an object")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<(), A::Error> {
        let mut found = false;
        while let Some(key) = entries.next_key::<String>()? {
            if key != "id" {
                // Numbers that nothing can hold are skipped like any.
                entries.next_value::<IgnoredAny>()?;
            } else if found {
                *self.0 = None;
                return Ok(());
            } else {
                found = true;
                *self.0 = Some(entries.next_value()?);
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn assert_wrong(line: &str, own_id: Json, told: &str) {
        assert_eq!((id(line.as_bytes()), read(line.as_bytes())), (own_id, Err(told.to_owned())));
    }

    #[test]
    fn the_id_is_found_before_and_behind_what_cannot_be_read() {
        for number in ["1e999", "-1e999", "NaN", "-Infinity", "inf"] {
            for line in [
                format!(r#"{{"id": "x\"NaN", "N": [0, {number}, 1]}}"#),
                format!(r#"{{"N": [0, {number}, 1], "id": "x\"NaN"}}"#),
            ] {
                let told = read(line.as_bytes()).unwrap_err();
                assert!(told.contains("all must be finite"), "{line}: {told}");
                assert_eq!(id(line.as_bytes()), "x\"NaN", "{line}");
            }
        }
        assert_wrong(r#"{"id": 7, "N" 3}"#, 7.into(), "not JSON: expected `:` (column 15)");
        assert_wrong(r#"{"id": 7"#, 7.into(), "not JSON: EOF while parsing an object (column 8)");
        assert_wrong(r#"{"id": 7} x"#, 7.into(), "not JSON: trailing characters (column 11)");
    }

    #[test]
    fn an_id_that_is_not_there_or_cannot_be_told_is_null() {
        for line in ["", "[1e999]", r#"{"id": 1e999}"#, r#"{"N" 1, "id": 3}"#, "{\"id\": \"\u{7f}"]
        {
            assert_eq!(id(line.as_bytes()), Json::Null, "{line}");
        }
        assert_eq!(id(b"{\"id\": \"\xff\"}"), Json::Null);
    }

    #[test]
    fn a_key_that_stands_twice_is_told_however_deep() {
        let twice = |key: &str, column| format!("the key \"{key}\" stands twice (column {column})");
        assert_wrong(r#"{"id": 1, "N": 1, "N": 1}"#, 1.into(), &twice("N", 21));
        assert_wrong(r#"{"id": 1, "params": {"a": 1, "a": 2}}"#, 1.into(), &twice("a", 32));
        assert_wrong(r#"{"l": [{"L": 1, "L": 1}], "id": 1}"#, 1.into(), &twice("L", 19));
        assert_wrong(r#"{"id": 1, "id": 2}"#, Json::Null, &twice("id", 14));
    }

    #[test]
    fn what_is_right_is_read_as_it_is_written() {
        let line = r#"{"a": [1, -2, 0.1, "\u00e9", null, true, {}], "b": 18446744073709551615}"#;
        let read = read(line.as_bytes()).unwrap();
        assert_eq!(read, serde_json::from_str::<Json>(line).unwrap());
    }
}
