//! Pieces of figures that lie over a picture when all else is done: what they show is not exposed, and no
//! tone curve changes it.

use phong_scene::{Rgb, srgb_decode};

use crate::film::Window;

/// A piece that lies over a part of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Patch {
    /// Where, in pixels of the full picture.
    pub window: Window,
    /// Red, green, blue and opacity of each pixel as levels from 0 to 255, of sRGB and straight; rows from
    /// the top. As many as the window has.
    pub pixels: Vec<[u8; 4]>,
    /// Which of red, green and blue it covers: all, but in a picture whose channels are for different eyes.
    pub channels: [bool; 3],
}

impl Patch {
    /// Calls `each` with every pixel of it that is seen in a part of the picture, by its number there.
    fn over(&self, part: Window, mut each: impl FnMut(usize, [u8; 4])) {
        let here = self.window;
        let both = here.intersection(&part);
        for y in both.y0..both.y1 {
            for x in both.x0..both.x1 {
                let from = (y - here.y0) as usize * here.width() as usize + (x - here.x0) as usize;
                let to = (y - part.y0) as usize * part.width() as usize + (x - part.x0) as usize;
                match self.pixels.get(from) {
                    Some(&pixel) if pixel[3] > 0 => each(to, pixel),
                    _ => {}
                }
            }
        }
    }

    /// What of it is seen in a part of the picture, where that has its corner at `to` of another picture; `None`:
    /// nothing is.
    pub fn cut(&self, part: Window, [x, y]: [u32; 2]) -> Option<Self> {
        let both = self.window.intersection(&part);
        if both.x0 >= both.x1 || both.y0 >= both.y1 {
            return None;
        }
        let (x0, y0) = (x + (both.x0 - part.x0), y + (both.y0 - part.y0));
        let window = Window { x0, y0, x1: x0 + both.width(), y1: y0 + both.height() };
        let rows = (both.y0..both.y1).map(|row| {
            let from = (row - self.window.y0) as usize * self.window.width() as usize;
            let from = from + (both.x0 - self.window.x0) as usize;
            self.pixels.get(from..from + both.width() as usize).unwrap_or_default()
        });
        let pixels = rows.flatten().copied().collect();
        Some(Self { window, pixels, channels: self.channels })
    }

    /// Lays it over linear values of a part of a picture: three a pixel and premultiplied, and their alpha.
    pub(super) fn over_linear(&self, part: Window, [picture, alpha]: &mut [Vec<f32>; 2]) {
        self.over(part, |i, [r, g, b, a]| {
            let share = f32::from(a) / 255.0;
            let color = Rgb::from_srgb8([r, g, b]).to_array();
            let values = picture[3 * i..].iter_mut().zip(color).zip(self.channels);
            for ((value, color), _) in values.filter(|(_, covered)| *covered) {
                *value = *value * (1.0 - share) + color * share;
            }
            alpha[i] += (1.0 - alpha[i]) * share;
        });
    }

    /// Lays it over the levels of a part of a picture, as a PNG has them: of one byte, or of two with the high
    /// one first; four values a pixel where there is `alpha`, which is straight, else three. `linear`: they
    /// are on no curve.
    pub(crate) fn over_levels(
        &self,
        part: Window,
        bytes: &mut [u8],
        alpha: bool,
        size: usize,
        linear: bool,
    ) {
        let channels = if alpha { 4 } else { 3 };
        let most = if size == 1 { 255.0 } else { 65535.0 };
        self.over(part, |i, [r, g, b, a]| {
            let Some(pixel) = bytes.get_mut(i * channels * size..(i + 1) * channels * size) else {
                return;
            };
            let level = |at: usize, pixel: &[u8]| match size {
                1 => f64::from(pixel[at]) / most,
                _ => f64::from(u16::from_be_bytes([pixel[2 * at], pixel[2 * at + 1]])) / most,
            };
            let share = f64::from(a) / 255.0;
            let below = if alpha { level(3, pixel) } else { 1.0 };
            let whole = share + below * (1.0 - share);
            let mut levels = [0.0, 0.0, 0.0, whole];
            for (at, color) in [r, g, b].into_iter().enumerate() {
                let color = f64::from(color) / 255.0;
                let color = if linear { srgb_decode(color) } else { color };
                let under = level(at, pixel) * below;
                let light = color * share + under * (1.0 - share);
                levels[at] = if self.channels[at] { light } else { under } / whole;
            }
            for (to, level) in pixel.chunks_exact_mut(size).zip(levels) {
                let level = (level * most + 0.5) as u16;
                match to {
                    [to] => *to = level as u8,
                    _ => to.copy_from_slice(&level.to_be_bytes()),
                }
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PART: Window = Window { x0: 10, y0: 0, x1: 12, y1: 1 };

    /// Half red over the second pixel of the part, and something beside the part.
    fn patch() -> Patch {
        let window = Window { x0: 11, y0: 0, x1: 13, y1: 1 };
        Patch { window, pixels: vec![[255, 0, 0, 51], [9, 9, 9, 255]], channels: [true; 3] }
    }

    #[test]
    fn a_patch_of_some_channels_leaves_the_others_as_they_are() {
        let patch = Patch { channels: [false, true, true], ..patch() };
        let mut bytes = [100; 6];
        patch.over_levels(PART, &mut bytes, false, 1, false);
        assert_eq!(bytes, [100, 100, 100, 100, 80, 80]);
        let mut values = [vec![0.5; 6], vec![0.5; 2]];
        patch.over_linear(PART, &mut values);
        assert_eq!(values[0], [0.5, 0.5, 0.5, 0.5, 0.4, 0.4]);
    }

    #[test]
    fn a_patch_covers_the_levels_of_a_picture_by_its_opacity() {
        let mut bytes = [100, 100, 100, 100, 100, 100];
        patch().over_levels(PART, &mut bytes, false, 1, false);
        assert_eq!(bytes, [100, 100, 100, 131, 80, 80]);
        let mut bytes = [0, 0, 0, 0, 0, 0, 0, 0];
        patch().over_levels(PART, &mut bytes, true, 1, false);
        assert_eq!(bytes, [0, 0, 0, 0, 255, 0, 0, 51], "nothing is below it");
        let mut bytes = [0; 12];
        patch().over_levels(PART, &mut bytes, false, 2, true);
        assert_eq!(bytes[6..8], 13107_u16.to_be_bytes());
    }

    #[test]
    fn what_a_part_shows_of_a_patch_is_cut_out_of_it() {
        let cut = patch().cut(PART, [5, 7]).expect("a pixel of it");
        assert_eq!(cut.window, Window { x0: 6, y0: 7, x1: 7, y1: 8 });
        assert_eq!(cut.pixels, [[255, 0, 0, 51]]);
        assert_eq!(patch().cut(Window { x0: 0, x1: 11, ..PART }, [0, 0]), None);
    }

    #[test]
    fn a_patch_covers_linear_values_by_its_opacity() {
        let mut values = [vec![0.5; 6], vec![0.5; 2]];
        patch().over_linear(PART, &mut values);
        assert_eq!(values[0], [0.5, 0.5, 0.5, 0.6, 0.4, 0.4]);
        assert_eq!(values[1], [0.5, 0.6]);
    }
}
