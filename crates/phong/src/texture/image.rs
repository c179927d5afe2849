//! Images, looked up between their pixels, and over as many of them as a sample of the picture covers.

use std::sync::{Arc, OnceLock};

use glam::DVec2;
use phong_scene::{Encoding, Rgb, TexelFilter, TexelValues, Texels, Wrap};

/// The most look-ups side by side along the longer axis of a footprint: what is still longer is blurred.
const MOST_TAPS: f64 = 16.0;

/// An image that can be looked up.
#[derive(Clone, Debug)]
pub(super) struct ImageTexture {
    texels: Arc<Texels>,
    /// Beside it, and above and below.
    wrap: [Wrap; 2],
    border: [f32; 4],
    /// What colours are multiplied by.
    tint: Rgb,
    filter: TexelFilter,
    encoding: Encoding,
    /// The image and its halves, of linear values and of sRGB ones, found when they are first needed.
    levels: [OnceLock<Vec<Arc<Texels>>>; 2],
}

/// How an image was looked up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImageLookUp {
    /// How often the image is halved: 0 the image itself; between whole numbers both neighbours count.
    pub level: f32,
    /// How many places side by side the mean is of.
    pub taps: u32,
}

impl ImageTexture {
    pub(super) fn new(
        texels: &Arc<Texels>,
        (wrap, border): ([Wrap; 2], Rgb),
        tint: Rgb,
        (filter, encoding): (TexelFilter, Encoding),
    ) -> Self {
        let Rgb { r, g, b } = border;
        Self {
            texels: Arc::clone(texels),
            wrap,
            border: [r, g, b, 0.0],
            tint,
            filter,
            encoding,
            levels: [OnceLock::new(), OnceLock::new()],
        }
    }

    /// Red, green, blue and opacity at a place, as the mean over a parallelogram about it with these sides.
    pub(super) fn value(&self, at: DVec2, sides: [DVec2; 2], is_color: bool) -> [f32; 4] {
        let srgb = match self.encoding {
            Encoding::Srgb => true,
            Encoding::Linear => false,
            Encoding::Auto => is_color && !matches!(self.texels.values(), TexelValues::Floats(_)),
        };
        // Rows run down from the upper edge.
        let at = DVec2::new(at.x, 1.0 - at.y);
        // Farther away than 1e100, times the size in pixels, may be infinite, and the part of a pixel then NaN.
        let is_near = at.is_finite() && at.abs().max_element() < 1e100;
        let at = if is_near { at } else { DVec2::ZERO };
        let [r, g, b, opacity] = match self.filter {
            TexelFilter::Nearest => self.nearest(at, srgb),
            TexelFilter::Linear => self.between(&self.texels, at, srgb),
            TexelFilter::Auto => self.mean(at, sides.map(|side| DVec2::new(side.x, -side.y)), srgb),
        };
        let tint = self.tint;
        [tint.r * r, tint.g * g, tint.b * b, opacity]
    }

    /// How [`ImageTexture::value`] looks up.
    pub(super) fn look_up(&self, sides: [DVec2; 2]) -> ImageLookUp {
        match self.filter {
            TexelFilter::Auto => {
                let Spread { taps, level, part, .. } = self.spread(sides);
                ImageLookUp { level: level as f32 + part, taps }
            }
            TexelFilter::Nearest | TexelFilter::Linear => ImageLookUp { level: 0.0, taps: 1 },
        }
    }

    fn mean(&self, at: DVec2, sides: [DVec2; 2], srgb: bool) -> [f32; 4] {
        let Spread { along, taps, level, part } = self.spread(sides);
        if (taps, level, part) == (1, 0, 0.0) {
            return self.between(&self.texels, at, srgb);
        }
        let levels = self.levels(srgb);
        // What is between two levels is before the last.
        let (near, far) = (&levels[level], &levels[level + usize::from(part > 0.0)]);
        let mut sum = [0.0; 4];
        for tap in 0..taps {
            let place = at + along * ((f64::from(tap) + 0.5) / f64::from(taps) - 0.5);
            let mut value = self.between(near, place, srgb);
            if part > 0.0 {
                value = mix(value, self.between(far, place, srgb), part);
            }
            for (sum, value) in sum.iter_mut().zip(value) {
                *sum += value;
            }
        }
        let [r, g, b, opacity] = sum;
        let taps = taps as f32;
        [r / taps, g / taps, b / taps, opacity / taps]
    }

    /// How a parallelogram is covered: by places along its longer side, each about as wide as the shorter.
    fn spread(&self, sides: [DVec2; 2]) -> Spread {
        let [width, height] = self.texels.size().map(f64::from);
        let length = |side: DVec2| (side * DVec2::new(width, height)).length();
        let [a, b] = sides.map(length);
        let (along, long, short) = if a > b { (sides[0], a, b) } else { (sides[1], b, a) };
        // A footprint of less than a pixel, or NaN: one look-up in the image itself is enough.
        if long.is_nan() || long <= 1.0 {
            return Spread { along: DVec2::ZERO, taps: 1, level: 0, part: 0.0 };
        }
        let most = width.max(height);
        // Each level has half the pixels of the one before along its longer side, rounded down.
        let last = log2(most).0;
        if long > MOST_TAPS * most {
            // All of the image, many times.
            return Spread { along: DVec2::ZERO, taps: 1, level: last, part: 0.0 };
        }
        let short = short.max(long / MOST_TAPS).max(1.0);
        let (level, part) = if short < most { log2(short) } else { (last, 0.0) };
        let part = if level < last { part } else { 0.0 };
        Spread { along, taps: (long / short).ceil().clamp(1.0, MOST_TAPS) as u32, level, part }
    }

    fn levels(&self, srgb: bool) -> &[Arc<Texels>] {
        self.levels[usize::from(srgb)].get_or_init(|| {
            let mut levels = vec![Arc::clone(&self.texels)];
            while let Some(half) = levels.last().and_then(|last| last.half(srgb)).cloned() {
                levels.push(half);
            }
            levels
        })
    }

    fn nearest(&self, at: DVec2, srgb: bool) -> [f32; 4] {
        let place = at * DVec2::from(self.texels.size().map(f64::from));
        self.texel(&self.texels, [place.x, place.y].map(|x| whole(x) as i64), srgb)
    }

    /// The value between the four pixels about a place.
    fn between(&self, texels: &Texels, at: DVec2, srgb: bool) -> [f32; 4] {
        let [width, height] = texels.size();
        let place = at * DVec2::new(f64::from(width), f64::from(height)) - 0.5;
        let corner = DVec2::new(whole(place.x), whole(place.y));
        let part = (place - corner).as_vec2();
        let [x, y] = [corner.x as i64, corner.y as i64];
        let [right, lower] = [x.saturating_add(1), y.saturating_add(1)];
        let column = |x: i64| wrapped(x, width, self.wrap[0]);
        let row = |y: i64| wrapped(y, height, self.wrap[1]);
        let [a, b, c, d] = match (column(x), column(right), row(y), row(lower)) {
            (Some(x), Some(right), Some(y), Some(lower)) => {
                texels.four([x, right], [y, lower], srgb)
            }
            _ => [[x, y], [right, y], [x, lower], [right, lower]]
                .map(|place| self.texel(texels, place, srgb)),
        };
        mix(mix(a, b, part.x), mix(c, d, part.x), part.y)
    }

    /// A pixel of the image or beside it.
    fn texel(&self, texels: &Texels, [x, y]: [i64; 2], srgb: bool) -> [f32; 4] {
        let [width, height] = texels.size();
        match (wrapped(x, width, self.wrap[0]), wrapped(y, height, self.wrap[1])) {
            (Some(x), Some(y)) => texels.get([x, y], srgb),
            _ => self.border,
        }
    }
}

/// From `a` towards `b`, a part of the way.
#[inline(always)]
fn mix(a: [f32; 4], b: [f32; 4], part: f32) -> [f32; 4] {
    let channel = |c: usize| a[c] + part * (b[c] - a[c]);
    [channel(0), channel(1), channel(2), channel(3)]
}

/// The largest whole number that is not above `x`, which is finite: `f64::floor`, which is a call where the
/// processor is not known to have an instruction for it.
#[inline(always)]
fn whole(x: f64) -> f64 {
    /// From here on all numbers are whole.
    const ALL_WHOLE: f64 = (1_u64 << 52) as f64;
    if x.abs() >= ALL_WHOLE {
        return x;
    }
    let toward_zero = x as i64 as f64;
    if toward_zero > x { toward_zero - 1.0 } else { toward_zero }
}

/// How a footprint is covered.
struct Spread {
    /// Its longer side.
    along: DVec2,
    /// How many places along it.
    taps: u32,
    /// How often the image is halved, and the share of the next half.
    level: usize,
    part: f32,
}

/// The column or row that stands for one that may be beside the image; `None`: its border.
fn wrapped(i: i64, count: u32, wrap: Wrap) -> Option<u32> {
    let n = i64::from(count);
    Some(match wrap {
        _ if (0..n).contains(&i) => i,
        // Without a division where it does.
        Wrap::Repeat if count.is_power_of_two() => i & (n - 1),
        Wrap::Repeat => i.rem_euclid(n),
        Wrap::Mirror => {
            let i = i.rem_euclid(2 * n);
            i.min(2 * n - 1 - i)
        }
        Wrap::Clamp => i.clamp(0, n - 1),
        Wrap::Border => return None,
    } as u32)
}

/// The logarithm to base 2 of a number of at least 1: the whole part, and a part in [0, 1) that runs linearly
/// between powers of two, which is all that mixing two levels asks for.
fn log2(x: f64) -> (usize, f32) {
    let exponent = (x.to_bits() >> 52 & 0x7ff) as i32 - 1023;
    let mantissa = f64::from_bits(x.to_bits() & ((1 << 52) - 1) | 1023 << 52);
    (exponent.max(0) as usize, (mantissa - 1.0) as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(size: [u32; 2], bytes: &[u8], wrap: Wrap, filter: TexelFilter) -> ImageTexture {
        let channels = bytes.len() / (size[0] * size[1]) as usize;
        let values = TexelValues::Bytes(bytes.to_vec());
        let texels = Arc::new(Texels::new(size, channels, values).expect("an image"));
        ImageTexture::new(&texels, ([wrap; 2], Rgb::BLACK), Rgb::WHITE, (filter, Encoding::Linear))
    }

    #[test]
    fn the_first_row_of_an_image_is_its_upper_edge() {
        let image = image([2, 2], &[0, 51, 102, 255], Wrap::Repeat, TexelFilter::Nearest);
        let at = |u, v| image.value(DVec2::new(u, v), [DVec2::ZERO; 2], true)[0];
        assert_eq!([at(0.1, 0.9), at(0.9, 0.9), at(0.1, 0.1), at(0.9, 0.1)], [0.0, 0.2, 0.4, 1.0]);
    }

    #[test]
    fn beside_an_image_is_what_wrap_says() {
        let at = |wrap, u: f64| {
            let image = image([2, 1], &[51, 255], wrap, TexelFilter::Nearest);
            image.value(DVec2::new(u, 0.5), [DVec2::ZERO; 2], true)
        };
        let [a, b, none] = [[0.2, 0.2, 0.2, 1.0], [1.0; 4], [0.0; 4]];
        for (wrap, want) in [
            (Wrap::Repeat, [a, b, a, b]),
            (Wrap::Mirror, [b, a, b, a]),
            (Wrap::Clamp, [a, a, b, b]),
            (Wrap::Border, [none; 4]),
        ] {
            let got = [-0.9, -0.1, 1.1, 1.9].map(|u| at(wrap, u));
            assert_eq!(got, want, "{wrap:?}");
        }
        assert_eq!(at(Wrap::Repeat, 1e300), at(Wrap::Repeat, 1e300), "far away is no panic");
        at(Wrap::Repeat, f64::NAN);
    }

    #[test]
    fn above_an_image_may_be_something_else_than_beside_it() {
        let pixels = TexelValues::Bytes(vec![51, 255]);
        let texels = Arc::new(Texels::new([2, 1], 1, pixels).expect("an image"));
        let wrap = [Wrap::Repeat, Wrap::Border];
        let how = (TexelFilter::Nearest, Encoding::Linear);
        let image = ImageTexture::new(&texels, (wrap, Rgb::BLACK), Rgb::WHITE, how);
        let at = |u, v| image.value(DVec2::new(u, v), [DVec2::ZERO; 2], true)[0];
        assert_eq!([at(1.2, 0.5), at(1.7, 0.5), at(0.7, 1.5)], [0.2, 1.0, 0.0]);
    }

    #[test]
    fn however_far_away_values_are_numbers() {
        for filter in [TexelFilter::Linear, TexelFilter::Auto] {
            let image = image([2, 1], &[51, 255], Wrap::Repeat, filter);
            for far in [1e99, 1e101, 1.7e308, -1.7e308] {
                for side in [0.0, 1.0, 1e300] {
                    let sides = [DVec2::new(side, 0.0), DVec2::new(0.0, side)];
                    let value = image.value(DVec2::splat(far), sides, true);
                    assert!(value.iter().all(|v| v.is_finite()), "{far}, {side}: {value:?}");
                }
            }
        }
    }

    #[test]
    fn between_pixels_values_run_linearly() {
        let image = image([2, 1], &[0, 255], Wrap::Clamp, TexelFilter::Linear);
        let at = |u: f64| image.value(DVec2::new(u, 0.5), [DVec2::ZERO; 2], true)[0];
        assert_eq!([0.0, 0.25, 0.5, 0.75, 1.0].map(at), [0.0, 0.0, 0.5, 1.0, 1.0]);
    }

    #[test]
    fn a_wide_footprint_is_the_mean_of_what_it_covers() {
        let squares: Vec<u8> =
            (0..64).map(|i| if (i + i / 8) % 2 == 0 { 255 } else { 0 }).collect();
        let image = image([8, 8], &squares, Wrap::Repeat, TexelFilter::Auto);
        let at = |sides| image.value(DVec2::new(0.31, 0.62), sides, true)[0];
        let side = |x, y| DVec2::new(x, y);
        for sides in [
            [side(0.5, 0.0), side(0.0, 0.5)],
            [side(1.0, 0.0), side(0.0, 0.25)],
            [side(1e9, 0.0), side(0.0, 1e-9)],
            [side(f64::INFINITY, 0.0), side(0.0, 1.0)],
        ] {
            assert!((at(sides) - 0.5).abs() < 0.01, "{sides:?}: {}", at(sides));
        }
        let narrow = [side(0.01, 0.0), side(0.0, 0.01)];
        assert_eq!(image.look_up(narrow), ImageLookUp { level: 0.0, taps: 1 });
        let long = [side(1.0, 0.0), side(0.0, 0.25)];
        assert_eq!(image.look_up(long), ImageLookUp { level: 1.0, taps: 4 });
    }

    #[test]
    fn the_largest_whole_number_below_is_that_of_the_standard_library() {
        let far = (1_u64 << 52) as f64;
        for x in [0.0, 0.5, 1.0, 2.999, 1e9 + 0.5, far - 0.5, far, far + 1.0, 1e300] {
            assert_eq!([whole(x), whole(-x)], [x.floor(), (-x).floor()], "{x}");
        }
    }

    #[test]
    fn the_logarithm_is_exact_at_powers_of_two_and_grows() {
        assert_eq!(
            [1.0, 2.0, 3.0, 4.0, 1024.0].map(log2),
            [(0, 0.0), (1, 0.0), (1, 0.5), (2, 0.0), (10, 0.0)]
        );
    }
}
