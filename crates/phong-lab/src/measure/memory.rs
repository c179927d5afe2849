//! How much memory there is, and how much was used.
//!
//! Read from what Linux tells of a process; elsewhere nothing is known.

use std::fs;

/// The most bytes this process has held at once; `None` where the system does not say.
pub fn peak() -> Option<u64> {
    kilobytes("/proc/self/status", "VmHWM:")
}

/// Bytes of memory that there are at all: the machine's, or what this process is confined to. `None`
/// where the system does not say.
pub fn total() -> Option<u64> {
    let confined = fs::read_to_string("/sys/fs/cgroup/memory.max").ok();
    let confined = confined.and_then(|text| text.trim().parse().ok());
    [kilobytes("/proc/meminfo", "MemTotal:"), confined].into_iter().flatten().min()
}

fn kilobytes(file: &str, key: &str) -> Option<u64> {
    let text = fs::read_to_string(file).ok()?;
    let rest = text.lines().find_map(|line| line.strip_prefix(key))?;
    rest.trim().trim_end_matches(" kB").parse::<u64>().ok().map(|kilobytes| kilobytes << 10)
}
