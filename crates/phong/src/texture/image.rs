//! Images, looked up between their pixels, and over as many of them as a sample of the picture covers.

use std::sync::{Arc, OnceLock};

use fearless_simd::{Fallback, Simd, f64x4, prelude::*};
use glam::DVec2;
use phong_bvh::Lanes;
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
        let [at, a, b] = [at, sides[0], sides[1]].map(alone);
        self.values(Fallback::new(), 1, &at, &[a, b], is_color).map(|all| all[0])
    }

    /// [`ImageTexture::value`] at some of eight places side by side, a bit each in `lanes`: the same bits. Unspecified
    /// in other lanes.
    #[inline(always)]
    pub(super) fn values<S: Simd>(
        &self,
        simd: S,
        lanes: u32,
        at: &[[f64; 8]; 2],
        sides: &[[[f64; 8]; 2]; 2],
        is_color: bool,
    ) -> [[f32; 8]; 4] {
        let srgb = match self.encoding {
            Encoding::Srgb => true,
            Encoding::Linear => false,
            Encoding::Auto => is_color && !matches!(self.texels.values(), TexelValues::Floats(_)),
        };
        let (mut spread, mut levels) = (Spread::POINTS, std::slice::from_ref(&self.texels));
        if self.filter == TexelFilter::Auto {
            levels = self.levels(srgb);
            spread = Spread::of(simd, self.texels.size(), lanes, sides);
        }
        let mut sums = match self.filter {
            TexelFilter::Nearest => self.nearest(lanes, at, srgb),
            _ => self.sums(simd, levels, lanes, at, &spread, srgb),
        };
        let Rgb { r, g, b } = self.tint;
        for (sums, tint) in sums.iter_mut().zip([r, g, b, 1.0]) {
            for (sum, taps) in sums.iter_mut().zip(spread.taps) {
                *sum = tint * (*sum / taps as f32);
            }
        }
        sums
    }

    /// How [`ImageTexture::value`] looks up.
    pub(super) fn look_up(&self, sides: [DVec2; 2]) -> ImageLookUp {
        match self.filter {
            TexelFilter::Auto => {
                let sides = sides.map(alone);
                let spread = Spread::of(Fallback::new(), self.texels.size(), 1, &sides);
                let level = spread.level[0] as f32 + spread.part[0];
                ImageLookUp { level, taps: spread.taps[0] as u32 }
            }
            TexelFilter::Nearest | TexelFilter::Linear => ImageLookUp { level: 0.0, taps: 1 },
        }
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

    fn nearest(&self, lanes: u32, [u, v]: &[[f64; 8]; 2], srgb: bool) -> [[f32; 8]; 4] {
        let [width, height] = self.texels.size().map(f64::from);
        let mut values = [[0.0; 8]; 4];
        for lane in phong_bvh::lanes(lanes) {
            // Rows run down from the upper edge.
            let [(x, _), (y, _)] = [split(u[lane] * width), split((1.0 - v[lane]) * height)];
            let [column, _] = wrapped(x, width, self.wrap[0]);
            let [row, _] = wrapped(y, height, self.wrap[1]);
            let value = self.inside(&self.texels, [number(column), number(row)], srgb);
            (0..4).for_each(|c| values[c][lane] = value[c]);
        }
        values
    }

    /// The sum of what the taps of each footprint find.
    #[inline(always)]
    fn sums<S: Simd>(
        &self,
        simd: S,
        levels: &[Arc<Texels>],
        lanes: u32,
        [u, v]: &[[f64; 8]; 2],
        spread: &Spread,
        srgb: bool,
    ) -> [[f32; 8]; 4] {
        let mut sums = [[0.0; 8]; 4];
        let mut taps = phong_bvh::lanes(lanes)
            .flat_map(|lane| (0..spread.taps[lane] as u32).map(move |tap| (lane, tap)));
        loop {
            let mut four = Taps::NONE;
            for (lane, tap) in taps.by_ref().take(4) {
                let i = four.count % 4;
                let way = (f64::from(tap) + 0.5) / spread.taps[lane] - 0.5;
                four.lane[i] = lane;
                four.place[0][i] = u[lane] + way * spread.along[0][lane];
                // Rows run down from the upper edge.
                four.place[1][i] = (1.0 - v[lane]) - way * spread.along[1][lane];
                (four.level[i], four.part[i]) = (spread.level[lane], spread.part[lane]);
                four.count = i + 1;
            }
            if four.count == 0 {
                return sums;
            }
            let values = self.between_levels(simd, levels, &four, srgb);
            for (value, &lane) in values.iter().zip(&four.lane).take(four.count) {
                for (sums, value) in sums.iter_mut().zip(value) {
                    sums[lane & 7] += value;
                }
            }
        }
    }

    /// Red, green, blue and opacity at each of four places, between its level and the next.
    #[inline(always)]
    fn between_levels<S: Simd>(
        &self,
        simd: S,
        levels: &[Arc<Texels>],
        four: &Taps,
        srgb: bool,
    ) -> [[f32; 4]; 4] {
        let (mut level, mut values) = (four.level, [[0.0; 4]; 4]);
        for is_far in [false, true] {
            let found = self.at_level(simd, levels, &level, four, srgb);
            if !is_far {
                values = found;
                if four.part == [0.0; 4] {
                    break;
                }
            }
            for i in 0..4 {
                // What is between two levels is before the last.
                level[i] += u32::from(four.part[i] > 0.0);
                values[i] = mix(values[i], found[i], four.part[i]);
            }
        }
        values
    }

    /// Red, green, blue and opacity at each of four places in its level, between the four pixels about it.
    #[inline(always)]
    fn at_level<S: Simd>(
        &self,
        simd: S,
        levels: &[Arc<Texels>],
        level: &[u32; 4],
        four: &Taps,
        srgb: bool,
    ) -> [[f32; 4]; 4] {
        let mut size = [[1.0; 4]; 2];
        for (i, &level) in level.iter().enumerate() {
            let [width, height] = levels[level as usize].size();
            (size[0][i], size[1][i]) = (f64::from(width), f64::from(height));
        }
        let (columns, across) = neighbours(simd, &four.place[0], &size[0], self.wrap[0]);
        let (rows, down) = neighbours(simd, &four.place[1], &size[1], self.wrap[1]);
        let mut values = [[0.0; 4]; 4];
        for i in 0..four.count {
            let texels = &levels[level[i] as usize];
            let columns = [number(columns[0][i]), number(columns[1][i])];
            let rows = [number(rows[0][i]), number(rows[1][i])];
            let parts = [across[i] as f32, down[i] as f32];
            values[i] = if self.wrap.contains(&Wrap::Border) {
                let [upper, lower] = rows.map(|y| {
                    let [left, right] = columns.map(|x| self.inside(texels, [x, y], srgb));
                    mix(left, right, parts[0])
                });
                mix(upper, lower, parts[1])
            } else {
                texels.between(columns, rows, parts, srgb)
            };
        }
        values
    }

    /// A pixel of the image, or its border where a column or row is beside it.
    fn inside(&self, texels: &Texels, place: [u32; 2], srgb: bool) -> [f32; 4] {
        if place.contains(&BESIDE) { self.border } else { texels.get(place, srgb) }
    }
}

/// The column or row of what is beside an image with a border.
const BESIDE: u32 = u32::MAX;

/// Four places that are looked up.
struct Taps {
    /// How many there are of them. The numbers of the others are those of an image's corner.
    count: usize,
    /// Which footprint each belongs to.
    lane: [usize; 4],
    /// How far to the right in the image, and how far down.
    place: [[f64; 4]; 2],
    /// How often the image is halved, and the share of the next half.
    level: [u32; 4],
    part: [f32; 4],
}

impl Taps {
    const NONE: Self =
        Self { count: 0, lane: [0; 4], place: [[0.0; 4]; 2], level: [0; 4], part: [0.0; 4] };
}

/// How eight footprints are covered: by places along the longer side of each, each about as wide as the shorter.
struct Spread {
    /// The longer side.
    along: [[f64; 8]; 2],
    /// How many places along it: a whole number.
    taps: [f64; 8],
    /// How often the image is halved, and the share of the next half.
    level: [u32; 8],
    part: [f32; 8],
}

impl Spread {
    /// One place each in the image itself.
    const POINTS: Self =
        Self { along: [[0.0; 8]; 2], taps: [1.0; 8], level: [0; 8], part: [0.0; 8] };

    /// How parallelograms of these sides are covered by an image of this size, in some of eight lanes.
    #[inline(always)]
    fn of<S: Simd>(simd: S, size: [u32; 2], lanes: u32, [a, b]: &[[[f64; 8]; 2]; 2]) -> Self {
        let size = size.map(f64::from);
        let mut spread = Self::POINTS;
        for half in (0..2).filter(|half| lanes >> (4 * half) & 0xf != 0) {
            let four = 4 * half..4 * half + 4;
            let load = |all: &[f64; 8]| f64x4::from_slice(simd, &all[four.clone()]);
            let sides = [[load(&a[0]), load(&a[1])], [load(&b[0]), load(&b[1])]];
            let (along, taps, width) = covered(size, sides);
            along[0].store_slice(&mut spread.along[0][four.clone()]);
            along[1].store_slice(&mut spread.along[1][four.clone()]);
            taps.store_slice(&mut spread.taps[four.clone()]);
            let width: [f64; 4] = width.into();
            for (lane, width) in four.zip(width) {
                (spread.level[lane], spread.part[lane]) = level(size, width);
            }
        }
        spread
    }
}

/// How a parallelogram is covered by an image of this size: its longer side, how many places along it are looked up,
/// and how wide each is, in pixels, at least 1 and at most all of the image.
#[inline(always)]
fn covered<F: Lanes<Scalar = f64>>(
    [width, height]: [f64; 2],
    [a, b]: [[F; 2]; 2],
) -> ([F; 2], F, F) {
    let length = |[x, y]: [F; 2]| {
        let (x, y) = (x * width, y * height);
        (x * x + y * y).sqrt()
    };
    let (of_a, of_b) = (length(a), length(b));
    let is_a = of_a.gt(of_b);
    let (long, short) = (F::select(is_a, of_a, of_b), F::select(is_a, of_b, of_a));
    let along = [F::select(is_a, a[0], b[0]), F::select(is_a, a[1], b[1])];
    let (one, none) = (long.splat(1.0), long.splat(0.0));
    let most = long.splat(width.max(height));
    // Of a footprint of less than a pixel, or NaN, one look-up in the image itself is enough; of one of all of the image,
    // many times, one in the last level.
    let is_wide = long.gt(one);
    let is_all = long.gt(most * MOST_TAPS);
    let short = short.max(long / MOST_TAPS).max(one);
    let taps = ceil(long / short);
    let taps = F::select(taps.lt(long.splat(MOST_TAPS)), taps, long.splat(MOST_TAPS));
    let is_long = is_wide & !is_all;
    let along = [F::select(is_long, along[0], none), F::select(is_long, along[1], none)];
    let width = F::select(is_wide, F::select(short.lt(most), short, most), one);
    (along, F::select(is_long, taps, one), width)
}

/// How often an image of this size is halved so that what is `width` pixels wide becomes one, and the share of the next
/// half: the logarithm to base 2, whose part in [0, 1) runs linearly between powers of two, which is all that mixing two
/// levels asks for.
#[inline(always)]
fn level([w, h]: [f64; 2], width: f64) -> (u32, f32) {
    let exponent = |x: f64| (x.to_bits() >> 52) as u32 - 1023;
    // Each level has half the pixels of the one before along its longer side, rounded down.
    let (last, level) = (exponent(w.max(h)), exponent(width));
    let mantissa = f64::from_bits(width.to_bits() & ((1 << 52) - 1) | 1023 << 52);
    if level < last { (level, (mantissa - 1.0) as f32) } else { (last, 0.0) }
}

/// The columns of the pixels before and behind four places, of images so many pixels wide; and how far each is from the
/// one towards the other. Or rows.
#[inline(always)]
fn neighbours<S: Simd>(
    simd: S,
    at: &[f64; 4],
    size: &[f64; 4],
    wrap: Wrap,
) -> ([[f64; 4]; 2], [f64; 4]) {
    let (at, size) = (f64x4::load_array_ref(simd, at), f64x4::load_array_ref(simd, size));
    let (before, part) = split(at * size - 0.5);
    let [before, behind] = wrapped(before, size, wrap);
    ([before.into(), behind.into()], part.into())
}

/// Numbers that are alone, in the first of eight lanes.
fn alone(v: DVec2) -> [[f64; 8]; 2] {
    let lanes = |x: f64| [x, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    [lanes(v.x), lanes(v.y)]
}

/// From here on `f64` has no parts of whole numbers: the last bits of what is about this one are a whole number.
const WHOLE: f64 = (3_u64 << 51) as f64;

/// A number as the largest whole one that is not above it, and the part in [0, 1) beyond that: 0 of what is farther
/// away than 2^50, or NaN.
#[inline(always)]
fn split<F: Lanes<Scalar = f64>>(x: F) -> (F, F) {
    let is_near = x.abs().lt(x.splat((1_u64 << 50) as f64));
    let x = F::select(is_near, x, x.splat(0.0));
    let whole = floor(x);
    (whole, x - whole)
}

/// The largest whole number that is not above `x`, which is less than 2^51.
#[inline(always)]
fn floor<F: Lanes<Scalar = f64>>(x: F) -> F {
    let nearest = (x + WHOLE) - WHOLE;
    nearest - F::select(nearest.gt(x), x.splat(1.0), x.splat(0.0))
}

/// The least whole number that is not below `x`, which is less than 2^51.
#[inline(always)]
fn ceil<F: Lanes<Scalar = f64>>(x: F) -> F {
    -floor(-x)
}

/// A whole number from −1 on, which is [`BESIDE`].
#[inline(always)]
fn number(x: f64) -> u32 {
    (x + WHOLE).to_bits() as u32
}

/// The columns or rows, of so many, that stand for one which may be beside the image, and for the next; −1: its
/// border. All are whole numbers.
#[inline(always)]
fn wrapped<F: Lanes<Scalar = f64>>(i: F, count: F, wrap: Wrap) -> [F; 2] {
    let (none, next) = (i.splat(0.0), i + 1.0);
    let least = |a: F, b: F| F::select(a.lt(b), a, b);
    match wrap {
        Wrap::Repeat => rest(i, count),
        Wrap::Mirror => {
            let [a, b] = rest(i, count * 2.0);
            let last = count * 2.0 - 1.0;
            [least(a, last - a), least(b, last - b)]
        }
        Wrap::Clamp => {
            let last = count - 1.0;
            [least(i, last).max(none), least(next, last).max(none)]
        }
        Wrap::Border => {
            let or_beside = |i: F| F::select(i.gt(i.splat(-1.0)) & i.lt(count), i, i.splat(-1.0));
            [or_beside(i), or_beside(next)]
        }
    }
}

/// What is left of a whole number, and of the next, without full periods.
#[inline(always)]
fn rest<F: Lanes<Scalar = f64>>(i: F, period: F) -> [F; 2] {
    // How many these are may be off by one, but not what is taken away for them.
    let rest = i - period * floor(i / period);
    let none = i.splat(0.0);
    let rest = F::select(rest.lt(none), rest + period, rest);
    let rest = F::select(rest.lt(period), rest, rest - period);
    let next = rest + 1.0;
    [rest, F::select(next.lt(period), next, none)]
}

/// From `a` towards `b`, a part of the way.
#[inline(always)]
fn mix(a: [f32; 4], b: [f32; 4], part: f32) -> [f32; 4] {
    let channel = |c: usize| a[c] + part * (b[c] - a[c]);
    [channel(0), channel(1), channel(2), channel(3)]
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
    fn a_number_is_split_as_the_standard_library_does() {
        for x in [0.0_f64, 0.25, 0.5, 1.0, 1.5, 2.999, 1e9 + 0.5, 7e14 + 0.25] {
            for x in [x, -x] {
                assert_eq!(split(x), (x.floor(), x - x.floor()), "{x}");
                assert_eq!(ceil(x), x.ceil(), "{x}");
            }
        }
        for far in [2e15, -2e15, 1e300, f64::INFINITY, f64::NAN] {
            assert_eq!(split(far), (0.0, 0.0), "{far}");
        }
    }

    #[test]
    fn columns_are_wrapped_as_whole_numbers_are() {
        let far = (1_i64 << 50) - 1;
        let places = (-40..40).chain([far, far - 1, -far, 999_999_937]);
        for (i, count) in places.flat_map(|i| [1, 2, 3, 7, 8, 1000].map(|count| (i, count))) {
            let both = |wrap| wrapped(i as f64, count as f64, wrap).map(|i| i as i64);
            let next = [i, i + 1];
            assert_eq!(both(Wrap::Repeat), next.map(|i| i.rem_euclid(count)), "{i}, {count}");
            let mirrored = next.map(|i| i.rem_euclid(2 * count)).map(|i| i.min(2 * count - 1 - i));
            assert_eq!(both(Wrap::Mirror), mirrored, "{i}, {count}");
            assert_eq!(both(Wrap::Clamp), next.map(|i| i.clamp(0, count - 1)), "{i}, {count}");
            let inside = next.map(|i| if (0..count).contains(&i) { i } else { -1 });
            assert_eq!(both(Wrap::Border), inside, "{i}, {count}");
        }
        assert_eq!([number(0.0), number(70_000.0), number(-1.0)], [0, 70_000, BESIDE]);
    }

    #[test]
    fn levels_are_exact_at_powers_of_two_and_grow_between() {
        let level = |width: f64| {
            let sides = [[width / 4096.0, 0.0], [0.0, width / 4096.0]];
            level([4096.0; 2], covered([4096.0; 2], sides).2)
        };
        let want = [(0, 0.0), (0, 0.0), (1, 0.0), (1, 0.5), (2, 0.0), (10, 0.0), (12, 0.0)];
        assert_eq!([0.3, 1.0, 2.0, 3.0, 4.0, 1024.0, 1e9].map(level), want);
    }

    #[test]
    fn eight_places_side_by_side_have_the_bits_of_each_by_itself() {
        let bytes: Vec<u8> = (0..8 * 16 * 3).map(|i| (i * 37 % 251) as u8).collect();
        for wrap in [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp, Wrap::Border] {
            for filter in [TexelFilter::Auto, TexelFilter::Linear, TexelFilter::Nearest] {
                let image = image([8, 16], &bytes, wrap, filter);
                let at = |k: f64| std::array::from_fn(|i| (i as f64 - 2.5) * k);
                let (u, v) = (at(0.37), at(0.91));
                let sides = [[at(0.21), at(0.05)], [at(-0.003), at(0.61)]];
                let eight = image.values(Fallback::new(), 0xb7, &[u, v], &sides, true);
                for lane in [0, 1, 2, 4, 5, 7] {
                    let side = |[x, y]: [[f64; 8]; 2]| DVec2::new(x[lane], y[lane]);
                    let one = image.value(DVec2::new(u[lane], v[lane]), sides.map(side), true);
                    assert_eq!(eight.map(|all| all[lane]), one, "{wrap:?} {filter:?} {lane}");
                }
            }
        }
    }
}
