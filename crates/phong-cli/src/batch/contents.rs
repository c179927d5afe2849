//! What pictures are made of, as one number each: the name that a picture has by its content.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use phong::part::ARITHMETIC;
use phong_scene::{path_of, path_text};
use serde_json::{Value, json};
use sha2::{Digest, Sha256};

use super::names::is_file;
use super::{Picture, Tasks};
use crate::failure::Failure;
use crate::input;
use crate::output::Output;

/// Hexadecimal digits of a digest that stand in a name: two contents share them by chance once in
/// 10^14 pictures.
const DIGITS: usize = 24;

/// A file that was changed so lately may be changed again without a later time.
const SETTLED: Duration = Duration::from_secs(2);

/// What is known of the files that inputs are made of; kept beside the records, so that they are
/// read once.
#[derive(Debug)]
pub(crate) struct Contents {
    known: BTreeMap<String, Known>,
    file: PathBuf,
    changed: bool,
}

/// The files of one input, as they were read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Known {
    files: Vec<Seen>,
    /// The digest of what they hold.
    sum: String,
}

/// A file as it looked when it was read.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Seen {
    path: PathBuf,
    bytes: u64,
    /// When it was changed last, nanoseconds since 1970.
    changed: u64,
}

impl Seen {
    fn of(path: &Path) -> io::Result<Self> {
        let meta = fs::metadata(path)?;
        let changed = meta.modified()?.duration_since(SystemTime::UNIX_EPOCH).unwrap_or_default();
        let changed = u64::try_from(changed.as_nanos()).unwrap_or(u64::MAX);
        Ok(Self { path: path.to_owned(), bytes: meta.len(), changed })
    }

    fn is_settled(&self) -> bool {
        let now = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).unwrap_or_default();
        u128::from(self.changed) + SETTLED.as_nanos() < now.as_nanos()
    }
}

impl Known {
    /// Whether the files still look as they did.
    pub(crate) fn holds(&self) -> bool {
        self.files.iter().all(|seen| Seen::of(&seen.path).is_ok_and(|now| now == *seen))
    }

    /// Bytes that the files hold.
    pub(crate) fn bytes(&self) -> u64 {
        self.files.iter().map(|seen| seen.bytes).sum()
    }

    fn of_json(value: &Value) -> Option<Self> {
        let files = value["files"].as_array()?.iter().map(|file| {
            Some(Seen {
                path: path_of(file[0].as_str()?),
                bytes: file[1].as_u64()?,
                changed: file[2].as_u64()?,
            })
        });
        Some(Self { files: files.collect::<Option<_>>()?, sum: value["sum"].as_str()?.to_owned() })
    }

    fn json(&self) -> Value {
        let file =
            |seen: &Seen| json!([path_text(seen.path.as_os_str()), seen.bytes, seen.changed]);
        json!({ "files": self.files.iter().map(file).collect::<Vec<_>>(), "sum": self.sum })
    }
}

impl Contents {
    /// What an earlier run has left, as far as it still holds.
    pub(crate) fn of(tasks: &Tasks) -> Self {
        let file = tasks.records().join("contents.json");
        let text = fs::read(&file).unwrap_or_default();
        let kept: BTreeMap<String, Value> = serde_json::from_slice(&text).unwrap_or_default();
        let known = kept
            .into_iter()
            .filter_map(|(name, value)| Some((name, Known::of_json(&value).filter(Known::holds)?)));
        Self { known: known.collect(), file, changed: false }
    }

    /// The digest of a picture's content, and the files of its input.
    pub(crate) fn digest(
        &mut self,
        tasks: &Tasks,
        picture: &Picture,
    ) -> Result<(String, Known), Failure> {
        let known = self.files(tasks, picture)?;
        let ending = path_of(&picture.input).extension().unwrap_or_default().to_ascii_lowercase();
        let ending = ending.to_string_lossy();
        let mut text = format!("arithmetic {ARITHMETIC}\n{ending} files {}\n", known.sum);
        let mut changes: Vec<String> = picture
            .changes
            .iter()
            .filter(|change| !is_file(change))
            .map(|change| format!("set {} = {}\n", change.path(), change.value()))
            .collect();
        changes.sort();
        text.extend(changes);
        let (options, format) = (tasks.options.join(" "), tasks.format.extension());
        text.extend([format!(
            "options {options}
format {format}
"
        )]);
        let mut digest = hexadecimal(Sha256::digest(text.as_bytes()).as_slice());
        digest.truncate(DIGITS);
        Ok((digest, known))
    }

    /// The files of an input.
    fn files(&mut self, tasks: &Tasks, picture: &Picture) -> Result<Known, Failure> {
        let args = tasks.render_args(picture)?.input;
        let input = std::path::absolute(path_of(&args.input)).unwrap_or_default();
        let mut name = path_text(input.as_os_str());
        for change in picture.changes.iter().filter(|change| is_file(change)) {
            name.extend(["\n", change.path(), " = ", change.value()]);
        }
        if let Some(known) = self.known.get(&name) {
            return Ok(known.clone());
        }
        let (reading, files) = input::read(&args)?;
        if reading.scene.is_none() {
            return Err(tasks.at_fault(picture, reading.diagnostics));
        }
        let mut all = Sha256::new();
        let mut seen: Vec<Seen> = Vec::with_capacity(files.len());
        // In the order in which they were opened, which the text decides, and without their names:
        // the folder may be moved.
        for path in files {
            if seen.iter().all(|seen| seen.path != path) {
                let failed = |error| Failure::reading(&path, &error);
                seen.push(Seen::of(&path).map_err(failed)?);
                all.update(sum(&path).map_err(failed)?);
            }
        }
        let known = Known { files: seen, sum: hexadecimal(all.finalize().as_slice()) };
        self.known.insert(name, known.clone());
        self.changed = true;
        Ok(known)
    }

    /// Keeps what is known for the next run.
    pub(crate) fn save(&self) -> Result<(), Failure> {
        if !self.changed {
            return Ok(());
        }
        let settled = self.known.iter().filter(|(_, k)| k.files.iter().all(Seen::is_settled));
        let all: BTreeMap<&String, Value> = settled.map(|(name, k)| (name, k.json())).collect();
        let mut output = Output::create(&self.file)?;
        output.write(|out| serde_json::to_writer(out, &all).map_err(io::Error::from))?;
        Output::commit(vec![output])
    }
}

/// The digest of a file.
fn sum(path: &Path) -> io::Result<[u8; 32]> {
    let mut file = File::open(path)?;
    let mut buffer = vec![0; 1 << 18];
    let mut sum = Sha256::new();
    loop {
        match file.read(&mut buffer) {
            Ok(0) => return Ok(sum.finalize().into()),
            Ok(n) => sum.update(&buffer[..n]),
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |mut text, byte| {
        // Writing to a string does not fail.
        let _ = write!(text, "{byte:02x}");
        text
    })
}
