//! Boxes along the axes.

use glam::Vec3;

/// The points with `lo ≤ p ≤ hi`; empty where some `lo > hi`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// The lower corner.
    pub lo: Vec3,
    /// The upper corner.
    pub hi: Vec3,
}

impl Aabb {
    /// No point: the union of nothing.
    pub const EMPTY: Self = Self { lo: Vec3::INFINITY, hi: Vec3::NEG_INFINITY };

    /// Whether it holds no point.
    pub fn is_empty(&self) -> bool {
        !self.lo.cmple(self.hi).all()
    }

    /// The least box around both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self { lo: self.lo.min(other.lo), hi: self.hi.max(other.hi) }
    }

    /// Whether every point of `other` is in it.
    pub fn contains(&self, other: &Self) -> bool {
        self.lo.cmple(other.lo).all() && self.hi.cmpge(other.hi).all()
    }

    /// The box grown to all sides by 2⁻²⁰ of its largest coordinate.
    ///
    /// A primitive's test rounds: it accepts rays that miss by up to 14 · 2⁻²⁴ of the coordinates of
    /// primitive and origin. Grown by a little more than that, here for the primitive and in the
    /// prepared ray for the origin, no box culls what a test accepts.
    pub(crate) fn padded(self) -> Self {
        let largest = self.lo.abs().max(self.hi.abs()).max_element();
        let pad = Vec3::splat(largest * (1.0 / 1_048_576.0));
        Self { lo: self.lo - pad, hi: self.hi + pad }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_union_of_nothing_is_empty_and_neutral() {
        let unit = Aabb { lo: Vec3::ZERO, hi: Vec3::ONE };
        assert!(Aabb::EMPTY.is_empty() && !unit.is_empty());
        assert_eq!(Aabb::EMPTY.union(unit), unit);
        assert!(unit.contains(&Aabb::EMPTY.union(unit)) && unit.padded().contains(&unit));
    }
}
