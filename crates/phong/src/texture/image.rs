//! Images, looked up between their pixels, and over as many of them as a sample of the picture covers.

use std::sync::{Arc, OnceLock};

use fearless_simd::Simd;
use glam::DVec2;
use phong_scene::{Encoding, Rgb, TexelFilter, TexelValues, Texels, Wrap};

use super::spread::{Spread, covered, level};
use super::wrap::{BESIDE, Side, neighbours, number, split, wrapped_alone};

/// An image that can be looked up.
#[derive(Clone, Debug)]
pub(super) struct ImageTexture {
    whole: Level,
    /// Beside it, and above and below.
    wrap: [Wrap; 2],
    border: [f32; 4],
    /// What colours are multiplied by.
    tint: Rgb,
    filter: TexelFilter,
    encoding: Encoding,
    /// The image and its halves, of linear values and of sRGB ones, found when they are first needed.
    levels: [OnceLock<Vec<Level>>; 2],
}

/// An image, or a half of one.
#[derive(Clone, Debug)]
struct Level {
    texels: Arc<Texels>,
    /// Its columns and its rows.
    sides: [Side<f64>; 2],
}

impl Level {
    fn new(texels: &Arc<Texels>) -> Self {
        Self { texels: Arc::clone(texels), sides: texels.size().map(Side::new) }
    }
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
            whole: Level::new(texels),
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
        let srgb = self.is_srgb(is_color);
        let sides = match self.filter {
            TexelFilter::Nearest => return self.tinted(self.nearest([at.x, at.y], srgb)),
            TexelFilter::Linear => [[0.0; 2]; 2],
            TexelFilter::Auto => sides.map(|side| [side.x, side.y]),
        };
        let size = self.whole.texels.size().map(f64::from);
        let (along, taps, width) = covered(size, sides);
        let (level, part) = level(size, width);
        let levels = if level > 0 || part > 0.0 { self.levels(srgb) } else { self.only_level() };
        let mut sum = [0.0; 4];
        for tap in 0..taps as u32 {
            let place = tap_place([at.x, at.y], along, (tap, taps));
            let mut value = self.at_place(&levels[level as usize].texels, place, srgb);
            if part > 0.0 {
                // What is between two levels is before the last.
                let far = self.at_place(&levels[level as usize + 1].texels, place, srgb);
                value = mix(value, far, part);
            }
            for (sum, value) in sum.iter_mut().zip(value) {
                *sum += value;
            }
        }
        let taps = taps as f32;
        self.tinted([sum[0] / taps, sum[1] / taps, sum[2] / taps, sum[3] / taps])
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
        let srgb = self.is_srgb(is_color);
        let (mut spread, mut levels) = (Spread::POINTS, self.only_level());
        match self.filter {
            TexelFilter::Nearest => {
                let mut values = [[0.0; 8]; 4];
                for lane in phong_bvh::lanes(lanes) {
                    let value = self.tinted(self.nearest([at[0][lane], at[1][lane]], srgb));
                    (0..4).for_each(|c| values[c][lane] = value[c]);
                }
                return values;
            }
            TexelFilter::Linear => {}
            TexelFilter::Auto => {
                spread = Spread::of(simd, self.whole.texels.size(), lanes, sides);
                // Halves are made only where they are needed.
                if spread.level != [0; 8] || spread.part != [0.0; 8] {
                    levels = self.levels(srgb);
                }
            }
        }
        let mut sums = self.sums(simd, levels, lanes, at, &spread, srgb);
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
                let size = self.whole.texels.size().map(f64::from);
                let (_, taps, width) = covered(size, sides.map(|side| [side.x, side.y]));
                let (level, part) = level(size, width);
                ImageLookUp { level: level as f32 + part, taps: taps as u32 }
            }
            TexelFilter::Nearest | TexelFilter::Linear => ImageLookUp { level: 0.0, taps: 1 },
        }
    }

    fn levels(&self, srgb: bool) -> &[Level] {
        self.levels[usize::from(srgb)].get_or_init(|| {
            let mut levels = vec![self.whole.clone()];
            while let Some(half) = levels.last().and_then(|last| last.texels.half(srgb)) {
                levels.push(Level::new(half));
            }
            levels
        })
    }

    /// The image itself.
    fn only_level(&self) -> &[Level] {
        std::slice::from_ref(&self.whole)
    }

    fn is_srgb(&self, is_color: bool) -> bool {
        match self.encoding {
            Encoding::Srgb => true,
            Encoding::Linear => false,
            Encoding::Auto => {
                is_color && !matches!(self.whole.texels.values(), TexelValues::Floats(_))
            }
        }
    }

    fn tinted(&self, [r, g, b, opacity]: [f32; 4]) -> [f32; 4] {
        [self.tint.r * r, self.tint.g * g, self.tint.b * b, opacity]
    }

    fn nearest(&self, [u, v]: [f64; 2], srgb: bool) -> [f32; 4] {
        let [width, height] = self.whole.texels.size();
        // Rows run down from the upper edge.
        let ((x, _), (y, _)) = (split(u * f64::from(width)), split((1.0 - v) * f64::from(height)));
        let column = wrapped_alone(x, width, self.wrap[0]);
        let row = wrapped_alone(y, height, self.wrap[1]);
        self.inside(&self.whole.texels, [column, row], srgb)
    }

    /// The value between the four pixels about a place, so far to the right and so far down.
    fn at_place(&self, texels: &Texels, [x, y]: [f64; 2], srgb: bool) -> [f32; 4] {
        let [width, height] = texels.size();
        let (x, across) = split(x * f64::from(width) - 0.5);
        let (y, down) = split(y * f64::from(height) - 0.5);
        let columns = [x, x + 1.0].map(|x| wrapped_alone(x, width, self.wrap[0]));
        let rows = [y, y + 1.0].map(|y| wrapped_alone(y, height, self.wrap[1]));
        self.between(texels, [columns, rows], [across, down], srgb)
    }

    /// The sum of what the taps of each footprint find.
    #[inline(always)]
    fn sums<S: Simd>(
        &self,
        simd: S,
        levels: &[Level],
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
                four.lane[i] = lane;
                let along = [spread.along[0][lane], spread.along[1][lane]];
                let [x, y] = tap_place([u[lane], v[lane]], along, (tap, spread.taps[lane]));
                (four.place[0][i], four.place[1][i]) = (x, y);
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
        levels: &[Level],
        four: &Taps,
        srgb: bool,
    ) -> [[f32; 4]; 4] {
        let Taps { level, part, .. } = four;
        let mut values = self.at_level(simd, levels, level, four, srgb);
        if *part != [0.0; 4] {
            // What is between two levels is before the last.
            let next = |i: usize| level[i] + u32::from(part[i] > 0.0);
            let next = [next(0), next(1), next(2), next(3)];
            let far = self.at_level(simd, levels, &next, four, srgb);
            for i in 0..4 {
                values[i] = mix(values[i], far[i], part[i]);
            }
        }
        values
    }

    /// Red, green, blue and opacity at each of four places in its level, between the four pixels about it.
    #[inline(always)]
    fn at_level<S: Simd>(
        &self,
        simd: S,
        levels: &[Level],
        level: &[u32; 4],
        four: &Taps,
        srgb: bool,
    ) -> [[f32; 4]; 4] {
        let of = |i: usize| &levels[level[i] as usize];
        let levels = [of(0), of(1), of(2), of(3)];
        let [a, b, c, d] = levels;
        let sides = |k: usize| [a.sides[k], b.sides[k], c.sides[k], d.sides[k]];
        let (columns, across) = neighbours(simd, &four.place[0], sides(0), self.wrap[0]);
        let (rows, down) = neighbours(simd, &four.place[1], sides(1), self.wrap[1]);
        let mut values = [[0.0; 4]; 4];
        for i in 0..four.count {
            let columns = [number(columns[0][i]), number(columns[1][i])];
            let rows = [number(rows[0][i]), number(rows[1][i])];
            let places = [columns, rows];
            values[i] = self.between(&levels[i].texels, places, [across[i], down[i]], srgb);
        }
        values
    }

    /// Between the pixels of two columns and two rows.
    #[inline(always)]
    fn between(
        &self,
        texels: &Texels,
        [columns, rows]: [[u32; 2]; 2],
        [across, down]: [f64; 2],
        srgb: bool,
    ) -> [f32; 4] {
        let (across, down) = (across as f32, down as f32);
        if self.wrap.contains(&Wrap::Border) {
            let [upper, lower] = rows.map(|y| {
                let [left, right] = columns.map(|x| self.inside(texels, [x, y], srgb));
                mix(left, right, across)
            });
            return mix(upper, lower, down);
        }
        texels.between(columns, rows, [across, down], srgb)
    }

    /// A pixel of the image, or its border where a column or row is beside it.
    fn inside(&self, texels: &Texels, place: [u32; 2], srgb: bool) -> [f32; 4] {
        if place.contains(&BESIDE) { self.border } else { texels.get(place, srgb) }
    }
}

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

/// Where one of `taps` look-ups along a footprint about a place is, how far to the right and how far down: rows run down
/// from the upper edge.
#[inline(always)]
fn tap_place([u, v]: [f64; 2], along: [f64; 2], (tap, taps): (u32, f64)) -> [f64; 2] {
    let way = (f64::from(tap) + 0.5) / taps - 0.5;
    [u + way * along[0], (1.0 - v) - way * along[1]]
}

/// From `a` towards `b`, a part of the way.
#[inline(always)]
fn mix(a: [f32; 4], b: [f32; 4], part: f32) -> [f32; 4] {
    let channel = |c: usize| a[c] + part * (b[c] - a[c]);
    [channel(0), channel(1), channel(2), channel(3)]
}

#[cfg(test)]
mod tests {
    use fearless_simd::Fallback;

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
