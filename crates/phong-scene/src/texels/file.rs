//! Image files: which format one is, by what it begins with, and its pixels.

use std::sync::Arc;

#[cfg(feature = "exr")]
use super::openexr;
use super::{Texels, jpeg, png, radiance};
use crate::limits::Limits;
use crate::source::{Source, trouble};

/// The pixels of the image file at `path`, or a clause that says what is wrong with it; `warn` is told by such clauses
/// what is not drawn of it.
pub(crate) fn load(
    path: &str,
    source: &dyn Source,
    limits: &Limits,
    warn: &mut dyn FnMut(String),
) -> Result<Arc<Texels>, String> {
    let blob = source.open(path).map_err(|error| trouble(&error))?;
    // A file that is larger than all it may hold is none that can be read.
    let most = limits.bytes.min(MOST_BYTES);
    if blob.len() > most {
        return Err(format!("it is larger than {most} bytes"));
    }
    let bytes = blob.read_whole(most).map_err(|error| trouble(&error))?;
    parse(&bytes, limits, warn).map(Arc::new)
}

/// The most bytes of an image file.
const MOST_BYTES: u64 = 1 << 32;

/// [`load`] of a file whose bytes these are.
pub(crate) fn parse(
    bytes: &[u8],
    limits: &Limits,
    warn: &mut dyn FnMut(String),
) -> Result<Texels, String> {
    match bytes {
        [] => Err("it is empty".to_owned()),
        [0x89, b'P', b'N', b'G', ..] => png::decode(bytes, limits),
        [0xff, 0xd8, ..] => jpeg::decode(bytes, limits),
        [b'#', b'?', ..] => radiance::decode(bytes, limits, warn),
        #[cfg(feature = "exr")]
        [0x76, 0x2f, 0x31, 0x01, ..] => openexr::decode(bytes, limits, warn),
        #[cfg(not(feature = "exr"))]
        [0x76, 0x2f, 0x31, 0x01, ..] => Err("it is an EXR, which is not read here".to_owned()),
        _ => Err("it is no PNG, JPEG, HDR or EXR".to_owned()),
    }
}
