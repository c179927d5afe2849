//! A picture of named channels, read from a file or made of a film.

use thiserror::Error;

use crate::film::{Film, LayerKind};

/// Values (pixels × channels) of the largest picture that is read: 4 GiB as floats.
pub(super) const MAX_VALUES: u64 = 1 << 30;

/// A picture, one plane a channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The channels in the file's order: `R G B A` or `Y A` of a PNG, `R G B` or `Y` of a PFM, any
    /// names of an EXR.
    pub planes: Vec<Plane>,
    /// What the values are.
    pub transfer: Transfer,
    /// The whole number that stands for 1 in the file, to which values were rounded: 255 or 65535
    /// in a PNG, any in a PPM, less in a PNG of few bits; `None`: they are floats.
    pub levels: Option<u16>,
    /// What compression may have changed; `None`: nothing.
    pub lossy: Option<Lossy>,
}

/// How coarsely a JPEG holds its picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lossy {
    /// Steps to which the cosine coefficients of 8 × 8 values are rounded, in levels of 255, row by row
    /// from the mean to the finest: of brightness, and of colour.
    pub steps: [[u16; 64]; 2],
    /// Width and height in pixels of the block that 8 × 8 values of colour stand for: 16 where two
    /// pixels share one.
    pub block: [u8; 2],
}

/// One channel of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Plane {
    /// Its name: `R`, `diffuse.R`, `depth`.
    pub name: String,
    /// A value a pixel, rows from top to bottom.
    pub values: Vec<f32>,
}

/// What the values of a picture are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Transfer {
    /// Encoded by the sRGB curve, in [0, 1].
    Srgb,
    /// Proportional to light.
    Linear,
}

/// Why a file could not be read as a picture.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum ReadError {
    /// It begins like none of the formats.
    #[error("this is no PNG, PPM, JPEG, PFM or OpenEXR file")]
    Unknown,
    /// It is damaged, or uses what we do not read.
    #[error("{0}")]
    Broken(String),
    /// Reading it would take more memory than allowed.
    #[error("{width} × {height} pixels take {needed} bytes of memory, over the limit of {limit}")]
    Memory {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
        /// Bytes that it takes.
        needed: u64,
        /// The limit.
        limit: u64,
    },
    /// It has more pixels than we read.
    #[error("{width} × {height} pixels are more than are read")]
    TooLarge {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
    },
}

/// The number of values in a picture, if that many are read.
pub(super) fn count(width: u32, height: u32, channels: u64) -> Result<u64, ReadError> {
    (u64::from(width) * u64::from(height))
        .checked_mul(channels)
        .filter(|&values| values <= MAX_VALUES)
        .ok_or(ReadError::TooLarge { width, height })
}

/// Says if a picture takes more memory than allowed: `bytes` for each of its pixels.
pub(super) fn within([width, height]: [u32; 2], bytes: u64, limit: u64) -> Result<(), ReadError> {
    let needed = (u64::from(width) * u64::from(height)).saturating_mul(bytes);
    if needed > limit {
        return Err(ReadError::Memory { width, height, needed, limit });
    }
    Ok(())
}

impl Picture {
    /// The picture that a film holds, in linear values: `R G B`, and `A` where any pixel is
    /// not wholly covered.
    pub fn of_film(film: &Film) -> Self {
        let layer = |kind: LayerKind, names: &[&str]| {
            let Some(layer) = film.layer(kind) else { return Vec::new() };
            let plane = |(c, name): (usize, &&str)| {
                let values = layer.values.iter().skip(c).step_by(names.len()).copied().collect();
                Plane { name: (*name).to_owned(), values }
            };
            names.iter().enumerate().map(plane).collect()
        };
        let mut planes = layer(LayerKind::Picture, &["R", "G", "B"]);
        let alpha = film.layer(LayerKind::Alpha);
        if alpha.is_some_and(|alpha| alpha.values.iter().any(|&a| a != 1.0)) {
            planes.extend(layer(LayerKind::Alpha, &["A"]));
        }
        Self {
            size: [film.width(), film.height()],
            planes,
            transfer: Transfer::Linear,
            levels: None,
            lossy: None,
        }
    }

    /// The plane of that name.
    pub fn plane(&self, name: &str) -> Option<&[f32]> {
        self.planes.iter().find(|plane| plane.name == name).map(|plane| &*plane.values)
    }

    /// Red, green and blue; grey is all three. `None`: there is no colour, only other layers.
    pub fn rgb(&self) -> Option<[&[f32]; 3]> {
        let grey = || self.plane("Y").map(|y| [y; 3]);
        let color = || Some([self.plane("R")?, self.plane("G")?, self.plane("B")?]);
        color().or_else(grey)
    }
}
