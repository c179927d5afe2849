//! The tree in memory: rows of eight numbers.
//!
//! | | rows | each row holds, for eight children or primitives |
//! |---|---|---|
//! | node | 8 | lo x, hi x, lo y, hi y, lo z, hi z, [`Ref`], – |
//! | triangles | 10 | x, y, z of the three corners; number |
//! | spheres | 5 | x, y, z, radius; number |
//! | cylinders | 10 | x, y, z of the first end; the same of half the way to the second; how near a ray may miss; the two radii, whose signs tell the ends; number |
//! | solid | 1 | number, index of its geometry, – |
//! | indexed triangles | 2 | number within its geometry; index of its geometry; none: 2³² − 1 |
//!
//! A [`Ref`] counts rows from the node that holds it, and children follow their parent. So a subtree
//! is a run of rows that means the same wherever it is put: subtrees are built apart, by as
//! many threads as there are, and then laid end to end.

use crate::Primitives;

/// Eight numbers: f32, or the bits of u32.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(32))]
pub(crate) struct Row(pub(crate) [f32; 8]);

impl Row {
    /// Eight zeros.
    pub(crate) const ZERO: Self = Self([0.0; 8]);

    /// The bits of one number.
    #[inline(always)]
    pub(crate) fn bits(&self, lane: usize) -> u32 {
        self.0[lane & 7].to_bits()
    }
}

/// The rows of a node.
pub(crate) const NODE: usize = 8;
/// The row of a node that holds the [`Ref`]s.
pub(crate) const REFS: usize = 6;

/// The most rows a tree can have.
pub(crate) const MAX_ROWS: usize = 1 << 29;

/// Bits below those of the tag.
const TAG: u32 = 29;
const ROW: u32 = (1 << TAG) - 1;

/// What a child is, and where: in bits 31–29 a tag, in bits 28–0 a row. The tag of a node is 0, and
/// that of a leaf is its [`Kind`], so there is room for seven kinds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Ref(pub(crate) u32);

/// The kinds of leaves: up to eight primitives, or one solid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub(crate) enum Kind {
    Triangles = 1,
    Spheres,
    Solid,
    /// Triangles that are looked up in their geometry: less memory, more time.
    Indexed,
    Cylinders,
}

impl Kind {
    /// The kind of leaf a geometry's primitives make, or none: they have no bounds.
    pub(crate) const fn of(geometry: &Primitives) -> Option<Self> {
        match geometry {
            Primitives::Triangles { .. } => Some(Self::Triangles),
            Primitives::Spheres(_) => Some(Self::Spheres),
            Primitives::Solid(_) => Some(Self::Solid),
            Primitives::Cylinders { .. } => Some(Self::Cylinders),
            Primitives::Plane(_) => None,
        }
    }
}

impl Ref {
    /// An inner node.
    pub(crate) const fn node(row: usize) -> Self {
        Self(row as u32)
    }

    /// A leaf.
    pub(crate) const fn leaf(kind: Kind, row: usize) -> Self {
        Self(row as u32 | (kind as u32) << TAG)
    }

    /// The row it begins at.
    #[inline(always)]
    pub(crate) const fn row(self) -> usize {
        (self.0 & ROW) as usize
    }

    /// What kind of leaf it is, or none: a node.
    #[inline(always)]
    pub(crate) const fn kind(self) -> Option<Kind> {
        match self.0 >> TAG {
            0 => None,
            1 => Some(Kind::Triangles),
            2 => Some(Kind::Spheres),
            3 => Some(Kind::Solid),
            4 => Some(Kind::Indexed),
            _ => Some(Kind::Cylinders),
        }
    }

    /// The same, of a row counted from `row`.
    #[inline(always)]
    pub(crate) const fn from(self, row: usize) -> Self {
        Self(self.0 + row as u32)
    }
}

/// `N` rows from `row` on.
#[inline(always)]
pub(crate) fn rows<const N: usize>(rows: &[Row], row: usize) -> &[Row; N] {
    rows[row..row + N].try_into().expect("a range of N has length N")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reference_keeps_its_kind_and_counts_from_anywhere() {
        let leaves = [Kind::Triangles, Kind::Spheres, Kind::Solid, Kind::Indexed, Kind::Cylinders];
        for kind in leaves {
            let leaf = Ref::leaf(kind, 7).from(100);
            assert_eq!((leaf.kind(), leaf.row()), (Some(kind), 107));
            let last = Ref::leaf(kind, MAX_ROWS - 1);
            assert_eq!((last.kind(), last.row()), (Some(kind), MAX_ROWS - 1));
        }
        assert_eq!((Ref::node(3).from(4).kind(), Ref::node(3).from(4).row()), (None, 7));
        let last = Ref::node(MAX_ROWS - 1);
        assert_eq!((last.kind(), last.row()), (None, MAX_ROWS - 1));
    }
}
