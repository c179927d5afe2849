//! The normal of a sphere.

use glam::DVec3;
use phong::film::LayerKind;
use phong::math::wide;
use phong_scene::{ConstantMaterial, Rgb, Scene};

use super::drawing::Drawing;
use super::mark::{Anchor, Path, Point, Stroke, heading};
use super::stage::{self, Spot, ball, distant, plastic};
use super::{Number, Plate, Setting, style};

/// The direction to the light.
const TO_LIGHT: DVec3 = DVec3::new(-0.5, 0.8, 1.0);
const TITLE: &str = "The normal of a sphere";
const EQUATION: &str = "*n* = (*p* − *c*) / ‖*p* − *c*‖";

pub(super) fn draw(setting: Setting) -> Plate {
    let spots = stage::spots(&stage::measured(&scene(setting)));
    let apart = spots.iter().map(|spot| {
        let from_center = spot.p.as_dvec3().normalize_or_zero(); // c is the origin
        from_center.distance(spot.n.as_dvec3())
    });
    let length = spots.iter().map(|spot| (f64::from(spot.n.length()) - 1.0).abs());
    let numbers = vec![
        Number::new("largest ‖n − (p − c)/‖p − c‖‖ of a pixel", apart.fold(0.0, f64::max), ""),
        Number::new("largest distance of ‖n‖ from 1", length.fold(0.0, f64::max), ""),
        Number::new("pixels compared", spots.len() as f64, ""),
    ];
    Plate {
        title: TITLE,
        equation: EQUATION,
        caption: "The normal at a point p of a sphere points from its centre c to p; divided by \
                  its length, the radius, it is a unit vector.",
        drawing: drawing(&spots, setting),
        numbers,
    }
}

fn scene(setting: Setting) -> Scene {
    let clay = ConstantMaterial {
        color: setting.color.unwrap_or(Rgb::grey(0.72)),
        k_s: 0.0,
        k_d: 0.75,
        k_a: 0.3,
        ..plastic(setting)
    };
    ball(clay, vec![distant(TO_LIGHT, 0.8)], DVec3::Z)
}

fn drawing(spots: &[Spot], setting: Setting) -> Drawing {
    let mut drawing = Drawing::slide();
    drawing.header(TITLE, EQUATION);
    let (at, size) = (Point::new(90.0, 142.0), 300.0);
    let film = stage::shown(&scene(setting), Point::splat(size), setting);
    drawing.image(at, Point::splat(size), stage::bitmap(&film, &[LayerKind::Picture]));
    stage::light_from(&mut drawing, TO_LIGHT, DVec3::Z, at, size);
    for target in hedgehog() {
        let nearest = spots
            .iter()
            .max_by(|a, b| a.p.as_dvec3().dot(target).total_cmp(&b.p.as_dvec3().dot(target)));
        let Some(spot) = nearest else { continue };
        let (p, n) = (spot.p.as_dvec3(), spot.n.as_dvec3());
        let on_paper = |p| stage::seen(p, DVec3::Z, at, size);
        drawing.circle(on_paper(p), 2.2, Some(style::NORMAL), None);
        drawing.arrow(on_paper(p), on_paper(p + 0.3 * n), style::NORMAL, 2.0);
    }
    drawing.note(at + Point::new(0.5 * size, size + 62.0), "the renderer’s normals, at 25 pixels");
    section(&mut drawing, Point::new(716.0, 320.0), 122.0);
    drawing
}

/// Directions in three rings around the direction to the eye.
fn hedgehog() -> Vec<DVec3> {
    let rings = [(0.0, 1), (36.0, 8), (68.0, 16)];
    let ring = |(tilt, count): (f64, u32)| {
        let (sin, cos) = wide::sin_cos(tilt.to_radians());
        (0..count).map(move |step| {
            let (y, x) = wide::sin_cos((360.0 * f64::from(step) / f64::from(count)).to_radians());
            DVec3::new(sin * x, sin * y, cos)
        })
    };
    rings.into_iter().flat_map(ring).collect()
}

/// A cut through the sphere, with the vectors to c and to p from some origin.
fn section(drawing: &mut Drawing, c: Point, radius: f64) {
    let outline = Some(Stroke::new(style::SURFACE, 2.0));
    drawing.circle(c, radius, Some(style::BODY), outline);
    let (way, along) = (heading(52.0), heading(142.0));
    let p = c + radius * way;
    let o = Point::new(900.0, 470.0);
    for (end, words) in [(c, "*c*"), (p, "*p*")] {
        drawing.arrow(o, end, style::GUIDE, 1.8);
        let middle = o + 0.32 * (end - o);
        let aside = if words == "*c*" { Point::new(-10.0, 16.0) } else { Point::new(15.0, -2.0) };
        drawing.label(middle + aside, style::LETTER, style::MUTED, words);
    }
    drawing.dot(o, style::MUTED);
    drawing.text(o + Point::new(0.0, 24.0), Anchor::Middle, style::NOTE, style::MUTED, "origin");
    drawing.line(
        p - 96.0 * along,
        p + 96.0 * along,
        Stroke::new(style::SURFACE, style::LINE).dashed(),
    );
    let square = [p - 13.0 * along, p - 13.0 * along + 13.0 * way, p + 13.0 * way];
    drawing.stroke(Path::polyline(square), Stroke::new(style::SURFACE, style::LINE));
    drawing.arrow(c, p, style::TEXT, 2.2);
    let middle = 0.5 * (c + p) - 30.0 * along + Point::new(10.0, 4.0);
    drawing.label(middle, style::LETTER, style::TEXT, "*p* − *c*");
    drawing.vector(p, p + 92.0 * way, style::NORMAL, "*n*");
    drawing.dot(c, style::TEXT);
    drawing.label(c + Point::new(-14.0, -12.0), style::LETTER, style::TEXT, "*c*");
    drawing.dot(p, style::TEXT);
    drawing.label(p + Point::new(-26.0, 4.0), style::LETTER, style::TEXT, "*p*");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rendered_normals_point_from_the_centre_to_the_point() {
        let [apart, length, pixels] = draw(Setting::DRAFT).values();
        assert!(apart < 5e-7 && length < 3e-7, "{apart} {length}");
        assert!(pixels > 10_000.0);
    }
}
