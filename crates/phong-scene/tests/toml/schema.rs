//! The schema for editors accepts what the reader accepts.

use std::fs;

use serde_json::Value;

/// Whether a value fits a schema, for the words of JSON schema that ours is made of.
fn fits(schema: &Value, value: &Value) -> bool {
    let words = schema.as_object().into_iter().flatten();
    words.into_iter().all(|(word, says)| match word.as_str() {
        "$schema" | "title" | "description" | "default" | "then" => true,
        "type" => is(value, says.as_str().expect("a type")),
        "enum" => says.as_array().expect("a list").contains(value),
        "const" => says == value,
        "minimum" => value.as_f64() >= says.as_f64(),
        "maximum" => value.as_f64() <= says.as_f64(),
        "exclusiveMinimum" => value.as_f64() > says.as_f64(),
        "exclusiveMaximum" => value.as_f64() < says.as_f64(),
        "minLength" => value.as_str().is_some_and(|text| text.len() as u64 >= count(says)),
        "items" => value.as_array().is_none_or(|items| items.iter().all(|item| fits(says, item))),
        "minItems" => value.as_array().is_none_or(|a| a.len() as u64 >= count(says)),
        "maxItems" => value.as_array().is_none_or(|a| a.len() as u64 <= count(says)),
        "required" => says
            .as_array()
            .expect("a list")
            .iter()
            .all(|key| !value[key.as_str().expect("a key")].is_null()),
        "properties" => entries(value).all(|(key, value)| {
            says.get(key).is_none_or(|schema| *schema != Value::Bool(false) && fits(schema, value))
        }),
        "additionalProperties" => {
            let others = entries(value).filter(|(key, _)| schema["properties"].get(key).is_none());
            others.into_iter().all(|(_, value)| says.is_object() && fits(says, value))
        }
        "anyOf" => says.as_array().expect("a list").iter().any(|schema| fits(schema, value)),
        "allOf" => says.as_array().expect("a list").iter().all(|schema| fits(schema, value)),
        "if" => !fits(says, value) || fits(&schema["then"], value),
        "not" => !fits(says, value),
        other => panic!("the schema uses `{other}`, which this test does not know"),
    })
}

fn count(says: &Value) -> u64 {
    says.as_u64().expect("a count")
}

fn entries(value: &Value) -> impl Iterator<Item = (&String, &Value)> {
    value.as_object().into_iter().flatten()
}

fn is(value: &Value, kind: &str) -> bool {
    match kind {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "boolean" => value.is_boolean(),
        "number" => value.is_number(),
        "integer" => value.is_u64() || value.is_i64(),
        other => panic!("`{other}` is no type of ours"),
    }
}

fn file_fits(schema: &Value, path: &str) -> bool {
    let text = fs::read_to_string(crate::folder().join(path)).expect("a scene");
    let table: toml::Table = text.trim_start_matches('\u{feff}').parse().expect("TOML");
    fits(schema, &serde_json::to_value(table).expect("JSON"))
}

#[test]
fn the_schema_accepts_every_good_scene() {
    let schema = serde_json::from_str(&phong_scene::schema_json()).expect("JSON");
    for file in fs::read_dir(crate::folder().join("good")).expect("the folder") {
        let name = file.expect("a file").file_name().into_string().expect("a name");
        let Some(name) = name.strip_suffix(".toml") else { continue };
        // Its seed is beyond i64, which this test's own reader of TOML does not take.
        if name != "a_background_may_run_from_top_to_bottom" {
            assert!(file_fits(&schema, &format!("good/{name}.toml")), "{name}");
        }
    }
}

#[test]
fn the_schema_refuses_what_one_value_alone_is_wrong_about() {
    let schema = serde_json::from_str(&phong_scene::schema_json()).expect("JSON");
    for name in [
        "a_background_table_has_two_colours",
        "a_colour_is_never_negative",
        "a_key_of_another_kind_is_told_so",
        "a_key_that_the_model_does_not_use_is_wrong",
        "a_wrong_type_says_what_is_wanted_and_what_was_found",
        "an_unknown_key_says_what_was_meant",
        "an_unknown_word_says_what_was_meant",
        "every_number_out_of_range_is_told_at_its_place",
        "one_table_and_several_are_not_the_same",
        "the_only_version_is_one",
        "what_is_required_and_missing_is_told_at_its_table",
    ] {
        assert!(!file_fits(&schema, &format!("bad/{name}.toml")), "{name}");
    }
}
