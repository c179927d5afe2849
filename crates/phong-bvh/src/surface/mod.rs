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

use std::ops::Range;

use fearless_simd::{Simd, f32x8, f64x4, mask32x8, prelude::*};
use glam::{DVec2, DVec3, Vec3};

use self::point::{
    Point, corners, flat, line, on_plane, on_sphere, rounded, sphere, triangle, unit,
};
use crate::{
    Bvh, Coordinates, Hit, Hits8, Kernel, Primitives, Ray, Rays8, Sphere, Surface, lanes,
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
        Primitives::Triangles { positions, indices } => {
            triangle(corners(positions, indices[local as usize]), hit.u.into(), hit.v.into())
        }
        Primitives::Spheres(spheres) => {
            let Sphere { center, radius } = spheres[local as usize];
            let (o, d) = line(ray);
            sphere(center.as_dvec3().to_array(), radius.into(), o, d, hit.t.into())
        }
        Primitives::Plane(plane) => {
            let (o, d) = line(ray);
            flat(plane, o, d)
        }
        Primitives::Solid(solid) => {
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

impl Surfaces8 {
    fn set(&mut self, lane: usize, Surface { p, p_error, ng }: Surface) {
        for axis in 0..3 {
            self.p[axis][lane] = p[axis];
            self.p_error[axis][lane] = p_error[axis];
            self.ng[axis][lane] = ng[axis];
        }
    }
}

/// [`surface`] of a bundle of eights.
pub(crate) struct Surfaces<'a> {
    pub(crate) bvh: &'a Bvh,
    pub(crate) rays: &'a [Rays8],
    pub(crate) hits: &'a [Hits8],
    pub(crate) out: &'a mut [Surfaces8],
}

impl Kernel for Surfaces<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { bvh, rays, hits, out } = self;
        let mut index = 0;
        for ((rays, hits), out) in rays.iter().zip(hits).zip(out) {
            let mut left = hits.met;
            while left != 0 {
                // Neighbours are mostly of one geometry.
                let first = hits.prim[left.trailing_zeros() as usize & 7];
                let range = bvh.primitives_around(&mut index, first);
                let same = left & within(&hits.prim, &range);
                left &= !same;
                match &bvh.geometry()[index] {
                    Primitives::Solid(_) => {
                        for lane in lanes(same) {
                            out.set(lane, surface(bvh, &rays.get(lane), &hits.get(lane)));
                        }
                    }
                    geometry => {
                        // The other lanes repeat the first.
                        let mut locals = [(first - range.start) as usize; 8];
                        for (lane, own) in locals.iter_mut().enumerate() {
                            if same >> lane & 1 != 0 {
                                *own = (hits.prim[lane] - range.start) as usize;
                            }
                        }
                        let met = eight(simd, geometry, &locals, rays, hits);
                        // What is in lanes without a hit is of no account.
                        let lanes = if same == hits.met { 0xff } else { same };
                        let same = mask32x8::from_bitmask(simd, lanes.into());
                        put(simd, &mut out.p, same, met.p);
                        put(simd, &mut out.p_error, same, met.p_error);
                        put(simd, &mut out.ng, same, met.ng);
                    }
                }
            }
        }
    }
}

/// The numbers that are in a range, a bit each.
#[inline(always)]
fn within(prim: &[u32; 8], range: &Range<u32>) -> u32 {
    let mut mask = 0;
    for (lane, &prim) in prim.iter().enumerate() {
        mask |= u32::from(prim.wrapping_sub(range.start) < range.end - range.start) << lane;
    }
    mask
}

#[inline(always)]
fn put<S: Simd>(simd: S, to: &mut [[f32; 8]; 3], lanes: mask32x8<S>, value: [f32x8<S>; 3]) {
    for axis in 0..3 {
        let old = f32x8::load_array_ref(simd, &to[axis]);
        lanes.select(value[axis], old).store_array(&mut to[axis]);
    }
}

/// The surfaces of eight rays that met primitives of one geometry.
#[inline(always)]
fn eight<S: Simd>(
    simd: S,
    geometry: &Primitives,
    locals: &[usize; 8],
    rays: &Rays8,
    hits: &Hits8,
) -> Point<f32x8<S>> {
    let load = |lanes: &[f32; 8]| f32x8::load_array_ref(simd, lanes).widen();
    let Rays8 { origin: [ox, oy, oz], dir: [dx, dy, dz], .. } = rays;
    let (ox, oy, oz) = (load(ox), load(oy), load(oz));
    let (dx, dy, dz) = (load(dx), load(dy), load(dz));
    let (low_o, high_o) = ([ox.0, oy.0, oz.0], [ox.1, oy.1, oz.1]);
    let (low_d, high_d) = ([dx.0, dy.0, dz.0], [dx.1, dy.1, dz.1]);
    let [a, b, c, d, e, f, g, h] = *locals;
    let (low, high) = match geometry {
        Primitives::Triangles { positions, indices } => {
            let (u, v) = (load(&hits.u), load(&hits.v));
            let four = |of| corners_of_four(simd, positions, indices, of);
            (triangle(four([a, b, c, d]), u.0, v.0), triangle(four([e, f, g, h]), u.1, v.1))
        }
        Primitives::Spheres(spheres) => {
            let t = load(&hits.t);
            let (center, radius) = four_spheres(simd, spheres, [a, b, c, d]);
            let low = sphere(center, radius, low_o, low_d, t.0);
            let (center, radius) = four_spheres(simd, spheres, [e, f, g, h]);
            (low, sphere(center, radius, high_o, high_d, t.1))
        }
        Primitives::Plane(plane) => (flat(plane, low_o, low_d), flat(plane, high_o, high_d)),
        Primitives::Solid(_) => unreachable!("solids are worked out one by one"),
    };
    let join = |l: [f64x4<S>; 3], h: [f64x4<S>; 3]| -> [f32x8<S>; 3] {
        [l[0].narrow(h[0]), l[1].narrow(h[1]), l[2].narrow(h[2])]
    };
    Point {
        p: join(low.p, high.p),
        p_error: join(low.p_error, high.p_error),
        ng: join(low.ng, high.ng),
    }
}

#[inline(always)]
fn wide<S: Simd>(simd: S, v: [f32; 4]) -> f64x4<S> {
    [f64::from(v[0]), f64::from(v[1]), f64::from(v[2]), f64::from(v[3])].simd_into(simd)
}

#[inline(always)]
fn wide3<S: Simd>(simd: S, [a, b, c, d]: [Vec3; 4]) -> [f64x4<S>; 3] {
    [
        wide(simd, [a.x, b.x, c.x, d.x]),
        wide(simd, [a.y, b.y, c.y, d.y]),
        wide(simd, [a.z, b.z, c.z, d.z]),
    ]
}

#[inline(always)]
fn four_spheres<S: Simd>(
    simd: S,
    spheres: &[Sphere],
    [a, b, c, d]: [usize; 4],
) -> ([f64x4<S>; 3], f64x4<S>) {
    let [a, b, c, d] = [spheres[a], spheres[b], spheres[c], spheres[d]];
    let center = wide3(simd, [a.center, b.center, c.center, d.center]);
    (center, wide(simd, [a.radius, b.radius, c.radius, d.radius]))
}

#[inline(always)]
fn corners_of_four<S: Simd>(
    simd: S,
    positions: &[Vec3],
    indices: &[[u32; 3]],
    [a, b, c, d]: [usize; 4],
) -> [[f64x4<S>; 3]; 3] {
    let [a, b, c, d] = [indices[a], indices[b], indices[c], indices[d]];
    let at = |i: u32| positions[i as usize];
    [
        wide3(simd, [at(a[0]), at(b[0]), at(c[0]), at(d[0])]),
        wide3(simd, [at(a[1]), at(b[1]), at(c[1]), at(d[1])]),
        wide3(simd, [at(a[2]), at(b[2]), at(c[2]), at(d[2])]),
    ]
}

/// Where on its surface a hit of `ray` is.
pub(crate) fn coordinates(bvh: &Bvh, ray: &Ray, hit: &Hit) -> Coordinates {
    let (index, local) = bvh.locate(hit.prim);
    let (normal, tangent, uv) = match &bvh.geometry()[index] {
        Primitives::Triangles { positions, indices } => {
            let [a, b, c] = corners(positions, indices[local as usize]).map(DVec3::from_array);
            ((b - a).cross(c - a), b - a, DVec2::new(hit.u.into(), hit.v.into()))
        }
        Primitives::Spheres(spheres) => {
            let Sphere { center, radius } = spheres[local as usize];
            let (o, d) = line(ray);
            let center = center.as_dvec3().to_array();
            let normal = on_sphere(center, radius.into(), o, d, hit.t.into());
            let patch = ellipsoid::patch(DVec3::from_array(normal));
            (patch.normal, patch.tangent, patch.uv)
        }
        Primitives::Plane(plane) => {
            let [u, v] = plane.axes();
            let (o, d) = line(ray);
            let p = on_plane(plane.point.to_array(), plane.normal.to_array(), o, d);
            let from = DVec3::from_array(p) - plane.point;
            (plane.normal, u, DVec2::new(from.dot(u), from.dot(v)))
        }
        Primitives::Solid(solid) => {
            let patch = solid.patch(ray, hit.t);
            (patch.normal, patch.tangent, patch.uv)
        }
    };
    let ng = normal.normalize_or(DVec3::Z);
    let tangent = tangent - tangent.dot(ng) * ng;
    let tangent = tangent.try_normalize().unwrap_or_else(|| ng.any_orthonormal_vector());
    Coordinates { uv: uv.as_vec2(), tangent: tangent.as_vec3() }
}
