//! `phong render --watch`: the picture, drawn again at every change.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use phong_scene::path_of;

use super::render;
use crate::args::RenderArgs;
use crate::failure::Failure;
use crate::{input, report};

/// How often the files are looked at.
const INTERVAL: Duration = Duration::from_millis(150);

/// Draws, then draws again whenever a file that was read changes. Ends only by an interrupt, or by
/// what the command line is to blame for.
pub(crate) fn run(args: &RenderArgs) -> Result<(), Failure> {
    if args.input.input == "-" {
        return Err(Failure::usage("--watch: standard input does not change")
            .with_help("write the scene to a file"));
    }
    if args.output.as_deref() == Some(Path::new("-")) {
        return Err(Failure::usage("--watch: standard output takes one picture")
            .with_help("give a file to write, with -o"));
    }
    let mut first = true;
    loop {
        // Looked at before the scene is read: what changes while it is drawn is drawn next.
        let before = Seen::of(&[path_of(&args.input.input)]);
        let started = SystemTime::now();
        let files = match render::run(args) {
            Ok(files) => files,
            Err(failure @ Failure::Interrupted(_)) => return Err(failure),
            Err(failure)
                if first && !(matches!(failure, Failure::Input(_)) && before.is_there()) =>
            {
                return Err(failure);
            }
            Err(failure) => {
                report::failure(&failure);
                // The files of a scene with mistakes: reading it again is the way to know them.
                input::read(&args.input).map(|(_, files)| files).unwrap_or_default()
            }
        };
        first = false;
        let all: Vec<PathBuf> =
            before.files.iter().map(|(path, _)| path.clone()).chain(files).collect();
        let now = Seen::of(&all);
        // A time that is yet to come says nothing about when the file was written.
        let meanwhile = started..=SystemTime::now();
        let changed = |state: &Option<State>| state.is_some_and(|s| meanwhile.contains(&s.changed));
        let touched = now.files.iter().any(|(_, state)| changed(state));
        if !touched && before.is_within(&now) {
            now.until_it_differs();
        }
    }
}

/// What a file looked like: when it was changed last, and how long it was.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct State {
    changed: SystemTime,
    bytes: u64,
}

/// Files, and what each looked like; `None`: there was none.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Seen {
    files: Vec<(PathBuf, Option<State>)>,
}

impl Seen {
    fn of(files: &[PathBuf]) -> Self {
        let mut files = files.to_vec();
        files.sort();
        files.dedup();
        let state = |path: &PathBuf| {
            let meta = fs::metadata(path).ok()?;
            Some(State { changed: meta.modified().ok()?, bytes: meta.len() })
        };
        Self { files: files.iter().map(|path| (path.clone(), state(path))).collect() }
    }

    /// Whether there is such a file, for each of them.
    fn is_there(&self) -> bool {
        self.files.iter().all(|(_, state)| state.is_some())
    }

    /// Whether the other has all of these files, and they look the same there.
    fn is_within(&self, other: &Self) -> bool {
        self.files.iter().all(|file| other.files.contains(file))
    }

    /// Waits until a file looks different, and then until all look the same twice: an editor may
    /// write in several steps, or take a file away before it puts the new one in its place.
    fn until_it_differs(&self) {
        let paths: Vec<PathBuf> = self.files.iter().map(|(path, _)| path.clone()).collect();
        let mut last = self.clone();
        loop {
            std::thread::sleep(INTERVAL);
            let now = Self::of(&paths);
            if now != *self && now == last && now.is_there() {
                return;
            }
            last = now;
        }
    }
}
