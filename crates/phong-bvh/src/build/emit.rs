//! From branches to rows.

use super::{
    WIDTH,
    boxes::Boxed,
    branch::{Branch, Shape},
};
use crate::{
    Primitives,
    node8::{Kind, NODE, REFS, Ref, Row},
    primitives::{capsule, sphere, triangle},
    simd::prefetch_item,
};

/// What is under one node.
pub(super) struct Children {
    list: [u32; WIDTH],
    len: usize,
}

impl Children {
    /// The branches that become the children of the pair `root`: leaves first, since they lie beside
    /// their node.
    fn of(branches: &[Branch], root: u32) -> Self {
        let mut found = Self { list: [0; WIDTH], len: 0 };
        if let Shape::Pair { left } = branches[root as usize].shape {
            let k = usize::from(branches[root as usize].split[0]);
            found.forest(branches, left, k);
            found.forest(branches, root - 1, WIDTH - k);
        }
        let is_leaf = |&child: &u32| matches!(branches[child as usize].shape, Shape::Leaf { .. });
        let mut sorted = [0; WIDTH];
        let leaves = found.as_slice().iter().filter(|child| is_leaf(child));
        let others = found.as_slice().iter().filter(|child| !is_leaf(child));
        for (slot, child) in sorted.iter_mut().zip(leaves.chain(others)) {
            *slot = *child;
        }
        Self { list: sorted, len: found.len }
    }

    /// Adds the branches that are the trees of a forest of at most `trees` under a branch.
    fn forest(&mut self, branches: &[Branch], branch: u32, trees: usize) {
        let Branch { shape, split, .. } = &branches[branch as usize];
        let Shape::Pair { left } = *shape else { return self.push(branch) };
        // The most trees that are worth their cost.
        let used = (2..=trees).rev().find(|&trees| split[trees - 1] > 0);
        let Some(used) = used else { return self.push(branch) };
        let k = usize::from(split[used - 1]);
        self.forest(branches, left, k);
        self.forest(branches, branch - 1, used - k);
    }

    fn push(&mut self, branch: u32) {
        self.list[self.len] = branch;
        self.len += 1;
    }

    fn as_slice(&self) -> &[u32] {
        &self.list[..self.len]
    }
}

/// How large something is.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Size {
    pub(super) rows: usize,
    pub(super) nodes: u64,
}

/// The size of the subtree of a branch, without the subtrees it refers to.
pub(super) fn measure(branches: &[Branch], indexed: bool, root: u32) -> Size {
    match branches[root as usize].shape {
        Shape::Leaf { kind, .. } => Size { rows: leaf_rows(kind, indexed), nodes: 0 },
        Shape::Subtree(_) => Size::default(),
        Shape::Pair { .. } => {
            let mut size = Size { rows: NODE, nodes: 1 };
            for &child in Children::of(branches, root).as_slice() {
                let Size { rows, nodes } = measure(branches, indexed, child);
                size.rows += rows;
                size.nodes += nodes;
            }
            size
        }
    }
}

fn leaf_rows(kind: Kind, indexed: bool) -> usize {
    match kind {
        Kind::Triangles if indexed => 2,
        Kind::Triangles => triangle::BLOCK,
        Kind::Spheres => sphere::BLOCK,
        Kind::Solid => 1,
        Kind::Indexed => 2,
        Kind::Cylinders => capsule::BLOCK,
    }
}

/// Writes one subtree, or the tree over all of them.
pub(super) struct Writer<'a> {
    pub(super) geometry: &'a [Primitives],
    pub(super) first: &'a [u32],
    pub(super) indexed: bool,
    pub(super) branches: &'a [Branch],
    pub(super) boxes: &'a [Boxed],
    pub(super) rows: &'a mut [Row],
    pub(super) end: usize,
}

impl Writer<'_> {
    /// Writes a branch and all under it; `subtree` says where a subtree is, given its number and the row
    /// it may begin at, and how many rows it takes.
    pub(super) fn write(
        &mut self,
        branch: u32,
        subtree: &mut impl FnMut(u32, usize) -> (Ref, usize),
    ) -> Ref {
        let at = self.end;
        match self.branches[branch as usize].shape {
            Shape::Subtree(number) => {
                let (root, rows) = subtree(number, at);
                self.end += rows;
                root
            }
            Shape::Leaf { kind, len, first } => {
                let (first, len) = (first as usize, usize::from(len));
                self.prefetch(first, len);
                self.leaf(kind, &self.boxes[first..first + len])
            }
            Shape::Pair { .. } => {
                self.end += NODE;
                let children = Children::of(self.branches, branch);
                let mut node = EMPTY_NODE;
                for (lane, &child) in children.as_slice().iter().enumerate() {
                    let Ref(row) = self.write(child, subtree);
                    let bounds = &self.branches[child as usize].bounds;
                    for axis in 0..3 {
                        node[2 * axis].0[lane] = -bounds[axis];
                        node[2 * axis + 1].0[lane] = bounds[3 + axis];
                    }
                    node[REFS].0[lane] = f32::from_bits(row - at as u32);
                }
                self.rows[at..at + NODE].copy_from_slice(&node);
                Ref::node(at)
            }
        }
    }

    /// Asks for primitives of leaves to come: the next boxes are written soon, not in their order but
    /// nearly, and primitives lie anywhere in memory.
    #[inline(always)]
    fn prefetch(&self, first: usize, len: usize) {
        const AHEAD: usize = 16;
        let range = |ahead: usize| {
            let end = self.boxes.len();
            (first + ahead).min(end)..(first + ahead + len).min(end)
        };
        if !self.indexed {
            for b in &self.boxes[range(2 * AHEAD)] {
                match &self.geometry[b.geometry()] {
                    Primitives::Triangles { indices, .. } => prefetch_item(indices, b.local()),
                    Primitives::Spheres(spheres) => prefetch_item(spheres.as_slice(), b.local()),
                    Primitives::Cylinders { cylinders, .. } => prefetch_item(cylinders, b.local()),
                    Primitives::Solid(_) | Primitives::Plane(_) => {}
                }
            }
            for b in &self.boxes[range(AHEAD)] {
                if let Primitives::Triangles { positions, indices } = &self.geometry[b.geometry()] {
                    for &index in &indices[b.local()] {
                        prefetch_item(positions, index as usize);
                    }
                }
            }
        }
    }

    /// Writes a leaf. Unused lanes repeat the first primitive with no number.
    fn leaf(&mut self, kind: Kind, boxes: &[Boxed]) -> Ref {
        let at = self.end;
        self.end += leaf_rows(kind, self.indexed);
        let block = &mut self.rows[at..self.end];
        let number = |b: &Boxed| f32::from_bits(self.first[b.geometry()] + b.local() as u32);
        if kind == Kind::Solid {
            let index = f32::from_bits(boxes[0].geometry() as u32);
            block[0] = Row([number(&boxes[0]), index, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
            return Ref::leaf(kind, at);
        }
        if kind == Kind::Triangles && self.indexed {
            block.fill(Row([f32::from_bits(u32::MAX); 8]));
            for (lane, b) in boxes.iter().enumerate() {
                block[0].0[lane] = f32::from_bits(b.local() as u32);
                block[1].0[lane] = f32::from_bits(b.geometry() as u32);
            }
            return Ref::leaf(Kind::Indexed, at);
        }
        for lane in 0..WIDTH {
            let b = boxes.get(lane).unwrap_or(&boxes[0]);
            match &self.geometry[b.geometry()] {
                Primitives::Triangles { positions, indices } => {
                    for (corner, &index) in indices[b.local()].iter().enumerate() {
                        let [x, y, z] = positions[index as usize].to_array();
                        block[3 * corner].0[lane] = x;
                        block[3 * corner + 1].0[lane] = y;
                        block[3 * corner + 2].0[lane] = z;
                    }
                }
                Primitives::Spheres(spheres) => {
                    let numbers = spheres.as_slice()[b.local()];
                    for (row, value) in numbers.into_iter().enumerate() {
                        block[row].0[lane] = value;
                    }
                }
                Primitives::Cylinders { cylinders, caps } => {
                    let numbers = capsule::lane(&cylinders[b.local()], *caps);
                    for (row, value) in numbers.into_iter().enumerate() {
                        block[row].0[lane] = value;
                    }
                }
                Primitives::Solid(_) | Primitives::Plane(_) => {}
            }
            let number = if lane < boxes.len() { number(b) } else { f32::from_bits(u32::MAX) };
            block[block.len() - 1].0[lane] = number;
        }
        Ref::leaf(kind, at)
    }
}

/// A node without children: boxes no ray meets.
const EMPTY_NODE: [Row; NODE] = {
    let (lo, hi) = (Row([f32::INFINITY; 8]), Row([f32::NEG_INFINITY; 8]));
    [lo, hi, lo, hi, lo, hi, Row::ZERO, Row::ZERO]
};
