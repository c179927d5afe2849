//! Half of an image: the mean of linear values over the place of each pixel.

use std::sync::OnceLock;

use super::{TexelValues, Texels};
use crate::color::{srgb_decode, srgb_encode};

/// The pixels of a row of `from` that a pixel of one of `to` covers, and the weight of each: at most four.
fn covered(from: u32, to: u32, at: u32) -> Vec<(u32, f64)> {
    let scale = f64::from(from) / f64::from(to);
    let (low, high) = (f64::from(at) * scale, f64::from(at + 1) * scale);
    let (first, last) = (low as u32, (high.ceil() as u32).min(from));
    let weight = |i: u32| (high.min(f64::from(i + 1)) - low.max(f64::from(i))) / scale;
    (first..last).map(|i| (i, weight(i))).filter(|&(_, weight)| weight > 0.0).collect()
}

/// The image at half its size; `None`: it is one pixel large.
pub(super) fn half(texels: &Texels, srgb: bool) -> Option<Texels> {
    let [width, height] = texels.size();
    if [width, height] == [1, 1] {
        return None;
    }
    let size = [(width / 2).max(1), (height / 2).max(1)];
    let channels = texels.channels();
    // The channel of red, green, blue and opacity that each of its own is.
    let own: &[usize] = match channels {
        1 => &[0],
        2 => &[0, 3],
        3 => &[0, 1, 2],
        _ => &[0, 1, 2, 3],
    };
    let columns: Vec<_> = (0..size[0]).map(|x| covered(width, size[0], x)).collect();
    let count = size[0] as usize * size[1] as usize * channels;
    if let TexelValues::Bytes(_) = texels.values() {
        let codes = codes();
        let mut bytes = Vec::with_capacity(count);
        each_mean(texels, size, &columns, srgb, |sum| {
            bytes.extend(own.iter().map(|&channel| {
                let value = sum[channel];
                if srgb && channel < 3 { codes.of(value) } else { (value * 255.0 + 0.5) as u8 }
            }));
        });
        return Texels::new(size, channels, TexelValues::Bytes(bytes)).ok();
    }
    let mut means = Vec::with_capacity(count);
    each_mean(texels, size, &columns, srgb, |sum| {
        means.extend(own.iter().map(|&channel| {
            let value = sum[channel];
            if srgb && channel < 3 { encode(value) } else { value }
        }));
    });
    let values = if let TexelValues::Floats(_) = texels.values() {
        TexelValues::Floats(means.iter().map(|&mean| mean as f32).collect())
    } else {
        TexelValues::Shorts(means.iter().map(|mean| (mean * 65535.0 + 0.5) as u16).collect())
    };
    Texels::new(size, channels, values).ok()
}

/// Tells the means over the places of the pixels of an image of this size, row by row.
fn each_mean(
    texels: &Texels,
    size: [u32; 2],
    columns: &[Vec<(u32, f64)>],
    srgb: bool,
    mut tell: impl FnMut([f64; 4]),
) {
    let [width, height] = texels.size();
    let mut pixels: Vec<[f32; 4]> = Vec::new();
    for y in 0..size[1] {
        let rows = covered(height, size[1], y);
        pixels.clear();
        for &(y, _) in &rows {
            pixels.extend((0..width).map(|x| texels.get([x, y], srgb)));
        }
        for columns in columns {
            let mut sum = [0.0_f64; 4];
            for (&(_, down), pixels) in rows.iter().zip(pixels.chunks_exact(width as usize)) {
                for &(x, across) in columns {
                    let weight = down * across;
                    let pixel = pixels[x as usize];
                    sum.iter_mut().zip(pixel).for_each(|(s, v)| *s += weight * f64::from(v));
                }
            }
            tell(sum);
        }
    }
}

/// The sRGB code of a value; of what is beyond 0 to 1 itself.
fn encode(value: f64) -> f64 {
    if (0.0..=1.0).contains(&value) { srgb_encode(value) } else { value }
}

/// The bytes that are the sRGB codes of values, told without a power where there is no doubt.
struct Codes {
    /// The code at each number of [`STEPS`]; before the next there is none, or only the one after it.
    steps: Vec<u8>,
    /// Where each code ends.
    ends: [f64; 256],
}

/// So many steps from 0 to 1.
const STEPS: u16 = 1 << 12;

impl Codes {
    fn new() -> Self {
        let mut ends = std::array::from_fn(|code| srgb_decode((code as f64 + 0.5) / 255.0));
        ends[255] = f64::INFINITY;
        let code = |step| {
            let value = f64::from(step) / f64::from(STEPS);
            ends.partition_point(|&end| end <= value) as u8
        };
        Self { steps: (0..STEPS).map(code).collect(), ends }
    }

    fn of(&self, value: f64) -> u8 {
        if (0.0..1.0).contains(&value) {
            let code = self.steps[(value * f64::from(STEPS)) as usize];
            let beyond = value - self.ends[usize::from(code)];
            // Powers are off by far less.
            if beyond.abs() > 1e-9 {
                return code + u8::from(beyond > 0.0);
            }
        }
        (encode(value) * 255.0 + 0.5) as u8
    }
}

fn codes() -> &'static Codes {
    static CODES: OnceLock<Codes> = OnceLock::new();
    CODES.get_or_init(Codes::new)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_told_without_a_power_are_those_that_it_gives() {
        let codes = codes();
        // Values everywhere, and those about the places where one code becomes the next.
        let even = (0..=1_000_000).map(|i| f64::from(i) / 1e6);
        let edges = (0..255).flat_map(|code| {
            let edge = srgb_decode((f64::from(code) + 0.5) / 255.0);
            [-1e-9, -1e-15, 0.0, 1e-15, 1e-9].map(|off| edge + off)
        });
        for value in even.chain(edges).chain([-0.1, 1.0 + 1e-15, 2.0]) {
            assert_eq!(codes.of(value), (encode(value) * 255.0 + 0.5) as u8, "{value}");
        }
    }

    #[test]
    fn the_pixels_of_half_an_image_share_all_of_it_evenly() {
        for from in 1..12_u32 {
            let to = (from / 2).max(1);
            let mut shares = vec![0.0; from as usize];
            for at in 0..to {
                let covered = covered(from, to, at);
                let sum: f64 = covered.iter().map(|(_, weight)| weight).sum();
                assert!((sum - 1.0).abs() < 1e-12, "{from}: {covered:?}");
                for &(i, weight) in &covered {
                    shares[i as usize] += weight;
                }
            }
            let even = f64::from(to) / f64::from(from);
            assert!(shares.iter().all(|share| (share - even).abs() < 1e-12), "{from}: {shares:?}");
        }
    }
}
