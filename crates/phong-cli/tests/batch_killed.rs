//! Tasks of a batch that are killed, interrupted, or begun twice at once.
#![cfg(target_os = "linux")]
#![allow(clippy::unwrap_used, reason = "tests")]

mod support;

use std::fs;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use support::{BALLS, Given, Then, given};

/// A batch of one picture that takes a while.
fn slow() -> Given {
    let batch = "version = 1\ninputs = \"a.toml\"\noptions = \"--size 80x60 --samples 48\"\n";
    given(&[("a.toml", BALLS), ("b.toml", batch)])
}

fn task(folder: &Given) -> Child {
    let mut command = folder.command("batch b.toml --task 0 --threads 1");
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap()
}

/// Waits until the task has a checkpoint; false if it ended before.
fn has_begun(folder: &Given, child: &mut Child) -> bool {
    let begun = Instant::now();
    loop {
        let files = fs::read_dir(folder.path("b/by-content"));
        let mut names = files.into_iter().flatten().map(|e| e.unwrap().file_name());
        if names.any(|name| name.to_string_lossy().ends_with(".part")) {
            return true;
        }
        if child.try_wait().unwrap().is_some() {
            return false;
        }
        assert!(begun.elapsed() < Duration::from_mins(2), "it does not begin");
        sleep(Duration::from_millis(2));
    }
}

fn state(folder: &Given) -> serde_json::Value {
    folder.when("batch b.toml --status --json").json()["tasks"][0].clone()
}

fn signal(child: &Child, name: &str) {
    let kill = format!("kill -{name} {}", child.id());
    assert!(Command::new("sh").args(["-c", &kill]).status().unwrap().success());
}

/// The picture is that of an undivided render, and nothing but it is left.
fn is_right(folder: &Given) {
    folder.done("render a.toml --size 80x60 --samples 48 -o alone.png");
    assert_eq!(folder.bytes("b/a.png"), folder.bytes("alone.png"));
    // The temporary file of a process that was killed a moment ago is there until another one writes.
    let left = fs::read_dir(folder.path("b/by-content")).unwrap().map(|e| e.unwrap().file_name());
    let left = left.filter(|name| !name.to_string_lossy().starts_with(".phong-"));
    assert_eq!(left.count(), 1);
}

#[test]
fn a_task_that_is_killed_again_and_again_ends_in_the_right_picture() {
    let folder = slow();
    let mut kills = 0;
    for run in 0.. {
        let mut child = task(&folder);
        has_begun(&folder, &mut child);
        sleep(Duration::from_millis(20 << run));
        if child.try_wait().unwrap().is_some() {
            break;
        }
        assert_eq!(state(&folder)["state"], "running");
        child.kill().unwrap();
        child.wait().unwrap();
        kills += 1;
        let killed = state(&folder);
        assert_eq!((&killed["state"], &killed["starts"]), (&"killed".into(), &kills.into()));
    }
    assert!(kills > 0);
    is_right(&folder);
}

#[test]
fn an_interrupted_task_says_so_and_keeps_its_checkpoint() {
    for (name, code) in [("INT", 130), ("TERM", 143)] {
        let folder = slow();
        let mut child = task(&folder);
        assert!(has_begun(&folder, &mut child));
        signal(&child, name);
        let then = Then::of(child.wait_with_output().unwrap());
        assert_eq!((then.code, then.err.as_str()), (Some(code), ""));
        assert_eq!(state(&folder)["state"], "interrupted");
        folder.done("batch b.toml --run");
        let records = fs::read_dir(folder.path("b/.batch")).unwrap();
        let text = |e: fs::DirEntry| fs::read_to_string(e.path()).unwrap();
        assert!(records.map(|e| text(e.unwrap())).any(|text| text.contains("\"goes_on\":true")));
        is_right(&folder);
    }
}

#[test]
fn an_interrupted_run_interrupts_its_tasks() {
    let folder = slow();
    let mut command = folder.command("batch b.toml --run");
    let mut child = command.stdin(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    assert!(has_begun(&folder, &mut child));
    signal(&child, "TERM");
    let then = Then::of(child.wait_with_output().unwrap());
    assert_eq!((then.code, then.err.as_str()), (Some(143), ""));
    assert_eq!(state(&folder)["state"], "interrupted");
}

#[test]
fn of_two_of_the_same_task_one_works_and_the_other_waits() {
    let folder = slow();
    let mut first = task(&folder);
    assert!(has_begun(&folder, &mut first));
    let second = task(&folder);
    let second = Then::of(second.wait_with_output().unwrap());
    let first = Then::of(first.wait_with_output().unwrap());
    assert_eq!((first.code, second.code), (Some(0), Some(0)));
    assert!(second.err.contains("task 0 is being done on"), "{}", second.err);
    assert_eq!(state(&folder)["starts"], 1);
    is_right(&folder);
}

#[test]
fn whoever_waits_for_a_task_that_is_killed_does_it() {
    let folder = slow();
    let mut first = task(&folder);
    assert!(has_begun(&folder, &mut first));
    let second = task(&folder);
    sleep(Duration::from_millis(200));
    first.kill().unwrap();
    first.wait().unwrap();
    let second = Then::of(second.wait_with_output().unwrap());
    assert_eq!(second.code, Some(0), "{}", second.err);
    is_right(&folder);
}

#[test]
fn a_damaged_checkpoint_is_begun_anew() {
    let folder = slow();
    let mut child = task(&folder);
    assert!(has_begun(&folder, &mut child));
    child.kill().unwrap();
    child.wait().unwrap();
    let files = fs::read_dir(folder.path("b/by-content")).unwrap();
    for file in files.map(|file| file.unwrap().path()) {
        if file.extension().is_some_and(|ending| ending == "part") {
            fs::write(file, b"phong part 4\nrubbish\n\n").unwrap();
        }
    }
    folder.done("batch b.toml --task 0");
    is_right(&folder);
}

#[test]
fn a_checkpoint_of_a_picture_that_is_there_goes() {
    let folder = slow();
    folder.done("batch b.toml --task 0");
    let picture =
        fs::read_dir(folder.path("b/by-content")).unwrap().next().unwrap().unwrap().path();
    // A task that is killed when its picture has its name, and its checkpoint is not yet removed.
    let checkpoint = picture.with_extension("png.part");
    fs::write(&checkpoint, b"phong part 4\n").unwrap();
    folder.done("batch b.toml --task 0");
    assert!(!checkpoint.exists());
    is_right(&folder);
}

#[test]
fn a_scene_that_changes_while_it_is_drawn_gets_no_wrong_name() {
    let folder = slow();
    let mut child = task(&folder);
    assert!(has_begun(&folder, &mut child));
    fs::write(folder.path("a.toml"), BALLS.replace("radius = 1", "radius = 0.7")).unwrap();
    let then = Then::of(child.wait_with_output().unwrap());
    assert_eq!(then.code, Some(3), "{}", then.err);
    assert!(then.err.contains("changed while it was drawn"), "{}", then.err);
    folder.done("batch b.toml --task 0");
    is_right(&folder);
}
