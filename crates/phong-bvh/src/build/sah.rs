//! Where to cut a run of boxes in two: the surface area heuristic over bins.
//!
//! A ray that meets the parent meets a child with a probability of the ratio of their surfaces, so a
//! cut costs `A_left ⌈n_left / 8⌉ + A_right ⌈n_right / 8⌉`: blocks of eight are tested whole.
//! Centres are sorted into bins along each axis and a cut is tried between any two bins (Wald, *On
//! fast Construction of SAH-based Bounding Volume Hierarchies*, 2007).

use fearless_simd::{Simd, f32x4, f32x8, i32x4, prelude::*};

use super::boxes::{Boxed, EMPTY};

/// A run of boxes: how many, their bounds and the bounds of their doubled centres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Run {
    /// How many.
    pub(super) len: usize,
    /// Their bounds as `[−lo, _, hi, _]`.
    pub(super) bounds: [f32; 8],
    /// Bounds of `lo + hi` as `[−lo, _, hi, _]`.
    pub(super) centers: [f32; 8],
}

/// A box's doubled centre.
#[inline(always)]
pub(super) fn center<S: Simd>(lanes: f32x8<S>) -> f32x4<S> {
    let (minus_lo, hi) = lanes.split();
    hi - minus_lo
}

/// A box's doubled centre twice over, once negated: what a maximum needs to bound centres.
#[inline(always)]
pub(super) fn center_bounds<S: Simd>(lanes: f32x8<S>) -> f32x8<S> {
    let (minus_lo, hi) = lanes.split();
    (minus_lo - hi).combine(hi - minus_lo)
}

impl Run {
    /// No boxes.
    pub(super) const NONE: Self = Self { len: 0, bounds: EMPTY, centers: EMPTY };

    /// The bounds of `boxes`.
    #[inline(always)]
    pub(super) fn of<S: Simd>(simd: S, boxes: &[Boxed]) -> Self {
        let mut bounds = f32x8::load_array(simd, EMPTY);
        let mut centers = bounds;
        for b in boxes {
            let lanes = b.lanes(simd);
            bounds = bounds.max(lanes);
            centers = centers.max(center_bounds(lanes));
        }
        Self { len: boxes.len(), bounds: bounds.to_array(), centers: centers.to_array() }
    }

    /// Both runs as one.
    pub(super) fn union(&self, other: &Self) -> Self {
        Self {
            len: self.len + other.len,
            bounds: union(&self.bounds, &other.bounds),
            centers: union(&self.centers, &other.centers),
        }
    }

    /// The axis on which centres lie farthest apart.
    #[inline(always)]
    fn widest(&self) -> usize {
        let extent = |axis: usize| self.centers[axis] + self.centers[4 + axis];
        let axis = usize::from(extent(1) > extent(0));
        if extent(2) > extent(axis) { 2 } else { axis }
    }
}

/// The bounds of two boxes given as `[−lo, _, hi, _]`.
pub(super) fn union(a: &[f32; 8], b: &[f32; 8]) -> [f32; 8] {
    std::array::from_fn(|lane| a[lane].max(b[lane]))
}

/// Which cuts are tried.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cuts {
    /// The most bins along an axis, at most 32.
    pub(super) bins: usize,
    /// Along one axis alone, that on which centres lie farthest apart, instead of all three.
    pub(super) widest: bool,
}

/// The most bins along an axis.
const MOST: usize = 32;

/// The bins along the three axes.
#[derive(Clone, Debug)]
pub(super) struct Bins {
    bounds: [[[f32; 8]; 3]; MOST],
    /// How many boxes are in the bins of the three axes, and nothing.
    counts: [[i32; 4]; MOST],
    grid: Grid,
}

/// How centres fall into bins.
#[derive(Clone, Copy, Debug)]
struct Grid {
    bins: usize,
    first: [f32; 4],
    /// Bins a unit of doubled centre; 0 where all centres are one.
    scale: [f32; 4],
}

impl Grid {
    #[inline(always)]
    fn new(run: &Run, most: usize) -> Self {
        let bins = (4 + run.len / 16).min(most);
        let (mut first, mut scale) = ([0.0; 4], [0.0; 4]);
        for axis in 0..3 {
            first[axis] = -run.centers[axis];
            let extent = run.centers[4 + axis] - first[axis];
            let bins = bins as f32 * 0.999_99 / extent;
            scale[axis] = if extent > 0.0 && bins.is_finite() { bins } else { 0.0 };
        }
        Self { bins, first, scale }
    }
}

/// A cut: boxes whose centre is in a bin before `bin` along `axis` go left.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cut {
    /// The axis, 0 to 2.
    pub(super) axis: usize,
    /// The first doubled centre of the bins along the axis.
    pub(super) first: f32,
    /// Bins a unit of doubled centre.
    pub(super) scale: f32,
    /// The first bin on the right.
    pub(super) bin: f32,
    /// The bounds on both sides.
    pub(super) bounds: [[f32; 8]; 2],
}

impl Bins {
    /// No bins yet.
    pub(super) const fn new() -> Self {
        let grid = Grid { bins: 0, first: [0.0; 4], scale: [0.0; 4] };
        Self { bounds: [[EMPTY; 3]; MOST], counts: [[0; 4]; MOST], grid }
    }

    /// Sorts `boxes` of `run` into bins between which `cuts` are tried.
    #[inline(always)]
    pub(super) fn sort<S: Simd>(&mut self, simd: S, boxes: &[Boxed], run: &Run, cuts: Cuts) {
        let grid = Grid::new(run, cuts.bins.min(MOST));
        self.grid = grid;
        self.bounds[..grid.bins].fill([EMPTY; 3]);
        self.counts[..grid.bins].fill([0; 4]);
        if cuts.widest {
            // The bins of other axes stay empty, and nothing is not cut.
            let axis = run.widest();
            let (first, scale) = (grid.first[axis], grid.scale[axis]);
            for b in boxes {
                let bin = (b.0[4 + axis] - b.0[axis] - first) * scale;
                self.put(simd, b.lanes(simd), axis, bin as i32);
            }
            return;
        }
        let first = f32x4::load_array(simd, grid.first);
        let scale = f32x4::load_array(simd, grid.scale);
        for b in boxes {
            let lanes = b.lanes(simd);
            // Below `bins` by the choice of the scale. Where it is 0 there is one bin, or centres
            // beyond all numbers, which become some number the mask makes a bin.
            let bins: i32x4<S> = ((center(lanes) - first) * scale).to_int();
            let [x, y, z, _] = bins.to_array();
            self.put(simd, lanes, 0, x);
            self.put(simd, lanes, 1, y);
            self.put(simd, lanes, 2, z);
        }
    }

    /// Puts a box into a bin of an axis.
    #[inline(always)]
    fn put<S: Simd>(&mut self, simd: S, lanes: f32x8<S>, axis: usize, bin: i32) {
        let bin = bin as usize & (MOST - 1);
        let slot = &mut self.bounds[bin][axis];
        f32x8::load_array_ref(simd, slot).max(lanes).store_array(slot);
        self.counts[bin][axis] += 1;
    }

    /// Both together; they must have been sorted by the same run.
    pub(super) fn merge(mut self, other: &Self) -> Self {
        for bin in 0..self.grid.bins {
            for axis in 0..3 {
                let (a, b) = (&mut self.bounds[bin][axis], &other.bounds[bin][axis]);
                *a = union(a, b);
                self.counts[bin][axis] += other.counts[bin][axis];
            }
        }
        self
    }

    /// The cheapest cut, or none where all centres are one.
    #[inline(always)]
    pub(super) fn cheapest<S: Simd>(&self, simd: S) -> Option<Cut> {
        let bins = self.grid.bins;
        let mut right = [[0.0; 4]; MOST];
        let mut side = Side::new(simd);
        for bin in (1..bins).rev() {
            side.add(simd, &self.bounds[bin], &self.counts[bin]);
            side.cost(simd).store_array(&mut right[bin]);
        }
        let mut side = Side::new(simd);
        let mut best = f32x4::splat(simd, f32::INFINITY);
        let mut place = f32x4::splat(simd, 0.0);
        for (bin, right) in right.iter().enumerate().take(bins).skip(1) {
            side.add(simd, &self.bounds[bin - 1], &self.counts[bin - 1]);
            // NaN where one side is empty: never less.
            let both = side.cost(simd) + f32x4::load_array_ref(simd, right);
            let better = both.simd_lt(best);
            best = better.select(both, best);
            place = better.select(f32x4::splat(simd, bin as f32), place);
        }
        let (best, place) = (best.to_array(), place.to_array());
        let mut axis = 0;
        for other in 1..3 {
            if best[other] < best[axis] {
                axis = other;
            }
        }
        if best[axis] == f32::INFINITY {
            return None;
        }
        let mut bounds = [f32x8::load_array(simd, EMPTY); 2];
        for bin in 0..bins {
            let side = usize::from(bin >= place[axis] as usize);
            bounds[side] = bounds[side].max(f32x8::load_array_ref(simd, &self.bounds[bin][axis]));
        }
        Some(Cut {
            axis,
            first: self.grid.first[axis],
            scale: self.grid.scale[axis],
            bin: place[axis],
            bounds: [bounds[0].to_array(), bounds[1].to_array()],
        })
    }
}

/// What lies on one side of a cut along each of the three axes.
struct Side<S: Simd> {
    hulls: [f32x8<S>; 3],
    counts: i32x4<S>,
}

impl<S: Simd> Side<S> {
    #[inline(always)]
    fn new(simd: S) -> Self {
        Self { hulls: [f32x8::load_array(simd, EMPTY); 3], counts: i32x4::splat(simd, 0) }
    }

    #[inline(always)]
    fn add(&mut self, simd: S, bounds: &[[f32; 8]; 3], counts: &[i32; 4]) {
        for (hull, bounds) in self.hulls.iter_mut().zip(bounds) {
            *hull = hull.max(f32x8::load_array_ref(simd, bounds));
        }
        self.counts += i32x4::load_array_ref(simd, counts);
    }

    /// Half the surface times the number of blocks, for each axis. Infinite boxes times no block,
    /// NaN, where nothing is on this side.
    #[inline(always)]
    fn cost(&self, simd: S) -> f32x4<S> {
        let size = |hull: f32x8<S>| {
            let (minus_lo, hi) = hull.split();
            minus_lo + hi
        };
        let (a, b, c) = (size(self.hulls[0]), size(self.hulls[1]), size(self.hulls[2]));
        // Sizes of three boxes by axis.
        let (ac, b0) = (a.zip_low(c), b.zip_low(b));
        let (x, y) = (ac.zip_low(b0), ac.zip_high(b0));
        let z = a.zip_high(c).zip_low(b.zip_high(b));
        let blocks: f32x4<S> = ((self.counts + i32x4::splat(simd, 7)) >> 3).to_float();
        (x * y + y * z + z * x) * blocks
    }
}

#[cfg(test)]
mod tests {
    use fearless_simd::Fallback;
    use glam::Vec3;

    use super::*;
    use crate::Aabb;

    const ALL: Cuts = Cuts { bins: 16, widest: false };

    fn cheapest(boxes: &[Boxed], cuts: Cuts) -> Option<Cut> {
        let simd = Fallback::new();
        let mut bins = Bins::new();
        bins.sort(simd, boxes, &Run::of(simd, boxes), cuts);
        bins.cheapest(simd)
    }

    fn boxed(lo: Vec3, size: f32) -> Boxed {
        Boxed::boxed(Aabb { lo, hi: lo + size }, 0, 0)
    }

    #[test]
    fn two_heaps_are_cut_apart_and_each_side_has_its_bounds() {
        let heap = |z: f32| (0..20).map(move |i| boxed(Vec3::new(i as f32 * 0.1, 0.0, z), 1.0));
        let boxes: Vec<Boxed> = heap(0.0).chain(heap(50.0)).collect();
        let simd = Fallback::new();
        let [low, high] = [&boxes[..20], &boxes[20..]].map(|heap| Run::of(simd, heap).bounds);
        for widest in [false, true] {
            let cut = cheapest(&boxes, Cuts { widest, ..ALL }).unwrap();
            assert_eq!(cut.axis, 2);
            for axis in [0, 1, 2, 4, 5, 6] {
                assert_eq!([cut.bounds[0][axis], cut.bounds[1][axis]], [low[axis], high[axis]]);
            }
        }
    }

    #[test]
    fn there_is_no_cut_where_all_centres_are_one() {
        let boxes: Vec<Boxed> =
            (0..40).map(|i| boxed(Vec3::splat(-0.5 * i as f32), i as f32)).collect();
        assert!(cheapest(&boxes, ALL).is_none());
        assert!(cheapest(&boxes, Cuts { widest: true, ..ALL }).is_none());
    }

    #[test]
    fn merged_bins_are_those_of_all_boxes() {
        let simd = Fallback::new();
        let place = |i: usize| Vec3::new((i * 7 % 31) as f32, (i * 5 % 17) as f32, i as f32 * 0.1);
        let boxes: Vec<Boxed> = (0..300).map(|i| boxed(place(i), 1.0 + (i % 3) as f32)).collect();
        let run = Run::of(simd, &boxes);
        let of = |boxes: &[Boxed]| {
            let mut bins = Bins::new();
            bins.sort(simd, boxes, &run, ALL);
            bins
        };
        let (all, merged) = (of(&boxes), of(&boxes[..100]).merge(&of(&boxes[100..])));
        assert_eq!(all.counts, merged.counts);
        let [a, b] = [all, merged].map(|bins| bins.cheapest(simd).unwrap());
        assert_eq!((a.axis, a.bin), (b.axis, b.bin));
    }
}
