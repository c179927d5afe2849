//! Building: boxes are cut in two until eight or fewer are left, and up to eight runs become the
//! children of one node.
//!
//! Large runs are cut by all threads together, and runs of at most [`TASK`] boxes become a subtree
//! each, by any thread. No decision depends on how many threads there are, so neither does the tree.

mod boxes;
mod emit;
mod sah;

use fearless_simd::Simd;
use rayon::prelude::*;

use self::{
    boxes::Boxed,
    emit::{Emitter, node},
    sah::{Bins, Run},
};
use crate::{
    Geometry,
    bvh::Preset,
    level::{Kernel, Token},
    node8::{Kind, MAX_ROWS, NODE, Ref, Row},
    simd::Rows,
};

/// Boxes of a run that one thread makes a subtree of.
const TASK: usize = 1 << 14;
/// Cuts from the root after which runs are halved, so that no arrangement makes a tree deep.
const DEEP: u32 = 64;
/// The most children or primitives side by side.
const WIDTH: usize = 8;

/// A tree.
#[derive(Debug, Default)]
pub(crate) struct Tree {
    /// Nodes and leaves.
    pub(crate) rows: Rows,
    /// Where to begin; none: there is nothing.
    pub(crate) root: Option<Ref>,
    /// Inner nodes.
    pub(crate) nodes: u64,
    /// The kind of all leaves, if it is one.
    pub(crate) only: Option<Kind>,
}

/// More rows than can be referred to.
#[derive(Debug)]
pub(crate) struct TooLarge;

/// Builds the tree over all geometry that has bounds.
pub(crate) fn build(
    geometry: &[Geometry],
    first: &[u32],
    preset: Preset,
    token: Token,
) -> Result<Tree, TooLarge> {
    let mut boxes = boxes::of(geometry);
    if boxes.is_empty() {
        return Ok(Tree::default());
    }
    let builder =
        Builder { geometry, first, bins: bins(preset), indexed: preset == Preset::Compact, token };
    let run = builder.bounds(&boxes);
    let root = builder.grow(&mut boxes, run, 0);
    drop(boxes);
    let mut tree = Tree { only: only(geometry, builder.indexed), ..Tree::default() };
    let size = root.size();
    if size > MAX_ROWS {
        return Err(TooLarge);
    }
    tree.rows = Rows::zeroed(size);
    let mut laid = Laid { rows: tree.rows.as_mut_slice(), end: 0, nodes: 0 };
    tree.root = Some(root.lay(&mut laid));
    tree.nodes = laid.nodes;
    Ok(tree)
}

/// The kind of all primitives that have bounds, if it is one.
fn only(geometry: &[Geometry], indexed: bool) -> Option<Kind> {
    let mut kinds = geometry.iter().filter(|g| !g.is_empty()).filter_map(Kind::of);
    let first = kinds.next()?;
    let plain = !(indexed && first == Kind::Triangles);
    (kinds.all(|kind| kind == first) && plain).then_some(first)
}

/// Bins along each axis.
fn bins(preset: Preset) -> usize {
    match preset {
        Preset::Fast => 8,
        Preset::Balanced | Preset::Compact => 16,
        Preset::Best => 32,
    }
}

/// A part of the tree, before all is laid end to end.
enum Part {
    /// A node over parts.
    Node(Vec<(Part, [f32; 8])>),
    /// A subtree that is already rows.
    Rows { rows: Vec<Row>, root: Ref, nodes: u64 },
}

impl Part {
    /// How many rows it is.
    fn size(&self) -> usize {
        match self {
            Self::Node(children) => {
                NODE + children.iter().map(|(part, _)| part.size()).sum::<usize>()
            }
            Self::Rows { rows, .. } => rows.len(),
        }
    }

    /// Lays it behind what is laid already, and says where its root is.
    fn lay(self, laid: &mut Laid<'_>) -> Ref {
        let at = laid.end;
        match self {
            Self::Node(children) => {
                laid.nodes += 1;
                laid.end += NODE;
                let mut written = Vec::with_capacity(WIDTH);
                for (part, bounds) in children {
                    let child = part.lay(laid);
                    written.push((Ref(child.0 - at as u32), bounds));
                }
                laid.rows[at..at + NODE].copy_from_slice(&node(&written));
                Ref::node(at)
            }
            Self::Rows { rows, root, nodes } => {
                laid.nodes += nodes;
                laid.end += rows.len();
                laid.rows[at..laid.end].copy_from_slice(&rows);
                root.from(at)
            }
        }
    }
}

/// The rows of a tree, of which some are laid.
struct Laid<'a> {
    rows: &'a mut [Row],
    end: usize,
    nodes: u64,
}

/// What every step of building needs.
#[derive(Clone, Copy)]
struct Builder<'a> {
    geometry: &'a [Geometry],
    first: &'a [u32],
    bins: usize,
    /// Whether leaves name their triangles instead of holding them.
    indexed: bool,
    token: Token,
}

impl Builder<'_> {
    /// The bounds of all boxes.
    fn bounds(&self, boxes: &[Boxed]) -> Run {
        let runs = boxes.par_chunks(TASK).map(|boxes| self.token.run(Bound { boxes }));
        let none = || Run { len: 0, bounds: boxes::EMPTY, centers: boxes::EMPTY };
        runs.reduce(none, |a, b| a.union(&b))
    }

    /// The part over `boxes`, `depth` cuts below the root.
    fn grow(&self, boxes: &mut [Boxed], run: Run, depth: u32) -> Part {
        if boxes.len() <= TASK {
            return self.token.run(Subtree { builder: self, boxes, run, depth });
        }
        let mut children = vec![(boxes, run, depth)];
        while children.len() < WIDTH {
            let widest = (0..children.len())
                .filter(|&i| children[i].0.len() > TASK)
                .max_by(|&i, &j| children[i].1.half_area().total_cmp(&children[j].1.half_area()));
            let Some(widest) = widest else { break };
            let (boxes, run, depth) = children.swap_remove(widest);
            let [left, right] = self.cut(boxes, &run, depth);
            let (front, back) = boxes.split_at_mut(left.len);
            children.push((front, left, depth + 1));
            children.push((back, right, depth + 1));
        }
        let grown = children.into_par_iter().map(|(boxes, run, depth)| {
            let bounds = run.bounds;
            (self.grow(boxes, run, depth), bounds)
        });
        Part::Node(grown.collect())
    }

    /// Cuts a large run in two, binning with all threads.
    fn cut(&self, boxes: &mut [Boxed], run: &Run, depth: u32) -> [Run; 2] {
        let sorted =
            boxes.par_chunks(TASK).map(|boxes| self.token.run(Bin { boxes, run, bins: self.bins }));
        let bins = sorted.reduce_with(|a, b| a.merge(&b));
        self.token.run(Apply { bins: bins.as_ref(), boxes, depth })
    }
}

/// Cuts a run in two where it costs least, or in halves where there is no such place.
#[inline(always)]
fn cut<S: Simd>(simd: S, bins: Option<&Bins>, boxes: &mut [Boxed], depth: u32) -> [Run; 2] {
    let found = bins.filter(|_| depth < DEEP).and_then(|bins| Some((bins, bins.cheapest(simd)?)));
    if let Some((bins, cut)) = found {
        return bins.apply(simd, boxes, cut);
    }
    // All centres are one, or nearly: halves, at a multiple of the width so that leaves are full.
    let half = (boxes.len() / 2).next_multiple_of(WIDTH).min(boxes.len() - 1);
    let (front, back) = boxes.split_at(half);
    [Run::of(simd, front), Run::of(simd, back)]
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
    bins: usize,
}

impl Kernel for Bin<'_> {
    type Output = Bins;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> Bins {
        let mut bins = Bins::new();
        bins.sort(simd, self.boxes, self.run, self.bins);
        bins
    }
}

/// [`cut`] at a level.
struct Apply<'a> {
    bins: Option<&'a Bins>,
    boxes: &'a mut [Boxed],
    depth: u32,
}

impl Kernel for Apply<'_> {
    type Output = [Run; 2];

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> [Run; 2] {
        cut(simd, self.bins, self.boxes, self.depth)
    }
}

/// A whole subtree at a level.
struct Subtree<'a, 'b> {
    builder: &'a Builder<'a>,
    boxes: &'b mut [Boxed],
    run: Run,
    depth: u32,
}

impl Kernel for Subtree<'_, '_> {
    type Output = Part;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> Part {
        let Builder { geometry, first, bins, .. } = *self.builder;
        let mut emitter = Emitter::new(geometry, first, bins, self.builder.indexed);
        let root = emitter.emit(simd, self.boxes, &self.run, self.depth);
        emitter.rows.shrink_to_fit();
        Part::Rows { rows: emitter.rows, root, nodes: emitter.nodes }
    }
}

impl Tree {
    /// The bytes of nodes and leaves.
    pub(crate) fn bytes(&self) -> u64 {
        size_of_val(self.rows.as_slice()) as u64
    }

    /// The bounds of a child, as stored.
    #[cfg(test)]
    pub(crate) fn child_bounds(node: &[Row; NODE], child: usize) -> crate::Aabb {
        let at = |row: usize| node[row].0[child];
        crate::Aabb {
            lo: glam::Vec3::new(at(0), at(2), at(4)),
            hi: glam::Vec3::new(at(1), at(3), at(5)),
        }
    }
}
