//! What a rough surface does with light, and what a smooth one does.

use phong::math::{Dir3, wide};

use super::drawing::Drawing;
use super::mark::{Path, Point, Stroke, heading};
use super::plot::fixed;
use super::symbols::{drawn, eye, surface, unit};
use super::{Number, Plate, Setting, style};

const TITLE: &str = "Rough and smooth";
const EQUATION: &str = "*k*_d (*l*·*n*) *C*_d";

/// The angle of incidence, degrees.
const THETA: f64 = 40.0;
/// Directions in which the rough surface is looked at, degrees from the surface's right.
const EYES: [f64; 3] = [150.0, 90.0, 35.0];

pub(super) fn draw(setting: Setting) -> Plate {
    let theta = setting.theta_or(THETA);
    let l = unit(90.0 + theta);
    let share = f64::from(l.cos(Dir3::Y));
    let mut numbers = vec![Number::new("l·n", share, "")];
    for degrees in EYES {
        // The diffuse term has no eye in it: the same number whatever the eye.
        numbers.push(Number::new(format!("seen from {degrees}°"), share, "of full light"));
    }
    Plate {
        title: TITLE,
        equation: EQUATION,
        caption: "A rough surface scatters the light that falls on it equally in all directions, so \
                  that every eye sees the same; a smooth one sends it on like a mirror, so that one \
                  eye sees all of it and the others nothing.",
        drawing: drawing(theta, share),
        numbers,
    }
}

fn drawing(theta: f64, share: f64) -> Drawing {
    let mut drawing = Drawing::slide();
    drawing.header(TITLE, EQUATION);
    let l = unit(90.0 + theta);
    let rough = Point::new(250.0, 372.0);
    surface(&mut drawing, rough, 206.0);
    grains(&mut drawing, rough, 206.0);
    let length = 150.0;
    let dome = Path::arc(rough, length + 12.0, 0.0, 180.0);
    drawing.stroke(dome, Stroke::new(style::GUIDE, style::THIN).dashed());
    for step in 0..=10 {
        let degrees = 8.0 + 16.4 * f64::from(step);
        if (degrees - 90.0 - theta).abs() > 9.0 {
            drawing.arrow(rough, rough + length * heading(degrees), style::MIRROR, 1.8);
        }
    }
    light(&mut drawing, rough, l);
    for degrees in EYES {
        if (degrees - 90.0 - theta).abs() > 16.0 {
            eye(&mut drawing, rough + 196.0 * heading(degrees), degrees + 180.0);
        }
    }
    drawing.heading(Point::new(rough.x, 432.0), "rough: equally in all directions");
    let words = format!("every eye sees {} of the full light, *l*·*n*", fixed(share, 3));
    drawing.note(Point::new(rough.x, 458.0), &words);

    let smooth = Point::new(714.0, 372.0);
    surface(&mut drawing, smooth, 206.0);
    let r = Dir3::Y.mirror(l);
    drawing.arrow(smooth, smooth + 176.0 * drawn(r.to_vec()), style::MIRROR, 4.0);
    light(&mut drawing, smooth, l);
    let normal = Stroke::new(style::NORMAL, style::LINE).dashed();
    drawing.line(smooth, smooth + 168.0 * heading(90.0), normal);
    drawing.label(smooth + 184.0 * heading(90.0), style::LETTER, style::NORMAL, "*n*");
    drawing.angle(smooth, 62.0, [90.0, 90.0 + theta], style::TEXT, "*θ*");
    drawing.angle(smooth, 62.0, [90.0 - theta, 90.0], style::TEXT, "*θ*");
    eye(&mut drawing, smooth + 204.0 * heading(90.0 - theta), 270.0 - theta);
    drawing.heading(Point::new(smooth.x, 432.0), "smooth: in one direction");
    drawing.note(Point::new(smooth.x, 458.0), "one eye sees all of it, the others none");
    drawing
}

/// The light that falls in.
fn light(drawing: &mut Drawing, o: Point, l: Dir3) {
    let way = drawn(l.to_vec());
    drawing.arrow(o + 206.0 * way, o + 4.0 * way, style::LIGHT, 4.0);
    let beside = o + 200.0 * way + 22.0 * Point::new(way.y, -way.x);
    drawing.label(beside, 18.0, style::LIGHT, "light");
}

/// The grains of a rough surface, drawn along its edge.
fn grains(drawing: &mut Drawing, o: Point, half: f64) {
    let count = 68;
    let height = |i: u32| {
        // A few waves that do not fit into one another look like chance, and are no chance.
        let x = f64::from(i);
        2.2 * (wide::sin_cos(2.3 * x).0 + wide::sin_cos(4.1 * x + 1.0).0)
    };
    let place = |i: u32| {
        Point::new(o.x - half + 2.0 * half * f64::from(i) / f64::from(count), o.y - height(i))
    };
    let mut body: Vec<Point> = (0..=count).map(place).collect();
    let edge = Path::polyline(body.clone());
    body.extend([o + Point::new(half, 6.0), o + Point::new(-half, 6.0)]);
    drawing.fill(Path::polygon(body), style::BODY);
    drawing.stroke(edge, Stroke::new(style::SURFACE, 2.0));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_eye_sees_the_same_of_a_rough_surface() {
        let [cosine, left, above, right] = draw(Setting::DRAFT).values();
        assert!((cosine - wide::cos(THETA.to_radians())).abs() < 1e-6);
        assert_eq!([left, above, right], [cosine; 3]);
    }
}
