//! Brute force over every primitive of a tree: the oracle of tests and fuzzing.
//!
//! It knows nothing of trees, boxes, blocks or levels, and shares the scalar test of each primitive
//! with the kernels; so what the two return is equal bit for bit.

use crate::{
    Primitives, Tree,
    local::{Hit, Ray},
    primitives::{capsule, sphere, tapered::Tapered, triangle},
    traverse::Best,
};

/// The closest hit over all primitives of a tree, by trying each; planes, which are in no tree, excepted.
pub(crate) fn intersect(tree: &Tree, ray: &Ray) -> Hit {
    let shear = triangle::Shear::new(ray);
    let closest = sphere::Closest::new(ray);
    let mut best = Best::new(ray.t_max);
    for (batch, &first) in tree.batches().iter().zip(tree.first()) {
        match batch {
            Primitives::Triangles { positions, indices } => {
                for (prim, corners) in (first..).zip(&**indices) {
                    let corners = corners.map(|i| positions[i as usize]);
                    if !triangle::is_degenerate(corners)
                        && let Some([t, u, v]) = shear.intersect(corners)
                    {
                        best.offer(t, prim, u, v);
                    }
                }
            }
            Primitives::Spheres(spheres) => {
                for (prim, sphere) in (first..).zip(&**spheres) {
                    if let Some(t) = closest.intersect(sphere) {
                        best.offer(t, prim, 0.0, 0.0);
                    }
                }
            }
            Primitives::Cylinders { cylinders, caps } => {
                for (prim, cylinder) in (first..).zip(cylinders.iter()) {
                    let at = if capsule::is_capsule(cylinder, *caps) {
                        capsule::intersect(&closest, cylinder)
                    } else {
                        Tapered::new(cylinder, *caps).intersect(ray)
                    };
                    if let Some(at) = at {
                        best.offer_cylinder(at, prim);
                    }
                }
            }
            Primitives::Plane(_) => {}
            Primitives::Solid(solid) => {
                if let Some(t) = solid.intersect(ray) {
                    best.offer(t, first, 0.0, 0.0);
                }
            }
        }
    }
    best.hit()
}
