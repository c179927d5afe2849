//! How much memory the program may take: what `--max-memory` says, else what the system has for it.
//!
//! Rooms that know how much they will need ask [`limit`] before, and say what is too large. What
//! nobody foresaw meets the same limit where memory is allocated, and ends the program with the same
//! exit codes, by the runtime's own words.

use std::alloc::System;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, LazyLock};

use cap::Cap;
use phong_lab::measure::memory::total;

use crate::failure::Failure;
use crate::report::readable;

/// Counts every byte that is allocated.
#[global_allocator]
static HEAP: Cap<System> = Cap::new(System, usize::MAX);

/// Bytes that the program takes for itself, whatever it is to do: no limit is below.
const OWN: u64 = 8 << 20;

/// The limit, in bytes; 0: not known yet.
static LIMIT: AtomicU64 = AtomicU64::new(0);

/// Whether the command line set it.
static SAID: LazyLock<Arc<AtomicBool>> = LazyLock::new(Arc::default);

/// Keeps all that follows within `said` bytes; `None`: within what there is.
pub(crate) fn keep_within(said: Option<u64>) {
    let limit = said.or_else(total).unwrap_or(u64::MAX);
    LIMIT.store(limit, Ordering::Relaxed);
    SAID.store(said.is_some(), Ordering::Relaxed);
    #[cfg(unix)]
    end_in_order();
    // An error would say that more is in use already, which is less than the program's own.
    let _ = bound(limit);
}

/// Leaves what is allocated from now on so many bytes less, which a film takes: it is memory from the
/// system, and not counted.
pub(crate) fn set_aside(bytes: u64) -> Result<(), Failure> {
    let limit = limit();
    bound(limit.saturating_sub(bytes)).map_err(|()| over(bytes + HEAP.allocated() as u64, limit))
}

/// Bounds what is allocated.
fn bound(bytes: u64) -> Result<(), ()> {
    HEAP.set_limit(usize::try_from(bytes.saturating_add(OWN)).unwrap_or(usize::MAX))
}

/// Where memory is not granted the runtime says so, and aborts: with our exit codes instead.
#[cfg(unix)]
fn end_in_order() {
    use signal_hook::consts::SIGABRT;
    use signal_hook::flag::register_conditional_shutdown as end;
    // The first whose flag is set is the last.
    let _ = end(SIGABRT, 2, Arc::clone(&SAID));
    let _ = end(SIGABRT, 3, Arc::new(AtomicBool::new(true)));
}

/// Bytes that the program may take; `u64::MAX`: no limit is known.
pub(crate) fn limit() -> u64 {
    match LIMIT.load(Ordering::Relaxed) {
        0 => u64::MAX,
        limit => limit,
    }
}

/// Says if so many bytes are more than the program may take.
pub(crate) fn want(bytes: u64) -> Result<(), Failure> {
    if bytes > limit() { Err(over(bytes, limit())) } else { Ok(()) }
}

/// More memory is needed than the limit allows.
pub(crate) fn over(needed: u64, limit: u64) -> Failure {
    let (needed, limit) = (readable(needed), readable(limit));
    let message = format!("this needs about {needed} of memory, over the limit of {limit}");
    Failure::usage(message).with_help(if SAID.load(Ordering::Relaxed) {
        "allow more with --max-memory, or render a smaller picture"
    } else {
        "there is no more in this machine; render a smaller picture, or a --crop of it"
    })
}
