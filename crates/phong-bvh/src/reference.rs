//! Brute force over every primitive: the oracle of tests and fuzzing.
//!
//! It knows nothing of trees, boxes, blocks or levels, and shares the scalar test of each primitive
//! with the kernels; so what the two return is equal bit for bit.

use crate::{
    Bvh, Hit, Primitives, Ray,
    primitives::{sphere, triangle},
    traverse::Best,
};

/// The closest hit over all primitives, by trying each.
pub(crate) fn intersect(bvh: &Bvh, ray: &Ray) -> Hit {
    let shear = triangle::Shear::new(ray);
    let closest = sphere::Closest::new(ray);
    let mut best = Best::new(ray.t_max);
    for (index, geometry) in bvh.geometry().iter().enumerate() {
        let first = bvh.primitives(index).start;
        match geometry {
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
            Primitives::Plane(plane) => {
                if let Some(t) = plane.intersect(ray) {
                    best.offer(t, first, 0.0, 0.0);
                }
            }
            Primitives::Solid(solid) => {
                if let Some(t) = solid.intersect(ray) {
                    best.offer(t, first, 0.0, 0.0);
                }
            }
        }
    }
    best.hit()
}
