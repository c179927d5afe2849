//! Why the diffuse term is a cosine: a beam that falls in aslant spreads over more surface.

use phong::math::Dir3;

use super::drawing::Drawing;
use super::mark::{Anchor, Path, Point, Stroke, heading};
use super::plot::{Plot, fixed, ticks};
use super::symbols::{GLOW, unit};
use super::{Number, Plate, Setting, style};

const TITLE: &str = "Lambert’s cosine law";
const EQUATION: &str = "*k*_d (*l*·*n*) *C*_d";

/// The angles of incidence that are drawn, degrees.
const ANGLES: [f64; 3] = [0.0, 30.0, 60.0];
/// The beam's width, units.
const BEAM: f64 = 74.0;

pub(super) fn draw(setting: Setting) -> Plate {
    let mut numbers = Vec::new();
    for angle in angles(setting) {
        let share = cosine(angle);
        numbers.push(Number::new(format!("l·n at {angle}°"), share, ""));
        numbers.push(Number::new(format!("beam's footprint at {angle}°"), 1.0 / share, "widths"));
    }
    Plate {
        title: TITLE,
        equation: EQUATION,
        caption: "A beam that meets the surface at the angle θ is spread over 1/cos θ of its \
                  width, so each point receives cos θ of the light.",
        numbers,
        drawing: drawing(setting),
    }
}

/// `L·N` as the renderer has it, for light that falls in at `degrees` from the normal.
fn cosine(degrees: f64) -> f64 {
    f64::from(unit(90.0 + degrees).cos(Dir3::Y))
}

/// The angles that are drawn: of one that is asked for, the half and the whole.
fn angles(setting: Setting) -> [f64; 3] {
    setting.theta.map_or(ANGLES, |theta| [0.0, 0.5 * theta, theta])
}

fn drawing(setting: Setting) -> Drawing {
    let mut drawing = Drawing::slide();
    drawing.header(TITLE, EQUATION);
    for (angle, x) in angles(setting).into_iter().zip([112.0, 298.0, 486.0]) {
        beam(&mut drawing, Point::new(x, 310.0), angle);
    }
    let corners = [Point::new(716.0, 112.0), Point::new(916.0, 386.0)];
    let plot = Plot { corners, x: [0.0, 90.0], y: [0.0, 1.0] };
    let x_ticks = ticks(&[0.0, 30.0, 60.0, 90.0], "°");
    plot.axes(&mut drawing, &x_ticks, &ticks(&[0.0, 0.5, 1.0], ""));
    plot.names(&mut drawing, "angle of incidence *θ*", "light received", 42.0);
    plot.curve(&mut drawing, [0.0, 90.0], 90, cosine, Stroke::new(style::NORMAL, style::CURVE));
    for angle in angles(setting) {
        plot.dot(&mut drawing, angle, cosine(angle), style::MIRROR);
    }
    drawing.text(plot.at(58.0, 0.66), Anchor::Start, style::NOTE, style::NORMAL, "cos *θ*");
    drawing
}

/// A beam from above that falls on a surface turned by `angle`, both around `foot`.
fn beam(drawing: &mut Drawing, foot: Point, angle: f64) {
    let share = cosine(angle);
    let (along, n) = (heading(-angle), heading(90.0 - angle));
    let (lit, ends) = (0.5 * BEAM / share * along, (0.5 * BEAM / share + 24.0) * along);
    let deep = -20.0 * n;
    let body = [foot - ends, foot + ends, foot + ends + deep, foot - ends + deep];
    drawing.fill(Path::polygon(body), style::BODY);

    let top = |x: f64| Point::new(foot.x + x, 104.0);
    let half = 0.5 * BEAM;
    let sides = [foot - lit, top(-half), top(half), foot + lit];
    drawing.fill(Path::polygon(sides), GLOW.fade(0.45));
    for ray in 0..5 {
        let t = f64::from(ray) / 2.0 - 1.0;
        drawing.arrow(top(t * half), foot + t * lit, style::LIGHT, 1.6);
    }
    drawing.line(foot - ends, foot + ends, Stroke::new(style::SURFACE, 2.0));
    drawing.line(foot - lit + 0.5 * deep, foot + lit + 0.5 * deep, Stroke::new(style::MIRROR, 5.0));
    if angle > 0.0 {
        drawing.vector(foot, foot + 128.0 * n, style::NORMAL, "*n*");
        drawing.angle(foot, 76.0, [90.0 - angle, 90.0], style::TEXT, "*θ*");
    }

    let line = |y: f64| Point::new(foot.x, y);
    drawing.heading(line(448.0), &format!("*θ* = {angle}°"));
    drawing.note(line(476.0), &format!("spread over {}×", fixed(1.0 / share, 3)));
    drawing.note(line(500.0), &format!("receives {}", fixed(share, 3)));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_footprint_of_a_beam_grows_as_its_light_thins() {
        let numbers = draw(Setting::DRAFT).numbers;
        let values: Vec<f64> = numbers.iter().map(|number| number.value).collect();
        let expected = [1.0, 1.0, 0.866_025_4, 1.154_700_5, 0.5, 2.0];
        for (value, expected) in values.iter().zip(expected) {
            assert!((value - expected).abs() < 1e-6, "{value} for {expected}");
        }
    }
}
