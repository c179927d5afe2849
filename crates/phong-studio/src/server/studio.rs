//! What all sessions share.

use std::net::SocketAddr;
use std::sync::Arc;

use phong::scene::NamedLook;
use tokio::sync::Semaphore;

use crate::engine::Bounds;
use crate::folder::Shelf;

/// What all sessions share.
#[derive(Debug)]
pub(super) struct Studio {
    pub(super) token: String,
    pub(super) address: SocketAddr,
    pub(super) shelf: Shelf,
    pub(super) bounds: Bounds,
    /// The look that is put on what is opened first.
    pub(super) look: Option<NamedLook>,
    /// How many more sessions there may be.
    pub(super) sessions: Arc<Semaphore>,
}
