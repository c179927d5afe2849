//! Films that are killed or interrupted, and gone on with.
#![cfg(target_os = "linux")]
#![allow(clippy::unwrap_used, reason = "tests")]

mod support;

use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use support::{BALLS, Given, Then, given};

const FILM: &str = "render a.toml --size 16x12 --samples 2 --turntable 100 --resume";

fn begin(folder: &Given, words: &str) -> Child {
    let mut command = folder.command(words);
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap()
}

/// Waits until there is a file whose name ends so; false if the film ended before.
fn has_come_to(folder: &Given, child: &mut Child, ending: &str) -> bool {
    let begun = Instant::now();
    while !folder.names().iter().any(|name| name.ends_with(ending)) {
        if child.try_wait().unwrap().is_some() {
            return false;
        }
        assert!(begun.elapsed() < Duration::from_mins(2), "it does not begin");
        sleep(Duration::from_millis(2));
    }
    true
}

#[test]
fn a_hundred_pictures_that_were_killed_twice_are_those_of_a_run_in_one_go() {
    let (folder, whole) = (given(&[("a.toml", BALLS)]), given(&[("a.toml", BALLS)]));
    whole.done(&format!("{FILM} -o f-%04d.png"));
    for number in ["0020.png", "0055.png"] {
        let mut child = begin(&folder, &format!("{FILM} -o f-%04d.png"));
        has_come_to(&folder, &mut child, number);
        child.kill().unwrap();
        child.wait().unwrap();
    }
    let told = folder.done(&format!("{FILM} -o f-%04d.png --json")).json();
    assert!(told["skipped"].as_u64().unwrap() > 55, "{told}");
    assert_eq!(folder.names(), whole.names(), "nothing else is left");
    assert_eq!(folder.names().len(), 101);
    for number in 0..100 {
        let name = format!("f-{number:04}.png");
        assert!(folder.bytes(&name) == whole.bytes(&name), "{name}");
    }
}

#[test]
fn an_interrupted_film_leaves_whole_pictures_alone() {
    for (target, ending) in [("f-%04d.png", "0005.png"), ("a.gif", ".tmp")] {
        let folder = given(&[("a.toml", BALLS)]);
        let words = format!("{FILM} -o {target}").replace(" --resume", "");
        let mut child = begin(&folder, &words.replace("--samples 2", "--samples 64"));
        assert!(has_come_to(&folder, &mut child, ending), "{target}");
        let kill = format!("kill -INT {}", child.id());
        assert!(Command::new("sh").args(["-c", &kill]).status().unwrap().success());
        let then = Then::of(child.wait_with_output().unwrap());
        assert_eq!((then.code, then.err.as_str()), (Some(130), ""), "{target}");
        let names = folder.names();
        let is_png = |name: &str| name.rsplit_once('.').is_some_and(|(_, ending)| ending == "png");
        assert!(names.iter().all(|n| n == "a.toml" || is_png(n)), "{names:?}");
        for name in names.iter().filter(|name| is_png(name)) {
            assert!(folder.bytes(name).ends_with(b"IEND\xae\x42\x60\x82"), "{name}");
        }
    }
}
