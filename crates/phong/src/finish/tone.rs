//! How light becomes what a PNG shows: exposure, white balance, and a curve.

use std::ops::Range;

use glam::{DMat3, DVec3};
use phong_scene::{Exposure, Rgb, Tone, ToneCurve};
use rayon::prelude::*;

use crate::math::wide;

/// What automatic exposure makes of the geometric mean luminance of what is lit: a grey in the middle between black
/// and white to the eye, as photographers and Reinhard's paper have it.
const MIDDLE_GREY: f64 = 0.18;

/// What is more often brighter or darker than the median luminance counts as so much: a lamp in the
/// picture, or the last glimmer of a highlight, does not decide on its exposure.
const FARTHEST: f32 = 1024.0;

/// Beyond this light is so bright that curves take it for this: their products stay finite.
const BRIGHTEST: f32 = 1e9;

/// Linear Rec. 709 to X, Y and Z, rows.
const TO_XYZ: [[f64; 3]; 3] = [
    [0.412_456_4, 0.357_576_1, 0.180_437_5],
    [0.212_672_9, 0.715_152_2, 0.072_175],
    [0.019_333_9, 0.119_192, 0.950_304_1],
];

/// X, Y and Z to the responses of cones as Bradford's transform has them, rows (Lam, 1985).
const BRADFORD: [[f64; 3]; 3] =
    [[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]];

/// How light becomes what a PNG shows: a scene's [`Tone`], whose exposure is found. The default leaves light
/// as it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToneMap {
    stops: f64,
    gain: f32,
    /// Rows; `None`: colours stay.
    balance: Option<[[f32; 3]; 3]>,
    curve: ToneCurve,
}

/// A pixel's light on its way, step by step. Linear.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToneSteps {
    /// As bright as exposure makes it.
    pub exposed: Rgb,
    /// With its white balanced; `None`: nothing is asked for.
    pub balanced: Option<Rgb>,
    /// On the curve; `None`: that is the clamp, which every file does.
    pub curved: Option<Rgb>,
}

impl ToneSteps {
    /// What comes out at the end; not yet clamped.
    pub fn last(&self) -> Rgb {
        self.curved.or(self.balanced).unwrap_or(self.exposed)
    }
}

impl Default for ToneMap {
    fn default() -> Self {
        Self { stops: 0.0, gain: 1.0, balance: None, curve: ToneCurve::Clamp }
    }
}

impl ToneMap {
    /// Tone of a picture: three values a pixel, premultiplied with its alpha; `None`: that is 1.
    pub fn new(tone: &Tone, picture: &[f32], alpha: Option<&[f32]>) -> Self {
        let stops = match tone.exposure {
            Exposure::Stops(stops) => stops,
            Exposure::Auto => automatic(picture, alpha),
        };
        let white = tone.white_balance.map(white_of).or_else(|| tone.neutral.map(xyz_of));
        Self {
            stops,
            gain: wide::exp2(stops) as f32,
            balance: white.map(balance),
            curve: tone.curve,
        }
    }

    /// Stops by which the picture is made brighter.
    pub fn stops(&self) -> f64 {
        self.stops
    }

    /// By what exposure multiplies light.
    pub(super) fn gain(&self) -> f32 {
        self.gain
    }

    /// The curve that light goes through.
    pub fn curve(&self) -> ToneCurve {
        self.curve
    }

    /// The factor that is all it does; `None`: it does more.
    pub(crate) fn only_gain(&self) -> Option<f32> {
        (self.balance.is_none() && self.curve == ToneCurve::Clamp).then_some(self.gain)
    }

    /// What becomes of a picture: three values a pixel, premultiplied with its alpha. Not yet clamped.
    pub fn toned(&self, picture: &[f32], alpha: &[f32]) -> Vec<f32> {
        let pixels = picture.as_chunks::<3>().0.iter().zip(alpha);
        let toned = pixels.flat_map(|(color, &alpha)| {
            let straight = color.map(|v| if alpha > 0.0 { v / alpha } else { 0.0 });
            (self.steps(straight.into()).last() * alpha).to_array()
        });
        toned.collect()
    }

    /// What becomes of a pixel's light, whose alpha is divided out.
    pub fn steps(&self, linear: Rgb) -> ToneSteps {
        let exposed = linear * self.gain;
        let balanced = self.balance.map(|rows| {
            let Rgb { r, g, b } = exposed;
            // What no display shows of a colour is left out.
            let channel = |[x, y, z]: [f32; 3]| (x * r + y * g + z * b).max(0.0);
            Rgb::from(rows.map(channel))
        });
        let light = balanced.unwrap_or(exposed);
        let curved = match self.curve {
            ToneCurve::Clamp => None,
            ToneCurve::Reinhard { white } => Some(reinhard(light, white as f32)),
            ToneCurve::Filmic => Some(light.to_array().map(filmic).into()),
        };
        ToneSteps { exposed, balanced, curved }
    }
}

/// The stops that bring the geometric mean of what is lit to a middle grey; 0 where nothing is.
///
/// It is taken over the luminances of all pixels that have any, each at most ten stops from their median.
fn automatic(picture: &[f32], alpha: Option<&[f32]>) -> f64 {
    let lit = Lit { picture: picture.as_chunks::<3>().0, alpha };
    let Some((median, count)) = lit.median() else { return 0.0 };
    let logarithm =
        |y: f32| wide::ln(f64::from(y.clamp(median / FARTHEST, (median * FARTHEST).min(f32::MAX))));
    // The pieces are the same for any number of threads, and summed in their order.
    let pieces =
        lit.pieces().into_par_iter().map(|piece| lit.luminances(piece).map(logarithm).sum());
    let sums: Vec<f64> = pieces.collect();
    let mean = sums.iter().sum::<f64>() / count as f64;
    let most = Tone::MOST_STOPS;
    ((wide::ln(MIDDLE_GREY) - mean) / std::f64::consts::LN_2).clamp(-most, most)
}

/// The pixels of a picture that have any luminance. They may be very many, so that nothing is kept of each.
struct Lit<'a> {
    picture: &'a [[f32; 3]],
    alpha: Option<&'a [f32]>,
}

impl Lit<'_> {
    /// Of these pixels, those that are lit.
    fn luminances(&self, pixels: Range<usize>) -> impl Iterator<Item = f32> {
        pixels
            .map(|i| {
                let share = self.alpha.and_then(|alpha| alpha.get(i)).map_or(1.0, |&alpha| alpha);
                Rgb::from(self.picture[i]).luminance() / share
            })
            .filter(|&y| y > 0.0 && y < f32::INFINITY)
    }

    /// All pixels, 4096 at a time.
    fn pieces(&self) -> Vec<Range<usize>> {
        let pixels = self.picture.len();
        (0..pixels).step_by(4096).map(|first| first..pixels.min(first + 4096)).collect()
    }

    /// The median of the luminances, and how many there are; `None`: there is none.
    ///
    /// Floats above 0 are in the order of their bits: of the median's the highest eleven are found first, by
    /// counting how many luminances begin with each, then ten more, and then the last ten.
    fn median(&self) -> Option<(f32, u64)> {
        let (mut known, mut below) = (0_u32, 31);
        let (mut all, mut rank) = (None, 0);
        for shift in [20, 10, 0] {
            let counts = self.counts(known, below, shift);
            if all.is_none() {
                let count = counts.iter().sum::<u64>();
                (all, rank) = (Some(count), count / 2);
            }
            let mut next = 0;
            for &count in &counts {
                if rank < count {
                    break;
                }
                (rank, next) = (rank - count, next + 1);
            }
            (known, below) = ((known << (below - shift)) + next, shift);
        }
        all.filter(|&count| count > 0).map(|count| (f32::from_bits(known), count))
    }

    /// Of the luminances whose bits from bit `below` on are `known`, how many have each number in the bits
    /// from there down to bit `shift`.
    fn counts(&self, known: u32, below: u32, shift: u32) -> Vec<u64> {
        let size = 1_usize << (below - shift);
        let none = || vec![0_u64; size];
        let count = |mut counts: Vec<u64>, piece| {
            let bits = self.luminances(piece).map(f32::to_bits);
            for bits in bits.filter(|bits| bits >> below == known) {
                counts[(bits >> shift) as usize % size] += 1;
            }
            counts
        };
        let add = |mut some: Vec<u64>, more: Vec<u64>| {
            some.iter_mut().zip(more).for_each(|(some, more)| *some += more);
            some
        };
        self.pieces().into_par_iter().fold(none, count).reduce(none, add)
    }
}

/// See [`ToneCurve::Reinhard`].
fn reinhard(light: Rgb, white: f32) -> Rgb {
    let light: Rgb = light.to_array().map(|v| v.min(BRIGHTEST)).into();
    let y = light.luminance();
    if y > 0.0 { light * ((1.0 + y / (white * white)) / (1.0 + y)) } else { light }
}

/// See [`ToneCurve::Filmic`].
fn filmic(x: f32) -> f32 {
    let x = x.clamp(0.0, BRIGHTEST);
    x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14)
}

/// X, Y and Z of a linear colour, of luminance 1.
fn xyz_of(color: Rgb) -> DVec3 {
    let xyz = rows(TO_XYZ) * DVec3::from_array(color.to_array().map(f64::from));
    xyz / xyz.y.max(f64::MIN_POSITIVE)
}

/// X, Y and Z of light of a colour temperature, of luminance 1: daylight as the CIE has it from 5000 K on,
/// a black body up to 4000 K, and between them what lies between.
fn white_of(kelvin: f64) -> DVec3 {
    let share = ((kelvin - 4000.0) / 1000.0).clamp(0.0, 1.0);
    let (body, day) = (black_body(kelvin), daylight(kelvin));
    let [x, y] = [0, 1].map(|i| body[i] * (1.0 - share) + day[i] * share);
    DVec3::new(x / y, 1.0, (1.0 - x - y) / y)
}

/// The sum of three powers of the inverse temperature, that of the highest first, and a number.
fn inverse_cubic([a, b, c, d]: [f64; 4], kelvin: f64) -> f64 {
    let inverse = 1000.0 / kelvin;
    ((a * inverse + b) * inverse + c) * inverse + d
}

/// Chromaticity of a black body, by the fit of Kim, Lee, Kim and Kwon (US patent 7024034, 2006).
fn black_body(kelvin: f64) -> [f64; 2] {
    let x = if kelvin < 4000.0 {
        inverse_cubic([-0.266_123_9, -0.234_358_9, 0.877_695_6, 0.179_91], kelvin)
    } else {
        inverse_cubic([-3.025_846_9, 2.107_037_9, 0.222_634_7, 0.240_39], kelvin)
    };
    let [a, b, c, d] = if kelvin < 2222.0 {
        [-1.106_381_4, -1.348_110_2, 2.185_558_32, -0.202_196_83]
    } else if kelvin < 4000.0 {
        [-0.954_947_6, -1.374_185_93, 2.091_370_15, -0.167_488_67]
    } else {
        [3.081_758, -5.873_386_7, 3.751_129_97, -0.370_014_83]
    };
    [x, ((a * x + b) * x + c) * x + d]
}

/// Chromaticity of daylight (CIE 15, *Colorimetry*), from 4000 K on.
fn daylight(kelvin: f64) -> [f64; 2] {
    let x = if kelvin < 7000.0 {
        inverse_cubic([-4.607, 2.9678, 0.099_11, 0.244_063], kelvin)
    } else {
        inverse_cubic([-2.0064, 1.9018, 0.247_48, 0.237_04], kelvin)
    };
    [x, (2.87 - 3.0 * x) * x - 0.275]
}

/// The matrix under which light of X, Y and Z becomes grey: each cone's response is scaled by itself, as
/// von Kries proposed, with the cones of Bradford's transform.
fn balance(white: DVec3) -> [[f32; 3]; 3] {
    let to_cones = rows(BRADFORD) * rows(TO_XYZ);
    let (from, to) = (rows(BRADFORD) * white, to_cones * DVec3::ONE);
    let scale = DMat3::from_diagonal(to / from);
    let matrix = to_cones.inverse() * scale * to_cones;
    [0, 1, 2].map(|row| matrix.row(row).to_array().map(|v| v as f32))
}

fn rows(rows: [[f64; 3]; 3]) -> DMat3 {
    DMat3::from_cols_array_2d(&rows).transpose()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map(tone: Tone) -> ToneMap {
        ToneMap::new(&tone, &[], None)
    }

    #[test]
    fn without_a_tone_light_stays_as_it_is() {
        let color = Rgb::new(0.1, 2.0, -0.5);
        assert_eq!(map(Tone::default()).steps(color).last(), color);
        assert_eq!(map(Tone::default()), ToneMap::default());
        assert_eq!(ToneMap::default().only_gain(), Some(1.0));
    }

    #[test]
    fn a_stop_doubles_the_light() {
        let tone = Tone { exposure: Exposure::Stops(1.0), ..Tone::default() };
        assert_eq!(map(tone).steps(Rgb::grey(0.25)).last(), Rgb::grey(0.5));
        assert_eq!(map(tone).only_gain(), Some(2.0));
    }

    /// Half of the lit pixels are at 0.02, half at 0.08, and the logarithms' mean is that of 0.04.
    #[test]
    fn automatic_exposure_brings_the_mean_of_what_is_lit_to_middle_grey() {
        let mut picture = vec![0.0; 30];
        picture[..6].fill(0.02);
        picture[6..12].fill(0.08);
        let tone = Tone { exposure: Exposure::Auto, ..Tone::default() };
        let found = ToneMap::new(&tone, &picture, None);
        assert!((found.stops() - wide::ln(4.5) / std::f64::consts::LN_2).abs() < 1e-6, "{found:?}");
        // Where half of a pixel is there, it is as bright as a whole one.
        let halved: Vec<f32> = picture.iter().map(|v| 0.5 * v).collect();
        assert_eq!(ToneMap::new(&tone, &halved, Some(&[0.5; 10])).stops(), found.stops());
    }

    #[test]
    fn automatic_exposure_is_decided_by_no_lamp_no_glimmer_and_nothing_that_is_no_light() {
        let tone = Tone { exposure: Exposure::Auto, ..Tone::default() };
        let stops = |picture: &[f32]| ToneMap::new(&tone, picture, None).stops();
        assert_eq!(stops(&[0.0; 12]), 0.0);
        assert_eq!(stops(&[f32::NAN, 1.0, 1.0, f32::INFINITY, 1.0, 1.0, -1.0, 0.0, 0.0]), 0.0);
        let mut picture = vec![0.18; 3000];
        assert!(stops(&picture).abs() < 1e-6);
        picture[..3].fill(1e30);
        picture[3..6].fill(1e-30);
        assert!(stops(&picture).abs() < 1e-6, "ten stops up and ten down: {}", stops(&picture));
        assert_eq!(stops(&[1e-44; 3]), 100.0);
        assert_eq!(stops(&[1e38; 3]), -100.0);
    }

    /// Sorted by others, of numbers of all sizes and in any order.
    #[test]
    fn the_median_is_the_middle_one_of_all_luminances_that_were_sorted() {
        for count in [1_u32, 2, 3, 4096, 4097, 10_001] {
            let value = |i: u32| f32::from_bits(i.wrapping_mul(2_654_435_761) % 0x7f7f_ffff + 1);
            let picture: Vec<[f32; 3]> = (0..count).map(|i| [0.0, value(i), 0.0]).collect();
            let lit = Lit { picture: &picture, alpha: None };
            let mut sorted: Vec<f32> = lit.luminances(0..picture.len()).collect();
            sorted.sort_by(f32::total_cmp);
            let wanted = (sorted[sorted.len() / 2], sorted.len() as u64);
            assert_eq!(lit.median(), Some(wanted), "{count}");
        }
        assert_eq!(Lit { picture: &[[0.0; 3]], alpha: None }.median(), None);
    }

    #[test]
    fn the_colour_that_is_to_look_grey_does_and_keeps_its_luminance() {
        for neutral in [[1.0, 0.5, 0.2], [0.2, 0.3, 2.0], [1.0, 0.0, 0.0]].map(Rgb::from) {
            let tone = Tone { neutral: Some(neutral), ..Tone::default() };
            let [r, g, b] = map(tone).steps(neutral).last().to_array();
            let wanted = neutral.luminance();
            for channel in [r, g, b] {
                assert!((channel - wanted).abs() < 1e-4, "{neutral:?}: {r} {g} {b}, {wanted}");
            }
        }
    }

    #[test]
    fn light_of_6504_kelvin_is_white_already_and_a_lamps_is_made_bluer() {
        let at = |kelvin| {
            let tone = Tone { white_balance: Some(kelvin), ..Tone::default() };
            map(tone).steps(Rgb::grey(0.5)).last()
        };
        for channel in at(6504.0).to_array() {
            assert!((channel - 0.5).abs() < 2e-3, "{:?}", at(6504.0));
        }
        let lamp = at(2856.0);
        assert!(lamp.b > 1.5 * lamp.r, "{lamp:?}");
        let shade = at(9000.0);
        assert!(shade.r > 1.1 * shade.b, "{shade:?}");
        // CIE illuminant A, of 2856 K, has the chromaticity (0.4476, 0.4074).
        let [x, y] = black_body(2856.0);
        assert!((x - 0.4476).abs() < 1e-3 && (y - 0.4074).abs() < 1e-3, "({x}, {y})");
        // D65 has (0.3127, 0.3290), D50, of 5003 K, (0.3457, 0.3585).
        for (kelvin, wanted) in [(6504.0, [0.3127, 0.3290]), (5003.0, [0.3457, 0.3585])] {
            let [x, y] = daylight(kelvin);
            assert!((x - wanted[0]).abs() < 3e-4 && (y - wanted[1]).abs() < 3e-4, "({x}, {y})");
        }
    }

    #[test]
    fn white_balance_has_no_steps() {
        let mut before = white_of(Tone::TEMPERATURES[0]);
        for kelvin in (1710..=25_000).step_by(10) {
            let now = white_of(f64::from(kelvin));
            assert!(now.z > before.z && now.z - before.z < 0.01, "{kelvin}: {before} {now}");
            before = now;
        }
    }

    #[test]
    fn reinhards_white_becomes_white_and_all_below_it_less() {
        let tone = Tone { curve: ToneCurve::Reinhard { white: 4.0 }, ..Tone::default() };
        let bright = |y| map(tone).steps(Rgb::grey(y)).last().g;
        assert!((bright(4.0) - 1.0).abs() < 1e-6);
        assert!((bright(1.0) - 0.531_25).abs() < 1e-6, "17/16 ÷ 2, by hand: {}", bright(1.0));
        // The colour stays: its channels are as one another.
        let color = map(tone).steps(Rgb::new(2.0, 1.0, 0.5)).last();
        assert!((color.r - 2.0 * color.g).abs() < 1e-6 && (color.g - 2.0 * color.b).abs() < 1e-6);
    }

    /// 2.54 ÷ 3.16 at 1, by hand.
    #[test]
    fn the_filmic_curve_is_the_fit_that_it_is_named_after() {
        assert_eq!(filmic(0.0), 0.0);
        assert!((filmic(1.0) - 0.803_797_5).abs() < 1e-6);
        assert!((filmic(0.18) - 0.266_898_9).abs() < 1e-6, "{}", filmic(0.18));
    }

    #[test]
    fn curves_never_fall_and_stay_finite() {
        for curve in [ToneCurve::Filmic, ToneCurve::Reinhard { white: 4.0 }] {
            let tone = Tone { curve, ..Tone::default() };
            let mut before = 0.0;
            for i in -200..400 {
                let light = wide::exp2(f64::from(i) / 4.0) as f32;
                let now = map(tone).steps(Rgb::grey(light)).last().g;
                // Where it hardly rises, rounding may be more than that.
                let least = before * (1.0 - 1e-6);
                assert!(now >= least && now.is_finite(), "{curve:?} at {light}: {now}");
                before = now;
            }
            for light in [f32::INFINITY, f32::MAX] {
                assert!(map(tone).steps(Rgb::grey(light)).last().g >= 1.0);
            }
            assert!(map(tone).steps(Rgb::grey(-1.0)).last().g <= 0.0);
        }
    }
}
