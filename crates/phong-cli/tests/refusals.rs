//! What is wrong is told where it is wrong, with exit code 2, and nothing is left behind.
#![allow(clippy::unwrap_used, reason = "tests")]

mod support;

use std::process::Stdio;

use support::{BALLS, Then, given};

#[test]
fn how_wide_a_camera_sees_depends_on_its_kind() {
    let fisheye =
        BALLS.replace("[camera]\n", "[camera]\nkind = \"fisheye\"\n").replace("fov = 40\n", "");
    let folder = given(&[("a.toml", BALLS), ("f.toml", &fisheye)]);
    folder.when("render a.toml --fov 200 -o a.png").is_refused(&["--fov", "less than 180"]);
    folder.done("render f.toml --fov 220 -o f.png");
}

#[test]
fn a_mistyped_command_is_corrected() {
    given(&[]).when("rendr").is_refused(&["rendr", "render"]);
}

#[test]
fn every_command_has_help_with_an_exit_code_of_nought() {
    let folder = given(&[]);
    let commands = "render explain figure eval fit compare grade check info convert bench merge \
                    studio keys completions man";
    for command in commands.split_whitespace() {
        let then = folder.done(&format!("{command} --help"));
        assert!(!then.out.is_empty(), "{command}");
    }
}

#[test]
fn a_missing_file_is_named() {
    let folder = given(&[]);
    folder.when("render nowhere.toml").is_refused(&["nowhere.toml"]);
    assert!(folder.names().is_empty());
}

#[test]
fn a_mistyped_key_has_line_caret_and_correction() {
    let folder = given(&[("a.toml", &BALLS.replace("radius", "radus"))]);
    let then = folder.when("render a.toml");
    then.is_refused(&["a.toml:16:1", "^^^^^", "did you mean `radius`"]);
    assert_eq!(folder.names(), ["a.toml"]);
}

#[test]
fn a_mesh_cut_short_is_told() {
    let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
               property float z\nelement face 1\nproperty list uchar int vertex_indices\n\
               end_header\n0 0 0\n1 0 0\n";
    let folder = given(&[("a.ply", ply)]);
    folder.when("render a.ply").is_refused(&["a.ply"]);
    assert_eq!(folder.names(), ["a.ply"]);
}

#[test]
fn what_cannot_be_written_is_known_before_anything_is_read() {
    let folder = given(&[("broken.toml", "not a scene")]);
    folder.when("render broken.toml -o no/such/a.png").is_refused(&["no such folder"]);
    folder.when("render broken.toml -o . --output-format png").is_refused(&["folder"]);
    folder.when("render broken.toml -o a.jpeg").is_refused(&[".png, .pfm or .exr"]);
    assert_eq!(folder.names(), ["broken.toml"]);
}

#[test]
fn of_several_files_all_are_written_or_none() {
    let folder = given(&[("a.toml", BALLS)]);
    std::fs::create_dir(folder.path("x.depth.png")).unwrap();
    folder.when("render a.toml -o x.png --aov normal,depth").is_refused(&["x.depth.png", "folder"]);
    assert_eq!(folder.names(), ["a.toml", "x.depth.png"]);
}

#[test]
fn the_input_is_never_written_over() {
    let folder = given(&[("a.toml", BALLS)]);
    folder.when("render a.toml -o a.toml --output-format png").is_refused(&["over the input"]);
    assert_eq!(folder.bytes("a.toml"), BALLS.as_bytes());
}

#[test]
fn values_out_of_range_are_refused_with_the_way_out() {
    let folder = given(&[("a.toml", BALLS)]);
    folder.when("render a.toml --size 0x5").is_refused(&["--size", "from 1"]);
    folder.when("render a.toml --crop 0,0,41,5").is_refused(&["--crop", "40x30"]);
    folder.when("render a.toml --tile 2/2").is_refused(&["--tile", "last of 2 is 1"]);
    folder.when("render a.toml --aov dept").is_refused(&["--aov", "depth"]);
    folder.when("render a.toml --samples 0").is_refused(&["--samples"]);
    folder.when("render a.toml --color red").is_refused(&["--color", "bare models"]);
    folder.when("render a.toml --eye 0,1,0 --look-at 0,1,0").is_refused(&["same point"]);
    folder.when("render - ").is_refused(&["--format"]);
    folder.when("render a.toml -o - --json").is_refused(&["standard output"]);
    folder.when("render a.toml -o - --terms").is_refused(&["standard output", "exr"]);
    assert_eq!(folder.names(), ["a.toml"]);
}

#[test]
fn a_picture_that_memory_cannot_hold_is_refused() {
    let folder = given(&[("a.toml", BALLS)]);
    folder
        .when("render a.toml --size 400x400 --max-memory 100k")
        .is_refused(&["memory", "--max-memory"]);
    folder.when("render a.toml --size 1000000x1000000").is_refused(&["memory"]);
    assert_eq!(folder.names(), ["a.toml"]);
}

#[test]
fn check_tells_programs_everything() {
    let folder = given(&[("a.toml", &BALLS.replace("radius", "radus")), ("b.toml", BALLS)]);
    let then = folder.when("check a.toml --json");
    assert_eq!(then.code, Some(2));
    assert_eq!(then.json()["ok"], false);
    let found = then.json()["diagnostics"].as_array().unwrap().clone();
    let typo = found.iter().find(|d| d["line"] == 16).unwrap();
    assert_eq!((&typo["severity"], &typo["column"]), (&"error".into(), &1.into()));
    assert_eq!((&typo["file"], typo["message"].is_string()), (&"a.toml".into(), true));
    assert_eq!(folder.done("check b.toml --json").json()["ok"], true);
}

#[test]
fn a_reader_that_has_had_enough_is_no_panic() {
    let folder = given(&[("a.toml", BALLS)]);
    for words in ["render a.toml -o -", "info a.toml", "man", "--help"] {
        let mut child =
            folder.command(words).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        let then = Then::of(child.wait_with_output().unwrap());
        assert_eq!((then.code, then.err.as_str()), (Some(0), ""), "{words}");
    }
}
