//! The nodes of the binary tree.

use super::gather::Split;
use crate::node8::Kind;

/// A node of the binary tree, or a leaf.
#[derive(Clone, Copy, Debug)]
pub(super) struct Branch {
    /// Its bounds as `[−lo, hi]`.
    pub(super) bounds: [f32; 6],
    pub(super) shape: Shape,
    pub(super) split: Split,
}

/// What is under a branch.
#[derive(Clone, Copy, Debug)]
pub(super) enum Shape {
    /// So many boxes of one kind from number `first` of the subtree's own.
    Leaf { kind: Kind, len: u8, first: u32 },
    /// Two branches: the left one's number; the right one is the one before this.
    Pair { left: u32 },
    /// A subtree, by number.
    Subtree(u32),
}
