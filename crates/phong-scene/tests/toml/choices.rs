//! What scenes are made up by.

/// Choices that follow from a seed.
pub(crate) struct Make(pub(crate) u64);

impl Make {
    /// `SplitMix64`.
    pub(crate) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub(crate) fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }

    pub(crate) fn flag(&mut self) -> bool {
        self.below(2) == 0
    }

    pub(crate) fn one<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.below(of.len())]
    }

    /// A number from 0.01 to 1.01, of few digits or of all that f64 has.
    pub(crate) fn number(&mut self) -> f64 {
        if self.flag() {
            0.01 * self.below(100) as f64 + 0.01
        } else {
            0.01 + (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
        }
    }

    pub(crate) fn float(&mut self) -> f32 {
        self.number() as f32
    }
}
