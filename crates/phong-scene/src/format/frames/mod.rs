//! The frames of trajectories: each is read as if its file held no other.

mod excerpt;
mod scan;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;
use std::fmt;
use std::io;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use self::excerpt::{Excerpt, line_in_file};
use self::scan::{Around, Section, scan};
use super::read_known;
use super::table::Format;
use crate::change::Change;
use crate::diagnostic::{Diagnostic, Place, Span};
use crate::limits::Limits;
use crate::molecule::Topology;
use crate::scene::Reading;
use crate::source::{Blob, Source};
use crate::unpack::Unpacked;

/// Which frames of a trajectory are wanted: `start`, `start + step`, … below `end`. They count from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameRange {
    /// The first.
    pub start: u64,
    /// The first that is not wanted any more; `None`: all that there are.
    pub end: Option<u64>,
    /// From one to the next, at least 1.
    pub step: u64,
}

/// A source whose trajectories have one frame at a time.
///
/// A trajectory is a file of several frames: XYZ, PDB with several models, GRO, a LAMMPS dump, DCD or XTC. It is
/// looked through once, where its frames begin is kept, and then each is read by itself; files of one
/// frame, and all others, are read as they are. Bonds that are found by covalent radii are those of the
/// first frame that is read, as long as the atoms are the same.
///
/// ```
/// use phong_scene::{FrameRange, Frames, Limits, Memory};
/// let text = "1\n\nH 0 0 0\n1\n\nH 0 0 1\n1\n\nH 0 0 2\n";
/// let files = Memory::new().with("a.xyz", text.as_bytes());
/// let range = FrameRange { start: 1, end: None, step: 1 };
/// let (limits, changes) = (Limits::default(), []);
/// let frames = Frames::new(&files, &limits, range);
/// let reading = frames.read(1, "a.xyz", None, &changes);
/// assert_eq!(frames.numbers().expect("a trajectory"), [1, 2]);
/// assert_eq!(reading.scene.expect("a scene").bounds().center().z, 1.0);
/// ```
pub struct Frames<'a> {
    source: Unpacked<'a>,
    limits: &'a Limits,
    range: FrameRange,
    /// How many bytes of a file are looked through for frames, and how many frames are found.
    most: (u64, u64),
    topology: Topology,
    state: Mutex<State>,
}

#[derive(Default)]
struct State {
    /// The frame that is read.
    number: u64,
    /// The file whose format was given, and what was given.
    given: Option<(String, Format)>,
    /// What is known of each file that was opened; `None`: it has not several frames.
    files: BTreeMap<String, Option<Trajectory>>,
    /// A file of frames that has one alone.
    single: Option<String>,
    /// What is wrong with the last file that could not be opened.
    fault: Option<Diagnostic>,
}

/// A file of several frames.
struct Trajectory {
    blob: Arc<dyn Blob>,
    around: Around,
    /// Those that are wanted.
    frames: Vec<Section>,
    /// How many there are, as far as anybody looked.
    count: u64,
}

impl fmt::Debug for Frames<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Frames").field("range", &self.range).finish_non_exhaustive()
    }
}

impl Source for Frames<'_> {
    fn open(&self, path: &str) -> io::Result<Box<dyn Blob>> {
        let mut state = self.state();
        if !state.files.contains_key(path) {
            let known = self.look_through(path, &mut state)?;
            state.files.insert(path.to_owned(), known);
        }
        let Some(Some(trajectory)) = state.files.get(path) else {
            drop(state);
            return self.source.open(path);
        };
        let sections = trajectory.sections(self.range, state.number);
        let blob = Arc::clone(&trajectory.blob);
        match sections {
            Some(sections) => Ok(Box::new(Excerpt::new(blob, sections))),
            None => Err(too_few(path, trajectory.count, state.number, &mut state.fault)),
        }
    }
}

impl<'a> Frames<'a> {
    /// The frames of the trajectories among a source's files.
    pub fn new(source: &'a dyn Source, limits: &'a Limits, range: FrameRange) -> Self {
        let range = FrameRange { step: range.step.max(1), ..range };
        let (topology, state) = (Topology::default(), Mutex::default());
        let (source, most) = (Unpacked::new(source, limits), (u64::MAX, u64::MAX));
        Self { source, limits, range, most, topology, state }
    }

    /// The same, which looks through no more of a text file than the frames that begin in its first `bytes`, and
    /// finds `count` frames at most: those behind them are not there.
    #[must_use]
    pub fn within(self, bytes: u64, count: u64) -> Self {
        Self { most: (bytes, count), ..self }
    }

    /// Reads a scene or a bare model as [`read_changed`](crate::read_changed) does, with the frame of
    /// this number of each trajectory; errors and warnings tell the frame, and lines of the whole file.
    pub fn read(
        &self,
        number: u64,
        path: &str,
        format: Option<Format>,
        changes: &[Change],
    ) -> Reading {
        {
            let mut state = self.state();
            (state.number, state.fault) = (number, None);
            state.given = format.map(|format| (path.to_owned(), format));
        }
        let mut reading =
            read_known(path, format, self, self.limits, changes, Some(&self.topology));
        let state = self.state();
        if let (None, Some(fault)) = (&reading.scene, &state.fault) {
            reading.diagnostics = vec![fault.clone()];
            return reading;
        }
        for diagnostic in &mut reading.diagnostics {
            state.tell_frame(diagnostic, self.range);
        }
        reading
    }

    /// The numbers of the frames that are wanted and there, once one was read.
    ///
    /// # Errors
    /// That nothing that was read is a trajectory, or that its one frame is not all that is wanted.
    pub fn numbers(&self) -> Result<Vec<u64>, Box<Diagnostic>> {
        let mut state = self.state();
        let FrameRange { start, end, step } = self.range;
        let counts = state.files.values().flatten().map(|trajectory| trajectory.count);
        let Some(count) = counts.min() else {
            if let Some(path) = state.single.clone() {
                let last = end.map_or(start, |end| end.saturating_sub(1));
                if last > 0 {
                    let _ = too_few(&path, 1, last, &mut state.fault);
                }
                return state.fault.take().map_or(Ok(vec![0]), |fault| Err(Box::new(fault)));
            }
            let message = "no file that is read has several frames";
            let help = "frames are read of XYZ, PDB, GRO, LAMMPS dump, DCD and XTC files";
            return Err(Box::new(Diagnostic::error(message, None).with_help(help)));
        };
        let end = end.map_or(count, |end| end.min(count));
        Ok((start..end).step_by(usize::try_from(step).unwrap_or(usize::MAX)).collect())
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Finds the frames of a file; `None`: it has not several.
    fn look_through(&self, path: &str, state: &mut State) -> io::Result<Option<Trajectory>> {
        let given = state.given.as_ref().filter(|(of, _)| of == path).map(|(_, format)| *format);
        let format = given.or_else(|| Format::of_file(path, &self.source));
        let kinds = [Format::Xyz, Format::Pdb, Format::Gro, Format::Lammps, Format::Trajectory];
        let Some(format) = format.filter(|format| kinds.contains(format)) else { return Ok(None) };
        let blob: Arc<dyn Blob> = Arc::from(self.source.open(path)?);
        let FrameRange { start, end, step } = self.range;
        let (mut frames, mut count) = (Vec::new(), 0);
        let found = scan(format, &*blob, &mut |section| {
            if count >= start && (count - start).is_multiple_of(step) {
                frames.push(section);
            }
            count += 1;
            let goes_on = end.is_none_or(|end| count < end.max(2));
            // Without lines it is of a DCD, nothing of which is read for this.
            let is_far = section.lines > 0 && section.end >= self.most.0;
            goes_on && !is_far && count < self.most.1
        })?;
        let around = match found {
            Ok(around) => around,
            Err(broken) => {
                let message = format!("frame {}: {}", broken.frame, broken.message);
                let column = u32::from(broken.line > 0);
                let place = Place { file: path.into(), line: line_of(broken.line), column };
                let span = Span { place, ..Span::default() };
                let help = format!("frames before it can be drawn: `--frames 0:{}`", broken.frame);
                state.fault = Some(Diagnostic::error(message.clone(), span).with_help(help));
                return Err(io::Error::new(io::ErrorKind::InvalidData, message));
            }
        };
        if count < 2 {
            state.single = (count == 1).then(|| path.to_owned()).or(state.single.take());
            return Ok(None);
        }
        if let Some(last) = end.and_then(|end| end.checked_sub(1)).filter(|last| *last >= count) {
            return Err(too_few(path, count, last, &mut state.fault));
        }
        Ok(Some(Trajectory { blob, around, frames, count }))
    }
}

impl State {
    /// Tells of a diagnostic which frame it is about, and where in the whole file.
    fn tell_frame(&self, diagnostic: &mut Diagnostic, range: FrameRange) {
        let sections_of = |file: &str| {
            let trajectory = self.files.get(file)?.as_ref()?;
            trajectory.sections(range, self.number).zip(Some(trajectory))
        };
        let mut any = false;
        let spans = diagnostic.labels.iter_mut().map(|label| &mut label.span);
        for span in diagnostic.span.iter_mut().chain(spans) {
            let Some((sections, trajectory)) = sections_of(&span.place.file) else { continue };
            any = true;
            let place = &mut span.place;
            // A binary file has no lines.
            if place.line == 0 && sections.iter().all(|section| section.lines == 0) {
                continue;
            }
            place.column = place.column.max(1);
            place.line = line_of(match place.line {
                // The frame as a whole.
                0 => trajectory.frame(range, self.number).map_or(0, |frame| frame.line),
                line => line_in_file(&sections, line.into()),
            });
        }
        if any && diagnostic.severity != crate::diagnostic::Severity::Note {
            diagnostic.message = format!("frame {}: {}", self.number, diagnostic.message);
        }
    }
}

impl Trajectory {
    /// The frame of this number, if it was wanted and is there.
    fn frame(&self, range: FrameRange, number: u64) -> Option<Section> {
        let place = number.checked_sub(range.start)?;
        let index = usize::try_from(place / range.step).ok()?;
        self.frames.get(index).copied().filter(|_| place.is_multiple_of(range.step))
    }

    /// What is read of the file for it.
    fn sections(&self, range: FrameRange, number: u64) -> Option<Vec<Section>> {
        let frame = self.frame(range, number)?;
        let Around { head, tail, first } = self.around;
        let first = first.filter(|first| *first != frame);
        Some(head.into_iter().chain(first).chain([frame]).chain(tail).collect())
    }
}

/// A frame is asked for that is not there.
fn too_few(path: &str, count: u64, asked: u64, fault: &mut Option<Diagnostic>) -> io::Error {
    let there = match count {
        1 => "1 frame, 0".to_owned(),
        _ => format!("{count} frames, 0 to {}", count.saturating_sub(1)),
    };
    let message = format!("the file has {there}: there is no frame {asked}");
    let place = Place { file: path.into(), ..Place::default() };
    let span = Span { place, ..Span::default() };
    let help = "`--frames 0:` are all that there are";
    *fault = Some(Diagnostic::error(message.clone(), span).with_help(help));
    io::Error::new(io::ErrorKind::InvalidInput, message)
}

/// The number of a line as places hold it.
fn line_of(line: u64) -> u32 {
    u32::try_from(line).unwrap_or(u32::MAX)
}
