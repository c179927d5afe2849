//! Part files: a film that is not finished, with all that says what picture it belongs to.
//!
//! One format serves shares, which are put together ([`Join`]), and checkpoints, from which a
//! rendering goes on. A text header ([`Settings`], a name and a value a line) ends in a checksum
//! of itself; then comes a record for each tile, and one that says how many there were. A record is
//! the tile's number, how many samples its pixels have (0: all of them), its layers' values as
//! little-endian floats, where samples are lacking the sums from which it goes on, and a checksum of
//! all that. A cut file or a flipped bit is an error.

mod figure;
mod fingerprint;
mod join;
mod settings;
mod tone;

use std::io::{self, Read, Write};
use std::sync::Arc;

use crc32fast::hash as checksum;
use thiserror::Error;

use crate::film::{Film, FilmTile, LayerKind, Sums8, TileSums, eights_of};
pub use figure::furniture_of;
pub use fingerprint::fingerprint;
pub use join::{Join, JoinError, ReadError};
pub use settings::Settings;

/// The first line of every part file: what it is, and the version of its format.
const MAGIC: &str = "phong part 4\n";

/// The version of the arithmetic. It is raised by every change that moves a bit of any picture, so
/// that no picture is put together from two of them.
pub const ARITHMETIC: u32 = 8;

/// The checksum of the films of some golden scenes, and the version of the arithmetic that it is of: a
/// test draws them. Who moves a bit raises [`ARITHMETIC`] and writes both anew.
#[cfg(test)]
const FILMS: (u32, u32) = (8, 0x1f52_a25a);

/// What stands for a tile's number after the last one.
const END: u64 = u64::MAX;

/// The longest header that is read, in bytes.
const MAX_HEADER: usize = 4 << 20;

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
    /// Its pixels were computed in another way, and do not go together with ours.
    #[error(
        "this part file is of version {theirs} of the arithmetic, this program of {ARITHMETIC}"
    )]
    Arithmetic {
        /// The version of the file.
        theirs: u32,
    },
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

/// Writes a part. Not flushed.
///
/// `tiles` are those of [`Film::film_tiles`], or, while a rendering is under way, what
/// [`Rendering::film_tile`](crate::render::Rendering::film_tile) has of each: they are asked for one
/// after another, so that the rendering is never held up for longer than one takes to copy.
///
/// # Errors
/// As `out` says.
pub fn write(
    tiles: impl IntoIterator<Item = FilmTile>,
    settings: &Settings,
    out: &mut impl Write,
) -> io::Result<()> {
    let header = format!("{MAGIC}arithmetic {ARITHMETIC}\n{}", settings.to_text());
    write!(out, "{header}check {:08x}\n\n", checksum(header.as_bytes()))?;
    let mut record = Vec::new();
    let mut count = 0_u64;
    for FilmTile { index, values, sums } in tiles {
        record.clear();
        record.extend_from_slice(&(index as u64).to_le_bytes());
        let samples = sums.as_ref().map_or(0, |sums| sums.samples());
        record.extend_from_slice(&samples.to_le_bytes());
        for value in values.iter().flatten() {
            record.extend_from_slice(&value.to_le_bytes());
        }
        for value in sums.iter().flat_map(|sums| sums.eights()).flat_map(Sums8::numbers) {
            record.extend_from_slice(&value.to_le_bytes());
        }
        record.extend_from_slice(&checksum(&record).to_le_bytes());
        out.write_all(&record)?;
        count += 1;
    }
    let mut end = [END.to_le_bytes(), count.to_le_bytes()].concat();
    end.extend_from_slice(&checksum(&end).to_le_bytes());
    out.write_all(&end)
}

impl Part {
    /// Reads a part that takes at most `max_bytes` of memory. Give it a buffered reader.
    ///
    /// # Errors
    /// [`PartError`].
    pub fn read(input: &mut impl Read, max_bytes: u64) -> Result<Self, PartError> {
        let settings = read_settings(input, max_bytes)?;
        let mut film = settings.empty_film();
        read_tiles(&settings, input, max_bytes, |tile| film.put_tile(tile))?;
        Ok(Self { settings, film })
    }
}

/// Reads the header of a part whose film takes at most `max_bytes` of memory.
fn read_settings(input: &mut impl Read, max_bytes: u64) -> Result<Settings, PartError> {
    let (header, sum) = header(input)?;
    let damaged = |what: &str| PartError::Damaged(what.to_owned());
    if sum != format!("{:08x}", checksum(header.as_bytes())) {
        return Err(damaged("its header was altered"));
    }
    let senseless = || damaged("its header makes no sense");
    let body = header[MAGIC.len()..].strip_prefix("arithmetic ").ok_or_else(senseless)?;
    let (theirs, body) = body.split_once('\n').ok_or_else(senseless)?;
    let theirs = theirs.parse().map_err(|_| senseless())?;
    if theirs != ARITHMETIC {
        return Err(PartError::Arithmetic { theirs });
    }
    let settings = Settings::from_text(body).ok_or_else(senseless)?;
    within(settings.film_bytes(), max_bytes)?;
    Ok(settings)
}

/// Reads all that follows the header, and gives each tile to `take`.
fn read_tiles(
    settings: &Settings,
    input: &mut impl Read,
    max_bytes: u64,
    mut take: impl FnMut(FilmTile),
) -> Result<(), PartError> {
    let damaged = |what: &str| PartError::Damaged(what.to_owned());
    let mut needed = settings.film_bytes();
    let mut seen = vec![false; settings.tiles()];
    let mut count = 0_u64;
    while let Some(tile) = tile(settings, &mut seen, input)? {
        needed += tile.sums.as_ref().map_or(0, |sums| sums.bytes());
        within(needed, max_bytes)?;
        take(tile);
        count += 1;
    }
    let mut end = [0; 8];
    let mut sum = [0; 4];
    if !fill(input, &mut end)? || !fill(input, &mut sum)? {
        return Err(damaged("it ends before its end"));
    }
    let whole = [END.to_le_bytes(), end].concat();
    if u64::from_le_bytes(end) != count || checksum(&whole) != u32::from_le_bytes(sum) {
        return Err(damaged("its end was altered"));
    }
    match input.read(&mut [0]) {
        Ok(0) => Ok(()),
        Ok(_) => Err(damaged("something follows its end")),
        Err(error) => Err(error.into()),
    }
}

fn within(needed: u64, limit: u64) -> Result<(), PartError> {
    if needed > limit {
        return Err(PartError::TooLarge { needed, limit });
    }
    Ok(())
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

/// The next tile's record; `None` where the last one has been.
fn tile(
    settings: &Settings,
    seen: &mut [bool],
    input: &mut impl Read,
) -> Result<Option<FilmTile>, PartError> {
    let cut = || PartError::Damaged("it ends in the middle of a tile".to_owned());
    let mut number = [0; 8];
    if !fill(input, &mut number)? {
        return Err(cut());
    }
    if number == END.to_le_bytes() {
        return Ok(None);
    }
    let index = u64::from_le_bytes(number) as usize;
    match seen.get_mut(index) {
        Some(seen) if !*seen => *seen = true,
        _ => return Err(PartError::Damaged(format!("tile {index} is out of place"))),
    }
    let mut samples = [0; 4];
    if !fill(input, &mut samples)? {
        return Err(cut());
    }
    let mut record = [&number[..], &samples].concat();
    let samples = u32::from_le_bytes(samples);
    let window = settings.window.tile(settings.tile, index);
    let values = |kind: &LayerKind| window.pixels() as usize * kind.channels();
    let lengths: Vec<usize> = settings.layers.iter().map(values).collect();
    let begin = record.len();
    let middle = begin + 4 * lengths.iter().sum::<usize>();
    let eights = if samples == 0 { 0 } else { eights_of(window) };
    record.resize(middle + 8 * Sums8::NUMBERS * eights, 0);
    let mut sum = [0; 4];
    if !fill(input, &mut record[begin..])? || !fill(input, &mut sum)? {
        return Err(cut());
    }
    if checksum(&record) != u32::from_le_bytes(sum) {
        return Err(PartError::Damaged(format!("tile {index} was altered")));
    }
    let mut floats = record[begin..middle].as_chunks().0.iter().map(|b| f32::from_le_bytes(*b));
    let values: Vec<Vec<f32>> =
        lengths.into_iter().map(|length| floats.by_ref().take(length).collect()).collect();
    let numbers: Vec<f64> =
        record[middle..].as_chunks().0.iter().map(|b| f64::from_le_bytes(*b)).collect();
    let sums: Vec<Sums8> = numbers.chunks_exact(Sums8::NUMBERS).map(Sums8::of_numbers).collect();
    let sums = (samples > 0).then(|| Arc::new(TileSums::new(samples, sums)));
    Ok(Some(FilmTile { index, values, sums }))
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
