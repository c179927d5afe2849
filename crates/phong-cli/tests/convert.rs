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
fn a_bare_model_is_framed_for_the_size_that_is_asked_for_and_the_account_says_so() {
    let folder = given(&[("a.obj", "v -1 0 0\nv 1 0 0\nv 0 3 0\nf 1 2 3\n")]);
    let then = folder.done("convert a.obj a.toml --size 30x60 --view front");
    assert!(then.err.contains("the model fills a picture of 30 × 60"), "{}", then.err);
    folder.done("render a.toml --samples 2 -o a.png --quiet");
    folder.done("render a.obj --size 30x60 --view front --samples 2 -o b.png --quiet");
    assert!(folder.bytes("a.png") == folder.bytes("b.png"));
}

#[test]
fn a_model_of_which_nothing_can_be_seen_is_told() {
    let folder = given(&[("a.obj", "v 0 0 0\nv 1 1 1\nv 2 2 2\nf 1 2 3\nf 3 2 1\n")]);
    let then = folder.done("render a.obj --size 4x4 -o a.png");
    assert!(then.err.contains("a.obj") && then.err.contains("none of its 2 triangles has an area"));
    folder.when("render a.obj --size 4x4 -o b.png --strict").is_refused(&["has an area"]);
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
    folder
        .when("convert a.toml b.docx")
        .is_refused(&["b.docx", ".toml, .obj, .ply, .stl, .gltf or .dat"]);
    folder.when("convert a.toml b.nff").is_refused(&["NFF", "not written yet"]);
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

#[test]
fn what_is_lost_is_listed_and_an_error_if_it_must_not_be() {
    let scene = format!(
        "{BALLS}[[triangle]]\npoints = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\nmaterial = \"mirror\"\n"
    );
    let folder = given(&[("a.toml", &scene)]);
    folder.when("convert a.toml b.obj --strict").is_refused(&[
        "error: OBJ holds no camera",
        "`sphere 1`",
        "`plane 1`",
    ]);
    assert_eq!(folder.names(), ["a.toml"]);

    let then = folder.done("convert a.toml b.obj");
    for word in ["wrote b.obj", "wrote b.mtl", "1 triangle", "(N·H)^4n = 128", "the mirror"] {
        assert!(then.err.contains(word), "{word}: {}", then.err);
    }
    assert!(then.out.is_empty());
    let told = folder.done("convert a.toml b.obj --json").json();
    assert_eq!(told["files"], serde_json::json!(["b.obj", "b.mtl"]));
    let dropped = told["dropped"].as_array().unwrap();
    let ball = dropped.iter().find(|d| d["message"].as_str().unwrap().contains("sphere")).unwrap();
    assert_eq!((&ball["file"], &ball["line"]), (&"a.toml".into(), &14.into()));
    assert_eq!(folder.done("convert a.toml b.obj -q").err, "");
    folder.when("convert b.obj c.ply --strict").is_refused(&["PLY holds no materials", "mirror"]);
    folder.done("convert b.obj c.ply");
    folder.when("convert a.toml c.ply -q --strict").is_refused(&["PLY holds no lights"]);
}

#[test]
fn models_go_round_by_every_format_to_the_same_picture() {
    let knot = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/knot.obj");
    let folder = given(&[]);
    folder.done(&format!("render {} -o a.pfm --size 60x40 --samples 2", knot.display()));
    folder.done(&format!("convert {} b.ply --strict", knot.display()));
    folder.done("convert b.ply c.obj --strict");
    folder.done("convert c.obj d.ply --strict --ascii");
    for name in ["b.ply", "c.obj", "d.ply"] {
        folder.done(&format!("render {name} -o b.pfm --size 60x40 --samples 2"));
        assert!(folder.bytes("a.pfm") == folder.bytes("b.pfm"), "{name}");
    }
}

#[test]
fn odd_models_are_converted_or_refused_like_any_input() {
    let folder = given(&[
        ("lost.obj", "mtllib gone.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl x\nf 1 2 3\n"),
        ("nan.obj", "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
        ("empty.obj", ""),
        ("empty.toml", "version = 1\n[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\n"),
    ]);
    let then = folder.done("convert lost.obj lost.toml");
    assert!(then.err.contains("gone.mtl"), "{}", then.err);
    folder.when("convert lost.obj b.ply --strict").is_refused(&["gone.mtl"]);
    folder.when("convert nan.obj b.ply").is_refused(&["nan.obj:1"]);
    folder.when("convert empty.obj b.ply").is_refused(&["empty.obj"]);
    folder.when("convert empty.toml b.obj").is_refused(&["nothing would be in the file"]);
    folder.done("convert empty.toml same.toml");
    let names = ["empty.obj", "empty.toml", "lost.mesh-1.ply", "lost.obj", "lost.toml"];
    assert_eq!(folder.names(), [&names[..], &["nan.obj", "same.toml"]].concat());
}

#[test]
fn solids_become_triangles_within_a_tolerance_and_the_account_counts_them() {
    let folder = given(&[("a.toml", BALLS)]);
    let then = folder.done("convert a.toml a.stl --tessellate 0.05");
    assert!(then.err.contains("nowhere farther than 0.05 from the surface"), "{}", then.err);
    assert!(!then.err.contains("sphere 1` are left out"), "{}", then.err);
    for wrong in ["0", "-1", "nan", "inf", "fine"] {
        folder
            .when(&format!("convert a.toml b.stl --tessellate {wrong}"))
            .is_refused(&["a tolerance is a number above 0"]);
    }
}
