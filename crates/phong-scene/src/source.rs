//! Where bytes come from: the only input in this crate.

use std::collections::BTreeMap;
use std::ffi::OsStr;
#[cfg(unix)]
use std::ffi::OsString;
use std::fmt;
use std::fs::File;
use std::io::{self, Read as _};
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

/// Opens the files a scene is made of.
pub trait Source: fmt::Debug + Send + Sync {
    /// Opens `path`, which is written as the scene's author wrote it, joined to the folder of
    /// the file that names it.
    ///
    /// # Errors
    /// Whatever the system says: not found, not permitted, a folder.
    fn open(&self, path: &str) -> io::Result<Box<dyn Blob>>;
}

/// The first of 256 letters of a private area that stand for bytes which are no UTF-8, so that every
/// path can be text.
const BYTES: u32 = 0x0010_ff00;

/// A path as text, whatever bytes it is of: [`path_of`] gives the path back.
///
/// ```
/// use phong_scene::{path_of, path_text};
/// assert_eq!(path_text("scenes/café.obj".as_ref()), "scenes/café.obj");
/// # #[cfg(unix)] {
/// use std::ffi::OsStr;
/// use std::os::unix::ffi::OsStrExt;
/// let latin = OsStr::from_bytes(b"caf\xe9.obj");
/// assert_eq!(path_of(&path_text(latin)).as_os_str(), latin);
/// # }
/// ```
pub fn path_text(path: &OsStr) -> String {
    let mut text = String::new();
    for chunk in path.as_encoded_bytes().utf8_chunks() {
        text.push_str(chunk.valid());
        text.extend(chunk.invalid().iter().map(|byte| byte_letter(*byte)));
    }
    text
}

/// The path of a text that [`path_text`] may have made.
pub fn path_of(text: &str) -> PathBuf {
    #[cfg(unix)]
    if text.chars().any(|letter| letter_byte(letter).is_some()) {
        use std::os::unix::ffi::OsStringExt;
        let mut bytes = Vec::with_capacity(text.len());
        for letter in text.chars() {
            match letter_byte(letter) {
                Some(byte) => bytes.push(byte),
                None => bytes.extend_from_slice(letter.encode_utf8(&mut [0; 4]).as_bytes()),
            }
        }
        return OsString::from_vec(bytes).into();
    }
    PathBuf::from(text)
}

/// What stands behind the last dot of a file's name, without that of a packed file (`.ply.gz`).
pub(crate) fn ending(path: &str) -> Option<&str> {
    let (stem, ending) = path.rsplit(['/', '\\']).next()?.rsplit_once('.')?;
    if ending.eq_ignore_ascii_case("gz") { Some(stem.rsplit_once('.')?.1) } else { Some(ending) }
}

/// The letter that stands for a byte which is no UTF-8.
pub(crate) fn byte_letter(byte: u8) -> char {
    char::from_u32(BYTES + u32::from(byte)).unwrap_or(char::REPLACEMENT_CHARACTER)
}

#[cfg(unix)]
fn letter_byte(letter: char) -> Option<u8> {
    u32::from(letter).checked_sub(BYTES).and_then(|byte| u8::try_from(byte).ok())
}

/// What the system says of a file that cannot be opened, read or written, in plain words: a clause
/// about the file, without a number of the system's.
///
/// ```
/// let error = std::fs::read("no/such/scene.toml").unwrap_err();
/// assert_eq!(phong_scene::trouble(&error), "there is no such file");
/// ```
pub fn trouble(error: &io::Error) -> String {
    use io::ErrorKind as Kind;
    let said = error.to_string();
    let said = said.split(" (os error").next().unwrap_or_default();
    if error.get_ref().is_some() {
        return said.to_owned(); // not the system's words, but a source's own
    }
    match error.kind() {
        Kind::NotFound => "there is no such file",
        Kind::PermissionDenied => "the system does not permit it",
        Kind::IsADirectory => "it is a folder",
        Kind::NotADirectory => "what should be its folder is a file",
        Kind::StorageFull | Kind::QuotaExceeded => "there is no room left for it",
        Kind::ReadOnlyFilesystem => "nothing can be written there",
        Kind::InvalidFilename => "no file can have that name",
        Kind::FileTooLarge => "the system takes no file that large",
        Kind::OutOfMemory => "there is not enough memory for it",
        _ => said,
    }
    .to_owned()
}

/// An open file: sized, and readable at any position by several threads at once.
#[allow(clippy::len_without_is_empty, reason = "an empty file is a file like any other")]
pub trait Blob: Send + Sync {
    /// Its length in bytes when it was opened.
    fn len(&self) -> u64;

    /// Reads up to `buffer.len()` bytes from `offset` on; 0 only at the end.
    ///
    /// # Errors
    /// Whatever the system says.
    fn read_at(&self, buffer: &mut [u8], offset: u64) -> io::Result<usize>;

    /// Reads from `offset` until `buffer` is full or the file ends; the bytes read.
    ///
    /// # Errors
    /// Whatever the system says.
    fn read_full(&self, buffer: &mut [u8], offset: u64) -> io::Result<usize> {
        let mut done = 0;
        while done < buffer.len() {
            match self.read_at(&mut buffer[done..], offset + done as u64) {
                Ok(0) => break,
                Ok(n) => done += n,
                Err(e) if e.kind() == io::ErrorKind::Interrupted => {}
                Err(e) => return Err(e),
            }
        }
        Ok(done)
    }

    /// Reads all of it, or its first `most` bytes.
    ///
    /// # Errors
    /// Whatever the system says; [`OutOfMemory`](io::ErrorKind::OutOfMemory).
    fn read_whole(&self, most: u64) -> io::Result<Vec<u8>> {
        let len = self.len().min(most) as usize;
        let mut bytes = Vec::new();
        bytes.try_reserve_exact(len)?;
        bytes.resize(len, 0);
        let read = self.read_full(&mut bytes, 0)?;
        bytes.truncate(read);
        Ok(bytes)
    }
}

/// The file system, with paths as written. Only files are opened: a pipe may wait for its writer
/// for ever, and a device has no end.
#[derive(Clone, Copy, Debug, Default)]
pub struct Folder;

impl Source for Folder {
    fn open(&self, path: &str) -> io::Result<Box<dyn Blob>> {
        open_file(&path_of(path))
    }
}

/// The files in a folder and below it, and no others: for scenes of people one does not know.
///
/// Links are followed, and what they lead to must be in the folder as well. A path is resolved, held
/// against the folder, and opened as resolved: whoever may change the folder at that very moment is
/// not kept out.
#[derive(Clone, Debug)]
pub struct Jail {
    /// Without links.
    folder: PathBuf,
}

impl Jail {
    /// The files in this folder.
    ///
    /// # Errors
    /// What the system says of the folder, or that it is none.
    pub fn new(folder: &Path) -> io::Result<Self> {
        let folder = folder.canonicalize()?;
        if !folder.is_dir() {
            return Err(io::Error::new(io::ErrorKind::NotADirectory, "it is no folder"));
        }
        Ok(Self { folder })
    }

    /// The file that a path names, without links.
    ///
    /// # Errors
    /// What the system says, or that the file lies outside.
    pub fn resolve(&self, path: &Path) -> io::Result<PathBuf> {
        let outside = || {
            let message = format!("it lies outside {}", self.folder.display());
            io::Error::new(io::ErrorKind::PermissionDenied, message)
        };
        match path.canonicalize() {
            Ok(real) if real.starts_with(&self.folder) => Ok(real),
            // Of what is not there and lies outside by its name, that it is not there is not told.
            Err(error) if plain(path).is_some_and(|path| path.starts_with(&self.folder)) => {
                Err(error)
            }
            _ => Err(outside()),
        }
    }
}

impl Source for Jail {
    fn open(&self, path: &str) -> io::Result<Box<dyn Blob>> {
        open_file(&self.resolve(&path_of(path))?)
    }
}

/// A path from the root on without `.` and `..`, as far as its words say; its folder is resolved.
fn plain(path: &Path) -> Option<PathBuf> {
    let mut plain = Path::new(".").canonicalize().ok()?;
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir => {
                plain.pop();
            }
            part => plain.push(part),
        }
    }
    let name = plain.file_name()?.to_owned();
    let folder = plain.parent()?;
    Some(folder.canonicalize().unwrap_or_else(|_| folder.to_owned()).join(name))
}

/// Opens a file, and nothing else.
fn open_file(path: &Path) -> io::Result<Box<dyn Blob>> {
    let kind = path.metadata()?;
    if kind.is_dir() {
        return Err(io::Error::new(io::ErrorKind::IsADirectory, "it is a folder"));
    }
    if !kind.is_file() {
        let message = "it is no file but a pipe or a device";
        return Err(io::Error::new(io::ErrorKind::InvalidInput, message));
    }
    let file = File::open(path)?;
    let len = file.metadata()?.len();
    #[cfg(not(unix))]
    let file = std::sync::Mutex::new(file);
    Ok(Box::new(OpenFile { len, file }))
}

/// All that a stream holds, if that is at most so many bytes; what it takes in memory is little more.
///
/// # Errors
/// What the stream says; [`FileTooLarge`](io::ErrorKind::FileTooLarge) beyond `most` bytes;
/// [`OutOfMemory`](io::ErrorKind::OutOfMemory).
pub fn read_stream(mut stream: impl io::Read, most: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    loop {
        // A quarter more each time: doubling would hold twice of what there is.
        let more = (bytes.len() / 4).max(1 << 16) as u64;
        let room = more.min(most.saturating_add(1).saturating_sub(bytes.len() as u64));
        bytes.try_reserve_exact(room as usize)?;
        let read = stream.by_ref().take(room).read_to_end(&mut bytes)?;
        if bytes.len() as u64 > most {
            let message = format!("it holds more than {most} bytes");
            return Err(io::Error::new(io::ErrorKind::FileTooLarge, message));
        }
        if (read as u64) < room {
            bytes.shrink_to_fit();
            return Ok(bytes);
        }
    }
}

struct OpenFile {
    len: u64,
    /// Unix reads at a position; elsewhere the shared cursor needs a lock.
    #[cfg(unix)]
    file: File,
    #[cfg(not(unix))]
    file: std::sync::Mutex<File>,
}

impl Blob for OpenFile {
    fn len(&self) -> u64 {
        self.len
    }

    #[cfg(unix)]
    fn read_at(&self, buffer: &mut [u8], offset: u64) -> io::Result<usize> {
        use std::os::unix::fs::FileExt;
        self.file.read_at(buffer, offset)
    }

    #[cfg(not(unix))]
    fn read_at(&self, buffer: &mut [u8], offset: u64) -> io::Result<usize> {
        use std::io::{Read, Seek, SeekFrom};
        let mut file = self.file.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        file.seek(SeekFrom::Start(offset))?;
        file.read(buffer)
    }
}

/// Files in memory: for tests, fuzzing, and standard input.
#[derive(Clone, Debug, Default)]
pub struct Memory {
    files: BTreeMap<String, Arc<Vec<u8>>>,
}

impl Memory {
    /// No files.
    pub fn new() -> Self {
        Self::default()
    }

    /// The same with one more file.
    #[must_use]
    pub fn with(mut self, path: impl Into<String>, bytes: impl Into<Vec<u8>>) -> Self {
        self.files.insert(path.into(), Arc::new(bytes.into()));
        self
    }
}

impl Source for Memory {
    fn open(&self, path: &str) -> io::Result<Box<dyn Blob>> {
        match self.files.get(path) {
            Some(bytes) => Ok(Box::new(Bytes(Arc::clone(bytes)))),
            None => Err(io::Error::new(io::ErrorKind::NotFound, "there is no such file")),
        }
    }
}

struct Bytes(Arc<Vec<u8>>);

impl Blob for Bytes {
    fn len(&self) -> u64 {
        self.0.len() as u64
    }

    fn read_at(&self, buffer: &mut [u8], offset: u64) -> io::Result<usize> {
        let from = usize::try_from(offset).unwrap_or(usize::MAX).min(self.0.len());
        let n = buffer.len().min(self.0.len() - from);
        buffer[..n].copy_from_slice(&self.0[from..from + n]);
        Ok(n)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stream_is_read_to_its_end_or_its_bound() {
        let text = vec![7; 300_000];
        assert_eq!(read_stream(&text[..], 300_000).unwrap(), text);
        assert_eq!(read_stream(&text[..0], 0).unwrap(), [0; 0]);
        let error = read_stream(&text[..], 299_999).unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::FileTooLarge);
        assert!(read_stream(io::repeat(0), 1 << 20).is_err());
    }

    #[test]
    fn what_the_system_says_is_told_in_words_without_its_numbers() {
        let told = |code| trouble(&io::Error::from_raw_os_error(code));
        for code in 1..=133 {
            assert!(!told(code).contains("os error"), "{}", told(code));
        }
        #[cfg(unix)]
        assert_eq!([told(2), told(21)], ["there is no such file", "it is a folder"]);
        let own = io::Error::new(io::ErrorKind::NotFound, "it is not in the archive");
        assert_eq!(trouble(&own), "it is not in the archive");
    }
}
