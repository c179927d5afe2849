//! Every file of these tests, damaged at random: it is read to a sound scene or to errors, in bounded time.
//!
//! A few hundred damaged files are read each time, from one seed. `PHONG_FUZZ_SECONDS=600` goes on for so
//! long, and `PHONG_FUZZ_SEED=7` begins elsewhere.

use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::time::{Duration, Instant};

use phong_scene::{Diagnostic, Limits, Memory, read};

/// The folders whose files are damaged.
const FOLDERS: [&str; 10] =
    ["atoms", "gltf", "mtl", "nff", "obj", "off", "ply", "stl", "tachyon", "trajectories"];

/// Damaged files that are read in any case.
const LEAST: u64 = 300;

/// Longer than any of these small files may take, on a busy machine too.
const PATIENCE: Duration = Duration::from_secs(20);

/// What is written over, or between, other things.
const WORDS: [&[u8]; 16] = [
    b"nan",
    b"-1",
    b"0",
    b"1e39",
    b"inf",
    b"4294967295",
    b"18446744073709551616",
    b"99999999999999999999999",
    b"\n",
    b" ",
    b"\r\n",
    b"\"",
    b"\0\0\0\0",
    b"\xff\xff\xff\xff",
    b"\xff\xff\xff\x7f",
    b"\xc3",
];

/// Numbers that look random and are the same every time (xorshift).
struct Random(u64);

impl Random {
    fn below(&mut self, end: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % end.max(1) as u64) as usize
    }

    /// Two places, in order.
    fn range(&mut self, end: usize) -> (usize, usize) {
        let (a, b) = (self.below(end + 1), self.below(end + 1));
        // Mostly a short piece.
        let b = if self.below(3) > 0 { (a + self.below(40)).min(end) } else { b };
        (a.min(b), a.max(b))
    }
}

/// Damages a file in one to four ways.
fn damage(bytes: &mut Vec<u8>, random: &mut Random) {
    for _ in 0..=random.below(4) {
        let (a, b) = random.range(bytes.len());
        match random.below(7) {
            0 => bytes.truncate(a),
            1 => drop(bytes.drain(a..b)),
            2 => {
                let piece = bytes[a..b].to_vec();
                let times = 1 + random.below(30);
                bytes.splice(b..b, piece.repeat(times));
            }
            3 => {
                let word = WORDS[random.below(WORDS.len())];
                let end = (a + word.len()).min(bytes.len());
                bytes.splice(a..end, word.iter().copied());
            }
            4 => {
                let word = WORDS[random.below(WORDS.len())];
                bytes.splice(a..a, word.iter().copied());
            }
            5 => {
                let piece = bytes[a..b].to_vec();
                let to = random.below(bytes.len() + 1);
                bytes.splice(to..to, piece);
            }
            _ => {
                if let Some(byte) = bytes.get_mut(a) {
                    *byte ^= 1 << random.below(8);
                }
            }
        }
    }
}

/// What every reading must hold.
fn check(name: &str, source: &Memory) {
    for lenient in [false, true] {
        let limits = Limits { bytes: 64 << 20, lenient, ..Limits::default() };
        let begin = Instant::now();
        let reading = read(name, None, source, &limits);
        assert!(begin.elapsed() < PATIENCE, "it takes {:?}", begin.elapsed());
        let error = reading.diagnostics.iter().any(Diagnostic::is_error);
        assert_eq!(reading.scene.is_none(), error, "{:?}", reading.diagnostics);
        for span in reading.diagnostics.iter().filter_map(|d| d.span.as_ref()) {
            // Panics unless it is within the excerpt and on the borders of characters.
            let _ = &span.excerpt[span.range.clone()];
        }
        if let Some(scene) = reading.scene {
            assert!(!scene.check().iter().any(Diagnostic::is_error), "it is checked already");
            assert!(scene.objects.iter().all(|object| object.transform.is_finite()));
        }
    }
}

#[test]
fn damaged_files_are_read_to_a_sound_scene_or_to_errors() {
    let number = |name: &str| std::env::var(name).ok().and_then(|text| text.parse::<u64>().ok());
    let seed = number("PHONG_FUZZ_SEED").unwrap_or(1);
    let time = Duration::from_secs(number("PHONG_FUZZ_SECONDS").unwrap_or(0));
    let mut files: Vec<(String, Vec<u8>)> = Vec::new();
    let mut all = Memory::new();
    for folder in FOLDERS {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests").join(folder);
        for entry in fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("a file").path();
            let name = path.file_name().expect("a name").to_string_lossy().into_owned();
            if path.extension().is_none_or(|ending| ending != "txt") && path.is_file() {
                let bytes = fs::read(&path).expect("a file");
                all = all.with(name.as_str(), bytes.clone());
                files.push((name, bytes));
            }
        }
    }
    files.sort();
    let begin = Instant::now();
    let mut round = 0;
    while round < LEAST || begin.elapsed() < time {
        let mut random = Random((seed << 32 | round).wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1);
        let (name, bytes) = &files[random.below(files.len())];
        let mut bytes = bytes.clone();
        damage(&mut bytes, &mut random);
        let source = all.clone().with(name.as_str(), bytes.clone());
        // Materials and trajectories are read by the file that names them.
        let mut name = name.clone();
        let ending = Path::new(&name).extension().and_then(|ending| ending.to_str());
        let by = match ending {
            Some("mtl") => {
                let model = format!("mtllib {name}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
                Some(("model.obj", model))
            }
            Some("dcd" | "xtc") => {
                let camera = "version = 1\n[camera]\neye = [0, 0, 50]\nlook_at = [5, 5, 5]";
                let molecule = format!("file = \"waters.xyz\"\ntrajectory = \"{name}\"");
                Some(("model.toml", format!("{camera}\n[[molecule]]\n{molecule}\n")))
            }
            _ => None,
        };
        let source = match by {
            Some((by, text)) => {
                name = by.to_owned();
                source.with(by, text.into_bytes())
            }
            None => source,
        };
        if let Err(panic) = catch_unwind(AssertUnwindSafe(|| check(&name, &source))) {
            let kept = std::env::temp_dir().join(format!("damaged-{seed}-{round}-{name}"));
            fs::write(&kept, &bytes).expect("a file that is kept");
            eprintln!("seed {seed}, round {round}: {}", kept.display());
            std::panic::resume_unwind(panic);
        }
        round += 1;
    }
    eprintln!("{round} damaged files of seed {seed}");
}
