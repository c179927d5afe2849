//! Corners that stand alone, put together where they lie at one place.

use std::hash::{BuildHasher, Hasher, RandomState};

use glam::Vec3;

/// A slot that no position is in.
const EMPTY: u64 = 0;

/// The bits of a slot that are of the position's hash; the others are one more than its number.
const TAG: u64 = 0xffff_ffff_0000_0000;

/// How many positions are looked up together.
const TOGETHER: usize = 64;

/// Positions, numbered in the order of first use: those of equal coordinates have one number.
#[derive(Debug)]
pub(crate) struct Weld {
    positions: Vec<Vec3>,
    /// Open addressing; a power of two, at least four for every three positions.
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

    /// Where a position is to be sought: both halves are spread by themselves.
    #[inline]
    pub(super) fn of(self, p: Vec3) -> u64 {
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
        Self { positions: Vec::with_capacity(count), slots: vec![EMPTY; slots_for(count)], hash }
    }

    /// The number of a position, none of whose coordinates is NaN.
    #[inline]
    pub(crate) fn number(&mut self, p: Vec3) -> u32 {
        self.make_room(1);
        self.find(p, self.hash.of(p))
    }

    /// The numbers of many positions, one after the other, in place of what is in `numbers`.
    ///
    /// The slots of some are read before any is used, and so are the positions that these refer to: memory
    /// is waited for once, and not for each.
    pub(crate) fn number_all(&mut self, all: &[Vec3], numbers: &mut Vec<u32>) {
        self.make_room(all.len());
        numbers.clear();
        numbers.reserve(all.len());
        let mask = self.slots.len() - 1;
        for some in all.chunks(TOGETHER) {
            let mut hashes = [0; TOGETHER];
            for (hash, p) in hashes.iter_mut().zip(some) {
                *hash = self.hash.of(*p);
            }
            let mut slots = [EMPTY; TOGETHER];
            for (slot, hash) in slots.iter_mut().zip(&hashes[..some.len()]) {
                *slot = self.slots[*hash as usize & mask];
            }
            // Nothing is equal to NaN.
            let mut there = [Vec3::NAN; TOGETHER];
            for ((there, slot), hash) in there.iter_mut().zip(slots).zip(hashes) {
                if slot != EMPTY && (slot ^ hash) & TAG == 0 {
                    *there = self.positions[slot as u32 as usize - 1];
                }
            }
            for (i, p) in some.iter().enumerate() {
                let known = there[i] == *p;
                numbers.push(if known { slots[i] as u32 - 1 } else { self.find(*p, hashes[i]) });
            }
        }
    }

    /// The number of a position, for which there is room.
    #[inline]
    fn find(&mut self, p: Vec3, hash: u64) -> u32 {
        let mask = self.slots.len() - 1;
        let mut at = hash as usize & mask;
        loop {
            let slot = self.slots[at];
            if slot == EMPTY {
                let number = self.positions.len();
                self.slots[at] = hash & TAG | (number as u64 + 1);
                self.positions.push(p);
                return number as u32;
            }
            if (slot ^ hash) & TAG == 0 && self.positions[slot as u32 as usize - 1] == p {
                return slot as u32 - 1;
            }
            at = (at + 1) & mask;
        }
    }

    /// Makes room for so many positions more.
    #[inline]
    fn make_room(&mut self, more: usize) {
        if self.positions.len() + more > self.slots.len() / 4 * 3 {
            self.grow(more);
        }
    }

    #[cold]
    fn grow(&mut self, more: usize) {
        let mut slots = vec![EMPTY; slots_for(self.positions.len() + more)];
        let mask = slots.len() - 1;
        for (number, p) in self.positions.iter().enumerate() {
            let hash = self.hash.of(*p);
            let mut at = hash as usize & mask;
            while slots[at] != EMPTY {
                at = (at + 1) & mask;
            }
            slots[at] = hash & TAG | (number as u64 + 1);
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

/// How many slots so many positions need.
fn slots_for(count: usize) -> usize {
    (count / 3 * 4 + 4).next_power_of_two().max(64)
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

    #[test]
    fn many_at_once_have_the_numbers_that_they_have_one_by_one() {
        let place = |i: u32| {
            let i = i.wrapping_mul(2_654_435_761) >> 12 & 0xfff;
            Vec3::new(
                (i % 64) as f32 - 32.0,
                -((i / 64) as f32),
                if i.is_multiple_of(2) { 0.0 } else { -0.0 },
            )
        };
        let all: Vec<Vec3> = (0..20_000).map(place).collect();
        let mut single = Weld::with_room(0, Hash::new());
        let expected: Vec<u32> = all.iter().map(|p| single.number(*p)).collect();
        for size in [1, 63, 64, 5000, 20_000] {
            let mut weld = Weld::with_room(0, Hash::new());
            let (mut numbers, mut some) = (Vec::new(), Vec::new());
            for part in all.chunks(size) {
                weld.number_all(part, &mut some);
                numbers.extend_from_slice(&some);
            }
            assert_eq!(numbers, expected, "{size}");
            let bits = |p: &Vec3| p.to_array().map(f32::to_bits);
            assert!(weld.positions().iter().map(bits).eq(single.positions().iter().map(bits)));
        }
    }
}
