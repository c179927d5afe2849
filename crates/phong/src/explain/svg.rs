//! The vectors at a point, drawn: in the plane of incidence of each light, and in space.

use std::fmt::Write;

use glam::{DVec2, DVec3, Vec3};

use super::text::{hidden, named};
use super::{End, Explanation, Lit, Surface};

const N: &str = "#0066a8";
const L: &str = "#c97b00";
const R: &str = "#c84a00";
const E: &str = "#008360";
const H: &str = "#9b3d83";
const MUTED: &str = "#5c6570";

/// One panel's width and height.
const PANEL: DVec2 = DVec2::new(360.0, 330.0);
/// Length of a unit vector.
const UNIT: f64 = 130.0;

impl Explanation {
    /// An SVG of what sample `sample` (from 0) met first: for each light one panel in its plane of
    /// incidence, where E is seen in projection, and one in space. `None` if it met nothing.
    pub fn svg(&self, sample: usize) -> Option<String> {
        let ray = self.samples.get(sample)?.ray.as_ref()?;
        let End::Surface(surface) = &ray.end else { return None };
        let lights: Vec<&Lit> = surface.lights.iter().filter(|lit| lit.l.is_some()).collect();
        let rows = lights.len().max(1) as f64;
        let (width, height) = (2.0 * PANEL.x, rows * PANEL.y + 50.0);
        let mut out = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" \
             font-family=\"sans-serif\" font-size=\"14\">\n\
             <rect width=\"{width}\" height=\"{height}\" fill=\"#fff\"/>\n"
        );
        let [x, y] = self.pixel;
        let object = named(&surface.object, surface.element);
        text(
            &mut out,
            DVec2::new(20.0, 30.0),
            "start",
            "#1f242b",
            16.0,
            &format!("pixel ({x}, {y}): {object}"),
        );
        if lights.is_empty() {
            panel(&mut out, DVec2::new(0.0, 50.0), surface, None, false);
            panel(&mut out, DVec2::new(PANEL.x, 50.0), surface, None, true);
        }
        for (row, lit) in lights.into_iter().enumerate() {
            let top = 50.0 + row as f64 * PANEL.y;
            panel(&mut out, DVec2::new(0.0, top), surface, Some(lit), false);
            panel(&mut out, DVec2::new(PANEL.x, top), surface, Some(lit), true);
        }
        out.push_str("</svg>\n");
        Some(out)
    }
}

/// The vectors of one light: in its plane of incidence, or in space.
fn panel(out: &mut String, corner: DVec2, s: &Surface, lit: Option<&Lit>, in_space: bool) {
    let n = s.n.to_vec().as_dvec3();
    let toward = lit.and_then(|lit| lit.l).unwrap_or(s.e).to_vec().as_dvec3();
    // Along the surface, away from the light: L leans to the left.
    let away = -(toward - toward.dot(n) * n);
    let across = away.try_normalize().unwrap_or_else(|| n.any_orthonormal_vector());
    let depth = across.cross(n);
    let origin = corner + DVec2::new(PANEL.x / 2.0, 210.0);
    // In space: seen from a little above, the surface's depth running up to the right.
    let place = |v: DVec3| {
        let (x, up, back) = (v.dot(across), v.dot(n), v.dot(depth));
        let flat = if in_space {
            DVec2::new(x + 0.45 * back, up + 0.28 * back)
        } else {
            DVec2::new(x, up)
        };
        origin + UNIT * DVec2::new(flat.x, -flat.y)
    };
    ground(out, &place, across, depth, in_space);
    let mut vector = |v: Vec3, ink: &str, name: &str| {
        let (from, to) = (origin, place(v.as_dvec3()));
        arrow(out, from, to, ink);
        let beyond = to + (to - from).normalize_or(DVec2::NEG_Y) * 16.0 + DVec2::new(0.0, 5.0);
        text(out, beyond, "middle", ink, 17.0, name);
    };
    vector(s.n.to_vec(), N, "N");
    vector(s.e.to_vec(), E, "E");
    if let Some(lit) = lit {
        for (dir, ink, name) in [(lit.l, L, "L"), (lit.r, R, "R"), (lit.h, H, "H")] {
            if let Some(dir) = dir {
                vector(dir.to_vec(), ink, name);
            }
        }
    }
    let what = if in_space { "in space" } else { "in the plane of incidence" };
    let title = lit.map_or(what.to_owned(), |lit| format!("{}, {what}", lit.name));
    text(out, corner + DVec2::new(20.0, 22.0), "start", MUTED, 14.0, &title);
    if let (Some(lit), false) = (lit, in_space) {
        let numbers = format!(
            "N·L = {:.4}   R·E = {:.4}   N·H = {:.4}",
            lit.n_dot_l, lit.r_dot_e, lit.n_dot_h
        );
        text(out, corner + DVec2::new(20.0, PANEL.y - 34.0), "start", MUTED, 13.0, &numbers);
        let why = hidden(lit).map_or("lit".to_owned(), str::to_owned);
        text(out, corner + DVec2::new(20.0, PANEL.y - 14.0), "start", MUTED, 13.0, &why);
    }
}

/// The surface: a line, or a patch of it in space.
fn ground(
    out: &mut String,
    place: &impl Fn(DVec3) -> DVec2,
    across: DVec3,
    depth: DVec3,
    in_space: bool,
) {
    let corners: Vec<DVec3> = if in_space {
        vec![-across - depth, across - depth, across + depth, depth - across]
    } else {
        vec![-1.2 * across, 1.2 * across]
    };
    let points: Vec<String> = corners
        .into_iter()
        .map(|corner| {
            let p = place(corner);
            format!("{:.2},{:.2}", p.x, p.y)
        })
        .collect();
    let kind = if in_space { "polygon" } else { "polyline" };
    // Writing to a String cannot fail.
    let _ = writeln!(
        out,
        "<{kind} points=\"{}\" fill=\"#eef1f4\" stroke=\"{MUTED}\"/>",
        points.join(" ")
    );
}

fn arrow(out: &mut String, from: DVec2, to: DVec2, ink: &str) {
    let along = (to - from).normalize_or(DVec2::NEG_Y);
    let (side, back) = (along.perp() * 5.0, to - 12.0 * along);
    let (left, right) = (back + side, back - side);
    let _ = writeln!(
        out,
        "<line x1=\"{:.2}\" y1=\"{:.2}\" x2=\"{:.2}\" y2=\"{:.2}\" stroke=\"{ink}\" stroke-width=\"3\"/>\
         <polygon points=\"{:.2},{:.2} {:.2},{:.2} {:.2},{:.2}\" fill=\"{ink}\"/>",
        from.x, from.y, back.x, back.y, to.x, to.y, left.x, left.y, right.x, right.y
    );
}

fn text(out: &mut String, at: DVec2, anchor: &str, ink: &str, size: f64, words: &str) {
    let _ = writeln!(
        out,
        "<text x=\"{:.2}\" y=\"{:.2}\" text-anchor=\"{anchor}\" fill=\"{ink}\" font-size=\"{size}\">{}</text>",
        at.x,
        at.y,
        super::html::escaped(words)
    );
}
