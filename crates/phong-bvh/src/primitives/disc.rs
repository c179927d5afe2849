//! The unit disc: z = 0, x² + y² ≤ 1; geometric normal +z. Also the caps of cylinders and cones.
//!
//! `t = −o_z / d_z`, kept where the point lies within the circle. A ray within the disc's plane
//! meets nothing. Coordinates: u = (x + 1)/2, v = (y + 1)/2, so an image lies flat on it.

use glam::{DMat3, DVec2, DVec3};

use super::{
    crossing::{Crossings, Line},
    patch::Patch,
};

/// The one crossing of a line and the disc.
pub(super) fn crossings(line: &Line) -> Crossings {
    let mut crossings = Crossings::NONE;
    if line.d.z != 0.0 {
        let t = -line.o.z / line.d.z;
        if line.at(t).truncate().length_squared() <= 1.0 {
            crossings.push(t, 0);
        }
    }
    crossings
}

/// How far the disc of `radius` around the origin reaches from it along each axis of the world,
/// under the linear map `m`.
///
/// The farthest point along a direction w of the image is where w pulled back is farthest: `|mᵀ w|`
/// without its z, times the radius.
pub(super) fn reach(m: &DMat3, radius: f64) -> DVec3 {
    let [x, y] = [m.x_axis, m.y_axis];
    let pulled = x * x + y * y;
    radius * DVec3::new(pulled.x.sqrt(), pulled.y.sqrt(), pulled.z.sqrt())
}

/// The disc of `radius` at height `z` around the point `p` on it, seen from `up` or from below.
pub(super) fn patch(p: DVec3, z: f64, radius: f64, up: bool) -> Patch {
    let uv = if radius > 0.0 { p.truncate() / radius } else { DVec2::ZERO };
    Patch {
        p: p.truncate().extend(z),
        normal: if up { DVec3::Z } else { DVec3::NEG_Z },
        tangent: DVec3::X,
        uv: 0.5 + 0.5 * uv,
        curvature: 0.0,
    }
}
