//! Radiance HDR: three floats a pixel that share an exponent.

use std::io::Cursor;

use zune_hdr::HdrDecoder;
use zune_jpeg::zune_core::options::DecoderOptions;

use super::allowed::allow;
use super::{TexelValues, Texels};
use crate::limits::Limits;

/// The largest side that a header may say: the pixels are counted besides.
const MOST_SIDE: usize = 1 << 20;

/// The pixels, or a clause that says what is wrong; `warn` is told of colours that are not those they are drawn as.
pub(super) fn decode(
    bytes: &[u8],
    limits: &Limits,
    warn: &mut dyn FnMut(String),
) -> Result<Texels, String> {
    let Header { axes, exposure, pixels } = Header::read(bytes, warn)?;
    let [lines, length] = axes.map(|axis| axis.count);
    let size = if axes[0].is_y { [length, lines] } else { [lines, length] };
    let is_upright = axes[0].is_y && !axes[0].is_turned && !axes[1].is_turned;
    // What is not upright is there twice for a moment.
    allow(size, if is_upright { 3 * 4 } else { 2 * 3 * 4 }, limits)?;
    // The decoder knows rows from the top alone, and takes the pixels to be RGB: it is told so.
    let plain = format!("#?RADIANCE\nFORMAT={RGBE}\n\n-Y {lines} +X {length}\n");
    let options = DecoderOptions::default().set_max_width(MOST_SIDE).set_max_height(MOST_SIDE);
    let file = [plain.as_bytes(), pixels].concat();
    let mut values = HdrDecoder::new_with_options(Cursor::new(file), options)
        .decode()
        .map_err(|error| broken(&format!("{error:?}")))?;
    if !is_upright {
        values = upright(&values, axes, size);
    }
    if exposure != [1.0; 3] {
        for pixel in values.chunks_exact_mut(3) {
            pixel.iter_mut().zip(exposure).for_each(|(value, by)| *value /= by);
        }
    }
    Texels::new(size, 3, TexelValues::Floats(values)).map_err(|error| error.to_string())
}

fn broken(what: &str) -> String {
    format!("it is a broken HDR: {what}")
}

/// Pixels of lines along `axes` as rows from the top.
fn upright(values: &[f32], axes: [Axis; 2], [width, height]: [u32; 2]) -> Vec<f32> {
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
    let at = |[x, y]: [u32; 2]| {
        let [line, place] = axes.map(|axis| {
            let from = if axis.is_y { y } else { x };
            (if axis.is_turned { axis.count - 1 - from } else { from }) as usize
        });
        let at = 3 * (line * axes[1].count as usize + place);
        &values[at..at + 3]
    };
    pixels.flat_map(at).copied().collect()
}

/// The name of the only format of pixels that is read.
const RGBE: &str = "32-bit_rle_rgbe";

/// Where Rec. 709 has red, green, blue and white, as x and y each.
const REC_709: [f32; 8] = [0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329];

/// By how much what files round differs.
const ROUNDED: f32 = 0.002;

/// What stands before the pixels.
struct Header<'a> {
    /// That along which the lines follow one another, and that of each line.
    axes: [Axis; 2],
    /// What red, green and blue have been multiplied by.
    exposure: [f32; 3],
    pixels: &'a [u8],
}

/// One of `-Y 8 +X 16`.
#[derive(Clone, Copy)]
struct Axis {
    is_y: bool,
    /// Whether it runs from the bottom or from the right.
    is_turned: bool,
    count: u32,
}

impl<'a> Header<'a> {
    fn read(mut rest: &'a [u8], warn: &mut dyn FnMut(String)) -> Result<Self, String> {
        let mut exposure = [1.0; 3];
        loop {
            let line = line(&mut rest)?;
            let number =
                |text: &str| text.parse::<f32>().ok().filter(|n| n.is_finite() && *n > 0.0);
            let by = match line.split_once('=') {
                _ if line.is_empty() => break,
                Some(("FORMAT", format)) if format.trim() != RGBE => {
                    let format = format.trim();
                    return Err(format!(
                        "it is an HDR of the unsupported format `{format}`: `{RGBE}` is read"
                    ));
                }
                Some(("EXPOSURE", by)) => number(by.trim()).map(|by| [by; 3]),
                Some(("COLORCORR", by)) => {
                    let by: Option<Vec<f32>> = by.split_whitespace().map(number).collect();
                    by.and_then(|by| by.try_into().ok())
                }
                Some(("PRIMARIES", places)) => {
                    let places: Option<Vec<f32>> =
                        places.split_whitespace().map(|text| text.parse().ok()).collect();
                    let near = |(said, known): (&f32, f32)| (said - known).abs() <= ROUNDED;
                    let is_known = |places: Vec<f32>| {
                        places.len() == REC_709.len() && places.iter().zip(REC_709).all(near)
                    };
                    if !places.is_some_and(is_known) {
                        let drawn = "its colours are drawn as those of Rec. 709";
                        warn(format!("{drawn}, and not by `{line}`"));
                    }
                    continue;
                }
                _ => continue,
            };
            let by = by.ok_or_else(|| broken(&format!("`{line}` is no factor above 0")))?;
            exposure.iter_mut().zip(by).for_each(|(all, by)| *all *= by);
        }
        let line = line(&mut rest)?;
        let axes = axes(&line).ok_or_else(|| broken(&format!("`{line}` is no size of it")))?;
        Ok(Self { axes, exposure, pixels: rest })
    }
}

/// The next line, which is taken off.
fn line(rest: &mut &[u8]) -> Result<String, String> {
    let end = rest.iter().position(|&byte| byte == b'\n');
    let end = end.ok_or_else(|| broken("its header has no end"))?;
    let line = String::from_utf8_lossy(&rest[..end]).trim().to_owned();
    *rest = &rest[end + 1..];
    Ok(line)
}

/// What `-Y 8 +X 16` says; `None`: it is no such line.
fn axes(line: &str) -> Option<[Axis; 2]> {
    let mut words = line.split_whitespace();
    let mut axis = || {
        let (is_y, is_turned) = match words.next()? {
            "-Y" => (true, false),
            "+Y" => (true, true),
            "+X" => (false, false),
            "-X" => (false, true),
            _ => return None,
        };
        let count = words.next()?.parse().ok().filter(|&count| count as usize <= MOST_SIDE)?;
        Some(Axis { is_y, is_turned, count })
    };
    let axes = [axis()?, axis()?];
    (axes[0].is_y != axes[1].is_y && words.next().is_none()).then_some(axes)
}
