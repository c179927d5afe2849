//! Building: boxes are cut in two until eight or fewer are left, and branches of that binary tree
//! are gathered into nodes of eight.
//!
//! Large runs are cut by all threads together, and smaller ones become a subtree each, by any thread.
//! When all sizes are known, each subtree is written where it belongs, again by any thread. No
//! decision depends on how many threads there are, so neither does the tree.

mod boxes;
mod branch;
mod emit;
mod gather;
mod grow;
mod options;
mod partition;
mod sah;

use glam::Vec3;
use rayon::prelude::*;

pub use self::options::{BuildError, BuildOptions, Preset};
use self::{
    boxes::Boxed,
    emit::Writer,
    grow::{Grower, Subtree},
    sah::Cuts,
};
#[cfg(test)]
use crate::node8::NODE;
use crate::{
    Aabb, Primitives,
    level::Token,
    node8::{Kind, MAX_ROWS, Ref, Row},
    simd::Rows,
};

/// The most children or primitives side by side.
const WIDTH: usize = 8;

/// The nodes and leaves of a tree.
#[derive(Debug, Default)]
#[expect(clippy::struct_field_names, reason = "what it counts are nodes, too")]
pub(crate) struct Nodes {
    /// Nodes and leaves.
    pub(crate) rows: Rows,
    /// Where to begin; none: there is nothing.
    pub(crate) root: Option<Ref>,
    /// Inner nodes.
    pub(crate) nodes: u64,
    /// The kind of all leaves, if it is one.
    pub(crate) only: Option<Kind>,
    /// The box around all, grown like every box of the tree; none: there is nothing.
    pub(crate) bounds: Option<Aabb>,
}

/// More primitives than a box can name, or more rows than can be referred to.
#[derive(Debug)]
pub(crate) struct TooLarge;

/// How to build.
#[derive(Clone, Copy, Debug)]
struct Settings {
    cuts: Cuts,
    /// Whether leaves name their triangles instead of holding them.
    indexed: bool,
}

impl Settings {
    fn of(preset: Preset) -> Self {
        let cuts = match preset {
            Preset::Fast => Cuts { bins: 8, widest: true },
            Preset::Balanced | Preset::Compact => Cuts { bins: 16, widest: false },
            Preset::Best => Cuts { bins: 32, widest: false },
        };
        Self { cuts, indexed: preset == Preset::Compact }
    }
}

/// Most primitives of one geometry.
pub(crate) const MOST_OF_ONE: usize = boxes::MOST;

/// Builds the tree over all geometry that has bounds.
pub(crate) fn build(
    geometry: &[Primitives],
    first: &[u32],
    preset: Preset,
    token: Token,
) -> Result<Nodes, TooLarge> {
    if geometry.len() > boxes::MOST || geometry.iter().any(|g| g.len() > boxes::MOST) {
        return Err(TooLarge);
    }
    let (mut boxes, count) = boxes::of(geometry);
    if count == 0 {
        return Ok(Nodes::default());
    }
    let boxes = &mut boxes.as_mut_slice()[..count];
    let settings = Settings::of(preset);
    let only = only(geometry);
    let (top, subtrees) = Grower { geometry, settings, only, token }.grow(boxes);
    let bounds = top.branches.last().map(|root| {
        let [x, y, z, hi @ ..] = root.bounds;
        Aabb { lo: Vec3::new(-x, -y, -z), hi: Vec3::from(hi) }
    });
    let only = only.filter(|&kind| !(settings.indexed && kind == Kind::Triangles));
    let nodes = Plan { geometry, first, indexed: settings.indexed, boxes }.lay(&top, &subtrees)?;
    Ok(Nodes { only, bounds, ..nodes })
}

/// The kind of all primitives that have bounds, if it is one.
fn only(geometry: &[Primitives]) -> Option<Kind> {
    let mut kinds = geometry.iter().filter(|g| !g.is_empty()).filter_map(Kind::of);
    let first = kinds.next()?;
    kinds.all(|kind| kind == first).then_some(first)
}

/// What is to be written.
struct Plan<'a> {
    geometry: &'a [Primitives],
    first: &'a [u32],
    indexed: bool,
    boxes: &'a [Boxed],
}

impl Plan<'_> {
    /// Writes all subtrees and the tree over them.
    fn lay(&self, top: &Subtree, subtrees: &[Subtree]) -> Result<Nodes, TooLarge> {
        let sizes = || subtrees.iter().chain([top]).map(|subtree| subtree.size);
        let size = sizes().map(|size| size.rows).sum();
        let nodes = sizes().map(|size| size.nodes).sum();
        if size > MAX_ROWS {
            return Err(TooLarge);
        }
        let mut rows = Rows::zeroed(size);
        let mut places = Vec::with_capacity(subtrees.len());
        let root = self.write(top, rows.as_mut_slice(), |number, at| {
            let number = number as usize;
            places.push((number, at));
            (subtrees[number].root(self.indexed, at), subtrees[number].size.rows)
        });
        let mut rest = rows.as_mut_slice();
        let mut done = 0;
        let mut pieces = Vec::with_capacity(subtrees.len());
        for (number, at) in places {
            let (_, from) = rest.split_at_mut(at - done);
            let (piece, behind) = from.split_at_mut(subtrees[number].size.rows);
            pieces.push((&subtrees[number], piece));
            rest = behind;
            done = at + subtrees[number].size.rows;
        }
        pieces.into_par_iter().for_each(|(subtree, rows)| {
            self.write(subtree, rows, |_, at| (Ref::node(at), 0));
        });
        Ok(Nodes { rows, root: Some(root), nodes, ..Nodes::default() })
    }

    fn write(
        &self,
        subtree: &Subtree,
        rows: &mut [Row],
        mut inner: impl FnMut(u32, usize) -> (Ref, usize),
    ) -> Ref {
        let Self { geometry, first, indexed, boxes } = *self;
        let Subtree { branches, boxes: range, .. } = subtree;
        let boxes = &boxes[range.clone()];
        let mut writer = Writer { geometry, first, indexed, branches, boxes, rows, end: 0 };
        writer.write(branches.len() as u32 - 1, &mut inner)
    }
}

impl Nodes {
    /// The bytes of nodes and leaves.
    pub(crate) fn bytes(&self) -> u64 {
        size_of_val(self.rows.as_slice()) as u64
    }

    /// The bounds of a child, as stored.
    #[cfg(test)]
    pub(crate) fn child_bounds(node: &[Row; NODE], child: usize) -> Aabb {
        let at = |row: usize| node[row].0[child];
        Aabb { lo: Vec3::new(at(0), at(2), at(4)), hi: Vec3::new(at(1), at(3), at(5)) }
    }
}
