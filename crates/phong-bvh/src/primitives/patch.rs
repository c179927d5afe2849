//! What a surface is near one of its points.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

/// A surface near one of its points.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Patch {
    /// The point.
    pub(crate) p: DVec3,
    /// Normal to the surface, outwards; of any length.
    pub(crate) normal: DVec3,
    /// Along the surface and growing u, of any length; zero where there is no such direction.
    pub(crate) tangent: DVec3,
    /// Surface coordinates.
    pub(crate) uv: DVec2,
    /// No less than the greatest curvature in any direction: 1 / radius.
    pub(crate) curvature: f64,
}

/// The angle of (x, y) from the x axis towards the y axis, in turns: [0, 1].
pub(crate) fn turn(y: f64, x: f64) -> f64 {
    let turns = libm::atan2(y, x) / TAU;
    if turns < 0.0 { turns + 1.0 } else { turns }
}
