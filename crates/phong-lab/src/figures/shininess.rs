//! How the exponent narrows the highlight.

use phong::math::{lobe, wide};

use super::drawing::Drawing;
use super::mark::{Anchor, Path, Point, Stroke};
use super::plot::{Plot, fixed, ticks};
use super::{Number, Plate, Setting, style};

const TITLE: &str = "Shininess";
const EQUATION: &str = "cos(*x*)^{*i*}";

/// The lecture's exponents.
const EXPONENTS: [u32; 6] = [1, 2, 4, 8, 16, 32];

pub(super) fn draw(_: Setting) -> Plate {
    let half_widths = EXPONENTS.map(|i| cosine_power(i.into()).half_width);
    let numbers = EXPONENTS
        .iter()
        .zip(half_widths)
        .map(|(i, degrees)| Number::new(format!("half width, i = {i}"), degrees, "°"));
    Plate {
        title: TITLE,
        equation: EQUATION,
        caption: "The higher the exponent, the faster the highlight falls off; half its peak is \
                  left at the half width, acos(2^(−1/i)).",
        numbers: numbers.collect(),
        drawing: drawing(&half_widths),
    }
}

/// `cos(x)^i` as the renderer has it.
fn falloff(degrees: f64, i: f64) -> f64 {
    let cosine = wide::cos(degrees.to_radians()) as f32;
    f64::from(lobe(cosine, i as f32))
}

/// The share of a highlight's peak by the angle from it, for one exponent.
#[derive(Clone, Debug, PartialEq)]
pub struct Falloff {
    /// The first and the last angle, degrees.
    pub range: [f64; 2],
    /// `cos(x)^i` from the first angle to the last, at equal distances.
    pub curve: Vec<f64>,
    /// The angle at which one half of the peak is left, degrees.
    pub half_width: f64,
}

/// `cos(x)^exponent` from one horizon to the other.
#[must_use]
pub fn cosine_power(exponent: f64) -> Falloff {
    let range = [-90.0, 90.0];
    let curve = (-90..=90).map(|degrees| falloff(f64::from(degrees), exponent)).collect();
    let half_width = half_width(|degrees| falloff(degrees, exponent));
    Falloff { range, curve, half_width }
}

/// The angle in degrees at which a falloff from 1 at 0° is down to one half, by bisection.
///
/// In f32 a falloff may be exactly ½ over a short stretch; its middle is meant.
pub(super) fn half_width(falloff: impl Fn(f64) -> f64) -> f64 {
    let last = |above_half: &dyn Fn(f64) -> bool| {
        let (mut inside, mut outside) = (0.0, 90.0);
        for _ in 0..60 {
            let middle = 0.5 * (inside + outside);
            if above_half(falloff(middle)) { inside = middle } else { outside = middle }
        }
        inside
    };
    0.5 * (last(&|share| share > 0.5) + last(&|share| share >= 0.5))
}

fn drawing(half_widths: &[f64; 6]) -> Drawing {
    let mut drawing = Drawing::slide();
    drawing.header(TITLE, EQUATION);
    let corners = [Point::new(96.0, 92.0), Point::new(680.0, 462.0)];
    let plot = Plot { corners, x: [-90.0, 90.0], y: [0.0, 1.0] };
    let x_ticks = ticks(&[-90.0, -60.0, -30.0, 0.0, 30.0, 60.0, 90.0], "°");
    plot.axes(&mut drawing, &x_ticks, &ticks(&[0.0, 0.25, 0.5, 0.75, 1.0], ""));
    plot.names(
        &mut drawing,
        "*x*, from the direction of mirror reflection",
        "share of the peak",
        56.0,
    );
    let half = Stroke::new(style::MIRROR, style::LINE).dashed();
    drawing.line(plot.at(-90.0, 0.5), plot.at(90.0, 0.5), half);

    let shades = style::FAMILY;
    for (&i, &shade) in EXPONENTS.iter().zip(&shades) {
        let stroke = Stroke::new(shade, style::CURVE);
        plot.curve(&mut drawing, [-90.0, 90.0], 180, |x| falloff(x, i.into()), stroke);
    }
    for &degrees in half_widths {
        plot.dot(&mut drawing, degrees, 0.5, style::MIRROR);
    }

    let (swatch, exponent, width) = (724.0, 800.0, 908.0);
    let head = 128.0;
    drawing.text(Point::new(exponent, head), Anchor::End, style::NOTE, style::MUTED, "*i*");
    drawing.text(Point::new(width, head), Anchor::End, style::NOTE, style::MUTED, "half width");
    for (row, (&i, &shade)) in EXPONENTS.iter().zip(&shades).enumerate() {
        let y = head + 38.0 + 40.0 * row as f64;
        let ends = [Point::new(swatch, y - 5.0), Point::new(swatch + 44.0, y - 5.0)];
        drawing.stroke(Path::polyline(ends), Stroke::new(shade, 4.0));
        let number = i.to_string();
        drawing.text(Point::new(exponent, y), Anchor::End, style::HEADING, style::TEXT, &number);
        let degrees = format!("{}°", fixed(half_widths[row], 3));
        drawing.text(Point::new(width, y), Anchor::End, style::HEADING, style::MIRROR, &degrees);
    }
    let y = head + 38.0 + 40.0 * EXPONENTS.len() as f64 + 8.0;
    drawing.text(Point::new(width, y), Anchor::End, style::NOTE, style::MUTED, "acos 2^{−1/*i*}");
    drawing
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_half_widths_are_those_of_the_closed_form() {
        let expected = [60.0, 45.0, 32.7651, 23.5081, 16.7437, 11.8825];
        let numbers = draw(Setting::DRAFT).numbers;
        for ((i, number), degrees) in EXPONENTS.iter().zip(&numbers).zip(expected) {
            assert_eq!(number.name, format!("half width, i = {i}"));
            assert!((number.value - degrees).abs() < 1e-4, "{number:?}");
        }
    }
}
