//! Why n = h is brightest: then the eye is where the mirrored light goes.

use phong::math::{Dir3, lobe, wide};

use super::drawing::Drawing;
use super::mark::{Anchor, Point, Stroke};
use super::plot::{Plot, fixed, ticks};
use super::symbols::{drawn, eye, surface, unit};
use super::{Number, Plate, Setting, style};

const TITLE: &str = "Brightest where n = h";
const EQUATION: &str = "*n* = *h*   where   *e* = *r*";

/// The angle of incidence, degrees.
const THETA: f64 = 42.0;
/// Phong's exponent; Blinn's is four times as large.
const ALPHA: f64 = 12.0;
/// How far the three eyes are from the mirrored light, degrees towards the normal: all of them are
/// above the ground, and on this side of the normal.
fn away(theta: f64) -> [f64; 3] {
    [f64::min(22.0, 0.6 * theta), 0.0, -f64::min(24.0, 0.6 * (90.0 - theta))]
}

/// What Phong's term and Blinn's are for an eye `away` from the mirrored light.
fn seen(theta: f64, alpha: f64, away: f64) -> [f64; 2] {
    let (l, e) = (unit(90.0 + theta), unit(90.0 - theta + away));
    let h = l.halfway(e).unwrap_or(Dir3::Y);
    let phong = lobe(Dir3::Y.mirror(l).cos(e), alpha as f32);
    [phong, lobe(Dir3::Y.cos(h), 4.0 * alpha as f32)].map(f64::from)
}

pub(super) fn draw(setting: Setting) -> Plate {
    let (theta, alpha) = (setting.theta_or(THETA), setting.alpha_or(ALPHA));
    let mut numbers = Vec::new();
    for away in away(theta) {
        let [phong, blinn] = seen(theta, alpha, away);
        numbers.push(Number::new(format!("(r·e)^α, eye at {away}°"), phong, ""));
        numbers.push(Number::new(format!("(n·h)^4α, eye at {away}°"), blinn, ""));
    }
    Plate {
        title: TITLE,
        equation: EQUATION,
        caption: "The vector h halves the angle between l and e, and n halves that between l and r: so \
                  h = n exactly if e = r, where both powers are 1; whichever way the eye then moves, \
                  h leaves n, the cosine falls below 1, and the highlight darkens.",
        drawing: drawing(theta, alpha),
        numbers,
    }
}

fn drawing(theta: f64, alpha: f64) -> Drawing {
    let mut drawing = Drawing::slide();
    drawing.header(TITLE, EQUATION);
    let words = ["eye nearer to *n*", "eye at *r*: *h* = *n*", "eye nearer to the ground"];
    for (column, (away, words)) in away(theta).into_iter().zip(words).enumerate() {
        let o = Point::new(166.0 + 314.0 * column as f64, 262.0);
        panel(&mut drawing, o, theta, away);
        drawing.heading(o + Point::new(0.0, 48.0), words);
        let [phong, blinn] = seen(theta, alpha, away);
        let values = format!(
            "(*r*·*e*)^{{*α*}} = {}, (*n*·*h*)^{{4*α*}} = {}",
            fixed(phong, 3),
            fixed(blinn, 3)
        );
        drawing.note(o + Point::new(0.0, 72.0), &values);
    }
    let corners = [Point::new(180.0, 372.0), Point::new(700.0, 476.0)];
    let plot = Plot { corners, x: [-45.0, 45.0], y: [0.0, 1.0] };
    let x_ticks = ticks(&[-45.0, -30.0, -15.0, 0.0, 15.0, 30.0, 45.0], "°");
    plot.axes(&mut drawing, &x_ticks, &ticks(&[0.0, 0.5, 1.0], ""));
    plot.names(&mut drawing, "the eye’s angle from *r*, towards *n*", "highlight", 48.0);
    let curve = |drawing: &mut Drawing, which: usize, stroke: Stroke| {
        plot.curve(drawing, [-45.0, 45.0], 180, |away| seen(theta, alpha, away)[which], stroke);
    };
    curve(&mut drawing, 0, Stroke::new(style::MIRROR, style::CURVE));
    curve(&mut drawing, 1, Stroke::new(style::HALF, style::CURVE).dashed());
    for away in away(theta) {
        plot.dot(&mut drawing, away, seen(theta, alpha, away)[0], style::EYE);
    }
    let legend = [
        (style::MIRROR, format!("(*r*·*e*)^{{*α*}}, *α* = {alpha}")),
        (style::HALF, format!("(*n*·*h*)^{{*α′*}}, *α′* = {}", 4.0 * alpha)),
        (style::EYE, "the three eyes above".to_owned()),
    ];
    for (row, (ink, words)) in legend.into_iter().enumerate() {
        let at = Point::new(726.0, 400.0 + 24.0 * row as f64);
        drawing.text(at, Anchor::Start, style::NOTE, ink, &words);
    }
    drawing
}

/// The vectors for one eye.
fn panel(drawing: &mut Drawing, o: Point, theta: f64, away: f64) {
    surface(drawing, o, 132.0);
    let length = 128.0;
    let (l, e) = (unit(90.0 + theta), unit(90.0 - theta + away));
    let r = Dir3::Y.mirror(l);
    let h = l.halfway(e).unwrap_or(Dir3::Y);
    let tip = |v: Dir3, share: f64| o + share * length * drawn(v.to_vec());
    drawing.line(o, tip(r, 1.0), Stroke::new(style::MIRROR, 2.0).dashed());
    if away != 0.0 {
        drawing.label(tip(r, 1.12), style::LETTER, style::MIRROR, "*r*");
    }
    drawing.vector(o, tip(l, 0.94), style::LIGHT, "*l*");
    drawing.arrow(o, tip(Dir3::Y, 1.0), style::NORMAL, style::VECTOR);
    let beside = if away < 0.0 { -13.0 } else { 13.0 };
    drawing.label(
        tip(Dir3::Y, 1.0) + Point::new(beside, -6.0),
        style::LETTER,
        style::NORMAL,
        "*n*",
    );
    drawing.arrow(o, tip(h, 0.8), style::HALF, style::VECTOR);
    let at_h = tip(h, 0.8) + Point::new(if away > 0.0 { -15.0 } else { 15.0 }, 4.0);
    drawing.label(at_h, style::LETTER, style::HALF, "*h*");
    drawing.arrow(o, tip(e, 0.92), style::EYE, style::VECTOR);
    eye(drawing, tip(e, 1.12), 270.0 - theta + away);
    // The two halves of the angle between l and e, which h cuts.
    let at = |v: Dir3| wide::atan2(f64::from(v.to_vec().y), f64::from(v.to_vec().x)).to_degrees();
    for (from, to) in [(at(e), at(h)), (at(h), at(l))] {
        drawing.stroke(
            super::mark::Path::arc(o, 40.0, from + 1.5, to - 1.5),
            Stroke::new(style::HALF, style::LINE),
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_highlights_are_brightest_where_the_eye_is_at_r() {
        let [near, near_blinn, at, at_blinn, far, far_blinn] = draw(Setting::DRAFT).values();
        assert!((at - 1.0).abs() < 1e-5 && (at_blinn - 1.0).abs() < 1e-5, "{at} {at_blinn}");
        for value in [near, near_blinn, far, far_blinn] {
            assert!(value < 0.6, "{value}");
        }
    }
}
