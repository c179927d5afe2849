//! What nobody may make the program do: take more memory than it may, read what it may not, or go on
//! for ever.
#![cfg(target_os = "linux")]
#![allow(clippy::unwrap_used, reason = "tests")]

mod support;

use std::fs;
use std::os::unix::fs::symlink;
use std::process::{Command, Stdio};

use support::{BALLS, Given, Then, given};

/// What `phong` says to these words if the shell sets limits or pipes before.
fn in_shell(folder: &Given, script: &str) -> Then {
    let mut shell = Command::new("sh");
    shell.current_dir(folder.path("")).stdin(Stdio::null()).env_remove("RUST_BACKTRACE");
    shell.env("phong", env!("CARGO_BIN_EXE_phong")).args(["-c", script]);
    Then::of(shell.output().unwrap())
}

/// The head of a PNG of this size, and hardly any pixels.
fn png(width: u32, height: u32) -> Vec<u8> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width, height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Sixteen);
    encoder.write_header().unwrap().write_chunk(png::chunk::IDAT, &[120, 156, 3, 0]).unwrap();
    file
}

#[test]
fn a_picture_whose_head_says_that_it_is_too_large_is_not_decoded() {
    let folder = given(&[("a.toml", BALLS)]);
    fs::write(folder.path("a.png"), png(10_000, 10_000)).unwrap();
    fs::write(folder.path("a.pfm"), "PF\n10000 10000\n-1.0\n").unwrap();
    for words in [
        "compare a.png a.png --max-memory 500M",
        "compare a.pfm a.pfm --max-memory 500M",
        "grade a.toml a.png --max-memory 500M",
        "grade a.toml a.pfm --max-memory 500M",
    ] {
        folder.when(words).is_refused(&["10000 × 10000", "memory", "limit"]);
    }
}

#[test]
fn a_pixel_that_a_whole_picture_exposes_takes_the_memory_of_that() {
    let folder = given(&[("a.toml", BALLS)]);
    let words = "explain a.toml 20 15 --samples 1 --size 20000x20000 --max-memory 1G";
    folder.done(words);
    folder.when(&format!("{words} --exposure auto")).is_refused(&["memory", "limit"]);
}

#[test]
fn a_part_whose_head_says_that_it_is_too_large_is_not_read() {
    let folder = given(&[("a.toml", BALLS)]);
    folder.done("render a.toml --tile 0/2 --crop 0,0,40,1 --size 40000x30000 -o a.part");
    let part = folder.bytes("a.part");
    let end = part.windows(6).position(|w| w == b"check ").unwrap();
    let text = String::from_utf8(part[..end].to_vec()).unwrap();
    let text = text.replace("crop 0,0,40,1", "crop 0,0,40000,30000");
    let sum = crc32(text.as_bytes());
    fs::write(folder.path("b.part"), format!("{text}check {sum:08x}\n\n")).unwrap();
    folder.when("merge b.part -o b.png --max-memory 1G").is_refused(&[
        "b.part",
        "the picture takes",
        "limit",
    ]);
}

fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |sum, &byte| {
        (0..8).fold(sum ^ u32::from(byte), |sum, _| {
            (sum >> 1) ^ (0xedb8_8320 & (sum & 1).wrapping_neg())
        })
    })
}

#[test]
fn more_memory_than_the_system_grants_is_told_and_no_abort() {
    let sphere = |i| format!("[[sphere]]\ncenter = [{i}, 0, 0]\nradius = 1\n");
    let spheres = (0..40_000).map(sphere).collect::<Vec<_>>().concat();
    let folder = given(&[("a.toml", &format!("{BALLS}{spheres}"))]);
    let limited = in_shell(&folder, "exec $phong check a.toml --max-memory 30M");
    assert_eq!(limited.code, Some(2), "{}", limited.err);
    assert!(limited.err.contains("memory"), "{}", limited.err);
    let granted = in_shell(&folder, "ulimit -d 60000; exec $phong check a.toml");
    assert_eq!(granted.code, Some(3), "{}", granted.err);
    assert!(granted.err.contains("memory"), "{}", granted.err);
}

#[test]
fn every_command_knows_the_bound_of_memory() {
    let folder = given(&[("a.toml", BALLS)]);
    folder.done("render a.toml --max-memory 64M");
    folder.done("--max-memory 64M grade a.toml a.png");
    folder.done("compare a.png a.png --max-memory 64M");
    folder.done("render a.toml --tile 0/1 -o a.part");
    folder.done("merge a.part -o b.png --max-memory 64M");
    assert_eq!(folder.bytes("a.png"), folder.bytes("b.png"));
}

#[test]
fn a_pipe_is_read_once_and_only_as_the_input() {
    let mesh = format!("{BALLS}[[mesh]]\nfile = \"pipe.obj\"\n");
    let folder = given(&[("a.toml", BALLS), ("mesh.toml", &mesh)]);
    let then = in_shell(
        &folder,
        "mkfifo in.toml pipe.obj; cat a.toml > in.toml & exec $phong check in.toml",
    );
    assert_eq!(then.code, Some(0), "{}", then.err);
    // Nobody writes to that one.
    folder.when("check mesh.toml").is_refused(&["pipe.obj", "a pipe or a device"]);
    in_shell(&folder, "mkfifo a.png.part");
    folder.when("render a.toml --resume").is_refused(&["a.png.part", "it is no file"]);
    for device in ["zero", "random", "full"] {
        let text = mesh.replace("pipe.obj", &format!("/dev/{device}"));
        fs::write(folder.path("device.toml"), text.replace("[[mesh]]", "[[include]]")).unwrap();
        folder.when("check device.toml").is_refused(&["a pipe or a device"]);
    }
    folder.when("check /dev/zero --format toml").is_refused(&["a pipe or a device"]);
    folder.when("compare /dev/zero /dev/zero").is_refused(&["this is no PNG"]);
    folder.when("merge /dev/zero -o a.png").is_refused(&["no part file"]);
    let endless =
        in_shell(&folder, "cat /dev/zero | exec $phong check - --format obj --max-memory 9M");
    endless.is_refused(&["more than 9437184 bytes"]);
}

#[test]
fn in_a_jail_nothing_outside_the_folder_is_read_by_any_name() {
    let folder =
        given(&[("secret.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), ("out.toml", BALLS)]);
    let jail = folder.path("jail");
    fs::create_dir_all(jail.join("deep")).unwrap();
    fs::copy(folder.path("secret.obj"), jail.join("deep/own.obj")).unwrap();
    symlink("../secret.obj", jail.join("link.obj")).unwrap();
    symlink("deep/own.obj", jail.join("inner.obj")).unwrap();
    symlink("..", jail.join("up")).unwrap();
    let secret = folder.path("secret.obj").to_str().unwrap().to_owned();
    for outside in ["../secret.obj", "link.obj", "up/secret.obj", "../nothing.obj", &secret] {
        let text = format!("{BALLS}[[mesh]]\nfile = \"{outside}\"\n");
        fs::write(jail.join("a.toml"), text).unwrap();
        for command in ["check", "info", "render", "explain --html a.html", "grade", "compare"] {
            let more = match command {
                "grade" => "a.png",
                "compare" => "--model phong:3",
                _ => "",
            };
            let then = folder.when(&format!("--jail jail {command} jail/a.toml {more}"));
            then.is_refused(&["it lies outside"]);
        }
    }
    let text = format!(
        "{BALLS}[[mesh]]\nfile = \"inner.obj\"\n[[mesh]]\nfile = \"deep/../deep/own.obj\"\n"
    );
    fs::write(jail.join("a.toml"), text).unwrap();
    folder.done("render jail/a.toml --jail jail -o a.png");
    folder.done("grade jail/a.toml a.png");
    folder.when("grade jail/a.toml a.png --jail jail").is_refused(&["a.png", "it lies outside"]);
    folder.when("check out.toml --jail jail").is_refused(&["it lies outside"]);
    folder.when("check out.toml --jail nowhere").is_refused(&["--jail nowhere", "no such file"]);
    assert!(!folder.names().contains(&"a.html".to_owned()));
}

#[test]
fn a_picture_of_numbers_beyond_what_can_be_held_comes_with_a_word() {
    let bright = BALLS.replace("kind = \"point\"", "kind = \"point\"\ncolor = [1e18, 1e18, 1e18]");
    let bright = bright
        .replace("reflection = 0.5", "reflection = 0.5\nk_d = 1e18\ncolor = [1e18, 1e18, 1e18]");
    let folder = given(&[("a.toml", &bright)]);
    let then = folder.when("render a.toml --json");
    if then.code == Some(0) {
        assert!(then.err.contains("infinite or NaN"), "{}", then.err);
        assert!(then.json()["warnings"].to_string().contains("infinite or NaN"));
        folder.done("render a.toml --tile 0/1 -o a.part");
        assert!(folder.done("merge a.part -o b.png").err.contains("infinite or NaN"));
    } else {
        then.is_refused(&["a.toml"]);
    }
}

/// A text of many lines, one for each number.
fn lines(n: u32, line: impl Fn(u32) -> String) -> String {
    (0..n).map(line).collect()
}

/// Each of these would take minutes if the time grew by the square.
#[test]
fn no_kind_of_input_takes_time_by_the_square_of_its_size() {
    const N: u32 = 40_000;
    let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    let comb = lines(N, |i| format!("v {} {} 0\n", i, 10 * (i % 2)));
    let corners = lines(N + 2, |i| format!(" {}", i + 1));
    let inputs = [
        ("comb.obj", format!("{comb}v {N} -1 0\nv 0 -1 0\nf{corners}\n"), 0),
        ("line.obj", format!("{}f{corners}\n", lines(N + 2, |i| format!("v {i} 0 0\n"))), 0),
        ("points.obj", lines(N, |_| "v 1 2 3\n".to_owned()), 0),
        (
            "materials.obj",
            format!("mtllib a.mtl\n{triangle}{}", lines(N, |i| format!("usemtl {i}\nf 1 2 3\n"))),
            0,
        ),
        ("a.mtl", lines(N, |i| format!("newmtl {i}\nnewmtl twice\n")), 2),
        (
            "libraries.obj",
            format!("mtllib{}\n{triangle}f 1 2 3\n", lines(N, |i| format!(" {i}.mtl"))),
            0,
        ),
        (
            "cycle.toml",
            BALLS.to_owned()
                + &lines(N, |i| format!("[[groups.{i}.instance]]\ngroup = \"{}\"\n", (i + 1) % N)),
            2,
        ),
        (
            "names.toml",
            BALLS.to_owned() + &lines(N, |i| format!("[[plane]]\nmaterial = \"{i}\"\n")),
            2,
        ),
    ];
    let folder = given(&[]);
    for (name, text, _) in &inputs {
        fs::write(folder.path(name), text).unwrap();
    }
    for (name, _, code) in inputs {
        let then = folder.when(&format!("check {name}"));
        assert_eq!(then.code, Some(code), "{name}: {}", then.err);
        assert!(then.err.len() < 64 << 10, "{name}: {}", then.err.len());
    }
}
