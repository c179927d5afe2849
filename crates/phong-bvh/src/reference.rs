//! Brute force over every primitive: the oracle of tests and fuzzing.

use glam::{DVec3, Vec2, Vec3};

use crate::{Bvh, Geometry, Hit, Ray, Surface};

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
        Geometry::Plane(plane) => {
            let t = (plane.point - o).dot(plane.normal) / d.dot(plane.normal);
            if t.is_finite() && inside(t) { hit(t, 0.0, 0.0) } else { Hit::NONE }
        }
        Geometry::Solid(_) => Hit::NONE,
    }
}

/// The surface at a hit.
pub(crate) fn surface(bvh: &Bvh, ray: &Ray, hit: &Hit) -> Surface {
    let (index, local) = bvh.locate(hit.prim);
    let (p, ng) = match &bvh.geometry()[index] {
        Geometry::Triangles { positions, indices } => {
            let [a, b, c] = indices[local as usize].map(|i| positions[i as usize].as_dvec3());
            let (u, v) = (f64::from(hit.u), f64::from(hit.v));
            (a + u * (b - a) + v * (c - a), (b - a).cross(c - a))
        }
        Geometry::Spheres(spheres) => {
            let s = spheres[local as usize];
            let c = s.center.as_dvec3();
            let n = (ray.origin.as_dvec3() + f64::from(hit.t) * ray.dir.as_dvec3() - c)
                .normalize_or(DVec3::Z);
            (c + f64::from(s.radius) * n, n)
        }
        Geometry::Plane(plane) => {
            let p = ray.origin.as_dvec3() + f64::from(hit.t) * ray.dir.as_dvec3();
            (p - (p - plane.point).dot(plane.normal) * plane.normal, plane.normal)
        }
        Geometry::Solid(_) => (DVec3::ZERO, DVec3::Z),
    };
    let ng = ng.normalize_or(DVec3::Z).as_vec3();
    Surface {
        p: p.as_vec3(),
        p_error: p.as_vec3().abs() * 3e-7 + Vec3::splat(1e-7 * hit.t),
        ng,
        tangent: ng.any_orthonormal_vector(),
        uv: Vec2::new(hit.u, hit.v),
    }
}
