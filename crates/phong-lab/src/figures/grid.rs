//! The specular coefficient against the shininess.

use glam::DVec3;
use phong::film::{Film, LayerKind};
use phong_scene::{ConstantMaterial, Scene};

use super::drawing::Drawing;
use super::mark::{Anchor, Bitmap, Point, Stroke};
use super::plot::fixed;
use super::stage::{self, Spot, ball, distant, plastic};
use super::{Number, Plate, Setting, style};

const TITLE: &str = "Specular coefficient and shininess";
const EQUATION: &str = "*k*_s (*r*·*e*)^{*α*} *C*_s";
/// The direction to the light.
const TO_LIGHT: DVec3 = DVec3::new(0.8, 1.0, 1.4);
const WEIGHTS: [f32; 3] = [0.25, 0.5, 0.75];
const EXPONENTS: [f32; 3] = [3.0, 9.0, 200.0];

pub(super) fn draw(setting: Setting) -> Plate {
    let mut numbers = Vec::new();
    for k_s in WEIGHTS {
        for alpha in EXPONENTS {
            let spots = stage::spots(&stage::measured(&scene(k_s, alpha, setting)));
            numbers.push(Number::new(format!("peak, k_s {k_s}, α {alpha}"), peak(&spots), ""));
        }
    }
    let areas = EXPONENTS.map(|alpha| {
        let spots = stage::spots(&stage::measured(&scene(WEIGHTS[2], alpha, setting)));
        let half = 0.5 * peak(&spots);
        let above = spots.iter().filter(|spot| value(spot) > half).count();
        above as f64 / spots.len() as f64
    });
    for (alpha, area) in EXPONENTS.iter().zip(areas) {
        numbers.push(Number::new(format!("share above half the peak, α {alpha}"), area, ""));
    }
    Plate {
        title: TITLE,
        equation: EQUATION,
        caption: "The coefficient scales the highlight and the exponent narrows it: the peak \
                  stays at k_s while the area above half of it shrinks.",
        numbers,
        drawing: drawing(areas, setting),
    }
}

fn scene(k_s: f32, alpha: f32, setting: Setting) -> Scene {
    let material =
        ConstantMaterial { k_a: 0.15, k_d: 0.6, k_s, shininess: alpha, ..plastic(setting) };
    ball(material, vec![distant(TO_LIGHT, 1.0)], DVec3::Z)
}

fn value(spot: &Spot) -> f64 {
    f64::from(spot.terms.specular.b)
}

fn peak(spots: &[Spot]) -> f64 {
    spots.iter().map(value).fold(0.0, f64::max)
}

fn drawing(areas: [f64; 3], setting: Setting) -> Drawing {
    let mut drawing = Drawing::slide();
    drawing.header(TITLE, EQUATION);
    let (left, top, step, size) = (128.0, 104.0, 142.0, 132.0);
    let corner = |row: usize, column: usize| {
        Point::new(left + step * column as f64, top + step * row as f64)
    };
    for (row, k_s) in WEIGHTS.into_iter().enumerate() {
        let beside = corner(row, 0) + Point::new(-14.0, 0.5 * size + 6.0);
        let words = format!("*k*_s = {k_s}");
        drawing.text(beside, Anchor::End, style::HEADING, style::TEXT, &words);
        for (column, alpha) in EXPONENTS.into_iter().enumerate() {
            let film = stage::shown(&scene(k_s, alpha, setting), Point::splat(size), setting);
            let at = corner(row, column);
            drawing.image(at, Point::splat(size), stage::bitmap(&film, &[LayerKind::Picture]));
            if [row, column] == [0, 2] {
                stage::light_from(&mut drawing, TO_LIGHT, DVec3::Z, at, size);
            }
            if row == 0 {
                let above = at + Point::new(0.5 * size, -10.0);
                drawing.heading(above, &format!("*α* = {alpha}"));
            }
        }
    }

    let middle = 770.0;
    drawing.heading(Point::new(middle, 130.0), "above half the peak");
    for (line, alpha) in EXPONENTS.into_iter().enumerate() {
        let size = 104.0;
        let at = Point::new(middle - 120.0, 150.0 + 118.0 * line as f64);
        let film = stage::shown(&scene(WEIGHTS[2], alpha, setting), Point::splat(size), setting);
        let ring = Some(Stroke::new(style::SURFACE, style::LINE));
        let center = at + Point::splat(0.5 * size);
        drawing.circle(center, size / stage::VIEW, Some(style::BODY), ring);
        drawing.image(at, Point::splat(size), above_half(&film));
        let words = format!("*α* = {alpha}");
        let beside = center + Point::new(76.0, -4.0);
        drawing.text(beside, Anchor::Start, style::HEADING, style::TEXT, &words);
        let share = format!("{} % of the disc", fixed(100.0 * areas[line], 2));
        let under = beside + Point::new(0.0, 24.0);
        drawing.text(under, Anchor::Start, style::NOTE, style::MUTED, &share);
    }
    drawing
}

/// The pixels whose specular term is above half its peak, in one colour.
fn above_half(film: &Film) -> Bitmap {
    let values = film.layer(stage::SPECULAR).map_or(&[][..], |layer| &layer.values);
    let peak = values.iter().copied().fold(0.0, f32::max);
    let [r, g, b] = style::MIRROR.srgb;
    let pixel = |rgb: &[f32]| [r, g, b, if rgb[2] > 0.5 * peak { 255 } else { 0 }];
    let rgba = values.chunks_exact(3).flat_map(pixel).collect();
    Bitmap { width: film.width(), height: film.height(), rgba }
}

#[cfg(test)]
mod tests {
    use super::*;
    use phong::math::lobe;

    #[test]
    fn the_specular_image_is_its_coefficient_times_one_lobe() {
        for alpha in EXPONENTS {
            let [quarter, half, most] = WEIGHTS
                .map(|k_s| stage::spots(&stage::measured(&scene(k_s, alpha, Setting::DRAFT))));
            for ((quarter, half), most) in quarter.iter().zip(&half).zip(&most) {
                // Doubling is exact down to where f32 loses bits.
                assert!((value(half) - 2.0 * value(quarter)).abs() < f32::MIN_POSITIVE.into());
                assert!((value(most) - 3.0 * value(quarter)).abs() < 1e-7);
            }
        }
    }

    #[test]
    fn the_area_above_half_the_peak_shrinks_as_the_exponent_grows() {
        let numbers = draw(Setting::DRAFT).numbers;
        let areas: Vec<f64> = numbers[9..].iter().map(|number| number.value).collect();
        assert!(areas[0] > areas[1] && areas[1] > areas[2] && areas[2] > 0.0, "{areas:?}");
        for (number, k_s) in numbers[..9].iter().zip([0.25, 0.25, 0.25, 0.5, 0.5, 0.5]) {
            // At α = 200 a pixel may miss the peak by half a pixel's angle.
            let least = k_s * f64::from(lobe(0.9997, 200.0));
            assert!(number.value <= k_s && number.value >= least, "{number:?}");
        }
    }
}
