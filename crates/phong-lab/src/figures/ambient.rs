//! The ambient term: flat, and what there would be without it.

use glam::DVec3;
use phong::film::LayerKind;
use phong_scene::{Light, Scene};

use super::drawing::Drawing;
use super::mark::Point;
use super::plot::fixed;
use super::stage::{self, AMBIENT, Channel, DIFFUSE, SPECULAR, ball, distant, plastic};
use super::{Number, Plate, Setting, style};

const TITLE: &str = "The ambient term";
/// The direction to the light.
const TO_LIGHT: DVec3 = DVec3::new(1.6, 0.9, 0.5);
const EQUATION: &str = "*k*_a *C*_a";

pub(super) fn draw(setting: Setting) -> Plate {
    let spots = stage::spots(&stage::measured(&scene(DVec3::Z, setting)));
    let channel = Channel::of(setting);
    let (blue, name) = (|value: phong_scene::Rgb| channel.value(value), channel.name());
    let least = spots.iter().map(|spot| blue(spot.terms.ambient)).fold(f64::INFINITY, f64::min);
    let most = spots.iter().map(|spot| blue(spot.terms.ambient)).fold(0.0, f64::max);
    let darkest = |without: f64| {
        spots.iter().map(|spot| blue(spot.sum) - without).fold(f64::INFINITY, f64::min)
    };
    let plastic = plastic(setting);
    let numbers = vec![
        Number::new(format!("k_a C_a, {name}"), blue(plastic.k_a * plastic.color), ""),
        Number::new(format!("least ambient on the ball, {name}"), least, ""),
        Number::new(format!("most ambient on the ball, {name}"), most, ""),
        Number::new("darkest pixel without it", darkest(most), ""),
        Number::new("darkest pixel with it", darkest(0.0), ""),
    ];
    Plate {
        title: TITLE,
        equation: EQUATION,
        caption: "Light that has come round by everything else is taken for a constant: it uses \
                  no vector, is totally flat, and keeps shadows from being totally black.",
        drawing: drawing(most, setting),
        numbers,
    }
}

fn scene(eye: DVec3, setting: Setting) -> Scene {
    let light: Light = distant(TO_LIGHT, 0.9);
    ball(plastic(setting), vec![light], eye)
}

fn drawing(value: f64, setting: Setting) -> Drawing {
    let mut drawing = Drawing::slide();
    drawing.header(TITLE, EQUATION);
    let size = 250.0;
    let film = stage::shown(&scene(DVec3::Z, setting), Point::splat(size), setting);
    let panels = [
        (
            vec![DIFFUSE, SPECULAR],
            "without ambient light",
            "where no light falls: black".to_owned(),
        ),
        (
            vec![AMBIENT],
            "ambient alone",
            format!("{}: {} at every point", Channel::of(setting).name(), fixed(value, 3)),
        ),
        (vec![LayerKind::Picture], "together", "the dark side keeps its colour".to_owned()),
    ];
    for (column, (layers, words, note)) in panels.into_iter().enumerate() {
        let left = Point::new(44.0 + 311.0 * column as f64, 122.0);
        drawing.image(left, Point::splat(size), stage::bitmap(&film, &layers));
        if layers != [AMBIENT] {
            stage::light_from(&mut drawing, TO_LIGHT, DVec3::Z, left, size);
        }
        let middle = left + Point::new(0.5 * size, size);
        drawing.heading(middle + Point::new(0.0, 40.0), words);
        drawing.note(middle + Point::new(0.0, 66.0), &note);
        if let Some(sign) = ["+", "="].get(column) {
            let between = left + Point::new(size + 30.0, 0.5 * size);
            drawing.label(between, 36.0, style::TEXT, sign);
        }
    }
    drawing
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ambient_term_is_the_same_at_every_point() {
        let [expected, least, most, without, with] = draw(Setting::DRAFT).values();
        assert_eq!([least, most], [expected; 2]);
        assert_eq!([without, with], [0.0, expected]);
    }

    #[test]
    fn the_ambient_term_does_not_know_where_the_eye_is() {
        let eyes = [DVec3::Z, DVec3::X, DVec3::new(0.6, 0.0, -0.8)];
        let seen = eyes.map(|eye| {
            stage::spots(&stage::measured(&scene(eye, Setting::DRAFT)))[0].terms.ambient
        });
        assert_eq!([seen[0]; 3], seen);
    }
}
