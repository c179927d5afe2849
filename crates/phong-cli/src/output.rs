//! What is written: files, which are complete or absent, and standard output.
//!
//! The library writes files whole or not at all ([`Draft`]). What is added here is that an interrupt
//! takes every temporary file with it.

use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use phong::image::{Draft, SaveError, WriteError, WriteSeek, place, remove_abandoned};

use crate::failure::Failure;
use crate::report;

/// Temporary files that exist now. Held while they get their names, so that an interrupt comes
/// before all of them or after.
static TEMPORARIES: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Folders in which what dead processes have left is already removed.
static TIDY: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

fn held<T>(mutex: &'static Mutex<T>) -> MutexGuard<'static, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes what is half-written; no file gets its name after that.
pub(crate) fn remove_temporaries() {
    let all = held(&TEMPORARIES);
    for path in all.iter() {
        let _ = fs::remove_file(path);
    }
    std::mem::forget(all);
}

/// A file, or standard output, that is being written.
#[derive(Debug)]
pub(crate) struct Output {
    target: Target,
}

#[derive(Debug)]
enum Target {
    Stdout(Cursor<Vec<u8>>),
    File(Listed),
}

/// A draft whose temporary file the interrupt handler knows until it has its name or is gone.
#[derive(Debug)]
struct Listed(Option<Draft>);

impl Listed {
    fn create(path: &Path) -> Result<Self, SaveError> {
        let mut all = held(&TEMPORARIES);
        let draft = Draft::create(path)?;
        all.extend(draft.temporary().map(Path::to_owned));
        Ok(Self(Some(draft)))
    }
}

impl Drop for Listed {
    fn drop(&mut self) {
        if let Some(draft) = self.0.take() {
            let mut all = held(&TEMPORARIES);
            all.retain(|path| Some(&**path) != draft.temporary());
            drop(draft);
        }
    }
}

impl Output {
    /// Makes ready to write `path`; `-` is standard output.
    pub(crate) fn create(path: &Path) -> Result<Self, Failure> {
        if path == Path::new("-") {
            return Ok(Self { target: Target::Stdout(Cursor::default()) });
        }
        let draft = Listed::create(path)?;
        tidy(draft.0.as_ref().map_or(path, Draft::path));
        Ok(Self { target: Target::File(draft) })
    }

    /// Whether this would replace `path`, under whatever name.
    pub(crate) fn is(&self, path: &Path) -> bool {
        match &self.target {
            Target::File(Listed(Some(draft))) => draft.replaces(path),
            _ => false,
        }
    }

    /// Writes all of the content, under no name yet.
    pub(crate) fn write<E: Into<WriteError>>(
        &mut self,
        content: impl FnOnce(&mut dyn WriteSeek) -> Result<(), E>,
    ) -> Result<(), Failure> {
        match &mut self.target {
            Target::Stdout(memory) => content(memory).map_err(|error| match error.into() {
                WriteError::Io(error) => Failure::stdout(&error),
                WriteError::Unsuitable(message) => Failure::System(message),
            }),
            Target::File(Listed(Some(draft))) => Ok(draft.write(content)?),
            Target::File(Listed(None)) => Ok(()),
        }
    }

    /// Gives all outputs their names, the first last: where it is, the others are, too.
    pub(crate) fn commit(outputs: Vec<Self>) -> Result<(), Failure> {
        let mut drafts = Vec::new();
        for output in outputs {
            match output.target {
                Target::Stdout(memory) => report::data(memory.get_ref())?,
                Target::File(mut listed) => drafts.extend(listed.0.take()),
            }
        }
        // A pipe may wait for its reader, and an interrupt must not wait with it.
        let (pipes, drafts): (Vec<_>, Vec<_>) =
            drafts.into_iter().partition(|draft| draft.temporary().is_none());
        place(pipes)?;
        let mut all = held(&TEMPORARIES);
        let gone: Vec<_> =
            drafts.iter().filter_map(|draft| draft.temporary().map(Path::to_owned)).collect();
        let placed = place(drafts);
        all.retain(|path| !gone.contains(path));
        Ok(placed?)
    }
}

/// Removes what dead processes have left beside a file, once.
fn tidy(file: &Path) {
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty());
    let folder = folder.unwrap_or(Path::new("."));
    let mut tidy = held(&TIDY);
    if !tidy.iter().any(|known| known == folder) {
        remove_abandoned(folder);
        tidy.push(folder.to_owned());
    }
}

/// Refuses to write over anything that is read.
pub(crate) fn keep_inputs_safe<'o, P: AsRef<Path>>(
    outputs: impl IntoIterator<Item = &'o Output>,
    inputs: impl IntoIterator<Item = P>,
) -> Result<(), Failure> {
    let outputs: Vec<_> = outputs.into_iter().collect();
    for input in inputs {
        let input = input.as_ref();
        if outputs.iter().any(|output| output.is(input)) {
            let message = format!("this would write over the input {}", input.display());
            return Err(Failure::usage(message).with_help("give another file to write"));
        }
    }
    Ok(())
}

impl From<SaveError> for Failure {
    fn from(error: SaveError) -> Self {
        match &error {
            SaveError::Place { path, .. } => {
                let help = if path.is_dir() {
                    "name a file in it"
                } else {
                    "look at its folder, or give another file to write"
                };
                Self::usage(error.to_string()).with_help(help)
            }
            _ => Self::System(error.to_string()),
        }
    }
}
