//! Cel steps: the luminance of a picture in a few steps from black to white, as cartoons are painted.
//!
//! A pixel's luminance is taken as the eye has it, on the sRGB curve, and becomes the nearest step; its colour is
//! scaled as its luminance is, so that hue and saturation stay. Where a step ends, a pixel shows as much of either
//! as it covers: it takes the mean, in light, over what the luminance runs through within it. That looks one pixel
//! around, so a part of a picture has the steps of the whole. Across the edge of a thing the luminance runs through
//! all that lies between the two sides, so that edges stay as smooth as they were.

use phong_scene::{Rgb, srgb_decode, srgb_encode};
use rayon::prelude::*;

use crate::film::{Film, LayerKind};

/// By what steps scale the light of each pixel of a film, exposed by the factor `gain`. What is black, or no light
/// at all, stays.
pub(super) fn scales(film: &Film, steps: u32, gain: f32) -> Vec<f32> {
    let Some(picture) = film.layer(LayerKind::Picture) else { return Vec::new() };
    let (pixels, alpha) = (picture.values.as_chunks::<3>().0, film.layer(LayerKind::Alpha));
    let stairs = Stairs::new(steps);
    let luminance = |i: usize| {
        let share = alpha.and_then(|alpha| alpha.values.get(i)).map_or(1.0, |&alpha| alpha);
        let y = f64::from(Rgb::from(pixels[i]).luminance()) * f64::from(gain) / f64::from(share);
        (y > 0.0 && y.is_finite()).then_some(y)
    };
    let heights = (0..pixels.len()).into_par_iter();
    let heights: Vec<Option<f64>> =
        heights.map(|i| luminance(i).map(|y| stairs.height(y))).collect();
    let [width, height] = [film.width(), film.height()].map(|side| side as usize);
    let scale = |i: usize| {
        let (Some(y), Some(own)) = (luminance(i), heights[i]) else { return 1.0 };
        let (x, row) = (i % width, i / width);
        let near = |there: bool, i: usize| heights.get(i).copied().flatten().filter(|_| there);
        let slopes = [
            slope(own, near(x > 0, i.wrapping_sub(1)), near(x + 1 < width, i + 1)),
            slope(own, near(row > 0, i.wrapping_sub(width)), near(row + 1 < height, i + width)),
        ];
        let run = (slopes[0] * slopes[0] + slopes[1] * slopes[1]).sqrt();
        (stairs.mean(own, run) / y) as f32
    };
    (0..pixels.len()).into_par_iter().map(scale).collect()
}

/// Scales the colours of a picture, by nothing where there are no scales.
pub(super) fn scale(picture: &mut [f32], scales: &[f32]) {
    for (pixel, scale) in picture.as_chunks_mut::<3>().0.iter_mut().zip(scales) {
        for value in pixel {
            *value *= scale;
        }
    }
}

/// How much a height changes from pixel to pixel, by those on either side of it: what both sides agree on, so that
/// the edge of a thing counts for the pixels alone that it runs through.
fn slope(own: f64, before: Option<f64>, beyond: Option<f64>) -> f64 {
    let (before, beyond) = (before.map(|before| own - before), beyond.map(|beyond| beyond - own));
    match (before, beyond) {
        (Some(a), Some(b)) if a * b <= 0.0 => 0.0,
        (Some(a), Some(b)) => a.abs().min(b.abs()),
        (Some(a), None) | (None, Some(a)) => a.abs(),
        (None, None) => 0.0,
    }
}

/// Steps of luminance: heights are from 0 to the number of the last step.
struct Stairs {
    /// The luminance of each step.
    levels: Vec<f64>,
    /// The sum of those before each.
    sums: Vec<f64>,
}

impl Stairs {
    fn new(steps: u32) -> Self {
        let last = f64::from(steps.max(2) - 1);
        let levels = (0..steps.max(2)).map(|step| srgb_decode(f64::from(step) / last));
        let levels: Vec<f64> = levels.collect();
        let sums = levels.iter().scan(0.0, |sum, level| {
            let before = *sum;
            *sum += level;
            Some(before)
        });
        Self { sums: sums.collect(), levels }
    }

    /// The height of a luminance; what is brighter than white is white.
    fn height(&self, luminance: f64) -> f64 {
        srgb_encode(luminance.min(1.0)) * (self.levels.len() - 1) as f64
    }

    /// The mean luminance of the steps that are nearest to the heights within half of `run` of `height`.
    fn mean(&self, height: f64, run: f64) -> f64 {
        /// Below this run it is one step to rounding.
        const LEVEL: f64 = 1e-6;
        if run < LEVEL {
            return self.levels[self.step(height + 0.5)];
        }
        let (from, to) = (height - 0.5 * run + 0.5, height + 0.5 * run + 0.5);
        (self.below(to) - self.below(from)) / run
    }

    /// The number of the step that a height counted from the middle below the first one is on.
    fn step(&self, from_first: f64) -> usize {
        (from_first.max(0.0) as usize).min(self.levels.len() - 1)
    }

    /// The integral of the steps' luminance up to a height counted so.
    fn below(&self, from_first: f64) -> f64 {
        let step = self.step(from_first);
        self.sums[step] + (from_first - step as f64) * self.levels[step]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::Window;

    /// A film of grey pixels as bright as the eye has it.
    fn film(size: [u32; 2], seen: impl Fn(u32, u32) -> f64) -> Film {
        let kinds = [LayerKind::Picture, LayerKind::Alpha];
        let mut film = Film::new(size, Window::full(size), 16, &kinds);
        let pixels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y)));
        let values = pixels.flat_map(|(x, y)| [srgb_decode(seen(x, y)) as f32; 3]);
        film.layers[0].values = values.collect();
        film.layers[1].values.fill(1.0);
        film
    }

    /// How bright the pixels come out, as the eye has it.
    fn stepped(film: &Film, steps: u32, gain: f32) -> Vec<f64> {
        let mut values = film.layers[0].values.clone();
        scale(&mut values, &scales(film, steps, gain));
        values.iter().step_by(3).map(|v| srgb_encode(f64::from(*v))).collect()
    }

    #[test]
    fn a_slope_comes_in_even_steps_with_one_pixel_between_two() {
        // Three steps over 40 pixels: they change at a quarter and at three quarters.
        let slope = film([40, 3], |x, _| (f64::from(x) + 0.5) / 40.0);
        let row = &stepped(&slope, 3, 1.0)[40..80];
        let near = |v: f64, to: f64| (v - to).abs() < 1e-6;
        let counts = [0.0, 0.5, 1.0].map(|to| row.iter().filter(|v| near(**v, to)).count());
        assert_eq!(counts, [10, 20, 10], "{row:?}");
        // A slope that crosses within a pixel shows half of either there.
        let slope = film([41, 3], |x, _| f64::from(x) / 40.0);
        let row = &stepped(&slope, 3, 1.0)[41..82];
        let half = srgb_encode(0.5 * srgb_decode(0.5));
        assert!(near(row[10], half), "{} and not {half}", row[10]);
        assert!(near(row[9], 0.0) && near(row[11], 0.5));
    }

    #[test]
    fn black_and_white_stay_and_colours_keep_their_hue() {
        let flat = |v: f64| film([3, 3], move |_, _| v);
        for (from, to) in [(0.0, 0.0), (0.2, 0.0), (0.6, 0.5), (1.0, 1.0), (1.4, 1.0)] {
            assert!((stepped(&flat(from), 3, 1.0)[4] - to).abs() < 1e-6, "{from}");
        }
        let mut red = flat(0.5);
        for pixel in red.layers[0].values.as_chunks_mut::<3>().0 {
            *pixel = [0.4, 0.1, 0.05];
        }
        let scales = scales(&red, 3, 1.0);
        assert!(scales.iter().all(|scale| *scale == scales[0] && *scale > 1.0));
    }

    #[test]
    fn steps_are_of_exposed_light() {
        let bright = film([3, 3], |_, _| srgb_encode(0.25));
        let [plain, exposed] = [1.0, 4.0].map(|gain| stepped(&bright, 2, gain)[4]);
        assert!((plain - 1.0).abs() < 1e-6, "it is beyond half of the way to white");
        assert!((srgb_decode(exposed) - 0.25).abs() < 1e-6, "four times that is white");
    }

    #[test]
    fn the_edge_of_a_thing_stays_smooth_and_changes_no_pixel_beside_it() {
        // Black, a pixel of which a part is covered, and white.
        let edge = film([9, 3], |x, _| [0.1, 0.6, 1.0][(x.clamp(3, 5) - 3) as usize]);
        let row = stepped(&edge, 2, 1.0);
        assert!(row[9 + 3] == 0.0 && row[9 + 5] > 0.999, "{row:?}");
        assert!((0.2..0.9).contains(&row[9 + 4]), "{row:?}");
    }

    #[test]
    fn what_is_no_light_stays_as_it_is() {
        let mut odd = film([3, 2], |_, _| 0.5);
        let values = [f32::NAN, f32::INFINITY, -1.0, 0.0, f32::MIN_POSITIVE, f32::MAX];
        for (pixel, value) in odd.layers[0].values.as_chunks_mut::<3>().0.iter_mut().zip(values) {
            *pixel = [value; 3];
        }
        odd.layers[1].values[3] = 0.0;
        let scales = scales(&odd, 4, 1.0);
        assert_eq!(scales[..4], [1.0; 4]);
        assert!(scales.iter().all(|scale| scale.is_finite() && *scale >= 0.0), "{scales:?}");
    }
}
