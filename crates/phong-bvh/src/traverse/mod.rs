//! Rays through the tree.

mod single;
mod slabs;

use std::cell::RefCell;

pub(crate) use self::single::{Any, Closest};
use crate::{Cost, Hit};

/// Entries a stack can need: a tree is at most [`DEEP`](crate::build) cuts and 32 halvings deep, and
/// each node leaves seven children behind.
const STACK: usize = 7 * (64 + 32);

thread_local! {
    /// One stack a thread: clearing one for each ray would cost a tenth of its time.
    static STACKS: RefCell<Stack> = const { RefCell::new(Stack([0; STACK])) };
}

/// Nodes to visit: entry distance in the upper half, [`Ref`](crate::node8::Ref) in the lower.
pub(crate) struct Stack([u64; STACK]);

/// Runs with this thread's stack.
#[inline(always)]
pub(crate) fn with_stack<R>(run: impl FnOnce(&mut Stack) -> R) -> R {
    STACKS.with_borrow_mut(run)
}

/// Who counts what a ray costs; `()` does not.
pub(crate) trait Meter {
    /// A node was visited.
    fn node(&mut self);
    /// A block of primitives, or a solid or plane, was tested.
    fn primitive(&mut self);
}

impl Meter for () {
    #[inline(always)]
    fn node(&mut self) {}

    #[inline(always)]
    fn primitive(&mut self) {}
}

impl Meter for Cost {
    #[inline(always)]
    fn node(&mut self) {
        self.nodes += 1;
    }

    #[inline(always)]
    fn primitive(&mut self) {
        self.primitives += 1;
    }
}

/// The best hit so far. Before the first it stands at the ray's end, with the number of none.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Best(pub(crate) Hit);

impl Best {
    /// No hit yet.
    #[inline(always)]
    pub(crate) fn new(t_max: f32) -> Self {
        Self(Hit { t: t_max, ..Hit::NONE })
    }

    /// Takes a hit that is nearer, or as near and of a lower number.
    #[inline(always)]
    pub(crate) fn offer(&mut self, t: f32, prim: u32, u: f32, v: f32) {
        if t < self.0.t || (t == self.0.t && prim < self.0.prim) {
            self.0 = Hit { t, prim, u, v };
        }
    }

    /// The hit, if any.
    #[inline(always)]
    pub(crate) fn hit(self) -> Hit {
        if self.0.is_some() { self.0 } else { Hit::NONE }
    }
}
