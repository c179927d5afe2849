//! The vectors at a point, drawn: in the plane of incidence of each light, and in space.

mod labels;

use std::f64::consts::PI;
use std::fmt::Write;

use glam::{DVec2, DVec3};
use phong::explain::{End, Explanation, Lit, Surface};
use phong::math::{Dir3, wide};

use super::text::{hidden, named};
use crate::markup::escaped;
use labels::Labels;

const N: &str = "#0066a8";
const L: &str = "#c97b00";
const R: &str = "#c84a00";
const E: &str = "#008360";
const H: &str = "#9b3d83";
const TEXT: &str = "#1f242b";
const MUTED: &str = "#5c6570";

/// Width of a panel, and of what is around the two of them.
const PANEL: f64 = 430.0;
/// Length of a unit vector.
const UNIT: f64 = 140.0;
/// From a panel's top to the point.
const ABOVE: f64 = 200.0;
/// Half an edge of the patch of surface.
const PATCH: f64 = 0.85;
/// Cosine and sine of how far the view in space is turned about N (30°), and raised (25°).
const TURNED: [f64; 2] = [0.866_025_403_784_438_6, 0.5];
const RAISED: [f64; 2] = [0.906_307_787_036_65, 0.422_618_261_740_699_4];

/// An SVG of what sample `sample` (from 0) met first: for each light one panel in its plane of
/// incidence, where E is seen in projection, and one in space. `None` if it met nothing.
pub fn svg(told: &Explanation, sample: usize) -> Option<String> {
    let ray = told.samples.get(sample)?.ray.as_ref()?;
    let End::Surface(surface) = &ray.end else { return None };
    let lights = surface.lights.iter().filter(|lit| lit.l.is_some());
    let mut shown: Vec<Option<&Lit>> = lights.map(Some).collect();
    if shown.is_empty() {
        shown.push(None);
    }
    let mut body = String::new();
    let mut y = 70.0;
    for lit in shown {
        y = row(&mut body, y, surface, lit);
    }
    let width = 2.0 * PANEL;
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {y}\" width=\"{width}\" \
         height=\"{y}\" role=\"img\" font-family=\"Helvetica, Arial, sans-serif\" \
         font-size=\"14\">\n<rect width=\"{width}\" height=\"{y}\" fill=\"#fff\"/>\n"
    );
    let [x, y] = told.pixel;
    let object = named(&surface.object, surface.element);
    let title = format!("Pixel ({x}, {y}): {object}, {}", surface.at);
    text(&mut out, DVec2::new(20.0, 30.0), TEXT, 17.0, &title);
    let keys = [
        (N, "N", "normal"),
        (L, "L", "to the light"),
        (R, "R", "L mirrored at N"),
        (E, "E", "to the eye"),
        (H, "H", "halfway between L and E"),
    ];
    let _ = write!(out, "<text x=\"20\" y=\"54\" fill=\"{MUTED}\">");
    for (ink, letter, means) in keys {
        let _ = write!(out, "{} {means}<tspan dx=\"16\"> </tspan>", italic(ink, letter));
    }
    out.push_str("</text>\n");
    Some(out + &body + "</svg>\n")
}

/// Both panels of a light and its angles, from `top`; tells where the next row begins.
fn row(out: &mut String, top: f64, s: &Surface, lit: Option<&Lit>) -> f64 {
    let _ = writeln!(out, "<path d=\"M20 {top}H{}\" stroke=\"#d5dae0\"/>", 2.0 * PANEL - 20.0);
    let point = DVec2::new(0.5 * PANEL, top + ABOVE);
    for in_space in [false, true] {
        let at = point + if in_space { DVec2::new(PANEL, 0.0) } else { DVec2::ZERO };
        let what = if in_space { "in space" } else { "in the plane of incidence" };
        let title = lit.map_or(what.to_owned(), |lit| format!("{}, {what}", lit.name));
        text(out, DVec2::new(at.x - 0.5 * PANEL + 20.0, top + 24.0), MUTED, 14.0, &title);
        panel(out, at, s, lit, in_space);
    }
    // A light behind the surface needs room below it.
    let behind = lit.map_or(0.0, |lit| f64::from(-lit.n_dot_l).max(0.0));
    let mut y = point.y + (75.0 + RAISED[0] * UNIT * behind).max(95.0);
    let Some(lit) = lit else { return y };
    let verdict = match (&lit.blocker, hidden(lit)) {
        (Some(b), Some(why)) => format!("{why}: {} stands between", named(&b.object, b.element)),
        (None, Some(why)) => format!("{why}: diffuse and specular are 0"),
        (_, None) => "lit".to_owned(),
    };
    text(out, DVec2::new(20.0, y), TEXT, 14.0, &format!("{}: {verdict}", lit.name));
    let mut angles = vec![("θ", L, [N, L], ["N", "L"], lit.n_dot_l)];
    if lit.r.is_some() {
        angles.push(("φ", R, [R, E], ["R", "E"], lit.r_dot_e));
    }
    if lit.h.is_some() {
        angles.push(("β", H, [N, H], ["N", "H"], lit.n_dot_h));
    }
    for (name, ink, inks, [a, b], cosine) in angles {
        y += 22.0;
        let degrees = wide::acos(f64::from(cosine).clamp(-1.0, 1.0)).to_degrees();
        let _ = writeln!(
            out,
            "<text x=\"20\" y=\"{y}\">{} = ∠({}, {}) = {degrees:.1}°</text>\
             <text x=\"190\" y=\"{y}\">cos {} = {}·{} = {}</text>",
            italic(ink, name),
            italic(inks[0], a),
            italic(inks[1], b),
            italic(ink, name),
            italic(inks[0], a),
            italic(inks[1], b),
            format!("{cosine:.4}").replace('-', "−"),
        );
    }
    let (_, depth) = frame(s.n, lit.l.unwrap_or(s.e));
    let out_of_plane = 90.0 - wide::acos(unit(s.e).dot(depth).clamp(-1.0, 1.0)).to_degrees();
    let note = format!(
        "E is {:.1}° out of the plane of N and L; there it is drawn in projection",
        out_of_plane.abs()
    );
    text(out, DVec2::new(PANEL + 20.0, y), MUTED, 13.0, &note);
    y + 26.0
}

/// Along the surface away from `toward`, so that L leans to the left, and across that, to the
/// viewer of the plane.
fn frame(n: Dir3, toward: Dir3) -> (DVec3, DVec3) {
    let (n, toward) = (unit(n), unit(toward));
    let away = -(toward - toward.dot(n) * n);
    let along = away.try_normalize().unwrap_or_else(|| n.any_orthonormal_vector());
    (along, along.cross(n))
}

fn unit(dir: Dir3) -> DVec3 {
    dir.to_vec().as_dvec3()
}

/// How the surroundings of a point are looked at: along the plane of incidence, or aslant.
struct View {
    /// Where the point is on the page.
    point: DVec2,
    n: DVec3,
    along: DVec3,
    depth: DVec3,
    in_space: bool,
}

impl View {
    /// Where the tip of a vector from the point is on the page.
    fn place(&self, v: DVec3) -> DVec2 {
        let (x, y, z) = (v.dot(self.along), v.dot(self.n), v.dot(self.depth));
        let flat = if self.in_space {
            let near = z * TURNED[0] - x * TURNED[1];
            DVec2::new(x * TURNED[0] + z * TURNED[1], y * RAISED[0] - near * RAISED[1])
        } else {
            DVec2::new(x, y)
        };
        self.point + UNIT * DVec2::new(flat.x, -flat.y)
    }

    /// The surface, and in space half a disc of the plane of incidence on it; tells its edges.
    fn ground(&self, out: &mut String) -> Vec<DVec2> {
        let Self { n, along, depth, .. } = *self;
        if !self.in_space {
            let [left, right] = [-1.3, 1.3].map(|x| self.place(x * along));
            let under = [left, right, right + DVec2::new(0.0, 14.0), left + DVec2::new(0.0, 14.0)];
            outline(out, &under, "fill=\"#eef1f4\"");
            line(out, &[left, right], MUTED, "stroke-width=\"1.5\"");
            return vec![left, right];
        }
        let corners = [-along - depth, along - depth, along + depth, depth - along];
        let corners = corners.map(|corner| self.place(PATCH * corner));
        outline(out, &corners, &format!("fill=\"#eef1f4\" stroke=\"{MUTED}\""));
        let rim = (0..=36).map(|i| {
            let (sin, cos) = wide::sin_cos(f64::from(i) * PI / 36.0);
            self.place(PATCH * (cos * along + sin * n))
        });
        outline(out, &rim.collect::<Vec<_>>(), "fill=\"#8a94a0\" fill-opacity=\"0.16\"");
        [&corners[..], &corners[..1]].concat()
    }

    /// From the tip of a vector straight to the surface.
    fn plumb(&self, out: &mut String, v: DVec3) -> [DVec2; 2] {
        let [tip, foot] = [v, v - v.dot(self.n) * self.n].map(|v| self.place(v));
        line(out, &[tip, foot], MUTED, "stroke-dasharray=\"2 4\"");
        let _ = writeln!(
            out,
            "<circle cx=\"{:.2}\" cy=\"{:.2}\" r=\"2\" fill=\"{MUTED}\"/>",
            foot.x, foot.y
        );
        [tip, foot]
    }

    /// Part of a circle around the point, from one unit vector to another.
    fn arc(&self, Arc { from, to, radius, .. }: &Arc) -> Vec<DVec2> {
        let middle = (*from + *to).normalize_or(self.n);
        let at = |i: u32| {
            let t = f64::from(i) / 24.0;
            self.place(radius * ((1.0 - t) * *from + t * *to).normalize_or(middle))
        };
        (0..=24).map(at).collect()
    }
}

/// An angle to be drawn.
struct Arc {
    from: DVec3,
    to: DVec3,
    radius: f64,
    ink: &'static str,
    name: &'static str,
}

impl Arc {
    /// Those that can be measured on the page: θ in the plane, φ and β in space.
    fn of(n: DVec3, e: DVec3, lit: &Lit, in_space: bool) -> Vec<Self> {
        let [l, r, h] = [lit.l, lit.r, lit.h].map(|dir| dir.map(unit));
        let arc = |from, to: Option<DVec3>, radius, ink, name| {
            to.map(|to| Self { from, to, radius, ink, name })
        };
        let arcs = if in_space {
            [r.and_then(|r| arc(r, Some(e), 0.62, R, "φ")), arc(n, h, 0.42, H, "β")]
        } else {
            [l, r].map(|dir| arc(n, dir, 0.3, L, "θ"))
        };
        // Not those too narrow to letter, nor those too wide to be one arc.
        let drawn = |arc: &Self| (-0.98..0.998).contains(&arc.from.dot(arc.to));
        arcs.into_iter().flatten().filter(drawn).collect()
    }
}

/// The vectors of one light around `point`: in its plane of incidence, or in space.
fn panel(out: &mut String, point: DVec2, s: &Surface, lit: Option<&Lit>, in_space: bool) {
    let (along, depth) = frame(s.n, lit.and_then(|lit| lit.l).unwrap_or(s.e));
    let (n, e) = (unit(s.n), unit(s.e));
    let view = View { point, n, along, depth, in_space };
    let mut vectors = vec![(n, N, "N"), (e, E, "E")];
    if let Some(lit) = lit {
        let more = [(lit.h, H, "H"), (lit.r, R, "R"), (lit.l, L, "L")];
        let there = more.into_iter().filter_map(|(dir, ink, name)| Some((unit(dir?), ink, name)));
        vectors.extend(there);
    }
    let mut labels = Labels::new(vectors.iter().map(|vector| [point, view.place(vector.0)]));
    labels.avoid(&view.ground(out));
    if in_space {
        for (v, ..) in &vectors {
            labels.avoid(&view.plumb(out, *v));
        }
    }
    for (v, ink, _) in &vectors {
        arrow(out, point, view.place(*v), ink);
    }
    for (v, ink, name) in &vectors {
        let tip = view.place(*v);
        letter(out, labels.place(tip, tip - point), ink, 19.0, name);
    }
    for arc in lit.map_or_else(Vec::new, |lit| Arc::of(n, e, lit, in_space)) {
        let points = view.arc(&arc);
        line(out, &points, arc.ink, "stroke-width=\"1.5\"");
        labels.avoid(&points);
        let middle = points[points.len() / 2];
        letter(out, labels.place(middle, middle - point), arc.ink, 15.0, arc.name);
    }
}

/// From point to point.
fn line(out: &mut String, points: &[DVec2], ink: &str, look: &str) {
    let points: Vec<String> = points.iter().map(|p| format!("{:.2},{:.2}", p.x, p.y)).collect();
    // Writing to a String cannot fail.
    let _ = writeln!(
        out,
        "<polyline points=\"{}\" fill=\"none\" stroke=\"{ink}\" {look}/>",
        points.join(" ")
    );
}

fn outline(out: &mut String, corners: &[DVec2], paint: &str) {
    let points: Vec<String> = corners.iter().map(|p| format!("{:.2},{:.2}", p.x, p.y)).collect();
    let _ = writeln!(out, "<polygon points=\"{}\" {paint}/>", points.join(" "));
}

fn arrow(out: &mut String, from: DVec2, to: DVec2, ink: &str) {
    let long = (to - from).length();
    let along = (to - from).normalize_or(DVec2::NEG_Y);
    // An arrow that comes at the viewer keeps a head.
    let head = long.min(12.0);
    let (side, back) = (along.perp() * 0.4 * head, to - head * along);
    let (left, right) = (back + side, back - side);
    let _ = writeln!(
        out,
        "<line x1=\"{:.2}\" y1=\"{:.2}\" x2=\"{:.2}\" y2=\"{:.2}\" stroke=\"{ink}\" stroke-width=\"2.5\"/>\
         <polygon points=\"{:.2},{:.2} {:.2},{:.2} {:.2},{:.2}\" fill=\"{ink}\"/>",
        from.x, from.y, back.x, back.y, to.x, to.y, left.x, left.y, right.x, right.y
    );
}

/// A letter with its middle at `at`.
fn letter(out: &mut String, at: DVec2, ink: &str, size: f64, name: &str) {
    let _ = writeln!(
        out,
        "<text x=\"{:.2}\" y=\"{:.2}\" text-anchor=\"middle\" font-size=\"{size}\">{}</text>",
        at.x,
        at.y + 0.33 * size,
        italic(ink, name)
    );
}

fn italic(ink: &str, letter: &str) -> String {
    format!("<tspan fill=\"{ink}\" font-family=\"serif\" font-style=\"italic\">{letter}</tspan>")
}

fn text(out: &mut String, at: DVec2, ink: &str, size: f64, words: &str) {
    let _ = writeln!(
        out,
        "<text x=\"{:.2}\" y=\"{:.2}\" fill=\"{ink}\" font-size=\"{size}\">{}</text>",
        at.x,
        at.y,
        escaped(words)
    );
}
