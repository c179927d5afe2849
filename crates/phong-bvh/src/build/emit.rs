//! Turns a run of boxes into nodes and leaves.

use fearless_simd::Simd;

use super::{
    WIDTH,
    boxes::Boxed,
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
}

/// A child before it is written.
struct Child<'b> {
    boxes: &'b mut [Boxed],
    run: Run,
    depth: u32,
}

impl Emitter<'_> {
    /// Writes the subtree over `boxes`; where its root is.
    pub(super) fn emit<S: Simd>(
        &mut self,
        simd: S,
        boxes: &mut [Boxed],
        run: &Run,
        depth: u32,
    ) -> Ref {
        simd.vectorize(
            #[inline(always)]
            || self.subtree(simd, boxes, run, depth),
        )
    }

    #[inline(always)]
    fn subtree<S: Simd>(&mut self, simd: S, boxes: &mut [Boxed], run: &Run, depth: u32) -> Ref {
        if let Some(kind) = self.leaf_kind(boxes) {
            return self.leaf(boxes, kind);
        }
        let mut children = vec![Child { boxes, run: *run, depth }];
        while children.len() < WIDTH {
            let widest = (0..children.len())
                .filter(|&i| self.leaf_kind(children[i].boxes).is_none())
                .max_by(|&i, &j| {
                    children[i].run.half_area().total_cmp(&children[j].run.half_area())
                });
            let Some(widest) = widest else { break };
            let Child { boxes, run, depth } = children.swap_remove(widest);
            let [left, right] = if boxes.len() > WIDTH {
                let bins = Bins::of(simd, boxes, &run, self.bins);
                cut(simd, Some(&bins), boxes, depth)
            } else {
                self.cut_by_kind(simd, boxes)
            };
            let (front, back) = boxes.split_at_mut(left.len);
            children.push(Child { boxes: front, run: left, depth: depth + 1 });
            children.push(Child { boxes: back, run: right, depth: depth + 1 });
        }
        let at = self.rows.len();
        self.nodes += 1;
        self.rows.resize(at + NODE, Row::ZERO);
        let mut written = Vec::with_capacity(WIDTH);
        // Leaves first: they lie beside their node.
        children.sort_by_key(|child| self.leaf_kind(child.boxes).is_none());
        for child in children {
            let bounds = child.run.bounds;
            let child = self.emit(simd, child.boxes, &child.run, child.depth);
            written.push((Ref(child.0 - at as u32), bounds));
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
        match self.geometry[b.geometry()] {
            Geometry::Triangles { .. } => Kind::Triangles,
            Geometry::Spheres(_) => Kind::Spheres,
            Geometry::Solid(_) | Geometry::Plane(_) => Kind::Solid,
        }
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
        let size = if kind == Kind::Triangles { triangle::BLOCK } else { sphere::BLOCK };
        self.rows.resize(at + size, Row::ZERO);
        let block = &mut self.rows[at..];
        for lane in 0..WIDTH {
            let b = boxes.get(lane).unwrap_or(&boxes[0]);
            match &self.geometry[b.geometry()] {
                Geometry::Triangles { positions, indices } => {
                    for (corner, &index) in indices[b.local()].iter().enumerate() {
                        for (axis, x) in
                            positions[index as usize].to_array().into_iter().enumerate()
                        {
                            block[3 * corner + axis].0[lane] = x;
                        }
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
