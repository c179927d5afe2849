//! The torus (√(x² + y²) − 1)² + z² = s², s the radius of the tube.
//!
//! **The quartic.** Multiplied by the positive `(ρ + 1)² + z² − s²`, ρ = √(x² + y²), the equation is
//! free of roots: `f = (|p|² + 1 − s²)² − 4 ρ²`, with the same sign everywhere. On a line of unit
//! direction from its point closest to the middle, `|p|² = t² + o·o`, so with `K = o·o + 1 − s²` and
//! `ρ² = a t² + 2 b t + c`: `f(t) = t⁴ + 2P t² − 8 b t + K² − 4c`, `P = K − 2a`; no cubic term.
//!
//! **Its roots.** Between two neighbouring turning points f is monotone, so a change of sign there
//! is one root, and none is none. The turning points are the roots of
//! `f′/4 = t³ + P t − 2b`, found in the same way between *its* turning points `±√(−P/3)`.
//! Nothing is missed and nothing made up, however close two roots are: a graze deeper than rounding
//! changes the sign at the turning point, and a shallower one is nobody's loss.
//!
//! **Its digits.** For a thin tube `f` is of the order s², and its coefficients are not; the sign,
//! and the root, are therefore taken from the first equation, which is exact to rounding in the
//! distance from the tube's middle.
//!
//! Coordinates: u = angle around the axis / 2π from the x axis towards the y axis, v = angle around
//! the tube / 2π, from the outermost circle up towards +z.

use glam::{DMat3, DVec2, DVec3};

use super::{
    crossing::{Crossings, Line, Span},
    cylinder, disc, ellipsoid,
    patch::{Patch, turn},
};

/// The crossings of a line and the torus of tube radius `tube`, up to the first that is `enough`:
/// each takes a search.
pub(super) fn crossings(line: &Line, tube: f64, enough: impl Fn(f64) -> bool) -> Crossings {
    let length = line.d.length();
    let line = Line { o: line.o, d: line.d / length };
    let mut crossings = Crossings::NONE;
    let Some([first, last]) = bound(&line, tube) else { return crossings };

    let (o, d) = (line.o.truncate(), line.d.truncate());
    let (a, b) = (d.length_squared(), o.dot(d));
    let p = line.o.length_squared() + 1.0 - tube * tube - 2.0 * a;
    let slope = |t: f64| ((t * t + p) * t - 2.0 * b, 3.0 * t * t + p);
    let bend = (-p / 3.0).max(0.0).sqrt();
    let bends = [first, (-bend).clamp(first, last), bend.clamp(first, last), last];

    // A stretch without a turning point is monotone, and may as well be cut anywhere.
    let mut cuts = [first, first, first, first, last];
    for (i, stretch) in bends.windows(2).enumerate() {
        cuts[i + 1] = root([stretch[0], stretch[1]], slope).unwrap_or(stretch[0]);
    }
    for stretch in cuts.windows(2) {
        if let Some(t) = root([stretch[0], stretch[1]], |t| depth(&line, tube, t)) {
            crossings.push(t / length, 0);
            if enough(t / length) {
                break;
            }
        }
    }
    crossings
}

/// The part of a line in the flat cylinder around the torus, which is a little larger: at both ends
/// the line is certainly outside the torus.
fn bound(line: &Line, tube: f64) -> Option<[f64; 2]> {
    const WIDER: f64 = 1.001;
    let height = WIDER * tube;
    let between = Span::slab(line.o.z, line.d.z, [-height, height], [0, 0])?;
    Some(between.and(cylinder::around(line, WIDER * (1.0 + tube))?)?.ends())
}

/// The torus equation at `t`, negative inside the tube, and its derivative.
fn depth(line: &Line, tube: f64, t: f64) -> (f64, f64) {
    let p = line.at(t);
    let rho = p.truncate().length();
    let (off, z) = (rho - 1.0, p.z);
    let rho_slope = p.truncate().dot(line.d.truncate()) / rho;
    (off * off + z * z - tube * tube, 2.0 * (off * rho_slope + z * line.d.z))
}

/// The root of a monotone function (given with its slope) if it changes sign from `low` to `high`.
///
/// Newton's step wherever it stays between the bounds and at least halves the step before it, else
/// bisection; so the bounds close in whatever the function. The last step is the error before it,
/// squared.
fn root([mut low, mut high]: [f64; 2], f: impl Fn(f64) -> (f64, f64)) -> Option<f64> {
    const CLOSE: f64 = 1e-12;
    let starts_below = f(low).0 < 0.0;
    if (f(high).0 < 0.0) == starts_below {
        return None;
    }
    let mut t = 0.5 * (low + high);
    let mut step = high - low;
    for _ in 0..64 {
        let (value, slope) = f(t);
        if (value < 0.0) == starts_below {
            low = t;
        } else {
            high = t;
        }
        let newton = t - value / slope;
        let halves = (2.0 * value).abs() <= (step * slope).abs();
        let next =
            if halves && low < newton && newton < high { newton } else { 0.5 * (low + high) };
        step = next - t;
        t = next;
        if step.abs() <= CLOSE {
            break;
        }
    }
    Some(t)
}

/// How far the torus reaches along each axis under `m`: it has the hull of a flat disc of radius 1
/// thickened by a ball of radius `tube`.
pub(super) fn reach(m: &DMat3, tube: f64) -> DVec3 {
    disc::reach(m, 1.0) + tube * ellipsoid::reach(m)
}

/// The torus around the point nearest to `p`.
pub(super) fn patch(p: DVec3, tube: f64) -> Patch {
    let out = p.truncate().normalize_or(DVec2::X);
    let ring = out.extend(0.0);
    let normal = (p - ring).normalize_or(ring);
    Patch {
        p: ring + tube * normal,
        normal,
        tangent: DVec3::new(-out.y, out.x, 0.0),
        uv: DVec2::new(turn(out.y, out.x), turn(normal.z, normal.dot(ring))),
        curvature: (1.0 / tube).max(1.0 / (1.0 - tube)),
    }
}
