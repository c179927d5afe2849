//! Things that appear in many figures: a surface, a lamp, the sun, an eye, unit vectors.

use glam::{DVec3, Vec3};
use phong::math::{Dir3, wide};

use super::drawing::Drawing;
use super::mark::{Ink, Path, Point, Stroke, heading};
use super::style;

/// The unit vector at `degrees` anticlockwise from x, in the plane of the drawing.
pub(super) fn unit(degrees: f64) -> Dir3 {
    let way = heading(degrees);
    Dir3::new(Vec3::new(way.x as f32, -way.y as f32, 0.0)).unwrap_or(Dir3::X)
}

/// The light at `theta` degrees, in the plane of x and the normal y.
pub(super) fn light(theta: f64) -> Dir3 {
    unit(90.0 + theta)
}

/// An eye `phi` degrees from the mirrored light, in the plane of incidence, towards the normal.
pub(super) fn within(theta: f64, phi: f64) -> Dir3 {
    unit(90.0 - theta + phi)
}

/// An eye `phi` degrees from the mirrored light, straight across the plane of incidence.
pub(super) fn across(theta: f64, phi: f64) -> Dir3 {
    let r = Dir3::Y.mirror(light(theta)).to_vec();
    let (sin, cos) = wide::sin_cos(phi.to_radians());
    Dir3::new(cos as f32 * r + sin as f32 * Vec3::Z).unwrap_or(Dir3::Z)
}

/// A vector of the drawing's plane as it is drawn, one unit long for a unit vector.
pub(super) fn drawn(v: Vec3) -> Point {
    Point::new(f64::from(v.x), -f64::from(v.y))
}

/// A flat surface through `at`, `half` wide to both sides, and the body under it.
pub(super) fn surface(drawing: &mut Drawing, at: Point, half: f64) {
    let (left, right) = (at - Point::new(half, 0.0), at + Point::new(half, 0.0));
    let deep = Point::new(0.0, 22.0);
    drawing.fill(Path::polygon([left, right, right + deep, left + deep]), style::BODY);
    drawing.line(left, right, Stroke::new(style::SURFACE, 2.0));
}

/// A lamp: a small disc and its rays.
pub(super) fn lamp(drawing: &mut Drawing, at: Point, radius: f64) {
    for ray in 0..8 {
        let way = heading(45.0 * f64::from(ray));
        let stroke = Stroke::new(style::LIGHT, 2.2);
        drawing.line(at + 1.45 * radius * way, at + 1.95 * radius * way, stroke);
    }
    drawing.circle(at, radius, Some(GLOW), Some(Stroke::new(style::LIGHT, 2.2)));
}

/// The colour of a light's beam, and of a lamp's inside.
pub(super) const GLOW: Ink = Ink::rgb(0xff, 0xd9, 0x66);

/// An eye that looks along `towards`.
pub(super) fn eye(drawing: &mut Drawing, at: Point, towards: f64) {
    let (ahead, up) = (heading(towards), heading(towards + 90.0));
    let place = |x: f64, y: f64| at + x * ahead + y * up;
    let mut lids = Path::default();
    lids.move_to(place(-16.0, 11.0));
    lids.quad_to(place(9.0, 12.0), place(15.0, 0.0));
    lids.quad_to(place(9.0, -12.0), place(-16.0, -11.0));
    drawing.stroke(lids, Stroke::new(style::EYE, 2.2));
    let mut ball = Path::default();
    ball.move_to(place(2.0, 10.0));
    ball.quad_to(place(-7.0, 0.0), place(2.0, -10.0));
    drawing.stroke(ball, Stroke::new(style::EYE, 2.2));
    drawing.circle(place(5.0, 0.0), 4.2, Some(style::EYE), None);
}

/// Two eyes, 50° apart, for what moves with the eye and what does not.
pub(super) const EYES: [DVec3; 2] =
    [DVec3::Z, DVec3::new(0.766_044_443_118_978, 0.0, 0.642_787_609_686_539_3)];

/// The direction to the light that goes with [`EYES`].
pub(super) fn to_light() -> DVec3 {
    DVec3::new(0.3, 0.62, 0.72).normalize_or(DVec3::Z)
}

/// The point *p* of the unit ball that both eyes see: where the first sees the highlight.
pub(super) fn marked() -> DVec3 {
    (to_light() + EYES[0]).normalize_or(DVec3::Z)
}
