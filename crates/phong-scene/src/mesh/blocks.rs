//! Which corners of a polygon stand in the way of an ear: a tree over all of them, so that those
//! in a box are found without looking at the others, however the outline runs.

use glam::DVec2;

/// Corners that are looked at one by one.
const LEAF: usize = 8;

/// Corners, some of which block.
///
/// A balanced tree by x and y in turn: the middle of a range of `order` is a node, what lies
/// before and behind it are its branches.
#[derive(Debug)]
pub(super) struct Blocks {
    order: Vec<u32>,
    /// Where in `order` a corner stands.
    places: Vec<u32>,
    blocking: Vec<bool>,
    /// The range whose middle this is.
    ranges: Vec<Range>,
}

/// What is known of the corners of a range.
#[derive(Clone, Copy, Debug)]
struct Range {
    low: DVec2,
    high: DVec2,
    /// How many of them block.
    blocking: u32,
}

impl Blocks {
    /// None of these corners blocks yet.
    pub(super) fn new(points: &[DVec2]) -> Self {
        let mut order: Vec<u32> = (0..points.len() as u32).collect();
        let mut open = vec![(0, order.len(), 0)];
        let mut all = Vec::new();
        while let Some((start, end, axis)) = open.pop() {
            if start == end {
                continue;
            }
            all.push((start, end));
            if end - start <= LEAF {
                continue;
            }
            let middle = (end - start) / 2;
            let coordinate = |i: u32| points[i as usize][axis];
            order[start..end].select_nth_unstable_by(middle, |&a, &b| {
                coordinate(a).total_cmp(&coordinate(b)).then(a.cmp(&b))
            });
            let middle = start + middle;
            open.extend([(start, middle, 1 - axis), (middle + 1, end, 1 - axis)]);
        }
        let nothing = Range { low: DVec2::INFINITY, high: DVec2::NEG_INFINITY, blocking: 0 };
        let mut ranges = vec![nothing; order.len()];
        // Branches come behind the range that they are of.
        for &(start, end) in all.iter().rev() {
            let mut range = nothing;
            let mut include = |low: DVec2, high: DVec2| {
                range.low = range.low.min(low);
                range.high = range.high.max(high);
            };
            let middle = middle_of(start, end);
            if end - start <= LEAF {
                let corners = order[start..end].iter().map(|&i| points[i as usize]);
                corners.for_each(|p| include(p, p));
            } else {
                let p = points[order[middle] as usize];
                include(p, p);
                for at in [middle_of(start, middle), middle_of(middle + 1, end)] {
                    include(ranges[at].low, ranges[at].high);
                }
            }
            ranges[middle] = range;
        }
        let mut places = vec![0; order.len()];
        for (place, &corner) in order.iter().enumerate() {
            places[corner as usize] = place as u32;
        }
        Self { blocking: vec![false; order.len()], order, places, ranges }
    }

    /// Says whether a corner blocks.
    pub(super) fn set(&mut self, corner: u32, blocks: bool) {
        if self.blocking[corner as usize] == blocks {
            return;
        }
        self.blocking[corner as usize] = blocks;
        let place = self.places[corner as usize] as usize;
        let (mut start, mut end) = (0, self.order.len());
        loop {
            let middle = middle_of(start, end);
            let count = &mut self.ranges[middle].blocking;
            *count = if blocks { *count + 1 } else { *count - 1 };
            if end - start <= LEAF || place == middle {
                return;
            }
            (start, end) = if place < middle { (start, middle) } else { (middle + 1, end) };
        }
    }

    /// Whether one of the corners that block is as `wanted`. `may` says whether any point of a box,
    /// given by its ends, can be. `looked_at` grows by the corners and boxes that were looked at.
    pub(super) fn any(
        &self,
        points: &[DVec2],
        looked_at: &mut u64,
        may: impl Fn(DVec2, DVec2) -> bool,
        wanted: impl Fn(DVec2) -> bool,
    ) -> bool {
        let hit = |corner: u32| self.blocking[corner as usize] && wanted(points[corner as usize]);
        // Each step leaves one range more at most, and the ranges halve.
        let mut open = [(0_usize, 0_usize); 40];
        open[0] = (0, self.order.len());
        let mut count = 1;
        while count > 0 {
            count -= 1;
            let (start, end) = open[count];
            let middle = middle_of(start, end);
            *looked_at += 1;
            if start == end {
                continue;
            }
            let range = &self.ranges[middle];
            if range.blocking == 0 || !may(range.low, range.high) {
                continue;
            }
            if end - start <= LEAF {
                *looked_at += (end - start) as u64;
                if self.order[start..end].iter().any(|&corner| hit(corner)) {
                    return true;
                }
                continue;
            }
            if hit(self.order[middle]) {
                return true;
            }
            open[count] = (start, middle);
            open[count + 1] = (middle + 1, end);
            count += 2;
        }
        false
    }
}

fn middle_of(start: usize, end: usize) -> usize {
    start + (end - start) / 2
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_corner_is_found_in_a_box_exactly_if_it_blocks_and_lies_in_it() {
        let numbers = |i: u32| f64::from(i.wrapping_mul(2_654_435_761) >> 27);
        let points: Vec<_> = (0..500).map(|i| DVec2::new(numbers(i), numbers(i + 999))).collect();
        let mut blocks = Blocks::new(&points);
        let mut set = vec![false; points.len()];
        for step in 0..2000_u32 {
            let corner = step.wrapping_mul(40_503) % 500;
            let value = step % 3 > 0;
            set[corner as usize] = value;
            blocks.set(corner, value);
            let (a, b) = (points[(step * 7 % 500) as usize], points[(step * 13 % 500) as usize]);
            let (low, high) = (a.min(b), a.max(b));
            let inside = |p: DVec2| p.cmpge(low).all() && p.cmple(high).all();
            let odd = |p: DVec2| (p.x + p.y) % 2.0 != 0.0;
            let expected = points.iter().zip(&set).any(|(p, set)| *set && inside(*p) && odd(*p));
            let may = |l: DVec2, h: DVec2| l.cmple(high).all() && h.cmpge(low).all();
            let found = blocks.any(&points, &mut 0, may, |p| inside(p) && odd(p));
            assert_eq!(found, expected, "{step}");
        }
    }
}
