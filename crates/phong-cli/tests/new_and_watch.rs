//! A first scene, and its picture drawn again at every change.
#![allow(clippy::unwrap_used, reason = "tests")]

mod support;

use std::fs;
use std::process::Stdio;
use std::time::{Duration, Instant};

use support::{BALLS, given};

#[test]
fn a_new_scene_can_be_drawn_and_is_never_written_over_a_file() {
    let folder = given(&[("taken.toml", "mine")]);
    folder.done("new");
    folder.done("new ball");
    assert_eq!(folder.bytes("scene.toml"), folder.bytes("ball.toml"));
    let then = folder.done("render ball.toml --size 32x18 --samples 1");
    assert_eq!(then.err, "");
    folder.when("new ball").is_refused(&["ball.toml exists", "another name"]);
    folder.when("new taken.toml").is_refused(&["taken.toml exists"]);
    folder.when("new no/ball").is_refused(&["there is no folder"]);
    assert_eq!(folder.bytes("taken.toml"), b"mine");
}

#[test]
fn what_cannot_be_watched_is_refused() {
    let folder = given(&[("a.toml", BALLS)]);
    folder.when("render - --format toml --watch").is_refused(&["--watch", "standard input"]);
    folder.when("render a.toml -o - --watch").is_refused(&["--watch", "standard output"]);
    folder.when("render a.toml --watch --resume").is_refused(&["--watch", "--resume"]);
    folder.when("render none.toml --watch").is_refused(&["none.toml"]);
}

#[test]
fn a_watched_scene_is_drawn_again_when_it_or_a_file_it_names_changes() {
    let scene = format!("{BALLS}\n[[mesh]]\nfile = \"k.obj\"\n");
    let mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let folder = given(&[("a.toml", &scene), ("k.obj", mesh)]);
    let mut child = folder
        .command("render a.toml --watch --quiet")
        .stdin(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let mut last = Vec::new();
    let mut changes = || {
        let started = Instant::now();
        while started.elapsed() < Duration::from_mins(2) {
            let now = fs::read(folder.path("a.png")).unwrap_or_default();
            if !now.is_empty() && now != last {
                last = now;
                return true;
            }
            std::thread::sleep(Duration::from_millis(20));
        }
        false
    };
    let mut seen = vec![changes()];
    // A file system may count in whole milliseconds, so each file gets a length of its own.
    fs::write(folder.path("k.obj"), mesh.replace("v 1 0 0", "v 2.5 0 0.25")).unwrap();
    seen.push(changes());
    fs::write(folder.path("a.toml"), "version = 1\n").unwrap();
    std::thread::sleep(Duration::from_millis(700));
    fs::write(folder.path("a.toml"), scene.replace("radius = 1", "radius = 0.5")).unwrap();
    seen.push(changes());
    child.kill().unwrap();
    child.wait().unwrap();
    assert_eq!(seen, [true; 3]);
}
