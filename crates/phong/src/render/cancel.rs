//! Stopping a rendering from elsewhere.

use std::sync::atomic::{AtomicBool, Ordering};

/// A way to stop a rendering from another thread, or from within an event. It is looked at often
/// enough to be heeded within some milliseconds of work, however deep the glass.
#[derive(Debug, Default)]
pub struct Cancel(AtomicBool);

impl Cancel {
    /// Not cancelled.
    pub const fn new() -> Self {
        Self(AtomicBool::new(false))
    }

    /// Asks every rendering that looks at this to stop, for good.
    pub fn cancel(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether it was asked to stop.
    pub fn is_cancelled(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// The same for rooms that do not know this type: true once cancelled, and never false again.
    pub(crate) fn flag(&self) -> &AtomicBool {
        &self.0
    }
}
