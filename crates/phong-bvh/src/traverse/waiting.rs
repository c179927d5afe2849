//! What a traversal has still to visit.

use crate::node8::{NODE, REFS, Ref, Row};

/// A node or leaf on a stack.
pub(super) trait Waiting: Copy {
    /// Its entry distance in the upper half, its [`Ref`] in the lower.
    fn key(self) -> u64;
}

impl Waiting for u64 {
    #[inline(always)]
    fn key(self) -> u64 {
        self
    }
}

/// The key of the child in a lane of the node in row `at`, which is entered at `enter`.
#[inline(always)]
pub(super) fn key_of_child(node: &[Row; NODE], at: usize, lane: usize, enter: &[f32; 8]) -> u64 {
    let child = Ref(node[REFS].bits(lane)).from(at);
    u64::from(enter[lane & 7].to_bits()) << 32 | u64::from(child.0)
}

/// Puts something on a stack, of which what is above `bottom` came from the same node: the nearest on top.
#[inline(always)]
pub(super) fn push<T: Waiting>(stack: &mut [T], bottom: usize, depth: &mut usize, new: T) {
    let mut place = *depth;
    while place > bottom && stack[place - 1].key() < new.key() {
        stack[place] = stack[place - 1];
        place -= 1;
    }
    stack[place] = new;
    *depth += 1;
}
