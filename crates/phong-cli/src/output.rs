//! Files that are complete or absent: a temporary file in the target's folder, then a rename.
//!
//! Whether a target can be written is known before any work is done. An interrupt takes every
//! temporary file with it.

use std::fs::{self, File};
use std::io::{self, BufWriter, Cursor, Seek, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use tempfile::NamedTempFile;

use crate::failure::Failure;
use crate::report;

/// Temporary files that exist now. Held while they get their names, so that an interrupt comes
/// before all of them or after.
static TEMPORARIES: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

fn temporaries() -> MutexGuard<'static, Vec<PathBuf>> {
    TEMPORARIES.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes what is half-written; no file gets its name after that.
pub(crate) fn remove_temporaries() {
    let held = temporaries();
    for path in held.iter() {
        let _ = fs::remove_file(path);
    }
    std::mem::forget(held);
}

/// A file, or standard output, that is being written.
#[derive(Debug)]
pub(crate) struct Output {
    target: Target,
}

#[derive(Debug)]
enum Target {
    Stdout(Cursor<Vec<u8>>),
    /// A pipe or a device: nothing to rename.
    Special(PathBuf, Cursor<Vec<u8>>),
    File {
        path: PathBuf,
        temporary: Temporary,
    },
}

/// A temporary file, known to the interrupt handler until it has its name or is gone.
#[derive(Debug)]
struct Temporary(Option<NamedTempFile>);

impl Temporary {
    fn create_in(folder: &Path) -> io::Result<Self> {
        let mut all = temporaries();
        let file = builder().tempfile_in(folder)?;
        all.push(file.path().to_owned());
        Ok(Self(Some(file)))
    }

    /// Gives it its name; `all` are the temporary files.
    fn persist(&mut self, path: &Path, all: &mut Vec<PathBuf>) -> io::Result<()> {
        let Some(file) = self.0.take() else { return Ok(()) };
        all.retain(|other| other != file.path());
        // What cannot be renamed is removed with the error.
        file.persist(path).map(drop).map_err(|error| error.error)
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        if let Some(file) = self.0.take() {
            let mut all = temporaries();
            all.retain(|path| path != file.path());
            drop(file);
        }
    }
}

impl Output {
    /// Makes ready to write `path`; `-` is standard output.
    pub(crate) fn create(path: &Path) -> Result<Self, Failure> {
        if path == Path::new("-") {
            return Ok(Self { target: Target::Stdout(Cursor::default()) });
        }
        let cannot = |why: &str, help: &str| {
            Failure::usage(format!("cannot write {}: {why}", path.display())).with_help(help)
        };
        let look = "look at its folder, or give another file to write";
        // A link is written through.
        let path = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        match fs::metadata(&path) {
            Ok(meta) if meta.is_dir() => return Err(cannot("it is a folder", "name a file in it")),
            Ok(meta) if !meta.is_file() => {
                return Ok(Self { target: Target::Special(path, Cursor::default()) });
            }
            Ok(meta) if meta.permissions().readonly() => {
                return Err(cannot("it is write-protected", look));
            }
            _ => {}
        }
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
        let folder = folder.unwrap_or(Path::new("."));
        if path.file_name().is_none() {
            return Err(cannot("it names no file", look));
        }
        let temporary =
            Temporary::create_in(folder).map_err(|error| cannot(&reason(&error), look))?;
        Ok(Self { target: Target::File { path, temporary } })
    }

    /// Whether this would replace `path`.
    pub(crate) fn is(&self, path: &Path) -> bool {
        match &self.target {
            Target::File { path: own, .. } => fs::canonicalize(path)
                .is_ok_and(|path| fs::canonicalize(own).is_ok_and(|own| own == path)),
            _ => false,
        }
    }

    /// Writes all of the content, under no name yet.
    pub(crate) fn write<E: Into<WriteFailure>>(
        &mut self,
        content: impl FnOnce(&mut dyn WriteSeek) -> Result<(), E>,
    ) -> Result<(), Failure> {
        let written = match &mut self.target {
            Target::Stdout(memory) | Target::Special(_, memory) => {
                content(memory).map_err(Into::into)
            }
            Target::File { temporary, .. } => {
                let file = temporary.0.as_mut().map(NamedTempFile::as_file_mut);
                file.map_or(Ok(()), |file| {
                    let mut out = BufWriter::with_capacity(1 << 18, file);
                    content(&mut out)
                        .map_err(Into::into)
                        .and_then(|()| out.flush().map_err(WriteFailure::Io))
                })
            }
        };
        written.map_err(|failure| match failure {
            WriteFailure::Io(error) => Failure::writing(&self.path(), &error),
            WriteFailure::Other(message) => Failure::System(message),
        })
    }

    fn path(&self) -> PathBuf {
        match &self.target {
            Target::Stdout(_) => "standard output".into(),
            Target::Special(path, _) | Target::File { path, .. } => path.clone(),
        }
    }

    /// Gives all outputs their names, the first last: where it is, the others are, too.
    pub(crate) fn commit(outputs: Vec<Self>) -> Result<(), Failure> {
        let mut files = Vec::new();
        for output in outputs.into_iter().rev() {
            match output.target {
                Target::Stdout(memory) => report::data(memory.get_ref())?,
                Target::Special(path, memory) => File::options()
                    .write(true)
                    .open(&path)
                    .and_then(|mut file| file.write_all(memory.get_ref()))
                    .map_err(|error| Failure::writing(&path, &error))?,
                Target::File { path, temporary } => files.push((path, temporary)),
            }
        }
        // Declared after the files, so that it is free again when they are dropped.
        let mut all = temporaries();
        let mut named: Vec<&Path> = Vec::new();
        for (path, temporary) in &mut files {
            if let Err(error) = temporary.persist(path, &mut all) {
                for path in named {
                    let _ = fs::remove_file(path);
                }
                return Err(Failure::writing(path, &error));
            }
            named.push(path);
        }
        Ok(())
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

/// What file formats are written to.
pub(crate) trait WriteSeek: Write + Seek {}
impl<T: Write + Seek> WriteSeek for T {}

/// Why content could not be written.
#[derive(Debug)]
pub(crate) enum WriteFailure {
    Io(io::Error),
    Other(String),
}

impl From<io::Error> for WriteFailure {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

impl From<phong::image::WriteError> for WriteFailure {
    fn from(error: phong::image::WriteError) -> Self {
        match error {
            phong::image::WriteError::Io(error) => Self::Io(error),
            phong::image::WriteError::Unsuitable(message) => Self::Other(message),
        }
    }
}

fn builder() -> tempfile::Builder<'static, 'static> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".phong-").suffix(".tmp");
    // Like any new file: what the user's mask leaves.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder
}

fn reason(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "there is no such folder".to_owned(),
        io::ErrorKind::NotADirectory => "its folder is no folder".to_owned(),
        io::ErrorKind::PermissionDenied => "its folder may not be written to".to_owned(),
        // Without the temporary file's name, which says nothing to anybody.
        _ => phong_scene::trouble(error).split(" at path ").next().unwrap_or_default().to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(path: &Path, text: &[u8]) -> Output {
        let mut output = Output::create(path).unwrap();
        output.write(|out| out.write_all(text)).unwrap();
        output
    }

    #[test]
    fn what_was_named_is_taken_back_where_a_later_name_cannot_be_given() {
        let folder = tempfile::tempdir().unwrap();
        let [first, second] = ["first", "second"].map(|name| folder.path().join(name));
        let outputs = vec![written(&first, b"1"), written(&second, b"2")];
        // It takes its name last, and by then a folder has it.
        fs::create_dir(&first).unwrap();
        assert!(matches!(Output::commit(outputs), Err(Failure::System(_))));
        let names: Vec<_> =
            fs::read_dir(folder.path()).unwrap().map(|e| e.unwrap().path()).collect();
        assert_eq!(names, [first]);
    }

    #[test]
    fn what_is_given_up_leaves_no_file() {
        let folder = tempfile::tempdir().unwrap();
        drop(written(&folder.path().join("a"), b"half"));
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }
}
