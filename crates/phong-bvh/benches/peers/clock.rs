//! CPU time: what a loaded machine disturbs least.

use std::{ffi::c_int, hint::black_box};

#[repr(C)]
struct Timespec {
    seconds: i64,
    nanoseconds: i64,
}

unsafe extern "C" {
    fn clock_gettime(clock: c_int, time: *mut Timespec) -> c_int;
}

/// CPU seconds this thread takes for `work`, and its result.
pub(crate) fn thread<T>(work: impl FnOnce() -> T) -> (f64, T) {
    const CLOCK_THREAD_CPUTIME_ID: c_int = 3;
    time(CLOCK_THREAD_CPUTIME_ID, work)
}

/// CPU seconds the whole process takes for `work`, and its result.
pub(crate) fn process<T>(work: impl FnOnce() -> T) -> (f64, T) {
    const CLOCK_PROCESS_CPUTIME_ID: c_int = 2;
    time(CLOCK_PROCESS_CPUTIME_ID, work)
}

fn time<T>(clock: c_int, work: impl FnOnce() -> T) -> (f64, T) {
    let start = now(clock);
    let result = black_box(work());
    (now(clock) - start, result)
}

fn now(clock: c_int) -> f64 {
    let mut time = Timespec { seconds: 0, nanoseconds: 0 };
    // SAFETY: `time` is the C library's struct on 64-bit Linux, where this bench runs.
    unsafe { clock_gettime(clock, &raw mut time) };
    time.seconds as f64 + 1e-9 * time.nanoseconds as f64
}
