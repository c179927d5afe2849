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

mod point;

use fearless_simd::{Simd, f64x4, prelude::*};
use glam::{DVec2, DVec3, Vec3};

use self::point::{
    Point, corners, flat, line, on_plane, on_sphere, rounded, sphere, triangle, unit,
};
use crate::{
    Bvh, Coordinates, Geometry, Hit, Kernel, Ray, Sphere, Surface,
    primitives::{ellipsoid, solid::Patch},
};

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
#[inline]
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
    let point = match &bvh.geometry()[index] {
        Geometry::Triangles { positions, indices } => {
            triangle(corners(positions, indices[local as usize]), hit.u.into(), hit.v.into())
        }
        Geometry::Spheres(spheres) => {
            let Sphere { center, radius } = spheres[local as usize];
            let (o, d) = line(ray);
            sphere(center.as_dvec3().to_array(), radius.into(), o, d, hit.t.into())
        }
        Geometry::Plane(plane) => {
            let (o, d) = line(ray);
            flat(plane, o, d)
        }
        Geometry::Solid(solid) => {
            let Patch { p, normal, curvature, .. } = solid.patch(ray, hit.t);
            let slack = f64::EPSILON * 64.0 * solid.largest();
            rounded(p.to_array(), unit(normal.to_array()), curvature, slack.to_array())
        }
    };
    let narrow = |v: [f64; 3]| DVec3::from_array(v).as_vec3();
    Surface { p: narrow(point.p), p_error: narrow(point.p_error), ng: narrow(point.ng) }
}

/// Eight surfaces side by side.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(align(32))]
pub struct Surfaces8 {
    /// [`Surface::p`]: x of each, y of each, z of each.
    pub p: [[f32; 8]; 3],
    /// [`Surface::p_error`].
    pub p_error: [[f32; 8]; 3],
    /// [`Surface::ng`].
    pub ng: [[f32; 8]; 3],
}

/// [`surface`] of up to eight rays, `of` being their numbers.
pub(crate) struct Surfaces<'a> {
    pub(crate) bvh: &'a Bvh,
    pub(crate) rays: &'a [Ray],
    pub(crate) hits: &'a [Hit],
    pub(crate) of: &'a [u32],
}

impl Kernel for Surfaces<'_> {
    type Output = Surfaces8;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> Surfaces8 {
        let Self { bvh, rays, hits, of } = self;
        let mut out = Surfaces8::default();
        let geometry = |of: u32| bvh.locate(hits[of as usize].prim).0;
        let Some(first) = of.first().map(|&of| geometry(of)) else { return out };
        let plain = !matches!(bvh.geometry()[first], Geometry::Solid(_));
        if !plain || of.iter().any(|&of| geometry(of) != first) {
            for (lane, &of) in of.iter().enumerate() {
                let Surface { p, p_error, ng } =
                    surface(bvh, &rays[of as usize], &hits[of as usize]);
                for axis in 0..3 {
                    out.p[axis][lane] = p[axis];
                    out.p_error[axis][lane] = p_error[axis];
                    out.ng[axis][lane] = ng[axis];
                }
            }
            return out;
        }
        let base = bvh.primitives(first).start;
        // The lanes beyond the last repeat it.
        let of = |lane: usize| of[lane.min(of.len() - 1)] as usize;
        let low = four(simd, &bvh.geometry()[first], base, rays, hits, of);
        let high = four(simd, &bvh.geometry()[first], base, rays, hits, |lane| of(lane + 4));
        for axis in 0..3 {
            out.p[axis] = low.p[axis].narrow(high.p[axis]).into();
            out.p_error[axis] = low.p_error[axis].narrow(high.p_error[axis]).into();
            out.ng[axis] = low.ng[axis].narrow(high.ng[axis]).into();
        }
        out
    }
}

/// The surfaces of four rays that met one geometry.
#[inline(always)]
fn four<S: Simd>(
    simd: S,
    geometry: &Geometry,
    base: u32,
    rays: &[Ray],
    hits: &[Hit],
    of: impl Fn(usize) -> usize,
) -> Point<f64x4<S>> {
    let [a, b, c, d] = [of(0), of(1), of(2), of(3)];
    let wide = |v: [f32; 4]| -> f64x4<S> {
        [f64::from(v[0]), f64::from(v[1]), f64::from(v[2]), f64::from(v[3])].simd_into(simd)
    };
    let wide3 = |a: Vec3, b: Vec3, c: Vec3, d: Vec3| {
        [wide([a.x, b.x, c.x, d.x]), wide([a.y, b.y, c.y, d.y]), wide([a.z, b.z, c.z, d.z])]
    };
    let local = |of: usize| (hits[of].prim - base) as usize;
    match geometry {
        Geometry::Triangles { positions, indices } => {
            let [ia, ib, ic, id] =
                [indices[local(a)], indices[local(b)], indices[local(c)], indices[local(d)]];
            let at = |i: u32| positions[i as usize];
            let corners = [
                wide3(at(ia[0]), at(ib[0]), at(ic[0]), at(id[0])),
                wide3(at(ia[1]), at(ib[1]), at(ic[1]), at(id[1])),
                wide3(at(ia[2]), at(ib[2]), at(ic[2]), at(id[2])),
            ];
            let u = wide([hits[a].u, hits[b].u, hits[c].u, hits[d].u]);
            let v = wide([hits[a].v, hits[b].v, hits[c].v, hits[d].v]);
            triangle(corners, u, v)
        }
        Geometry::Spheres(spheres) => {
            let [sa, sb, sc, sd] =
                [spheres[local(a)], spheres[local(b)], spheres[local(c)], spheres[local(d)]];
            let o = wide3(rays[a].origin, rays[b].origin, rays[c].origin, rays[d].origin);
            let d3 = wide3(rays[a].dir, rays[b].dir, rays[c].dir, rays[d].dir);
            let t = wide([hits[a].t, hits[b].t, hits[c].t, hits[d].t]);
            let center = wide3(sa.center, sb.center, sc.center, sd.center);
            sphere(center, wide([sa.radius, sb.radius, sc.radius, sd.radius]), o, d3, t)
        }
        Geometry::Plane(plane) => {
            let o = wide3(rays[a].origin, rays[b].origin, rays[c].origin, rays[d].origin);
            let d3 = wide3(rays[a].dir, rays[b].dir, rays[c].dir, rays[d].dir);
            flat(plane, o, d3)
        }
        Geometry::Solid(_) => unreachable!("solids are worked out one by one"),
    }
}

/// Where on its surface a hit of `ray` is.
pub(crate) fn coordinates(bvh: &Bvh, ray: &Ray, hit: &Hit) -> Coordinates {
    let (index, local) = bvh.locate(hit.prim);
    let (normal, tangent, uv) = match &bvh.geometry()[index] {
        Geometry::Triangles { positions, indices } => {
            let [a, b, c] = corners(positions, indices[local as usize]).map(DVec3::from_array);
            ((b - a).cross(c - a), b - a, DVec2::new(hit.u.into(), hit.v.into()))
        }
        Geometry::Spheres(spheres) => {
            let Sphere { center, radius } = spheres[local as usize];
            let (o, d) = line(ray);
            let center = center.as_dvec3().to_array();
            let normal = on_sphere(center, radius.into(), o, d, hit.t.into());
            let patch = ellipsoid::patch(DVec3::from_array(normal));
            (patch.normal, patch.tangent, patch.uv)
        }
        Geometry::Plane(plane) => {
            let [u, v] = plane.axes();
            let (o, d) = line(ray);
            let p = on_plane(plane.point.to_array(), plane.normal.to_array(), o, d);
            let from = DVec3::from_array(p) - plane.point;
            (plane.normal, u, DVec2::new(from.dot(u), from.dot(v)))
        }
        Geometry::Solid(solid) => {
            let patch = solid.patch(ray, hit.t);
            (patch.normal, patch.tangent, patch.uv)
        }
    };
    let ng = normal.normalize_or(DVec3::Z);
    let tangent = tangent - tangent.dot(ng) * ng;
    let tangent = tangent.try_normalize().unwrap_or_else(|| ng.any_orthonormal_vector());
    Coordinates { uv: uv.as_vec2(), tangent: tangent.as_vec3() }
}
