//! The trees of meshes, clouds and bundles of cylinders, each built once for all objects that share its arrays.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::Vec3;
use phong_bvh::{BuildError, BuildOptions, Cylinder, Primitives, Tree};
use phong_scene::{Caps, Shared};
use rayon::prelude::*;

/// Trees by the addresses of the arrays that they are built of, or one address and what ends look like.
#[derive(Clone, Debug, Default)]
pub(super) struct Trees(BTreeMap<[usize; 2], Entry>);

/// A tree, with references to its arrays: as long as they are held, nothing else has their address.
#[derive(Clone, Debug)]
struct Entry {
    #[expect(dead_code, reason = "held so that nothing else gets the arrays' addresses")]
    arrays: Arrays,
    tree: Arc<Tree>,
}

/// What a tree is built of.
#[derive(Clone, Debug)]
pub(super) enum Arrays {
    /// Positions and indices.
    Triangles(Shared<Vec3>, Shared<[u32; 3]>),
    /// Centre and radius of each.
    Spheres(Shared<[f32; 4]>),
    /// The two ends of each, and what they look like.
    Cylinders(Shared<[[f32; 4]; 2]>, Caps),
}

impl Arrays {
    fn addresses(&self) -> [usize; 2] {
        match self {
            Self::Triangles(positions, indices) => {
                [Shared::address(positions), Shared::address(indices)]
            }
            Self::Spheres(spheres) => [Shared::address(spheres), 0],
            // Below any address.
            Self::Cylinders(segments, caps) => [Shared::address(segments), *caps as usize],
        }
    }

    fn primitives(&self) -> Primitives {
        match self {
            Self::Triangles(positions, indices) => {
                Primitives::triangles(positions.to_arc(), indices.to_arc())
            }
            Self::Spheres(spheres) => Primitives::spheres(spheres.to_arc()),
            Self::Cylinders(segments, caps) => {
                let cylinder = |&[from, to]: &[[f32; 4]; 2]| Cylinder {
                    from: Vec3::new(from[0], from[1], from[2]),
                    radius: from[3],
                    to: Vec3::new(to[0], to[1], to[2]),
                    radius_to: to[3],
                };
                let caps = match caps {
                    Caps::Round => phong_bvh::Caps::Round,
                    Caps::Flat => phong_bvh::Caps::Flat,
                    Caps::Open => phong_bvh::Caps::Open,
                };
                let cylinders: Vec<_> =
                    segments.par_iter().with_min_len(1 << 12).map(cylinder).collect();
                Primitives::cylinders(cylinders, caps)
            }
        }
    }
}

impl Trees {
    /// The tree of some arrays: one that is here or was in `earlier`, else a new one.
    pub(super) fn get(
        &mut self,
        arrays: Arrays,
        earlier: &Self,
        options: BuildOptions,
    ) -> Result<Arc<Tree>, BuildError> {
        let key = arrays.addresses();
        if let Some(Entry { tree, .. }) = self.0.get(&key) {
            return Ok(Arc::clone(tree));
        }
        let entry = if let Some(entry) = earlier.0.get(&key) {
            entry.clone()
        } else {
            let tree = Arc::new(Tree::build(arrays.primitives(), options)?);
            Entry { arrays, tree }
        };
        let tree = Arc::clone(&entry.tree);
        self.0.insert(key, entry);
        Ok(tree)
    }

    /// How many there are.
    pub(super) fn len(&self) -> usize {
        self.0.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle() -> Arrays {
        Arrays::Triangles([Vec3::ZERO, Vec3::X, Vec3::Y].into(), [[0, 1, 2]].into())
    }

    #[test]
    fn the_same_arrays_have_one_tree_and_equal_ones_do_not() {
        let (arrays, earlier) = (triangle(), Trees::default());
        let options = BuildOptions::default();
        let mut trees = Trees::default();
        let mut get = |arrays: &Arrays| trees.get(arrays.clone(), &earlier, options).unwrap();
        assert!(Arc::ptr_eq(&get(&arrays), &get(&arrays)));
        assert!(!Arc::ptr_eq(&get(&arrays), &get(&triangle())));
        assert_eq!(trees.len(), 2);
    }

    #[test]
    fn a_tree_of_spheres_holds_the_very_array_that_it_is_made_of() {
        let spheres: Shared<[f32; 4]> = [[1.0, 2.0, 3.0, 0.5], [0.0, 0.0, 0.0, 1.0]].into();
        let (earlier, options) = (Trees::default(), BuildOptions::default());
        let arrays = Arrays::Spheres(spheres.clone());
        let tree = Trees::default().get(arrays, &earlier, options).unwrap();
        let Primitives::Spheres(held) = tree.primitives() else { panic!("spheres stay spheres") };
        assert_eq!(held.as_slice().as_ptr(), spheres.as_ptr());
        assert_eq!(held.get(0).radius, 0.5);
    }

    #[test]
    fn an_earlier_tree_is_taken_over_as_long_as_its_arrays_are_the_same() {
        let (arrays, options) = (triangle(), BuildOptions::default());
        let mut earlier = Trees::default();
        let tree = earlier.get(arrays.clone(), &Trees::default(), options).unwrap();
        let mut trees = Trees::default();
        assert!(Arc::ptr_eq(&tree, &trees.get(arrays, &earlier, options).unwrap()));
        assert!(!Arc::ptr_eq(&tree, &trees.get(triangle(), &earlier, options).unwrap()));
    }
}
