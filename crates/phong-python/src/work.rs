//! Work done while the interpreter is free for others: on threads of its own, stopped by Ctrl-C.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use phong::render::Cancel;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::errors::{runtime_error, value_error};

/// How often the interpreter is asked whether a signal has come.
const ASKED: Duration = Duration::from_millis(20);
/// How long cancelled work is waited for. What does not look at its token goes on by itself, and
/// what comes of it is dropped.
const PATIENCE: Duration = Duration::from_millis(100);
/// Bytes of stack of a thread: what a program's first thread usually has.
const STACK: usize = 8 << 20;
/// The most threads that can be asked for.
const MOST_THREADS: u32 = 4096;

/// The pool of the last number of threads asked for, and the process it was made in: a forked
/// process has none of its parent's threads.
static POOL: Mutex<Option<(u32, usize, Arc<ThreadPool>)>> = Mutex::new(None);

/// How many threads work where nobody says.
fn default_threads() -> usize {
    let said = std::env::var("RAYON_NUM_THREADS").ok().and_then(|text| text.parse().ok());
    let cores = || thread::available_parallelism().map_or(1, usize::from);
    said.filter(|&threads| threads > 0).unwrap_or_else(cores).min(MOST_THREADS as usize)
}

/// How many threads `threads` asks for.
pub(crate) fn checked_threads(threads: Option<u32>) -> PyResult<usize> {
    match threads {
        None => Ok(default_threads()),
        Some(threads) if (1..=MOST_THREADS).contains(&threads) => Ok(threads as usize),
        Some(threads) => {
            Err(value_error(format!("threads = {threads}: it must be from 1 to {MOST_THREADS}")))
        }
    }
}

fn pool(threads: usize) -> Result<Arc<ThreadPool>, String> {
    let process = std::process::id();
    let mut kept = POOL.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((owner, size, pool)) = &*kept
        && (*owner, *size) == (process, threads)
    {
        return Ok(Arc::clone(pool));
    }
    let made = ThreadPoolBuilder::new().num_threads(threads).stack_size(STACK).build();
    let made =
        Arc::new(made.map_err(|error| format!("{threads} threads cannot be made: {error}"))?);
    let former = kept.replace((process, threads, Arc::clone(&made)));
    if let Some((owner, _, pool)) = former
        && owner != process
    {
        // Its threads are not there: nothing may wait for them.
        std::mem::forget(pool);
    }
    Ok(made)
}

/// Does work on so many threads, with the interpreter free for other threads meanwhile.
///
/// A signal (Ctrl-C) cancels it, and its exception is raised within a fifth of a second.
/// `meanwhile` is called every now and then by the thread that waits, and may raise as well.
pub(crate) fn run<T: Send + 'static>(
    py: Python<'_>,
    threads: usize,
    cancel: &Arc<Cancel>,
    work: impl FnOnce(&Cancel) -> T + Send + 'static,
    mut meanwhile: impl FnMut(Python<'_>) -> PyResult<()>,
) -> PyResult<T> {
    let pool = pool(threads).map_err(runtime_error)?;
    let (tell, told) = channel();
    let heeded = Arc::clone(cancel);
    let job = move || {
        let done = catch_unwind(AssertUnwindSafe(|| pool.install(|| work(&heeded))));
        // Nobody may be waiting any more.
        let _ = tell.send(done);
    };
    let thread = thread::Builder::new().name("phong".to_owned()).stack_size(STACK);
    thread.spawn(job).map_err(|error| runtime_error(format!("no thread can be made: {error}")))?;
    // Receivers are not shared between threads, and this one is only lent.
    let told = Mutex::new(told);
    let wait = |most: Duration| {
        let told = told.lock().unwrap_or_else(PoisonError::into_inner);
        told.recv_timeout(most)
    };
    let done = loop {
        match py.detach(|| wait(ASKED)) {
            Ok(done) => break done,
            Err(RecvTimeoutError::Disconnected) => {
                return Err(runtime_error("the work ended without a word: this is a bug in phong"));
            }
            Err(RecvTimeoutError::Timeout) => {}
        }
        if let Err(stop) = py.check_signals().and_then(|()| meanwhile(py)) {
            cancel.cancel();
            let until = Instant::now() + PATIENCE;
            // What comes of it is dropped, here or by its own thread.
            let _ = py.detach(|| wait(until.saturating_duration_since(Instant::now())));
            return Err(stop);
        }
    };
    done.map_err(|panic| {
        let text = panic.downcast_ref::<String>().map(String::as_str);
        let text = text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("no reason");
        runtime_error(format!("this is a bug in phong: {text}"))
    })
}

/// Work that nothing is told of meanwhile, and that only signals stop.
pub(crate) fn quietly<T: Send + 'static>(
    py: Python<'_>,
    threads: Option<u32>,
    work: impl FnOnce(&Cancel) -> T + Send + 'static,
) -> PyResult<T> {
    let threads = checked_threads(threads)?;
    run(py, threads, &Arc::new(Cancel::new()), work, |_| Ok(()))
}
