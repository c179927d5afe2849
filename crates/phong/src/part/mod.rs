//! Part files: a film that is not finished, with all that says what picture it belongs to.
//!
//! One format serves shares, which are put together ([`Join`]), and checkpoints, from which a
//! rendering goes on. A text header ([`Settings`], a name and a value a line) ends in a checksum
//! of itself; then, for each tile that is done, come its number, its layers' values as
//! little-endian floats, and a checksum of both. A cut file or a flipped bit is an error.

mod fingerprint;
mod join;
mod settings;

use std::io::{self, Read, Write};

use crc32fast::hash as checksum;
use thiserror::Error;

use crate::film::{Film, Layer};
pub use fingerprint::fingerprint;
pub use join::{Join, JoinError};
pub use settings::Settings;

/// The first line of every part file: what it is, and the version of its format.
const MAGIC: &str = "phong part 2\n";

/// The longest header that is read, in bytes.
const MAX_HEADER: usize = 64 << 10;

/// A film that may lack tiles, and the picture it is of.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// What picture it is.
    pub settings: Settings,
    /// What is done of it.
    pub film: Film,
}

/// Why a file could not be read as a part.
#[derive(Debug, Error)]
pub enum PartError {
    /// The system's word.
    #[error("{}", phong_scene::trouble(.0))]
    Io(#[from] io::Error),
    /// It is no part file at all.
    #[error("this is no part file")]
    Unknown,
    /// It was made by another version of this program.
    #[error("this part file is of another version of the format")]
    Version,
    /// It is cut short or altered.
    #[error("the part file is damaged: {0}")]
    Damaged(String),
    /// Its picture would take more memory than allowed.
    #[error("the picture takes {needed} bytes, over the limit of {limit}")]
    TooLarge {
        /// Bytes of the film.
        needed: u64,
        /// The limit.
        limit: u64,
    },
}

/// Writes the tiles that `film` has. Not flushed.
///
/// # Errors
/// As `out` says.
pub fn write(film: &Film, settings: &Settings, out: &mut impl Write) -> io::Result<()> {
    let done: Vec<usize> = (0..film.tiles()).filter(|&tile| film.done[tile]).collect();
    let header = format!("{MAGIC}{}done {}\n", settings.to_text(), done.len());
    write!(out, "{header}check {:08x}\n\n", checksum(header.as_bytes()))?;
    let mut record = Vec::new();
    for tile in done {
        record.clear();
        record.extend_from_slice(&(tile as u32).to_le_bytes());
        for value in film.take(tile).iter().flatten() {
            record.extend_from_slice(&value.to_le_bytes());
        }
        record.extend_from_slice(&checksum(&record).to_le_bytes());
        out.write_all(&record)?;
    }
    Ok(())
}

impl Part {
    /// Reads a part whose film takes at most `max_bytes` of memory. Give it a buffered reader.
    ///
    /// # Errors
    /// [`PartError`].
    pub fn read(input: &mut impl Read, max_bytes: u64) -> Result<Self, PartError> {
        let (header, sum) = header(input)?;
        let damaged = |what: &str| PartError::Damaged(what.to_owned());
        if sum != format!("{:08x}", checksum(header.as_bytes())) {
            return Err(damaged("its header was altered"));
        }
        let body = &header[MAGIC.len()..];
        let (settings, done) =
            Settings::from_text(body).ok_or_else(|| damaged("its header makes no sense"))?;
        let needed = settings.film_bytes();
        if needed > max_bytes {
            return Err(PartError::TooLarge { needed, limit: max_bytes });
        }
        let mut film = settings.empty_film();
        if done > film.tiles() {
            return Err(damaged("it claims more tiles than there are"));
        }
        for _ in 0..done {
            tile(&mut film, input)?;
        }
        match input.read(&mut [0]) {
            Ok(0) => Ok(Self { settings, film }),
            Ok(_) => Err(damaged("something follows its last tile")),
            Err(error) => Err(error.into()),
        }
    }
}

/// The header up to its checksum, and that checksum.
fn header(input: &mut impl Read) -> Result<(String, String), PartError> {
    let mut text = vec![0; MAGIC.len()];
    let whole = fill(input, &mut text)?;
    if !whole || text != MAGIC.as_bytes() {
        let kin = whole && text.starts_with(b"phong part ");
        return Err(if kin { PartError::Version } else { PartError::Unknown });
    }
    while !text.ends_with(b"\n\n") {
        let mut byte = [0];
        if text.len() > MAX_HEADER || !fill(input, &mut byte)? {
            return Err(PartError::Damaged("its header has no end".to_owned()));
        }
        text.push(byte[0]);
    }
    let text = String::from_utf8_lossy(&text);
    let split = text.strip_suffix("\n\n").and_then(|text| text.rsplit_once("check "));
    let (header, sum) =
        split.ok_or_else(|| PartError::Damaged("its header has no checksum".to_owned()))?;
    Ok((header.to_owned(), sum.to_owned()))
}

fn tile(film: &mut Film, input: &mut impl Read) -> Result<(), PartError> {
    let cut = || PartError::Damaged("it ends in the middle of a tile".to_owned());
    let mut number = [0; 4];
    if !fill(input, &mut number)? {
        return Err(cut());
    }
    let index = u32::from_le_bytes(number) as usize;
    if film.done.get(index) != Some(&false) {
        return Err(PartError::Damaged(format!("tile {index} is out of place")));
    }
    let window = film.tile_window(index);
    let pixels = window.width() as usize * window.height() as usize;
    let values = |layer: &Layer| pixels * layer.kind.channels();
    let lengths: Vec<usize> = film.layers.iter().map(values).collect();
    let mut record = number.to_vec();
    record.resize(4 + 4 * lengths.iter().sum::<usize>(), 0);
    let mut sum = [0; 4];
    if !fill(input, &mut record[4..])? || !fill(input, &mut sum)? {
        return Err(cut());
    }
    if checksum(&record) != u32::from_le_bytes(sum) {
        return Err(PartError::Damaged(format!("tile {index} was altered")));
    }
    let mut floats =
        record[4..].chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]]));
    let layers: Vec<Vec<f32>> =
        lengths.into_iter().map(|length| floats.by_ref().take(length).collect()).collect();
    film.put(index, &layers);
    Ok(())
}

/// Fills the buffer; false where the input ends before.
fn fill(input: &mut impl Read, buffer: &mut [u8]) -> io::Result<bool> {
    match input.read_exact(buffer) {
        Ok(()) => Ok(true),
        Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => Ok(false),
        Err(error) => Err(error),
    }
}

#[cfg(test)]
mod tests;
