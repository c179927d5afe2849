//! Linear colour and the sRGB transfer curve.

pub(crate) mod maps;
mod names;

use std::iter::Sum;
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Sub};

pub use names::ColorError;

/// A linear colour with Rec. 709 primaries; unclamped, any finite value (1 is display white).
///
/// ```
/// use phong_scene::Rgb;
/// let light = Rgb::new(1.0, 0.5, 0.25);
/// assert_eq!(2.0 * light * Rgb::grey(0.5), light);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Rgb {
    /// Red.
    pub r: f32,
    /// Green.
    pub g: f32,
    /// Blue.
    pub b: f32,
}

impl Rgb {
    /// No light at all.
    pub const BLACK: Self = Self::grey(0.0);
    /// Display white.
    pub const WHITE: Self = Self::grey(1.0);

    /// A colour from its linear channels.
    #[must_use]
    pub const fn new(r: f32, g: f32, b: f32) -> Self {
        Self { r, g, b }
    }

    /// The same value in all three channels.
    #[must_use]
    pub const fn grey(v: f32) -> Self {
        Self::new(v, v, v)
    }

    /// Channels in the order red, green, blue.
    #[must_use]
    pub const fn to_array(self) -> [f32; 3] {
        [self.r, self.g, self.b]
    }

    /// Whether all channels are exactly 0.
    #[inline]
    #[must_use]
    pub fn is_black(self) -> bool {
        self == Self::BLACK
    }

    /// The largest channel.
    #[must_use]
    pub fn max_channel(self) -> f32 {
        self.r.max(self.g).max(self.b)
    }

    /// How bright it is to the eye, Y of Rec. 709; of white 1.
    #[must_use]
    pub fn luminance(self) -> f32 {
        0.2126 * self.r + 0.7152 * self.g + 0.0722 * self.b
    }

    /// The colour at `t` of stops, each of a `t`, never falling, and a colour: linear between them, and beyond
    /// them as they are. Black where there are none.
    #[must_use]
    pub fn of_stops(stops: &[(f32, Self)], t: f32) -> Self {
        let next = stops.partition_point(|&(at, _)| at <= t);
        let (before, after) = stops.split_at(next);
        match (before.last(), after.first()) {
            (Some(&(from, a)), Some(&(to, b))) => a + (t - from) / (to - from) * (b - a),
            (Some(&(_, only)), None) | (None, Some(&(_, only))) => only,
            (None, None) => Self::BLACK,
        }
    }

    /// Applies `f` to each channel.
    #[must_use]
    pub fn map(self, f: impl Fn(f32) -> f32) -> Self {
        Self::new(f(self.r), f(self.g), f(self.b))
    }

    /// A colour from sRGB-encoded bytes (`#rrggbb`), decoded to linear.
    #[must_use]
    pub fn from_srgb8(bytes: [u8; 3]) -> Self {
        let [r, g, b] = bytes.map(|byte| srgb_decode(f64::from(byte) / 255.0) as f32);
        Self::new(r, g, b)
    }
}

impl From<[f32; 3]> for Rgb {
    fn from([r, g, b]: [f32; 3]) -> Self {
        Self::new(r, g, b)
    }
}

impl Add for Rgb {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self::new(self.r + o.r, self.g + o.g, self.b + o.b)
    }
}

impl AddAssign for Rgb {
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}

impl Sub for Rgb {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        Self::new(self.r - o.r, self.g - o.g, self.b - o.b)
    }
}

impl Mul for Rgb {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        Self::new(self.r * o.r, self.g * o.g, self.b * o.b)
    }
}

impl Mul<f32> for Rgb {
    type Output = Self;
    fn mul(self, k: f32) -> Self {
        Self::new(self.r * k, self.g * k, self.b * k)
    }
}

impl Mul<Rgb> for f32 {
    type Output = Rgb;
    fn mul(self, c: Rgb) -> Rgb {
        c * self
    }
}

impl MulAssign<f32> for Rgb {
    fn mul_assign(&mut self, k: f32) {
        *self = *self * k;
    }
}

impl Div<f32> for Rgb {
    type Output = Self;
    fn div(self, k: f32) -> Self {
        Self::new(self.r / k, self.g / k, self.b / k)
    }
}

impl Sum for Rgb {
    fn sum<I: Iterator<Item = Self>>(iter: I) -> Self {
        iter.fold(Self::BLACK, Add::add)
    }
}

/// sRGB-encoded value in [0, 1] to linear, by the piecewise curve of IEC 61966-2-1.
#[must_use]
pub fn srgb_decode(v: f64) -> f64 {
    if v <= 0.04045 { v / 12.92 } else { libm::pow((v + 0.055) / 1.055, 2.4) }
}

/// Linear value in [0, 1] to sRGB-encoded, by the piecewise curve of IEC 61966-2-1.
#[must_use]
pub fn srgb_encode(v: f64) -> f64 {
    if v <= 0.003_130_8 { v * 12.92 } else { 1.055 * libm::pow(v, 1.0 / 2.4) - 0.055 }
}

/// Whether these are colours counted up to 255: whole numbers, and one of them at least 2.
pub(crate) fn are_bytes(mut colors: impl Iterator<Item = Rgb>) -> bool {
    let mut largest = 0.0_f32;
    let whole = colors.all(|color| {
        largest = largest.max(color.max_channel());
        color.to_array().iter().all(|&c| c.fract() == 0.0 && (0.0..=255.0).contains(&c))
    });
    whole && largest >= 2.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_byte_survives_decoding_and_encoding() {
        for byte in 0..=255_u8 {
            let linear = srgb_decode(f64::from(byte) / 255.0);
            assert_eq!((srgb_encode(linear) * 255.0 + 0.5) as u8, byte);
        }
    }

    #[test]
    fn mid_grey_is_a_fifth_of_the_light() {
        assert!((srgb_decode(0.5) - 0.214_041_14).abs() < 1e-7);
    }
}
