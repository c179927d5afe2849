//! What an interrupt (Ctrl-C) does: work that looks at [`Cancel`] stops at its next tile and the
//! program ends by itself; work that does not is ended. Either way nothing half-written stays.

use std::process::exit;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::sleep;
use std::time::Duration;

use phong::render::Cancel;

use crate::failure::Failure;
use crate::{output, report};

/// Asked to stop by an interrupt.
static CANCEL: Cancel = Cancel::new();

/// Whether anything looks at it.
static HEEDED: AtomicBool = AtomicBool::new(false);

/// How long a tile may take to notice.
const PATIENCE: Duration = Duration::from_secs(1);

/// Whatever happens from now on, an interrupt ends the program with 130 and without a trace.
pub(crate) fn expect() {
    // Without a handler an interrupt still ends the program, only less tidily.
    let _ = ctrlc::set_handler(|| {
        CANCEL.cancel();
        if HEEDED.load(Ordering::Acquire) {
            // The program ends by itself, with every file removed where it was made.
            sleep(PATIENCE);
        }
        output::remove_temporaries();
        report::failure(&Failure::Interrupted);
        exit(Failure::Interrupted.code().into());
    });
}

/// Runs work that stops when it is cancelled; an interrupt before it began counts as well.
pub(crate) fn heeding<T>(work: impl FnOnce(&Cancel) -> T) -> T {
    HEEDED.store(true, Ordering::Release);
    let done = work(&CANCEL);
    HEEDED.store(false, Ordering::Release);
    done
}
