//! Every layer of a film as 32-bit floats, in one part, ZIP-compressed by 16 rows.
//!
//! After the format's description (openexr.com, *OpenEXR File Layout* and *Technical Introduction*).

use std::borrow::Cow;
use std::io::{Seek, SeekFrom, Write};
use std::ops::Range;

use flate2::Compression;
use flate2::write::ZlibEncoder;
use rayon::prelude::*;

use crate::aov::Aov;
use crate::film::{Film, LayerKind};
use crate::finish::Finished;
use crate::image::WriteError;

/// How a file begins, and that it is of version 2, in which names have at most 31 bytes.
const MAGIC: [u8; 8] = [0x76, 0x2f, 0x31, 0x01, 2, 0, 0, 0];
/// Rows that are compressed together.
const ROWS: usize = 16;
/// Of so many bytes blocks of rows are compressed side by side, or one of more. Beside each stands what it
/// becomes.
const AT_ONCE: usize = 64 << 20;
/// Rec. 709: the primaries of sRGB, with white D65.
const REC_709: [f32; 8] = [0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290];

/// One channel, as the film has it.
struct Channel<'a> {
    name: String,
    /// `None`: it is 1 everywhere.
    values: Option<&'a [f32]>,
    /// Values a pixel, and which of them.
    stride: usize,
    index: usize,
}

/// Writes all layers: `R G B A`, `finished.R` where anything but exposure finishes the picture, `diffuse.R`,
/// `normal.X`, `uv.U`, `depth`, … Premultiplied light, linear; only in `finished` have exposure, white balance and curve
/// changed it.
pub(in crate::image) fn write(
    picture: &Finished<'_>,
    out: &mut (impl Write + Seek),
) -> Result<(), WriteError> {
    let film = picture.film();
    let [width, height] = [film.width() as usize, film.height() as usize];
    let finished = picture.toned();
    let channels = channels(picture, finished.as_ref());
    let begin = out.stream_position()?;
    let mut head = header(picture, &channels, [film.width(), film.height()])?;
    // Where each block of rows is stands before them, and is known after them.
    let table = head.len();
    let blocks = height.div_ceil(ROWS);
    head.resize(table + 8 * blocks, 0);
    out.write_all(&head)?;
    let mut offsets = Vec::with_capacity(8 * blocks);
    let mut at = head.len() as u64;
    let wave = wave(width, channels.len(), rayon::current_num_threads());
    for first in (0..blocks).step_by(wave) {
        let packed = (first..blocks.min(first + wave)).into_par_iter().map(|block| {
            let rows = block * ROWS..height.min((block + 1) * ROWS);
            Ok((rows.start, packed(&channels, width, rows)?))
        });
        for (row, bytes) in packed.collect::<Result<Vec<_>, WriteError>>()? {
            offsets.extend(at.to_le_bytes());
            out.write_all(&whole(row)?.to_le_bytes())?;
            out.write_all(&whole(bytes.len())?.to_le_bytes())?;
            out.write_all(&bytes)?;
            at += 8 + bytes.len() as u64;
        }
    }
    out.seek(SeekFrom::Start(begin + table as u64))?;
    out.write_all(&offsets)?;
    out.seek(SeekFrom::Start(begin + at))?;
    Ok(())
}

/// How many blocks of rows are compressed side by side: enough for all threads, but of at most so many bytes.
fn wave(width: usize, channels: usize, threads: usize) -> usize {
    let block = 4_usize.saturating_mul(ROWS * channels).saturating_mul(width).max(1);
    (AT_ONCE / block).clamp(1, 2 * threads.max(1))
}

/// All channels, by their names.
fn channels<'a>(
    picture: &'a Finished<'_>,
    finished: Option<&'a [Cow<'_, [f32]>; 2]>,
) -> Vec<Channel<'a>> {
    let film = picture.film();
    let mut list = Vec::new();
    let mut add = |name: String, values, stride, index| {
        list.push(Channel { name, values, stride, index });
    };
    for layer in &film.layers {
        let stride = layer.kind.channels();
        for (channel, name) in channel_names(layer.kind).into_iter().enumerate() {
            add(name, Some(&*layer.values), stride, channel);
        }
    }
    if let Some([picture, alpha]) = finished {
        for (channel, name) in ["R", "G", "B"].into_iter().enumerate() {
            add(format!("finished.{name}"), Some(picture), 3, channel);
        }
        add("finished.A".to_owned(), Some(alpha), 1, 0);
    }
    if film.layer(LayerKind::Alpha).is_none() {
        add("A".to_owned(), None, 1, 0);
    }
    list.sort_by(|a, b| a.name.cmp(&b.name));
    list
}

/// Everything before the table of blocks.
fn header(
    picture: &Finished<'_>,
    channels: &[Channel<'_>],
    size: [u32; 2],
) -> Result<Vec<u8>, WriteError> {
    let mut head = MAGIC.to_vec();
    let mut list = Vec::new();
    for Channel { name, .. } in channels {
        list.extend(name.as_bytes());
        // 32-bit floats, of which each pixel has one.
        list.extend([0, 2, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0]);
    }
    list.push(0);
    let right = whole(size[0] as usize)? - 1;
    let bottom = whole(size[1] as usize)? - 1;
    let window: Vec<u8> = [0, 0, right, bottom].into_iter().flat_map(i32::to_le_bytes).collect();
    let primaries: Vec<u8> = REC_709.into_iter().flat_map(f32::to_le_bytes).collect();
    let mut attribute = |name: &str, kind: &str, value: &[u8]| {
        head.extend([name.as_bytes(), &[0], kind.as_bytes(), &[0]].concat());
        head.extend((value.len() as u32).to_le_bytes());
        head.extend(value);
    };
    attribute("channels", "chlist", &list);
    attribute("chromaticities", "chromaticities", &primaries);
    attribute("compression", "compression", &[3]); // ZIP by 16 rows
    attribute("dataWindow", "box2i", &window);
    attribute("displayWindow", "box2i", &window);
    attribute("lineOrder", "lineOrder", &[0]); // from top to bottom
    attribute("pixelAspectRatio", "float", &1.0_f32.to_le_bytes());
    attribute("screenWindowCenter", "v2f", &[0; 8]);
    attribute("screenWindowWidth", "float", &1.0_f32.to_le_bytes());
    let [software, scene, whole] = picture.origin().map(|said| said.map(|(_, text)| text));
    let said = [("software", software), ("scene", scene), ("picture", whole)];
    for (name, text) in said {
        if let Some(text) = text {
            attribute(name, "string", text.as_bytes());
        }
    }
    for (name, text) in sampled(picture.film()) {
        attribute(name, "string", text.as_bytes());
    }
    head.push(0);
    Ok(head)
}

/// Rows, channel after channel in each, as the file has them.
fn packed(
    channels: &[Channel<'_>],
    width: usize,
    rows: Range<usize>,
) -> Result<Vec<u8>, WriteError> {
    let size = 4 * width * channels.len() * rows.len();
    // Bytes at even places first, then those at odd ones: what changes little stands together.
    let mut apart = vec![0_u8; size];
    let (even, odd) = apart.split_at_mut(size / 2);
    let mut at = 0;
    for row in rows.clone() {
        for channel in channels {
            for value in channel.row(width, row) {
                let [a, b, c, d] = value.to_le_bytes();
                even[at..at + 2].copy_from_slice(&[a, c]);
                odd[at..at + 2].copy_from_slice(&[b, d]);
                at += 2;
            }
        }
    }
    // Each byte by how it differs from the one before.
    let mut before = apart.first().copied().unwrap_or(0);
    for byte in apart.iter_mut().skip(1) {
        let now = *byte;
        *byte = now.wrapping_sub(before).wrapping_add(128);
        before = now;
    }
    let mut encoder = ZlibEncoder::new(Vec::with_capacity(size / 2), Compression::new(4));
    encoder.write_all(&apart)?;
    let packed = encoder.finish()?;
    if packed.len() < size {
        return Ok(packed);
    }
    // Who reads it sees by its size that it is not compressed.
    let values = rows.flat_map(|row| channels.iter().flat_map(move |c| c.row(width, row)));
    Ok(values.flat_map(f32::to_le_bytes).collect())
}

impl Channel<'_> {
    /// The values of a row.
    fn row(&self, width: usize, row: usize) -> impl Iterator<Item = f32> {
        (row * width..(row + 1) * width)
            .map(|pixel| self.values.map_or(1.0, |values| values[pixel * self.stride + self.index]))
    }
}

/// A number as the file has it.
fn whole(number: usize) -> Result<i32, WriteError> {
    i32::try_from(number)
        .map_err(|_| WriteError::Unsuitable("the picture is too large for OpenEXR".to_owned()))
}

/// Which layers are the mean of a pixel's samples, and which are of the ray through its centre alone:
/// the attributes `averaged` and `pixelCenter`, names between commas.
fn sampled(film: &Film) -> impl Iterator<Item = (&'static str, String)> {
    let names = |averaged: bool| -> Vec<_> {
        let kinds = film.layers.iter().map(|layer| layer.kind);
        kinds.filter(|kind| kind.is_averaged() == averaged).map(LayerKind::name).collect()
    };
    [("averaged", names(true)), ("pixelCenter", names(false))]
        .into_iter()
        .filter(|(_, names)| !names.is_empty())
        .map(|(name, names)| (name, names.join(",")))
}

fn channel_names(kind: LayerKind) -> Vec<String> {
    let of = |axes: &[&str]| axes.iter().map(|axis| format!("{}.{axis}", kind.name())).collect();
    match kind {
        LayerKind::Picture => ["R", "G", "B"].map(str::to_owned).to_vec(),
        LayerKind::Alpha => vec!["A".to_owned()],
        LayerKind::Term(_)
        | LayerKind::Light(_)
        | LayerKind::Unlit
        | LayerKind::Aov(Aov::Albedo) => of(&["R", "G", "B"]),
        LayerKind::Aov(Aov::Normal | Aov::Position) => of(&["X", "Y", "Z"]),
        LayerKind::Aov(Aov::Uv) => of(&["U", "V"]),
        LayerKind::Aov(_) => vec![kind.name().into_owned()],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_that_are_compressed_side_by_side_have_no_more_bytes_than_are_allowed() {
        assert_eq!(wave(640, 4, 2), 4, "two for each thread");
        assert_eq!(wave(3840, 60, 64), 4, "14.7 MB each");
        assert_eq!(wave(10_000_000, 60, 64), 1, "one there must be");
    }
}
