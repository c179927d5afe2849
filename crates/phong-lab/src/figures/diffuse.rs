//! The diffuse term: from light to dark, wherever the eye is.

use glam::DVec3;
use phong::math::wide;
use phong_scene::{ConstantMaterial, Scene};

use super::drawing::Drawing;
use super::mark::{Anchor, Point, Stroke};
use super::plot::{Plot, fixed, ticks};
use super::stage::{self, Channel, DIFFUSE, Spot, ball, distant, plastic};
use super::symbols::{EYES, marked, to_light};
use super::{Number, Plate, Setting, style};

const TITLE: &str = "The diffuse term";
const EQUATION: &str = "*k*_d (*l*·*n*) *C*_d";

pub(super) fn draw(setting: Setting) -> Plate {
    let channel = Channel::of(setting);
    let share = |spot: &Spot| share(spot, setting);
    let at_p =
        EYES.map(|eye| channel.value(stage::probe(&scene(eye, setting), marked(), eye).diffuse));
    let spots = EYES.map(|eye| stage::spots(&stage::measured(&scene(eye, setting))));
    let apart = spots.iter().flatten().map(|spot| (share(spot) - cosine(spot).max(0.0)).abs());
    let dark = spots.iter().flatten().filter(|spot| cosine(spot) <= 0.0).map(share);
    let numbers = vec![
        Number::new("diffuse at p, first eye", at_p[0], ""),
        Number::new("diffuse at p, second eye", at_p[1], ""),
        Number::new(
            "largest distance of a pixel from max(0, cos θ)",
            apart.fold(0.0, f64::max),
            "",
        ),
        Number::new("most on the side turned away", dark.fold(0.0, f64::max), ""),
    ];
    Plate {
        title: TITLE,
        equation: EQUATION,
        caption: "The diffuse term falls off with the cosine of the angle of incidence, to black \
                  on the side turned away, and stays where it is when the eye moves.",
        drawing: drawing(at_p, &spots, setting),
        numbers,
    }
}

fn scene(eye: DVec3, setting: Setting) -> Scene {
    ball(
        ConstantMaterial { k_a: 0.0, k_d: 1.0, ..plastic(setting) },
        vec![distant(to_light(), 1.0)],
        eye,
    )
}

/// What a pixel shows of the light that its material would send back if it faced the light.
fn share(spot: &Spot, setting: Setting) -> f64 {
    let channel = Channel::of(setting);
    channel.value(spot.terms.diffuse) / channel.value(plastic(setting).color)
}

fn cosine(spot: &Spot) -> f64 {
    spot.n.as_dvec3().dot(to_light())
}

fn drawing(at_p: [f64; 2], spots: &[Vec<Spot>; 2], setting: Setting) -> Drawing {
    let mut drawing = Drawing::slide();
    drawing.header(TITLE, EQUATION);
    let size = 240.0;
    for (column, eye) in EYES.into_iter().enumerate() {
        let at = Point::new(40.0 + 272.0 * column as f64, 118.0);
        let film = stage::shown(&scene(eye, setting), Point::splat(size), setting);
        drawing.image(at, Point::splat(size), stage::bitmap(&film, &[DIFFUSE]));
        stage::light_from(&mut drawing, to_light(), eye, at, size);
        let p = stage::seen(marked(), eye, at, size);
        drawing.tag(p, Point::new(19.0, -3.0), "*p*");
        let middle = at + Point::new(0.5 * size, size);
        drawing
            .heading(middle + Point::new(0.0, 40.0), ["one eye", "the eye moved by 50°"][column]);
        let value = format!("{} at *p*: {}", Channel::of(setting).name(), fixed(at_p[column], 4));
        drawing.note(middle + Point::new(0.0, 66.0), &value);
    }

    let corners = [Point::new(650.0, 118.0), Point::new(916.0, 366.0)];
    let plot = Plot { corners, x: [0.0, 180.0], y: [0.0, 1.0] };
    let x_ticks = ticks(&[0.0, 45.0, 90.0, 135.0, 180.0], "°");
    plot.axes(&mut drawing, &x_ticks, &ticks(&[0.0, 0.5, 1.0], ""));
    plot.names(&mut drawing, "angle of incidence *θ*", "share of full colour", 44.0);
    let law = |degrees: f64| wide::cos(degrees.to_radians()).max(0.0);
    plot.curve(&mut drawing, [0.0, 180.0], 180, law, Stroke::new(style::NORMAL, style::CURVE));
    for (spots, ink) in spots.iter().zip([style::LIGHT, style::EYE]) {
        for spot in spots.iter().step_by(spots.len() / 23) {
            let degrees = wide::acos(cosine(spot).clamp(-1.0, 1.0)).to_degrees();
            plot.dot(&mut drawing, degrees, share(spot, setting), ink);
        }
    }
    let legend = [
        (style::NORMAL, "max(0, cos *θ*)"),
        (style::LIGHT, "pixels, one eye"),
        (style::EYE, "pixels, the other"),
    ];
    for (line, (ink, words)) in legend.into_iter().enumerate() {
        let at = plot.at(84.0, 0.93) + Point::new(0.0, 24.0 * line as f64);
        drawing.text(at, Anchor::Start, style::NOTE, ink, words);
    }
    drawing
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moving_the_eye_leaves_the_diffuse_term_where_it_was() {
        let [first, second, apart, dark] = draw(Setting::DRAFT).values();
        assert!(first > 0.3 && (first - second).abs() < 1e-6, "{first} {second}");
        assert!(apart < 1e-6, "{apart}");
        assert_eq!(dark, 0.0);
    }
}
