//! Lines that are drawn around things when a film is done, and what they need of it.

use std::fmt;

use phong_scene::{Image, Outline, Rgb};

use crate::aov::Aov;

/// Pixels an inch where nobody says.
const DPI: f64 = 96.0;

/// How often the corners of lines are moved towards their neighbours.
pub(crate) const SMOOTHINGS: u32 = 4;

/// Lines around things, in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lines {
    /// Width in pixels, > 0.
    pub width: f32,
    /// Colour, linear.
    pub color: Rgb,
    /// Whether they run where one object ends.
    pub objects: bool,
    /// The least jump of the distance within an object, as a share of it; 0: none counts.
    pub depth: f32,
    /// The least angle between normals within an object, degrees; 180: none counts.
    pub crease: f32,
}

impl Lines {
    /// The widest, in pixels: what is wider becomes so wide.
    pub const WIDEST: f32 = 64.0;

    /// The variables of a film that they are drawn by.
    pub const NEEDS: [Aov; 3] = [Aov::Object, Aov::Depth, Aov::Normal];

    /// A scene's lines in its picture.
    pub fn of(outline: &Outline, image: &Image) -> Self {
        let pixels = outline.width * image.dpi.unwrap_or(DPI) / 72.0;
        Self {
            width: (pixels as f32).clamp(f32::MIN_POSITIVE, Self::WIDEST),
            color: outline.color,
            objects: outline.objects,
            depth: outline.depth as f32,
            crease: outline.crease as f32,
        }
    }

    /// How many pixels around a part of a picture they are made of.
    pub(crate) fn margin(&self) -> u32 {
        (0.5 * self.width).ceil() as u32 + SMOOTHINGS + 3
    }

    /// What it was written as, by [`Display`](fmt::Display); `None`: that was none.
    pub(crate) fn from_text(text: &str) -> Option<Self> {
        let numbers = text.split(' ').map(|number| number.parse().ok());
        let numbers: Vec<f32> = numbers.collect::<Option<_>>()?;
        let [width, r, g, b, objects, depth, crease] = <[f32; 7]>::try_from(numbers).ok()?;
        let color = Rgb::new(r, g, b);
        let sound = width > 0.0 && width <= Self::WIDEST && color.max_channel().is_finite();
        sound.then_some(Self { width, color, objects: objects != 0.0, depth, crease })
    }
}

impl fmt::Display for Lines {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { width, color: Rgb { r, g, b }, objects, depth, crease } = self;
        write!(f, "{width} {r} {g} {b} {} {depth} {crease}", u8::from(*objects))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_become_pixels_by_the_dots_an_inch() {
        let outline = Outline { width: 1.5, ..Outline::default() };
        let image = |dpi| Image { dpi, ..Image::default() };
        assert_eq!(Lines::of(&outline, &image(None)).width, 2.0);
        assert_eq!(Lines::of(&outline, &image(Some(288.0))).width, 6.0);
    }

    #[test]
    fn lines_are_read_back_from_their_text() {
        let outline = Outline { color: Rgb::new(0.1, 0.2, 1e-7), ..Outline::default() };
        let lines = Lines::of(&outline, &Image::default());
        assert_eq!(Lines::from_text(&lines.to_string()), Some(lines));
        assert_eq!(Lines::from_text("1 2 3"), None);
        assert_eq!(Lines::from_text("0 0 0 0 1 0.02 40"), None);
    }
}
