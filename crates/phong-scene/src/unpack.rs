//! Files that are packed with gzip, told by their content, read as if they were not.

use std::fmt;
use std::io::{self, Read};

use flate2::read::MultiGzDecoder;

use crate::limits::Limits;
use crate::source::{Blob, Memory, Source, read_stream, trouble};

/// The most that a packed file may hold, whatever the limits say: few bytes may hold any number.
const MOST: u64 = 8 << 30;

/// What a packed file begins with. Of the ways to pack, only deflate was ever defined.
const MAGIC: [u8; 3] = [0x1f, 0x8b, 8];

/// What the text begins with that stands in place of a file where Git LFS has not brought the file itself.
const POINTER: &[u8] = b"version https://git-lfs.github.com/spec/";

/// A source whose packed files are read as what they hold.
pub(crate) struct Unpacked<'a> {
    source: &'a dyn Source,
    most: u64,
}

impl<'a> Unpacked<'a> {
    /// The files of a source; packed ones may hold as many bytes as the limits allow.
    pub(crate) fn new(source: &'a dyn Source, limits: &Limits) -> Self {
        Self { source, most: limits.bytes.min(MOST) }
    }
}

impl fmt::Debug for Unpacked<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Unpacked").field("source", &self.source).finish_non_exhaustive()
    }
}

impl Source for Unpacked<'_> {
    fn open(&self, path: &str) -> io::Result<Box<dyn Blob>> {
        let blob = self.source.open(path)?;
        let mut head = [0; POINTER.len()];
        let read = blob.read_full(&mut head, 0)?;
        if head == POINTER {
            let message = "the file itself is not here: this is a pointer of Git LFS to it; `git lfs pull` brings it";
            return Err(io::Error::new(io::ErrorKind::InvalidData, message));
        }
        if !head[..read].starts_with(&MAGIC) {
            return Ok(blob);
        }
        let packed = io::BufReader::with_capacity(1 << 16, Reader { blob: &*blob, at: 0 });
        let bytes = read_stream(MultiGzDecoder::new(packed), self.most).map_err(|error| {
            let message = match error.kind() {
                io::ErrorKind::FileTooLarge => {
                    format!("unpacked it takes more than {} bytes", self.most)
                }
                _ => format!("it is packed, and cannot be unpacked: {}", trouble(&error)),
            };
            io::Error::new(error.kind(), message)
        })?;
        if is_archive(&bytes) {
            let message = "it is packed, and what it holds is an archive of several files: unpack it (tar xzf)";
            return Err(io::Error::new(io::ErrorKind::InvalidData, message));
        }
        Memory::new().with(path, bytes).open(path)
    }
}

/// What a file begins with, or what it holds begins with if it is packed: at most so many bytes, of
/// which no more are unpacked.
///
/// # Errors
/// What the source says; of a packed file also that it cannot be unpacked.
pub(crate) fn head_of(source: &dyn Source, path: &str, most: usize) -> io::Result<Vec<u8>> {
    let blob = source.open(path)?;
    let mut head = vec![0; most];
    let read = blob.read_full(&mut head, 0)?;
    head.truncate(read);
    if head.starts_with(&MAGIC) {
        let packed = MultiGzDecoder::new(Reader { blob: &*blob, at: 0 });
        head = Vec::new();
        packed.take(most as u64).read_to_end(&mut head)?;
    }
    Ok(head)
}

/// Whether these are the bytes of a tar archive, as far as its first block says.
fn is_archive(bytes: &[u8]) -> bool {
    bytes.get(257..262) == Some(b"ustar")
}

/// A blob, read from its beginning on.
struct Reader<'a> {
    blob: &'a dyn Blob,
    at: u64,
}

impl Read for Reader<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = self.blob.read_at(buffer, self.at)?;
        self.at += read as u64;
        Ok(read)
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use flate2::Compression;
    use flate2::write::GzEncoder;

    use super::*;

    fn packed(bytes: &[u8]) -> Vec<u8> {
        let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
        encoder.write_all(bytes).expect("memory");
        encoder.finish().expect("memory")
    }

    fn open(file: Vec<u8>, bytes: u64) -> io::Result<Vec<u8>> {
        let files = Memory::new().with("a", file);
        let blob = Unpacked::new(&files, &Limits { bytes, ..Limits::default() }).open("a")?;
        let mut all = vec![0; blob.len() as usize];
        blob.read_full(&mut all, 0)?;
        Ok(all)
    }

    #[test]
    fn a_packed_file_is_read_as_what_it_holds_and_any_other_as_it_is() {
        let parts = [packed(b"one "), packed(b"two")].concat();
        assert_eq!(open(parts, 100).expect("both"), b"one two");
        assert_eq!(open(b"plain".to_vec(), 2).expect("plain"), b"plain");
    }

    #[test]
    fn a_packed_file_that_holds_too_much_or_is_cut_short_is_refused() {
        let zeros = packed(&vec![0; 1 << 20]);
        let error = open(zeros.clone(), 1000).expect_err("too much").to_string();
        assert!(error.contains("more than 1000 bytes"), "{error}");
        let error = open(zeros[..zeros.len() / 2].to_vec(), 1 << 30).expect_err("cut");
        assert!(error.to_string().contains("cannot be unpacked"), "{error}");
    }

    #[test]
    fn a_pointer_of_git_lfs_is_refused_with_a_way_out() {
        let pointer = b"version https://git-lfs.github.com/spec/v1\noid sha256:23\nsize 1324\n";
        let error = open(pointer.to_vec(), 1 << 20).expect_err("a pointer").to_string();
        assert!(error.ends_with("`git lfs pull` brings it"), "{error}");
    }

    #[test]
    fn an_archive_of_several_files_is_refused_with_a_way_out() {
        let mut block = [0; 1024];
        block[..5].copy_from_slice(b"1.pdb");
        block[257..262].copy_from_slice(b"ustar");
        let error = open(packed(&block), 1 << 20).expect_err("an archive").to_string();
        assert!(error.contains("an archive of several files: unpack it"), "{error}");
        assert_eq!(open(block.to_vec(), 1 << 20).expect("not packed").len(), 1024);
    }
}
