//! Whose a temporary file is: its name tells the host, the process and when that began.

use std::fs;
use std::path::Path;
use std::sync::LazyLock;

/// How the names of temporary files begin.
const PREFIX: &str = ".phong-";

/// `.phong-HOST-PROCESS-START-` of this process.
pub(super) fn prefix() -> &'static str {
    static OWN: LazyLock<String> = LazyLock::new(|| {
        let process = std::process::id();
        format!("{PREFIX}{:08x}-{process}-{}-", *HOST, started(process).unwrap_or(0))
    });
    &OWN
}

/// Removes temporary files that processes of this host have left in a folder, and that no longer
/// run. Where the system does not tell which processes run, nothing is removed.
pub fn remove_abandoned(folder: &Path) {
    let (Ok(entries), Some(_)) = (fs::read_dir(folder), started(std::process::id())) else {
        return;
    };
    for entry in entries.flatten() {
        if entry.file_name().to_str().is_some_and(is_abandoned) {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Whether a file of this name is a dead process's.
fn is_abandoned(name: &str) -> bool {
    let owner = || {
        let mut words = name.strip_prefix(PREFIX)?.split('-');
        let host = u32::from_str_radix(words.next()?, 16).ok()?;
        let process: u32 = words.next()?.parse().ok()?;
        let start: u64 = words.next()?.parse().ok()?;
        words.next()?;
        (host == *HOST).then_some((process, start))
    };
    owner().is_some_and(|(process, start)| started(process) != Some(start))
}

/// A number of what the processes of one machine see of one another: two machines that share a
/// folder, or two containers, have different ones.
static HOST: LazyLock<u32> = LazyLock::new(|| {
    let read = |path: &str| fs::read(path).unwrap_or_default();
    let namespace = fs::read_link("/proc/self/ns/pid").unwrap_or_default();
    let mut sum = crc32fast::Hasher::new();
    for part in [
        &read("/proc/sys/kernel/hostname")[..],
        &read("/etc/machine-id"),
        namespace.as_os_str().as_encoded_bytes(),
    ] {
        sum.update(part);
        sum.update(&[0]);
    }
    sum.finalize()
});

/// When a process began, in ticks since the machine did; `None` if it does not run, or where the
/// system does not tell.
fn started(process: u32) -> Option<u64> {
    let stat = fs::read(format!("/proc/{process}/stat")).ok()?;
    // The name of the program stands in brackets, and may hold anything.
    let end = stat.iter().rposition(|&byte| byte == b')')?;
    let rest = String::from_utf8_lossy(&stat[end + 1..]).into_owned();
    let mut words = rest.split_ascii_whitespace();
    // A process that has ended and that nobody has asked about is still listed.
    let runs = !matches!(words.next()?, "Z" | "X" | "x");
    let start = words.nth(18)?.parse().ok()?;
    runs.then_some(start)
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_abandoned_where_its_process_is_dead_or_another_by_now() {
        let own = format!("{}abc123.tmp", prefix());
        assert!(!is_abandoned(&own));
        let process = std::process::id();
        let start = started(process).expect("it runs");
        let named = |host: u32, process: u32, start: u64| {
            format!("{PREFIX}{host:08x}-{process}-{start}-abc123.tmp")
        };
        assert_eq!(named(*HOST, process, start), own);
        assert!(is_abandoned(&named(*HOST, process, start + 1)), "its number was given again");
        assert!(is_abandoned(&named(*HOST, u32::MAX, 5)), "no process has this number");
        assert!(!is_abandoned(&named(HOST.wrapping_add(1), u32::MAX, 5)), "another host's");
        for other in [".phong-abc123.tmp", "phong.tmp", ".phong-x-1-1-a.tmp", ""] {
            assert!(!is_abandoned(other), "{other}");
        }
    }

    #[test]
    fn what_is_abandoned_is_removed_and_nothing_else() {
        let folder = tempfile::tempdir().expect("a folder");
        let dead = format!("{PREFIX}{:08x}-{}-7-abc123.tmp", *HOST, u32::MAX);
        let alive = format!("{}abc123.tmp", prefix());
        for name in [&dead, &alive, "picture.png"] {
            fs::write(folder.path().join(name), b"").expect("a file");
        }
        remove_abandoned(folder.path());
        let mut left: Vec<_> = fs::read_dir(folder.path())
            .expect("the folder")
            .map(|entry| entry.expect("an entry").file_name().into_string().expect("a name"))
            .collect();
        left.sort();
        assert_eq!(left, [alive.as_str(), "picture.png"]);
    }
}
