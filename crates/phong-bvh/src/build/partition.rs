//! Bringing the boxes left of a cut to the front.

use fearless_simd::{Simd, f32x8, prelude::*};
use rayon::prelude::*;

use super::{
    boxes::{Boxed, EMPTY},
    sah::{Cut, Run, center_bounds, union},
};
use crate::level::{Kernel, Token};

/// Boxes that are partitioned by one thread at a time.
const CHUNK: usize = 1 << 14;

/// Brings the boxes left of `cut` to the front; both sides.
#[inline(always)]
pub(super) fn partition<S: Simd>(simd: S, boxes: &mut [Boxed], cut: &Cut) -> [Run; 2] {
    let axis = cut.axis & 3;
    let first = f32x8::splat(simd, cut.first);
    let scale = f32x8::splat(simd, cut.scale);
    let bin = f32x8::splat(simd, cut.bin);
    let empty = f32x8::load_array(simd, EMPTY);
    let (mut left, mut right) = (empty, empty);
    let mut front = 0;
    // Before each step, boxes up to `front` are left of the cut and those from there on are not.
    // The next box changes places with the first of these, and is counted in if it is left of it:
    // there is no branch to be predicted, since half of those would be wrong.
    for i in 0..boxes.len() {
        let b = &boxes[i];
        let lanes = b.lanes(simd);
        let center = f32x8::splat(simd, b.0[4 + axis]) - f32x8::splat(simd, b.0[axis]);
        let goes_left = ((center - first) * scale).simd_lt(bin);
        let centers = center_bounds(lanes);
        left = left.max(goes_left.select(centers, empty));
        right = right.max(goes_left.select(empty, centers));
        boxes[front].lanes(simd).store_array(&mut boxes[i].0);
        lanes.store_array(&mut boxes[front].0);
        front += goes_left.to_bitmask() as usize & 1;
    }
    [
        Run { len: front, bounds: cut.bounds[0], centers: left.to_array() },
        Run { len: boxes.len() - front, bounds: cut.bounds[1], centers: right.to_array() },
    ]
}

/// [`partition`] by all threads: each chunk by itself, then what lies on the wrong side of the
/// middle changes places.
pub(super) fn partition_by_all(token: Token, boxes: &mut [Boxed], cut: &Cut) -> [Run; 2] {
    let chunks: Vec<[Run; 2]> =
        boxes.par_chunks_mut(CHUNK).map(|boxes| token.run(Partition { boxes, cut })).collect();
    let mut runs = cut.bounds.map(|bounds| Run { bounds, ..Run::NONE });
    for chunk in &chunks {
        for (run, part) in runs.iter_mut().zip(chunk) {
            run.centers = union(&run.centers, &part.centers);
            run.len += part.len;
        }
    }
    exchange(boxes, &chunks, runs[0].len);
    runs
}

/// Exchanges what is of the right side before `middle` and what is of the left side after it.
fn exchange(boxes: &mut [Boxed], chunks: &[[Run; 2]], middle: usize) {
    let (front, back) = boxes.split_at_mut(middle);
    let (mut wrong_left, mut wrong_right) = (Vec::new(), Vec::new());
    let mut at = 0;
    for [left, right] in chunks {
        let (cut, end) = (at + left.len, at + left.len + right.len);
        // Boxes of the right side, from `cut` on, before the middle.
        if cut < end.min(middle) {
            wrong_left.push(cut..end.min(middle));
        }
        // Boxes of the left side, from `at` on, after the middle.
        if at.max(middle) < cut {
            wrong_right.push(at.max(middle) - middle..cut - middle);
        }
        at = end;
    }
    // No piece is empty, so that the shorter of two is 0 only where all are done.
    let mut lefts = pieces(front, &wrong_left).into_iter();
    let mut rights = pieces(back, &wrong_right).into_iter();
    let mut pairs = Vec::new();
    let (mut left, mut right): (&mut [Boxed], &mut [Boxed]) = (&mut [], &mut []);
    loop {
        if left.is_empty() {
            left = lefts.next().unwrap_or_default();
        }
        if right.is_empty() {
            right = rights.next().unwrap_or_default();
        }
        let len = left.len().min(right.len());
        if len == 0 {
            break;
        }
        let (a, rest) = std::mem::take(&mut left).split_at_mut(len);
        left = rest;
        let (b, rest) = std::mem::take(&mut right).split_at_mut(len);
        right = rest;
        pairs.push((a, b));
    }
    pairs.into_par_iter().for_each(|(a, b)| a.swap_with_slice(b));
}

/// The pieces of `boxes` at ascending `ranges`.
fn pieces<'a>(boxes: &'a mut [Boxed], ranges: &[std::ops::Range<usize>]) -> Vec<&'a mut [Boxed]> {
    let mut rest = boxes;
    let mut done = 0;
    let mut found = Vec::with_capacity(ranges.len());
    for range in ranges {
        let (_, from) = rest.split_at_mut(range.start - done);
        let (piece, behind) = from.split_at_mut(range.len());
        found.push(piece);
        rest = behind;
        done = range.end;
    }
    found
}

/// [`partition`] at a level.
struct Partition<'a> {
    boxes: &'a mut [Boxed],
    cut: &'a Cut,
}

impl Kernel for Partition<'_> {
    type Output = [Run; 2];

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> [Run; 2] {
        partition(simd, self.boxes, self.cut)
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::{Aabb, Level};

    #[test]
    fn many_chunks_by_all_threads_are_parted_as_one_by_one_thread() {
        let token = Token::of(Level::Scalar).unwrap();
        // In no order, and in runs, as meshes mostly are: then whole chunks are on one side.
        let mixed = |i: usize| i * 37 % 100;
        let runs = |i: usize| (i / CHUNK * 37 + i % 7) % 100;
        let orders: [&dyn Fn(usize) -> usize; 2] = [&mixed, &runs];
        let sizes = [(1, 2), (5 * CHUNK + 7, 9), (3 * CHUNK, 1), (9 * CHUNK, 4)];
        for (order, (count, cuts)) in
            orders.iter().flat_map(|order| sizes.map(|size| (order, size)))
        {
            let boxed = |i: usize| {
                let lo = Vec3::new(order(i) as f32, i as f32, 0.0);
                Boxed::boxed(Aabb { lo, hi: lo }, i, 0)
            };
            let boxes: Vec<Boxed> = (0..count).map(boxed).collect();
            for at in 0..=cuts {
                let bin = 100.0 * at as f32 / cuts as f32;
                let bounds = [EMPTY; 2];
                let cut = Cut { axis: 0, first: 0.0, scale: 0.5, bin, bounds };
                let (mut one, mut all) = (boxes.clone(), boxes.clone());
                let by_one = token.run(Partition { boxes: &mut one, cut: &cut });
                let by_all = partition_by_all(token, &mut all, &cut);
                let middle = by_one[0].len;
                assert_eq!(middle, boxes.iter().filter(|b| b.0[4] - b.0[0] < 2.0 * bin).count());
                for (one, all) in by_one.iter().zip(&by_all) {
                    assert_eq!((one.len, one.centers), (all.len, all.centers), "{at} of {cuts}");
                }
                for side in [0..middle, middle..count] {
                    let sorted = |boxes: &[Boxed]| {
                        let mut numbers: Vec<usize> = boxes.iter().map(Boxed::local).collect();
                        numbers.sort_unstable();
                        numbers
                    };
                    assert_eq!(sorted(&one[side.clone()]), sorted(&all[side]), "{at} of {cuts}");
                }
            }
        }
    }
}
