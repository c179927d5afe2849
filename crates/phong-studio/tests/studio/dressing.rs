//! Looks by name, put on what is open.

use phong::scene::{Memory, NamedLook};
use phong_studio::engine::{Bounds, Engine};
use serde_json::{Value, json};

use crate::SCENE;
use crate::client::Page;
use crate::engine::{Talk, scene};

const MODEL: &str = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

/// What a text says, however it is written; 1 and 1.0 are the same.
fn values(text: &str) -> Value {
    fn alike(value: &mut Value) {
        match value {
            Value::Number(number) => *value = json!(number.as_f64()),
            Value::Array(values) => values.iter_mut().for_each(alike),
            Value::Object(values) => values.values_mut().for_each(alike),
            _ => {}
        }
    }
    let table: toml::Table = toml::from_str(text).unwrap();
    let mut value = serde_json::to_value(table).unwrap();
    alike(&mut value);
    value
}

#[test]
fn every_look_is_written_into_the_text_as_the_program_prints_it() {
    let text = SCENE.replace("[materials.plastic]", "# A dull plastic.\n[materials.plastic]");
    for look in NamedLook::ALL {
        let mut talk = Talk::of(&text);
        talk.ask(&json!({ "do": "put-on", "look": look.name() }));
        let told = talk.page.last("text");
        assert_eq!(told["note"], json!(null));
        let written = told["text"].as_str().unwrap();
        assert!(written.contains("# A dull plastic.\n[materials.plastic]"), "{written}");
        let mut wanted = scene(&[]);
        wanted.put_on(look);
        let (now, wanted) = (values(written), values(&wanted.look_text().unwrap()));
        for key in ["light", "ambient", "ambient_occlusion", "sky", "fog", "outline"] {
            assert_eq!(now.get(key), wanted.get(key), "{} of {}", key, look.name());
        }
        for (name, material) in wanted["materials"].as_object().unwrap() {
            for (key, value) in material.as_object().unwrap() {
                assert_eq!(&now["materials"][name][key], value, "{name}.{key} of {}", look.name());
            }
        }
        // The text as it was comes back with the picture that it had.
        talk.ask(&json!({ "do": "edit", "text": text, "set": {} }));
        assert_eq!(talk.page.last("look")["values"], Talk::of(&text).page.last("look")["values"]);
    }
}

#[test]
fn a_look_is_lit_as_the_picture_is_seen_and_what_hides_it_is_taken_back() {
    let mut talk = Talk::of(SCENE);
    talk.ask(&json!({ "do": "turn", "by": [0.3, 0] }));
    talk.ask(
        &json!({ "do": "look", "set": { "materials.plastic.k_s": 0.9, "light.1.color": "red" } }),
    );
    talk.ask(&json!({ "do": "put-on", "look": "pymol" }));
    let look = talk.page.last("look");
    let left: Vec<&String> = look["set"].as_object().unwrap().keys().collect();
    assert!(left.iter().all(|path| path.starts_with("camera.")) && !left.is_empty(), "{left:?}");
    // 0.3 is the default.
    assert_eq!(look["values"]["materials"]["plastic"]["k_s"], json!(null));
    let number = |value: &Value| value.as_f64().unwrap();
    let camera = &look["values"]["camera"];
    let (eye, at) = (&camera["eye"], &camera["look_at"]);
    let across = [0, 2].map(|i| number(&at[i]) - number(&eye[i]));
    let light = &look["values"]["light"][0]["direction"];
    let shines = [0, 2].map(|i| number(&light[i]));
    // The light beside the eye shines along the view.
    assert!((across[0] * shines[1] - across[1] * shines[0]).abs() < 1e-6, "{across:?} {shines:?}");
}

#[test]
fn a_look_that_is_unknown_or_has_no_place_in_the_text_is_refused_and_all_is_as_it_was() {
    let mut talk = Talk::of(SCENE);
    talk.ask(&json!({ "do": "put-on", "look": "inc" }));
    assert!(talk.page.last("error")["message"].as_str().unwrap().contains("did you mean `ink`"));
    talk.ask(&json!({ "do": "put-on", "look": null }));
    assert!(talk.page.last("error")["message"].as_str().unwrap().contains("undo"));
    assert_eq!(talk.page.all("look").len(), 1);
    let lights = "version = 1\n[[light]]\nkind = \"point\"\nposition = [0, 5, 5]\n";
    let files = Memory::new().with("b.toml", lights);
    let files = files.with("a.toml", format!("{SCENE}[[include]]\nfile = \"b.toml\"\n"));
    let engine = Engine::new(files, Bounds::default());
    let mut talk = Talk { engine, page: Page::default(), stops: false };
    talk.ask(&json!({ "do": "open", "path": "a.toml" }));
    talk.ask(&json!({ "do": "put-on", "look": "vmd" }));
    let said = talk.page.last("error")["message"].as_str().unwrap().to_owned();
    assert!(said.contains("another file") && said.contains("--look vmd"), "{said}");
    talk.ask(&json!({ "do": "turn", "by": [0, 0.1] }));
    assert_eq!(talk.page.last("look")["values"]["light"].as_array().unwrap().len(), 3);
}

#[test]
fn a_bare_model_has_a_look_on_itself_and_takes_it_off() {
    let engine = Engine::new(Memory::new().with("m.off", MODEL), Bounds::default());
    let mut talk = Talk { engine, page: Page::default(), stops: false };
    talk.ask(&json!({ "do": "open", "path": "m.off" }));
    assert_eq!(talk.page.last("look")["dressed"], json!(null));
    let bare = talk.page.last("look")["values"].clone();
    talk.ask(&json!({ "do": "put-on", "look": "ink" }));
    let look = talk.page.last("look");
    assert_eq!((&look["dressed"], &look["finished"]), (&json!("ink"), &json!(true)));
    assert_eq!(look["command"], "phong render m.off --look ink");
    talk.ask(&json!({ "do": "export", "format": "python" }));
    assert!(String::from_utf8_lossy(&talk.page.file).contains("scene.look(\"ink\")"));
    talk.ask(&json!({ "do": "put-on", "look": null }));
    let look = talk.page.last("look");
    assert_eq!((&look["dressed"], &look["values"]), (&json!(null), &bare));
}

#[test]
fn a_look_that_is_tried_on_is_drawn_as_when_it_is_put_on_and_nothing_else_changes() {
    let mut talk = Talk::of(SCENE);
    talk.draw();
    let (before, picture) = (talk.page.last("look").clone(), talk.page.pixels.clone());
    talk.ask(&json!({ "do": "try-on", "look": "ink" }));
    talk.draw();
    let tried = talk.page.pixels.clone();
    assert_eq!(talk.page.last("look")["tried"], "ink");
    assert_ne!(tried, picture);
    talk.ask(&json!({ "do": "export", "format": "svg" }));
    let svg = talk.page.file.clone();
    // It is said why it is refused, and the one before stays.
    talk.ask(&json!({ "do": "try-on", "look": "inc" }));
    assert!(talk.page.last("error")["message"].as_str().unwrap().contains("did you mean `ink`"));
    talk.ask(&json!({ "do": "export", "format": "svg" }));
    assert!(talk.page.file == svg);
    talk.ask(&json!({ "do": "export", "format": "toml" }));
    assert_eq!(String::from_utf8_lossy(&talk.page.file), SCENE);
    assert!(talk.page.all("text").is_empty());
    talk.ask(&json!({ "do": "try-on", "look": null }));
    talk.draw();
    assert_eq!(talk.page.pixels, picture);
    let after = talk.page.last("look");
    for key in ["values", "set", "command", "tried", "terms"] {
        assert_eq!(after[key], before[key], "{key}");
    }
    // What is tried on goes by itself where something else changes.
    talk.ask(&json!({ "do": "try-on", "look": "clay" }));
    talk.ask(&json!({ "do": "terms", "off": [] }));
    assert_eq!(talk.page.last("look")["tried"], json!(null));
    talk.ask(&json!({ "do": "put-on", "look": "ink" }));
    talk.draw();
    assert_eq!(talk.page.pixels, tried);
}

#[test]
fn on_a_bare_model_another_look_is_tried_on_in_place_of_the_one_that_it_has() {
    let model = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
        property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n\
        element face 1\nproperty list uchar int vertex_indices\nend_header\n\
        0 0 0 200 0 0\n1 0 0 200 0 0\n0 1 0 200 0 0\n3 0 1 2\n";
    let mut talk = Talk {
        engine: Engine::new(Memory::new().with("m.ply", model), Bounds::default()),
        page: Page::default(),
        stops: false,
    };
    talk.ask(&json!({ "do": "pixels", "kind": "linear" }));
    talk.ask(&json!({ "do": "open", "path": "m.ply" }));
    talk.ask(&json!({ "do": "look", "set": { "image.size": [24, 16], "image.samples": 1 } }));
    talk.ask(&json!({ "do": "put-on", "look": "flat" }));
    talk.draw();
    let flat = talk.page.pixels.clone();
    // Clay has taken the colours away, and they are there again.
    talk.ask(&json!({ "do": "put-on", "look": "clay" }));
    talk.ask(&json!({ "do": "try-on", "look": "flat" }));
    talk.draw();
    assert_eq!(talk.page.pixels, flat);
    assert!(flat.chunks_exact(4).any(|pixel| pixel[0] > 2.0 * pixel[1]), "red");
    talk.ask(&json!({ "do": "try-on", "look": null }));
    assert_eq!(talk.page.last("look")["dressed"], "clay");
}
