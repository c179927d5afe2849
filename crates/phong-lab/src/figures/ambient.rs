//! The ambient term: flat, and what there would be without it.

use glam::DVec3;
use phong::film::LayerKind;
use phong_scene::{Light, Scene};

use super::drawing::Drawing;
use super::mark::Point;
use super::plot::fixed;
use super::stage::{self, AMBIENT, DIFFUSE, SPECULAR, ball, distant, plastic};
use super::{Finish, Number, Plate, style};

const TITLE: &str = "The ambient term";
const EQUATION: &str = "*k*_a *C*_a";

pub(super) fn draw(finish: Finish) -> Plate {
    let spots = stage::spots(&stage::measured(&scene(DVec3::Z)));
    let blue = |value: phong_scene::Rgb| f64::from(value.b);
    let least = spots.iter().map(|spot| blue(spot.terms.ambient)).fold(f64::INFINITY, f64::min);
    let most = spots.iter().map(|spot| blue(spot.terms.ambient)).fold(0.0, f64::max);
    let darkest = |without: f64| {
        spots.iter().map(|spot| blue(spot.sum) - without).fold(f64::INFINITY, f64::min)
    };
    let numbers = vec![
        Number::new("k_a C_a, blue", f64::from(plastic().k_a * plastic().color.b), ""),
        Number::new("least ambient on the ball, blue", least, ""),
        Number::new("most ambient on the ball, blue", most, ""),
        Number::new("darkest pixel without it", darkest(most), ""),
        Number::new("darkest pixel with it", darkest(0.0), ""),
    ];
    Plate {
        title: TITLE,
        equation: EQUATION,
        caption: "Light that has come round by everything else is taken for a constant: it uses \
                  no vector, is totally flat, and keeps shadows from being totally black.",
        drawing: drawing(most, finish),
        numbers,
    }
}

fn scene(eye: DVec3) -> Scene {
    let light: Light = distant(DVec3::new(1.6, 0.9, 0.5), 0.9);
    ball(plastic(), vec![light], eye)
}

fn drawing(value: f64, finish: Finish) -> Drawing {
    let mut drawing = Drawing::slide();
    drawing.header(TITLE, EQUATION);
    let size = 250.0;
    let film = stage::shown(&scene(DVec3::Z), Point::splat(size), finish);
    let panels = [
        (
            vec![DIFFUSE, SPECULAR],
            "without ambient light",
            "where no light falls: black".to_owned(),
        ),
        (vec![AMBIENT], "ambient alone", format!("blue: {} at every point", fixed(value, 3))),
        (vec![LayerKind::Picture], "together", "the dark side keeps its colour".to_owned()),
    ];
    for (column, (layers, words, note)) in panels.into_iter().enumerate() {
        let left = Point::new(44.0 + 311.0 * column as f64, 122.0);
        drawing.image(left, Point::splat(size), stage::bitmap(&film, &layers));
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
        let [expected, least, most, without, with] = draw(Finish::Draft).values();
        assert_eq!([least, most], [expected; 2]);
        assert_eq!([without, with], [0.0, expected]);
    }

    #[test]
    fn the_ambient_term_does_not_know_where_the_eye_is() {
        let eyes = [DVec3::Z, DVec3::X, DVec3::new(0.6, 0.0, -0.8)];
        let seen = eyes.map(|eye| stage::spots(&stage::measured(&scene(eye)))[0].terms.ambient);
        assert_eq!([seen[0]; 3], seen);
    }
}
