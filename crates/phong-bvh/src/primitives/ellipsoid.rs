//! The unit sphere, an ellipsoid under an uneven transform: |p|² = 1.
//!
//! From the point of the line closest to the middle, at `t_c = −o·d / d·d`, both crossings are
//! `√(1 − m²) / |d|` away, m being the line's distance from the middle. With m = |o × d| / |d|
//! (Lagrange's identity; no difference of large numbers): `t = t_c ± √(d·d − |o × d|²) / d·d`.
//!
//! Coordinates: u = longitude / 2π from the x axis towards the y axis, v = latitude from 0 at the
//! pole −z to 1 at +z.

use glam::{DMat3, DVec2, DVec3};

use super::{
    crossing::{Crossings, Line},
    patch::{Patch, turn},
};

/// The crossings of a line and the unit sphere.
pub(super) fn crossings(line: &Line) -> Crossings {
    let mut crossings = Crossings::NONE;
    let dd = line.d.length_squared();
    let inside = dd - line.o.cross(line.d).length_squared();
    if inside >= 0.0 {
        let middle = -line.o.dot(line.d) / dd;
        let half = inside.sqrt() / dd;
        crossings.push(middle - half, 0);
        crossings.push(middle + half, 0);
    }
    crossings
}

/// How far the unit sphere's image under `m` reaches along each axis: the length of each row.
pub(super) fn reach(m: &DMat3) -> DVec3 {
    let rows = m.transpose();
    DVec3::new(rows.x_axis.length(), rows.y_axis.length(), rows.z_axis.length())
}

/// The sphere around the point nearest to `p`.
pub(crate) fn patch(p: DVec3) -> Patch {
    let n = p.normalize_or(DVec3::Z);
    let height = n.z.clamp(-1.0, 1.0);
    let latitude = libm::asin(height) / std::f64::consts::PI + 0.5;
    Patch {
        p: n,
        normal: n,
        tangent: DVec3::new(-n.y, n.x, 0.0),
        uv: DVec2::new(turn(n.y, n.x), latitude),
        curvature: 1.0,
    }
}
