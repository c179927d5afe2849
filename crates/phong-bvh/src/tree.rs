//! The tree of one object: built once, and shared by all instances of it.

use glam::DVec3;

use crate::{
    Aabb, Level, Primitives,
    build::{self, BuildError, BuildOptions, Nodes},
    level::Token,
    traverse,
};

/// A mesh, a cloud or a bundle in its own space, with the hierarchy over it.
///
/// It knows nothing of where it stands: a [`World`](crate::World) is made of references to trees.
///
/// ```
/// use glam::Vec3;
/// use phong_bvh::{BuildOptions, Primitives, Tree};
///
/// let mesh = Primitives::triangles(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![[0, 1, 2]]);
/// let tree = Tree::build(mesh, BuildOptions::default())?;
/// assert_eq!(tree.primitives().len(), 1);
/// # Ok::<(), phong_bvh::BuildError>(())
/// ```
#[derive(Debug)]
pub struct Tree {
    /// Mostly one. Their numbers are moved by −`center`.
    batches: Vec<Primitives>,
    /// The number of each batch's first primitive, and at the end that of all.
    first: Vec<u32>,
    nodes: Nodes,
    /// What was taken off every coordinate of the object.
    center: DVec3,
}

impl Tree {
    /// Builds the tree of one object in the current rayon pool; it does not depend on the pool's size.
    ///
    /// # Errors
    /// [`BuildError::TooMany`], [`BuildError::NoSuchLevel`]; [`BuildError::Unbounded`] for a plane.
    pub fn build(primitives: Primitives, options: BuildOptions) -> Result<Self, BuildError> {
        if matches!(primitives, Primitives::Plane(_)) {
            return Err(BuildError::Unbounded);
        }
        Self::of(vec![primitives], options)
    }

    /// The tree over several batches, whose primitives are numbered through. Planes are numbered as well,
    /// and in no tree.
    pub(crate) fn of(batches: Vec<Primitives>, options: BuildOptions) -> Result<Self, BuildError> {
        let token = token(options)?;
        let total: u64 = batches.iter().map(|batch| batch.len() as u64).sum();
        if total >= u64::from(u32::MAX) {
            return Err(BuildError::TooMany(total));
        }
        let mut first = vec![0];
        let mut end = 0;
        first.extend(batches.iter().map(|batch| {
            end += batch.len() as u32;
            end
        }));
        let nodes = build::build(&batches, &first, options.preset, token)
            .map_err(|build::TooLarge| BuildError::TooMany(total))?;
        Ok(Self { batches, first, nodes, center: DVec3::ZERO })
    }

    /// The primitives, moved by −[`Tree::center`].
    #[inline]
    pub fn primitives(&self) -> &Primitives {
        &self.batches[0]
    }

    /// What was taken off every coordinate: the object's own point = the tree's + this.
    pub fn center(&self) -> DVec3 {
        self.center
    }

    /// Inner nodes.
    pub fn nodes(&self) -> u64 {
        self.nodes.nodes
    }

    /// Bytes of nodes, leaves, and the primitives' own arrays.
    pub fn bytes(&self) -> u64 {
        self.nodes.bytes() + self.batches.iter().map(Primitives::bytes).sum::<u64>()
    }

    pub(crate) fn batches(&self) -> &[Primitives] {
        &self.batches
    }

    /// The number of each batch's first primitive, and at the end that of all.
    pub(crate) fn first(&self) -> &[u32] {
        &self.first
    }

    /// How many primitives there are.
    pub(crate) fn len(&self) -> u32 {
        self.first[self.batches.len()]
    }

    /// The box around what is in the tree; none: there is nothing.
    pub(crate) fn bounds(&self) -> Option<Aabb> {
        self.nodes.bounds
    }

    /// The tree, for rays.
    #[inline(always)]
    pub(crate) fn rays(&self, token: Token) -> traverse::World<'_> {
        traverse::World::new(&self.nodes, &self.batches, &self.first, token)
    }

    /// Its nodes and leaves alone.
    pub(crate) fn into_nodes(self) -> Nodes {
        self.nodes
    }

    /// Its nodes and leaves.
    #[cfg(test)]
    pub(crate) fn rows(&self) -> &Nodes {
        &self.nodes
    }
}

/// The vector instructions asked for.
pub(crate) fn token(options: BuildOptions) -> Result<Token, BuildError> {
    let level = options.level.unwrap_or_else(Level::detect);
    Token::of(level).ok_or(BuildError::NoSuchLevel(level))
}
