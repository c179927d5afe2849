//! The threads that work is done on: those asked for, or as many as the system grants.

use std::fs;
use std::sync::Mutex;
use std::thread::{self, JoinHandle};

use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};

use crate::report;

/// Bytes of stack of a thread: what a program's first thread usually has.
const STACK: usize = 8 << 20;

/// Bytes of addresses that a thread may take: its stack, and what its allocator sets aside.
const ADDRESSES: u64 = STACK as u64 + (64 << 20);

/// Most threads where the command line asks for none: making a hundred thousand takes minutes.
const MOST_UNASKED: usize = 1024;

/// Does work on so many threads; `None`: on one for each core. Where they cannot be made it is done
/// on fewer, in the end on this one alone, with a word about it unless `quiet`.
pub(crate) fn on<T: Send>(wanted: Option<u32>, quiet: bool, work: impl FnOnce() -> T + Send) -> T {
    let wanted = wanted.map_or_else(rayon_threads, |threads| threads as usize);
    let mut threads = wanted.min(room());
    while threads > 0 {
        if let Ok(pool) = pool(threads) {
            if threads < wanted {
                warn(quiet, wanted, &format!("{threads} of them"));
            }
            return pool.install(work);
        }
        threads /= 2;
    }
    warn(quiet, wanted, "one alone");
    // This thread is the pool, and no other is made.
    match ThreadPoolBuilder::new().num_threads(1).use_current_thread().build() {
        Ok(pool) => pool.install(work),
        Err(_) => work(),
    }
}

/// One for each core, or what the environment says.
fn rayon_threads() -> usize {
    let said = std::env::var("RAYON_NUM_THREADS").ok().and_then(|text| text.parse().ok());
    let cores = || thread::available_parallelism().map_or(1, usize::from);
    said.filter(|&threads| threads > 0).unwrap_or_else(cores).min(MOST_UNASKED)
}

/// A pool of so many threads. If one of them cannot be made the others have ended, and given back
/// what they took, before the error is known.
fn pool(threads: usize) -> Result<ThreadPool, ThreadPoolBuildError> {
    let made: Mutex<Vec<JoinHandle<()>>> = Mutex::new(Vec::new());
    let pool = ThreadPoolBuilder::new()
        .num_threads(threads)
        .spawn_handler(|worker| {
            let thread = thread::Builder::new().stack_size(STACK).spawn(|| worker.run())?;
            made.lock().map(|mut made| made.push(thread)).map_err(|_| std::io::ErrorKind::Other)?;
            Ok(())
        })
        .build();
    if pool.is_err() {
        for thread in made.into_inner().unwrap_or_default() {
            let _ = thread.join();
        }
    }
    pool
}

/// Threads that there are addresses for, half of them left to the work. A process that has used up
/// its addresses cannot even fail in order, so this is known before.
fn room() -> usize {
    let number = |file: &str, key: &str| -> Option<u64> {
        let text = fs::read_to_string(file).ok()?;
        let rest = text.lines().find_map(|line| line.strip_prefix(key))?;
        rest.split_ascii_whitespace().next()?.parse().ok()
    };
    // Where there is no limit the word is `unlimited`, which is no number.
    let Some(limit) = number("/proc/self/limits", "Max address space") else { return usize::MAX };
    let used = number("/proc/self/status", "VmSize:").unwrap_or(0) << 10;
    (limit.saturating_sub(used) / 2 / ADDRESSES) as usize
}

fn warn(quiet: bool, wanted: usize, on: &str) {
    if !quiet {
        report::say(&format!("warning: {wanted} threads cannot be made: working on {on}"));
    }
}
