//! From boxes to a binary tree, whose branches are then gathered into nodes of eight.

use std::ops::Range;

use fearless_simd::Simd;
use rayon::prelude::*;

use super::{
    Settings, WIDTH,
    boxes::{Boxed, half_area},
    branch::{Branch, Shape},
    emit::{Size, measure},
    gather::{CLOSED, Costs, Split, gather},
    partition::{partition, partition_by_all},
    sah::{Bins, Cut, Cuts, Run},
};
use crate::{
    Primitives,
    level::{Kernel, Token},
    node8::{Kind, Ref},
};

/// Boxes of a run that one thread makes a subtree of.
const TASK: usize = 1 << 14;
/// Cuts from the root after which runs are halved, so that no arrangement makes a tree deep.
const DEEP: u32 = 64;

/// A subtree as branches: children before their parents, the root last.
#[derive(Debug, Default)]
pub(super) struct Subtree {
    pub(super) branches: Vec<Branch>,
    /// Its boxes, among all.
    pub(super) boxes: Range<usize>,
    /// How large it is once written, without the subtrees it refers to.
    pub(super) size: Size,
}

impl Subtree {
    /// Where its root is, if it is written from row `at` on.
    pub(super) fn root(&self, indexed: bool, at: usize) -> Ref {
        match self.branches.last().map(|root| root.shape) {
            Some(Shape::Leaf { kind: Kind::Triangles, .. }) if indexed => {
                Ref::leaf(Kind::Indexed, at)
            }
            Some(Shape::Leaf { kind, .. }) => Ref::leaf(kind, at),
            _ => Ref::node(at),
        }
    }
}

/// What every step needs.
#[derive(Clone, Copy)]
pub(super) struct Grower<'a> {
    pub(super) geometry: &'a [Primitives],
    pub(super) settings: Settings,
    /// The kind of all primitives, if it is one.
    pub(super) only: Option<Kind>,
    pub(super) token: Token,
}

/// A binary tree of subtrees.
enum Top {
    Subtree(Subtree, [f32; 8]),
    Pair(Box<[Top; 2]>, [f32; 8]),
}

impl Grower<'_> {
    /// The subtrees over all boxes in their order, and the tree over those.
    pub(super) fn grow(&self, boxes: &mut [Boxed]) -> (Subtree, Vec<Subtree>) {
        let runs = boxes.par_chunks(TASK).map(|boxes| self.token.run(Bound { boxes }));
        let run = runs.reduce(|| Run::NONE, |a, b| a.union(&b));
        let top = self.top(boxes, 0, &run, 0);
        let (mut over, subtrees) = self.token.run(Flatten { top });
        over.size = measure(&over.branches, self.settings.indexed, over.branches.len() as u32 - 1);
        (over, subtrees)
    }

    /// Cuts large runs, by all threads together; `first` is the number of the first box.
    fn top(&self, boxes: &mut [Boxed], first: usize, run: &Run, depth: u32) -> Top {
        if boxes.len() <= TASK {
            let range = first..first + boxes.len();
            let branches = self.token.run(Grow { grower: self, boxes, run, depth });
            // Now, while they are in the cache.
            let size = measure(&branches, self.settings.indexed, branches.len() as u32 - 1);
            return Top::Subtree(Subtree { branches, boxes: range, size }, run.bounds);
        }
        let bins = boxes
            .par_chunks(TASK)
            .map(|boxes| self.token.run(Bin { boxes, run, cuts: self.settings.cuts }))
            .reduce_with(|a, b| a.merge(&b));
        let cut = bins.filter(|_| depth < DEEP).and_then(|bins| self.token.run(Cheapest { bins }));
        let [left, right] = match cut {
            Some(cut) => partition_by_all(self.token, boxes, &cut),
            None => self.token.run(Halve { boxes }),
        };
        let (front, back) = boxes.split_at_mut(left.len);
        let (left, right) = rayon::join(
            || self.top(front, first, &left, depth + 1),
            || self.top(back, first + left.len, &right, depth + 1),
        );
        Top::Pair(Box::new([left, right]), run.bounds)
    }
}

/// The halves of boxes whose centres are one, or nearly: at a multiple of the width, so that leaves are
/// full.
#[inline(always)]
fn halves<S: Simd>(simd: S, boxes: &[Boxed]) -> [Run; 2] {
    let half = (boxes.len() / 2).next_multiple_of(WIDTH).min(boxes.len() - 1);
    let (front, back) = boxes.split_at(half);
    [Run::of(simd, front), Run::of(simd, back)]
}

/// Grows one subtree.
struct Sapling<'a> {
    grower: &'a Grower<'a>,
    branches: Vec<Branch>,
    /// The bins of the run being cut; clearing new ones for each cut would cost more than filling them.
    bins: Box<Bins>,
}

impl Sapling<'_> {
    /// Cuts the boxes of `range` down to leaves. The last branch is then theirs; what forests under it
    /// cost.
    fn grow<S: Simd>(
        &mut self,
        simd: S,
        boxes: &mut [Boxed],
        range: Range<usize>,
        run: &Run,
        depth: u32,
    ) -> Costs {
        simd.vectorize(
            #[inline(always)]
            || {
                let mine = &mut boxes[range.clone()];
                if let Some(kind) = self.leaf_kind(mine) {
                    let shape =
                        Shape::Leaf { kind, len: mine.len() as u8, first: range.start as u32 };
                    self.branches.push(Branch::new(&run.bounds, shape, [0; 8]));
                    return CLOSED;
                }
                let [left, right] = self.cut(simd, mine, run, depth);
                let middle = range.start + left.len;
                let left_costs = self.grow(simd, boxes, range.start..middle, &left, depth + 1);
                let shape = Shape::Pair { left: self.branches.len() as u32 - 1 };
                let right_costs = self.grow(simd, boxes, middle..range.end, &right, depth + 1);
                let (costs, split) =
                    gather(simd, half_area(&run.bounds), &left_costs, &right_costs);
                self.branches.push(Branch::new(&run.bounds, shape, split));
                costs
            },
        )
    }

    #[inline(always)]
    fn cut<S: Simd>(&mut self, simd: S, boxes: &mut [Boxed], run: &Run, depth: u32) -> [Run; 2] {
        if boxes.len() <= WIDTH {
            return self.cut_by_kind(simd, boxes);
        }
        if depth < DEEP {
            self.bins.sort(simd, boxes, run, self.grower.settings.cuts);
            if let Some(cut) = self.bins.cheapest(simd) {
                return partition(simd, boxes, &cut);
            }
        }
        halves(simd, boxes)
    }

    /// The kind of the leaf these boxes make, or none: they are too many, or of several kinds.
    #[inline(always)]
    fn leaf_kind(&self, boxes: &[Boxed]) -> Option<Kind> {
        if boxes.len() > WIDTH {
            return None;
        }
        let same = |kind: &Kind| boxes.iter().all(|b| self.kind(b) == *kind);
        let kind = self.grower.only.or_else(|| Some(self.kind(boxes.first()?)).filter(same))?;
        (kind != Kind::Solid || boxes.len() == 1).then_some(kind)
    }

    fn kind(&self, b: &Boxed) -> Kind {
        Kind::of(&self.grower.geometry[b.geometry()]).unwrap_or(Kind::Solid)
    }

    /// Parts a few boxes of several kinds, or several solids.
    #[inline(never)]
    fn cut_by_kind<S: Simd>(&self, simd: S, boxes: &mut [Boxed]) -> [Run; 2] {
        boxes.sort_by_key(|b| self.kind(b) as u32);
        let kind = self.kind(&boxes[0]);
        let same = boxes.iter().take_while(|b| self.kind(b) == kind).count();
        let (front, back) = boxes.split_at(if same == boxes.len() { same / 2 } else { same });
        [Run::of(simd, front), Run::of(simd, back)]
    }
}

impl Branch {
    #[inline(always)]
    fn new(bounds: &[f32; 8], shape: Shape, split: Split) -> Self {
        let [x, y, z, _, hx, hy, hz, _] = *bounds;
        Self { bounds: [x, y, z, hx, hy, hz], shape, split }
    }
}

/// [`Run::of`] at a level.
struct Bound<'a> {
    boxes: &'a [Boxed],
}

impl Kernel for Bound<'_> {
    type Output = Run;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> Run {
        Run::of(simd, self.boxes)
    }
}

/// [`Bins::sort`] at a level.
struct Bin<'a> {
    boxes: &'a [Boxed],
    run: &'a Run,
    cuts: Cuts,
}

impl Kernel for Bin<'_> {
    type Output = Bins;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> Bins {
        let mut bins = Bins::new();
        bins.sort(simd, self.boxes, self.run, self.cuts);
        bins
    }
}

/// [`Bins::cheapest`] at a level.
struct Cheapest {
    bins: Bins,
}

impl Kernel for Cheapest {
    type Output = Option<Cut>;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> Option<Cut> {
        self.bins.cheapest(simd)
    }
}

/// [`halves`] at a level.
struct Halve<'a> {
    boxes: &'a [Boxed],
}

impl Kernel for Halve<'_> {
    type Output = [Run; 2];

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> [Run; 2] {
        halves(simd, self.boxes)
    }
}

/// A whole subtree at a level.
struct Grow<'a, 'b> {
    grower: &'a Grower<'a>,
    boxes: &'b mut [Boxed],
    run: &'b Run,
    depth: u32,
}

impl Kernel for Grow<'_, '_> {
    type Output = Vec<Branch>;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> Vec<Branch> {
        // Room for leaves of five and as many pairs.
        let branches = Vec::with_capacity(self.boxes.len() * 2 / 5 + 1);
        let mut sapling = Sapling { grower: self.grower, branches, bins: Box::new(Bins::new()) };
        let all = 0..self.boxes.len();
        sapling.grow(simd, self.boxes, all, self.run, self.depth);
        sapling.branches.shrink_to_fit();
        sapling.branches
    }
}

/// The branches over subtrees, and the subtrees in their order.
struct Flatten {
    top: Top,
}

impl Kernel for Flatten {
    type Output = (Subtree, Vec<Subtree>);

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> (Subtree, Vec<Subtree>) {
        let (mut over, mut subtrees) = (Subtree::default(), Vec::new());
        flatten(simd, self.top, &mut over.branches, &mut subtrees);
        (over, subtrees)
    }
}

fn flatten<S: Simd>(
    simd: S,
    top: Top,
    branches: &mut Vec<Branch>,
    subtrees: &mut Vec<Subtree>,
) -> Costs {
    match top {
        Top::Subtree(subtree, bounds) => {
            let shape = Shape::Subtree(subtrees.len() as u32);
            branches.push(Branch::new(&bounds, shape, [0; 8]));
            subtrees.push(subtree);
            CLOSED
        }
        Top::Pair(pair, bounds) => {
            let [left, right] = *pair;
            let left = flatten(simd, left, branches, subtrees);
            let shape = Shape::Pair { left: branches.len() as u32 - 1 };
            let right = flatten(simd, right, branches, subtrees);
            let (costs, split) = gather(simd, half_area(&bounds), &left, &right);
            branches.push(Branch::new(&bounds, shape, split));
            costs
        }
    }
}
