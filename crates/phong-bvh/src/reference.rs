//! Brute force over every primitive of a tree: the oracle of tests and fuzzing.
//!
//! It knows nothing of trees, boxes, blocks or levels, and shares the scalar test of each primitive
//! with the kernels; so what the two return is equal bit for bit.

use crate::{
    Primitives, Tree,
    local::{Hit, Ray},
    primitives::{capsule, ray_frame::RayFrame, sphere, tapered::Tapered, triangle},
    traverse::Best,
};

/// The closest hit over all primitives of a tree, by trying each; planes, which are in no tree, excepted.
pub(crate) fn intersect(tree: &Tree, ray: &Ray) -> Hit {
    let prepared = Prepared::new(ray);
    let mut best = Best::new(ray.t_max);
    for (batch, &first) in tree.batches().iter().zip(tree.first()) {
        for local in 0..batch.len() as u32 {
            if let Some(Hit { t, u, v, .. }) = prepared.intersect(batch, local) {
                best.offer(t, first + local, u, v);
            }
        }
    }
    best.hit()
}

/// A ray prepared for the scalar test of every kind of primitive.
pub(crate) struct Prepared<'a> {
    ray: &'a Ray,
    shear: triangle::Shear,
    closest: sphere::Closest,
}

impl<'a> Prepared<'a> {
    pub(crate) fn new(ray: &'a Ray) -> Self {
        Self { ray, shear: triangle::Shear::new(ray), closest: sphere::Closest::new(ray) }
    }

    /// Where the ray meets one primitive of a batch, with the number that it has there. Planes, which
    /// are in no tree, are not met.
    pub(crate) fn intersect(&self, batch: &Primitives, local: u32) -> Option<Hit> {
        let at = |t: f32| Hit { t, prim: local, u: 0.0, v: 0.0 };
        match batch {
            Primitives::Triangles { positions, indices } => {
                let corners = indices[local as usize].map(|i| positions[i as usize]);
                if triangle::is_degenerate(corners) {
                    return None;
                }
                self.shear.intersect(corners).map(|[t, u, v]| Hit { u, v, ..at(t) })
            }
            Primitives::Spheres(spheres) => {
                self.closest.intersect(&spheres.get(local as usize)).map(at)
            }
            Primitives::Cylinders { cylinders, caps } => {
                let cylinder = &cylinders[local as usize];
                let met = if capsule::is_straight(cylinder) {
                    capsule::intersect(&RayFrame::new(self.ray), cylinder, *caps)
                } else {
                    Tapered::new(cylinder, *caps).intersect(self.ray)
                };
                met.map(|met| Hit { u: f32::from(u8::from(met.second_half)), ..at(met.t) })
            }
            Primitives::Plane(_) => None,
            Primitives::Solid(solid) => {
                solid.intersect(self.ray).map(|(t, [u, v])| Hit { u, v, ..at(t) })
            }
        }
    }
}
