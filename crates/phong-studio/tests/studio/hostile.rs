//! Requests that mean ill, and all that goes wrong: the engine answers, the server lives.
//!
//! `PHONG_HOSTILE=10000` sends so many requests to the engine in place of a few hundred.

use std::time::Duration;

use serde_json::{Map, Value, json};

use crate::SCENE;
use crate::client::Page;
use crate::engine::Talk;
use crate::server::Studio;

/// Numbers that look random and follow from a seed.
struct Dice(u64);

impl Dice {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    fn below(&mut self, count: usize) -> usize {
        (self.next() % count as u64) as usize
    }

    fn pick<T: Copy>(&mut self, from: &[T]) -> T {
        from[self.below(from.len())]
    }

    fn number(&mut self) -> Value {
        let numbers = [
            json!(0),
            json!(1),
            json!(-1),
            json!(0.5),
            json!(1e308),
            json!(-1e-308),
            json!(5e-324),
            json!(u64::MAX),
            json!(i64::MIN),
            json!(39),
            json!(22),
            json!(90),
            json!(179.999),
            json!(-0.0),
            json!(4_294_967_296_u64),
            json!(1e7),
            json!(7),
        ];
        numbers[self.below(numbers.len())].clone()
    }

    fn value(&mut self, depth: usize) -> Value {
        match self.below(if depth > 2 { 5 } else { 8 }) {
            0 => Value::Null,
            1 => json!(self.below(2) == 0),
            2 => json!(self.pick(&[
                "",
                "red",
                "#123456",
                "point",
                "spot",
                "phong",
                "ggx",
                "../x",
                "\u{0}",
                "é\u{202e}",
                "\"\\'''",
                "[[",
                "9".repeat(400).leak()
            ])),
            3 | 4 => self.number(),
            5 => json!([self.number(), self.number(), self.number()]),
            6 => (0..self.below(5)).map(|_| self.value(depth + 1)).collect(),
            _ => (0..self.below(4)).map(|i| (format!("k{i}"), self.value(depth + 1))).collect(),
        }
    }

    fn path(&mut self) -> String {
        let first = self.pick(&[
            "camera",
            "image",
            "ambient",
            "light.1",
            "light.2",
            "light.99",
            "materials.plastic",
            "materials.glassy",
            "materials.default",
            "sphere.1",
            "sphere.2",
            "plane.1",
            "mesh.1",
            "textures.t",
            "groups.g",
            "include.1",
            "",
            ".",
            "version",
            "light",
            "sphere.0",
            "sphere.-1",
        ]);
        let key = self.pick(&[
            "eye",
            "look_at",
            "fov",
            "size",
            "samples",
            "color",
            "position",
            "direction",
            "shininess",
            "model",
            "k_d",
            "reflection",
            "center",
            "radius",
            "point",
            "normal",
            "translate",
            "kind",
            "up",
            "height",
            "background",
            "roughness",
            "depth",
            "",
            "1",
            "nothing",
            "file",
        ]);
        format!("{first}.{key}")
    }

    fn set(&mut self) -> Value {
        let mut set = Map::new();
        for _ in 0..self.below(4) {
            let path = self.path();
            // Large pictures are refused by another test; here they would only take time.
            let value = if path.starts_with("image.s") { json!([9, 7]) } else { self.value(0) };
            set.insert(path, value);
        }
        Value::Object(set)
    }

    fn pair(&mut self) -> Value {
        json!([self.number(), self.number()])
    }

    /// The scene's text with a piece of it lost, doubled or exchanged.
    fn text(&mut self) -> String {
        let mut lines: Vec<&str> = SCENE.lines().collect();
        for _ in 0..=self.below(3) {
            let (a, b) = (self.below(lines.len()), self.below(lines.len()));
            match self.below(4) {
                0 => drop(lines.remove(a)),
                1 => lines.insert(a, lines[b]),
                2 => lines.swap(a, b),
                _ => {
                    lines[a] = self.pick(&[
                        "[[",
                        "a = 1",
                        "radius = nan",
                        "center = [1e400, 0, 0]",
                        "[[include]]\nfile = \"../a.toml\"",
                        "\u{1}",
                    ]);
                }
            }
        }
        lines.join("\n") + "\n"
    }

    fn request(&mut self) -> Value {
        let id = self.number();
        match self.below(19) {
            0 => {
                json!({ "do": "open", "path": self.pick(&["a.toml", "b.toml", "../a.toml", "/etc/passwd", "", "a.toml/"]) })
            }
            1 => json!({ "do": "edit", "text": self.text() }),
            2 => json!({ "do": "edit", "text": SCENE, "set": self.set() }),
            3 | 4 => json!({ "do": "look", "set": self.set() }),
            5 | 6 => json!({ "do": "write", "set": self.set() }),
            7 => json!({ "do": self.pick(&["turn", "move"]), "by": self.pair() }),
            8 => json!({ "do": "zoom", "by": self.number() }),
            9 | 10 => {
                json!({ "do": "drag", "path": self.path(), "from": self.pair(), "to": self.pair(), "keep": self.below(2) == 0 })
            }
            11 => {
                json!({ "do": "terms", "off": [self.pick(&["specular", "diffuse", "background", "x"])] })
            }
            12 => {
                json!({ "do": "explain", "id": id, "pixel": self.pair(), "samples": self.number(), "set": self.set() })
            }
            13 => {
                json!({ "do": "lobe", "id": id, "pixel": self.pair(), "light": self.number(), "set": self.set() })
            }
            14 if self.below(2) == 0 => {
                json!({ "do": "facets", "id": id, "theta": self.number(), "count": self.pick(&[0, 1, 50, u32::MAX]) })
            }
            14 if self.below(2) == 0 => json!({ "do": "finish", "picture": self.below(400) }),
            14 if self.below(3) == 0 => {
                json!({ "do": "cosine-power", "id": id, "exponent": self.number() })
            }
            14 => json!({ "do": "guess", "cause": self.pick(&["exponent-half", "", "x"]) }),
            15 => {
                json!({ "do": "grade", "name": "a\u{0}.png", "bytes": self.pick(&["", "AAAA", "iVBORw0KGgo=", "%%%"]) })
            }
            16 if self.below(3) == 0 => {
                json!({ "do": self.pick(&["save", "check-file", "take-file"]), "over": true })
            }
            16 if self.below(3) == 0 => json!({ "do": "frame", "number": self.number() }),
            16 if self.below(2) == 0 => {
                json!({ "do": self.pick(&["put-on", "try-on"]), "look": self.pick(&[Some("ink"), Some("clay"), Some(""), Some("vmd"), None]) })
            }
            16 => {
                json!({ "do": "export", "format": self.pick(&["png", "exr", "svg", "toml", "python", "pdf"]) })
            }
            17 => {
                json!({ "do": self.pick(&["reset", "cancel", "resume", "keys", "mistake", "fly", ""]), "seed": id })
            }
            _ => self.value(0),
        }
    }
}

#[test]
fn whatever_is_asked_is_answered_and_the_engine_still_draws() {
    let count = std::env::var("PHONG_HOSTILE").ok().and_then(|n| n.parse().ok()).unwrap_or(400);
    let mut dice = Dice(0x5eed);
    let mut talk = Talk::of(SCENE);
    for i in 0..count {
        let request = dice.request();
        talk.page.replies.clear();
        let mut text = request.to_string();
        if dice.below(20) == 0 {
            let end =
                (0..=dice.below(text.len() + 1)).rev().find(|&end| text.is_char_boundary(end));
            text.truncate(end.unwrap_or(0));
        }
        talk.with(|engine, emit| engine.receive(&text, emit));
        let told = |kind: &str| !talk.page.all(kind).is_empty();
        assert!(
            !told("error")
                || talk.page.last("error")["message"].as_str().is_some_and(|m| !m.is_empty()),
            "{text}"
        );
        if i % 16 == 0 {
            talk.some();
        }
    }
    talk.ask(&json!({ "do": "terms", "off": [] }));
    talk.ask(&json!({ "do": "open", "path": "a.toml" }));
    talk.draw();
    assert_eq!(
        crate::engine::seen(&talk.page),
        crate::engine::bits(&crate::engine::film(&crate::engine::scene(&[])))
    );
}

#[test]
fn after_a_bad_end_that_nobody_foresaw_the_engine_says_so_and_draws_again() {
    let mut talk = Talk::of(SCENE);
    talk.some();
    talk.with(|engine, emit| engine.broken(emit));
    assert!(talk.page.last("error")["message"].as_str().unwrap().contains("report"));
    assert!(!talk.engine.has_work());
    talk.ask(&json!({ "do": "explain", "id": 1, "pixel": [1, 1] }));
    assert!(talk.page.last("error")["message"].as_str().unwrap().contains("no picture"));
    talk.ask(&json!({ "do": "turn", "by": [0.1, 0] }));
    talk.draw();
}

#[test]
fn fifty_clients_at_once_are_served_or_sent_away_and_leave_nothing_behind() {
    let studio = Studio::new();
    let served: usize = std::thread::scope(|scope| {
        let studio = &studio;
        let clients: Vec<_> = (0..50)
            .map(|i| {
                scope.spawn(move || {
                    let Ok(mut client) = studio.call() else { return 0 };
                    client.open("a.toml");
                    if i % 3 == 0 {
                        return 1; // it goes in the middle of a tile
                    }
                    client.until(Page::is_done);
                    1
                })
            })
            .collect();
        clients.into_iter().map(|client| client.join().unwrap()).sum()
    });
    assert!(served >= 8, "{served} of 50 were served");
    // All places are free again.
    let mut free = 0;
    for _ in 0..200 {
        let clients: Vec<_> = (0..8).filter_map(|_| studio.call().ok()).collect();
        free = clients.len();
        drop(clients);
        if free == 8 {
            break;
        }
        std::thread::sleep(Duration::from_millis(50));
    }
    assert_eq!(free, 8);
}
