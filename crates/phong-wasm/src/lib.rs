//! The studio's engine as a module of WebAssembly, for a worker of the studio's page.
//!
//! It is the engine behind the server of `phong studio`, and speaks the same protocol. The worker gives
//! it messages and files, and takes what it says through functions of its own: `hear` takes a reply,
//! `take` a frame of bytes and says whether to go on drawing, `failed` the last words of a panic.
#![cfg(target_arch = "wasm32")]

use std::io;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use phong::render::Cancel;
use phong::scene::{Blob, Memory, Source};
use phong_studio::engine::{Bounds, Engine};
use phong_studio::protocol::Message;
use wasm_bindgen::prelude::wasm_bindgen;

/// Bytes that a scene may take, and a picture as well. A module has 4 GiB for all it does, and a page
/// several modules.
const BYTES: u64 = 512 << 20;

#[wasm_bindgen]
extern "C" {
    fn hear(reply: &str);
    fn take(frame: &[u8]) -> bool;
    fn failed(why: &str);
}

/// An engine, and the files that it may read.
#[wasm_bindgen]
#[derive(Debug)]
pub struct Studio {
    engine: Engine,
    shelf: Shelf,
}

#[wasm_bindgen]
impl Studio {
    /// The engine that draws one of so many shares of each picture; they count from 0.
    #[wasm_bindgen(constructor)]
    pub fn new(index: u32, count: u32) -> Self {
        std::panic::set_hook(Box::new(|panic| failed(&panic.to_string())));
        let shelf = Shelf::default();
        let mut bounds = Bounds { bytes: BYTES, ..Bounds::default() };
        bounds.limits.bytes = BYTES;
        let engine = Engine::new(shelf.clone(), bounds).with_share(index, count);
        Self { engine, shelf }
    }

    /// Says the first message of the protocol: what to open first, and what else there is.
    pub fn hello(&self, open: &str, names: Vec<String>) {
        say(Engine::hello(open, names));
    }

    /// Gives it a file.
    pub fn put(&self, path: String, bytes: Vec<u8>) {
        let mut files = self.shelf.files();
        files.there = std::mem::take(&mut files.there).with(path, bytes);
    }

    /// Files that were asked for and not there, since this was last asked.
    pub fn lacking(&self) -> Vec<String> {
        std::mem::take(&mut self.shelf.files().lacking)
    }

    /// Does what a message asks for.
    pub fn receive(&mut self, request: &str) {
        self.engine.receive(request, &say);
    }

    /// Whether there is something to draw.
    pub fn has_work(&self) -> bool {
        self.engine.has_work()
    }

    /// Draws until `take` says to stop.
    pub fn advance(&mut self) {
        self.engine.advance(&Cancel::new(), &say);
    }

    /// Its share of the picture; `None` as long as that is not finished.
    pub fn part(&self) -> Option<Vec<u8>> {
        self.engine.part()
    }

    /// Takes the share of another engine.
    pub fn join(&mut self, part: &[u8]) {
        self.engine.join(part, &say);
    }
}

fn say(message: Message) -> bool {
    match message {
        Message::Text(text) => {
            hear(&text);
            true
        }
        Message::Frame(bytes) => take(&bytes),
    }
}

/// Files that the worker has fetched.
#[derive(Clone, Debug, Default)]
struct Shelf(Arc<Mutex<Files>>);

#[derive(Debug, Default)]
struct Files {
    there: Memory,
    lacking: Vec<String>,
}

impl Shelf {
    fn files(&self) -> MutexGuard<'_, Files> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Source for Shelf {
    fn open(&self, path: &str) -> io::Result<Box<dyn Blob>> {
        let mut files = self.files();
        let found = files.there.open(path);
        if found.is_err() {
            files.lacking.push(path.to_owned());
        }
        found
    }
}
