//! The frames of the trajectories that a scene or a model is of.

use std::io;
use std::sync::{Arc, Mutex, PoisonError};

use phong::scene::{
    Blob, Change, Format, FrameRange, Frames, Limits, Reading, Scene, Source, read_changed,
};

/// How many bytes of a text file are looked through for frames, and how many frames are found of a file. It is done
/// before the first picture, so it must not take long.
const MOST: (u64, u64) = (256 << 20, 100_000);

/// Which frame is shown, of how many.
#[derive(Clone, Debug)]
pub(super) struct Frame {
    /// Its number, from 0.
    pub(super) number: u64,
    /// How many there are; 1 where nothing has several.
    pub(super) count: u64,
    /// The files that were counted.
    files: Vec<String>,
    /// The first frame of a bare model, as which the others are seen; `None`: it was not read, or is the only one.
    first: Option<Arc<Scene>>,
}

impl Default for Frame {
    fn default() -> Self {
        Self { number: 0, count: 1, files: Vec::new(), first: None }
    }
}

impl Frame {
    /// Reads what is at a path with this frame of its trajectories, and counts their frames where they are others than
    /// before.
    pub(super) fn read(
        &mut self,
        path: &str,
        source: &dyn Source,
        limits: &Limits,
        changes: &[Change],
    ) -> Reading {
        let recorder = Recorder { source, named: Mutex::default() };
        let reading = self.reading(path, &recorder, limits, changes);
        let files = recorder.named.into_inner().unwrap_or_else(PoisonError::into_inner);
        if let (Some(scene), true) = (&reading.scene, files != self.files) {
            self.count = count(&files, source, limits);
            self.files = files;
            if self.number >= self.count {
                self.number = 0;
            }
            let is_first = reading.bare && self.number == 0 && self.count > 1;
            self.first = is_first.then(|| Arc::new(scene.clone()));
        }
        reading
    }

    /// The same, where the frames are known.
    pub(super) fn reading(
        &self,
        path: &str,
        source: &dyn Source,
        limits: &Limits,
        changes: &[Change],
    ) -> Reading {
        let Some(range) = self.range() else {
            return read_changed(path, None, source, limits, changes);
        };
        let frames = Frames::new(source, limits, range);
        let mut reading = frames.read(self.number, path, None, changes);
        if let (Some(scene), Some(first)) = (&mut reading.scene, &self.first) {
            scene.follow(first, true);
        }
        reading
    }

    /// Another frame of the same.
    pub(super) fn other(&self, number: u64) -> Self {
        Self { number, ..self.clone() }
    }

    /// Whether sizes were guessed for the first frame of a bare model that the others have as well.
    pub(super) fn guesses(&self) -> bool {
        let first = self.first.as_ref();
        first
            .is_some_and(|first| first.all_objects().any(|object| object.shape.guessed().is_some()))
    }

    /// The range of frames that this is; `None`: it is the first, for which nothing need be known of the others.
    fn range(&self) -> Option<FrameRange> {
        let end = Some(self.number.checked_add(1)?);
        (self.number > 0).then_some(FrameRange { start: self.number, end, step: 1 })
    }
}

/// How many frames the trajectories among these files have, the shortest of them; 1 where there is none.
fn count(files: &[String], source: &dyn Source, limits: &Limits) -> u64 {
    let range = FrameRange { start: 0, end: None, step: 1 };
    let frames = Frames::new(source, limits, range).within(MOST.0, MOST.1);
    for file in files {
        // One that cannot be looked through is read as a file of one frame.
        let _ = frames.open(file);
    }
    frames.numbers().map_or(1, |numbers| numbers.len().max(1) as u64)
}

/// Remembers which files that may have several frames are read.
#[derive(Debug)]
struct Recorder<'a> {
    source: &'a dyn Source,
    named: Mutex<Vec<String>>,
}

impl Source for Recorder<'_> {
    fn open(&self, path: &str) -> io::Result<Box<dyn Blob>> {
        let kinds = [Format::Xyz, Format::Pdb, Format::Gro, Format::Lammps, Format::Trajectory];
        if Format::of_path(path).is_some_and(|format| kinds.contains(&format)) {
            let mut named = self.named.lock().unwrap_or_else(PoisonError::into_inner);
            if !named.iter().any(|one| one == path) {
                named.push(path.to_owned());
            }
        }
        self.source.open(path)
    }
}
