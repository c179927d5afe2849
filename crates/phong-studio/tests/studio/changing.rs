//! What is written into the text, dragged, left out and asked "what if".

use phong::glam::DVec2;
use phong::render::{Cancel, RenderOptions, render};
use phong::terms::{Term, TermSet};
use phong::view::View;
use serde_json::{Value, json};

use crate::SCENE;
use crate::engine::{Talk, bits, film, scene, seen};

fn text(talk: &Talk) -> String {
    talk.page.last("text")["text"].as_str().unwrap().to_owned()
}

fn handle(talk: &Talk, path: &str) -> [f64; 2] {
    let handles = talk.page.last("look")["handles"].as_array().unwrap();
    let handle = handles.iter().find(|handle| handle["path"] == path);
    let handle = handle.unwrap_or_else(|| panic!("no `{path}` among {handles:?}"));
    [0, 1].map(|i| handle["at"][i].as_f64().unwrap())
}

#[test]
fn what_is_written_into_the_text_changes_nothing_else_of_it() {
    let commented = SCENE.replace("shininess = 60", "shininess  =  60 # dull");
    let mut talk = Talk::of(&commented);
    talk.ask(
        &json!({ "do": "look", "set": { "materials.plastic.shininess": 8, "camera.fov": 40 } }),
    );
    talk.ask(&json!({ "do": "write", "set": { "materials.plastic.shininess": 9 } }));
    assert_eq!(text(&talk), commented.replace("60 # dull", "9 # dull"));
    let look = talk.page.last("look");
    assert_eq!(look["set"], json!({ "camera.fov": 40 }), "what was laid over the key is gone");
    talk.draw();
    let changes = ["materials.plastic.shininess=9", "camera.fov=40"];
    assert_eq!(seen(&talk.page), bits(&film(&scene(&changes))));
    talk.ask(&json!({ "do": "write", "set": { "sphere.2.radius": 0.5, "light.2.color": null } }));
    assert!(text(&talk).contains("radius = 0.5") && !text(&talk).contains("color = 0.35"));
}

#[test]
fn what_cannot_be_written_leaves_text_and_picture() {
    let mut talk = Talk::of(SCENE);
    talk.draw();
    for (path, value) in [
        ("sphere.1.radius", json!(-1)),
        ("sphere.3.radius", json!(1)),
        ("materials.plastic.shyness", json!(1)),
        ("light.1.position", json!("here")),
        ("image.size", json!([100_000, 100_000])),
    ] {
        let errors = talk.page.all("error").len();
        talk.ask(&json!({ "do": "write", "set": { path: value } }));
        assert_eq!(talk.page.all("error").len(), errors + 1, "{path}");
    }
    talk.ask(&json!({ "do": "export", "format": "toml" }));
    assert_eq!(talk.page.file, SCENE.as_bytes());
    talk.ask(&json!({ "do": "edit", "text": "version = " }));
    talk.ask(&json!({ "do": "write", "set": { "camera.fov": 20 } }));
    assert!(talk.page.last("error")["message"].as_str().unwrap().contains("cannot be read"));
}

#[test]
fn a_text_and_what_was_laid_over_it_come_back_together() {
    let mut talk = Talk::of(SCENE);
    talk.ask(&json!({ "do": "look", "set": { "camera.fov": 40, "sphere.1.radius": 0.7 } }));
    let set = talk.page.last("look")["set"].clone();
    talk.draw();
    let before = seen(&talk.page);
    talk.ask(&json!({ "do": "write", "set": { "camera.fov": 50 } }));
    talk.ask(&json!({ "do": "reset" }));
    talk.ask(&json!({ "do": "edit", "text": SCENE, "set": set }));
    talk.draw();
    assert_eq!(seen(&talk.page), before);
    assert_eq!(before, bits(&film(&scene(&["camera.fov=40", "sphere.1.radius=0.7"]))));
}

#[test]
fn a_handle_follows_the_pointer_and_is_written_when_it_is_let_go_of() {
    let mut talk = Talk::of(SCENE);
    for path in ["light.1.position", "light.2.direction", "sphere.1.center", "camera.look_at"] {
        talk.ask(&json!({ "do": "edit", "text": SCENE, "set": {} }));
        talk.ask(&json!({ "do": "look", "set": { "camera.fov": 125 } }));
        let from = handle(&talk, path);
        for to in [[9.0, 3.0], [15.0, 9.0]] {
            talk.ask(&json!({ "do": "drag", "path": path, "from": from, "to": to }));
            if path != "camera.look_at" && path != "light.2.direction" {
                let at = handle(&talk, path);
                assert!((0..2).all(|i| (at[i] - to[i]).abs() < 0.2), "{path}: {at:?} at {to:?}");
            }
        }
        let dragged = talk.page.last("look")["set"][path].clone();
        assert!(dragged.is_array(), "{path}");
        talk.ask(&json!({ "do": "drag", "path": path, "from": from, "to": [15, 9], "keep": true }));
        assert!(text(&talk).contains("version = 1") && text(&talk) != SCENE, "{path}");
        let look = talk.page.last("look");
        assert_eq!(look["set"], json!({ "camera.fov": 125 }), "{path}");
        let changed: Vec<_> =
            text(&talk).lines().filter(|line| !SCENE.contains(line)).map(str::to_owned).collect();
        assert_eq!(changed.len(), 1, "{path}: {changed:?}");
        assert!(changed[0].len() < 40, "no more digits than can be seen: {changed:?}");
    }
}

#[test]
fn a_handle_that_is_not_there_or_is_dragged_nowhere_is_refused() {
    let mut talk = Talk::of(SCENE);
    for (path, to) in [
        ("light.9.position", json!([1, 1])),
        ("plane.1.point", json!([1, 1])),
        ("light.2.direction", json!([1e300, 1])),
    ] {
        talk.ask(&json!({ "do": "drag", "path": path, "from": [0, 0], "to": to, "keep": true }));
        assert!(talk.page.all("look").len() == 1, "{path}");
    }
    assert_eq!(talk.page.all("error").len(), 3);
}

#[test]
fn without_a_term_the_picture_is_the_sum_of_the_others() {
    let mut talk = Talk::of(SCENE);
    assert_eq!(talk.page.last("look")["off"], json!([]));
    talk.ask(&json!({ "do": "terms", "off": ["specular", "background"] }));
    talk.draw();
    let scene = scene(&[]);
    let options = RenderOptions::of(&scene.image).unwrap().with_terms(TermSet::ALL);
    let film = render(&View::of(&scene).unwrap(), &options, &|_| {}, &Cancel::new()).film;
    let values = |term| film.layer(phong::film::LayerKind::Term(term)).unwrap().values.to_vec();
    let mut sum = vec![0.0; 3 * 40 * 22];
    for term in Term::ALL {
        if term != Term::Specular && term != Term::Background {
            sum.iter_mut().zip(values(term)).for_each(|(sum, v)| *sum += v);
        }
    }
    let shown: Vec<f32> = talk.page.pixels.chunks_exact(4).flat_map(|p| p[..3].to_vec()).collect();
    assert_eq!(shown, sum);
    talk.ask(&json!({ "do": "terms", "off": ["speculer"] }));
    assert!(
        talk.page.last("error")["message"].as_str().unwrap().contains("did you mean `specular`")
    );
    talk.ask(&json!({ "do": "terms", "off": [] }));
    talk.draw();
    assert_eq!(seen(&talk.page), bits(&crate::engine::film(&scene)));
}

#[test]
fn what_if_is_answered_without_another_picture() {
    let mut talk = Talk::of(SCENE);
    let ask = |talk: &mut Talk, set: Value| {
        talk.ask(&json!({ "do": "explain", "id": 1, "pixel": [14, 9], "set": set }));
        talk.page.last("explanation")["told"].clone()
    };
    let before = ask(&mut talk, json!({}));
    let dull = ask(&mut talk, json!({ "materials.plastic.shininess": 2 }));
    assert_ne!(before["linear"], dull["linear"]);
    talk.ask(&json!({ "do": "look", "set": { "materials.plastic.shininess": 2 } }));
    assert_eq!(ask(&mut talk, json!({})), dull, "as if it were so");
    talk.ask(&json!({ "do": "reset" }));
    assert_eq!(ask(&mut talk, json!({})), before);
    assert_eq!(talk.page.all("look").len(), 3);
    talk.ask(
        &json!({ "do": "explain", "id": 2, "pixel": [14, 9], "set": { "sphere.1.radius": 2 } }),
    );
    assert!(talk.page.last("error")["message"].as_str().unwrap().contains("single answer"));
}

#[test]
fn a_lobe_is_strongest_at_the_mirrored_direction() {
    let mut talk = Talk::of(SCENE);
    talk.ask(&json!({ "do": "lobe", "id": 4, "pixel": [14, 9], "light": 1 }));
    let lobe = talk.page.last("lobe");
    let number = |value: &Value| value.as_f64().unwrap();
    let length = |at: &Value| DVec2::new(number(&at[0]), number(&at[1])).length();
    let points = lobe["points"].as_array().unwrap();
    assert_eq!(points.len(), 181);
    let best = points.iter().max_by(|a, b| length(a).total_cmp(&length(b))).unwrap();
    assert!((length(best) - 1.0).abs() < 1e-6);
    let mark = |name| {
        lobe["marks"].as_array().unwrap().iter().find(|m| m["name"] == name).unwrap()["at"].clone()
    };
    let r = mark("r");
    assert!(
        number(&r[0]) * number(&best[0]) + number(&r[1]) * number(&best[1]) > 0.999,
        "{best} {r}"
    );
    assert!(number(&mark("l")[0]) < 0.0 && number(&mark("n")[1]) > 0.999);
    for (pixel, light, why) in
        [([0, 0], 1, "nothing"), ([14, 9], 0, "no light"), ([14, 9], 3, "no light")]
    {
        talk.ask(&json!({ "do": "lobe", "id": 5, "pixel": pixel, "light": light }));
        assert!(talk.page.last("error")["message"].as_str().unwrap().contains(why));
    }
}

#[test]
fn what_is_shown_is_exported_as_python_and_as_a_page() {
    let mut talk = Talk::of(SCENE);
    let program = |talk: &mut Talk| {
        talk.ask(&json!({ "do": "export", "format": "python" }));
        String::from_utf8(talk.page.file.clone()).unwrap()
    };
    assert!(program(&mut talk).contains("phong.Scene.read(\"a.toml\")"));
    talk.ask(&json!({ "do": "look", "set": { "camera.fov": 41 } }));
    let text = program(&mut talk);
    assert!(
        text.contains("phong.Scene.parse(\"\"\"\\\nversion = 1\n") && text.contains("fov = 41\n"),
        "{text}"
    );
    talk.ask(&json!({ "do": "export", "format": "html" }));
    assert_eq!(talk.page.last("file")["name"], "a.html");
    assert!(String::from_utf8_lossy(&talk.page.file).contains("<html"));
    talk.ask(&json!({ "do": "look", "set": { "image.size": [640, 360] } }));
    talk.ask(&json!({ "do": "export", "format": "html" }));
    assert!(talk.page.last("error")["message"].as_str().unwrap().contains("at most"));
}

#[test]
fn a_map_that_is_typed_has_the_numbers_of_its_file() {
    use phong::scene::Memory;
    use phong_studio::engine::{Bounds, Engine};

    let points = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n\
                  property float z\nproperty float T\nend_header\n-0.6 1 0 1\n0.6 1 0 2\n";
    let plain =
        format!("{SCENE}[[points]]\nfile = \"p.ply\"\nradius = 0.5\nmaterial = \"plastic\"\n");
    let mapped = plain.replace("color = \"#c8402f\"", "color = { texture = \"t\" }")
        + "[textures.t]\nkind = \"map\"\nof = \"T\"\nstops = \"viridis\"\n";
    let mapped = mapped.replacen("material = \"plastic\"", "", 1);
    let drawn = |first: &str, then: Option<&str>| {
        let files = Memory::new().with("a.toml", first.as_bytes()).with("p.ply", points.as_bytes());
        let mut talk = Talk {
            engine: Engine::new(files, Bounds::default()),
            page: crate::client::Page::default(),
            stops: false,
        };
        talk.ask(&json!({ "do": "pixels", "kind": "linear" }));
        talk.ask(&json!({ "do": "open", "path": "a.toml" }));
        if let Some(text) = then {
            talk.ask(&json!({ "do": "edit", "text": text }));
        }
        assert_eq!(talk.page.last("checked")["ok"], true, "{:?}", talk.page.last("checked"));
        talk.draw();
        seen(&talk.page)
    };
    let opened = drawn(&mapped, None);
    assert!(opened == drawn(&plain, Some(&mapped)));
    assert!(opened != drawn(&plain, None));
}
