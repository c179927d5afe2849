//! The box [−1, 1]³: the part of space inside three slabs.
//!
//! Inside one slab a line is at `−1 ≤ o_k + t d_k ≤ 1`; inside the box where it is inside all
//! three. Face 2k is the one at −1 of axis k, face 2k + 1 the one at +1.
//!
//! Coordinates: on the face of axis k, with i and j the axes after it in cyclic order, u runs along i
//! and v along j on the face at +1; on the one at −1, u runs against i. So an image is not mirrored,
//! seen from outside.

use glam::{DMat3, DVec2, DVec3};

use super::{
    crossing::{Line, Span},
    patch::Patch,
};

/// The part of a line inside the box.
pub(super) fn span(line: &Line) -> Option<Span> {
    let slab =
        |k: usize| Span::slab(line.o[k], line.d[k], [-1.0, 1.0], [2 * k as u8, 2 * k as u8 + 1]);
    slab(0)?.and(slab(1)?)?.and(slab(2)?)
}

/// How far the box's image under `m` reaches along each axis: the sum over its edges.
pub(super) fn reach(m: &DMat3) -> DVec3 {
    m.x_axis.abs() + m.y_axis.abs() + m.z_axis.abs()
}

/// The box around the point `p` on `face`.
pub(super) fn patch(p: DVec3, face: u8) -> Patch {
    let k = usize::from(face / 2).min(2);
    let (i, j) = ((k + 1) % 3, (k + 2) % 3);
    let side = if face % 2 == 1 { 1.0 } else { -1.0 };
    let mut on = p.clamp(DVec3::NEG_ONE, DVec3::ONE);
    on[k] = side;
    let uv = DVec2::new(0.5 + 0.5 * side * on[i], 0.5 + 0.5 * on[j]);
    Patch {
        p: on,
        normal: side * DVec3::AXES[k],
        tangent: side * DVec3::AXES[i],
        uv,
        curvature: 0.0,
    }
}
