//! How many parts stay within a tolerance, and how much they come to.

use std::f64::consts::PI;

/// How much there is.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Size {
    pub(super) vertices: u64,
    pub(super) triangles: u64,
}

impl Size {
    /// Both together.
    pub(super) fn and(self, other: Self) -> Self {
        Self {
            vertices: self.vertices.saturating_add(other.vertices),
            triangles: self.triangles.saturating_add(other.triangles),
        }
    }

    /// Bytes of memory: a position, a colour and up to two normals a corner, and two times three indices.
    pub(super) fn bytes(self) -> u64 {
        self.vertices.saturating_mul(48).saturating_add(self.triangles.saturating_mul(24))
    }
}

/// How many parts of a circle stay within the tolerance of it: at least 6.
pub(super) fn parts_of_circle(radius: f64, within: f64) -> u32 {
    let ratio = within / radius;
    // Where the ratio is small, 1 − cos x ≤ x² / 2 keeps its digits.
    let half = if ratio > 1e-4 { libm::acos((1.0 - ratio).max(0.0)) } else { (2.0 * ratio).sqrt() };
    whole(PI / half).max(6)
}

/// The next whole number.
pub(super) fn whole(parts: f64) -> u32 {
    // What numbers can hold of a shape needs fewer than 10⁴.
    parts.ceil().min(1e5) as u32
}
