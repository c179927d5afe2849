//! Brute force over every primitive: the oracle of tests and fuzzing.

use crate::{Bvh, Geometry, Hit, Ray};

/// The closest hit over all primitives, by trying each.
pub(crate) fn intersect(bvh: &Bvh, ray: &Ray) -> Hit {
    let mut best = Hit::NONE;
    for (index, geometry) in bvh.geometry().iter().enumerate() {
        let first = bvh.primitives(index).start;
        for local in 0..geometry.len() {
            let hit = one(geometry, local, ray);
            if hit.is_some() && hit.t < best.t {
                best = Hit { prim: first + local as u32, ..hit };
            }
        }
    }
    best
}

fn one(geometry: &Geometry, local: usize, ray: &Ray) -> Hit {
    let (o, d) = (ray.origin.as_dvec3(), ray.dir.as_dvec3());
    let inside = |t: f64| (t as f32) > ray.t_min && (t as f32) < ray.t_max;
    let hit = |t: f64, u: f64, v: f64| Hit { t: t as f32, prim: 0, u: u as f32, v: v as f32 };
    let exact = |t: f32| Hit { t, prim: 0, ..Hit::NONE };
    match geometry {
        Geometry::Triangles { positions, indices } => {
            let [a, b, c] = indices[local].map(|i| positions[i as usize].as_dvec3());
            let (ab, ac) = (b - a, c - a);
            let q = d.cross(ac);
            let det = ab.dot(q);
            if det == 0.0 {
                return Hit::NONE;
            }
            let s = o - a;
            let u = s.dot(q) / det;
            let w = s.cross(ab);
            let v = d.dot(w) / det;
            let t = ac.dot(w) / det;
            if u >= 0.0 && v >= 0.0 && u + v <= 1.0 && inside(t) { hit(t, u, v) } else { Hit::NONE }
        }
        Geometry::Spheres(spheres) => {
            let s = spheres[local];
            let oc = s.center.as_dvec3() - o;
            let b = oc.dot(d) / d.length_squared();
            let away = (oc - b * d).length_squared();
            let r = f64::from(s.radius);
            if away > r * r {
                return Hit::NONE;
            }
            let half = ((r * r - away) / d.length_squared()).sqrt();
            [b - half, b + half]
                .into_iter()
                .find(|&t| inside(t))
                .map_or(Hit::NONE, |t| hit(t, 0.0, 0.0))
        }
        Geometry::Plane(plane) => plane.intersect(ray).map_or(Hit::NONE, exact),
        Geometry::Solid(solid) => solid.intersect(ray).map_or(Hit::NONE, exact),
    }
}
