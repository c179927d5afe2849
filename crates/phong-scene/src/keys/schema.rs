//! The scene text as a JSON schema, for editors: completion, hover and errors while typing.

use serde_json::{Map, Value, json};

use super::{BACKGROUND, BATCH, Default, FILES, Key, Kind, RANGE, SCENE, TEXTURED, Table};
use crate::color::maps;
use crate::limits::{LARGEST, Range};
use crate::scene::Image;

/// The scene text as a JSON schema (draft 7, which TOML editors understand).
///
/// The reader reads by the very same tables of keys. What only several keys together can be wrong
/// about, the schema does not know: an eye where `look_at` is, a name that is not defined.
///
/// ```
/// let schema = phong_scene::schema_json();
/// assert!(schema.contains("\"$schema\": \"http://json-schema.org/draft-07/schema#\""));
/// assert!(schema.contains("Vertical field of view, degrees."));
/// ```
pub fn schema_json() -> String {
    let mut schema = object(&SCENE);
    schema.insert("$schema".into(), json!("http://json-schema.org/draft-07/schema#"));
    schema.insert("title".into(), json!("phong scene"));
    // Included files are scene files as well, and have no camera.
    schema.remove("required");
    format!("{:#}\n", Value::Object(schema))
}

/// A batch file as a JSON schema, as [`schema_json`] is of the scene text.
///
/// ```
/// assert!(phong_scene::batch_schema_json().contains("phong batch"));
/// ```
pub fn batch_schema_json() -> String {
    let mut schema = object(&BATCH);
    schema.insert("$schema".into(), json!("http://json-schema.org/draft-07/schema#"));
    schema.insert("title".into(), json!("phong batch"));
    format!("{:#}\n", Value::Object(schema))
}

/// A table: its keys and no others, and which of them go with which kind.
fn object(table: &Table) -> Map<String, Value> {
    let mut values: Vec<(&str, Vec<Value>)> = Vec::new();
    for key in table.keys() {
        match values.iter_mut().find(|(name, _)| *name == key.name) {
            Some((_, known)) => known.push(value(key)),
            None => values.push((key.name, vec![value(key)])),
        }
    }
    let mut properties = Map::new();
    for (name, mut all) in values {
        // The same name for other kinds: any will do here, the conditions below tell.
        let schema = if all.len() == 1 { all.swap_remove(0) } else { json!({ "anyOf": all }) };
        properties.insert(name.into(), schema);
    }
    let mut schema = Map::new();
    schema.insert("type".into(), json!("object"));
    schema.insert("description".into(), json!(table.doc));
    schema.insert("properties".into(), Value::Object(properties));
    schema.insert("additionalProperties".into(), json!(false));
    schema.insert("required".into(), required(table, |key| key.only.is_empty()));
    if let Some(select) = table.select {
        schema.insert("allOf".into(), conditions(table, select));
    }
    schema
}

fn required(table: &Table, applies: impl Fn(&Key) -> bool) -> Value {
    let required = table.keys().filter(|key| matches!(key.default, Default::Required));
    required.filter(|key| applies(key)).map(|key| json!(key.name)).collect()
}

/// For each word of the selecting key: what goes with it, and how.
fn conditions(table: &Table, select: &str) -> Value {
    let Some(Key { kind: Kind::Word(words), default, .. }) = table.find(select, None) else {
        return json!([]);
    };
    let condition = |&word: &&'static str| {
        let mut properties = Map::new();
        for key in table.keys().filter(|key| !key.only.is_empty()) {
            let schema = table.find(key.name, Some(word)).map_or(json!(false), value);
            properties.insert(key.name.into(), schema);
        }
        // Where the key is not written its default counts, else it must be written.
        let written = match default {
            Default::Word(default) if *default == word => json!([]),
            _ => json!([select]),
        };
        json!({
            "if": { "properties": { select: { "const": word } }, "required": written },
            "then": {
                "properties": properties,
                "required": required(table, |key| key.only.contains(&word)),
            },
        })
    };
    words.iter().map(condition).collect()
}

/// What may stand as a key's value, with its meaning and default.
fn value(key: &Key) -> Value {
    let mut schema = kind(key.kind);
    if key.varies && !matches!(key.kind, Kind::Map) {
        schema = json!({ "anyOf": [schema, object(&TEXTURED)] });
    }
    if let Value::Object(schema) = &mut schema {
        schema.insert("description".into(), json!(key.doc));
        let default = match key.default {
            Default::Required | Default::Said(_) => None,
            Default::Flag(flag) => Some(json!(flag)),
            Default::Integer(n) => Some(json!(n)),
            Default::Number(n) => Some(json!(n)),
            Default::Pair(v) => Some(json!(v)),
            Default::Vector(v) => Some(json!(v)),
            Default::Size(size) => Some(json!(size)),
            Default::Word(word) => Some(json!(word)),
        };
        if let Some(default) = default {
            schema.insert("default".into(), default);
        }
    }
    schema
}

fn kind(kind: Kind) -> Value {
    match kind {
        Kind::Flag => json!({ "type": "boolean" }),
        Kind::Integer(min, max) => json!({ "type": "integer", "minimum": min, "maximum": max }),
        Kind::Number(range) => number(&range),
        Kind::NumberOr(range, word) => json!({ "anyOf": [number(&range), { "enum": [word] }] }),
        Kind::Point | Kind::Direction => list(&any_number(), 3),
        Kind::Color | Kind::ColorOrObject => color(LARGEST), // "object" is among its texts
        Kind::Reflectance => color(1.0),
        Kind::Background => json!({ "anyOf": [color(LARGEST), object(&BACKGROUND)] }),
        Kind::Word(words) => json!({ "enum": words }),
        Kind::Text | Kind::File | Kind::Material | Kind::Group | Kind::Texture => text(),
        Kind::Size => {
            list(&json!({ "type": "integer", "minimum": 1, "maximum": Image::LARGEST }), 2)
        }
        Kind::Attenuation => list(&number(&Range::NOT_NEGATIVE), 3),
        Kind::Points | Kind::Directions => list(&list(&any_number(), 3), 3),
        Kind::Pair => list(&any_number(), 2),
        Kind::Uvs => list(&list(&any_number(), 2), 3),
        Kind::Smooth => {
            json!({ "anyOf": [{ "type": "boolean" }, number(&Range::closed(0.0, 180.0))] })
        }
        Kind::Scale => json!({ "anyOf": [any_number(), list(&any_number(), 3)] }),
        Kind::Rotate => {
            let rotation = list(&any_number(), 4);
            json!({ "anyOf": [rotation, { "type": "array", "items": rotation }] })
        }
        Kind::Matrix => list(&list(&any_number(), 4), 4),
        Kind::TwoColors => list(&color(LARGEST), 2),
        Kind::Stops => json!({ "anyOf": [{ "enum": maps::NAMES }, {
            "type": "array",
            "minItems": 1,
            "items": {
                "type": "array",
                "items": [number(&Range::closed(0.0, 1.0)), color(LARGEST)],
                "minItems": 2,
                "maxItems": 2,
            },
        }] }),
        Kind::Map => Value::Object(object(&TEXTURED)),
        Kind::Table(table) => Value::Object(object(table)),
        Kind::Tables(table) => json!({ "type": "array", "items": object(table) }),
        Kind::Named(table) => json!({ "type": "object", "additionalProperties": object(table) }),
        Kind::Cap => json!({ "anyOf": [{ "type": "boolean" }, text()] }),
        Kind::Names => json!({ "type": "array", "items": text(), "minItems": 1 }),
        Kind::Files => json!({ "anyOf": [text(), { "type": "array", "items": text() }] }),
        Kind::Numbers => json!({ "anyOf": [any_number(), {
            "type": "array", "items": any_number(), "minItems": 1,
        }] }),
        Kind::Counts(most) => list(&json!({ "type": "integer", "minimum": 1, "maximum": most }), 3),
        Kind::Interval => json!({ "anyOf": [{ "enum": ["auto"] }, list(&any_number(), 2)] }),
        Kind::Values => json!({ "type": "object", "additionalProperties": { "anyOf": [
            { "type": "array", "minItems": 1 },
            object(&RANGE),
            object(&FILES),
            { "type": ["number", "string", "boolean", "object"] },
        ] } }),
        Kind::Options => json!({ "type": "object", "additionalProperties": {
            "type": ["string", "number", "boolean"],
        } }),
    }
}

fn any_number() -> Value {
    json!({ "type": "number" })
}

fn number(range: &Range) -> Value {
    let mut schema = Map::new();
    schema.insert("type".into(), json!("number"));
    let lower = if range.min_included { "minimum" } else { "exclusiveMinimum" };
    schema.insert(lower.into(), json!(range.min));
    let upper = if range.max_included { "maximum" } else { "exclusiveMaximum" };
    schema.insert(upper.into(), json!(range.max));
    Value::Object(schema)
}

fn color(most: f64) -> Value {
    let channel = number(&Range::closed(0.0, most));
    let titled = |mut schema: Value, title: &str| {
        schema["title"] = json!(title);
        schema
    };
    json!({ "anyOf": [
        titled(channel.clone(), "linear grey"),
        titled(list(&channel, 3), "linear red, green, blue"),
        titled(text(), "\"#rrggbb\" or a CSS name: sRGB, decoded"),
    ] })
}

fn text() -> Value {
    json!({ "type": "string", "minLength": 1 })
}

/// So many of these.
fn list(item: &Value, count: usize) -> Value {
    json!({ "type": "array", "items": item, "minItems": count, "maxItems": count })
}
