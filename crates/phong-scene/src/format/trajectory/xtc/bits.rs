//! Bits of a file, in order, the highest of a byte first.

use super::super::frame::Fault;
use crate::source::Blob;

/// Bytes that are read at a time.
const PIECE: usize = 1 << 16;

/// The bits of a stretch of a file, read piece by piece.
pub(super) struct Bits<'a> {
    blob: &'a dyn Blob,
    /// The next byte of the file that is to be read, and the first behind the stretch.
    at: u64,
    end: u64,
    buffer: Vec<u8>,
    /// The next byte of the buffer.
    next: usize,
    /// The bits that were taken of the buffer and not used, at the low end.
    held: u64,
    count: u32,
}

impl<'a> Bits<'a> {
    pub(super) fn new(blob: &'a dyn Blob, start: u64, end: u64) -> Self {
        Self { blob, at: start, end, buffer: Vec::new(), next: 0, held: 0, count: 0 }
    }

    /// The next bits, at most 32 of them, as a number.
    pub(super) fn take(&mut self, count: u32) -> Result<u32, Fault> {
        while self.count < count {
            self.held = self.held << 8 | u64::from(self.byte()?);
            self.count += 8;
        }
        self.count -= count;
        let number = self.held >> self.count & ((1 << count) - 1);
        Ok(number as u32)
    }

    /// The next bits as a number whose first byte is the lowest, as three numbers are packed into one.
    pub(super) fn take_packed(&mut self, count: u32) -> Result<u128, Fault> {
        let (mut number, mut shift) = (0, 0);
        while shift + 8 < count {
            number |= u128::from(self.take(8)?) << shift;
            shift += 8;
        }
        Ok(number | u128::from(self.take(count - shift)?) << shift)
    }

    fn byte(&mut self) -> Result<u8, Fault> {
        if self.next == self.buffer.len() {
            let length = (self.end - self.at).min(PIECE as u64) as usize;
            self.buffer.resize(length, 0);
            let read = self.blob.read_full(&mut self.buffer, self.at)?;
            self.buffer.truncate(read);
            self.at += read as u64;
            self.next = 0;
        }
        let byte = self.buffer.get(self.next).copied().ok_or_else(|| {
            Fault::Broken(format!(
                "its packed places end before byte {}, but not all are told",
                self.at
            ))
        })?;
        self.next += 1;
        Ok(byte)
    }
}
