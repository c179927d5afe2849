//! The studio: an engine that a page talks to, and the server that carries their messages.
//!
//! The [`engine`] knows no network, no clock and no files but those of its
//! [`Source`](phong::scene::Source); it runs behind the server of `phong studio`, and as WebAssembly in
//! a worker of the same page. `PROTOCOL.md` says what is said between them.

pub mod engine;
pub mod folder;
pub mod page;
pub mod protocol;
#[cfg(feature = "server")]
pub mod server;
pub mod site;
