//! What is written is whole or not there, and what was there before is never lost.
#![cfg(target_os = "linux")]
#![allow(clippy::unwrap_used, reason = "tests")]

mod support;

use std::fs;
use std::os::unix::fs::{MetadataExt, PermissionsExt, symlink};
use std::process::{Command, Stdio};

use support::{BALLS, Given, Then, given};

fn balls() -> Given {
    given(&[("a.toml", BALLS)])
}

/// `phong` with these words, under a limit or with an end that the shell sets.
fn in_shell(folder: &Given, before: &str, words: &str, after: &str) -> Then {
    let phong = env!("CARGO_BIN_EXE_phong");
    let mut shell = Command::new("sh");
    shell.current_dir(folder.path("")).stdin(Stdio::null());
    shell.args(["-c", &format!("{before} {phong} {words} {after}")]);
    Then::of(shell.output().unwrap())
}

#[test]
fn a_full_disk_is_the_systems_trouble() {
    let folder = balls();
    let then = folder.when("render a.toml -o /dev/full --output-format png");
    assert_eq!(then.code, Some(3), "{}", then.err);
    assert!(then.err.contains("cannot write /dev/full"), "{}", then.err);
    for words in ["--help", "render --help", "--version", "render a.toml -o -", "keys"] {
        let then = in_shell(&folder, "", words, "> /dev/full");
        assert_eq!(then.code, Some(3), "{words}: {}", then.err);
        assert!(then.err.contains("standard output"), "{words}: {}", then.err);
    }
}

#[test]
fn a_file_over_the_limit_of_sizes_is_the_systems_trouble_and_the_former_one_stays() {
    let folder = balls();
    fs::write(folder.path("a.exr"), b"former").unwrap();
    let then = in_shell(&folder, "ulimit -f 1;", "render a.toml -o a.exr", "");
    assert_eq!(then.code, Some(3), "{}", then.err);
    assert!(then.err.contains("a.exr"), "{}", then.err);
    assert_eq!(folder.bytes("a.exr"), b"former");
    assert_eq!(folder.names(), ["a.exr", "a.toml"]);
}

#[test]
fn threads_that_cannot_be_made_are_done_without() {
    let folder = balls();
    folder.done("render a.toml -o one.png --threads 1");
    // Thousands of stacks do not fit into so many KiB; into the last not even one.
    for addresses in [4_000_000, 1_000_000, 120_000] {
        let words = "render a.toml -o few.png --threads 4096";
        let then = in_shell(&folder, &format!("ulimit -v {addresses};"), words, "");
        assert_eq!(then.code, Some(0), "{}", then.err);
        assert!(then.err.contains("4096 threads cannot be made"), "{}", then.err);
        assert_eq!(folder.bytes("one.png"), folder.bytes("few.png"));
    }
}

#[test]
fn what_a_killed_process_leaves_is_removed_by_the_next() {
    let folder = balls();
    let words = "render a.toml --size 2000x2000 --samples 1024 -o a.png";
    let mut child = folder.command(words).stderr(Stdio::null()).spawn().unwrap();
    let left = || folder.names().iter().any(|name| name.starts_with(".phong-"));
    while !left() {
        assert!(child.try_wait().unwrap().is_none(), "it ended by itself");
        std::thread::yield_now();
    }
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(left());
    folder.done("render a.toml -o b.png");
    assert_eq!(folder.names(), ["a.toml", "b.png"]);
}

#[test]
fn a_replaced_picture_keeps_its_mode_and_a_new_one_has_that_of_any_file() {
    let folder = balls();
    fs::write(folder.path("a.png"), b"private").unwrap();
    fs::set_permissions(folder.path("a.png"), fs::Permissions::from_mode(0o600)).unwrap();
    folder.done("render a.toml --aov depth");
    fs::write(folder.path("any"), b"").unwrap();
    let mode = |name: &str| fs::metadata(folder.path(name)).unwrap().mode() & 0o7777;
    assert_eq!((mode("a.png"), mode("a.depth.png")), (0o600, mode("any")));
}

#[test]
fn a_link_to_what_is_not_there_is_written_through() {
    let folder = balls();
    fs::create_dir(folder.path("far")).unwrap();
    symlink("far/real.png", folder.path("link.png")).unwrap();
    folder.done("render a.toml -o link.png");
    assert!(folder.path("link.png").is_symlink());
    assert!(folder.bytes("far/real.png").starts_with(b"\x89PNG"));
    assert_eq!(folder.names(), ["a.toml", "far", "link.png"]);
}

#[test]
fn another_name_of_the_input_is_known_as_the_input() {
    let folder = balls();
    fs::hard_link(folder.path("a.toml"), folder.path("b.png")).unwrap();
    folder.when("render a.toml -o b.png").is_refused(&["over the input"]);
    assert_eq!(folder.bytes("b.png"), BALLS.as_bytes());
}

#[test]
fn a_name_that_no_file_can_have_is_known_before_the_input_is_read() {
    let folder = given(&[("broken.toml", "not a scene")]);
    let long = format!("render broken.toml -o {}.png", "x".repeat(300));
    folder.when(&long).is_refused(&["its name is too long"]);
    folder.when("render broken.toml -o a.png/ --output-format png").is_refused(&["no file"]);
    assert_eq!(folder.names(), ["broken.toml"]);
}

#[test]
fn a_layer_that_cannot_be_written_leaves_every_former_file() {
    let folder = balls();
    for name in ["a.png", "a.normal.png"] {
        fs::write(folder.path(name), b"former").unwrap();
    }
    let then = in_shell(&folder, "ulimit -f 8;", "render a.toml --aov normal --size 400x300", "");
    assert_eq!(then.code, Some(3), "{}", then.err);
    assert_eq!(folder.names(), ["a.normal.png", "a.png", "a.toml"]);
    assert!(folder.bytes("a.png") == b"former" && folder.bytes("a.normal.png") == b"former");
}

#[test]
fn a_pipe_that_nobody_reads_can_be_interrupted() {
    let folder = balls();
    let then = in_shell(
        &folder,
        "mkfifo a.png; timeout --preserve-status -k 60 -s INT 2",
        "render a.toml -o a.png",
        "",
    );
    assert_eq!(then.code, Some(130), "{}", then.err);
}
