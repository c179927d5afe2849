//! Where the frames of a file are, in bytes.

use std::io;
use std::ops::Range;

use super::frame::{Fault, head_of};
use super::{dcd, xtc};
use crate::source::Blob;

/// What every frame needs besides its own bytes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Sections {
    /// What is before all frames.
    pub(crate) head: Option<Range<u64>>,
    /// The first frame, where others are told by it.
    pub(crate) first: Option<Range<u64>>,
}

/// Finds the frames, and hands them over in order, until `take` says `false`. What is wrong with one is told
/// with its number, from 0.
pub(crate) fn sections(
    blob: &dyn Blob,
    take: &mut dyn FnMut(Range<u64>) -> bool,
) -> io::Result<Result<Sections, (u64, String)>> {
    if xtc::is_xtc(&head_of(blob)?) {
        let mut start = 0;
        for number in 0.. {
            if start >= blob.len() {
                break;
            }
            match xtc::Header::read(blob, start) {
                Ok(header) if take(start..header.end) => start = header.end,
                Ok(_) => break,
                Err(Fault::Io(error)) => return Err(error),
                Err(Fault::Broken(message)) => return Ok(Err((number, message))),
            }
        }
        return Ok(Ok(Sections::default()));
    }
    let header = match dcd::Header::read(blob) {
        Ok(header) => header,
        Err(Fault::Io(error)) => return Err(error),
        // The reader says it.
        Err(Fault::Broken(_)) => return Ok(Ok(Sections::default())),
    };
    let first = header.start..header.start + header.first_bytes();
    let mut next = first.clone();
    for _ in 0..header.count(blob.len()) {
        if !take(next.clone()) {
            break;
        }
        next = next.end..next.end + header.other_bytes();
    }
    let first = header.has_fixed().then_some(first);
    Ok(Ok(Sections { head: Some(0..header.start), first }))
}
