//! Where to cut a set of boxes in two: the surface area heuristic over bins.
//!
//! A ray that meets the parent meets a child with a probability of the ratio of their surfaces, so a
//! cut costs `A_left ⌈n_left / 8⌉ + A_right ⌈n_right / 8⌉`: blocks of eight are tested whole.
//! Centres are sorted into bins along each axis and a cut is tried between any two bins (Wald, *On
//! fast Construction of SAH-based Bounding Volume Hierarchies*, 2007).

use fearless_simd::{Simd, f32x4, f32x8, i32x4, prelude::*};

use super::boxes::{Boxed, EMPTY, half_area};

/// A run of boxes: its place in the list, its bounds and the bounds of its doubled centres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Run {
    /// How many.
    pub(super) len: usize,
    /// Their bounds as `[−lo, _, hi, _]`.
    pub(super) bounds: [f32; 8],
    /// Bounds of `lo + hi` as `[−lo, _, hi, _]`.
    pub(super) centers: [f32; 8],
}

/// Doubled centre twice over, once negated: what a maximum needs to bound centres.
#[inline(always)]
fn center<S: Simd>(lanes: f32x8<S>) -> (f32x4<S>, f32x8<S>) {
    let (minus_lo, hi) = lanes.split();
    let center: f32x4<S> = hi - minus_lo;
    (center, (minus_lo - hi).combine(center))
}

impl Run {
    /// The bounds of `boxes`.
    #[inline(always)]
    pub(super) fn of<S: Simd>(simd: S, boxes: &[Boxed]) -> Self {
        let mut bounds = f32x8::load_array(simd, EMPTY);
        let mut centers = bounds;
        for b in boxes {
            let lanes = b.lanes(simd);
            bounds = bounds.max(lanes);
            centers = centers.max(center(lanes).1);
        }
        Self { len: boxes.len(), bounds: bounds.to_array(), centers: centers.to_array() }
    }

    /// The bounds of two runs.
    pub(super) fn union(&self, other: &Self) -> Self {
        let max = |a: &[f32; 8], b: &[f32; 8]| std::array::from_fn(|i| a[i].max(b[i]));
        Self {
            len: self.len + other.len,
            bounds: max(&self.bounds, &other.bounds),
            centers: max(&self.centers, &other.centers),
        }
    }

    /// Half its surface.
    pub(super) fn half_area(&self) -> f32 {
        half_area(&self.bounds)
    }
}

const MOST: usize = 32;

/// The bins along the three axes.
#[derive(Clone, Debug)]
pub(super) struct Bins {
    bounds: [[[f32; 8]; MOST]; 3],
    counts: [[u32; MOST]; 3],
    grid: Grid,
}

/// How centres fall into bins.
#[derive(Clone, Copy, Debug)]
struct Grid {
    bins: usize,
    first: [f32; 4],
    scale: [f32; 4],
}

impl Grid {
    fn new(run: &Run, most: usize) -> Self {
        let bins = (4 + run.len / 16).min(most);
        let lo: [f32; 4] = std::array::from_fn(|i| if i < 3 { -run.centers[i] } else { 0.0 });
        let scale = std::array::from_fn(|i| {
            let extent = if i < 3 { run.centers[4 + i] - lo[i] } else { 0.0 };
            let scale = bins as f32 * 0.999_99 / extent;
            if extent > 0.0 && scale.is_finite() { scale } else { 0.0 }
        });
        Self { bins, first: lo, scale }
    }

    #[inline(always)]
    fn bin<S: Simd>(&self, simd: S, lanes: f32x8<S>) -> [i32; 4] {
        let first = f32x4::load_array(simd, self.first);
        let scale = f32x4::load_array(simd, self.scale);
        let bin: i32x4<S> = ((center(lanes).0 - first) * scale).to_int();
        let last = i32x4::splat(simd, self.bins as i32 - 1);
        bin.max(i32x4::splat(simd, 0)).min(last).to_array()
    }
}

/// A cut: boxes in bins before `bin` along `axis` go left.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cut {
    axis: usize,
    bin: usize,
}

impl Bins {
    /// No bins yet.
    pub(super) const fn new() -> Self {
        let grid = Grid { bins: 0, first: [0.0; 4], scale: [0.0; 4] };
        Self { bounds: [[EMPTY; MOST]; 3], counts: [[0; MOST]; 3], grid }
    }

    /// Sorts `boxes` into bins.
    #[inline(always)]
    pub(super) fn sort<S: Simd>(&mut self, simd: S, boxes: &[Boxed], run: &Run, most: usize) {
        let grid = Grid::new(run, most.min(MOST));
        self.grid = grid;
        for axis in 0..3 {
            self.bounds[axis][..grid.bins].fill(EMPTY);
            self.counts[axis][..grid.bins].fill(0);
        }
        for b in boxes {
            let lanes = b.lanes(simd);
            let axes = self.bounds.iter_mut().zip(&mut self.counts);
            for (index, (bounds, counts)) in grid.bin(simd, lanes).into_iter().zip(axes) {
                let bin = index as usize & (MOST - 1);
                f32x8::load_array_ref(simd, &bounds[bin]).max(lanes).store_array(&mut bounds[bin]);
                counts[bin] += 1;
            }
        }
    }

    /// Both together; they must have been sorted by the same run.
    pub(super) fn merge(mut self, other: &Self) -> Self {
        for axis in 0..3 {
            for bin in 0..self.grid.bins {
                let (a, b) = (&mut self.bounds[axis][bin], &other.bounds[axis][bin]);
                for (a, b) in a.iter_mut().zip(b) {
                    *a = a.max(*b);
                }
                self.counts[axis][bin] += other.counts[axis][bin];
            }
        }
        self
    }

    /// The cheapest cut, or none where all centres are one.
    #[inline(always)]
    pub(super) fn cheapest<S: Simd>(&self, simd: S) -> Option<Cut> {
        let bins = self.grid.bins;
        let mut best = (f32::INFINITY, None);
        for axis in 0..3 {
            if self.grid.scale[axis] == 0.0 {
                continue;
            }
            let (bounds, counts) = (&self.bounds[axis], &self.counts[axis]);
            let mut right = [0.0; MOST];
            let (mut hull, mut count) = (f32x8::load_array(simd, EMPTY), 0);
            for bin in (1..bins).rev() {
                hull = hull.max(f32x8::load_array_ref(simd, &bounds[bin]));
                count += counts[bin];
                right[bin] = cost(hull, count);
            }
            let total = count + counts[0];
            let (mut hull, mut count) = (f32x8::load_array(simd, EMPTY), 0);
            for bin in 1..bins {
                hull = hull.max(f32x8::load_array_ref(simd, &bounds[bin - 1]));
                count += counts[bin - 1];
                let both = cost(hull, count) + right[bin];
                if both < best.0 && count > 0 && count < total {
                    best = (both, Some(Cut { axis, bin }));
                }
            }
        }
        best.1
    }

    /// Brings the boxes left of `cut` to the front; the bounds of both sides.
    #[inline(always)]
    pub(super) fn apply<S: Simd>(&self, simd: S, boxes: &mut [Boxed], cut: Cut) -> [Run; 2] {
        let empty = f32x8::load_array(simd, EMPTY);
        let (mut left, mut right) = ([empty; 2], [empty; 2]);
        let (mut front, mut back) = (0, boxes.len());
        // Each pass looks at one box: it stays at the front, or changes places with the last one
        // not yet looked at.
        while front < back {
            let lanes = boxes[front].lanes(simd);
            let goes_left = (self.grid.bin(simd, lanes)[cut.axis] as usize) < cut.bin;
            let centers = center(lanes).1;
            if goes_left {
                left = [left[0].max(lanes), left[1].max(centers)];
                front += 1;
            } else {
                right = [right[0].max(lanes), right[1].max(centers)];
                back -= 1;
                boxes.swap(front, back);
            }
        }
        let run = |[bounds, centers]: [f32x8<S>; 2], len| Run {
            len,
            bounds: bounds.to_array(),
            centers: centers.to_array(),
        };
        [run(left, front), run(right, boxes.len() - front)]
    }
}

#[inline(always)]
fn cost<S: Simd>(hull: f32x8<S>, count: u32) -> f32 {
    half_area(&hull.to_array()) * count.div_ceil(8) as f32
}
