//! Text that is not plain UTF-8 with line feeds: UTF-16, byte-order marks, carriage returns.

use std::io;

use crate::limits::Limits;
use crate::source::{Blob, Source};

/// Text that was decoded into memory.
struct Decoded(Vec<u8>);

impl Blob for Decoded {
    fn len(&self) -> u64 {
        self.0.len() as u64
    }

    fn read_at(&self, buffer: &mut [u8], offset: u64) -> io::Result<usize> {
        let from = usize::try_from(offset).unwrap_or(usize::MAX).min(self.0.len());
        let count = buffer.len().min(self.0.len() - from);
        buffer[..count].copy_from_slice(&self.0[from..from + count]);
        Ok(count)
    }
}

/// Opens a text of any size. Plain text stays where it is; UTF-16 and text whose lines end in
/// carriage returns alone are decoded into memory, and may have [`Limits::text_bytes`].
///
/// # Errors
/// What the source says, or that the text is too long to decode.
pub(crate) fn open_text(
    source: &dyn Source,
    path: &str,
    limits: &Limits,
) -> io::Result<Box<dyn Blob>> {
    as_text(source.open(path)?, limits)
}

/// The first bytes of a file, at most so many.
///
/// # Errors
/// What reading it fails with.
pub(crate) fn head_of(blob: &dyn Blob, most: usize) -> io::Result<Vec<u8>> {
    let mut head = vec![0; most.min(usize::try_from(blob.len()).unwrap_or(most))];
    let read = blob.read_full(&mut head, 0)?;
    head.truncate(read);
    Ok(head)
}

/// A file as text, as [`open_text`] opens it.
///
/// # Errors
/// As of [`open_text`].
pub(crate) fn as_text(blob: Box<dyn Blob>, limits: &Limits) -> io::Result<Box<dyn Blob>> {
    let head = &head_of(blob.as_ref(), 1 << 12)?[..];
    let plain = !is_utf16(head) && (head.contains(&b'\n') || !head.contains(&b'\r'));
    if plain && !head.starts_with(b"\xef\xbb\xbf") {
        return Ok(blob);
    }
    if plain {
        return Ok(Box::new(Rest { blob, start: 3 }));
    }
    Ok(Box::new(Decoded(decode(read_whole(blob.as_ref(), limits)?))))
}

/// Reads a whole text of at most [`Limits::text_bytes`], decoded.
///
/// # Errors
/// What the source says, or that the text is too long.
pub(crate) fn read_text(source: &dyn Source, path: &str, limits: &Limits) -> io::Result<Vec<u8>> {
    Ok(decode(read_whole(source.open(path)?.as_ref(), limits)?))
}

/// UTF-8 with line feeds from whatever the bytes are; bytes that are no text stay as they are.
pub(crate) fn decode(mut bytes: Vec<u8>) -> Vec<u8> {
    if is_utf16(&bytes) {
        let unit = if bytes[0] == 0xff { u16::from_le_bytes } else { u16::from_be_bytes };
        let units = bytes[2..].chunks_exact(2).map(|pair| unit([pair[0], pair[1]]));
        let text: String =
            char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)).collect();
        bytes = text.into_bytes();
    } else if bytes.starts_with(b"\xef\xbb\xbf") {
        bytes.drain(..3);
    }
    if !bytes.contains(&b'\n') {
        // Classic Mac OS; with line feeds about, a carriage return is but a blank.
        bytes.iter_mut().filter(|b| **b == b'\r').for_each(|b| *b = b'\n');
    }
    bytes
}

/// A name of a file that need not be UTF-8: what is not is taken for Latin-1, so that different names
/// stay different.
pub(crate) fn name_of(bytes: &[u8]) -> String {
    match str::from_utf8(bytes) {
        Ok(name) => name.to_owned(),
        Err(_) => bytes.iter().map(|byte| char::from(*byte)).collect(),
    }
}

fn is_utf16(head: &[u8]) -> bool {
    head.starts_with(&[0xff, 0xfe]) || head.starts_with(&[0xfe, 0xff])
}

fn read_whole(blob: &dyn Blob, limits: &Limits) -> io::Result<Vec<u8>> {
    let too_long = |limit: u64| {
        let message = format!("is text of more than {limit} bytes");
        io::Error::new(io::ErrorKind::FileTooLarge, message)
    };
    if blob.len() > limits.text_bytes {
        return Err(too_long(limits.text_bytes));
    }
    blob.read_whole(limits.text_bytes)
}

/// The rest of a blob.
struct Rest {
    blob: Box<dyn Blob>,
    start: u64,
}

impl Blob for Rest {
    fn len(&self) -> u64 {
        self.blob.len() - self.start
    }

    fn read_at(&self, buffer: &mut [u8], offset: u64) -> io::Result<usize> {
        self.blob.read_at(buffer, offset.saturating_add(self.start))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn utf16_marks_and_bare_carriage_returns_become_plain_text() {
        let utf16 = |unit: fn(u16) -> [u8; 2]| {
            "\u{feff}v 1\ré".encode_utf16().flat_map(unit).collect::<Vec<u8>>()
        };
        assert_eq!(decode(utf16(u16::to_le_bytes)), "v 1\né".as_bytes());
        assert_eq!(decode(utf16(u16::to_be_bytes)), "v 1\né".as_bytes());
        assert_eq!(decode(b"\xef\xbb\xbfv 1\r\n".to_vec()), b"v 1\r\n");
        assert_eq!(decode(b"a\rb\r".to_vec()), b"a\nb\n");
    }
}
