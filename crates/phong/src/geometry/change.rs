//! How texture coordinates change along a surface.

use glam::{DVec2, DVec3};
use phong_bvh::{Canonical, Hit, Lanes, Primitives, Ray};

use super::Geometry;
use crate::math::lanes::dot;

/// How much of a step is taken where the change is measured: it is not the same all over the surface.
const STEP: f64 = 1.0 / 16.0;

impl Geometry {
    /// A vector of the world in the own space of the object hit, as [`Geometry::own_point`] has points.
    ///
    /// # Panics
    /// If `hit` is none.
    pub fn own_vector(&self, hit: &Hit, world: DVec3) -> DVec3 {
        self.own_space(self.object(hit)).map_or(world, |space| space.transform_vector3(world))
    }

    /// How the texture coordinates change along two vectors that are tangent to the surface at a hit of `ray`.
    ///
    /// # Panics
    /// If `hit` is none.
    pub fn uv_changes(&self, ray: &Ray, hit: &Hit, along: [DVec3; 2]) -> [DVec2; 2] {
        let Some([a, b]) = self.weights_changes(hit, along) else {
            return self.measured(ray, hit, along);
        };
        let corners = self.corners(hit.part, hit.prim);
        match corners.and_then(|corners| self.batch(hit.part).uv_edges(hit.prim, corners)) {
            Some([ab, ac]) => [a, b].map(|change| change.x * ab + change.y * ac),
            None => [a, b],
        }
    }

    /// How the weights of a triangle's second and third corner change along two vectors; `None`: it is none.
    fn weights_changes(&self, hit: &Hit, along: [DVec3; 2]) -> Option<[DVec2; 2]> {
        match self.world.primitives(hit.part) {
            Primitives::Triangles { positions, indices } => {
                let at = |i: u32| positions[i as usize].as_dvec3();
                let [a, b, c] = indices[hit.prim as usize].map(at);
                let edges = [(b - a).to_array(), (c - a).to_array()];
                let along = if self.batch(hit.part).is_bulk() {
                    along.map(|along| self.own_vector(hit, along))
                } else {
                    along
                };
                Some(
                    weights_changes(edges, along.map(|along| along.to_array()))
                        .map(DVec2::from_array),
                )
            }
            Primitives::Solid(solid) if solid.shape == Canonical::Triangle => {
                let to_own = solid.to_world.matrix3.inverse();
                Some(along.map(|along| {
                    let change = (to_own * along).truncate();
                    if change.is_finite() { change } else { DVec2::ZERO }
                }))
            }
            _ => None,
        }
    }

    /// The change measured: by rays that meet the surface a little further on.
    fn measured(&self, ray: &Ray, hit: &Hit, along: [DVec3; 2]) -> [DVec2; 2] {
        let here = self.coordinates(ray, hit).uv.as_dvec2();
        let is_plane = matches!(self.world.primitives(hit.part), Primitives::Plane(_));
        along.map(|along| {
            let beside = Ray { origin: ray.origin + STEP * along, ..*ray };
            let change = self.coordinates(&beside, hit).uv.as_dvec2() - here;
            // Around what is round, 1 is 0 again.
            let change = if is_plane { change } else { change - change.round() };
            if change.is_finite() { change / STEP } else { DVec2::ZERO }
        })
    }
}

/// How the weights of a triangle's second and third corner change along two vectors: 0 where that is not finite.
/// `edges` lead to these corners from the first.
#[inline(always)]
pub(crate) fn weights_changes<F: Lanes<Scalar = f64>>(
    [ab, ac]: [[F; 3]; 2],
    along: [[F; 3]; 2],
) -> [[F; 2]; 2] {
    let (bb, bc, cc) = (dot(ab, ab), dot(ab, ac), dot(ac, ac));
    let area = bb * cc - bc * bc;
    let change = |along: [F; 3]| {
        let (b, c) = (dot(ab, along), dot(ac, along));
        let [x, y] = [(cc * b - bc * c) / area, (bb * c - bc * b) / area];
        let (most, none) = (x.splat(f64::INFINITY), x.splat(0.0));
        let is_finite = x.abs().lt(most) & y.abs().lt(most);
        [F::select(is_finite, x, none), F::select(is_finite, y, none)]
    };
    let [a, b] = along;
    [change(a), change(b)]
}
