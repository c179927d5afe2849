//! The halfway vector, and its angle β to the normal against Phong's angle φ.

use std::array;

use glam::{DVec3, Vec3};
use phong::math::{Dir3, wide};

use super::drawing::Drawing;
use super::mark::{Anchor, Ink, Path, Point, Stroke, heading};
use super::plot::{Plot, fixed, ticks};
use super::symbols::{across, drawn, light, surface, unit, within};
use super::{Number, Plate, Setting, style};

const TITLE: &str = "The halfway vector";
const EQUATION: &str = "*h* = (*l* + *e*) / ‖*l* + *e*‖,   cos *β* = *h*·*n*";

/// The angle of incidence, degrees.
const THETA: f64 = 60.0;
/// The angles φ whose β are told, degrees.
const PHIS: [f64; 3] = [5.0, 20.0, 40.0];

pub(super) fn draw(setting: Setting) -> Plate {
    let theta = setting.theta_or(THETA);
    let mut numbers = Vec::new();
    for phi in PHIS {
        let ratio = |e| beta(theta, e) / phi;
        numbers.push(Number::new(
            format!("β/φ in the plane, φ = {phi}°"),
            ratio(within(theta, phi)),
            "",
        ));
        numbers.push(Number::new(
            format!("β/φ across it, φ = {phi}°"),
            ratio(across(theta, phi)),
            "",
        ));
    }
    numbers.push(Number::new("1/(2 cos θ)", 0.5 / wide::cos(theta.to_radians()), ""));
    Plate {
        title: TITLE,
        equation: EQUATION,
        caption: "If n = h, the reflection is brightest; β is exactly half of φ where n, l and e \
                  lie in one plane, and more elsewhere: about φ/(2 cos θ) across it.",
        numbers,
        drawing: drawing(setting),
    }
}

/// The angle β between n and h, in degrees.
///
/// By its tangent: near 0 the cosine loses it.
fn beta(theta: f64, e: Dir3) -> f64 {
    let h = light(theta).halfway(e).map_or(DVec3::Y, |h| h.to_vec().as_dvec3());
    wide::atan2(h.cross(DVec3::Y).length(), h.y).to_degrees()
}

fn drawing(setting: Setting) -> Drawing {
    let theta = setting.theta_or(THETA);
    let mut drawing = Drawing::slide();
    drawing.header(TITLE, EQUATION);
    // Drawn with less than the plot: at 60° the vectors crowd the ground.
    let drawn_theta = setting.theta_or(48.0);
    flat(&mut drawing, Point::new(166.0, 372.0), 150.0, drawn_theta);
    solid(&mut drawing, Point::new(492.0, 340.0), 148.0, drawn_theta);

    let corners = [Point::new(724.0, 118.0), Point::new(916.0, 392.0)];
    let plot = Plot { corners, x: [0.0, 60.0], y: [0.0, 60.0] };
    let marks = ticks(&[0.0, 20.0, 40.0, 60.0], "°");
    plot.axes(&mut drawing, &marks, &marks);
    plot.names(&mut drawing, "*φ*", "*β*", 48.0);
    let curve = |drawing: &mut Drawing, e: fn(f64, f64) -> Dir3, ink: Ink| {
        let stroke = Stroke::new(ink, style::CURVE);
        plot.curve(drawing, [0.0, 60.0], 60, |phi| beta(theta, e(theta, phi)), stroke);
    };
    curve(&mut drawing, within, style::NORMAL);
    curve(&mut drawing, across, style::MIRROR);
    let limit = Stroke::new(style::MUTED, style::THIN).dashed();
    drawing.line(plot.at(0.0, 0.0), plot.at(60.0, 60.0), limit);
    let words = [
        (plot.at(58.0, 9.0), style::NORMAL, "in the plane: *φ*/2"),
        (plot.at(58.0, 37.0), style::MIRROR, "across it"),
        (plot.at(45.0, 50.0), style::MUTED, "*φ*/(2 cos *θ*)"),
    ];
    for (at, ink, words) in words {
        drawing.text(at, Anchor::End, style::TICK, ink, words);
    }
    drawing.note(Point::new(820.0, 462.0), &format!("*θ* = {theta}°"));
    drawing
}

/// In the plane of incidence.
fn flat(drawing: &mut Drawing, o: Point, length: f64, theta: f64) {
    surface(drawing, o, 128.0);
    let at_e = 90.0 - theta + 34.0;
    let (l, e) = (unit(90.0 + theta), unit(at_e));
    let tip = |v: Vec3, share: f64| o + share * length * drawn(v);
    let vector = |drawing: &mut Drawing, v: Vec3, ink: Ink, words: &str| {
        drawing.vector(o, tip(v, 1.0), ink, words);
    };
    let r = Dir3::Y.mirror(l);
    let h = l.halfway(e).map_or(Vec3::Y, Dir3::to_vec);
    let at_h = 0.5 * (90.0 + theta + at_e);
    drawing.angle(o, 44.0, [90.0, 90.0 + theta], style::LIGHT, "*θ*");
    drawing.angle(o, 76.0, [90.0 - theta, at_e], style::TEXT, "*φ*");
    drawing.angle(o, 100.0, [90.0, at_h], style::HALF, "*β*");
    drawing.line(o, tip(r.to_vec(), 1.0), Stroke::new(style::MIRROR, 2.0).dashed());
    drawing.label(tip(r.to_vec(), 1.1), style::LETTER, style::MIRROR, "*r*");
    vector(drawing, l.to_vec(), style::LIGHT, "*l*");
    vector(drawing, e.to_vec(), style::EYE, "*e*");
    drawing.arrow(o, tip(Vec3::Y, 1.25), style::NORMAL, style::VECTOR);
    drawing.label(tip(Vec3::Y, 1.25) - Point::new(0.0, 15.0), style::LETTER, style::NORMAL, "*n*");
    drawing.arrow(o, tip(h, 1.25), style::HALF, style::VECTOR);
    drawing.label(tip(h, 1.36), style::LETTER, style::HALF, "*h*");
    let below = |dy: f64| o + Point::new(0.0, dy);
    drawing.heading(below(76.0), "in the plane of *n* and *l*");
    drawing.note(below(100.0), &format!("*θ* = {theta}°: *β* = *φ*/2, exactly"));
}

/// The same with the eye across the plane of incidence, seen aslant from above.
fn solid(drawing: &mut Drawing, o: Point, length: f64, theta: f64) {
    // x comes forward to the right, y goes up, z back to the right.
    let place = |v: Vec3| {
        let v = v.as_dvec3();
        let slant = Point::new(0.6 * v.x + 0.75 * v.z, 0.35 * v.x - 0.95 * v.y - 0.28 * v.z);
        o + length * slant
    };
    let corner = |x: f32, z: f32| place(Vec3::new(x, 0.0, z));
    let floor = [corner(-0.75, -0.75), corner(0.8, -0.75), corner(0.8, 0.75), corner(-0.75, 0.75)];
    let edge = Some(Stroke::new(style::SURFACE, style::LINE));
    drawing.shape(Path::polygon(floor), Some(style::BODY), edge);
    let l = unit(90.0 + theta);
    let r = Dir3::Y.mirror(l).to_vec();
    let (sin, cos) = wide::sin_cos(52.0_f64.to_radians());
    let Some(e) = Dir3::new(cos as f32 * r + sin as f32 * Vec3::Z) else { return };
    let h = l.halfway(e).map_or(Vec3::Y, Dir3::to_vec);
    let plane: [Point; 42] = array::from_fn(|step| {
        if step == 41 {
            return o;
        }
        let way = heading(2.0 * step as f64 * theta / 40.0 + 90.0 - theta);
        place(Vec3::new(way.x as f32, -way.y as f32, 0.0))
    });
    drawing.fill(Path::polygon(plane), style::GUIDE.fade(0.22));
    let arc = |drawing: &mut Drawing, from: Vec3, to: Vec3, share: f32, ink: Ink| {
        let at = |t: f32| {
            let way = Dir3::new((1.0 - t) * from + t * to).unwrap_or(Dir3::Y).to_vec();
            place(share * way)
        };
        let points = (0..=16).map(|step| at(step as f32 / 16.0));
        drawing.stroke(Path::polyline(points), Stroke::new(ink, style::LINE));
        at(0.5)
    };
    arc(drawing, r, e.to_vec(), 0.55, style::TEXT);
    // Between r and e there is no room for a letter.
    let below_e = place(0.55 * e.to_vec()) + Point::new(9.0, 13.0);
    drawing.label(below_e, 18.0, style::TEXT, "*φ*");
    let middle = arc(drawing, l.to_vec(), Vec3::Y, 0.36, style::LIGHT);
    let beyond_arc = middle + 13.0 * (middle - o).normalize_or_zero();
    drawing.label(beyond_arc, 18.0, style::LIGHT, "*θ*");
    let middle = arc(drawing, Vec3::Y, h, 0.74, style::HALF);
    let above = middle + 14.0 * (middle - o).normalize_or_zero();
    drawing.label(above, 18.0, style::HALF, "*β*");
    drawing.line(o, place(1.3 * r), Stroke::new(style::MIRROR, 2.0).dashed());
    let beyond = |tip: Point| tip + 15.0 * (tip - o).normalize_or_zero();
    drawing.label(beyond(place(1.3 * r)), style::LETTER, style::MIRROR, "*r*");
    drawing.vector(o, place(l.to_vec()), style::LIGHT, "*l*");
    drawing.vector(o, place(1.2 * Vec3::Y), style::NORMAL, "*n*");
    drawing.vector(o, place(1.2 * h), style::HALF, "*h*");
    drawing.vector(o, place(e.to_vec()), style::EYE, "*e*");
    let below = |dy: f64| Point::new(o.x, o.y + dy);
    drawing.heading(below(108.0), "across it");
    let limit = fixed(0.5 / wide::cos(theta.to_radians()), 3);
    drawing.note(below(132.0), &format!("*θ* = {theta}°: *β* about {limit} *φ*"));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn beta_is_half_of_phi_in_the_plane_of_incidence_only() {
        let [in_5, across_5, in_20, across_20, in_40, across_40, limit] =
            draw(Setting::DRAFT).values();
        for ratio in [in_5, in_20, in_40] {
            assert!((ratio - 0.5).abs() < 2e-6, "{ratio}");
        }
        assert!(0.5 < across_40 && across_40 < across_20 && across_20 < across_5);
        assert!((limit - 1.0).abs() < 1e-12 && limit - across_5 > 0.0);
        // With t = tan(φ/2): tan β = t √(1 + t² sin² θ)/cos θ, from the components of l + e.
        for (phi, ratio) in PHIS.into_iter().zip([across_5, across_20, across_40]) {
            let t = wide::tan((0.5 * phi).to_radians());
            let (sin, cos) = wide::sin_cos(THETA.to_radians());
            let tangent = t * (1.0 + t * t * sin * sin).sqrt() / cos;
            let expected = wide::atan(tangent).to_degrees() / phi;
            assert!((ratio - expected).abs() < 2e-6, "φ = {phi}: {ratio} for {expected}");
        }
    }
}
