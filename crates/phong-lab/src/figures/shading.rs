//! The three vectors that a point's colour needs, together on one ball.

use glam::{DVec3, Vec3};
use phong::math::Dir3;

use super::drawing::Drawing;
use super::mark::{Anchor, Point, Stroke};
use super::plot::fixed;
use super::symbols::{drawn, eye, lamp, unit};
use super::{Number, Plate, Setting, style};

const TITLE: &str = "Three vectors at a point";
const EQUATION: &str = "*n*, *l*, *e*   ‖*n*‖ = ‖*l*‖ = ‖*e*‖ = 1";

/// Where p is on the unit circle, degrees.
const P: f64 = 58.0;
/// The lamp and the eye, radii from the centre.
const LAMP: DVec3 = DVec3::new(-0.3, 2.45, 0.0);
const EYE: DVec3 = DVec3::new(3.1, 1.3, 0.0);

/// n, l and e at p.
fn vectors() -> [Dir3; 3] {
    let p = unit(P).to_vec();
    let to = |end: DVec3| Dir3::new((end - p.as_dvec3()).as_vec3()).unwrap_or(Dir3::Y);
    [unit(P), to(LAMP), to(EYE)]
}

pub(super) fn draw(_: Setting) -> Plate {
    let [n, l, e] = vectors();
    let r = n.mirror(l);
    let numbers = vec![
        Number::new("n·l", n.dot(l).into(), ""),
        Number::new("n·e", n.dot(e).into(), ""),
        Number::new("r·e", r.dot(e).into(), ""),
    ];
    Plate {
        title: TITLE,
        equation: EQUATION,
        caption: "At the point p of a surface, n stands on the surface, l leads to the light and e to \
                  the eye; all three leave the surface and are one unit long, so that their dot \
                  products are cosines.",
        drawing: drawing([n, l, e]),
        numbers,
    }
}

fn drawing([n, l, e]: [Dir3; 3]) -> Drawing {
    let mut drawing = Drawing::slide();
    drawing.header(TITLE, EQUATION);
    let (o, radius) = (Point::new(270.0, 396.0), 112.0);
    let place = |v: Vec3| o + radius * drawn(v);
    drawing.circle(o, radius, Some(style::BODY), Some(Stroke::new(style::SURFACE, 2.0)));
    let p = place(unit(P).to_vec());
    let (lamp_at, eye_at) = (place(LAMP.as_vec3()), place(EYE.as_vec3()));
    let dashes = |ink: super::mark::Ink| Stroke::new(ink.fade(0.75), style::LINE).dashed();
    drawing.line(o, p, dashes(style::NORMAL));
    drawing.line(p, lamp_at, dashes(style::LIGHT));
    drawing.line(p, eye_at, dashes(style::EYE));
    let tip = |v: Dir3| p + 118.0 * drawn(v.to_vec());
    drawing.vector(p, tip(n), style::NORMAL, "*n*");
    drawing.arrow(p, tip(l), style::LIGHT, style::VECTOR);
    drawing.label(tip(l) + Point::new(17.0, 4.0), style::LETTER, style::LIGHT, "*l*");
    drawing.arrow(p, tip(e), style::EYE, style::VECTOR);
    drawing.label(tip(e) + Point::new(2.0, -17.0), style::LETTER, style::EYE, "*e*");
    drawing.dot(p, style::TEXT);
    drawing.label(p + Point::new(-4.0, 24.0), style::LETTER, style::TEXT, "*p*");
    drawing.dot(o, style::TEXT);
    drawing.label(o + Point::new(-16.0, 6.0), style::LETTER, style::TEXT, "*c*");
    lamp(&mut drawing, lamp_at, 11.0);
    eye(&mut drawing, eye_at + Point::new(15.0, -3.0), 190.0);

    let rows = [
        (style::NORMAL, "*n* = (*p* − *c*) / ‖*p* − *c*‖", "stands on the surface"),
        (style::LIGHT, "*l* = (lamp − *p*) / ‖lamp − *p*‖", "to the light"),
        (style::EYE, "*e* = (eye − *p*) / ‖eye − *p*‖", "to the eye"),
    ];
    for (row, (ink, formula, words)) in rows.into_iter().enumerate() {
        let at = Point::new(640.0, 316.0 + 50.0 * row as f64);
        drawing.text(at, Anchor::Start, style::HEADING, ink, formula);
        drawing.text(at + Point::new(0.0, 20.0), Anchor::Start, style::NOTE, style::MUTED, words);
    }
    let cosines = format!(
        "here *n*·*l* = {}, *n*·*e* = {}",
        fixed(n.dot(l).into(), 3),
        fixed(n.dot(e).into(), 3)
    );
    drawing.text(Point::new(640.0, 480.0), Anchor::Start, style::NOTE, style::TEXT, &cosines);
    drawing
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_three_leave_the_surface_as_unit_vectors() {
        let [n, l, e] = vectors();
        for v in [n, l, e] {
            assert!((v.to_vec().length() - 1.0).abs() < 1e-6 && v.dot(n) > 0.0);
        }
    }
}
