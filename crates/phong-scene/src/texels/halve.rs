//! Half of an image: the mean of linear values over the place of each pixel.

use super::{TexelValues, Texels};
use crate::color::srgb_encode;

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
    let mut means = Vec::with_capacity(size[0] as usize * size[1] as usize * channels);
    for y in 0..size[1] {
        let rows = covered(height, size[1], y);
        for columns in &columns {
            let mut sum = [0.0_f64; 4];
            for &(y, down) in &rows {
                for &(x, across) in columns {
                    let pixel = texels.get([x, y], srgb);
                    let weight = down * across;
                    sum.iter_mut().zip(pixel).for_each(|(s, v)| *s += weight * f64::from(v));
                }
            }
            let encode = |channel: usize| {
                let value = sum[channel];
                if srgb && channel < 3 && (0.0..=1.0).contains(&value) {
                    return srgb_encode(value);
                }
                value
            };
            means.extend(own.iter().map(|&channel| encode(channel)));
        }
    }
    let values = match texels.values() {
        TexelValues::Bytes(_) => {
            TexelValues::Bytes(means.iter().map(|mean| (mean * 255.0 + 0.5) as u8).collect())
        }
        TexelValues::Shorts(_) => {
            TexelValues::Shorts(means.iter().map(|mean| (mean * 65535.0 + 0.5) as u16).collect())
        }
        TexelValues::Floats(_) => {
            TexelValues::Floats(means.iter().map(|&mean| mean as f32).collect())
        }
    };
    Texels::new(size, channels, values).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

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
