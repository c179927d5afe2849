//! The studio: its address, who may come in, and how it ends.
#![cfg(feature = "studio")]
#![allow(clippy::unwrap_used, reason = "tests")]

mod support;

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};

use support::{BALLS, given};

/// A studio that runs, and its address.
struct Running {
    child: Child,
    url: String,
}

impl Running {
    fn start(words: &[&str]) -> Self {
        let mut child = Command::new(env!("CARGO_BIN_EXE_phong"))
            .arg("studio")
            .args(words)
            .arg("--no-open")
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let mut url = String::new();
        BufReader::new(child.stdout.as_mut().unwrap()).read_line(&mut url).unwrap();
        Self { child, url: url.trim_end().to_owned() }
    }

    fn get(&self, path: &str) -> String {
        let address = self.url.strip_prefix("http://").unwrap().split('/').next().unwrap();
        let mut stream = TcpStream::connect(address).unwrap();
        write!(stream, "GET {path} HTTP/1.1\r\nHost: {address}\r\nConnection: close\r\n\r\n")
            .unwrap();
        let mut answer = String::new();
        stream.read_to_string(&mut answer).unwrap();
        answer
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

#[test]
fn it_prints_one_line_that_opens_the_page_and_nothing_else_does() {
    let studio = Running::start(&[]);
    let (address, token) = studio.url.split_once("/?token=").unwrap();
    assert!(address.starts_with("http://127.0.0.1:") && token.len() == 32, "{}", studio.url);
    assert!(studio.get(&format!("/?token={token}")).starts_with("HTTP/1.1 200"));
    assert!(studio.get("/").starts_with("HTTP/1.1 403"));
    assert!(studio.get(&format!("/{token}/studio.js")).starts_with("HTTP/1.1 200"));
}

#[cfg(unix)]
#[test]
fn an_interrupt_ends_it_with_130() {
    let mut studio = Running::start(&[]);
    let id = studio.child.id().to_string();
    assert!(Command::new("kill").args(["-INT", &id]).status().unwrap().success());
    assert_eq!(studio.child.wait().unwrap().code(), Some(130));
}

#[test]
fn what_it_cannot_open_is_refused_before_it_answers() {
    let folder = given(&[("notes.txt", "")]);
    folder.when("studio nowhere.toml --no-open").is_refused(&["nowhere.toml"]);
    folder.when("studio notes.txt --no-open").is_refused(&["notes.txt", "scenes"]);
    folder.when("studio - --no-open").is_refused(&["file"]);
    folder.when("studio --look inc --no-open").is_refused(&["--look", "ink"]);
    folder.when("studio --port 0 --no-open").is_refused(&["--port"]);
}

/// A folder of scenes, and one of what is to be the renderer as WebAssembly.
fn given_scenes() -> support::Given {
    let folder = given(&[]);
    for name in ["scenes", "wasm"] {
        std::fs::create_dir(folder.path(name)).unwrap();
    }
    std::fs::write(folder.path("scenes/balls.toml"), BALLS).unwrap();
    std::fs::write(folder.path("scenes/notes.txt"), "not for others").unwrap();
    for name in phong_studio::site::MODULES {
        std::fs::write(folder.path("wasm").join(name), "a module").unwrap();
    }
    folder
}

#[test]
fn as_static_files_it_has_the_page_the_scenes_and_the_modules_and_nothing_else() {
    for input in ["scenes", "scenes/balls.toml"] {
        let folder = given_scenes();
        folder.done(&format!("studio {input} --static web --wasm wasm"));
        for name in ["index.html", "worker.js", "phong-simd_bg.wasm", "scenes/balls.toml"] {
            assert!(folder.path("web").join(name).is_file(), "{input}: {name}");
        }
        assert!(!folder.path("web/scenes/notes.txt").exists());
        // Over its own earlier files it writes again, here with a look to begin with.
        folder.done(&format!("studio {input} --static web --wasm wasm --look ink"));
        let list = std::fs::read_to_string(folder.path("web/files.json")).unwrap();
        assert!(list.contains("\"look\":\"ink\""), "{list}");
    }
}

#[test]
fn static_files_without_a_module_over_other_files_or_of_a_broken_scene_are_refused() {
    let folder = given_scenes();
    let refused = folder.when("studio scenes --static web");
    refused.is_refused(&["phong-simd.js", "bash .ci/wasm", "--wasm"]);
    folder.when("studio scenes --static scenes --wasm wasm").is_refused(&["something else"]);
    folder.when("studio scenes --static web --wasm wasm --port 80").is_refused(&["--port"]);
    folder.when("studio scenes --wasm wasm").is_refused(&["--static"]);
    std::fs::write(folder.path("scenes/broken.toml"), "version = 1\n[[sphere]]\n").unwrap();
    folder.when("studio scenes --static web --wasm wasm").is_refused(&["broken.toml", "radius"]);
    assert!(!folder.path("web").exists());
}
