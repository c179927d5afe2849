//! The engine, without a server.

use std::sync::Mutex;

use phong::film::{Film, LayerKind};
use phong::finish::{Finishing, finish};
use phong::image::{Content, Encoding, Format, write};
use phong::part::fingerprint;
use phong::render::{Cancel, RenderOptions, render};
use phong::scene::{Change, Limits, Memory, Scene, TexelValues, Texels, read_changed};
use phong::view::View;
use phong_studio::engine::{Bounds, Engine, Stage};
use phong_studio::protocol::Message;
use serde_json::{Value, json};

use crate::SCENE;
use crate::client::Page;

/// An engine and a page that talk with each other.
pub(crate) struct Talk {
    pub(crate) engine: Engine,
    pub(crate) page: Page,
    /// Whether the engine is stopped after every tile.
    pub(crate) stops: bool,
}

impl Talk {
    fn new() -> Self {
        Self::sharing(SCENE, 0, 1)
    }

    pub(crate) fn of(text: &str) -> Self {
        Self::sharing(text, 0, 1)
    }

    pub(crate) fn sharing(text: &str, index: u32, count: u32) -> Self {
        let engine = Engine::new(Memory::new().with("a.toml", text.as_bytes()), Bounds::default());
        let engine = engine.with_share(index, count);
        let mut talk = Self { engine, page: Page::default(), stops: false };
        talk.ask(&json!({ "do": "pixels", "kind": "linear" }));
        talk.ask(&json!({ "do": "open", "path": "a.toml" }));
        talk
    }

    pub(crate) fn ask(&mut self, request: &Value) {
        self.with(|engine, emit| engine.receive(&request.to_string(), emit));
    }

    pub(crate) fn with(&mut self, act: impl FnOnce(&mut Engine, phong_studio::engine::Emit<'_>)) {
        let heard = Mutex::new(Vec::new());
        let stops = self.stops;
        act(&mut self.engine, &|message: Message| {
            let goes_on = !stops || matches!(message, Message::Text(_));
            heard.lock().unwrap().push(message);
            goes_on
        });
        heard.into_inner().unwrap().iter().for_each(|message| self.page.hear(message));
    }

    /// Draws for a moment.
    pub(crate) fn some(&mut self) {
        self.stops = true;
        self.with(|engine, emit| engine.advance(&Cancel::new(), emit));
        self.stops = false;
    }

    /// Draws to the end; how often it had to be asked.
    pub(crate) fn draw(&mut self) -> usize {
        let mut times = 0;
        while self.engine.has_work() {
            self.with(|engine, emit| engine.advance(&Cancel::new(), emit));
            times += 1;
        }
        assert!(self.page.is_done());
        times
    }
}

pub(crate) fn scene(changes: &[&str]) -> Scene {
    let files = Memory::new().with("a.toml", SCENE.as_bytes());
    let changes: Vec<_> = changes.iter().map(|change| Change::parse(change).unwrap()).collect();
    read_changed("a.toml", None, &files, &Limits::default(), &changes).scene.unwrap()
}

/// The film that `phong render` makes.
pub(crate) fn film(scene: &Scene) -> Film {
    let options = RenderOptions::of(&scene.image).unwrap();
    render(&View::of(scene).unwrap(), &options, &|_| {}, &Cancel::new()).film
}

pub(crate) fn bits(film: &Film) -> Vec<u32> {
    let values = |kind| film.layer(kind).unwrap().values.to_vec();
    let (colors, alphas) = (values(LayerKind::Picture), values(LayerKind::Alpha));
    let pixels = colors.chunks_exact(3).zip(&alphas);
    pixels.flat_map(|(color, alpha)| color.iter().chain([alpha]).map(|v| v.to_bits())).collect()
}

pub(crate) fn seen(page: &Page) -> Vec<u32> {
    page.pixels.iter().map(|v| v.to_bits()).collect()
}

#[test]
fn the_last_pass_has_the_bits_of_a_render() {
    let mut talk = Talk::new();
    talk.draw();
    assert_eq!(talk.page.last("checked")["ok"], true);
    assert_eq!(seen(&talk.page), bits(&film(&scene(&[]))));
    let passes: Vec<_> =
        talk.page.all("pass").iter().map(|p| p["samples"].as_u64().unwrap()).collect();
    assert_eq!(passes, [0, 1, 2, 3]);
}

#[test]
fn stopped_after_every_tile_it_comes_to_the_same_bits() {
    let mut talk = Talk::new();
    talk.stops = true;
    assert!(talk.draw() > 5);
    assert_eq!(seen(&talk.page), bits(&film(&scene(&[]))));
}

#[test]
fn a_picture_is_coarse_until_a_pass_of_full_size_is_whole() {
    let mut talk = Talk::new();
    assert_eq!((talk.engine.stage(), talk.engine.picture()), (Stage::Begun, 1));
    talk.some();
    assert_eq!(talk.engine.stage(), Stage::Coarse);
    talk.draw();
    assert_eq!(talk.engine.stage(), Stage::Fine);
    talk.ask(&json!({ "do": "turn", "by": [0.1, 0] }));
    assert_eq!((talk.engine.stage(), talk.engine.picture()), (Stage::Begun, 2));
}

#[test]
fn a_value_laid_over_the_scene_is_that_of_set() {
    let mut talk = Talk::new();
    talk.ask(&json!({ "do": "look", "set": {
        "materials.plastic.shininess": 7, "light.2.color": "tomato", "camera.fov": 42.5,
    } }));
    talk.draw();
    let changes = ["materials.plastic.shininess=7", "light.2.color=tomato", "camera.fov=42.5"];
    assert_eq!(seen(&talk.page), bits(&film(&scene(&changes))));
    let look = talk.page.last("look");
    assert_eq!(look["values"]["materials"]["plastic"]["shininess"], 7.0);
    assert_eq!(look["wells"]["light.2.color"], "#ff6347");
    let command = look["command"].as_str().unwrap();
    assert!(
        command.starts_with("phong render a.toml --set materials.plastic.shininess=7"),
        "{command}"
    );
    talk.ask(&json!({ "do": "look", "set": { "materials.plastic.shininess": null } }));
    talk.ask(&json!({ "do": "reset" }));
    talk.draw();
    assert_eq!(seen(&talk.page), bits(&film(&scene(&[]))));
}

#[test]
fn an_image_stays_where_a_value_is_laid_over_the_scene() {
    let text = SCENE.replace(
        "[materials.plastic]\n",
        "[textures.stripes]\nkind = \"image\"\nfile = \"stripes.png\"\n\
         [materials.plastic]\nopacity = { texture = \"stripes\", scale = 4, channel = \"r\" }\n",
    );
    assert_ne!(text, SCENE);
    let stripes = TexelValues::Bytes(vec![51, 20, 20, 20, 51, 20]);
    let stripes = Texels::new([2, 1], 3, stripes).unwrap().stand_in().unwrap();
    let files = Memory::new().with("a.toml", text.as_bytes()).with("stripes.png", stripes);
    let engine = Engine::new(files.clone(), Bounds::default());
    let mut talk = Talk { engine, page: Page::default(), stops: false };
    talk.ask(&json!({ "do": "pixels", "kind": "linear" }));
    talk.ask(&json!({ "do": "open", "path": "a.toml" }));
    talk.ask(&json!({ "do": "look", "set": { "materials.plastic.shininess": 7 } }));
    talk.draw();
    let changes = [Change::parse("materials.plastic.shininess=7").unwrap()];
    let reading = read_changed("a.toml", None, &files, &Limits::default(), &changes);
    let scene = reading.scene.unwrap();
    assert_eq!(seen(&talk.page), bits(&film(&scene)));
}

#[test]
fn what_cannot_be_laid_over_it_is_refused_and_all_is_as_it_was() {
    let mut talk = Talk::new();
    talk.draw();
    for (path, value, why) in [
        ("materials.plastic.shininess", json!(-1), "shininess"),
        ("materials.plastik.color", json!("red"), "plastik"),
        ("include.1.file", json!("b.toml"), "in the text"),
        ("sphere.3.radius", json!(2), "sphere"),
        ("sphere.1.radius", json!(-2), "radius"),
        ("camera.fov", json!("wide"), "fov"),
    ] {
        talk.ask(&json!({ "do": "look", "set": { path: value } }));
        let message = talk.page.last("error")["message"].as_str().unwrap();
        assert!(message.contains(why), "{message}");
    }
    assert_eq!(talk.page.all("look").len(), 1);
    assert!(!talk.engine.has_work());
}

#[test]
fn a_text_that_cannot_be_drawn_leaves_the_picture_and_tells_why() {
    let mut talk = Talk::new();
    talk.draw();
    talk.ask(&json!({ "do": "edit", "text": SCENE.replace("radius = 1\n", "radus = 1\n") }));
    let checked = talk.page.last("checked");
    assert_eq!(checked["ok"], false);
    let diagnostics = checked["diagnostics"].as_array().unwrap();
    assert!(diagnostics.iter().any(|d| d["help"] == "did you mean `radius`?"), "{checked:#}");
    assert_eq!(talk.page.all("look").len(), 1, "no other picture begins");
    talk.ask(&json!({ "do": "explain", "id": 1, "pixel": [20, 11] }));
    assert_eq!(talk.page.last("explanation")["id"], 1);
    talk.ask(&json!({ "do": "edit", "text": SCENE.replace("radius = 1\n", "radius = 0.5\n") }));
    talk.draw();
    assert_ne!(seen(&talk.page), bits(&film(&scene(&[]))));
}

#[test]
fn an_explanation_is_that_of_explain_and_its_vectors_lie_in_the_picture() {
    let mut talk = Talk::new();
    talk.ask(&json!({ "do": "explain", "id": 5, "pixel": [14, 9] }));
    let said = talk.page.last("explanation").clone();
    let scene = scene(&[]);
    let options = RenderOptions::of(&scene.image).unwrap().with_samples(1).unwrap();
    let told = phong::explain::explain(&View::of(&scene).unwrap(), &options, [14, 9]).unwrap();
    assert_eq!(said["told"], phong_lab::tell::json(&told));
    let lines = said["lines"].as_array().unwrap();
    let names: Vec<_> = lines.iter().map(|line| line["name"].as_str().unwrap()).collect();
    assert_eq!(names[..8], ["n", "e", "l", "r", "h", "l", "r", "h"]);
    for line in lines.iter().take(8) {
        let from = [0, 1].map(|i| line["from"][i].as_f64().unwrap());
        assert!((from[0] - 14.5).abs() < 1e-3 && (from[1] - 9.5).abs() < 1e-3, "{line}");
    }
    talk.ask(&json!({ "do": "explain", "id": 6, "pixel": [40, 0] }));
    assert!(talk.page.last("error")["message"].as_str().unwrap().contains("outside"));
}

#[test]
fn turning_keeps_the_distance_and_moving_keeps_the_direction() {
    let mut talk = Talk::new();
    let camera = |talk: &Talk| {
        let camera = &talk.page.last("look")["values"]["camera"];
        ["eye", "look_at"].map(|key| [0, 1, 2].map(|i| camera[key][i].as_f64().unwrap()))
    };
    let way = |[eye, at]: [[f64; 3]; 2]| [0, 1, 2].map(|i| at[i] - eye[i]);
    let long = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let begin = camera(&talk);
    talk.ask(&json!({ "do": "turn", "by": [0.25, 0.1] }));
    let turned = camera(&talk);
    assert!((long(way(turned)) - long(way(begin))).abs() < 1e-9);
    assert_eq!(turned[1], begin[1]);
    assert!(turned[0] != begin[0]);
    talk.ask(&json!({ "do": "move", "by": [0.5, 0.0] }));
    let moved = camera(&talk);
    assert!((0..3).all(|i| (way(moved)[i] - way(turned)[i]).abs() < 1e-9));
    talk.ask(&json!({ "do": "zoom", "by": 0.5 }));
    assert!((long(way(camera(&talk))) - long(way(begin)) / 2.0).abs() < 1e-9);
    talk.ask(&json!({ "do": "turn", "by": [0, 50] }));
    talk.draw();
    talk.ask(&json!({ "do": "zoom", "by": 0 }));
    assert!(talk.page.last("error")["message"].as_str().unwrap().contains("above 0"));
}

#[test]
fn a_finished_picture_is_the_file_that_render_writes() {
    let mut talk = Talk::new();
    talk.ask(&json!({ "do": "export", "format": "png" }));
    assert!(talk.page.last("error")["message"].as_str().unwrap().contains("not finished"));
    talk.draw();
    talk.ask(&json!({ "do": "export", "format": "png" }));
    let scene = scene(&[]);
    let film = film(&scene);
    let finished = finish(&film, &Finishing::default().of_scene(fingerprint(&scene)));
    let mut png = std::io::Cursor::new(Vec::new());
    let picture = Content::Layer(LayerKind::Picture);
    write(&finished, picture, Format::Png, &Encoding::default(), &mut png).unwrap();
    assert_eq!(talk.page.last("file")["name"], "a.png");
    assert!(talk.page.file == png.into_inner());
    talk.ask(&json!({ "do": "export", "format": "toml" }));
    assert_eq!(talk.page.file, SCENE.as_bytes());
}

#[test]
fn a_picture_that_takes_too_much_memory_is_refused() {
    let mut talk = Talk::new();
    talk.ask(&json!({ "do": "look", "set": { "image.size": [100_000, 100_000] } }));
    let message = talk.page.last("error")["message"].as_str().unwrap();
    assert!(message.contains("100000") && message.contains("image.size"), "{message}");
    talk.ask(&json!({ "do": "turn", "by": [0, 0.1] }));
    assert_eq!(talk.page.last("look")["size"], json!([40, 22]), "it is not laid over the scene");
}

#[test]
fn what_is_no_request_is_answered() {
    let mut talk = Talk::new();
    let before = talk.page.all("error").len();
    for text in
        ["", "[]", "{\"do\":\"fly\"}", "\u{0}", "{\"do\":\"explain\",\"id\":-1,\"pixel\":[0,0]}"]
    {
        talk.with(|engine, emit| engine.receive(text, emit));
    }
    talk.ask(&json!({ "do": "open", "path": "b.toml" }));
    talk.ask(&json!({ "do": "open", "path": "../a.toml" }));
    assert_eq!(talk.page.all("error").len(), before + 7);
    talk.draw();
}

#[test]
fn the_studios_own_scene_is_that_of_the_gallery() {
    let gallery = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/two-balls.toml");
    assert_eq!(std::fs::read_to_string(gallery).unwrap(), phong_studio::engine::EXAMPLE);
}

#[test]
fn shares_put_together_are_the_file_of_a_render_and_say_every_pass() {
    // Of more shares than there are tiles some are empty.
    for count in [2, 40] {
        let mut talks: Vec<Talk> =
            (0..count).map(|index| Talk::sharing(SCENE, index, count)).collect();
        let mut parts = Vec::new();
        for talk in &mut talks {
            while talk.engine.has_work() {
                assert_eq!(talk.engine.part(), None);
                talk.with(|engine, emit| engine.advance(&Cancel::new(), emit));
            }
            parts.extend(talk.engine.part());
        }
        for (index, talk) in talks.iter().enumerate() {
            let passes = talk.page.all("pass");
            let passes: Vec<_> = passes.iter().map(|p| p["pass"].as_u64().unwrap()).collect();
            let all = &[0, 1, 2, 3][usize::from(index != 0)..];
            assert_eq!(passes, all, "share {index} of {count}");
        }
        let mut first = talks.swap_remove(0);
        first.ask(&json!({ "do": "export", "format": "png" }));
        assert_eq!(first.page.last("error")["message"], "the picture is not finished yet");
        for part in &parts[1..] {
            first.with(|engine, emit| engine.join(part, emit));
        }
        first.ask(&json!({ "do": "export", "format": "png" }));
        let mut whole = Talk::new();
        whole.draw();
        whole.ask(&json!({ "do": "export", "format": "png" }));
        assert_eq!(first.page.file, whole.page.file);
        // A share of another picture is told from one of this.
        first.ask(&json!({ "do": "zoom", "by": 0.5 }));
        first.with(|engine, emit| engine.advance(&Cancel::new(), emit));
        first.with(|engine, emit| engine.join(&parts[1], emit));
        let said = first.page.last("error")["message"].as_str().unwrap().to_owned();
        assert!(said.contains("another picture"), "{said}");
    }
}

#[test]
fn facets_are_drawn_and_counted_or_refused() {
    let mut talk = Talk::new();
    let mut error = |count: u32| {
        talk.ask(&json!({ "do": "facets", "id": 3, "theta": 55, "count": count }));
        let said = talk.page.last("facets");
        assert_eq!((&said["id"], &said["count"]), (&json!(3), &json!(count)));
        assert_eq!(said["counted"].as_array().unwrap().len(), 24);
        said["error"].as_f64().unwrap()
    };
    assert!(error(10_000) < 0.2 * error(10));
    for (theta, count) in [(55, 0), (55, 1_000_001), (90, 1)] {
        talk.ask(&json!({ "do": "facets", "id": 3, "theta": theta, "count": count }));
        assert!(talk.page.last("error")["message"].as_str().unwrap().contains("80 degrees"));
    }
}

#[test]
fn a_power_of_the_cosine_is_told_with_its_half_width_or_refused() {
    let mut talk = Talk::new();
    talk.ask(&json!({ "do": "cosine-power", "id": 4, "exponent": 2 }));
    let told = talk.page.last("cosine-power");
    let curve: Vec<f64> =
        told["curve"].as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect();
    assert_eq!((curve.len(), curve[90], told["id"].as_u64()), (181, 1.0, Some(4)));
    assert!((curve[45] - 0.5).abs() < 1e-5 && curve[0] < 1e-9, "{curve:?}");
    assert!((told["half_width"].as_f64().unwrap() - 45.0).abs() < 1e-4);
    for exponent in [-1.0, 1e7] {
        talk.ask(&json!({ "do": "cosine-power", "id": 5, "exponent": exponent }));
    }
    assert_eq!(talk.page.all("error").len(), 2);
}
