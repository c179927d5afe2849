//! The corners of a part of a file, put together where they lie at one place.

use glam::Vec3;

use super::Hash;

/// A slot that no position is in.
const EMPTY: u32 = 0;

/// A limited number of positions, numbered in the order of first use: those of equal coordinates have one
/// number. The slots are half as large as those of a [`Weld`](super::Weld), so that they stay in the cache.
#[derive(Debug)]
pub(crate) struct Few {
    positions: Vec<Vec3>,
    /// Open addressing; a power of two, at least twice as many as there are positions. The lower bits
    /// are one more than a position's number, the others of its hash.
    slots: Vec<u32>,
    /// The bits of a slot that are of the hash.
    tag: u32,
    hash: Hash,
}

impl Few {
    /// No positions, with room for so many; there will be `most` at most, which are 2³⁰ at most.
    pub(crate) fn with_room(count: usize, most: usize, hash: Hash) -> Self {
        let slots = vec![EMPTY; (2 * count).next_power_of_two().max(64)];
        let tag = !((most + 1).next_power_of_two() as u32 - 1);
        Self { positions: Vec::with_capacity(count), slots, tag, hash }
    }

    /// The number of a position, none of whose coordinates is NaN.
    #[inline]
    pub(crate) fn number(&mut self, p: Vec3) -> u32 {
        if 2 * self.positions.len() >= self.slots.len() {
            self.grow();
        }
        let hash = self.hash.of(p);
        let mask = self.slots.len() - 1;
        let mut at = (hash >> 32) as usize & mask;
        loop {
            let slot = self.slots[at];
            if slot == EMPTY {
                self.positions.push(p);
                let next = self.positions.len() as u32;
                self.slots[at] = hash as u32 & self.tag | next;
                return next - 1;
            }
            if (slot ^ hash as u32) & self.tag == 0 {
                let number = (slot & !self.tag) - 1;
                if self.positions[number as usize] == p {
                    return number;
                }
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
            let mut at = (hash >> 32) as usize & mask;
            while slots[at] != EMPTY {
                at = (at + 1) & mask;
            }
            slots[at] = hash as u32 & self.tag | (number as u32 + 1);
        }
        self.slots = slots;
    }

    /// Gives the positions for room for others, and begins anew.
    pub(crate) fn take(&mut self, room: Vec<Vec3>) -> Vec<Vec3> {
        self.slots.fill(EMPTY);
        let positions = std::mem::replace(&mut self.positions, room);
        self.positions.clear();
        positions
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_places_have_one_number_in_the_order_of_first_use() {
        let mut few = Few::with_room(0, 5000, Hash::new());
        let place = |i: u32| Vec3::new((i % 50) as f32, -((i / 50) as f32), 0.25);
        for _ in 0..2 {
            for i in (0..5000).chain((0..5000).rev()) {
                assert_eq!(few.number(place(i)), i);
            }
            assert_eq!(few.number(Vec3::new(-0.0, 0.0, 0.25)), 0);
            assert_eq!(few.take(Vec::new()), (0..5000).map(place).collect::<Vec<_>>());
        }
    }
}
