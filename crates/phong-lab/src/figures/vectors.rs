//! The vectors to the eye and to the light, for a distant light and for a point light.

use glam::{DVec3, Vec3};
use phong::light::Light;
use phong::math::{Dir3, wide};
use phong_scene::{Light as Written, LightKind};

use super::drawing::Drawing;
use super::mark::{Ink, Point, Stroke};
use super::plot::fixed;
use super::stage::distant;
use super::symbols::{drawn, eye, lamp, unit};
use super::{Number, Plate, Setting, style};

const TITLE: &str = "To the eye and to the light";
const EQUATION: &str = "*e* = (eye − *p*) / ‖eye − *p*‖,   *l* = (lamp − *p*) / ‖lamp − *p*‖";

/// Where on the unit circle the two points are, degrees.
const POINTS: [f64; 2] = [112.0, 38.0];
/// The lamp and the eye, radii from the centre.
const LAMP: DVec3 = DVec3::new(-0.35, 2.4, 0.0);
const EYE: Vec3 = Vec3::new(2.0, 2.1, 0.0);
/// The sun's direction.
const SUN: DVec3 = DVec3::new(-0.62, 1.0, 0.0);

pub(super) fn draw(_: Setting) -> Plate {
    let mut numbers = Vec::new();
    for (kind, light) in [("distant", sun()), ("point", point())] {
        let angle = wide::acos(f64::from(to_light(&light, 0).dot(to_light(&light, 1))).min(1.0));
        let name = format!("angle between the two l, {kind} light");
        numbers.push(Number::new(name, angle.to_degrees(), "°"));
    }
    Plate {
        title: TITLE,
        equation: EQUATION,
        caption: "The eye vector leads from the point to the eye; the light vector is the same \
                  everywhere for a distant light, and leads to the lamp for a point light.",
        drawing: drawing(numbers[1].value),
        numbers,
    }
}

fn sun() -> Written {
    distant(SUN, 1.0)
}

fn point() -> Written {
    let kind = LightKind::Point { position: LAMP, attenuation: [1.0, 0.0, 0.0], radius: 0.0 };
    Written { kind, ..sun() }
}

/// `l` at one of the [`POINTS`], as the renderer samples the light.
fn to_light(light: &Written, point: usize) -> Dir3 {
    let p = unit(POINTS[point]).to_vec();
    Light::new(light, DVec3::ZERO)
        .sample(p.as_dvec3(), [0.5, 0.5])
        .map_or(Dir3::Y, |sample| sample.l)
}

fn drawing(angle: f64) -> Drawing {
    let mut drawing = Drawing::slide();
    drawing.header(TITLE, EQUATION);
    panel(&mut drawing, Point::new(240.0, 352.0), &sun(), "distant light", 0.0);
    panel(&mut drawing, Point::new(680.0, 352.0), &point(), "point light", angle);
    drawing
}

fn panel(drawing: &mut Drawing, o: Point, light: &Written, words: &str, angle: f64) {
    let radius = 104.0;
    let place = |p: Vec3| o + radius * drawn(p);
    drawing.circle(o, radius, Some(style::BODY), Some(Stroke::new(style::SURFACE, 2.0)));
    let is_sun = matches!(light.kind, LightKind::Distant { .. });
    let dashes = |ink: Ink| Stroke::new(ink.fade(0.75), style::LINE).dashed();
    for (index, degrees) in POINTS.into_iter().enumerate() {
        let p = unit(degrees).to_vec();
        let l = to_light(light, index).to_vec();
        let Some(e) = Dir3::new(EYE - p) else { continue };
        let source = if is_sun { p + 1.45 * l } else { LAMP.as_vec3() };
        drawing.line(place(p), place(source), dashes(style::LIGHT));
        drawing.line(place(p), place(EYE), dashes(style::EYE));
        let tip = |v: Vec3| place(p) + 60.0 * drawn(v);
        drawing.arrow(place(p), tip(l), style::LIGHT, style::VECTOR);
        drawing.arrow(place(p), tip(e.to_vec()), style::EYE, style::VECTOR);
        let left = Point::new(if index == 0 { -15.0 } else { 15.0 }, -2.0);
        drawing.label(tip(l) + left, style::LETTER, style::LIGHT, "*l*");
        let below = if index == 0 { Point::new(-2.0, -15.0) } else { Point::new(14.0, 12.0) };
        drawing.label(tip(e.to_vec()) + below, style::LETTER, style::EYE, "*e*");
        drawing.dot(place(p), style::TEXT);
        let inside = place(p) - 18.0 * drawn(p);
        drawing.label(inside, style::LETTER, style::TEXT, "*p*");
    }
    if is_sun {
        lamp(drawing, Point::new(o.x - 168.0, 118.0), 20.0);
    } else {
        lamp(drawing, place(LAMP.as_vec3()), 10.0);
    }
    eye(drawing, place(EYE) + Point::new(12.0, -10.0), 220.0);
    drawing.heading(o + Point::new(0.0, 136.0), words);
    let note = match light.kind {
        LightKind::Distant { .. } => "*l* is the same everywhere".to_owned(),
        _ => format!("the two *l* are {}° apart", fixed(angle, 1)),
    };
    drawing.note(o + Point::new(0.0, 160.0), &note);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_point_light_is_seen_in_different_directions() {
        let [distant, point] = draw(Setting::DRAFT).values();
        assert_eq!(distant, 0.0);
        // The angle at the lamp between the two points, by the cosine rule.
        let [a, b] = POINTS.map(|degrees| LAMP - unit(degrees).to_vec().as_dvec3());
        let expected = wide::acos(a.dot(b) / (a.length() * b.length())).to_degrees();
        assert!((point - expected).abs() < 1e-3, "{point} for {expected}");
    }
}
