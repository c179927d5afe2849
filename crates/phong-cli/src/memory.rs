//! How much memory there is, and how much was used.

use std::fs;

use phong_bvh::{Bvh, Primitives};

/// The most bytes this process has held at once; `None` where the system does not say.
pub(crate) fn peak() -> Option<u64> {
    kilobytes("/proc/self/status", "VmHWM:")
}

/// Bytes of memory that there are at all: the machine's, or what this process is confined to.
pub(crate) fn total() -> Option<u64> {
    let confined = fs::read_to_string("/sys/fs/cgroup/memory.max").ok();
    let confined = confined.and_then(|text| text.trim().parse().ok());
    [kilobytes("/proc/meminfo", "MemTotal:"), confined].into_iter().flatten().min()
}

fn kilobytes(file: &str, key: &str) -> Option<u64> {
    let text = fs::read_to_string(file).ok()?;
    let rest = text.lines().find_map(|line| line.strip_prefix(key))?;
    rest.trim().trim_end_matches(" kB").parse::<u64>().ok().map(|kilobytes| kilobytes << 10)
}

/// Bytes that a hierarchy takes, its geometry included.
pub(crate) fn of_hierarchy(bvh: &Bvh) -> u64 {
    let bytes = |geometry: &Primitives| match geometry {
        Primitives::Triangles { positions, indices } => {
            size_of_val(&positions[..]) + size_of_val(&indices[..])
        }
        Primitives::Spheres(all) => size_of_val(&all[..]),
        Primitives::Plane(plane) => size_of_val(plane),
        Primitives::Solid(solid) => size_of_val(solid),
    };
    bvh.stats().bytes + bvh.geometry().iter().map(bytes).sum::<usize>() as u64
}

/// A number of bytes for people.
pub(crate) fn readable(bytes: u64) -> String {
    let units = ["bytes", "KiB", "MiB", "GiB", "TiB"];
    let mut value = bytes as f64;
    let mut unit = 0;
    while value >= 1024.0 && unit + 1 < units.len() {
        value /= 1024.0;
        unit += 1;
    }
    if unit == 0 { format!("{bytes} bytes") } else { format!("{value:.1} {}", units[unit]) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_read_well() {
        assert_eq!(readable(17), "17 bytes");
        assert_eq!(readable(1536), "1.5 KiB");
        assert_eq!(readable(3 << 40), "3.0 TiB");
    }
}
