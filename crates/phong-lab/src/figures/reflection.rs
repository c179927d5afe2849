//! The reflected vector, constructed; and what becomes of the highlight when its sign is wrong.

use phong::math::{Dir3, reflect, wide};

use super::drawing::Drawing;
use super::mark::{Anchor, Ink, Point, Stroke};
use super::plot::fixed;
use super::symbols::{drawn, surface, unit};
use super::{Number, Plate, Setting, style};

const TITLE: &str = "The reflected vector";
const EQUATION: &str = "*r* = 2(*l*·*n*)*n* − *l*";

/// Angles of l and e, degrees from the surface's right.
const LIGHT: f64 = 131.0;
const EYE: f64 = 31.0;
/// Exponents of the table: an even one hides the wrong sign, odd ones show it.
const EXPONENTS: [f64; 3] = [2.0, 3.0, 9.0];

pub(super) fn draw(setting: Setting) -> Plate {
    let light = 90.0 + setting.theta_or(LIGHT - 90.0);
    let (n, l, e) = (Dir3::Y, unit(light), unit(EYE));
    let (r, wrong) = (n.mirror(l), reflect(l, n));
    let mut numbers = vec![
        Number::new("l·n", l.dot(n).into(), ""),
        Number::new("r·n", r.dot(n).into(), ""),
        Number::new("cos φ = r·e", r.dot(e).into(), ""),
        Number::new("wrong sign: (l − 2(l·n)n)·e", wrong.dot(e).into(), ""),
    ];
    for alpha in EXPONENTS {
        let power = |v: Dir3| wide::pow(v.dot(e).into(), alpha);
        numbers.push(Number::new(format!("(r·e)^{alpha}"), power(r), ""));
        numbers.push(Number::new(format!("wrong sign, power {alpha}"), power(wrong), ""));
    }
    Plate {
        title: TITLE,
        equation: EQUATION,
        caption: "l and r add up to twice the projection of l on n; l − 2(l·n)n is −r, points \
                  into the surface, and gives no highlight, or by an even exponent a false one.",
        numbers,
        drawing: drawing(light, [n, l, e]),
    }
}

fn drawing(light: f64, [n, l, e]: [Dir3; 3]) -> Drawing {
    let mut drawing = Drawing::slide();
    drawing.header(TITLE, EQUATION);
    construct(&mut drawing, Point::new(292.0, 440.0), 212.0, light, [n, l, e]);
    trap(&mut drawing, Point::new(762.0, 226.0), 104.0, [n, l, e]);
    table(&mut drawing, n.mirror(l), reflect(l, n), e);
    drawing
}

/// The parallelogram of l, r and 2(l·n)n.
fn construct(drawing: &mut Drawing, o: Point, unit: f64, light: f64, [n, l, e]: [Dir3; 3]) {
    surface(drawing, o, 240.0);
    let r = n.mirror(l);
    let tip = |v: Dir3| o + unit * drawn(v.to_vec());
    let half = o + unit * drawn(l.dot(n) * n.to_vec());
    let whole = o + unit * drawn(2.0 * l.dot(n) * n.to_vec());
    let dashed = |ink: Ink| Stroke::new(ink, style::LINE).dashed();
    drawing.line(tip(l), half, dashed(style::LIGHT));
    drawing.line(tip(r), half, dashed(style::MIRROR));
    drawing.arrow(tip(l), whole, style::MIRROR.fade(0.45), 2.0);
    drawing.arrow(whole, tip(r), style::LIGHT.fade(0.6), 2.0);
    drawing.line(o, whole, dashed(style::NORMAL));

    let [phi_from, phi_to] = [EYE, 180.0 - light];
    drawing.angle(o, 62.0, [90.0, light], style::TEXT, "*θ*");
    drawing.angle(o, 62.0, [180.0 - light, 90.0], style::TEXT, "*θ*");
    drawing.angle(o, 108.0, [phi_from, phi_to], style::TEXT, "*φ*");
    drawing.vector(o, tip(l), style::LIGHT, "*l*");
    drawing.vector(o, tip(e), style::EYE, "*e*");
    drawing.vector(o, tip(r), style::MIRROR, "*r*");
    drawing.arrow(o, tip(n), style::NORMAL, style::VECTOR);
    let aside = Point::new(16.0, 14.0);
    drawing.label(tip(n) + aside, style::LETTER, style::NORMAL, "*n*");
    drawing.dot(half, style::NORMAL);
    let left = Anchor::Start;
    let beside = half + Point::new(12.0, 22.0);
    drawing.text(beside, left, style::NOTE, style::NORMAL, "(*l*·*n*)*n*");
    drawing.dot(whole, style::NORMAL);
    let above = whole + Point::new(12.0, -6.0);
    drawing.text(above, left, style::NOTE, style::NORMAL, "2(*l*·*n*)*n*");
    let middle = 0.5 * (whole + tip(r)) + Point::new(20.0, -10.0);
    drawing.label(middle, style::LETTER, style::LIGHT, "−*l*");
}

/// The same vectors with the wrong sign.
fn trap(drawing: &mut Drawing, o: Point, unit: f64, [n, l, e]: [Dir3; 3]) {
    surface(drawing, o, 150.0);
    let tip = |v: Dir3| o + unit * drawn(v.to_vec());
    drawing.vector(o, tip(l), style::LIGHT, "*l*");
    drawing.vector(o, tip(n), style::NORMAL, "*n*");
    drawing.vector(o, tip(e), style::EYE, "*e*");
    let r = n.mirror(l);
    drawing.line(o, tip(r), Stroke::new(style::MIRROR, style::LINE).dashed());
    let wrong = tip(reflect(l, n));
    drawing.arrow(o, wrong, style::MIRROR, style::VECTOR);
    let below = wrong + Point::new(18.0, 4.0);
    drawing.text(below, Anchor::Start, style::HEADING, style::MIRROR, "*l* − 2(*l*·*n*)*n* = −*r*");
}

fn table(drawing: &mut Drawing, r: Dir3, wrong: Dir3, e: Dir3) {
    let columns = [640.0, 738.0, 832.0, 916.0];
    let heads = ["*α*", "(*r*·*e*)^{*α*}", "(−*r*·*e*)^{*α*}", "clamped"];
    let mut row = |y: f64, size: f64, ink: Ink, words: [&str; 4]| {
        for (x, words) in columns.into_iter().zip(words) {
            drawing.text(Point::new(x, y), Anchor::End, size, ink, words);
        }
    };
    row(386.0, style::NOTE, style::MUTED, heads);
    for (line, alpha) in EXPONENTS.into_iter().enumerate() {
        let power = |v: Dir3| fixed(wide::pow(v.dot(e).into(), alpha), 3);
        let clamped = fixed(wide::pow(wrong.cos(e).into(), alpha), 0);
        let words = [&alpha.to_string(), &power(r), &power(wrong), &clamped];
        row(
            416.0 + 28.0 * line as f64,
            style::HEADING,
            style::TEXT,
            words.map(|word| word as &str),
        );
    }
    let note = Point::new(916.0, 504.0);
    let words = "An even exponent hides the sign, without a clamp.";
    drawing.text(note, Anchor::End, style::TICK, style::MUTED, words);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_wrong_sign_survives_an_even_exponent_and_no_other() {
        let numbers = draw(Setting::DRAFT).numbers;
        let value = |name: &str| numbers.iter().find(|n| n.name == name).unwrap().value;
        assert_eq!(value("l·n"), value("r·n"));
        assert_eq!(value("(r·e)^2"), value("wrong sign, power 2"));
        for alpha in [3, 9] {
            let (right, wrong) = (format!("(r·e)^{alpha}"), format!("wrong sign, power {alpha}"));
            assert_eq!(value(&right), -value(&wrong));
            assert!(value(&right) > 0.5);
        }
    }
}
