//! The difference of two pictures as a picture of its own: a map in colours, and their scale.

use phong::film::{Film, LayerKind, Window};
use phong::image::{Picture, Transfer};
use phong::render::RenderOptions;
use phong_scene::srgb_decode;

use super::{Comparison, color};
use crate::figures::{Lettering, lettering};

/// Narrower drawings are enlarged, by whole pixels, so that the scale has room.
const LEAST_WIDTH: usize = 240;
/// Around everything, and between pictures.
const MARGIN: usize = 8;
/// Height of the scale's bar.
const BAR: usize = 10;
/// Size of the letters, pixels.
const LETTER: f64 = 13.0;
/// Height of a line of letters.
const LINE: usize = 17;
/// Of a pixel that is finite in one picture only: green, which the map has not.
const NOT_FINITE: [f32; 3] = [0.0, 1.0, 0.0];
const PAPER: [f32; 3] = [1.0; 3];
const INK: [f32; 3] = [0.0; 3];

/// A drawing of the largest difference of each pixel, in colours from near black (none) to
/// near white, above the scale with its numbers; green where a value is finite in one picture only.
///
/// With `pictures` those two stand before it, under the letters A and B. Small pictures are
/// enlarged by whole pixels. The scale ends at the first 1, 2 or 5 times a power of ten that no
/// finite difference is above.
pub fn draw(found: &Comparison, size: [u32; 2], pictures: Option<[&Picture; 2]>) -> Film {
    let [width, height] = size.map(|side| side as usize);
    let panels = if pictures.is_some() { 3 } else { 1 };
    let gaps = (panels - 1) * MARGIN;
    let zoom = LEAST_WIDTH.div_ceil(panels * width).max(1);
    let across = panels * width * zoom + gaps;
    let title = if pictures.is_some() { LINE + 4 } else { 0 };
    let top = MARGIN + title;
    let bar = top + height * zoom + MARGIN;
    let size = [across + 2 * MARGIN, bar + BAR + 6 + LINE + MARGIN].map(|side| side as u32);
    let mut canvas = Canvas::new(size);
    let scale = Scale::reaching(found.largest.iter().copied());
    let differs = |i: usize| match found.largest[i] {
        d if d.is_finite() => color(f64::from(d) / scale.end()),
        _ => NOT_FINITE,
    };
    if let Some(pictures) = pictures {
        for (k, (picture, letter)) in pictures.into_iter().zip(["A", "B"]).enumerate() {
            let left = MARGIN + k * (width * zoom + MARGIN);
            canvas.picture([left, top], [width, height], zoom, |i| shown(picture, i));
            canvas.text([left, MARGIN], letter);
        }
    }
    let left = MARGIN + (panels - 1) * (width * zoom + MARGIN);
    canvas.picture([left, top], [width, height], zoom, differs);
    if panels > 1 {
        canvas.text([left, MARGIN], "|A − B|");
    }
    canvas.scale([MARGIN, bar], across, &scale, found.not_finite > 0);
    canvas.film
}

/// A pixel of a picture in linear values; black where it has no colours.
fn shown(picture: &Picture, i: usize) -> [f32; 3] {
    let Some(planes) = picture.rgb() else { return INK };
    planes.map(|plane| match picture.transfer {
        Transfer::Linear => plane[i],
        Transfer::Srgb => srgb_decode(f64::from(plane[i])) as f32,
    })
}

/// Ticks at whole multiples of `mantissa` × 10^`exponent`.
#[derive(Debug, PartialEq, Eq)]
struct Scale {
    mantissa: u32,
    exponent: i32,
    steps: u32,
}

impl Scale {
    /// The scale to the first 1, 2 or 5 × 10^k that no finite value is above; to 1 if all are 0.
    fn reaching(values: impl Iterator<Item = f32>) -> Self {
        let most = f64::from(values.filter(|v| v.is_finite()).fold(0.0, f32::max));
        if most == 0.0 {
            return Self { mantissa: 2, exponent: -1, steps: 5 };
        }
        let mut exponent = libm::floor(libm::log10(most)) as i32 - 1;
        loop {
            for (mantissa, steps) in [(2, 5), (5, 4), (10, 5)] {
                let scale = Self { mantissa, exponent, steps };
                if scale.end() >= most {
                    return scale;
                }
            }
            exponent += 1;
        }
    }

    fn end(&self) -> f64 {
        self.value(self.steps)
    }

    /// The value at a tick: the decimal number itself, not a product of rounded ones.
    fn value(&self, tick: u32) -> f64 {
        let decimal = format!("{}e{}", tick * self.mantissa, self.exponent);
        decimal.parse().unwrap_or(f64::INFINITY)
    }

    fn label(&self, tick: u32) -> String {
        let value = self.value(tick);
        if value == 0.0 || (1e-3..1e4).contains(&self.end()) {
            value.to_string()
        } else {
            format!("{value:E}")
        }
    }
}

/// What is drawn on, in linear values.
struct Canvas {
    film: Film,
}

impl Canvas {
    fn new(size: [u32; 2]) -> Self {
        let kinds = [LayerKind::Picture];
        let mut film = Film::new(size, Window::full(size), RenderOptions::TILE, &kinds);
        for pixel in film.layers[0].values.chunks_exact_mut(3) {
            pixel.copy_from_slice(&PAPER);
        }
        Self { film }
    }

    /// A block of one colour; what would lie beyond the edge is left out.
    fn block(&mut self, [x, y]: [usize; 2], [width, height]: [usize; 2], color: [f32; 3]) {
        let across = self.film.width() as usize;
        let right = (x + width).min(across);
        for row in y..(y + height).min(self.film.height() as usize) {
            for column in x..right {
                let at = 3 * (row * across + column);
                self.film.layers[0].values[at..at + 3].copy_from_slice(&color);
            }
        }
    }

    fn picture(
        &mut self,
        [left, top]: [usize; 2],
        [width, height]: [usize; 2],
        zoom: usize,
        at: impl Fn(usize) -> [f32; 3],
    ) {
        for y in 0..height {
            for x in 0..width {
                let corner = [left + x * zoom, top + y * zoom];
                self.block(corner, [zoom; 2], at(y * width + x));
            }
        }
    }

    /// The bar with its numbers; before it, if `not_finite`, what green means.
    fn scale(&mut self, at: [usize; 2], across: usize, scale: &Scale, not_finite: bool) {
        let [mut left, top] = at;
        let mut across = across;
        if not_finite {
            let words = lettering("not finite", LETTER);
            let room = words.width;
            self.block([left, top], [room, BAR], NOT_FINITE);
            self.letters([left, top + BAR + 4], &words);
            left += room + 2 * MARGIN;
            across -= room + 2 * MARGIN;
        }
        for x in 0..across {
            let t = x as f64 / (across - 1) as f64;
            self.block([left + x, top], [1, BAR], color(t));
        }
        for tick in 0..=scale.steps {
            let x = left + (across - 1) * tick as usize / scale.steps as usize;
            self.block([x, top + BAR], [1, 4], INK);
            let label = lettering(&scale.label(tick), LETTER);
            let width = label.width;
            // In the middle below its tick, but within the bar.
            let start = x.saturating_sub(width / 2).clamp(left, left + across - width.min(across));
            self.letters([start, top + BAR + 4], &label);
        }
    }

    fn text(&mut self, at: [usize; 2], words: &str) {
        self.letters(at, &lettering(words, LETTER));
    }

    /// Ink, as far as the letters cover each pixel; what would lie beyond the edge is left out.
    fn letters(&mut self, [x, y]: [usize; 2], letters: &Lettering) {
        let (width, height) = (self.film.width() as usize, self.film.height() as usize);
        for (i, coverage) in letters.coverage.iter().enumerate() {
            let (column, row) = (x + i % letters.width, y + i / letters.width);
            if column < width && row < height && *coverage > 0.0 {
                let at = 3 * (row * width + column);
                for (value, ink) in self.film.layers[0].values[at..at + 3].iter_mut().zip(INK) {
                    *value += coverage * (ink - *value);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::compare;
    use phong::image::Plane;

    fn grey(size: [u32; 2], values: &[f32]) -> Picture {
        let plane = Plane { name: "Y".to_owned(), values: values.to_vec() };
        Picture { size, planes: vec![plane], transfer: Transfer::Linear, levels: None, lossy: None }
    }

    #[test]
    fn a_scale_ends_at_the_first_round_number_above() {
        let end = |most: f32| {
            let scale = Scale::reaching([0.0, most].into_iter());
            (scale.end(), scale.label(1), scale.label(scale.steps))
        };
        assert_eq!(end(0.0), (1.0, "0.2".to_owned(), "1".to_owned()));
        assert_eq!(end(0.75), (1.0, "0.2".to_owned(), "1".to_owned()));
        assert_eq!(end(1.0), (1.0, "0.2".to_owned(), "1".to_owned()));
        assert_eq!(end(1.01), (2.0, "0.5".to_owned(), "2".to_owned()));
        assert_eq!(end(0.03), (0.05, "0.01".to_owned(), "0.05".to_owned()));
        assert_eq!(end(3e-5), (5e-5, "1E-5".to_owned(), "5E-5".to_owned()));
        assert_eq!(end(2e38).2, "2E38");
        assert_eq!(end(f32::INFINITY).0, 1.0, "what is not finite has no place on it");
    }

    #[test]
    fn a_map_shows_each_pixel_by_its_own_difference() {
        let a = grey([120, 2], &[0.0; 240]);
        let mut values = [0.0; 240];
        values[121] = 0.5;
        values[5] = f32::NAN;
        let found = compare(&a, &grey([120, 2], &values)).unwrap();
        let film = draw(&found, [120, 2], None);
        // Enlarged twice, beside a margin of 8.
        let at = |x: u32, y: u32| film.at(LayerKind::Picture, 8 + 2 * x, 8 + 2 * y).unwrap();
        assert_eq!(at(0, 0), color(0.0));
        assert_eq!(at(1, 1), color(1.0));
        assert_eq!(at(5, 0), NOT_FINITE);
        assert_eq!(film.width(), 2 * 120 + 16);
    }

    #[test]
    fn two_pictures_stand_before_the_map_of_their_difference() {
        let (a, b) = (grey([100, 50], &vec![0.25; 5000]), grey([100, 50], &vec![0.75; 5000]));
        let found = compare(&a, &b).unwrap();
        let film = draw(&found, [100, 50], Some([&a, &b]));
        let row = 8 + 21 + 20;
        let at = |x: u32| film.at(LayerKind::Picture, x, row).unwrap().to_vec();
        assert_eq!(at(58), [0.25; 3]);
        assert_eq!(at(166), [0.75; 3]);
        assert_eq!(at(274), color(0.5 / 0.5).to_vec());
        assert_eq!(film.width(), 3 * 100 + 2 * 8 + 16);
    }

    #[test]
    fn even_one_pixel_has_a_scale() {
        let (a, b) = (grey([1, 1], &[0.0]), grey([1, 1], &[f32::INFINITY]));
        let film = draw(&compare(&a, &b).unwrap(), [1, 1], Some([&a, &b]));
        assert!(film.width() >= LEAST_WIDTH as u32);
    }
}
