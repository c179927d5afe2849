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

/// Counts every byte that is allocated.
#[global_allocator]
static HEAP: Cap<System> = Cap::new(System, usize::MAX);

/// Bytes that the program takes for itself, whatever it is to do: no limit is below.
const OWN: u64 = 16 << 20;

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
    let heap = usize::try_from(limit.saturating_add(OWN)).unwrap_or(usize::MAX);
    // An error would say that more is in use already, which is less than the program's own.
    let _ = HEAP.set_limit(heap);
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

/// Whether the command line set the limit.
pub(crate) fn is_said() -> bool {
    SAID.load(Ordering::Relaxed)
}
