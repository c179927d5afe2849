//! PNG: what is looked at.

#![expect(clippy::needless_bitwise_bool, reason = "a branch for each value would cost more")]

use std::borrow::Cow;
use std::io::{Cursor, Write};
use std::ops::Range;

use phong_bvh::Level;
use phong_scene::Rgb;
use png::{
    BitDepth, ColorType, Compression, PixelDimensions, ScaledFloat, SrgbRenderingIntent,
    Transformations, Unit,
};
use rayon::prelude::*;

use super::curve::{Curve, LinearLevels, linear_level};
use super::picture::{MAX_VALUES, Picture, Plane, ReadError, Transfer, count, within};
use super::{Bits, Encoding, WriteError};
use crate::aov::Aov;
use crate::film::{LayerKind, Window};
use crate::finish::{Finished, ToneMap};

/// Bytes of levels that are encoded at a time, and of a chunk of the file, at most.
const BAND: usize = 1 << 18;

/// How the values of a layer become levels.
struct Coding<'a> {
    /// What the values are multiplied by first.
    gain: f32,
    /// What becomes of a colour in place of that; `None`: no more than that.
    tone: Option<&'a ToneMap>,
    bits: Bits,
    /// `None`: values are scaled as they are.
    curve: Option<&'static Curve>,
    /// Straight alpha, and what the values are to be divided by.
    alpha: Option<&'a [f32]>,
}

/// Writes one layer; the picture with its alpha where any pixel is not wholly covered.
///
/// Colours (the picture, the terms, `albedo`) go through the curve. `normal` is ½ + ½n, `uv` is
/// (u, v, 0), `shadow` and `openness` the share, all without the curve. `object`, `material` and `cost` are grey
/// levels of 16 bits that *are* the number. `depth` is the nearest depth ÷ depth in 16 bits: 1 the
/// nearest, 0 nothing; `position` runs from 0 to 1 along each side of the box of all positions.
/// Where the very values matter, EXR and PFM have them.
pub(super) fn write(
    picture: &Finished<'_>,
    kind: LayerKind,
    encoding: Encoding,
    out: &mut impl Write,
) -> Result<(), WriteError> {
    let layer = |kind: LayerKind| {
        let missing = || WriteError::Unsuitable(format!("the film has no layer {}", kind.name()));
        picture.beneath(kind).ok_or_else(missing)
    };
    let (values, film) = (layer(kind)?, picture.film());
    let curve = match (encoding.linear, encoding.bits) {
        (true, _) => None,
        (false, Bits::Eight) => Some(Curve::eight()),
        (false, Bits::Sixteen) => Some(Curve::sixteen()),
    };
    let plain = Coding { gain: 1.0, tone: None, bits: encoding.bits, curve: None, alpha: None };
    let number = Coding { bits: Bits::Sixteen, ..plain };
    let (values, coding): (Cow<'_, [f32]>, _) = match kind {
        LayerKind::Picture => {
            let (gain, tone) = gain_or_more(picture.tone());
            let alpha = layer(LayerKind::Alpha).ok();
            // All of a piece, without a branch for each.
            let is_whole = |piece: &[f32]| piece.iter().fold(true, |all, &a| all & (a == 1.0));
            let alpha = alpha.filter(|alpha| !alpha.chunks(4096).all(is_whole));
            (values.into(), Coding { gain, tone, curve, alpha, ..plain })
        }
        LayerKind::Term(_)
        | LayerKind::Light(_)
        | LayerKind::Unlit
        | LayerKind::Aov(Aov::Albedo) => (values.into(), Coding { curve, ..plain }),
        LayerKind::Alpha | LayerKind::Aov(Aov::Shadow | Aov::Openness) => (values.into(), plain),
        LayerKind::Aov(Aov::Normal) => (values.iter().map(|n| 0.5 + 0.5 * n).collect(), plain),
        LayerKind::Aov(Aov::Uv) => {
            (values.chunks_exact(2).flat_map(|uv| [uv[0], uv[1], 0.0]).collect(), plain)
        }
        LayerKind::Aov(Aov::Position) => (in_box(values), plain),
        LayerKind::Aov(Aov::Depth) => {
            let nearest = values.iter().copied().fold(f32::INFINITY, f32::min);
            (values.iter().map(|depth| nearest / depth).collect(), number)
        }
        LayerKind::Aov(Aov::Object | Aov::Material | Aov::Cost) => {
            (values.iter().map(|number| number / 65535.0).collect(), number)
        }
    };
    let grey = kind.channels() == 1;
    let color = match (grey, coding.alpha) {
        (true, _) => ColorType::Grayscale,
        (false, None) => ColorType::Rgb,
        (false, Some(_)) => ColorType::Rgba,
    };
    let mut encoder = png::Encoder::new(out, film.width(), film.height());
    encoder.set_color(color);
    encoder.set_depth(match coding.bits {
        Bits::Eight => BitDepth::Eight,
        Bits::Sixteen => BitDepth::Sixteen,
    });
    if coding.curve.is_some() {
        encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
    } else {
        encoder.set_source_gamma(ScaledFloat::from_scaled(100_000));
    }
    encoder.set_compression(Compression::Fast);
    for (keyword, text) in picture.origin().into_iter().flatten() {
        encoder.add_text_chunk(keyword.to_owned(), text).map_err(encoding_error)?;
    }
    if let Some(dpi) = picture.dpi() {
        let a_meter = (dpi / 0.0254).round().clamp(1.0, f64::from(i32::MAX)) as u32;
        encoder.set_pixel_dims(Some(PixelDimensions {
            xppu: a_meter,
            yppu: a_meter,
            unit: Unit::Meter,
        }));
    }
    let mut writer = encoder.write_header().map_err(encoding_error)?;
    // Rows are encoded as they are needed, so that beside the film there is never a second picture.
    let mut rows = writer.stream_writer_with_size(BAND).map_err(encoding_error)?;
    let (width, height) = (film.width() as usize, film.height() as usize);
    let step = (BAND / (8 * width)).max(1);
    for first in (0..height).step_by(step) {
        let band = first..height.min(first + step);
        let mut levels = levels(&values, if grey { 1 } else { 3 }, width, band.clone(), &coding);
        if kind == LayerKind::Picture {
            cover(&mut levels, band, picture, &coding);
        }
        rows.write_all(&levels)?;
    }
    rows.finish().map_err(encoding_error)?;
    writer.finish().map_err(encoding_error)
}

/// What a PNG of 8 bits holds of the picture: red, green, blue and straight alpha of each pixel, rows
/// from top to bottom, by the sRGB curve unless `encoding` is linear. Its `bits` are not looked at.
pub fn srgb8(picture: &Finished<'_>, encoding: &Encoding) -> Vec<u8> {
    let film = picture.film();
    let values = picture.beneath(LayerKind::Picture).unwrap_or_default();
    let opaque = || vec![1.0; values.len() / 3].into();
    let alpha: Cow<'_, [f32]> =
        picture.beneath(LayerKind::Alpha).map_or_else(opaque, Cow::Borrowed);
    let curve = (!encoding.linear).then(Curve::eight);
    let (gain, tone) = gain_or_more(picture.tone());
    let coding = Coding { gain, tone, bits: Bits::Eight, curve, alpha: Some(&alpha) };
    let rows = 0..film.height() as usize;
    let mut levels = levels(values, 3, film.width() as usize, rows.clone(), &coding);
    cover(&mut levels, rows, picture, &coding);
    levels
}

/// Lays what covers the picture over the levels of some of its rows.
fn cover(levels: &mut [u8], rows: Range<usize>, picture: &Finished<'_>, coding: &Coding<'_>) {
    let whole = picture.film().window;
    let [y0, y1] = [rows.start, rows.end].map(|row| whole.y0 + row as u32);
    let part = Window { y0, y1, ..whole };
    for patch in picture.patches() {
        patch.over_levels(
            part,
            levels,
            coding.alpha.is_some(),
            coding.bits.bytes(),
            coding.curve.is_none(),
        );
    }
}

/// The factor that tone is; or 1, and the tone that is more than a factor.
fn gain_or_more(tone: &ToneMap) -> (f32, Option<&ToneMap>) {
    tone.only_gain().map_or((1.0, Some(tone)), |gain| (gain, None))
}

/// The levels of some rows of pixels, as the bytes a PNG holds.
fn levels(
    values: &[f32],
    channels: usize,
    width: usize,
    rows: Range<usize>,
    coding: &Coding<'_>,
) -> Vec<u8> {
    let bytes = coding.bits.bytes();
    let pixel_bytes = (channels + usize::from(coding.alpha.is_some())) * bytes;
    let mut out = vec![0_u8; rows.len() * width * pixel_bytes];
    out.par_chunks_exact_mut(width * pixel_bytes).enumerate().for_each(|(y, row)| {
        let first = (rows.start + y) * width;
        if coding.alpha.is_none() && coding.tone.is_none() && bytes == 1 {
            // The usual picture: nothing to divide, and a byte a value.
            let values = &values[first * channels..][..row.len()];
            match coding.curve {
                Some(curve) => {
                    let levels = values.iter().map(|value| value * coding.gain);
                    row.iter_mut().zip(levels).for_each(|(to, v)| *to = curve.level(v) as u8);
                }
                None => Level::detect().run(LinearLevels { values, gain: coding.gain, to: row }),
            }
            return;
        }
        let mut sink = row.iter_mut();
        let mut put = |level: u16| {
            if bytes == 2 {
                sink.by_ref().zip(level.to_be_bytes()).for_each(|(to, from)| *to = from);
            } else if let Some(to) = sink.next() {
                *to = level as u8;
            }
        };
        let highest = if bytes == 1 { 255 } else { 65535 };
        for i in first..first + width {
            let alpha = coding.alpha.map_or(1.0, |alpha| alpha[i]);
            let mut put_value = |value: f32| {
                put(coding
                    .curve
                    .map_or_else(|| linear_level(value, highest), |curve| curve.level(value)));
            };
            let straight = |value: f32| if alpha > 0.0 { value / alpha } else { 0.0 };
            match (coding.tone, &values[i * channels..][..channels]) {
                (Some(tone), &[r, g, b]) => {
                    let color = tone.steps(Rgb::from([r, g, b].map(straight))).last();
                    color.to_array().into_iter().for_each(&mut put_value);
                }
                (_, values) => {
                    let values = values.iter().map(|&value| straight(value) * coding.gain);
                    values.for_each(&mut put_value);
                }
            }
            if coding.alpha.is_some() {
                put(linear_level(alpha, highest));
            }
        }
    });
    out
}

/// Positions within the box of them all: 0 to 1 along each side.
fn in_box(values: &[f32]) -> Cow<'_, [f32]> {
    let (mut min, mut max) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for position in values.chunks_exact(3) {
        for axis in 0..3 {
            min[axis] = min[axis].min(position[axis]);
            max[axis] = max[axis].max(position[axis]);
        }
    }
    let place = |(i, v): (usize, &f32)| (v - min[i % 3]) / (max[i % 3] - min[i % 3]);
    values.iter().enumerate().map(place).collect()
}

fn encoding_error(error: png::EncodingError) -> WriteError {
    match error {
        png::EncodingError::IoError(error) => WriteError::Io(error),
        other => WriteError::Unsuitable(format!("PNG: {other}")),
    }
}

/// Reads a PNG of any kind; palettes and few bits are spread out.
pub(super) fn read(bytes: &[u8], max_bytes: u64) -> Result<Picture, ReadError> {
    let broken = |error: png::DecodingError| ReadError::Broken(format!("PNG: {error}"));
    let most = usize::try_from(4 * MAX_VALUES).unwrap_or(usize::MAX);
    let limits = png::Limits { bytes: most };
    let mut decoder = png::Decoder::new_with_limits(Cursor::new(bytes), limits);
    decoder.set_transformations(Transformations::EXPAND);
    let mut reader = decoder.read_info().map_err(broken)?;
    let (width, height) = (reader.info().width, reader.info().height);
    count(width, height, 4)?;
    let size = reader.output_buffer_size().ok_or(ReadError::TooLarge { width, height })?;
    let (_, depth) = reader.output_color_type();
    let line = reader.output_line_size(width).unwrap_or(usize::MAX) as u64;
    let value = if depth == BitDepth::Sixteen { 2 } else { 1 };
    let values = line / (u64::from(width) * value).max(1);
    within([width, height], values * (value + size_of::<f32>() as u64), max_bytes)?;
    let mut data = vec![0; size];
    let frame = reader.next_frame(&mut data).map_err(broken)?;
    let linear = reader.info().srgb.is_none()
        && reader.info().gama_chunk.is_some_and(|gamma| gamma.into_scaled() == 100_000);
    let levels = match (reader.info().color_type, reader.info().bit_depth) {
        (ColorType::Indexed, _) | (_, BitDepth::Eight) => 255,
        (_, BitDepth::One) => 1,
        (_, BitDepth::Two) => 3,
        (_, BitDepth::Four) => 15,
        (_, BitDepth::Sixteen) => 65535,
    };
    let names: &[&str] = match frame.color_type {
        ColorType::Grayscale => &["Y"],
        ColorType::GrayscaleAlpha => &["Y", "A"],
        ColorType::Rgb => &["R", "G", "B"],
        ColorType::Rgba | ColorType::Indexed => &["R", "G", "B", "A"],
    };
    let n = names.len();
    let value = |i: usize| match frame.bit_depth {
        BitDepth::Sixteen => {
            f32::from(u16::from_be_bytes([data[2 * i], data[2 * i + 1]])) / 65535.0
        }
        _ => f32::from(data[i]) / 255.0,
    };
    let pixels = width as usize * height as usize;
    let plane = |(c, name): (usize, &&str)| Plane {
        name: (*name).to_owned(),
        values: (0..pixels).map(|i| value(i * n + c)).collect(),
    };
    Ok(Picture {
        size: [width, height],
        planes: names.iter().enumerate().map(plane).collect(),
        transfer: if linear { Transfer::Linear } else { Transfer::Srgb },
        levels: Some(levels),
        lossy: None,
    })
}
