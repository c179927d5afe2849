//! The pixels of image textures as arrays, and the same image at half its size, again and again.
//!
//! Values stay as the file has them: bytes, 16-bit numbers or floats. Whether they are sRGB or linear is what
//! uses them to say.

mod allowed;
mod file;
mod halve;
mod jpeg;
#[cfg(feature = "exr")]
mod openexr;
mod png;
mod radiance;

pub(crate) use allowed::allow;
pub(crate) use file::{load, parse};

use std::fmt;
use std::sync::{Arc, OnceLock};

use thiserror::Error;

use crate::color::srgb_decode;

/// The pixels of an image, row by row from the top, each row from the left: 1 to 4 numbers a pixel.
///
/// ```
/// use phong_scene::{TexelValues, Texels};
/// let red_and_blue = TexelValues::Bytes(vec![255, 0, 0, 0, 0, 255]);
/// let texels = Texels::new([2, 1], 3, red_and_blue)?;
/// assert_eq!(texels.get([1, 0], false), [0.0, 0.0, 1.0, 1.0]);
/// # Ok::<(), phong_scene::TexelsError>(())
/// ```
pub struct Texels {
    size: [u32; 2],
    channels: usize,
    values: TexelValues,
    /// The least and the largest value of each of the four channels, as stored.
    bounds: [[f32; 4]; 2],
    /// Half the size, made when it is first asked for: of linear values, and of sRGB ones.
    halves: [OnceLock<Option<Arc<Texels>>>; 2],
}

/// The numbers of an image, as compact as the file has them.
#[derive(Clone, PartialEq)]
pub enum TexelValues {
    /// 0 to 255 for 0 to 1.
    Bytes(Vec<u8>),
    /// 0 to 65535 for 0 to 1.
    Shorts(Vec<u16>),
    /// As they are; finite.
    Floats(Vec<f32>),
}

/// Why numbers are no image.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum TexelsError {
    /// A side of it is 0.
    #[error("it has no pixels: it is {} × {}", .0[0], .0[1])]
    Empty([u32; 2]),
    /// Neither 1, 2, 3 nor 4.
    #[error("a pixel has 1 to 4 numbers, not {0}")]
    Channels(usize),
    /// There are more or fewer numbers than width × height × channels.
    #[error("it has {found} numbers, and its size asks for {wanted}")]
    Count {
        /// As many as there are.
        found: usize,
        /// As many as there should be.
        wanted: u64,
    },
    /// A number is NaN or infinite.
    #[error("the pixel at ({}, {}) is {value}, which is no number", .at[0], .at[1])]
    NotFinite {
        /// Column and row of the first such pixel, from the left and from the top.
        at: [u32; 2],
        /// The number.
        value: f32,
    },
}

impl Texels {
    /// An image of `channels` numbers a pixel: grey; grey and opacity; red, green and blue; those and opacity.
    ///
    /// # Errors
    /// [`TexelsError`].
    pub fn new(size: [u32; 2], channels: usize, values: TexelValues) -> Result<Self, TexelsError> {
        if size.contains(&0) {
            return Err(TexelsError::Empty(size));
        }
        if !(1..=4).contains(&channels) {
            return Err(TexelsError::Channels(channels));
        }
        let wanted = u64::from(size[0]) * u64::from(size[1]) * channels as u64;
        let found = values.len();
        if found as u64 != wanted {
            return Err(TexelsError::Count { found, wanted });
        }
        if let TexelValues::Floats(values) = &values
            && let Some(at) = values.iter().position(|value| !value.is_finite())
        {
            let (pixel, value) = ((at / channels) as u64, values[at]);
            let width = u64::from(size[0]);
            let at = [(pixel % width) as u32, (pixel / width) as u32];
            return Err(TexelsError::NotFinite { at, value });
        }
        let bounds = bounds(&values, channels);
        Ok(Self { size, channels, values, bounds, halves: [OnceLock::new(), OnceLock::new()] })
    }

    /// A white pixel.
    pub fn white() -> Self {
        Self {
            size: [1, 1],
            channels: 1,
            values: TexelValues::Bytes(vec![255]),
            bounds: [[1.0; 4]; 2],
            halves: [OnceLock::new(), OnceLock::new()],
        }
    }

    /// Width and height.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Numbers a pixel.
    pub fn channels(&self) -> usize {
        self.channels
    }

    /// The numbers.
    pub fn values(&self) -> &TexelValues {
        &self.values
    }

    /// Red, green, blue and opacity of the pixel in column `x` and row `y` (from the top), 1 being the most
    /// of what is not a float. `srgb`: colours are decoded, the opacity never is. Grey is all three colours;
    /// what has no opacity has 1.
    ///
    /// # Panics
    /// If there is no such pixel.
    #[inline]
    pub fn get(&self, [x, y]: [u32; 2], srgb: bool) -> [f32; 4] {
        let at = (y as usize * self.size[0] as usize + x as usize) * self.channels;
        match &self.values {
            TexelValues::Bytes(values) => {
                let tables = decoded();
                let color = &tables.bytes[usize::from(srgb)];
                Self::pixel(&values[at..][..self.channels], |byte, is_color| {
                    let table = if is_color { color } else { &tables.bytes[0] };
                    table[usize::from(byte)]
                })
            }
            TexelValues::Shorts(values) => {
                Self::pixel(&values[at..][..self.channels], |short, is_color| {
                    if srgb && is_color {
                        decoded_shorts()[usize::from(short)]
                    } else {
                        f32::from(short) / 65535.0
                    }
                })
            }
            TexelValues::Floats(values) => {
                Self::pixel(&values[at..][..self.channels], |value, is_color| {
                    if srgb && is_color { decode(value) } else { value }
                })
            }
        }
    }

    /// Between four pixels, which [`Texels::get`] gives: so large a part of the way, 0 to 1, from the first column
    /// to the second, and from the first row to the second.
    ///
    /// # Panics
    /// If there is no such pixel.
    #[inline]
    pub fn between(
        &self,
        [left, right]: [u32; 2],
        [upper, lower]: [u32; 2],
        parts: [f32; 2],
        srgb: bool,
    ) -> [f32; 4] {
        let TexelValues::Bytes(values) = &self.values else {
            let [a, b] = [[left, upper], [right, upper]].map(|place| self.get(place, srgb));
            let [c, d] = [[left, lower], [right, lower]].map(|place| self.get(place, srgb));
            return std::array::from_fn(|i| bilinear([a[i], b[i], c[i], d[i]], parts));
        };
        // Most images: what their numbers are is asked for once, and each channel goes its own way.
        let [upper, lower] = [upper, lower].map(|y| y as usize * self.size[0] as usize);
        let [left, right] = [left as usize, right as usize];
        let at = [upper + left, upper + right, lower + left, lower + right];
        match self.channels {
            1 => between_bytes::<1>(values, at, parts, srgb),
            2 => between_bytes::<2>(values, at, parts, srgb),
            3 => between_bytes::<3>(values, at, parts, srgb),
            _ => between_bytes::<4>(values, at, parts, srgb),
        }
    }

    #[inline(always)]
    fn pixel<T: Copy>(of: &[T], value: impl Fn(T, bool) -> f32) -> [f32; 4] {
        match *of {
            [grey] => {
                let grey = value(grey, true);
                [grey, grey, grey, 1.0]
            }
            [grey, opacity] => {
                let grey = value(grey, true);
                [grey, grey, grey, value(opacity, false)]
            }
            [r, g, b] => [value(r, true), value(g, true), value(b, true), 1.0],
            [r, g, b, opacity] => {
                [value(r, true), value(g, true), value(b, true), value(opacity, false)]
            }
            _ => [0.0; 4],
        }
    }

    /// The least and the largest value of red, green, blue and opacity, as [`Texels::get`] gives them.
    pub fn bounds(&self, srgb: bool) -> [[f32; 4]; 2] {
        self.bounds.map(|[r, g, b, a]| {
            let [r, g, b] = if srgb { [r, g, b].map(decode) } else { [r, g, b] };
            [r, g, b, a]
        })
    }

    /// The mean of all of it.
    pub fn mean(&self, srgb: bool) -> [f32; 4] {
        let mut sum = [0.0; 4];
        for y in 0..self.size[1] {
            for x in 0..self.size[0] {
                let pixel = self.get([x, y], srgb);
                sum.iter_mut().zip(pixel).for_each(|(sum, value)| *sum += f64::from(value));
            }
        }
        let count = f64::from(self.size[0]) * f64::from(self.size[1]);
        sum.map(|sum| (sum / count) as f32)
    }

    /// The image at half its size, rounded down, each side at least 1: the mean of linear values over the
    /// place of each pixel. `None`: it is one pixel large. It is made once, when it is first asked for, and
    /// kept. `srgb`: values are decoded, and encoded again.
    pub fn half(&self, srgb: bool) -> Option<&Arc<Self>> {
        self.halves[usize::from(srgb)]
            .get_or_init(|| halve::half(self, srgb).map(Arc::new))
            .as_ref()
    }
}

impl TexelValues {
    fn len(&self) -> usize {
        match self {
            Self::Bytes(values) => values.len(),
            Self::Shorts(values) => values.len(),
            Self::Floats(values) => values.len(),
        }
    }
}

impl Clone for Texels {
    fn clone(&self) -> Self {
        let (size, channels, bounds) = (self.size, self.channels, self.bounds);
        Self { size, channels, values: self.values.clone(), bounds, halves: self.halves.clone() }
    }
}

impl PartialEq for Texels {
    fn eq(&self, other: &Self) -> bool {
        self.size == other.size && self.channels == other.channels && self.values == other.values
    }
}

impl fmt::Debug for Texels {
    /// Without its numbers, which may be many.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kind = match self.values {
            TexelValues::Bytes(_) => "bytes",
            TexelValues::Shorts(_) => "16-bit numbers",
            TexelValues::Floats(_) => "floats",
        };
        let [width, height] = self.size;
        write!(f, "Texels({width} × {height} × {} {kind})", self.channels)
    }
}

impl fmt::Debug for TexelValues {
    /// How many there are.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "TexelValues({})", self.len())
    }
}

/// sRGB to linear; what is above 1 is no code of sRGB and stays, so that the curve is without a step.
fn decode(value: f32) -> f32 {
    if (0.0..=1.0).contains(&value) { srgb_decode(f64::from(value)) as f32 } else { value }
}

struct Decoded {
    /// What bytes are, as they are and as sRGB.
    bytes: [[f32; 256]; 2],
}

/// [`Texels::between`] of pixels of `N` bytes, by their numbers in the image.
#[inline(always)]
fn between_bytes<const N: usize>(
    values: &[u8],
    at: [usize; 4],
    parts: [f32; 2],
    srgb: bool,
) -> [f32; 4] {
    let pixel = |at: usize| -> &[u8; N] {
        values[at * N..].first_chunk().expect("the pixel is one of the image")
    };
    let [a, b, c, d] = [pixel(at[0]), pixel(at[1]), pixel(at[2]), pixel(at[3])];
    let Decoded { bytes: tables } = decoded();
    let channel = |i: usize, srgb: bool| {
        let value = |pixel: &[u8; N]| tables[usize::from(srgb)][usize::from(pixel[i])];
        bilinear([value(a), value(b), value(c), value(d)], parts)
    };
    let first = channel(0, srgb);
    match N {
        1 => [first, first, first, 1.0],
        2 => [first, first, first, channel(1, false)],
        3 => [first, channel(1, srgb), channel(2, srgb), 1.0],
        _ => [first, channel(1, srgb), channel(2, srgb), channel(3, false)],
    }
}

/// Between four numbers, in the upper row from the left, then in the lower one.
#[inline(always)]
fn bilinear([a, b, c, d]: [f32; 4], [across, down]: [f32; 2]) -> f32 {
    let (upper, lower) = (a + across * (b - a), c + across * (d - c));
    upper + down * (lower - upper)
}

fn decoded() -> &'static Decoded {
    static DECODED: OnceLock<Decoded> = OnceLock::new();
    DECODED.get_or_init(|| {
        let plain = std::array::from_fn(|byte| byte as f32 / 255.0);
        let srgb = std::array::from_fn(|byte| srgb_decode(byte as f64 / 255.0) as f32);
        Decoded { bytes: [plain, srgb] }
    })
}

fn decoded_shorts() -> &'static [f32] {
    static DECODED: OnceLock<Vec<f32>> = OnceLock::new();
    DECODED.get_or_init(|| {
        (0..=u16::MAX).map(|short| srgb_decode(f64::from(short) / 65535.0) as f32).collect()
    })
}

/// The least and the largest value of each of the four channels.
fn bounds(values: &TexelValues, channels: usize) -> [[f32; 4]; 2] {
    fn each<T: Copy + PartialOrd>(
        values: &[T],
        channels: usize,
        of: impl Fn(T) -> f32,
    ) -> [Vec<f32>; 2] {
        let lesser = |a: T, b: T| if b < a { b } else { a };
        let greater = |a: T, b: T| if b > a { b } else { a };
        let mut least = values[..channels].repeat(64);
        let mut most = least.clone();
        // Sixty-four pixels side by side, so that none waits for the one before it.
        for pixels in values.chunks(64 * channels) {
            for ((least, most), &value) in least.iter_mut().zip(&mut most).zip(pixels) {
                *least = lesser(*least, value);
                *most = greater(*most, value);
            }
        }
        for i in channels..least.len() {
            least[i % channels] = lesser(least[i % channels], least[i]);
            most[i % channels] = greater(most[i % channels], most[i]);
        }
        [least, most].map(|bound| bound[..channels].iter().map(|&value| of(value)).collect())
    }
    let both = match values {
        TexelValues::Bytes(values) => each(values, channels, |byte| f32::from(byte) / 255.0),
        TexelValues::Shorts(values) => each(values, channels, |short| f32::from(short) / 65535.0),
        TexelValues::Floats(values) => each(values, channels, |value| value),
    };
    both.map(|bound| match bound[..] {
        [grey] => [grey, grey, grey, 1.0],
        [grey, opacity] => [grey, grey, grey, opacity],
        [r, g, b] => [r, g, b, 1.0],
        [r, g, b, opacity] => [r, g, b, opacity],
        _ => [0.0; 4],
    })
}

#[cfg(test)]
mod tests;
