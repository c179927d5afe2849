//! How many times something is left out after it was not worth while.
//!
//! Where one ray spreads too far from the next, the groups or beams that follow mostly do as well. It changes how soon
//! rays are traced and never what they hit.

/// What is left out.
#[derive(Clone, Copy)]
pub(super) struct Pause {
    /// How many more times.
    left: u32,
    /// How many times it was left out when it was not worth while last; 0: it was.
    last: u32,
}

impl Pause {
    /// Nothing is left out.
    pub(super) const NONE: Self = Self { left: 0, last: 0 };
    /// The most that is left out in a row.
    const MOST: u32 = 15;

    /// Whether the next is left out.
    #[inline(always)]
    pub(super) fn skips(&mut self) -> bool {
        let skips = self.left > 0;
        self.left -= u32::from(skips);
        skips
    }

    /// Takes note of whether one was worth while.
    #[inline(always)]
    pub(super) fn note(&mut self, done: bool) {
        self.last = if done { 0 } else { (2 * self.last + 1).min(Self::MOST) };
        self.left = self.last;
    }
}
