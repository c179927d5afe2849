//! What an interrupt (Ctrl-C) does: work that looks at [`Cancel`] stops within moments, and the
//! program ends by itself when it has kept what is done; other work is ended, and so is any by a
//! second interrupt. Either way nothing half-written stays.

use std::process::exit;
#[cfg(unix)]
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use phong::render::Cancel;

use crate::failure::Failure;
use crate::{output, report};

/// Asked to stop by an interrupt.
static CANCEL: Cancel = Cancel::new();

/// Whether anything looks at it.
static HEEDED: AtomicBool = AtomicBool::new(false);

/// Whatever happens from now on, an interrupt ends the program with 130 and without a trace.
pub(crate) fn expect() {
    // A file over the size that the system allows is an error like any other, and no death.
    #[cfg(unix)]
    let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, Arc::default());
    // Without a handler an interrupt still ends the program, only less tidily.
    let _ = ctrlc::set_handler(|| {
        let again = CANCEL.is_cancelled();
        CANCEL.cancel();
        if HEEDED.load(Ordering::Acquire) && !again {
            // The program ends by itself, with every file removed where it was made.
            return;
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
