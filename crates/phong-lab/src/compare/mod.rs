//! How different two pictures are: in numbers, to the eye, pixel by pixel, and term by term.

mod color_map;
mod delta_e;
mod drawing;
mod json;
mod terms;

use phong::image::{Picture, Transfer};
use phong_scene::{srgb_decode, srgb_encode};
use rayon::prelude::*;
use thiserror::Error;

pub use color_map::color;
pub use delta_e::{Lab, delta_e_2000};
pub use drawing::draw;
pub use json::{json, shortest};
pub use terms::{TermDifference, terms};

/// How many of the worst pixels are told.
const WORST: usize = 5;
/// A difference in ΔE₀₀ that is about the least seen side by side.
const SEEN: f64 = 1.0;

/// How different two pictures are, over all values of the channels that both have.
///
/// Alpha counts as a channel, 1 where a picture has none. Two PNGs are compared as they are
/// encoded, EXR and PFM as linear values; of a PNG and one of those the latter is encoded.
///
/// A value that is finite in one picture only differs infinitely, which `max` says; means leave
/// it out. Two of the same infinity, or two NaNs, do not differ.
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
    /// Every channel by itself, in the order of comparison: colours, alpha, other layers.
    pub channels: Vec<Channel>,
    /// How different the colours look; `None`: the pictures have no colours.
    pub delta_e: Option<DeltaE>,
    /// Pixels with a value that is finite in one picture only.
    pub not_finite: u64,
    /// The pixels that differ most, the worst first; at most five, none that does not differ.
    pub worst_pixels: Vec<Pixel>,
    /// The largest absolute difference of each pixel over all channels, rows from top to bottom.
    pub largest: Vec<f32>,
    /// The absolute differences of red, green and blue, three a pixel, rows from top to bottom;
    /// empty where the pictures have no colours.
    pub map: Vec<f32>,
}

/// One channel of two pictures.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Its name: `R`, `A`, `diffuse.R`.
    pub name: String,
    /// The largest absolute difference, as for the whole.
    pub max: f64,
    /// The mean absolute difference.
    pub mean: f64,
    /// The root of the mean squared difference.
    pub rms: f64,
    /// Peak signal to noise in decibels; `None`: nothing differs.
    pub psnr: Option<f64>,
}

/// How different colours look, by CIEDE2000, as a display shows them: clamped to [0, 1].
///
/// 1 is about the least that is seen side by side. Pixels that are not finite are left out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DeltaE {
    /// The mean over all pixels.
    pub mean: f64,
    /// The largest.
    pub max: f64,
    /// Where it is, the first of several.
    pub worst: [u32; 2],
    /// Share of the pixels that differ by more than 1, in [0, 1].
    pub over_1: f64,
}

/// One pixel of two pictures.
#[derive(Clone, Debug, PartialEq)]
pub struct Pixel {
    /// Column and row.
    pub at: [u32; 2],
    /// Its largest absolute difference over all channels.
    pub difference: f64,
    /// The first picture's values as they were compared, in the order of the channels.
    pub a: Vec<f64>,
    /// The second's.
    pub b: Vec<f64>,
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
    let pairs = pairs(a, b);
    if pairs.is_empty() {
        return Err(CompareError::Channels);
    }
    let count = a.size[0] as usize * a.size[1] as usize;
    let colors = a.rgb().is_some() && b.rgb().is_some();
    let mut largest = vec![0.0_f32; count];
    let mut map = vec![0.0; if colors { 3 * count } else { 0 }];
    let mut broken = vec![false; count];
    let (mut all, mut worst) = (Sums::default(), (-1.0, 0, 0));
    let mut channels = Vec::with_capacity(pairs.len());
    for (index, pair) in pairs.iter().enumerate() {
        let mut sums = Sums::default();
        for i in 0..count {
            let d = pair.distance(i);
            sums.add(d);
            broken[i] |= d.is_infinite();
            largest[i] = largest[i].max(d as f32);
            if colors && index < 3 {
                map[3 * i + index] = d as f32;
            }
            if d > worst.0 {
                worst = (d, i, index);
            }
        }
        all.join(&sums);
        let (mean, rms, psnr) = sums.told();
        channels.push(Channel { name: pair.name.to_owned(), max: sums.max, mean, rms, psnr });
    }
    let place = |i: usize| [i as u32 % a.size[0], i as u32 / a.size[0]];
    let pixel = |i: usize| Pixel {
        at: place(i),
        difference: pairs.iter().fold(0.0, |most: f64, pair| most.max(pair.distance(i))),
        a: pairs.iter().map(|pair| pair.a.at(i)).collect(),
        b: pairs.iter().map(|pair| pair.b.at(i)).collect(),
    };
    let (mean, rms, psnr) = all.told();
    Ok(Comparison {
        max: all.max,
        mean,
        rms,
        over_1_255: all.over as f64 / (count * pairs.len()) as f64,
        psnr,
        worst: place(worst.1),
        channel: pairs[worst.2].name.to_owned(),
        channels,
        delta_e: colors
            .then(|| delta_e(&pairs[..3], count))
            .map(|(told, at)| DeltaE { worst: place(at), ..told }),
        not_finite: broken.into_iter().filter(|&broken| broken).count() as u64,
        worst_pixels: the_worst(&largest).into_iter().map(pixel).collect(),
        largest,
        map,
    })
}

impl Comparison {
    /// How many pixels differ by more than `tolerance` in some channel.
    pub fn pixels_over(&self, tolerance: f64) -> usize {
        self.largest.iter().filter(|&&d| exceeds(f64::from(d), tolerance)).count()
    }
}

/// One channel of both pictures.
struct Pair<'a> {
    name: &'a str,
    a: Values<'a>,
    b: Values<'a>,
}

/// One channel of one picture, as it is compared.
#[derive(Clone, Copy)]
struct Values<'a> {
    /// `None`: 1 everywhere, an alpha that is not there.
    plane: Option<&'a [f32]>,
    /// Whether linear values are encoded first.
    encode: bool,
    /// Whether the values, as they are compared, are encoded.
    encoded: bool,
}

impl Values<'_> {
    fn at(&self, i: usize) -> f64 {
        let v = self.plane.map_or(1.0, |plane| plane[i]);
        if self.encode && v.is_finite() {
            srgb_encode(f64::from(v.clamp(0.0, 1.0)))
        } else {
            f64::from(v)
        }
    }

    fn linear(&self, i: usize) -> f64 {
        let v = self.at(i);
        if self.encoded && v.is_finite() { srgb_decode(v.clamp(0.0, 1.0)) } else { v }
    }
}

impl Pair<'_> {
    /// |a − b|; 0 for two of the same infinity or two NaNs, infinite where only one is finite.
    fn distance(&self, i: usize) -> f64 {
        let (a, b) = (self.a.at(i), self.b.at(i));
        if a == b || (a.is_nan() && b.is_nan()) {
            0.0
        } else if a.is_finite() && b.is_finite() {
            (a - b).abs()
        } else {
            f64::INFINITY
        }
    }
}

/// What is compared with what: colours first, then alpha if either has it, then common layers.
fn pairs<'a>(a: &'a Picture, b: &'a Picture) -> Vec<Pair<'a>> {
    let mixed = a.transfer != b.transfer;
    let pair = |name: &'a str, planes: [Option<&'a [f32]>; 2], color: bool| {
        let values = |picture: &Picture, plane| {
            let encode = color && mixed && picture.transfer == Transfer::Linear;
            let encoded = color && (encode || picture.transfer == Transfer::Srgb);
            Values { plane, encode, encoded }
        };
        Pair { name, a: values(a, planes[0]), b: values(b, planes[1]) }
    };
    let mut pairs = Vec::new();
    if let (Some(a), Some(b)) = (a.rgb(), b.rgb()) {
        let names = ["R", "G", "B"];
        pairs.extend((0..3).map(|c| pair(names[c], [Some(a[c]), Some(b[c])], true)));
    }
    let (alpha_a, alpha_b) = (a.plane("A"), b.plane("A"));
    if !pairs.is_empty() && (alpha_a.is_some() || alpha_b.is_some()) {
        pairs.push(pair("A", [alpha_a, alpha_b], false));
    }
    let done = ["R", "G", "B", "A", "Y"];
    for plane in a.planes.iter().filter(|plane| !done.contains(&plane.name.as_str())) {
        if let Some(other) = b.plane(&plane.name) {
            pairs.push(pair(&plane.name, [Some(&plane.values), Some(other)], true));
        }
    }
    pairs
}

/// Sums over differences; those that are infinite go into the maximum alone.
#[derive(Default)]
struct Sums {
    max: f64,
    sum: f64,
    squares: f64,
    finite: u64,
    over: u64,
}

impl Sums {
    fn add(&mut self, d: f64) {
        self.max = self.max.max(d);
        self.over += u64::from(exceeds(d, 1.0 / 255.0));
        if d.is_finite() {
            self.sum += d;
            self.squares += d * d;
            self.finite += 1;
        }
    }

    fn join(&mut self, other: &Self) {
        self.max = self.max.max(other.max);
        self.sum += other.sum;
        self.squares += other.squares;
        self.finite += other.finite;
        self.over += other.over;
    }

    /// Mean, root mean square, peak signal to noise.
    fn told(&self) -> (f64, f64, Option<f64>) {
        let count = self.finite.max(1) as f64;
        let square = self.squares / count;
        let psnr = (square > 0.0).then(|| -10.0 * libm::log10(square));
        (self.sum / count, square.sqrt(), psnr)
    }
}

/// ΔE₀₀ of all pixels, and where the largest is. Blocks are summed in order: the same bits for any
/// number of threads.
fn delta_e(colors: &[Pair<'_>], count: usize) -> (DeltaE, usize) {
    const BLOCK: usize = 4096;
    let at = |i: usize| {
        let [a, b] = [[0, 1, 2].map(|c| colors[c].a), [0, 1, 2].map(|c| colors[c].b)]
            .map(|channels| channels.map(|values| values.linear(i)));
        let finite = a.iter().chain(&b).all(|v| v.is_finite());
        finite
            .then(|| if a == b { 0.0 } else { delta_e_2000(Lab::of_linear(a), Lab::of_linear(b)) })
    };
    let block = |block: usize| {
        let (mut sum, mut told, mut seen, mut max, mut worst) = (0.0, 0_u64, 0_u64, 0.0, 0);
        for i in block * BLOCK..((block + 1) * BLOCK).min(count) {
            let Some(d) = at(i) else { continue };
            sum += d;
            told += 1;
            seen += u64::from(d > SEEN);
            if d > max {
                (max, worst) = (d, i);
            }
        }
        (sum, told, seen, max, worst)
    };
    let blocks: Vec<_> = (0..count.div_ceil(BLOCK)).into_par_iter().map(block).collect();
    let (mut sum, mut told, mut seen, mut max, mut worst) = (0.0, 0, 0, 0.0, 0);
    for block in blocks {
        sum += block.0;
        told += block.1;
        seen += block.2;
        if block.3 > max {
            (max, worst) = (block.3, block.4);
        }
    }
    let pixels = told.max(1) as f64;
    let delta_e = DeltaE { mean: sum / pixels, max, worst: [0, 0], over_1: seen as f64 / pixels };
    (delta_e, worst)
}

/// The pixels of the largest differences, the worst first, of equals the first.
fn the_worst(largest: &[f32]) -> Vec<usize> {
    let mut worst: Vec<usize> = Vec::with_capacity(WORST + 1);
    for (i, &d) in largest.iter().enumerate() {
        let full = worst.len() == WORST;
        if d > 0.0 && !(full && d <= largest[worst[WORST - 1]]) {
            let place = worst.partition_point(|&other| largest[other] >= d);
            worst.insert(place, i);
            worst.truncate(WORST);
        }
    }
    worst
}

#[cfg(test)]
mod tests;
