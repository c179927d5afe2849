//! How texture coordinates and normals change along a surface.

use glam::{DVec2, DVec3, Vec3};
use phong_bvh::{Canonical, Hit, Lanes, Primitives, Ray};

use super::Geometry;
use crate::math::lanes::dot;
use crate::math::wide as math;

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

    /// How much the normal of the surface at a hit turns along it, in radians a unit of the world, as the mean over all
    /// directions: above 0 where it is convex on the side of its geometric normal `ng`, 0 where it is flat, or of a kind
    /// of which this is not known.
    ///
    /// # Panics
    /// If `hit` is none.
    pub fn curvature(&self, hit: &Hit, ng: Vec3) -> f32 {
        let local = hit.prim as usize;
        let is_bulk = self.batch(hit.part).is_bulk();
        // Of what is written one by one, the tree has the numbers of the world.
        let ng = ng.as_dvec3();
        let up = if is_bulk { self.own_vector(hit, ng) } else { ng };
        let own = match self.world.primitives(hit.part) {
            Primitives::Spheres(spheres) => 1.0 / spheres.get(local).radius,
            Primitives::Cylinders { cylinders, .. } => 0.5 / cylinders[local].radius,
            Primitives::Triangles { positions, indices } => {
                let corners = indices[local].map(|i| positions[i as usize]);
                let normals = self.batch(hit.part).normals(hit.prim, indices[local]);
                normals.map_or(0.0, |normals| of_triangle(corners, normals, up.as_vec3()))
            }
            Primitives::Solid(solid) => {
                let [x, y, z] = solid.to_world.matrix3.to_cols_array_2d().map(DVec3::from);
                // What is not round is taken as the ball, or the pipe, of the same volume.
                return match solid.shape {
                    Canonical::Sphere => math::pow(x.cross(y).dot(z).abs(), -1.0 / 3.0) as f32,
                    Canonical::Cylinder { .. } => (0.5 / x.cross(y).length().sqrt()) as f32,
                    _ => 0.0,
                };
            }
            Primitives::Plane(_) => 0.0,
        };
        own * up.length() as f32
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
    let mut changes = [[area; 2]; 2];
    // A closure called twice would be compiled without the level's instructions.
    for (change, along) in changes.iter_mut().zip(along) {
        let (b, c) = (dot(ab, along), dot(ac, along));
        let [x, y] = [(cc * b - bc * c) / area, (bb * c - bc * b) / area];
        let (most, none) = (x.splat(f64::INFINITY), x.splat(0.0));
        let is_finite = x.abs().lt(most) & y.abs().lt(most);
        *change = [F::select(is_finite, x, none), F::select(is_finite, y, none)];
    }
    changes
}

/// The mean curvature that the normals at a triangle's corners stand for: how much they turn along its edges. Above 0
/// where it is convex on the side of `up`.
fn of_triangle(corners: [Vec3; 3], normals: [Vec3; 3], up: Vec3) -> f32 {
    let normals = normals.map(|n| if n.dot(up) < 0.0 { -n } else { n }.normalize_or_zero());
    let (mut turn, mut way) = (0.0, 0.0);
    for (i, k) in [(0, 1), (1, 2), (2, 0)] {
        let edge = corners[k] - corners[i];
        turn += edge.dot(normals[k] - normals[i]);
        way += edge.length_squared();
    }
    let curvature = turn / way;
    if curvature.is_finite() { curvature } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normals_of_a_ball_turn_by_one_over_its_radius() {
        let around = |u: f32, v: f32| Vec3::new(u, v, 1.0).normalize_or_zero();
        let normals = [around(0.0, 0.0), around(0.1, 0.0), around(0.0, 0.1)];
        let curvature = |radius: f32| of_triangle(normals.map(|n| radius * n), normals, Vec3::Z);
        assert!((curvature(4.0) - 0.25).abs() < 1e-4, "{}", curvature(4.0));
        let within = of_triangle(normals.map(|n| 4.0 * n), normals, -Vec3::Z);
        assert!((within + 0.25).abs() < 1e-4, "seen from within: {within}");
        assert_eq!(of_triangle(normals, [Vec3::Z; 3], Vec3::Z), 0.0);
        assert_eq!(of_triangle([Vec3::ONE; 3], normals, Vec3::Z), 0.0);
    }
}
