//! Files as Python names them, and texts that have none.

use std::sync::LazyLock;

use phong_lab::measure::memory::total;
use phong_scene::{Folder, Format, FrameRange, Frames, Limits, Memory, Reading, Source, read};
use pyo3::prelude::*;

use crate::errors::{kind_of, type_error, value_error};

/// The path that an argument means, as the readers take it.
pub(crate) fn path_of(path: &Bound<'_, PyAny>) -> PyResult<String> {
    let path: std::path::PathBuf = path.extract().map_err(|_| {
        type_error(format!("path must be text or a pathlib.Path, not {}", kind_of(path)))
    })?;
    Ok(phong_scene::path_text(path.as_os_str()))
}

pub(crate) fn format_of(name: &str) -> PyResult<Format> {
    Format::of_ending(name).ok_or_else(|| {
        let names: Vec<_> = Format::readable().into_iter().map(Format::ending).collect();
        value_error(format!("format = {name:?}: there are {}", names.join(", ")))
    })
}

/// Bytes of memory that there are; looked for once.
pub(crate) fn memory() -> u64 {
    static TOTAL: LazyLock<u64> = LazyLock::new(|| total().unwrap_or(u64::MAX));
    *TOTAL
}

/// Reads what is at a path, with the frame of this number of its trajectories.
pub(crate) fn read_frame(
    number: u64,
    path: &str,
    format: Option<Format>,
    source: &dyn Source,
    limits: &Limits,
) -> Reading {
    if number == 0 {
        return read(path, format, source, limits);
    }
    let range = FrameRange { start: number, end: number.checked_add(1), step: 1 };
    let frames = Frames::new(source, limits, range);
    let mut reading = frames.read(number, path, format, &[]);
    if let (Some(_), Err(none)) = (&reading.scene, frames.numbers()) {
        (reading.scene, reading.diagnostics) = (None, vec![*none]);
    }
    reading
}

/// What a text that has no file is called.
pub(crate) const TEXT: &str = "<text>";

/// A text, and the folder that the files it names are in.
#[derive(Debug)]
pub(crate) struct Beside {
    pub(crate) text: String,
    pub(crate) folder: String,
}

impl Source for Beside {
    fn open(&self, path: &str) -> std::io::Result<Box<dyn phong_scene::Blob>> {
        if path == TEXT {
            return Memory::new().with(TEXT, self.text.as_bytes()).open(TEXT);
        }
        let path = phong_scene::path_of(&self.folder).join(phong_scene::path_of(path));
        Folder.open(&phong_scene::path_text(path.as_os_str()))
    }
}
