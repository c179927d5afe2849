//! Pictures as files: PNG, PFM and OpenEXR, written whole or not at all, and read back; PPM and JPEG
//! are read too. An [`Animation`] is several pictures in one file, an animated PNG or a GIF.
//!
//! | | values | layers | tone | alpha |
//! |---|---|---|---|---|
//! | PNG | clamped to [0, 1], sRGB curve, 8 or 16 bits | a file each | picture only | straight |
//! | PFM | linear f32 | a file each | no | none |
//! | EXR | linear f32 | all in one file | no | premultiplied |
//!
//! The same film gives the same bytes on every machine, for any number of threads.

mod animation;
mod curve;
mod exr;
mod jpeg;
mod origin;
mod pfm;
mod picture;
mod png;
mod pnm;
mod save;

use std::borrow::Cow;
use std::io::{Seek, Write};
use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::film::LayerKind;
use crate::finish::Finished;

pub use self::png::srgb8;
pub use animation::{Animation, AnimationFormat, AnimationOptions};
pub use origin::picture_of;
pub use picture::{Lossy, Picture, Plane, ReadError, Transfer};
pub use save::{Draft, SaveError, WriteSeek, place, remove_abandoned, save};

impl Picture {
    /// Whether bytes begin as those of a file that is read; four suffice.
    pub fn is_known(begin: &[u8]) -> bool {
        Kind::of(begin).is_some()
    }

    /// Reads a PNG, PPM, JPEG, PFM or EXR file, known by how it begins. 16-bit PNGs keep all their
    /// bits.
    ///
    /// # Errors
    /// [`ReadError`], for anything but a whole picture of at most 2³⁰ values.
    pub fn read(bytes: &[u8]) -> Result<Self, ReadError> {
        Self::read_within(bytes, u64::MAX)
    }

    /// The same, if the picture and what is needed to decode it take at most so many bytes of memory;
    /// how many it takes is told by the head of the file, before anything of it is decoded.
    ///
    /// # Errors
    /// As [`Picture::read`], and [`ReadError::Memory`].
    pub fn read_within(bytes: &[u8], max_bytes: u64) -> Result<Self, ReadError> {
        match Kind::of(bytes) {
            Some(Kind::Png) => png::read(bytes, max_bytes),
            Some(Kind::Pfm) => pfm::read(bytes, max_bytes),
            Some(Kind::Pnm) => pnm::read(bytes, max_bytes),
            Some(Kind::Jpeg) => jpeg::read(bytes, max_bytes),
            #[cfg(feature = "exr")]
            Some(Kind::Exr) => exr::read(bytes, max_bytes),
            #[cfg(not(feature = "exr"))]
            Some(Kind::Exr) => Err(ReadError::Broken("OpenEXR files are not read here".to_owned())),
            None => Err(ReadError::Unknown),
        }
    }
}

/// What a file is by how it begins.
enum Kind {
    Png,
    Pfm,
    /// PPM and PGM.
    Pnm,
    Jpeg,
    Exr,
}

impl Kind {
    fn of(bytes: &[u8]) -> Option<Self> {
        match bytes {
            [0x89, b'P', b'N', b'G', ..] => Some(Self::Png),
            [b'P', b'F' | b'f', ..] => Some(Self::Pfm),
            [b'P', b'2' | b'3' | b'5' | b'6', ..] => Some(Self::Pnm),
            [0xff, 0xd8, 0xff, ..] => Some(Self::Jpeg),
            [0x76, 0x2f, 0x31, 0x01, ..] => Some(Self::Exr),
            _ => None,
        }
    }
}

/// A file format for pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Portable Network Graphics, for eyes.
    Png,
    /// Portable float map: three (or one) floats a pixel, nothing else.
    Pfm,
    /// OpenEXR, for everything: all layers as floats.
    Exr,
}

impl Format {
    /// Every format.
    pub const ALL: [Self; 3] = [Self::Png, Self::Pfm, Self::Exr];

    /// The usual file name extension, without the dot.
    pub const fn extension(self) -> &'static str {
        match self {
            Self::Png => "png",
            Self::Pfm => "pfm",
            Self::Exr => "exr",
        }
    }

    /// The format that a file name's extension means, whatever its case.
    ///
    /// ```
    /// use phong::image::Format;
    /// assert_eq!(Format::of_path("a/b.PNG".as_ref()), Some(Format::Png));
    /// assert_eq!(Format::of_path("a.jpeg".as_ref()), None);
    /// ```
    pub fn of_path(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?;
        Self::ALL.into_iter().find(|f| f.extension().eq_ignore_ascii_case(extension))
    }

    /// Whether one file holds all layers of a film.
    pub const fn holds_layers(self) -> bool {
        matches!(self, Self::Exr)
    }
}

/// Bits a channel in a PNG.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Bits {
    /// Levels from 0 to 255.
    #[default]
    Eight,
    /// Levels from 0 to 65535.
    Sixteen,
}

impl Bits {
    /// Bytes of a level.
    const fn bytes(self) -> usize {
        match self {
            Self::Eight => 1,
            Self::Sixteen => 2,
        }
    }
}

/// How linear values become the values of a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Encoding {
    /// Bits a channel in a PNG. Variables that count or measure always take 16.
    pub bits: Bits,
    /// Whether a PNG holds linear values, without the sRGB curve, and says so.
    pub linear: bool,
}

/// What one file holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Content {
    /// One layer; for the picture of a PNG its alpha too.
    Layer(LayerKind),
    /// All layers: EXR only.
    Film,
}

impl Content {
    /// What the files of a film with layers of these kinds hold, the picture's first.
    pub fn of(kinds: &[LayerKind], format: Format) -> Vec<Self> {
        if format.holds_layers() {
            return vec![Self::Film];
        }
        let layers = kinds.iter().filter(|&&kind| kind != LayerKind::Alpha);
        layers.map(|&kind| Self::Layer(kind)).collect()
    }

    /// The word in the file's name: `None` for the picture and the whole film.
    pub fn word(self) -> Option<Cow<'static, str>> {
        match self {
            Self::Layer(LayerKind::Picture) | Self::Film => None,
            Self::Layer(kind) => Some(kind.name()),
        }
    }

    /// The file that holds it, beside the picture's: `a/b.depth.png` for `a/b.png`.
    ///
    /// ```
    /// use phong::{aov::Aov, film::LayerKind, image::Content};
    /// let depth = Content::Layer(LayerKind::Aov(Aov::Depth));
    /// assert_eq!(depth.path("b.c.pfm".as_ref()).to_str(), Some("b.c.depth.pfm"));
    /// assert_eq!(depth.path("b".as_ref()).to_str(), Some("b.depth"));
    /// assert_eq!(Content::Film.path("b.exr".as_ref()).to_str(), Some("b.exr"));
    /// ```
    pub fn path(self, picture: &Path) -> PathBuf {
        let Some(word) = self.word() else { return picture.to_owned() };
        let mut ending = std::ffi::OsString::from(&*word);
        if let Some(extension) = picture.extension() {
            ending.push(".");
            ending.push(extension);
        }
        picture.with_extension(ending)
    }
}

/// Why a picture could not be encoded.
#[derive(Debug, Error)]
pub enum WriteError {
    /// The disc, the pipe.
    #[error("{}", phong_scene::trouble(.0))]
    Io(#[from] std::io::Error),
    /// The film has no such layer, or the format cannot hold it: the caller's fault.
    #[error("{0}")]
    Unsuitable(String),
}

/// Writes one file of a picture. The writer is left where the file ends, not flushed.
///
/// # Errors
/// [`WriteError::Io`] as `out` says; [`WriteError::Unsuitable`] where the film lacks the layer, or the
/// format cannot hold the content or the size.
pub fn write(
    picture: &Finished<'_>,
    content: Content,
    format: Format,
    encoding: &Encoding,
    out: &mut (impl Write + Seek),
) -> Result<(), WriteError> {
    match (format, content) {
        (Format::Png, Content::Layer(kind)) => png::write(picture, kind, *encoding, out),
        (Format::Pfm, Content::Layer(kind)) => pfm::write(picture, kind, out),
        (Format::Exr, Content::Film) => exr::write(picture, out),
        (format, content) => {
            Err(WriteError::Unsuitable(format!("{content:?} is nothing for a {format:?} file")))
        }
    }
}

/// A linear value as a PNG of 8 bits has it: clamped, on the sRGB curve, rounded. NaN is 0.
///
/// ```
/// use phong::image::srgb_level;
/// assert_eq!([-1.0, 0.0, 0.5, 1.0, 2.0].map(srgb_level), [0, 0, 188, 255, 255]);
/// ```
pub fn srgb_level(linear: f32) -> u8 {
    curve::Curve::eight().level(linear) as u8
}

fn layer<'a>(picture: &'a Finished<'_>, kind: LayerKind) -> Result<&'a [f32], WriteError> {
    picture
        .values(kind)
        .ok_or_else(|| WriteError::Unsuitable(format!("the film has no layer {}", kind.name())))
}

#[cfg(test)]
mod tests;
