//! Corners that stand alone, put together where they lie at one place.

use std::hash::{BuildHasher, Hasher, RandomState};

use glam::Vec3;

/// A slot that no position is in.
const EMPTY: u64 = u64::MAX;

/// The bits of a slot that are of the position's hash; the others are its number.
const TAG: u64 = 0xffff_ffff_0000_0000;

/// Positions, numbered in the order of first use: those of equal coordinates have one number.
#[derive(Debug)]
pub(crate) struct Weld {
    positions: Vec<Vec3>,
    /// Open addressing; a power of two, at least twice as many as there are positions.
    slots: Vec<u64>,
    hash: Hash,
}

/// How positions are spread over the slots: by numbers drawn at random, so that no file can be made
/// to put all of its own into one slot. Nothing else depends on them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hash([u64; 2]);

impl Hash {
    /// Draws the numbers.
    pub(crate) fn new() -> Self {
        let random = RandomState::new();
        Self([1, 2].map(|number: u64| {
            let mut hasher = random.build_hasher();
            hasher.write_u64(number);
            hasher.finish() | 1
        }))
    }

    #[inline]
    fn of(self, p: Vec3) -> u64 {
        // Adding 0 makes −0 the same as 0.
        let [x, y, z] = (p + 0.0).to_array().map(|c| u64::from(c.to_bits()));
        let mixed = (x | y << 32).wrapping_mul(self.0[0]) ^ (z ^ y << 32).wrapping_mul(self.0[1]);
        let mixed = (mixed ^ mixed >> 32).wrapping_mul(self.0[1] ^ self.0[0].rotate_left(17) | 1);
        mixed ^ mixed >> 32
    }
}

impl Weld {
    /// No positions, with room for so many.
    pub(crate) fn with_room(count: usize, hash: Hash) -> Self {
        let slots = vec![EMPTY; (2 * count).next_power_of_two().max(64)];
        Self { positions: Vec::with_capacity(count), slots, hash }
    }

    /// The number of a position, none of whose coordinates is NaN.
    #[inline]
    pub(crate) fn number(&mut self, p: Vec3) -> u32 {
        if 2 * self.positions.len() >= self.slots.len() {
            self.grow();
        }
        let hash = self.hash.of(p);
        let mask = self.slots.len() - 1;
        let mut at = hash as usize & mask;
        loop {
            let slot = self.slots[at];
            if slot == EMPTY {
                let number = self.positions.len() as u32;
                self.slots[at] = hash & TAG | u64::from(number);
                self.positions.push(p);
                return number;
            }
            if slot & TAG == hash & TAG && self.positions[slot as u32 as usize] == p {
                return slot as u32;
            }
            at = (at + 1) & mask;
        }
    }

    #[cold]
    fn grow(&mut self) {
        let mut slots = vec![EMPTY; 2 * self.slots.len()];
        let mask = slots.len() - 1;
        for (number, p) in self.positions.iter().enumerate() {
            let hash = self.hash.of(*p);
            let mut at = hash as usize & mask;
            while slots[at] != EMPTY {
                at = (at + 1) & mask;
            }
            slots[at] = hash & TAG | number as u64;
        }
        self.slots = slots;
    }

    /// The positions so far.
    pub(crate) fn positions(&self) -> &[Vec3] {
        &self.positions
    }

    /// The positions alone.
    pub(crate) fn into_positions(self) -> Vec<Vec3> {
        self.positions
    }

    /// Bytes that it takes in memory.
    pub(crate) fn bytes(&self) -> u64 {
        (12 * self.positions.capacity() + 8 * self.slots.len()) as u64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_places_have_one_number_in_the_order_of_first_use() {
        let mut weld = Weld::with_room(0, Hash::new());
        let place = |i: u32| Vec3::new((i % 50) as f32, -((i / 50) as f32), 0.25);
        for i in 0..5000 {
            assert_eq!(weld.number(place(i)), i);
        }
        for i in (0..5000).rev() {
            assert_eq!(weld.number(place(i)), i);
        }
        assert_eq!(weld.number(Vec3::new(0.0, -0.0, 0.25)), 0);
        assert_eq!(weld.number(Vec3::new(-0.0, 0.0, 0.25)), 0);
        assert_eq!(weld.into_positions().len(), 5000);
    }
}
