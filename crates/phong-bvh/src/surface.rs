//! The surface at a hit, and the way off it.
//!
//! Everything is solved again in f64, from the ray as it is in f32, and put back *onto* the surface.
//! So `p` is a point of the surface rounded to f32, and all that `p_error` must cover is that
//! rounding, and the rounding of the f32 kernels that will test the next ray against the very
//! same surface: a ray that starts nearer than a kernel can tell would hit what it leaves.
//!
//! | kind | u, v |
//! |---|---|
//! | triangle | barycentric weights of the second and third corner |
//! | sphere, ellipsoid | longitude / 2π from x towards y, latitude from 0 at −z to 1 at +z |
//! | plane | distance from `point` along its axes, not wrapped: x as far as it lies in the plane (else y), and what completes the right-handed frame |
//! | disc, cap | (x + 1)/2, (y + 1)/2 over the radius |
//! | box | 0…1 along the two axes after the face's own, against the first on a lower face |
//! | cylinder, cone | angle / 2π from x towards y, z |
//! | torus | angle / 2π around the axis, angle / 2π around the tube from the outermost circle up |
//!
//! (x, y and z are the solid's own; spheres are not turned.)

use glam::{DVec2, DVec3, Vec3};

use crate::{
    Bvh, Geometry, Hit, Ray, Sphere, Surface,
    primitives::{ellipsoid, solid::Patch},
};

/// What rounding to f32 changes at most, relative: half of ε, and a trifle for rounding the bound.
const ROUNDING: f64 = 0.500_001 * f32::EPSILON as f64;

/// Where to start a ray that leaves the surface at `p` towards `dir`: beyond the error of `p`, on
/// the side of `ng` that `dir` points to.
///
/// The true point is within the box `p ± p_error`; moved along ±`ng` by `|ng| · p_error`, the box
/// lies wholly on that side of the tangent plane. Each coordinate is then rounded away from `p`.
/// (Pharr, Jakob, Humphreys, *Physically Based Rendering*, 4th ed., section 6.8.6.)
///
/// ```
/// use glam::Vec3;
/// use phong_bvh::offset_origin;
///
/// let (p, error) = (Vec3::new(3.0, 4.0, 5.0), Vec3::splat(1e-6));
/// let up = offset_origin(p, error, Vec3::Z, Vec3::new(0.6, 0.0, 0.8));
/// assert!(up.z > 5.000_001 && up.truncate() == p.truncate());
/// assert!(offset_origin(p, error, Vec3::Z, Vec3::NEG_Z).z < 4.999_999);
/// ```
pub fn offset_origin(p: Vec3, p_error: Vec3, ng: Vec3, dir: Vec3) -> Vec3 {
    let side = if dir.dot(ng) < 0.0 { -ng } else { ng };
    let offset = ng.abs().dot(p_error) * side;
    let away = |p: f32, offset: f32| match p + offset {
        moved if offset > 0.0 => moved.next_up(),
        moved if offset < 0.0 => moved.next_down(),
        still => still,
    };
    Vec3::new(away(p.x, offset.x), away(p.y, offset.y), away(p.z, offset.z))
}

/// The surface at a hit of `ray`.
pub(crate) fn surface(bvh: &Bvh, ray: &Ray, hit: &Hit) -> Surface {
    let (index, local) = bvh.locate(hit.prim);
    match &bvh.geometry()[index] {
        Geometry::Triangles { positions, indices } => {
            let corners = indices[local as usize].map(|i| positions[i as usize].as_dvec3());
            triangle(corners, hit)
        }
        Geometry::Spheres(spheres) => sphere(&spheres[local as usize], ray, hit.t),
        Geometry::Plane(plane) => {
            let (o, d) = (ray.origin.as_dvec3(), ray.dir.as_dvec3());
            let p = o + plane.solve(ray) * d;
            let p = p - (p - plane.point).dot(plane.normal) * plane.normal;
            let [u, v] = plane.axes();
            let (normal, from) = (plane.normal, p - plane.point);
            let uv = DVec2::new(from.dot(u), from.dot(v));
            // The plane's own numbers round in f64 only.
            let patch = Patch { p, normal, tangent: u, uv, curvature: 0.0 };
            facing(patch, f64::EPSILON * 8.0 * plane.point.abs())
        }
        Geometry::Solid(solid) => {
            facing(solid.patch(ray, hit.t), f64::EPSILON * 64.0 * solid.largest())
        }
    }
}

/// Interpolates in f64, so the point is in the triangle's plane whatever the rounding of u and v.
///
/// The kernel takes the corners relative to the ray's origin, and shears them. Of each coordinate
/// so made up to six roundings are relative to how far the corners are, along any axis.
fn triangle([a, b, c]: [DVec3; 3], hit: &Hit) -> Surface {
    let (u, v) = (f64::from(hit.u), f64::from(hit.v));
    let (ab, ac) = (b - a, c - a);
    let p = a + u * ab + v * ac;
    let far = (a - p).abs().max((b - p).abs()).max((c - p).abs());
    let patch =
        Patch { p, normal: ab.cross(ac), tangent: ab, uv: DVec2::new(u, v), curvature: 0.0 };
    facing(patch, DVec3::splat(8.0 * ROUNDING * far.max_element()))
}

/// Of the two points where the line of the ray meets the sphere the one nearer to the hit; where
/// rounding takes the line past the sphere, the nearest of the sphere.
fn sphere(sphere: &Sphere, ray: &Ray, t: f32) -> Surface {
    let (center, radius) = (sphere.center.as_dvec3(), f64::from(sphere.radius));
    let (o, d) = (ray.origin.as_dvec3() - center, ray.dir.as_dvec3());
    let middle = -o.dot(d) / d.length_squared();
    let off = o + middle * d;
    let half = ((radius * radius - off.length_squared()).max(0.0) / d.length_squared()).sqrt();
    let reach = if f64::from(t) > middle { half } else { -half };
    let patch = ellipsoid::patch(off + reach * d);
    let world = Patch { p: center + radius * patch.p, curvature: 1.0 / radius, ..patch };
    facing(world, DVec3::splat(16.0 * ROUNDING * radius))
}

/// A patch in the world's space rounded to a surface, given how far the next ray must keep off
/// besides what rounding `p` costs.
///
/// Rounding moves `p` along the surface as well, and so does rounding away from it, by as much as
/// two roundings more; and a curved surface bends away below: by `e² κ / 2`. That matters to rays
/// going in, on small shapes far from the world's origin.
fn facing(patch: Patch, slack: DVec3) -> Surface {
    let ng = patch.normal.normalize_or(DVec3::Z);
    let tangent = patch.tangent - patch.tangent.dot(ng) * ng;
    let tangent = tangent.try_normalize().unwrap_or_else(|| ng.any_orthonormal_vector());
    let rounding = ROUNDING * patch.p.abs();
    let along = (3.0 * rounding).length();
    let bend = (0.5 * patch.curvature * along * along).min(along);
    Surface {
        p: patch.p.as_vec3(),
        p_error: (rounding + bend + slack).as_vec3(),
        ng: ng.as_vec3(),
        tangent: tangent.as_vec3(),
        uv: patch.uv.as_vec2(),
    }
}
