//! The terms add up to the picture, and lights add up to their pictures' sum.

use glam::DVec3;
use phong::film::LayerKind;
use phong_scene::{Light, LightKind, Rgb};

use super::drawing::Drawing;
use super::mark::{Bitmap, Point};
use super::stage::{self, AMBIENT, DIFFUSE, SPECULAR, Spot, ball, distant, plastic};
use super::{Number, Plate, Setting, style};

const TITLE: &str = "The terms add up";
const EQUATION: &str = "*k*_a *C*_a + Σ (*k*_d (*l*·*n*) *C*_d + *k*_s (*r*·*e*)^{*α*} *C*_s)";

pub(super) fn draw(setting: Setting) -> Plate {
    let [first, second] = lights();
    let spots = |lights: Vec<Light>| stage::spots(&stage::measured(&scene(lights, setting)));
    let one = spots(vec![first.clone()]);
    let other = spots(vec![second.clone()]);
    let both = spots(vec![first.clone(), second.clone()]);
    let by_terms =
        |spot: &Spot| spot.terms.ambient + spot.terms.diffuse + spot.terms.specular - spot.sum;
    let by_lights = one
        .iter()
        .zip(&other)
        .zip(&both)
        .map(|((one, other), both)| one.sum + other.sum - one.terms.ambient - both.sum);
    let numbers = vec![
        Number::new("ambient + diffuse + specular − picture", worst(both.iter().map(by_terms)), ""),
        Number::new("image(1) + image(2) − ambient − image(1, 2)", worst(by_lights), ""),
        Number::new("pixels compared", both.len() as f64, ""),
    ];
    Plate {
        title: TITLE,
        equation: EQUATION,
        caption: "The picture is the sum of its terms, and with two lights the sum of the \
                  pictures by each, less the ambient light that both of them contain.",
        numbers,
        drawing: drawing(&lights(), setting),
    }
}

/// The largest absolute channel.
fn worst(differences: impl Iterator<Item = Rgb>) -> f64 {
    differences
        .map(|difference| f64::from(difference.map(f32::abs).max_channel()))
        .fold(0.0, f64::max)
}

fn lights() -> [Light; 2] {
    let key = distant(DVec3::new(1.0, 1.2, 1.1), 0.8);
    [key, distant(DVec3::new(-1.6, 0.2, 0.9), 0.45)]
}

fn scene(lights: Vec<Light>, setting: Setting) -> phong_scene::Scene {
    ball(plastic(setting), lights, DVec3::Z)
}

fn drawing([first, second]: &[Light; 2], setting: Setting) -> Drawing {
    let mut drawing = Drawing::slide();
    drawing.header(TITLE, EQUATION);
    let shown =
        |lights: Vec<Light>| stage::shown(&scene(lights, setting), Point::splat(BALL), setting);
    let all = [LayerKind::Picture];
    let one = shown(vec![first.clone()]);
    let layers = |kinds: &[LayerKind]| stage::bitmap(&one, kinds);
    let terms = [&[AMBIENT], &[DIFFUSE], &[SPECULAR], &all].map(|kind| layers(kind));
    row(&mut drawing, 96.0, terms, ["+", "+", "="], ["ambient", "diffuse", "specular", "Phong"]);
    let pictures = [
        layers(&all),
        stage::bitmap(&shown(vec![second.clone()]), &all),
        layers(&[AMBIENT]),
        stage::bitmap(&shown(vec![first.clone(), second.clone()]), &all),
    ];
    let words = ["light 1", "light 2", "ambient", "both lights"];
    row(&mut drawing, 318.0, pictures, ["+", "−", "="], words);
    for (column, y, light) in [(0, 318.0, first), (1, 318.0, second), (3, 96.0, first)] {
        if let LightKind::Distant { direction, .. } = light.kind {
            let at = Point::new(left(column), y);
            stage::light_from(&mut drawing, -direction, DVec3::Z, at, BALL);
        }
    }
    drawing
}

/// A ball's edge, units.
const BALL: f64 = 168.0;

/// From one ball to the next.
const STEP: f64 = 230.0;

fn left(column: usize) -> f64 {
    51.0 + STEP * column as f64
}

fn row(drawing: &mut Drawing, y: f64, pictures: [Bitmap; 4], signs: [&str; 3], words: [&str; 4]) {
    for (column, (picture, words)) in pictures.into_iter().zip(words).enumerate() {
        drawing.image(Point::new(left(column), y), Point::splat(BALL), picture);
        drawing.heading(Point::new(left(column) + 0.5 * BALL, y + BALL + 26.0), words);
    }
    for (column, sign) in signs.into_iter().enumerate() {
        let at = Point::new(left(column) + 0.5 * (BALL + STEP), y + 0.5 * BALL);
        drawing.label(at, 36.0, style::TEXT, sign);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn terms_add_up_exactly_and_lights_to_rounding() {
        let [terms, lights, pixels] = draw(Setting::DRAFT).values();
        assert_eq!(terms, 0.0);
        assert!(lights <= 2.4e-7, "{lights}");
        assert!(pixels > 10_000.0);
    }
}
