//! A mistake to be found, a picture graded, a class sheet.

use phong::scene::Memory;
use phong_studio::engine::{Bounds, Engine};
use serde_json::{Value, json};

use crate::SCENE;
use crate::engine::Talk;

const SHEET: &str = "title = \"Week 3\"\n[[exercise]]\ntitle = \"Find it\"\ntext = \"Look.\"\n\
    scene = \"a.toml\"\nmistake = 3\n";

#[test]
fn a_planted_mistake_is_found_among_its_choices_and_the_right_picture_comes_back() {
    let mut talk = Talk::of(SCENE);
    talk.draw();
    let right = crate::engine::seen(&talk.page);
    talk.ask(&json!({ "do": "mistake", "seed": 5 }));
    assert!(!talk.engine.has_work(), "the right picture is not drawn over it");
    let wrong = crate::engine::seen(&talk.page);
    assert_ne!(wrong, right);
    let choices = talk.page.last("mistake")["choices"].as_array().unwrap().clone();
    assert_eq!(choices.len(), 8);
    talk.ask(&json!({ "do": "explain", "id": 1, "pixel": [14, 9] }));
    assert!(talk.page.last("explanation")["drawn"].is_array());
    let mut found = 0;
    for choice in &choices {
        talk.ask(&json!({ "do": "guess", "cause": choice["cause"] }));
        let verdict = talk.page.last("verdict");
        found += usize::from(verdict["right"] == true);
        assert_eq!(verdict["right"] == true, !verdict["says"].is_null());
    }
    assert!(found >= 1);
    talk.ask(&json!({ "do": "guess", "cause": null }));
    assert!(talk.page.last("verdict")["says"].is_string());
    talk.ask(&json!({ "do": "resume" }));
    talk.draw();
    assert_eq!(crate::engine::seen(&talk.page), right);
    talk.ask(&json!({ "do": "guess", "cause": "exponent-half" }));
    assert!(talk.page.last("error")["message"].as_str().unwrap().contains("no picture"));
}

#[test]
fn the_same_seed_plants_the_same_mistake() {
    let mut talk = Talk::of(SCENE);
    let ask = |talk: &mut Talk| -> Value {
        talk.ask(&json!({ "do": "mistake", "seed": 9 }));
        talk.page.last("mistake")["choices"].clone()
    };
    assert_eq!(ask(&mut talk), ask(&mut talk));
}

#[test]
fn a_picture_is_graded_and_what_is_none_is_refused() {
    let mut talk = Talk::of(SCENE);
    let large = SCENE.replace("[40, 22]", "[160, 90]").replace("shininess = 60", "shininess = 30");
    let mut other = Talk::of(&large.replace("samples = 3", "samples = 1"));
    other.draw();
    other.ask(&json!({ "do": "export", "format": "png" }));
    talk.ask(&json!({ "do": "grade", "name": "mine.png", "bytes": base64(&other.page.file) }));
    let graded = talk.page.last("graded");
    assert_eq!(
        (&graded["name"], &graded["told"]["cause"]),
        (&json!("mine.png"), &json!("exponent-half"))
    );
    for (bytes, why) in [("%%%", "base 64"), ("AAAA", "no PNG"), ("", "no PNG")] {
        talk.ask(&json!({ "do": "grade", "name": "x", "bytes": bytes }));
        assert!(talk.page.last("error")["message"].as_str().unwrap().contains(why), "{bytes}");
    }
}

#[test]
fn a_class_sheet_is_told_in_place_of_a_scene() {
    let files = Memory::new().with("week.toml", SHEET.as_bytes()).with("a.toml", SCENE.as_bytes());
    let mut talk = Talk::of(SCENE);
    talk.engine = Engine::new(files, Bounds::default());
    talk.ask(&json!({ "do": "open", "path": "week.toml" }));
    let sheet = talk.page.last("sheet");
    assert_eq!(
        (&sheet["title"], &sheet["exercises"][0]["scene"]),
        (&json!("Week 3"), &json!("a.toml"))
    );
    let files = Memory::new().with("week.toml", SHEET.replace("scene", "scnee").as_bytes());
    talk.engine = Engine::new(files, Bounds::default());
    talk.ask(&json!({ "do": "open", "path": "week.toml" }));
    assert!(talk.page.last("error")["message"].as_str().unwrap().contains("week.toml:5"));
}

#[test]
fn a_mistake_is_planted_by_its_name_where_it_can_be_seen() {
    let mut talk = Talk::of(SCENE);
    talk.ask(&json!({ "do": "mistake", "cause": "reflection-sign" }));
    let choices = &talk.page.last("mistake")["choices"];
    assert_eq!(
        (choices.as_array().unwrap().len(), &choices[0]["cause"]),
        (1, &json!("reflection-sign"))
    );
    for cause in ["gamma-thrice", "attenuation-missing"] {
        talk.ask(&json!({ "do": "mistake", "cause": cause }));
        let said = talk.page.last("error")["message"].as_str().unwrap();
        assert!(said.contains(cause), "{said}");
    }
}

/// Bytes in base 64, with no package for it.
fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let group = |three: &[u8]| {
        let number =
            three.iter().fold(0_u32, |n, b| n << 8 | u32::from(*b)) << (8 * (3 - three.len()));
        let digit = |i: usize| {
            let letter = char::from(DIGITS[(number >> (18 - 6 * i)) as usize & 63]);
            if i <= three.len() { letter } else { '=' }
        };
        (0..4).map(digit).collect::<String>()
    };
    bytes.chunks(3).map(group).collect()
}
