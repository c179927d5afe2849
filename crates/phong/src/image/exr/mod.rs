//! OpenEXR: pictures with all their layers as floats. Files are written by a few lines of our own, and read,
//! where the feature `exr` is, by a crate that knows all kinds of them.

#[cfg(feature = "exr")]
mod read;
mod write;

#[cfg(feature = "exr")]
pub(super) use read::{read, said};
pub(super) use write::write;
