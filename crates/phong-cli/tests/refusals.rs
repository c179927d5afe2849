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
                    studio keys completions man new";
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
    folder.when("render broken.toml -o a.jpeg").is_refused(&[".png, .pfm, .exr or .svg"]);
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
fn negative_values_are_told_their_range() {
    let folder = given(&[("a.toml", BALLS)]);
    for (words, told) in [
        ("--samples -1", "from 1 to 1000000"),
        ("--depth -3", "from 0 to 1024"),
        ("--seed -1", "from 0 to 18446744073709551615"),
        ("--threads -2", "from 1 to 4096"),
        ("--crop -1,0,1,1", "four whole numbers"),
        ("--size -4x3", "width and height in pixels"),
        ("--tile -1/2", "like 0/4"),
        ("--color -1,0,0", "none below 0"),
        ("--background -1", "none below 0"),
        ("--background 1e39", "beyond 1e18"),
        ("--eye 1e300,0,0", "beyond 1e18"),
        ("--fov -40", "degrees"),
        ("--max-memory -1", "write bytes"),
    ] {
        let then = folder.when(&format!("render a.toml {words}"));
        then.is_refused(&[words.split(' ').next().unwrap(), told]);
        assert!(!then.err.contains("unexpected argument"), "{}", then.err);
    }
    for words in ["explain a.toml -1 2", "explain a.toml 1 -2", "explain a.toml 1 2 --sample -1"] {
        folder.when(words).is_refused(&["write a whole number from"]);
    }
}

#[test]
fn a_name_that_is_nearly_right_is_told_the_right_one() {
    let folder = given(&[
        ("scene.toml", BALLS),
        ("fong.toml", &BALLS.replace("[materials.mirror]", "[materials.mirror]\nmodel = \"fong\"")),
    ]);
    folder.when("render scene.toml --aov depht").is_refused(&["did you mean `depth`?"]);
    folder.when("check fong.toml").is_refused(&["fong.toml:13:9", "did you mean `phong`?"]);
    folder.when("check scene.tml --format toml").is_refused(&["did you mean `scene.toml`?"]);
    folder
        .when("compare scene.tml fong.png")
        .is_refused(&["scene.tml", "did you mean `scene.toml`?"]);
    folder.when("render scene.tom").is_refused(&["did you mean `scene.toml`?"]);
    folder.when("fit phong:3 blin-phong").is_refused(&["did you mean `blinn-phong`?"]);
    folder.when("man rendr").is_refused(&["did you mean `render`?"]);
    folder.when("check scene.toml --format tolm").is_refused(&["did you mean `toml`?"]);
}

#[test]
fn what_the_system_says_is_told_in_words() {
    let folder = given(&[("a.toml", BALLS), ("bad.toml", "[[mesh]]\nfile = \"no.obj\"\n")]);
    std::fs::create_dir(folder.path("folder.toml")).unwrap();
    for words in [
        "render no.toml",
        "render no.obj",
        "render no/such.ply",
        "render a.toml/b.toml",
        "render folder.toml",
        "render bad.toml",
        "compare no.png no.png",
        "compare folder.toml/ folder.toml/",
        "grade a.toml no.png",
        "grade a.toml folder.toml",
        "merge no.part -o a.png",
        "merge folder.toml -o a.png",
        "render a.toml -o a.toml/b.png",
        "convert a.toml no/such.ply",
        "figure vectors -d a.toml",
        "figure vectors -d a.toml/b",
    ] {
        let then = folder.when(words);
        assert_eq!(then.code, Some(2), "{words}: {}", then.err);
        assert!(!then.err.contains("os error"), "{words}: {}", then.err);
    }
    folder.when("render no.toml").is_refused(&["no.toml", "there is no such file", "its folder"]);
    folder.when("render no/such.ply").is_refused(&["there is no folder no"]);
    folder.when("render folder.toml").is_refused(&["it is a folder", "name a file in it"]);
}

#[test]
fn too_little_memory_for_a_text_is_told_with_what_it_takes() {
    let folder = given(&[("a.toml", BALLS)]);
    let needed = format!("takes {} of memory at least, over the limit of 500", 3 * BALLS.len());
    folder.when("render a.toml --max-memory 500").is_refused(&["a.toml", &needed]);
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
