//! How much memory there is, and how much was used.
//!
//! Read from what Linux tells of a process; elsewhere nothing is known.

use std::fs;

/// The most bytes this process has held at once; `None` where the system does not say.
pub fn peak() -> Option<u64> {
    kilobytes("/proc/self/status", "VmHWM:")
}

/// Bytes of memory that this process may hold: the machine's, or what it is confined to by the
/// control groups it is in (of either version) or by its own limits of addresses and data. `None`
/// where the system does not say.
pub fn total() -> Option<u64> {
    let groups = fs::read_to_string("/proc/self/cgroup").unwrap_or_default();
    let confined = group_files(&groups).into_iter().filter_map(|file| {
        // Without a limit it says `max`, or a number beyond any memory.
        fs::read_to_string(file).ok()?.trim().parse().ok()
    });
    let limits = fs::read_to_string("/proc/self/limits").unwrap_or_default();
    let held = kilobytes("/proc/self/status", "VmRSS:").unwrap_or(0);
    let left = [("Max address space", "VmSize:"), ("Max data size", "VmData:")].into_iter();
    let left = left.filter_map(|(limit, used)| {
        let used = kilobytes("/proc/self/status", used)?;
        Some(soft_limit(&limits, limit)?.saturating_sub(used).saturating_add(held))
    });
    kilobytes("/proc/meminfo", "MemTotal:").into_iter().chain(confined).chain(left).min()
}

/// The files that say how much memory the groups of `/proc/self/cgroup`, and those around them, may
/// take. Within a container the group may stand at the root.
fn group_files(groups: &str) -> Vec<String> {
    let mut files = Vec::new();
    for line in groups.lines() {
        let mut parts = line.splitn(3, ':').skip(1);
        let (Some(controllers), Some(path)) = (parts.next(), parts.next()) else { continue };
        let (roots, file): (&[&str], _) = match controllers {
            "" => (&["/sys/fs/cgroup", "/sys/fs/cgroup/unified"], "memory.max"),
            _ if controllers.split(',').any(|name| name == "memory") => {
                (&["/sys/fs/cgroup/memory"], "memory.limit_in_bytes")
            }
            _ => continue,
        };
        let mut path = path.trim_end_matches('/');
        loop {
            files.extend(roots.iter().map(|root| format!("{root}{path}/{file}")));
            let Some((around, _)) = path.rsplit_once('/') else { break };
            path = around;
        }
    }
    files
}

/// The soft limit of that name in `/proc/self/limits`; `None`: there is none.
fn soft_limit(limits: &str, name: &str) -> Option<u64> {
    let rest = limits.lines().find_map(|line| line.strip_prefix(name))?;
    rest.split_ascii_whitespace().next()?.parse().ok()
}

fn kilobytes(file: &str, key: &str) -> Option<u64> {
    let text = fs::read_to_string(file).ok()?;
    let rest = text.lines().find_map(|line| line.strip_prefix(key))?;
    rest.trim().trim_end_matches(" kB").parse::<u64>().ok().map(|kilobytes| kilobytes << 10)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_of_the_own_group_and_of_those_around_it_count_in_both_versions() {
        let text = "4:memory,hugetlb:/a/b\n3:cpuset:/\n0::/user.slice/run:1.scope\n";
        let files = group_files(text);
        for file in [
            "/sys/fs/cgroup/memory/a/b/memory.limit_in_bytes",
            "/sys/fs/cgroup/memory/a/memory.limit_in_bytes",
            "/sys/fs/cgroup/memory/memory.limit_in_bytes",
            "/sys/fs/cgroup/user.slice/run:1.scope/memory.max",
            "/sys/fs/cgroup/user.slice/memory.max",
            "/sys/fs/cgroup/memory.max",
            "/sys/fs/cgroup/unified/memory.max",
        ] {
            assert!(files.iter().any(|other| other == file), "{file} is not in {files:?}");
        }
        assert!(!files.iter().any(|file| file.contains("cpuset")));
        assert_eq!(group_files("nonsense\n1:\n"), [""; 0]);
    }

    #[test]
    fn a_limit_is_a_number_and_none_is_none() {
        let text = "Limit                     Soft Limit           Hard Limit           Units     \n\
                    Max data size             unlimited            unlimited            bytes     \n\
                    Max address space         1024000              unlimited            bytes     \n";
        assert_eq!(soft_limit(text, "Max address space"), Some(1_024_000));
        assert_eq!(soft_limit(text, "Max data size"), None);
    }
}
