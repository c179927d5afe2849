//! The frustum of a cone: x² + y² = r(z)², r(z) = `radius` + k z, 0 ≤ z ≤ 1.
//!
//! With `r_o = r(o_z)` and `r_d = k d_z` the line is inside where `a t² + 2 b t + c ≤ 0`:
//! `a = d_x² + d_y² − r_d²`, `b = o_x d_x + o_y d_y − r_o r_d`, `c = o_x² + o_y² − r_o²`. By Lagrange's
//! identity for this difference of squares, the discriminant is
//! `b² − a c = (o_x r_d − r_o d_x)² + (o_y r_d − r_o d_y)² − (o_x d_y − o_y d_x)²`.
//!
//! The equation is that of a double cone, whose two halves meet at the apex; only one of them
//! reaches into 0 ≤ z ≤ 1. Across the axis (a > 0) a line is inside between the roots. Along it
//! (a < 0) it is inside one half up to the lesser root and inside the other from the greater
//! one on. Parallel to a side (a = 0) it is inside on one side of a single root.
//!
//! Faces, and coordinates, as those of the [`cylinder`](super::cylinder).

use glam::{DVec2, DVec3};

use super::{
    crossing::{Crossings, Line, Span, quadratic},
    disc,
    patch::{Patch, turn},
};

/// Radii at z = 0 and at z = 1.
pub(super) type Radii = [f64; 2];

/// The crossings of a line and the frustum.
pub(super) fn crossings(line: &Line, radii: Radii, capped: bool) -> Crossings {
    let parts = within(line, radii);
    if capped {
        // A frustum is convex: of the two parts no more than one reaches into it. Rounding at the
        // apex may let both touch it, hence the longer.
        let between = Span::slab(line.o.z, line.d.z, [0.0, 1.0], [1, 2]);
        let clip = |part: Option<Span>| part.and_then(|part| between?.and(part));
        let length = |span: &Span| span.length();
        let inside = parts.map(clip).into_iter().flatten();
        return inside.max_by(|p, q| length(p).total_cmp(&length(q))).into();
    }
    let mut crossings = Crossings::NONE;
    for t in parts.into_iter().flatten().flat_map(|part| part.ends()) {
        if (0.0..=1.0).contains(&line.at(t).z) {
            crossings.push(t, 0);
        }
    }
    crossings
}

/// The parts of a line inside the endless double cone, by growing `t`.
fn within(line: &Line, [radius, radius_to]: Radii) -> [Option<Span>; 2] {
    let k = radius_to - radius;
    let (o, d) = (line.o.truncate(), line.d.truncate());
    let (r_o, r_d) = (radius + k * line.o.z, k * line.d.z);
    let a = d.length_squared() - r_d * r_d;
    let b = o.dot(d) - r_o * r_d;
    let c = o.length_squared() - r_o * r_o;
    let (along, across) = (r_d * o - r_o * d, o.perp_dot(d));
    let discriminant = along.length_squared() - across * across;
    let span = |enter, leave| Some(Span::new(enter, leave, 0));
    let (first, last) = (f64::NEG_INFINITY, f64::INFINITY);
    if a > 0.0 {
        [quadratic(a, b, c, discriminant).map(|[t, s]| Span::new(t, s, 0)), None]
    } else if a < 0.0 {
        // Such a line passes from one half to the other: it has roots, if only one at the apex.
        let [t, s] = quadratic(a, b, c, discriminant.max(0.0)).unwrap_or_default();
        [span(first, t), span(s, last)]
    } else if b > 0.0 {
        [span(first, -0.5 * c / b), None]
    } else if b < 0.0 {
        [span(-0.5 * c / b, last), None]
    } else {
        [(c <= 0.0).then_some(Span::WHOLE), None]
    }
}

/// The side around the point `p`, or one of the caps.
///
/// The gradient of `x² + y² − r(z)²` is along `(x/ρ, y/ρ, −k)` on the side, ρ = r(z). The apex has no
/// normal; it is given the axis, outwards.
pub(super) fn patch(p: DVec3, [radius, radius_to]: Radii, face: u8) -> Patch {
    match face {
        1 => disc::patch(p, 0.0, radius, false),
        2 => disc::patch(p, 1.0, radius_to, true),
        _ => {
            let k = radius_to - radius;
            let z = p.z.clamp(0.0, 1.0);
            let r = radius + k * z;
            let out = p.truncate().normalize_or_zero();
            let normal = if r > 0.0 && out != DVec2::ZERO {
                out.extend(-k)
            } else {
                DVec3::new(0.0, 0.0, -k)
            };
            Patch {
                p: (r * out).extend(z),
                normal,
                tangent: DVec3::new(-out.y, out.x, 0.0),
                uv: DVec2::new(turn(out.y, out.x), z),
                curvature: 1.0 / r,
            }
        }
    }
}
