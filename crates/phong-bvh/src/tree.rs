//! The tree of one object: built once, and shared by all instances of it.

use std::sync::Arc;

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use crate::{
    Aabb, Cylinder, Primitives,
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
    /// Arrays are shared, not copied, but for an object that is farther from its own origin than it is
    /// large: that one is moved to its own middle, so that f32 is fine enough for it.
    ///
    /// # Errors
    /// [`BuildError::TooMany`], [`BuildError::NoSuchLevel`]; [`BuildError::Unbounded`] for a plane.
    pub fn build(primitives: Primitives, options: BuildOptions) -> Result<Self, BuildError> {
        if matches!(primitives, Primitives::Plane(_)) {
            return Err(BuildError::Unbounded);
        }
        let center = middle(&primitives);
        let moved = if center == DVec3::ZERO { primitives } else { moved(&primitives, -center) };
        Ok(Self { center, ..Self::of(vec![moved], options)? })
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

/// The most points that the middle of an object is taken from.
const SAMPLE: usize = 1024;
/// Up to so many sizes from its own origin an object stays where it is.
const NEAR: f64 = 16.0;

/// What to take off an object's coordinates: its median point, rounded to a power of two about as large as
/// the object, so that little is lost in f32. 0 where the object is around its own origin: it then keeps its
/// bits, and its arrays need not be copied.
///
/// Medians and quantiles, not the box: one stray point says nothing of where the others are.
fn middle(primitives: &Primitives) -> DVec3 {
    let (points, radius) = sample(primitives);
    if points.is_empty() {
        return DVec3::ZERO;
    }
    let along = |axis: usize| {
        let mut all: Vec<f32> = points.iter().map(|p| p[axis]).collect();
        all.sort_unstable_by(f32::total_cmp);
        let at = |share: usize| f64::from(all[(all.len() - 1) * share / 10]);
        (at(5), at(9) - at(1))
    };
    let [x, y, z] = [along(0), along(1), along(2)];
    let (middle, size) =
        (DVec3::new(x.0, y.0, z.0), x.1.max(y.1).max(z.1).max(2.0 * f64::from(radius)));
    let is_far = middle.abs().max_element() > NEAR * size;
    if !is_far || size == 0.0 || !middle.is_finite() {
        return DVec3::ZERO;
    }
    // The power of two is made of the exponent's bits.
    let step = f64::from_bits(size.to_bits() & 0x7ff0_0000_0000_0000) * 2.0;
    (middle / step).round() * step
}

/// Points of up to [`SAMPLE`] primitives, evenly spread over their numbers, and a usual radius.
fn sample(primitives: &Primitives) -> (Vec<Vec3>, f32) {
    let step = primitives.len().div_ceil(SAMPLE).max(1);
    match primitives {
        Primitives::Triangles { positions, indices } => {
            (indices.iter().step_by(step).map(|&[a, ..]| positions[a as usize]).collect(), 0.0)
        }
        Primitives::Spheres(spheres) => {
            let some = || spheres.iter().step_by(step);
            let mut radii: Vec<f32> = some().map(|sphere| sphere.radius).collect();
            radii.sort_unstable_by(f32::total_cmp);
            let radius = radii.get(radii.len() / 2).copied().unwrap_or_default();
            (some().map(|sphere| sphere.center).collect(), radius)
        }
        Primitives::Cylinders { cylinders, .. } => {
            let some = || cylinders.iter().step_by(step);
            let mut radii: Vec<f32> = some().map(|cylinder| cylinder.radius).collect();
            radii.sort_unstable_by(f32::total_cmp);
            let radius = radii.get(radii.len() / 2).copied().unwrap_or_default();
            (some().flat_map(|cylinder| [cylinder.from, cylinder.to]).collect(), radius)
        }
        // These are f64 as they are.
        Primitives::Plane(_) | Primitives::Solid(_) => (Vec::new(), 0.0),
    }
}

/// The same primitives, elsewhere.
fn moved(primitives: &Primitives, by: DVec3) -> Primitives {
    let place = |p: Vec3| (p.as_dvec3() + by).as_vec3();
    match primitives {
        Primitives::Triangles { positions, indices } => {
            let positions: Vec<Vec3> = positions.par_iter().map(|&p| place(p)).collect();
            Primitives::triangles(positions, Arc::clone(indices))
        }
        Primitives::Spheres(spheres) => {
            let sphere =
                |&[x, y, z, radius]: &[f32; 4]| place(Vec3::new(x, y, z)).extend(radius).to_array();
            let spheres: Vec<_> = spheres.as_slice().par_iter().map(sphere).collect();
            Primitives::spheres(Arc::new(spheres))
        }
        Primitives::Cylinders { cylinders, caps } => {
            let cylinder = |c: &Cylinder| Cylinder { from: place(c.from), to: place(c.to), ..*c };
            Primitives::cylinders(cylinders.par_iter().map(cylinder).collect::<Vec<_>>(), *caps)
        }
        Primitives::Plane(_) | Primitives::Solid(_) => primitives.clone(),
    }
}

/// The vector instructions asked for.
pub(crate) fn token(options: BuildOptions) -> Result<Token, BuildError> {
    let level = options.level_used()?;
    Token::of(level).ok_or(BuildError::NoSuchLevel(level))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Sphere;

    fn cloud(at: Vec3, stray: bool) -> Primitives {
        let place = |i: u32| at + Vec3::new((i % 7) as f32, (i % 11) as f32, (i % 13) as f32);
        let mut spheres: Vec<_> =
            (0..3000).map(|i| Sphere { center: place(i), radius: 0.25 }).collect();
        if stray {
            spheres[1500].center = Vec3::splat(-4e6);
        }
        Primitives::spheres(spheres)
    }

    #[test]
    fn an_object_far_from_its_origin_is_moved_to_its_middle_whatever_strays() {
        let at = Vec3::new(512_000.0, -40_960.0, 64.0);
        for stray in [false, true] {
            let cloud = cloud(at, stray);
            let tree = Tree::build(cloud.clone(), BuildOptions::default()).unwrap();
            let (Primitives::Spheres(before), Primitives::Spheres(after)) =
                (&cloud, tree.primitives())
            else {
                panic!("spheres stay spheres");
            };
            assert_eq!(tree.center() % 16.0, DVec3::ZERO, "{}", tree.center());
            assert!(after.get(7).center.abs().max_element() < 32.0, "{}", after.get(7).center);
            for (before, after) in before.iter().zip(after.iter()) {
                let there = after.center.as_dvec3() + tree.center();
                assert_eq!(there, before.center.as_dvec3(), "nothing is lost");
            }
        }
    }

    #[test]
    fn an_object_around_its_origin_shares_its_arrays() {
        let near = cloud(Vec3::new(100.0, -60.0, 3.0), false);
        let tree = Tree::build(near.clone(), BuildOptions::default()).unwrap();
        assert_eq!(tree.center(), DVec3::ZERO);
        let (Primitives::Spheres(before), Primitives::Spheres(after)) = (&near, tree.primitives())
        else {
            panic!("spheres stay spheres");
        };
        assert_eq!(before.as_slice().as_ptr(), after.as_slice().as_ptr());
    }
}
