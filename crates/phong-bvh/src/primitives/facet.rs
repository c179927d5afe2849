//! A triangle met in f64: z = 0, x ≥ 0, y ≥ 0, x + y ≤ 1; geometric normal +z.
//!
//! For the few triangles that are so large next to what stands on them that f32 is too coarse. As with the disc,
//! `t = −o_z / d_z`. Two of them that share an edge stand in spaces of their own, so each reaches beyond
//! its edges by more than rounding can be: no ray slips through between them.

use glam::{DMat3, DVec2, DVec3};

use super::{
    crossing::{Crossings, Line},
    patch::Patch,
};

/// How far it reaches beyond its edges, in its own space.
const OVER: f64 = 1e-12;

/// The one crossing of a line and the triangle.
pub(super) fn crossings(line: &Line) -> Crossings {
    let mut crossings = Crossings::NONE;
    if line.d.z != 0.0 {
        let t = -line.o.z / line.d.z;
        let DVec2 { x, y } = line.at(t).truncate();
        if x >= -OVER && y >= -OVER && x + y <= 1.0 + OVER {
            crossings.push(t, 0);
        }
    }
    crossings
}

/// The weights of its second and third corner at a point, as a triangle of a mesh has them.
pub(super) fn weights(p: DVec3) -> [f32; 2] {
    let u = p.x.clamp(0.0, 1.0);
    [u as f32, p.y.clamp(0.0, 1.0 - u) as f32]
}

/// Its lowest and highest corner of the world from `origin`, under the linear map `m`.
pub(super) fn bounds(m: &DMat3, origin: DVec3) -> [DVec3; 2] {
    let (b, c) = (origin + m.x_axis, origin + m.y_axis);
    [origin.min(b).min(c), origin.max(b).max(c)]
}

/// The triangle around the point `p` on it.
pub(super) fn patch(p: DVec3) -> Patch {
    Patch {
        p: p.truncate().extend(0.0),
        normal: DVec3::Z,
        tangent: DVec3::X,
        uv: p.truncate(),
        curvature: 0.0,
    }
}
