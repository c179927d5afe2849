//! Who is right where ours and Embree's differ: every triangle against the ray, in f64.

use glam::DVec3;
use phong_bvh::{Primitives, Ray};

/// Judging takes every triangle: so many rays are enough.
pub(crate) const CASES: usize = 200;

/// Where a ray first meets a triangle; none: nowhere. Möller and Trumbore's way: of f32 numbers, its
/// products have no error to speak of in f64.
pub(crate) fn closest(geometry: &Primitives, ray: &Ray) -> Option<f64> {
    let Primitives::Triangles { positions, indices } = geometry else { return None };
    let (o, d) = (ray.origin, ray.dir.as_dvec3());
    let meet = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|i| positions[i as usize].as_dvec3());
        let (ab, ac, ao): (DVec3, DVec3, DVec3) = (b - a, c - a, o - a);
        let (p, q) = (d.cross(ac), ao.cross(ab));
        let det = ab.dot(p);
        let (u, v, t) = (ao.dot(p) / det, d.dot(q) / det, ac.dot(q) / det);
        let inside = u >= 0.0 && v >= 0.0 && u + v <= 1.0;
        (inside && f64::from(ray.t_min) < t && t < f64::from(ray.t_max)).then_some(t)
    };
    indices.iter().filter_map(meet).min_by(f64::total_cmp)
}
