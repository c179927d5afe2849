//! Files that are written whole or not at all.
//!
//! A [`Draft`] is written under a temporary name in its target's folder. [`place`] gives several
//! drafts their names together: what they replace is whole until then, and comes back if one of them
//! cannot be placed. Whether a target can be written at all is known when its draft is made, before
//! any work is done. A temporary file of a process that has died is removed by the next one
//! ([`remove_abandoned`]).

mod former;
mod process;
#[cfg(test)]
mod tests;

use std::fs::{self, File};
use std::io::{self, BufWriter, Cursor, Seek, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;
use thiserror::Error;

use super::{Content, Encoding, Format, WriteError};
use crate::finish::Finished;
use former::Former;
pub use process::remove_abandoned;

/// As many links are followed from one to the next.
const MOST_LINKS: usize = 40;

/// Why a file could not be written.
#[derive(Debug, Error)]
pub enum SaveError {
    /// There can be no such file: whoever named it is at fault.
    #[error("cannot write {}: {why}", path.display())]
    Place {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        why: String,
    },
    /// The system failed: a full disk, a limit, a broken pipe.
    #[error("cannot write {}: {}", path.display(), phong_scene::trouble(source))]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The same, and then a former file could not be put back either. Nothing is lost.
    #[error("{error}; the former {} is now {}", path.display(), kept.display())]
    NotRestored {
        /// What failed first.
        error: Box<SaveError>,
        /// The file that is gone from its place.
        path: PathBuf,
        /// Where it is.
        kept: PathBuf,
    },
    /// The content is nothing for such a file: the caller's fault.
    #[error("{0}")]
    Unsuitable(String),
}

impl SaveError {
    fn io(path: &Path, source: io::Error) -> Self {
        Self::Io { path: path.to_owned(), source }
    }

    fn place(path: &Path, why: &str) -> Self {
        Self::Place { path: path.to_owned(), why: why.to_owned() }
    }

    /// Of an error with the place: whose fault it is, that of the name or that of the system.
    fn of_place(path: &Path, error: io::Error) -> Self {
        let why = match error.kind() {
            io::ErrorKind::NotFound => "there is no such folder",
            io::ErrorKind::NotADirectory => "its folder is no folder",
            io::ErrorKind::PermissionDenied => "its folder may not be written to",
            io::ErrorKind::ReadOnlyFilesystem => "its folder can only be read",
            io::ErrorKind::InvalidFilename => "its name is too long, or no name",
            io::ErrorKind::InvalidInput => "it is no name of a file",
            _ => return Self::io(path, error),
        };
        Self::place(path, why)
    }
}

/// What file formats are written to.
pub trait WriteSeek: Write + Seek {}
impl<T: Write + Seek> WriteSeek for T {}

/// A file that is being written, and is not yet under its name.
#[derive(Debug)]
pub struct Draft {
    /// Links followed.
    path: PathBuf,
    content: Written,
}

#[derive(Debug)]
enum Written {
    /// A pipe or a device: there is nothing to rename.
    Special(Cursor<Vec<u8>>),
    File(NamedTempFile, Option<Former>),
}

impl Draft {
    /// Makes ready to write `path`. A link is written through, even one to a file that is not there.
    ///
    /// # Errors
    /// [`SaveError::Place`] if there can be no such file: it is a folder or write-protected, its
    /// folder is missing or may not be written to, its name is no name. [`SaveError::Io`] if the
    /// system has no room for one.
    pub fn create(path: &Path) -> Result<Self, SaveError> {
        let named = path;
        let path = followed(path)?;
        if path.is_dir() {
            return Err(SaveError::place(named, "it is a folder"));
        }
        let name = path.as_os_str().as_encoded_bytes();
        if path.file_name().is_none() || name.ends_with(b"/") || name.ends_with(b"/.") {
            return Err(SaveError::place(named, "it names no file"));
        }
        let former = match fs::metadata(&path) {
            Ok(meta) if !meta.is_file() => {
                return Ok(Self { path, content: Written::Special(Cursor::default()) });
            }
            Ok(meta) if meta.permissions().readonly() => {
                return Err(SaveError::place(named, "it is write-protected"));
            }
            Ok(meta) => Some(Former::new(meta)),
            Err(error) if error.kind() == io::ErrorKind::NotFound => None,
            Err(error) => return Err(SaveError::of_place(named, error)),
        };
        let folder = folder_of(&path);
        let file = temporary(".tmp", former.as_ref())
            .tempfile_in(folder)
            .map_err(|error| SaveError::of_place(named, without_temporary_name(error)))?;
        if let Some(former) = &former
            && !former.may_be_replaced(folder, file.as_file())
        {
            return Err(SaveError::place(named, "it is another user's, in a folder for all"));
        }
        Ok(Self { path, content: Written::File(file, former) })
    }

    /// The file that it will be, links followed.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The temporary file, for whoever has to end the process in the middle; none of a pipe or a
    /// device.
    pub fn temporary(&self) -> Option<&Path> {
        match &self.content {
            Written::Special(_) => None,
            Written::File(file, _) => Some(file.path()),
        }
    }

    /// Whether `path` is the file that this would replace, under this name or another.
    pub fn replaces(&self, path: &Path) -> bool {
        matches!(self.content, Written::File(..)) && former::is_same_file(&self.path, path)
    }

    /// Writes all of the content, to disk, under no name yet.
    ///
    /// # Errors
    /// [`SaveError::Io`]; [`SaveError::Unsuitable`] as the content says.
    pub fn write<E: Into<WriteError>>(
        &mut self,
        content: impl FnOnce(&mut dyn WriteSeek) -> Result<(), E>,
    ) -> Result<(), SaveError> {
        let written = match &mut self.content {
            Written::Special(memory) => content(memory).map_err(Into::into),
            Written::File(file, former) => {
                let file = file.as_file_mut();
                let mut out = BufWriter::with_capacity(1 << 18, &mut *file);
                let written = content(&mut out).map_err(Into::into);
                let written = written.and_then(|()| Ok(out.flush()?));
                drop(out);
                written.and_then(|()| {
                    if let Some(former) = former {
                        former.hand_on(file)?;
                    }
                    Ok(file.sync_all()?)
                })
            }
        };
        written.map_err(|error| match error {
            WriteError::Io(error) => SaveError::io(&self.path, error),
            WriteError::Unsuitable(message) => SaveError::Unsuitable(message),
        })
    }
}

/// Gives all drafts their names, the first last: where it is, the others are, too.
///
/// # Errors
/// [`SaveError::Io`]: then every file is what it was before. [`SaveError::NotRestored`] if that
/// could not be had either; what is missing from its place is where the error says.
pub fn place(drafts: Vec<Draft>) -> Result<(), SaveError> {
    let mut files = Vec::new();
    for Draft { path, content } in drafts.into_iter().rev() {
        match content {
            Written::Special(memory) => File::options()
                .write(true)
                .open(&path)
                .and_then(|mut file| file.write_all(memory.get_ref()))
                .map_err(|error| SaveError::io(&path, error))?,
            Written::File(file, _) => files.push((path, file)),
        }
    }
    let last = files.len().saturating_sub(1);
    let mut placed: Vec<(PathBuf, Option<PathBuf>)> = Vec::new();
    for (number, (path, file)) in files.into_iter().enumerate() {
        // If the last one cannot be placed nothing has happened to what it would replace.
        let kept = if number < last { former::keep(&path) } else { Ok(None) };
        let done = kept.and_then(|kept| match file.persist(&path) {
            Ok(_) => Ok(kept),
            Err(error) => {
                discard(kept.as_deref());
                Err(error.error)
            }
        });
        match done {
            Ok(kept) => placed.push((path, kept)),
            Err(error) => return Err(take_back(placed, SaveError::io(&path, error))),
        }
    }
    for (path, kept) in &placed {
        discard(kept.as_deref());
        sync_folder(folder_of(path));
    }
    Ok(())
}

/// Removes what was kept of a former file. If it cannot be, the next process does.
fn discard(kept: Option<&Path>) {
    if let Some(kept) = kept {
        let _ = fs::remove_file(kept);
    }
}

/// Puts back what was replaced, after an error.
fn take_back(placed: Vec<(PathBuf, Option<PathBuf>)>, mut error: SaveError) -> SaveError {
    for (path, kept) in placed.into_iter().rev() {
        match kept {
            None => drop(fs::remove_file(&path)),
            Some(kept) => {
                if fs::rename(&kept, &path).is_err() {
                    error = SaveError::NotRestored { error: Box::new(error), path, kept };
                }
            }
        }
    }
    error
}

/// Writes a picture, and beside it a file for each other layer of its film if the format does not
/// hold them: all of them or none.
///
/// # Errors
/// [`SaveError::Unsuitable`] if the name does not end in a format's extension; else as
/// [`Draft::create`], [`Draft::write`] and [`place`] say.
pub fn save(picture: &Finished<'_>, path: &Path, encoding: &Encoding) -> Result<(), SaveError> {
    let format = Format::of_path(path).ok_or_else(|| {
        SaveError::Unsuitable(format!("the name {} does not say what to write", path.display()))
    })?;
    let kinds: Vec<_> = picture.film().layers.iter().map(|layer| layer.kind).collect();
    let contents = Content::of(&kinds, format);
    let mut drafts = contents
        .iter()
        .map(|content| Draft::create(&content.path(path)))
        .collect::<Result<Vec<_>, _>>()?;
    for (content, draft) in contents.into_iter().zip(&mut drafts) {
        draft.write(|mut out| super::write(picture, content, format, encoding, &mut out))?;
    }
    place(drafts)
}

/// The file that a name means: what a link leads to, and so on, whether it is there or not.
fn followed(path: &Path) -> Result<PathBuf, SaveError> {
    let mut file = path.to_owned();
    for _ in 0..MOST_LINKS {
        let Ok(to) = fs::read_link(&file) else { return Ok(file) };
        file = folder_of(&file).join(to);
    }
    Err(SaveError::place(path, "it is a link that leads back to itself"))
}

/// The folder that a file is in.
fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Makes a name's place in its folder last. Not every file system can; the file itself is on disk.
fn sync_folder(folder: &Path) {
    if cfg!(unix)
        && let Ok(folder) = File::open(folder)
    {
        let _ = folder.sync_all();
    }
}

/// How temporary files are made: named after this process, and open to nobody to whom the file
/// they replace is closed.
fn temporary(suffix: &'static str, former: Option<&Former>) -> tempfile::Builder<'static, 'static> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(process::prefix()).suffix(suffix);
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(
        // A new file gets what the user's mask leaves.
        former.map_or(0o666, |former| former.mode() & 0o777),
    ));
    #[cfg(not(unix))]
    let _ = former;
    builder
}

/// The error without the temporary file's name, which says nothing to anybody.
fn without_temporary_name(error: io::Error) -> io::Error {
    match error.get_ref().and_then(|inner| inner.source()) {
        Some(source) => {
            let code = source.downcast_ref::<io::Error>().and_then(io::Error::raw_os_error);
            code.map_or(error, io::Error::from_raw_os_error)
        }
        None => error,
    }
}
