//! The bytes of a buffer: held, or left in their file until somebody wants some of them.

use std::borrow::Cow;
use std::io;

use crate::source::Blob;

/// Files of fewer bytes are read at once.
const SMALL: u64 = 1 << 18;

/// What is wrong with bytes that were there when the file was opened.
const GONE: &str = "the file became shorter meanwhile";

/// The bytes of a buffer.
pub(super) enum Bytes {
    Held(Vec<u8>),
    /// So many bytes of a file, from the one of this number on.
    Filed {
        blob: Box<dyn Blob>,
        start: u64,
        length: u64,
    },
}

impl Default for Bytes {
    /// None.
    fn default() -> Self {
        Self::Held(Vec::new())
    }
}

impl Bytes {
    /// So many bytes of a file, from one on; they are there, or were when it was opened. A small part of a
    /// file is read at once, and so is all where no file is to be `kept` open.
    pub(super) fn of(blob: Box<dyn Blob>, start: u64, length: u64, kept: bool) -> io::Result<Self> {
        let filed = Self::Filed { blob, start, length };
        if kept && length >= SMALL {
            return Ok(filed);
        }
        Ok(Self::Held(filed.part(0, length as usize)?.into_owned()))
    }

    /// How many there are.
    pub(super) fn len(&self) -> u64 {
        match self {
            Self::Held(bytes) => bytes.len() as u64,
            Self::Filed { length, .. } => *length,
        }
    }

    /// So many bytes from one on, all of which are there.
    pub(super) fn part(&self, from: u64, length: usize) -> io::Result<Cow<'_, [u8]>> {
        if let Self::Held(bytes) = self {
            return held(bytes, from, length).map(Cow::Borrowed);
        }
        let mut room = Vec::new();
        room.try_reserve_exact(length)?;
        self.piece(from, length, &mut room)?;
        Ok(Cow::Owned(room))
    }

    /// The same, in a room for what must be read from a file.
    pub(super) fn piece<'a>(
        &'a self,
        from: u64,
        length: usize,
        room: &'a mut Vec<u8>,
    ) -> io::Result<&'a [u8]> {
        match self {
            Self::Held(bytes) => held(bytes, from, length),
            Self::Filed { blob, start, .. } => {
                room.resize(length, 0);
                let read = blob.read_full(room, start + from)?;
                held(&room[..read], 0, length)
            }
        }
    }
}

/// So many of some bytes, from one on.
fn held(bytes: &[u8], from: u64, length: usize) -> io::Result<&[u8]> {
    let part = bytes.get(from as usize..).and_then(|rest| rest.get(..length));
    part.ok_or_else(|| io::Error::new(io::ErrorKind::UnexpectedEof, GONE))
}
