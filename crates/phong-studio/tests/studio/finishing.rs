//! What is drawn onto a picture that is whole.

use phong::film::Film;
use phong::finish::finish;
use phong::image::{Content, Encoding, Format, write};
use phong::part::Settings;
use phong::render::{Cancel, RenderOptions, render};
use phong::scene::{Limits, Memory, Scene, read};
use phong::view::View;
use phong_lab::furniture;
use serde_json::json;

use crate::SCENE;
use crate::engine::{Talk, bits, seen};

fn text() -> String {
    format!("{SCENE}[outline]\nwidth = 1.5\n[title]\ntext = \"Two\"\n")
}

fn scene() -> Scene {
    let files = Memory::new().with("a.toml", text());
    read("a.toml", None, &files, &Limits::default()).scene.unwrap()
}

/// What `phong render` makes of the scene: the film, the finished picture, and its files.
fn rendered() -> (Film, Film, Vec<u8>, String) {
    let scene = scene();
    let options = RenderOptions::of(&scene.image).unwrap().with_finishing_of(&scene);
    let film = render(&View::of(&scene).unwrap(), &options, &|_| {}, &Cancel::new()).film;
    let settings = Settings::of(&scene, &options, Encoding::default());
    let svg = furniture::svg(&film, &settings, &settings.encoding).unwrap();
    let finished = finish(&film, &furniture::finishing(&film, &settings));
    let mut exr = std::io::Cursor::new(Vec::new());
    write(&finished, Content::Film, Format::Exr, &Encoding::default(), &mut exr).unwrap();
    let picture = finished.into_film();
    (film, picture, exr.into_inner(), svg)
}

#[test]
fn lines_are_seen_and_saved_as_a_render_draws_them() {
    let (bare, finished, exr, svg) = rendered();
    let mut talk = Talk::of(&text());
    assert_eq!(talk.page.last("look")["finished"], true);
    while talk.engine.has_work() {
        talk.some();
    }
    assert!(talk.page.is_done());
    assert_eq!(seen(&talk.page), bits(&finished));
    assert_ne!(seen(&talk.page), bits(&bare));
    talk.ask(&json!({ "do": "export", "format": "exr" }));
    assert!(talk.page.file == exr);
    talk.ask(&json!({ "do": "export", "format": "svg" }));
    assert_eq!(String::from_utf8_lossy(&talk.page.file), svg);
    talk.ask(&json!({ "do": "look", "set": { "outline.color": "red" } }));
    talk.draw();
    assert_ne!(seen(&talk.page), bits(&finished));
    assert_eq!(Talk::of(SCENE).page.last("look")["finished"], false);
}

#[test]
fn lines_stay_where_a_term_is_left_out() {
    let mut talk = Talk::of(&text());
    talk.draw();
    let whole = talk.page.pixels.clone();
    let is_line = |pixel: &&[f32]| pixel[..3] == [0.0; 3];
    let lines = whole.chunks_exact(4).filter(is_line).count();
    assert!(lines > 20, "{lines}");
    talk.ask(&json!({ "do": "terms", "off": ["diffuse"] }));
    talk.draw();
    let pairs = whole.chunks_exact(4).zip(talk.page.pixels.chunks_exact(4));
    for (before, now) in pairs.filter(|(before, _)| is_line(before)) {
        assert_eq!(before, now);
    }
    assert_ne!(whole, talk.page.pixels);
}

#[test]
fn who_has_all_shares_finishes_the_picture_and_nobody_else_does() {
    let mut talks: Vec<Talk> = (0..3).map(|index| Talk::sharing(&text(), index, 3)).collect();
    let mut parts = Vec::new();
    for talk in &mut talks {
        talk.draw();
        parts.extend(talk.engine.part());
    }
    let mut first = talks.swap_remove(0);
    let picture = first.page.last("look")["picture"].as_u64().unwrap();
    let said = first.page.replies.len();
    first.ask(&json!({ "do": "finish", "picture": picture }));
    assert_eq!(first.page.replies.len(), said, "it has its own share alone");
    for part in &parts[1..] {
        first.with(|engine, emit| engine.join(part, emit));
    }
    first.ask(&json!({ "do": "finish", "picture": picture - 1 }));
    assert_eq!(first.page.replies.len(), said, "that picture is gone");
    first.ask(&json!({ "do": "finish", "picture": picture }));
    assert_eq!(first.page.replies.len(), said + 1);
    assert_eq!(seen(&first.page), bits(&rendered().1));
}

#[test]
fn tiles_of_a_share_have_their_tone_unless_that_needs_the_whole_picture() {
    let scene = |tone: &str| format!("{SCENE}[tone]\n{tone}\n");
    let toned = scene("exposure = 1.5\ncurve = \"filmic\"");
    let mut whole = Talk::of(&toned);
    whole.draw();
    let mut seen = 0;
    for index in 0..2 {
        let mut talk = Talk::sharing(&toned, index, 2);
        talk.draw();
        for (part, whole) in talk.page.pixels.iter().zip(&whole.page.pixels) {
            assert!(part.is_nan() || part.to_bits() == whole.to_bits(), "{part} {whole}");
            seen += usize::from(!part.is_nan());
        }
    }
    assert_eq!(seen, whole.page.pixels.len());
    let mut talk = Talk::sharing(&scene("exposure = \"auto\""), 0, 2);
    talk.draw();
    assert!(talk.page.pixels.iter().all(|value| value.is_nan()));
}

#[test]
fn what_finishes_a_picture_is_seen_and_told_as_the_program_has_it() {
    let steps = SCENE.replacen("[image]\n", "[image]\ncel = 3\n", 1);
    let label = "[[label]]\ntext = \"Here\"\nat = [0, 0, 0]\nhidden = \"never\"\n";
    let over = format!("{SCENE}\n[outline]\nwidth = 2\n[title]\ntext = \"Over it\"\n{label}");
    for text in [steps, over] {
        assert_finished_and_told(&text);
    }
}

/// That the engine shows the finished picture of this scene, and tells the bytes of its pixels, as the program does.
fn assert_finished_and_told(text: &str) {
    let files = Memory::new().with("a.toml", text);
    let scene = read("a.toml", None, &files, &Limits::default()).scene.unwrap();
    let options = RenderOptions::of(&scene.image).unwrap().with_finishing_of(&scene);
    let view = View::of(&scene).unwrap();
    let film = render(&view, &options, &|_| {}, &Cancel::new()).film;
    let settings = Settings::of(&scene, &options, Encoding::default());
    let mut talk = Talk::of(text);
    talk.draw();
    let finished = furniture::finish(&film, &settings);
    assert_eq!(seen(&talk.page), bits(&finished.into_film()));
    let options = options.with_samples(1).unwrap();
    let mut changed = 0;
    for mut talk in [talk, Talk::sharing(text, 1, 2)] {
        for pixel in [[10, 8], [16, 12], [22, 9], [16, 1], [3, 2]] {
            let mut told = phong::explain::explain(&view, &options, pixel).unwrap();
            furniture::expose(&mut told, &scene, &view, &options, &|_| {}, &Cancel::new());
            changed += u32::from(told.cel.is_some() || !told.furniture.is_empty());
            talk.ask(&json!({ "do": "explain", "id": 1, "pixel": pixel }));
            assert_eq!(
                talk.page.last("explanation")["told"],
                phong_lab::tell::json(&told),
                "{pixel:?}"
            );
        }
    }
    assert!(changed > 1, "{changed} of {text}");
}
