//! Rows of varying length in binary bodies, number by number.

use std::io;

use super::body::Body;
use super::header::{Element, Encoding, Type};
use crate::source::Blob;

/// Bytes that are read at once.
pub(super) const BLOCK: usize = 256 << 10;

/// The number that `bytes`, as many as `kind` takes, stand for.
#[inline]
pub(super) fn load(bytes: &[u8], kind: Type, big: bool) -> f64 {
    macro_rules! value {
        ($type:ty) => {
            match bytes.first_chunk() {
                Some(bytes) if big => f64::from(<$type>::from_be_bytes(*bytes)),
                Some(bytes) => f64::from(<$type>::from_le_bytes(*bytes)),
                None => f64::NAN,
            }
        };
    }
    match kind {
        Type::I8 => value!(i8),
        Type::U8 => value!(u8),
        Type::I16 => value!(i16),
        Type::U16 => value!(u16),
        Type::I32 => value!(i32),
        Type::U32 => value!(u32),
        Type::F32 => value!(f32),
        Type::F64 => value!(f64),
    }
}

/// Walks over rows of varying length.
pub(super) struct Walk<'a> {
    blob: &'a dyn Blob,
    big: bool,
    buffer: Vec<u8>,
    /// Where in the buffer it stands, how much of it is filled, and where in the file it begins.
    at: usize,
    filled: usize,
    start: u64,
}

impl<'a> Walk<'a> {
    pub(super) fn new(body: &Body<'a>, offset: u64) -> Self {
        let big = body.header.encoding == Encoding::Big;
        Self { blob: body.blob, big, buffer: vec![0; BLOCK], at: 0, filled: 0, start: offset }
    }

    pub(super) fn offset(&self) -> u64 {
        self.start + self.at as u64
    }

    /// The next number; `None` at the end of the file.
    #[inline]
    pub(super) fn number(&mut self, kind: Type) -> io::Result<Option<f64>> {
        let size = kind.size();
        if self.at + size > self.filled && !self.fill(size)? {
            return Ok(None);
        }
        let value = load(&self.buffer[self.at..self.at + size], kind, self.big);
        self.at += size;
        Ok(Some(value))
    }

    /// The numbers of one row, 0 for a list; whether it is there as a whole.
    pub(super) fn row(&mut self, element: &Element, values: &mut Vec<f64>) -> io::Result<bool> {
        values.clear();
        for property in &element.properties {
            let value = match property.list {
                None => self.number(property.kind)?,
                Some(count) => self.skip_list(count, property.kind)?.then_some(0.0),
            };
            let Some(value) = value else { return Ok(false) };
            values.push(value);
        }
        Ok(true)
    }

    /// Reads on; whether there are `size` more bytes.
    #[cold]
    fn fill(&mut self, size: usize) -> io::Result<bool> {
        self.start = self.offset();
        self.at = 0;
        self.filled = self.blob.read_full(&mut self.buffer, self.start)?;
        Ok(self.filled >= size)
    }

    /// Reads a list of at most `most` numbers; whether it is there as a whole.
    pub(super) fn list<T>(
        &mut self,
        count: Type,
        kind: Type,
        most: u64,
        numbers: &mut Vec<T>,
        of: impl Fn(f64) -> T,
    ) -> io::Result<bool> {
        numbers.clear();
        let Some(count) = self.number(count)? else { return Ok(false) };
        if count > most as f64 {
            let message = format!("a list of {count} numbers takes more memory than is allowed");
            return Err(io::Error::new(io::ErrorKind::InvalidData, message));
        }
        for _ in 0..count.max(0.0) as u64 {
            // What a count promises is not reserved: the file may be shorter.
            let Some(number) = self.number(kind)? else { return Ok(false) };
            numbers.push(of(number));
        }
        Ok(true)
    }

    /// Skips a list; whether it is there as a whole.
    pub(super) fn skip_list(&mut self, count: Type, kind: Type) -> io::Result<bool> {
        let Some(count) = self.number(count)? else { return Ok(false) };
        let size = count.max(0.0) as u64 * kind.size() as u64;
        if size <= (self.filled - self.at) as u64 {
            self.at += size as usize;
        } else {
            self.start = self.offset() + size;
            (self.at, self.filled) = (0, 0);
        }
        Ok(self.start <= self.blob.len())
    }
}
