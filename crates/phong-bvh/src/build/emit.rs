//! A subtree by one thread: cut in two down to leaves, then gathered into nodes of eight.
//!
//! Which branches of the binary tree become children of one node is decided by dynamic programming
//! (Ylitie, Karras and Laine, *Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide
//! BVHs*, 2017): with `A` the surface of a branch, a forest of at most `i` trees under it costs
//! `C(1) = A + min C_left(k) + C_right(8 − k)` as a node and
//! `C(i) = min(C(i − 1), min C_left(k) + C_right(i − k))` as several.

use std::ops::Range;

use fearless_simd::Simd;

use super::{
    WIDTH,
    boxes::{Boxed, half_area},
    cut,
    sah::{Bins, Run},
};
use crate::{
    Geometry,
    node8::{Kind, NODE, REFS, Ref, Row},
    primitives::{sphere, triangle},
};

/// Writes one subtree.
pub(super) struct Emitter<'a> {
    pub(super) geometry: &'a [Geometry],
    pub(super) first: &'a [u32],
    pub(super) bins: usize,
    pub(super) rows: Vec<Row>,
    pub(super) nodes: u64,
    branches: Vec<Branch>,
    /// The bins of the run being cut; clearing new ones for each cut would cost more than filling them.
    sorted: Box<Bins>,
    indexed: bool,
}

/// A node of the binary tree.
struct Branch {
    bounds: [f32; 8],
    shape: Shape,
    /// C(1) … C(7).
    costs: [f32; WIDTH - 1],
    /// For two to eight trees: how many of them are on the left; 0: the same as for one fewer. The
    /// first entry is for eight trees, the children of a node here.
    left: [u8; WIDTH],
}

/// What is under a branch.
enum Shape {
    Leaf(Kind, Range<usize>),
    Pair([usize; 2]),
}

impl<'a> Emitter<'a> {
    pub(super) fn new(
        geometry: &'a [Geometry],
        first: &'a [u32],
        bins: usize,
        indexed: bool,
    ) -> Self {
        let (rows, branches, sorted) = (Vec::new(), Vec::new(), Box::new(Bins::new()));
        Self { geometry, first, bins, rows, nodes: 0, branches, sorted, indexed }
    }

    /// Writes the subtree over `boxes`; where its root is.
    #[inline(always)]
    pub(super) fn emit<S: Simd>(
        &mut self,
        simd: S,
        boxes: &mut [Boxed],
        run: &Run,
        depth: u32,
    ) -> Ref {
        let root = self.grow(simd, boxes, run, 0..boxes.len(), depth);
        self.write(boxes, root)
    }

    /// Cuts the boxes of `range` down to leaves; the number of their branch.
    fn grow<S: Simd>(
        &mut self,
        simd: S,
        boxes: &mut [Boxed],
        run: &Run,
        range: Range<usize>,
        depth: u32,
    ) -> usize {
        simd.vectorize(
            #[inline(always)]
            || {
                let mine = &mut boxes[range.clone()];
                if let Some(kind) = self.leaf_kind(mine) {
                    // A leaf's own cost is the same wherever it hangs.
                    return self.branch(run, Shape::Leaf(kind, range), [0.0; 7], [0; 8]);
                }
                let [left, right] = if mine.len() > WIDTH {
                    self.sorted.sort(simd, mine, run, self.bins);
                    cut(simd, Some(&self.sorted), mine, depth)
                } else {
                    self.cut_by_kind(simd, mine)
                };
                let middle = range.start + left.len;
                let left = self.grow(simd, boxes, &left, range.start..middle, depth + 1);
                let right = self.grow(simd, boxes, &right, middle..range.end, depth + 1);
                let (costs, split) = self.gather(run, [left, right]);
                self.branch(run, Shape::Pair([left, right]), costs, split)
            },
        )
    }

    fn branch(&mut self, run: &Run, shape: Shape, costs: [f32; 7], left: [u8; 8]) -> usize {
        self.branches.push(Branch { bounds: run.bounds, shape, costs, left });
        self.branches.len() - 1
    }

    /// The least costs of forests over two branches, and how to divide them.
    fn gather(&self, run: &Run, [left, right]: [usize; 2]) -> ([f32; 7], [u8; 8]) {
        let [l, r] = [&self.branches[left].costs, &self.branches[right].costs];
        let least = |trees: usize| {
            let cost = |k: usize| l[k - 1] + r[trees - k - 1];
            let mut best = (f32::INFINITY, 1);
            for k in 1.max(trees.saturating_sub(7))..=(trees - 1).min(7) {
                if cost(k) < best.0 {
                    best = (cost(k), k as u8);
                }
            }
            best
        };
        let (mut costs, mut split) = ([0.0; 7], [0; 8]);
        let (below, k) = least(WIDTH);
        costs[0] = half_area(&run.bounds) + below;
        split[0] = k;
        for trees in 2..WIDTH {
            let (cost, k) = least(trees);
            let better = cost < costs[trees - 2];
            costs[trees - 1] = if better { cost } else { costs[trees - 2] };
            split[trees - 1] = if better { k } else { 0 };
        }
        (costs, split)
    }

    /// The branches that are the trees of a forest of at most `trees` under a branch.
    fn forest(&self, branch: usize, trees: usize, found: &mut Vec<usize>) {
        let Branch { shape, left, .. } = &self.branches[branch];
        match (shape, left[trees - 1]) {
            (Shape::Pair([l, r]), k) if trees > 1 && k > 0 => {
                self.forest(*l, usize::from(k), found);
                self.forest(*r, trees - usize::from(k), found);
            }
            (Shape::Pair(_), _) if trees > 1 => self.forest(branch, trees - 1, found),
            _ => found.push(branch),
        }
    }

    /// Writes a branch and all under it.
    fn write(&mut self, boxes: &mut [Boxed], branch: usize) -> Ref {
        let pair = match &self.branches[branch].shape {
            Shape::Leaf(kind, range) => {
                let (kind, range) = (*kind, range.clone());
                return self.leaf(&mut boxes[range], kind);
            }
            Shape::Pair(pair) => *pair,
        };
        let k = usize::from(self.branches[branch].left[0]);
        let mut children = Vec::with_capacity(WIDTH);
        self.forest(pair[0], k, &mut children);
        self.forest(pair[1], WIDTH - k, &mut children);
        // Leaves first: they lie beside their node.
        children.sort_by_key(|&child| matches!(self.branches[child].shape, Shape::Pair(_)));
        let at = self.rows.len();
        self.nodes += 1;
        self.rows.resize(at + NODE, Row::ZERO);
        let mut written = Vec::with_capacity(WIDTH);
        for child in children {
            let row = self.write(boxes, child);
            written.push((Ref(row.0 - at as u32), self.branches[child].bounds));
        }
        self.rows[at..at + NODE].copy_from_slice(&node(&written));
        Ref::node(at)
    }

    /// The kind of the leaf these boxes make, or none: they are too many, or of several kinds.
    fn leaf_kind(&self, boxes: &[Boxed]) -> Option<Kind> {
        if boxes.len() > WIDTH {
            return None;
        }
        let kind = self.kind(boxes.first()?);
        let same = boxes.iter().all(|b| self.kind(b) == kind);
        (same && (kind != Kind::Solid || boxes.len() == 1)).then_some(kind)
    }

    fn kind(&self, b: &Boxed) -> Kind {
        Kind::of(&self.geometry[b.geometry()]).unwrap_or(Kind::Solid)
    }

    /// Parts a few boxes of several kinds, or several solids.
    #[inline(always)]
    fn cut_by_kind<S: Simd>(&self, simd: S, boxes: &mut [Boxed]) -> [Run; 2] {
        boxes.sort_by_key(|b| self.kind(b) as u32);
        let kind = self.kind(&boxes[0]);
        let same = boxes.iter().take_while(|b| self.kind(b) == kind).count();
        let (front, back) = boxes.split_at(if same == boxes.len() { same / 2 } else { same });
        [Run::of(simd, front), Run::of(simd, back)]
    }

    /// Writes a leaf. Unused lanes repeat the first primitive with no number.
    fn leaf(&mut self, boxes: &mut [Boxed], kind: Kind) -> Ref {
        let at = self.rows.len();
        // By number, so that a leaf does not depend on how boxes were swapped to and fro.
        boxes.sort_unstable_by_key(|b| (b.geometry(), b.local()));
        let number = |b: &Boxed| f32::from_bits(self.first[b.geometry()] + b.local() as u32);
        if kind == Kind::Solid {
            let index = f32::from_bits(boxes[0].geometry() as u32);
            self.rows.push(Row([number(&boxes[0]), index, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]));
            return Ref::leaf(kind, at);
        }
        if kind == Kind::Triangles && self.indexed {
            let mut row = [Row([f32::from_bits(u32::MAX); 8]); 2];
            for (lane, b) in boxes.iter().enumerate() {
                row[0].0[lane] = f32::from_bits(b.local() as u32);
                row[1].0[lane] = f32::from_bits(b.geometry() as u32);
            }
            self.rows.extend(row);
            return Ref::leaf(Kind::Indexed, at);
        }
        let size = if kind == Kind::Triangles { triangle::BLOCK } else { sphere::BLOCK };
        self.rows.resize(at + size, Row::ZERO);
        let block = &mut self.rows[at..];
        for lane in 0..WIDTH {
            let b = boxes.get(lane).unwrap_or(&boxes[0]);
            match &self.geometry[b.geometry()] {
                Geometry::Triangles { positions, indices } => {
                    for (corner, &index) in indices[b.local()].iter().enumerate() {
                        let [x, y, z] = positions[index as usize].to_array();
                        block[3 * corner].0[lane] = x;
                        block[3 * corner + 1].0[lane] = y;
                        block[3 * corner + 2].0[lane] = z;
                    }
                }
                Geometry::Spheres(spheres) => {
                    let sphere = spheres[b.local()];
                    let [x, y, z] = sphere.center.to_array();
                    for (row, value) in [x, y, z, sphere.radius].into_iter().enumerate() {
                        block[row].0[lane] = value;
                    }
                }
                Geometry::Solid(_) | Geometry::Plane(_) => {}
            }
            block[size - 1].0[lane] =
                if lane < boxes.len() { number(b) } else { f32::from_bits(u32::MAX) };
        }
        Ref::leaf(kind, at)
    }
}

/// The rows of a node. Unused children are boxes no ray meets.
pub(super) fn node(children: &[(Ref, [f32; 8])]) -> [Row; NODE] {
    let mut node = [Row::ZERO; NODE];
    for axis in 0..3 {
        node[2 * axis] = Row([f32::INFINITY; 8]);
        node[2 * axis + 1] = Row([f32::NEG_INFINITY; 8]);
    }
    for (lane, (child, bounds)) in children.iter().enumerate() {
        for axis in 0..3 {
            node[2 * axis].0[lane] = -bounds[axis];
            node[2 * axis + 1].0[lane] = bounds[4 + axis];
        }
        node[REFS].0[lane] = f32::from_bits(child.0);
    }
    node
}
