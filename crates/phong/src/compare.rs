//! How different two pictures are.

use phong_scene::srgb_encode;
use thiserror::Error;

use crate::image::{Picture, Transfer};

/// How different two pictures are, over all values of the channels that both have.
///
/// Alpha counts as a channel, 1 where a picture has none. Two PNGs are compared as they are
/// encoded, EXR and PFM as linear values; of a PNG and one of those the latter is encoded.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// The largest absolute difference; infinite where a value is finite in one picture only.
    pub max: f64,
    /// The mean absolute difference.
    pub mean: f64,
    /// The root of the mean squared difference.
    pub rms: f64,
    /// Share of the values that differ by more than 1/255, in [0, 1].
    pub over_1_255: f64,
    /// Peak signal to noise in decibels, the peak being 1; `None`: nothing differs.
    pub psnr: Option<f64>,
    /// The pixel (x, y) of the largest difference, the first of several.
    pub worst: [u32; 2],
    /// The channel of the largest difference.
    pub channel: String,
    /// The absolute differences of red, green and blue, three a pixel, rows from top to bottom;
    /// empty where the pictures have no colours.
    pub map: Vec<f32>,
}

/// Why two pictures cannot be compared.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum CompareError {
    /// Their sizes differ.
    #[error("the pictures differ in size: {}x{} and {}x{}", a[0], a[1], b[0], b[1])]
    Size {
        /// Width and height of the first.
        a: [u32; 2],
        /// Width and height of the second.
        b: [u32; 2],
    },
    /// They have no channel in common.
    #[error("the pictures have no channel in common")]
    Channels,
}

/// A difference is over a limit if it is so by more than rounding to f32 explains. A limit of 0 is
/// exact.
pub fn exceeds(difference: f64, limit: f64) -> bool {
    difference > limit * 1.000_1
}

/// Compares two pictures.
///
/// # Errors
/// [`CompareError`].
pub fn compare(a: &Picture, b: &Picture) -> Result<Comparison, CompareError> {
    if a.size != b.size {
        return Err(CompareError::Size { a: a.size, b: b.size });
    }
    let encode = a.transfer != b.transfer;
    let pairs = pairs(a, b);
    if pairs.is_empty() {
        return Err(CompareError::Channels);
    }
    let pixels = a.size[0] as usize * a.size[1] as usize;
    let mut map = vec![0.0; if a.rgb().is_some() && b.rgb().is_some() { 3 * pixels } else { 0 }];
    let (mut max, mut worst, mut channel) = (-1.0, 0, "");
    let (mut sum, mut squares, mut over) = (0.0, 0.0, 0_u64);
    for (index, (name, a_values, b_values)) in pairs.iter().enumerate() {
        let value = |picture: &Picture, plane: Option<&[f32]>, i: usize| {
            let v = plane.map_or(1.0, |plane| plane[i]);
            let bend = encode && picture.transfer == Transfer::Linear && *name != "A";
            if bend { srgb_encode(f64::from(v.clamp(0.0, 1.0))) } else { f64::from(v) }
        };
        for i in 0..pixels {
            let d = distance(value(a, *a_values, i), value(b, *b_values, i));
            sum += d;
            squares += d * d;
            over += u64::from(exceeds(d, 1.0 / 255.0));
            if d > max {
                (max, worst, channel) = (d, i, name);
            }
            if !map.is_empty() && index < 3 {
                map[3 * i + index] = d as f32;
            }
        }
    }
    let count = (pixels * pairs.len()) as f64;
    let mse = squares / count;
    let width = a.size[0] as usize;
    Ok(Comparison {
        max,
        mean: sum / count,
        rms: mse.sqrt(),
        over_1_255: over as f64 / count,
        psnr: (mse > 0.0).then(|| -10.0 * libm::log10(mse)),
        worst: [(worst % width) as u32, (worst / width) as u32],
        channel: channel.to_owned(),
        map,
    })
}

type Pair<'a> = (&'a str, Option<&'a [f32]>, Option<&'a [f32]>);

/// What is compared with what: colours first, then alpha if either has it, then common layers.
fn pairs<'a>(a: &'a Picture, b: &'a Picture) -> Vec<Pair<'a>> {
    let mut pairs = Vec::new();
    if let (Some(a), Some(b)) = (a.rgb(), b.rgb()) {
        let names = ["R", "G", "B"];
        pairs.extend((0..3).map(|c| (names[c], Some(a[c]), Some(b[c]))));
    }
    let (alpha_a, alpha_b) = (a.plane("A"), b.plane("A"));
    if !pairs.is_empty() && (alpha_a.is_some() || alpha_b.is_some()) {
        pairs.push(("A", alpha_a, alpha_b));
    }
    let done = ["R", "G", "B", "A", "Y"];
    for plane in a.planes.iter().filter(|plane| !done.contains(&plane.name.as_str())) {
        if let Some(other) = b.plane(&plane.name) {
            pairs.push((&plane.name, Some(&plane.values), Some(other)));
        }
    }
    pairs
}

/// |a − b|; 0 for two of the same infinity or two NaNs, infinite where only one is finite.
fn distance(a: f64, b: f64) -> f64 {
    if a == b || (a.is_nan() && b.is_nan()) {
        0.0
    } else if a.is_finite() && b.is_finite() {
        (a - b).abs()
    } else {
        f64::INFINITY
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::Plane;

    fn picture(transfer: Transfer, planes: &[(&str, &[f32])]) -> Picture {
        let planes = planes
            .iter()
            .map(|&(name, values)| Plane { name: name.to_owned(), values: values.to_vec() })
            .collect();
        Picture { size: [2, 1], planes, transfer }
    }

    fn grey(values: &[f32]) -> Picture {
        picture(Transfer::Srgb, &[("Y", values)])
    }

    #[test]
    fn a_picture_does_not_differ_from_itself() {
        let a = grey(&[0.25, f32::INFINITY]);
        let same = compare(&a, &a).unwrap();
        assert_eq!((same.max, same.mean, same.rms, same.over_1_255), (0.0, 0.0, 0.0, 0.0));
        assert_eq!((same.psnr, same.worst), (None, [0, 0]));
    }

    #[test]
    fn numbers_are_those_worked_by_hand() {
        let a = picture(
            Transfer::Linear,
            &[("R", &[0.0, 0.5]), ("G", &[0.0, 0.0]), ("B", &[0.0, 0.0])],
        );
        let b = picture(
            Transfer::Linear,
            &[("R", &[0.0, 0.0]), ("G", &[0.0, 0.25]), ("B", &[0.0, 0.0])],
        );
        let found = compare(&a, &b).unwrap();
        assert_eq!(found.max, 0.5);
        assert_eq!(found.mean, 0.125);
        assert!((found.rms - (0.3125_f64 / 6.0).sqrt()).abs() < 1e-15);
        assert!((found.over_1_255 - 1.0 / 3.0).abs() < 1e-15);
        // 10 log10(19.2)
        assert!((found.psnr.unwrap() - 12.833_012_287).abs() < 1e-8);
        assert_eq!((found.worst, found.channel.as_str()), ([1, 0], "R"));
        assert_eq!(found.map, [0.0, 0.0, 0.0, 0.5, 0.25, 0.0]);
    }

    #[test]
    fn one_level_of_eight_bits_is_not_over_one_level() {
        for level in 0..255_u8 {
            let [a, b] = [level, level + 1].map(|l| grey(&[f32::from(l) / 255.0; 2]));
            let found = compare(&a, &b).unwrap();
            assert_eq!(found.over_1_255, 0.0, "{level}");
            assert!(!exceeds(found.max, 1.0 / 255.0));
            assert!(exceeds(found.max, 0.0));
        }
    }

    #[test]
    fn what_is_finite_in_one_picture_only_is_infinitely_different() {
        let a = grey(&[0.0, f32::NAN]);
        let b = grey(&[0.0, 1.0]);
        assert_eq!(compare(&a, &b).unwrap().max, f64::INFINITY);
    }

    #[test]
    fn a_missing_alpha_is_opaque() {
        let y: (&str, &[f32]) = ("Y", &[0.5, 0.5]);
        let a = picture(Transfer::Srgb, &[y]);
        let b = picture(Transfer::Srgb, &[y, ("A", &[1.0, 0.25])]);
        let found = compare(&a, &b).unwrap();
        assert_eq!((found.max, found.channel.as_str()), (0.75, "A"));
    }

    #[test]
    fn linear_values_are_encoded_to_be_held_against_encoded_ones() {
        let a = grey(&[srgb_encode(0.5) as f32; 2]);
        let b = picture(Transfer::Linear, &[("Y", &[0.5, 0.5])]);
        assert!(compare(&a, &b).unwrap().max < 1e-7);
    }

    #[test]
    fn pictures_of_different_size_or_without_common_channels_are_refused() {
        let mut b = grey(&[0.5, 0.5]);
        b.size = [1, 2];
        let size = CompareError::Size { a: [2, 1], b: [1, 2] };
        assert_eq!(compare(&grey(&[0.5, 0.5]), &b), Err(size));
        let depth = picture(Transfer::Linear, &[("depth", &[0.5, 0.5])]);
        assert_eq!(compare(&grey(&[0.5, 0.5]), &depth), Err(CompareError::Channels));
    }
}
