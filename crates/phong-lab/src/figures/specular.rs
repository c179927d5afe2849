//! The specular term: a blurry image of the light around the mirror direction, seen by one eye.

use glam::DVec3;
use phong::film::LayerKind;
use phong::math::{Dir3, lobe, wide};
use phong_scene::{ConstantMaterial, Scene};

use super::drawing::Drawing;
use super::mark::{Anchor, Path, Point, Stroke, heading};
use super::plot::fixed;
use super::stage::{self, SPECULAR, Spot, ball, distant, plastic};
use super::symbols::{EYES, drawn, marked, surface, to_light, unit};
use super::{Number, Plate, Setting, style};

const TITLE: &str = "The specular term";
const EQUATION: &str = "*k*_s (*r*·*e*)^{*α*} *C*_s";
/// Exponents of the drawn lobes.
const EXPONENTS: [f32; 3] = [3.0, 9.0, 200.0];

pub(super) fn draw(setting: Setting) -> Plate {
    let at_p =
        EYES.map(|eye| f64::from(stage::probe(&scene(eye, setting), marked(), eye).specular.b));
    let brightest =
        EYES.map(|eye| brightest(&stage::spots(&stage::measured(&scene(eye, setting)))));
    let moved = brightest[0].dot(brightest[1]).clamp(-1.0, 1.0);
    let numbers = vec![
        Number::new("specular at p, first eye", at_p[0], ""),
        Number::new("specular at p, second eye", at_p[1], ""),
        Number::new("the eye moved by", wide::acos(EYES[0].dot(EYES[1])).to_degrees(), "°"),
        Number::new("the highlight's normal moved by", wide::acos(moved).to_degrees(), "°"),
    ];
    Plate {
        title: TITLE,
        equation: EQUATION,
        caption: "A shiny spot is a blurry image of the light: it sits where the mirrored light \
                  meets the eye, so it moves when the eye moves.",
        drawing: drawing(at_p, setting),
        numbers,
    }
}

fn scene(eye: DVec3, setting: Setting) -> Scene {
    let shininess = setting.alpha_or(20.0) as f32;
    let material = ConstantMaterial { k_a: 0.15, k_s: 0.7, shininess, ..plastic(setting) };
    ball(material, vec![distant(to_light(), 0.9)], eye)
}

/// The normal where the specular term peaks: the mean over pixels of 99 % of the peak or more.
fn brightest(spots: &[Spot]) -> DVec3 {
    let value = |spot: &Spot| spot.terms.specular.b;
    let peak = spots.iter().map(value).fold(0.0, f32::max);
    let top = spots.iter().filter(|spot| value(spot) > 0.99 * peak);
    top.map(|spot| spot.n.as_dvec3()).sum::<DVec3>().normalize_or_zero()
}

fn drawing(at_p: [f64; 2], setting: Setting) -> Drawing {
    let mut drawing = Drawing::slide();
    drawing.header(TITLE, EQUATION);
    let size = 196.0;
    for (column, eye) in EYES.into_iter().enumerate() {
        let at = Point::new(40.0 + 226.0 * column as f64, 88.0);
        let film = stage::shown(&scene(eye, setting), Point::splat(size), setting);
        let below = at + Point::new(0.0, size + 8.0);
        for (at, layer) in [(at, LayerKind::Picture), (below, SPECULAR)] {
            drawing.image(at, Point::splat(size), stage::bitmap(&film, &[layer]));
            stage::light_from(&mut drawing, to_light(), eye, at, size);
            let p = stage::seen(marked(), eye, at, size);
            drawing.tag(p, Point::new(-20.0, -10.0), "*p*");
        }
        let middle = below + Point::new(0.5 * size, size);
        drawing
            .heading(middle + Point::new(0.0, 24.0), ["one eye", "the eye moved by 50°"][column]);
        let value = format!("specular at *p*: {}", fixed(at_p[column], 3));
        drawing.note(middle + Point::new(0.0, 45.0), &value);
    }
    lobes(&mut drawing, Point::new(712.0, 410.0), 240.0, setting);
    drawing
}

/// Lobes of several exponents around the mirrored light.
fn lobes(drawing: &mut Drawing, o: Point, length: f64, setting: Setting) {
    surface(drawing, o, 206.0);
    let (n, l, e) = (Dir3::Y, unit(132.0), unit(28.0));
    let r = n.mirror(l);
    let exponents = setting.alpha.map_or(EXPONENTS.to_vec(), |alpha| vec![alpha as f32]);
    let shades = style::shades(exponents.len());
    for (&alpha, &shade) in exponents.iter().zip(&shades) {
        let tip = |degrees: f64| {
            let share = f64::from(lobe(r.cos(unit(degrees)), alpha));
            o + length * share * heading(degrees)
        };
        let petal = Path::polygon((0..=360).map(|step| tip(0.5 * f64::from(step))));
        drawing.shape(petal, Some(shade.fade(0.22)), Some(Stroke::new(shade, style::CURVE)));
    }
    let tip = |v: Dir3, share: f64| o + share * length * drawn(v.to_vec());
    drawing.vector(o, tip(n, 0.72), style::NORMAL, "*n*");
    drawing.vector(o, tip(l, 0.72), style::LIGHT, "*l*");
    drawing.vector(o, tip(r, 1.06), style::MIRROR, "*r*");
    drawing.vector(o, tip(e, 0.86), style::EYE, "*e*");
    drawing.angle(o, 150.0, [28.0, 48.0], style::TEXT, "*φ*");
    for (column, (&alpha, &shade)) in exponents.iter().zip(&shades).enumerate() {
        let at = o + Point::new(-150.0 + 130.0 * column as f64, 66.0);
        drawing.line(
            at - Point::new(34.0, 5.0),
            at - Point::new(8.0, 5.0),
            Stroke::new(shade, 4.0),
        );
        drawing.text(at, Anchor::Start, style::NOTE, style::TEXT, &format!("*α* = {alpha}"));
    }
    let words = "length: what an eye in that direction sees, (*r*·*e*)^{*α*}";
    drawing.note(o + Point::new(0.0, 94.0), words);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moving_the_eye_moves_the_highlight_half_as_far() {
        let [first, second, eye, highlight] = draw(Setting::DRAFT).values();
        assert!(first > 2.0 * second, "{first} {second}");
        assert!((eye - 50.0).abs() < 1e-9);
        // Both normals are bisectors of l and e; l is out of the eyes' plane, so not quite half.
        let bisectors = EYES.map(|eye| (eye + to_light()).normalize_or_zero());
        let expected = wide::acos(bisectors[0].dot(bisectors[1])).to_degrees();
        assert!((highlight - expected).abs() < 0.3, "{highlight} for {expected}");
    }
}
