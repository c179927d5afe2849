//! How fast files are read, checks included: bytes of the file over the clock's time, the best of some runs.
//!
//! `cargo run --release -p phong-scene --example reading -- [--sum] RUNS FILE…`. Of a scene that names its model the
//! bytes are the model's, as far as it lies beside. With `--sum` each file is read once, and told is a number
//! that stands for every bit of what was read and for all that was said.
#![allow(clippy::print_stdout, reason = "it is a program")]

use std::fmt::{self, Write};
use std::hash::{DefaultHasher, Hasher};
use std::path::Path;
use std::time::Instant;

use phong_scene::{Folder, Limits, Reading, read};

fn main() -> Result<(), String> {
    let mut arguments: Vec<String> = std::env::args().skip(1).collect();
    let sum = arguments.first().is_some_and(|first| first == "--sum");
    let usage = || "reading [--sum] RUNS FILE…".to_owned();
    if sum {
        arguments.remove(0);
    }
    let runs = arguments.first().and_then(|runs| runs.parse::<u32>().ok()).ok_or_else(usage)?;
    for path in &arguments[1..] {
        if sum {
            let reading = read(path, None, &Folder, &Limits::default());
            println!("{:016x} {path}", sum_of(&reading).map_err(|error| error.to_string())?);
            continue;
        }
        let mut best = f64::INFINITY;
        for _ in 0..runs {
            let start = Instant::now();
            let reading = read(path, None, &Folder, &Limits::default());
            best = best.min(start.elapsed().as_secs_f64());
            if reading.scene.is_none() {
                return Err(reading
                    .diagnostics
                    .first()
                    .map(ToString::to_string)
                    .unwrap_or_default());
            }
        }
        let bytes = size(path)?;
        println!("{path}: {best:.3} s, {:.0} MB/s", bytes as f64 / best / 1e6);
    }
    Ok(())
}

/// Bytes of a file, and of those that it names with `file = "…"`.
fn size(path: &str) -> Result<u64, String> {
    let of = |path: &Path| path.metadata().map(|data| data.len());
    let own = of(path.as_ref()).map_err(|error| format!("{path}: {error}"))?;
    if Path::new(path).extension().is_none_or(|ending| ending != "toml") {
        return Ok(own);
    }
    let text = std::fs::read_to_string(path).map_err(|error| format!("{path}: {error}"))?;
    let names = text.lines().filter_map(|line| line.strip_prefix("file = \"")?.strip_suffix('"'));
    Ok(own + names.filter_map(|name| of(&Path::new(path).with_file_name(name)).ok()).sum::<u64>())
}

/// What is written, made one number.
struct Sum(DefaultHasher);

impl Write for Sum {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0.write(text.as_bytes());
        Ok(())
    }
}

fn sum_of(reading: &Reading) -> Result<u64, fmt::Error> {
    let mut sum = Sum(DefaultHasher::new());
    if let Some(scene) = &reading.scene {
        write!(sum, "{scene:?}")?;
    }
    for diagnostic in &reading.diagnostics {
        writeln!(sum, "{diagnostic:?}")?;
    }
    Ok(sum.0.finish())
}
