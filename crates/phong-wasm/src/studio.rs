//! An engine, and what a worker asks of it.

use phong::render::Cancel;
use phong::scene::NamedLook;
use phong_studio::engine::{Bounds, Engine};
use wasm_bindgen::prelude::wasm_bindgen;

use crate::shelf::Shelf;
use crate::worker::{failed, say};

/// Bytes that a scene may take, and a picture as well. A module has 4 GiB for all it does, and a page
/// several modules.
const BYTES: u64 = 512 << 20;

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

    /// Says the first message of the protocol: what to open first, what else there is, and the name of a
    /// look to put on.
    pub fn hello(&self, open: &str, names: Vec<String>, look: Option<String>) {
        let look = look.and_then(|name| NamedLook::from_name(&name));
        say(self.engine.hello(open, names, look));
    }

    /// Gives it a file.
    pub fn put(&self, path: String, bytes: Vec<u8>) {
        self.shelf.put(path, bytes);
    }

    /// Files that were asked for and not there, since this was last asked.
    pub fn lacking(&self) -> Vec<String> {
        self.shelf.lacking()
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
