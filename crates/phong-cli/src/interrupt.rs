//! What an interrupt (Ctrl-C, or SIGTERM) does: work that looks at [`Cancel`] stops within moments, and the
//! program ends by itself when it has kept what is done; other work is ended, and so is any by a
//! second interrupt. Either way nothing half-written stays.

use std::process::exit;
#[cfg(unix)]
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU8, Ordering};
#[cfg(unix)]
use std::thread;

use phong::render::Cancel;

use crate::failure::Failure;
use crate::{output, report};

/// Asked to stop by an interrupt.
static CANCEL: Cancel = Cancel::new();

/// Whether anything looks at it.
static HEEDED: AtomicBool = AtomicBool::new(false);

/// The number of the signal that asked; Ctrl-C before there was any.
static SIGNAL: AtomicU8 = AtomicU8::new(2);

/// Whatever happens from now on, an interrupt ends the program with 128 and the number of its signal,
/// and without a trace.
pub(crate) fn expect() {
    // A file over the size that the system allows is an error like any other, and no death.
    #[cfg(unix)]
    let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, Arc::default());
    // Without a handler an interrupt still ends the program, only less tidily.
    #[cfg(unix)]
    {
        use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
        use signal_hook::iterator::Signals;
        let heed = |mut signals: Signals| {
            thread::Builder::new().spawn(move || {
                signals.forever().for_each(|signal| interrupted(signal as u8));
            })
        };
        let _ = Signals::new([SIGINT, SIGTERM, SIGHUP]).and_then(heed);
    }
    #[cfg(not(unix))]
    let _ = ctrlc::set_handler(|| interrupted(2));
}

fn interrupted(signal: u8) {
    SIGNAL.store(signal, Ordering::Release);
    let again = CANCEL.is_cancelled();
    CANCEL.cancel();
    if HEEDED.load(Ordering::Acquire) && !again {
        // The program ends by itself, with every file removed where it was made.
        return;
    }
    output::remove_temporaries();
    let failure = failure();
    report::failure(&failure);
    exit(failure.code().into());
}

/// What work that was interrupted ends with.
pub(crate) fn failure() -> Failure {
    Failure::Interrupted(SIGNAL.load(Ordering::Acquire))
}

/// Runs work that stops when it is cancelled; an interrupt before it began counts as well.
pub(crate) fn heeding<T>(work: impl FnOnce(&Cancel) -> T) -> T {
    HEEDED.store(true, Ordering::Release);
    let done = work(&CANCEL);
    HEEDED.store(false, Ordering::Release);
    done
}
