//! From one format to another, as typed.
#![allow(clippy::unwrap_used, reason = "tests")]

mod support;

use std::fs;
use std::path::Path;

use support::{BALLS, given};

#[test]
fn a_scene_comes_back_as_the_very_picture() {
    let gallery = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let folder = given(&[]);
    for name in ["glass", "instances", "metals", "smooth-and-flat", "soft-shadows"] {
        let scene = gallery.join(name).with_extension("toml");
        let scene = scene.to_str().unwrap();
        let small = "--size 60x40 --samples 2 --terms";
        folder.done(&format!("convert {scene} {name}.toml"));
        folder.done(&format!("render {scene} {small} -o a.exr"));
        folder.done(&format!("render {name}.toml {small} -o b.exr"));
        assert!(folder.bytes("a.exr") == folder.bytes("b.exr"), "{name}");
    }
}

#[test]
fn the_same_scene_gives_the_same_bytes() {
    let folder = given(&[("a.toml", BALLS)]);
    folder.done("convert a.toml b.toml");
    folder.done("convert b.toml c.toml");
    assert_eq!(folder.bytes("b.toml"), folder.bytes("c.toml"));
    let then = folder.done("convert a.toml - --to toml");
    assert_eq!(then.out, folder.bytes("b.toml"));
}

#[test]
fn what_is_wrong_with_the_words_is_said_before_anything_is_read() {
    let folder = given(&[("a.toml", BALLS), ("nan.toml", &BALLS.replace("0.7", "nan"))]);
    folder.when("convert a.toml b.docx").is_refused(&["b.docx", ".toml, .obj or .ply"]);
    folder.when("convert a.toml b.stl").is_refused(&["STL", "not written yet"]);
    folder.when("convert a.toml").is_refused(&["OUT"]);
    folder.when("convert a.toml -").is_refused(&["--to"]);
    folder.when("convert a.toml - --to toml --json").is_refused(&["standard output"]);
    folder.when("convert a.toml no/b.toml").is_refused(&["no/b.toml", "no such folder"]);
    folder.when("convert a.toml b.toml --too toml").is_refused(&["--to"]);
    folder.when("convert none.toml b.toml").is_refused(&["none.toml", "no such file"]);
    folder.when("convert a.toml a.toml").is_refused(&["over the input"]);
    folder.when("convert nan.toml b.toml").is_refused(&["nan.toml:8", "NaN"]);
    assert_eq!(folder.names(), ["a.toml", "nan.toml"]);
    assert_eq!(folder.bytes("a.toml"), BALLS.as_bytes());
}

#[test]
fn geometry_lies_beside_the_text_or_nowhere() {
    let folder = given(&[("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")]);
    folder.when("convert a.obj - --to toml").is_refused(&["several files"]);
    fs::create_dir(folder.path("b.mesh-1.ply")).unwrap();
    folder.when("convert a.obj b.toml").is_refused(&["b.mesh-1.ply", "folder"]);
    assert_eq!(folder.names(), ["a.obj", "b.mesh-1.ply"]);
    let told = folder.done("convert a.obj c.toml --json").json();
    assert_eq!(told["files"], serde_json::json!(["c.toml", "c.mesh-1.ply"]));
    assert_eq!((&told["carried"]["mesh"], &told["carried"]["light"]), (&1.into(), &2.into()));
    assert_eq!(folder.names(), ["a.obj", "b.mesh-1.ply", "c.mesh-1.ply", "c.toml"]);
    // A bare model's camera is that for a picture of the default size.
    folder.done("render a.obj -o a.png --crop 400,200,500,280");
    folder.done("render c.toml -o c.png --crop 400,200,500,280");
    assert_eq!(folder.bytes("a.png"), folder.bytes("c.png"));
}
