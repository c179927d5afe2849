//! JPEG: read only, for pictures that were handed in as such.

use std::io::Cursor;

use zune_jpeg::JpegDecoder;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

use super::picture::{Lossy, MAX_VALUES, Picture, Plane, ReadError, Transfer, count, within};

/// Bytes that a pixel takes at most: coefficients of a progressive file, bytes, and floats.
const PIXEL: u64 = 3 * (2 + 2 + 1 + 4);

/// Reads a JPEG, baseline or progressive, in colour or grey.
pub(super) fn read(bytes: &[u8], max_bytes: u64) -> Result<Picture, ReadError> {
    let broken = |what: String| ReadError::Broken(format!("JPEG: {what}"));
    let most = MAX_VALUES as usize / 4;
    let options = DecoderOptions::default()
        .jpeg_set_out_colorspace(ColorSpace::RGB)
        .set_max_width(most)
        .set_max_height(most);
    let mut decoder = JpegDecoder::new_with_options(Cursor::new(bytes), options);
    decoder.decode_headers().map_err(|error| broken(error.to_string()))?;
    let info = decoder.info().ok_or_else(|| broken("it has no size".to_owned()))?;
    let (width, height) = (u32::from(info.width), u32::from(info.height));
    count(width, height, 4)?;
    within([width, height], PIXEL, max_bytes)?;
    let data = decoder.decode().map_err(|error| broken(error.to_string()))?;
    let pixels = width as usize * height as usize;
    if data.len() != 3 * pixels {
        return Err(broken(format!("{} values, not {}", data.len(), 3 * pixels)));
    }
    let plane = |(c, name): (usize, &&str)| Plane {
        name: (*name).to_owned(),
        values: data.iter().skip(c).step_by(3).map(|&level| f32::from(level) / 255.0).collect(),
    };
    Ok(Picture {
        size: [width, height],
        planes: ["R", "G", "B"].iter().enumerate().map(plane).collect(),
        transfer: Transfer::Srgb,
        levels: Some(255),
        lossy: Some(lossy(bytes)),
    })
}

/// The order in which a block's coefficients are stored: each diagonal in turn, from the corner.
fn zigzag() -> [usize; 64] {
    let mut order: Vec<usize> = (0..64).collect();
    order.sort_by_key(|&i| {
        let (row, column) = (i / 8, i % 8);
        let along = if (row + column) % 2 == 0 { column } else { row };
        (row + column, along)
    });
    std::array::from_fn(|k| order[k])
}

/// The quantisation, as the file's headers tell it; what they do not tell is taken to be coarse.
fn lossy(bytes: &[u8]) -> Lossy {
    let order = zigzag();
    let mut tables = [[16_u16; 64]; 4];
    let mut used = [0, 1];
    let mut block = [8, 8];
    let mut at = 2;
    while let Some([0xff, marker, high, low]) = bytes.get(at..at + 4) {
        let length = usize::from(u16::from_be_bytes([*high, *low]));
        let segment = bytes.get(at + 4..at + 2 + length).unwrap_or_default();
        match marker {
            // Tables of quantisation, one after the other.
            0xdb => {
                let mut rest = segment;
                while let [head, tail @ ..] = rest {
                    let wide = usize::from(head >> 4 != 0) + 1;
                    let Some(values) = tail.get(..64 * wide) else { break };
                    let table = &mut tables[usize::from(head & 3)];
                    for (&place, value) in order.iter().zip(values.chunks_exact(wide)) {
                        table[place] =
                            value.iter().fold(0, |sum, byte| sum << 8 | u16::from(*byte));
                    }
                    rest = &tail[64 * wide..];
                }
            }
            // The frame: the components with their sampling and their tables.
            0xc0..=0xc2 => {
                let components: Vec<&[u8]> =
                    segment.get(6..).unwrap_or_default().chunks_exact(3).collect();
                for (which, component) in components.iter().enumerate().take(2) {
                    used[which] = usize::from(component[2] & 3);
                }
                let most = |shift: u32| {
                    let sampling = components.iter().map(|c| (c[1] >> shift) & 15);
                    8 * sampling.max().unwrap_or(1).clamp(1, 4)
                };
                block = if components.len() > 1 { [most(4), most(0)] } else { block };
            }
            // The picture itself.
            0xda => break,
            _ => {}
        }
        at += 2 + length;
    }
    Lossy { steps: used.map(|which| tables[which]), block }
}
