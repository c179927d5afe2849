//! Films: many pictures of one input, a file each or all in one.
#![allow(clippy::unwrap_used, reason = "tests")]

mod support;

use std::fs;
use std::io::Cursor;

use support::{BALLS, Given, given};

/// A pyramid, lopsided.
const PYRAMID: &str = "v -1 0 -1\nv 1 0 -1\nv 2 0 1\nv -1 0 1\nv 0 3 0\n\
                       f 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\nf 4 3 2 1\n";

fn folder() -> Given {
    given(&[("a.toml", BALLS), ("p.obj", PYRAMID)])
}

/// Two pictures have the very same pixels.
fn are_the_same(folder: &Given, a: &str, b: &str) {
    let told = folder.when(&format!("compare {a} {b} --json")).json();
    assert_eq!(told["max"], 0.0, "{a}, {b}: {told}");
}

#[test]
fn a_picture_of_a_turntable_has_the_bits_of_a_render_with_that_camera() {
    let folder = folder();
    folder.done("render a.toml --turntable 4 -o s%d.png");
    folder.done("render a.toml -o whole.png");
    are_the_same(&folder, "s0.png", "whole.png");
    for (number, eye) in [(1, "5,1,0"), (2, "0,1,-5"), (3, "-5,1,0")] {
        folder.done(&format!("render a.toml --eye {eye} -o whole.png"));
        are_the_same(&folder, &format!("s{number}.png"), "whole.png");
    }
    // A bare model is lit from behind its camera, wherever that is.
    let view = "--size 40x30 --samples 2 --look-at 0.5,1,0";
    folder.done(&format!("render p.obj {view} --eye 0.5,2,8 --turntable 4 -o p%02d.png"));
    for (number, eye) in [("00", "0.5,2,8"), ("01", "8.5,2,0"), ("03", "-7.5,2,0")] {
        folder.done(&format!("render p.obj {view} --eye {eye} -o whole.png"));
        are_the_same(&folder, &format!("p{number}.png"), "whole.png");
    }
}

#[test]
fn a_bare_model_stays_in_the_picture_all_the_way_around() {
    let folder = folder();
    folder.done("render p.obj --size 64x48 --samples 1 --turntable 12 --aov object -o p%d.exr");
    folder.done("render p.obj --size 64x48 --samples 1 --turntable 12 --aov object -o p%d.png");
    for number in 0..12 {
        let bytes = folder.bytes(&format!("p{number}.object.png"));
        let mut reader = png::Decoder::new(Cursor::new(&bytes)).read_info().unwrap();
        let mut grey = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut grey).unwrap();
        let met = |x: usize, y: usize| grey[2 * (64 * y + x) + 1] != 0;
        let at_edge =
            (0..64).any(|x| met(x, 0) || met(x, 47)) || (0..48).any(|y| met(0, y) || met(63, y));
        assert!(!at_edge && grey.iter().any(|g| *g != 0), "{number}");
    }
}

#[test]
fn pictures_that_are_there_and_of_the_same_input_are_kept_and_others_drawn_again() {
    let folder = folder();
    let film = "render a.toml --turntable 5 --json -o f-%04d.png";
    assert_eq!(folder.done(film).json()["skipped"], 0);
    fs::remove_file(folder.path("f-0003.png")).unwrap();
    let cut = folder.bytes("f-0001.png");
    fs::write(folder.path("f-0001.png"), &cut[..cut.len() - 1]).unwrap();
    folder.done("render a.toml -o f-0004.png");
    assert_eq!(folder.done(&format!("{film} --resume")).json()["skipped"], 2);
    assert_eq!(folder.bytes("f-0001.png"), cut);
    let then = folder.done("render a.toml --turntable 5 -o f-%04d.png --resume");
    assert!(then.err.contains("5 pictures, of which 5 were there already"), "{}", then.err);
    for other in ["--samples 3", "--seed 7", "--no-shadows", "--set sphere.1.radius=0.9"] {
        assert_eq!(folder.done(&format!("{film} --resume {other}")).json()["skipped"], 0);
    }
    folder.done(film);
    // Another film has other pictures but for the first, and every second one of this.
    let wider = "render a.toml --turntable 10 --json -o f-%04d.png --resume";
    assert_eq!(folder.done(wider).json()["skipped"], 1);
    assert_eq!(folder.names().len(), 12);
}

#[test]
fn layers_of_a_picture_are_there_or_it_is_drawn_again() {
    let folder = folder();
    let film = "render a.toml --turntable 2 --aov depth --json --resume -o f-%d.png";
    assert_eq!(folder.done(film).json()["skipped"], 0);
    assert_eq!(folder.done(film).json()["skipped"], 2);
    fs::remove_file(folder.path("f-1.depth.png")).unwrap();
    assert_eq!(folder.done(film).json()["skipped"], 1);
    let film = "render a.toml --turntable 2 --terms --json --resume -o f-%d.exr";
    assert_eq!(folder.done(film).json()["skipped"], 0);
    assert_eq!(folder.done(film).json()["skipped"], 2);
}

#[test]
fn a_name_without_a_place_is_one_file_that_moves() {
    let folder = folder();
    folder.done("render a.toml --turntable 6 --fps 12 -o a.png");
    folder.done("render a.toml --turntable 6 -o f%d.png");
    let bytes = folder.bytes("a.png");
    let mut reader = png::Decoder::new(Cursor::new(&bytes)).read_info().unwrap();
    assert_eq!(reader.info().animation_control.unwrap().num_frames, 6);
    for number in 0..6 {
        let mut moving = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut moving).unwrap();
        assert_eq!(reader.info().frame_control.unwrap().delay_den, 12);
        let bytes = folder.bytes(&format!("f{number}.png"));
        let mut single = png::Decoder::new(Cursor::new(&bytes)).read_info().unwrap();
        let mut alone = vec![0; single.output_buffer_size().unwrap()];
        single.next_frame(&mut alone).unwrap();
        assert!(moving == alone, "{number}");
    }
    folder.done("render a.toml --turntable 6 -o a.gif");
    let gif = folder.bytes("a.gif");
    assert!(gif.starts_with(b"GIF89a") && gif.ends_with(&[0x3b]));
}

#[test]
fn memory_does_not_grow_with_the_number_of_pictures() {
    let folder = folder();
    let peak = |pictures: u32, name: &str| {
        let words =
            "render a.toml --size 160x120 --samples 1 --depth 0 --no-shadows --threads 2 --json";
        let told = folder.done(&format!("{words} --turntable {pictures} -o {name}")).json();
        told["peak_bytes"].as_u64().unwrap()
    };
    for name in ["a.gif", "a.png", "f-%d.png"] {
        let [few, many] = [peak(4, name), peak(44, name)];
        // Forty films take 12 MB.
        assert!(many < few + (7 << 20), "{name}: {few}, {many}");
    }
}

#[test]
fn what_no_film_can_be_is_refused_with_a_way_out() {
    let folder = folder();
    let turn = "render a.toml --turntable 3";
    for (words, said) in [
        ("-o a.exr", ["do not fit into a.exr", "-o a-%04d.exr is a file for each"]),
        ("-o a.pfm --resume", ["do not fit into a.pfm", "a-%04d.pfm"]),
        ("-o %d-%d.png", ["more than one place", "write %d or %04d once"]),
        ("-o f-{}.png", ["{} in f-{}.png is no place", "-o f-%04d.png"]),
        ("-o -", ["standard output", "-o a-%04d.png"]),
        ("-o %d.pfm --resume", ["PFM files do not say what they are of", "PNG or EXR"]),
        ("-o %d.svg --resume", ["SVG files do not say what they are of", "PNG or EXR"]),
        ("-o a.gif --resume", ["in one go", "%04d"]),
        ("-o a.gif --fps 60", ["at most 50", ".png"]),
        ("-o a.gif --terms", ["layers", "%04d"]),
        ("-o a.png --bits 16", ["8 bits", "%04d"]),
        ("-o %d.png --fps 9", ["one file that moves", "leave it out"]),
        ("-o none/%d.png", ["none/0.png", "no such folder"]),
        ("-o %d.tga", ["does not say what to write", ".png"]),
        ("--watch", ["--turntable", "--watch"]),
        ("--tile 0/2", ["--turntable", "--tile"]),
    ] {
        folder.when(&format!("{turn} {words}")).is_refused(&said);
    }
    folder.when("render a.toml --turntable 0").is_refused(&["from 1 to 1000000"]);
    folder.when("render a.toml --fps 9").is_refused(&["--turntable"]);
    assert_eq!(folder.names(), ["a.toml", "p.obj"]);
    let batch = "version = 1\ninputs = \"a.toml\"\noptions = \"--turntable 5\"\n";
    fs::write(folder.path("b.toml"), batch).unwrap();
    folder.when("batch b.toml").is_refused(&["--turntable", "camera.eye"]);
}

#[test]
fn no_picture_is_written_over_the_input() {
    let folder = folder();
    fs::copy(folder.path("a.toml"), folder.path("f2.png")).unwrap();
    let then = folder.when("render f2.png --format toml --turntable 4 -o f%d.png");
    then.is_refused(&["write over the input"]);
    assert!(folder.bytes("f2.png").starts_with(b"\nversion"));
}

/// Half around the balls, closer at the end.
const WAY: &str = "version = 1\npictures = 5\n\
    [[key]]\ntime = 0\neye = [0, 1, 5]\nlook_at = [0, 1, 0]\n\
    [[key]]\ntime = 2\neye = [5, 1, 0]\nlook_at = [0, 1, 0]\n\
    [[key]]\ntime = 4\neye = [0, 1, -4]\nlook_at = [0, 1, 0]\nfov = 20\n";

#[test]
fn pictures_along_a_way_have_the_bits_of_renders_with_the_cameras_of_its_keys() {
    let folder = folder();
    fs::write(folder.path("way.toml"), WAY).unwrap();
    let film = "render a.toml --path way.toml -o f-%02d.png --json";
    let told = folder.done(film).json();
    assert_eq!(told["pictures"], 5);
    for (number, view) in [(0, "--eye 0,1,5"), (2, "--eye 5,1,0"), (4, "--eye 0,1,-4 --fov 20")] {
        folder.done(&format!("render a.toml {view} --look-at 0,1,0 -o whole.png"));
        are_the_same(&folder, &format!("f-0{number}.png"), "whole.png");
    }
    fs::remove_file(folder.path("f-03.png")).unwrap();
    let told = folder.done(&format!("{film} --resume")).json();
    assert_eq!(told["skipped"], 4);
    // A bare model goes with it as well, into one file.
    folder.done("render p.obj --size 16x12 --samples 1 --path way.toml -o p.gif");
}

#[test]
fn what_is_wrong_with_a_way_is_told_at_its_place() {
    let folder = folder();
    let wrong = |text: &str, words: &[&str]| {
        fs::write(folder.path("way.toml"), text).unwrap();
        folder.when("render a.toml --path way.toml -o f-%d.png").is_refused(words);
    };
    wrong(&WAY.replace("time = 2", "time = 4"), &["way.toml:12:8", "must rise", "it is 4"]);
    wrong(&WAY.replace("time = 2", "tome = 2"), &["way.toml:8:1", "no `time`", "did you mean"]);
    wrong(
        &WAY.replace("eye = [5, 1, 0]", "eye = [0, 1, 0]"),
        &["way.toml:10:11", "where the eye is"],
    );
    wrong(&WAY.replace("fov = 20", "fov = 200"), &["way.toml:15:7", "fov"]);
    wrong(&WAY.replace("fov = 20", "height = 2"), &["way.toml:11:1", "orthographic camera"]);
    wrong(&WAY.replace("pictures = 5\n", ""), &["no `pictures`"]);
    wrong("version = 1\npictures = 2\n", &["no `key`"]);
    wrong("version = 1\npictures = 2\nkey = 3\n", &["way.toml:3:7", "[[key]]"]);
    wrong("version = 1\npictures = 2\nkey = [3]\n", &["[[key]]"]);
    wrong("version = 1\npictures = = 2\n", &["way.toml:2"]);
    folder
        .when("render a.toml --path no.toml -o f-%d.png")
        .is_refused(&["no.toml", "no such file"]);
    fs::write(folder.path("way.toml"), WAY).unwrap();
    folder.when("render a.toml --path way.toml -o way.toml").is_refused(&["way.toml"]);
    folder.when("render a.toml --path way.toml --turntable 3").is_refused(&["--turntable"]);
    folder.when("render a.toml --path way.toml -o f.jpg").is_refused(&["-o f-%04d.png"]);
    assert_eq!(fs::read_to_string(folder.path("way.toml")).unwrap(), WAY);
}
