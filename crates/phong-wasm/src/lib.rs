//! The studio's engine as a module of WebAssembly, for a worker of the studio's page.
//!
//! It is the engine behind the server of `phong studio`, and speaks the same protocol. The worker gives
//! it messages and files, and takes what it says through functions of its own: `hear` takes a reply,
//! `take` a frame of bytes, or none, and says whether to go on drawing, `failed` the last words of a panic.
#![cfg(target_arch = "wasm32")]

mod shelf;
mod studio;
mod worker;
