//! The frames of trajectories.

use std::io::Cursor;

use phong::film::LayerKind;
use phong::finish::finish;
use phong::image::{Content, Encoding, Format, write};
use phong::part::Settings;
use phong::render::RenderOptions;
use phong::scene::{FrameRange, Frames, Limits, Memory};
use phong_studio::engine::{Bounds, Engine};
use serde_json::{Value, json};

use crate::client::Page;
use crate::engine::{Talk, bits, film, seen};

/// Three frames of two atoms, of which the second goes away.
const RUN: &str = "2\n\nC 0 0 0\nO 1.2 0 0\n2\n\nC 0 0 0\nO 2.4 0 0\n2\n\nC 0 0 0\nO 9 0 0\n";

const SCENE: &str = "version = 1\n[image]\nsize = [24, 16]\nsamples = 1\n[camera]\neye = [1, 0, 20]\n\
    look_at = [1, 0, 0]\n[[light]]\nkind = \"point\"\nposition = [5, 5, 20]\n[[molecule]]\nfile = \"run.xyz\"\n\
    style = \"spacefill\"\n";

fn talk(open: &str) -> Talk {
    let files = Memory::new().with("run.xyz", RUN).with("a.toml", SCENE);
    let engine = Engine::new(files, Bounds::default());
    let mut talk = Talk { engine, page: Page::default(), stops: false };
    talk.ask(&json!({ "do": "pixels", "kind": "linear" }));
    talk.ask(&json!({ "do": "open", "path": open }));
    talk
}

/// What `phong render --frames` makes of a frame of the scene.
fn rendered(number: u64) -> Vec<u32> {
    let files = Memory::new().with("run.xyz", RUN).with("a.toml", SCENE);
    let (limits, range) = (Limits::default(), FrameRange { start: number, end: None, step: 1 });
    let frames = Frames::new(&files, &limits, range);
    bits(&film(&frames.read(number, "a.toml", None, &[]).scene.unwrap()))
}

fn told(talk: &Talk) -> (Value, Value) {
    let look = talk.page.last("look");
    (look["frame"].clone(), look["frames"].clone())
}

#[test]
fn a_frame_of_a_scene_is_drawn_as_the_program_draws_it_and_what_is_laid_over_it_stays() {
    let mut talk = talk("a.toml");
    assert_eq!(told(&talk), (json!(0), json!(3)));
    talk.draw();
    assert_eq!(seen(&talk.page), rendered(0));
    talk.ask(&json!({ "do": "frame", "number": 1 }));
    talk.draw();
    assert_eq!((told(&talk), seen(&talk.page)), ((json!(1), json!(3)), rendered(1)));
    assert_eq!(talk.page.last("look")["command"], "phong render a.toml --frames 1");
    let python = |talk: &mut Talk| {
        talk.ask(&json!({ "do": "export", "format": "python" }));
        String::from_utf8_lossy(&talk.page.file).into_owned()
    };
    assert!(python(&mut talk).contains("scene = phong.Scene.read(\"a.toml\", frame=1)\n"));
    let set = json!({ "molecule.1.scale": 0.5, "camera.fov": 20 });
    talk.ask(&json!({ "do": "look", "set": set }));
    talk.draw();
    let program = python(&mut talk);
    assert!(program.contains("scale = 0.5") && program.contains("\"\"\", frame=1)\n"), "{program}");
    let before = seen(&talk.page);
    talk.ask(&json!({ "do": "frame", "number": 2 }));
    talk.draw();
    assert_ne!(seen(&talk.page), before);
    assert_eq!(talk.page.last("look")["set"], set);
    talk.ask(&json!({ "do": "frame", "number": 1 }));
    talk.draw();
    assert_eq!(seen(&talk.page), before);
    // The text is edited at the frame that is shown, and back at the first where there is no other any more.
    talk.ask(&json!({ "do": "edit", "text": SCENE, "set": {} }));
    talk.draw();
    assert_eq!(seen(&talk.page), rendered(1));
    talk.ask(&json!({ "do": "edit", "text": SCENE.replace("run", "gone") }));
    assert_eq!(talk.page.last("checked")["ok"], false);
    talk.ask(&json!({ "do": "frame", "number": 0 }));
    assert!(talk.page.last("error")["message"].as_str().unwrap().contains("cannot be read"));
    let ball = SCENE.split("[[molecule]]").next().unwrap().to_owned();
    talk.ask(
        &json!({ "do": "edit", "text": ball + "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\n" }),
    );
    assert_eq!(told(&talk), (json!(0), json!(1)));
}

#[test]
fn frames_of_a_bare_model_are_seen_as_the_first_one_is() {
    let mut talk = talk("run.xyz");
    talk.ask(&json!({ "do": "look", "set": { "image.size": [24, 16], "image.samples": 1 } }));
    let first = talk.page.last("look").clone();
    talk.ask(&json!({ "do": "frame", "number": 2 }));
    let look = talk.page.last("look");
    assert_eq!((&look["values"], &look["command"]), (&first["values"], &json!(null)));
    // So they are with a look on, and without it again.
    talk.ask(&json!({ "do": "put-on", "look": "clay" }));
    let clay = talk.page.last("look")["values"].clone();
    talk.ask(&json!({ "do": "frame", "number": 1 }));
    assert_eq!(talk.page.last("look")["values"], clay);
    talk.ask(&json!({ "do": "put-on", "look": null }));
    assert_eq!(talk.page.last("look")["values"], first["values"]);
    assert_eq!(told(&talk), (json!(1), json!(3)));
    talk.ask(&json!({ "do": "frame", "number": 0 }));
    assert_eq!(talk.page.last("look")["values"], first["values"]);
}

#[test]
fn a_frame_that_is_not_there_or_cannot_be_read_is_refused_and_all_is_as_it_was() {
    let mut talk = talk("a.toml");
    for number in [json!(3), json!(u64::MAX)] {
        talk.ask(&json!({ "do": "frame", "number": number }));
        let said = talk.page.last("error")["message"].as_str().unwrap();
        assert!(said.contains("there are 3, 0 to 2"), "{said}");
    }
    for wrong in [json!(-1), json!(0.5), json!(null), json!("1")] {
        talk.ask(&json!({ "do": "frame", "number": wrong }));
        assert!(talk.page.last("error")["message"].as_str().unwrap().contains("no request"));
    }
    assert_eq!(talk.page.all("look").len(), 1);
    // A frame with a fault in it is refused, and the others are shown.
    let broken = format!("{RUN}2\n\nC 0 0\nO x 0 0\n");
    let files = Memory::new().with("run.xyz", broken);
    talk.engine = Engine::new(files, Bounds::default());
    talk.ask(&json!({ "do": "open", "path": "run.xyz" }));
    assert_eq!(told(&talk), (json!(0), json!(4)));
    talk.ask(&json!({ "do": "frame", "number": 3 }));
    let said = talk.page.last("error")["message"].as_str().unwrap();
    assert!(said.contains("frame 3: "), "{said}");
    talk.ask(&json!({ "do": "turn", "by": [0.1, 0] }));
    assert_eq!(told(&talk), (json!(0), json!(4)));
}

/// What is copied as Python, or why nothing is.
fn python(talk: &mut Talk) -> Result<String, String> {
    let errors = talk.page.all("error").len();
    talk.ask(&json!({ "do": "export", "format": "python" }));
    match talk.page.all("error").get(errors) {
        Some(error) => Err(error["message"].as_str().unwrap().to_owned()),
        None => Ok(String::from_utf8_lossy(&talk.page.file).into_owned()),
    }
}

#[test]
fn a_later_frame_of_a_bare_model_is_copied_as_python_with_the_camera_of_the_first() {
    let mut talk = talk("run.xyz");
    let first = python(&mut talk).unwrap();
    assert!(
        first.contains("phong.Scene.read(\"run.xyz\")\n") && !first.contains("camera"),
        "{first}"
    );
    talk.ask(&json!({ "do": "put-on", "look": "clay" }));
    talk.ask(&json!({ "do": "frame", "number": 2 }));
    let lines = [
        "scene = phong.Scene.read(\"run.xyz\", frame=2)",
        "# Seen as the first frame is.",
        "scene.camera = phong.Scene.read(\"run.xyz\").camera",
        "scene.look(\"clay\")",
        "phong.render(scene).save(\"picture.png\")",
    ];
    assert!(python(&mut talk).unwrap().ends_with(&(lines.join("\n") + "\n")));
    // Where sizes are guessed for each frame, it would not be the same.
    let frame = |time: u32, x: f32| {
        format!(
            "ITEM: TIMESTEP\n{time}\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n0 9\n0 9\n0 9\n\
             ITEM: ATOMS id type x y z\n1 1 1 1 1\n2 1 {x} 1 1\n"
        )
    };
    let files = Memory::new().with("run.lammpstrj", frame(0, 2.0) + &frame(1, 3.0));
    talk.engine = Engine::new(files, Bounds::default());
    talk.ask(&json!({ "do": "open", "path": "run.lammpstrj" }));
    assert_eq!(told(&talk), (json!(0), json!(2)));
    assert!(python(&mut talk).is_ok());
    talk.ask(&json!({ "do": "frame", "number": 1 }));
    assert!(python(&mut talk).unwrap_err().contains("copy the first"));
}

#[test]
fn the_file_of_a_later_frame_says_which_picture_it_is_as_the_program_s_does() {
    let files = Memory::new().with("run.xyz", RUN).with("a.toml", SCENE);
    let (limits, range) = (Limits::default(), FrameRange { start: 1, end: None, step: 1 });
    let scene = Frames::new(&files, &limits, range).read(1, "a.toml", None, &[]).scene.unwrap();
    let options = RenderOptions::of(&scene.image).unwrap();
    let settings = Settings::of(&scene, &options, Encoding::default());
    let finishing = settings.finishing().of_picture(settings.checksum());
    let mut expected = Cursor::new(Vec::new());
    let film = film(&scene);
    let picture = Content::Layer(LayerKind::Picture);
    let finished = finish(&film, &finishing);
    write(&finished, picture, Format::Png, &settings.encoding, &mut expected).unwrap();
    let mut talk = talk("a.toml");
    talk.ask(&json!({ "do": "frame", "number": 1 }));
    talk.draw();
    talk.ask(&json!({ "do": "export", "format": "png" }));
    assert!(talk.page.file == expected.into_inner());
    talk.ask(&json!({ "do": "frame", "number": 0 }));
    talk.draw();
    talk.ask(&json!({ "do": "export", "format": "png" }));
    assert!(!String::from_utf8_lossy(&talk.page.file).contains("Picture"));
}
