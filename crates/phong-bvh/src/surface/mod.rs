//! The surface at a hit, and the way off it.
//!
//! Everything is solved again in f64, in the part's own space, from the ray as it is there in f32, and put
//! back *onto* the surface. So `p` is a point of the surface rounded to f32 there, and all that `p_error`
//! must cover is that rounding, the way into the world and back, and the rounding of the f32 kernels that
//! will test the next ray against the very same surface: a ray that starts nearer than a kernel can tell
//! would hit what it leaves.
//!
//! | kind | u, v |
//! |---|---|
//! | triangle | barycentric weights of the second and third corner |
//! | sphere, ellipsoid | longitude / 2π from x towards y, latitude from 0 at −z to 1 at +z |
//! | plane | distance from `point` along its axes, not wrapped: x as far as it lies in the plane (else y), and what completes the right-handed frame |
//! | triangle among solids | weights of its second and third corner |
//! | disc, cap | (x + 1)/2, (y + 1)/2 over the radius |
//! | box | 0…1 along the two axes after the face's own, against the first on a lower face |
//! | cylinder, cone | angle / 2π from x towards y, z |
//! | cylinder of a bundle | the same; with round ends v is that of the foot on the axis, 0 or 1 beyond the ends |
//! | torus | angle / 2π around the axis, angle / 2π around the tube from the outermost circle up |
//!
//! (x, y and z are the solid's own; spheres are not turned.)

mod offset;
mod point;

pub use offset::{offset_origin, offset_origins, offset_sides};

use fearless_simd::{Simd, f32x8, f64x4, mask32x8, mask64x4, prelude::*, u32x8};
use glam::{DVec2, DVec3, Vec3};

use self::offset::is_coarse;
use self::point::{
    Capsule, Point, capsule, corners, flat, line, on_capsule, on_plane, on_sphere, rounded, sphere,
    triangle,
};
use crate::{
    Coordinates, Cylinder, Hit, Hits8, Kernel, Primitives, Ray, Rays8, Sphere, Spheres, Surface,
    eights::{halves, whole},
    frame::{Frame, ROUNDING, Way, unit, wide as wide8},
    lanes, local,
    primitives::{
        capsule::{self, half, is_capsule, is_straight},
        ellipsoid,
        patch::{Patch, turn},
        ray_frame::RayFrame,
        sphere::Closest,
        tapered::{self, Tapered},
    },
};

/// What knows all parts of a world.
pub(crate) trait Places {
    /// The primitives of a part, and where it stands.
    fn place(&self, part: u32) -> (&Primitives, &Frame);
}

/// The surface at a hit of `ray`.
pub(crate) fn surface(world: &impl Places, ray: &Ray, hit: &Hit) -> Surface {
    let (primitives, frame) = world.place(hit.part);
    let (ray, way) = frame.ray(ray);
    let (t, local) = (distance(primitives, &ray, way, hit), hit.prim as usize);
    let Point { p, p_error, ng } = match primitives {
        Primitives::Triangles { positions, indices } => {
            triangle(corners(positions, indices[local]), hit.u.into(), hit.v.into())
        }
        Primitives::Spheres(spheres) => {
            let Sphere { center, radius } = spheres.get(local);
            let (o, d) = line(&ray);
            sphere(center.as_dvec3().to_array(), radius.into(), o, d, t.into())
        }
        Primitives::Cylinders { cylinders, caps } => {
            let cylinder = &cylinders[local];
            if is_capsule(cylinder, *caps) {
                let (o, d) = line(&ray);
                capsule(one_capsule(cylinder), o, d, t.into())
            } else {
                let tapered = Tapered::new(cylinder, *caps);
                let Patch { p, normal, curvature, .. } = tapered.patch(&ray, t);
                let slack = f64::EPSILON * 64.0 * tapered.largest() + kernel_slack(cylinder);
                rounded(p.to_array(), unit(normal.to_array()), curvature, slack.to_array())
            }
        }
        Primitives::Plane(plane) => {
            let (o, d) = line(&ray);
            flat(plane, o, d)
        }
        Primitives::Solid(solid) => {
            let Patch { p, normal, curvature, .. } = solid.patch(&ray, t);
            let slack = f64::EPSILON * 64.0 * solid.largest();
            rounded(p.to_array(), unit(normal.to_array()), curvature, slack.to_array())
        }
    };
    let p = p.map(|x| f64::from(x as f32));
    let [p, p_error, ng] = frame.leave([p, p_error, ng]).map(DVec3::from_array);
    Surface { p, p_error: p_error.as_vec3(), ng: ng.as_vec3() }
}

/// How far the kernel in f32 may take a cylinder for elsewhere, as for capsules; 0 where it is met in f64.
fn kernel_slack(cylinder: &Cylinder) -> f64 {
    let length = cylinder.from.as_dvec3().distance(cylinder.to.as_dvec3());
    let size = length + f64::from(cylinder.radius);
    if is_straight(cylinder) { size * (16.0 * ROUNDING) } else { 0.0 }
}

/// How far along its ray in the part's space a hit is. Where the ray was moved along, its own distance is
/// rounded too coarsely to tell the near side of a thing from the far one, so it is looked for again.
fn distance(primitives: &Primitives, ray: &local::Ray, way: Way<f64>, hit: &Hit) -> f32 {
    let again = match primitives {
        Primitives::Spheres(spheres) if way.skip > 0.0 => {
            Closest::new(ray).intersect(&spheres.get(hit.prim as usize))
        }
        Primitives::Cylinders { cylinders, caps } if way.skip > 0.0 => {
            let cylinder = &cylinders[hit.prim as usize];
            let at = if is_straight(cylinder) {
                capsule::intersect(&RayFrame::new(ray), cylinder, *caps)
            } else {
                Tapered::new(cylinder, *caps).intersect(ray)
            };
            at.map(|at| at.t)
        }
        Primitives::Solid(solid) if way.skip > 0.0 => solid.intersect(ray).map(|(t, _)| t),
        _ => None,
    };
    again.unwrap_or_else(|| way.there(hit.t))
}

/// Eight surfaces side by side.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(align(32))]
pub struct Surfaces8 {
    /// [`Surface::p`]: x of each, y of each, z of each.
    pub p: [[f64; 8]; 3],
    /// [`Surface::p_error`].
    pub p_error: [[f32; 8]; 3],
    /// [`Surface::ng`].
    pub ng: [[f32; 8]; 3],
    /// Whether some `p_error` may be less than what rounding a coordinate of `p` to f32 costs, as it is far
    /// from the world's origin. Whoever makes a `p_error` smaller sets it.
    pub coarse: bool,
}

impl Surfaces8 {
    fn set(&mut self, lane: usize, Surface { p, p_error, ng }: Surface) {
        for axis in 0..3 {
            self.p[axis][lane] = p[axis];
            self.p_error[axis][lane] = p_error[axis];
            self.ng[axis][lane] = ng[axis];
        }
        self.coarse = true;
    }
}

/// [`surface`] of a bundle of eights.
pub(crate) struct Surfaces<'a, P> {
    pub(crate) world: &'a P,
    pub(crate) rays: &'a [Rays8],
    pub(crate) hits: &'a [Hits8],
    pub(crate) out: &'a mut [Surfaces8],
}

impl<P: Places> Kernel for Surfaces<'_, P> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { world, rays, hits, out } = self;
        for ((rays, hits), out) in rays.iter().zip(hits).zip(out) {
            out.coarse = false;
            let mut left = hits.met;
            while left != 0 {
                // Neighbours are mostly of one part.
                let first = left.trailing_zeros() as usize & 7;
                let part = u32x8::splat(simd, hits.part[first]);
                let same = part.simd_eq(u32x8::load_array_ref(simd, &hits.part));
                let same = left & same.to_bitmask() as u32;
                // What is in lanes without a hit is unspecified, and the others are yet to come.
                let to = if left == hits.met { 0xff } else { same };
                left &= !same;
                let (primitives, frame) = world.place(hits.part[first]);
                // The other lanes repeat the first.
                let own = mask32x8::from_bitmask(simd, same.into());
                let others = u32x8::splat(simd, hits.prim[first]);
                let locals = own.select(u32x8::load_array_ref(simd, &hits.prim), others);
                let locals = <[u32; 8]>::from(locals).map(|number| number as usize);
                let one_by_one = is_one_by_one(primitives, &locals)
                    || !eight(simd, (primitives, frame), &locals, rays, hits, to, out);
                if one_by_one {
                    for lane in lanes(same) {
                        out.set(lane, surface(world, &rays.get(lane), &hits.get(lane)));
                    }
                }
            }
        }
    }
}

/// Whether surfaces are worked out one by one: solids, and cylinders that are no capsules.
#[inline(always)]
fn is_one_by_one(primitives: &Primitives, locals: &[usize; 8]) -> bool {
    match primitives {
        Primitives::Solid(_) => true,
        Primitives::Cylinders { cylinders, caps } => {
            !locals.iter().all(|&local| is_capsule(&cylinders[local], *caps))
        }
        _ => false,
    }
}

#[inline(always)]
fn put<S: Simd>(simd: S, to: &mut [[f32; 8]; 3], lanes: u32, value: [f32x8<S>; 3]) {
    if lanes == 0xff {
        for (to, value) in to.iter_mut().zip(value) {
            value.store_array(to);
        }
        return;
    }
    let lanes = mask32x8::from_bitmask(simd, lanes.into());
    for (to, value) in to.iter_mut().zip(value) {
        let old = f32x8::load_array_ref(simd, to);
        lanes.select(value, old).store_array(to);
    }
}

#[inline(always)]
fn join<S: Simd>(l: [f64x4<S>; 3], h: [f64x4<S>; 3]) -> [f32x8<S>; 3] {
    [l[0].narrow(h[0]), l[1].narrow(h[1]), l[2].narrow(h[2])]
}

/// The surfaces of eight rays that met primitives of one part, put into `lanes` of `out`; false: they have
/// to be worked out one by one.
#[inline(always)]
fn eight<S: Simd>(
    simd: S,
    (primitives, frame): (&Primitives, &Frame),
    locals: &[usize; 8],
    rays: &Rays8,
    hits: &Hits8,
    lanes: u32,
    out: &mut Surfaces8,
) -> bool {
    let [a, b, c, d, e, f, g, h] = *locals;
    let [low, high] = match primitives {
        Primitives::Triangles { positions, indices } => {
            let (u, v) = (wide8(simd, &hits.u), wide8(simd, &hits.v));
            let four = |of| corners_of_four(simd, positions, indices, of);
            [triangle(four([a, b, c, d]), u.0, v.0), triangle(four([e, f, g, h]), u.1, v.1)]
        }
        others => {
            let (rays, t) = if let Some(near) = frame.load_near(simd, rays) {
                (near, wide8(simd, &hits.t))
            } else {
                let mut local = local::Rays8::NONE;
                let [low, high] = frame.rays(simd, rays, &mut local);
                let far = low.skip.simd_gt(0.0).any_true() || high.skip.simd_gt(0.0).any_true();
                if far && !matches!(others, Primitives::Plane(_)) {
                    return false;
                }
                let t = wide8(simd, &hits.t);
                // As `Way::there` has it.
                let (t_low, t_high) = (t.0 * low.scale - low.skip, t.1 * high.scale - high.skip);
                let t: f32x8<S> = t_low.narrow(t_high);
                (local.load(simd), t.widen())
            };
            let [ox, oy, oz] =
                [rays.origin[0].widen(), rays.origin[1].widen(), rays.origin[2].widen()];
            let [dx, dy, dz] = [rays.dir[0].widen(), rays.dir[1].widen(), rays.dir[2].widen()];
            let (low_o, high_o) = ([ox.0, oy.0, oz.0], [ox.1, oy.1, oz.1]);
            let (low_d, high_d) = ([dx.0, dy.0, dz.0], [dx.1, dy.1, dz.1]);
            match others {
                Primitives::Cylinders { cylinders, .. } => {
                    let four = |of| four_capsules(simd, cylinders, of);
                    let low = capsule(four([a, b, c, d]), low_o, low_d, t.0);
                    [low, capsule(four([e, f, g, h]), high_o, high_d, t.1)]
                }
                Primitives::Spheres(spheres) => {
                    let (center, radius) = four_spheres(simd, spheres, [a, b, c, d]);
                    let low = sphere(center, radius, low_o, low_d, t.0);
                    let (center, radius) = four_spheres(simd, spheres, [e, f, g, h]);
                    [low, sphere(center, radius, high_o, high_d, t.1)]
                }
                Primitives::Plane(plane) => {
                    [flat(plane, low_o, low_d), flat(plane, high_o, high_d)]
                }
                _ => unreachable!("triangles are above, and solids are worked out one by one"),
            }
        }
    };
    let [x, y, z] = join(low.p, high.p);
    let (x, y, z) = (x.widen(), y.widen(), z.widen());
    let [low_p, low_error, low_ng] = frame.leave([[x.0, y.0, z.0], low.p_error, low.ng]);
    let [high_p, high_error, high_ng] = frame.leave([[x.1, y.1, z.1], high.p_error, high.ng]);
    put(simd, &mut out.p_error, lanes, join(low_error, high_error));
    put(simd, &mut out.ng, lanes, join(low_ng, high_ng));
    let bits = u64::from(lanes);
    let (of_low, of_high): (mask64x4<S>, mask64x4<S>) =
        (SimdMask::from_bitmask(simd, bits & 15), SimdMask::from_bitmask(simd, bits >> 4));
    for axis in 0..3 {
        let (mut low, mut high) = (low_p[axis], high_p[axis]);
        if lanes != 0xff {
            let [old_low, old_high] = halves(simd, &out.p[axis]);
            (low, high) = (of_low.select(low, old_low), of_high.select(high, old_high));
        }
        out.p[axis] = whole(low, high);
    }
    if !frame.is_of_world() {
        for axis in 0..3 {
            let error = f32x8::load_array_ref(simd, &out.p_error[axis]);
            out.coarse |= is_coarse(simd, &out.p[axis], error) & bits != 0;
        }
    }
    true
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
    spheres: &Spheres,
    [a, b, c, d]: [usize; 4],
) -> ([f64x4<S>; 3], f64x4<S>) {
    let [a, b, c, d] = [spheres.get(a), spheres.get(b), spheres.get(c), spheres.get(d)];
    let center = wide3(simd, [a.center, b.center, c.center, d.center]);
    (center, wide(simd, [a.radius, b.radius, c.radius, d.radius]))
}

fn one_capsule(cylinder: &Cylinder) -> Capsule<f64> {
    Capsule {
        from: cylinder.from.as_dvec3().to_array(),
        half: half(cylinder).map(f64::from),
        radius: cylinder.radius.into(),
    }
}

#[inline(always)]
fn four_capsules<S: Simd>(
    simd: S,
    cylinders: &[Cylinder],
    [a, b, c, d]: [usize; 4],
) -> Capsule<f64x4<S>> {
    let [a, b, c, d] = [&cylinders[a], &cylinders[b], &cylinders[c], &cylinders[d]];
    let halves = [half(a).into(), half(b).into(), half(c).into(), half(d).into()];
    Capsule {
        from: wide3(simd, [a.from, b.from, c.from, d.from]),
        half: wide3(simd, halves),
        radius: wide(simd, [a.radius, b.radius, c.radius, d.radius]),
    }
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
pub(crate) fn coordinates(world: &impl Places, ray: &Ray, hit: &Hit) -> Coordinates {
    let (primitives, frame) = world.place(hit.part);
    let (ray, way) = frame.ray(ray);
    let (t, local) = (distance(primitives, &ray, way, hit), hit.prim as usize);
    let (normal, tangent, uv) = match primitives {
        Primitives::Triangles { positions, indices } => {
            let [a, b, c] = corners(positions, indices[local]).map(DVec3::from_array);
            ((b - a).cross(c - a), b - a, DVec2::new(hit.u.into(), hit.v.into()))
        }
        Primitives::Spheres(spheres) => {
            let Sphere { center, radius } = spheres.get(local);
            let (o, d) = line(&ray);
            let center = center.as_dvec3().to_array();
            let normal = on_sphere(center, radius.into(), o, d, t.into());
            let patch = ellipsoid::patch(DVec3::from_array(normal));
            (patch.normal, patch.tangent, patch.uv)
        }
        Primitives::Cylinders { cylinders, caps } => {
            let cylinder = &cylinders[local];
            if is_capsule(cylinder, *caps) {
                let (o, d) = line(&ray);
                let (normal, foot) = on_capsule(one_capsule(cylinder), o, d, t.into());
                let normal = DVec3::from_array(normal);
                let frame = tapered::frame(DVec3::from_array(half(cylinder).map(f64::from)));
                let DVec3 { x, y, .. } = frame.transpose() * normal;
                let tangent = frame * DVec3::new(-y, x, 0.0);
                (normal, tangent, DVec2::new(turn(y, x), 0.5 * (1.0 + foot)))
            } else {
                let patch = Tapered::new(cylinder, *caps).patch(&ray, t);
                (patch.normal, patch.tangent, patch.uv)
            }
        }
        Primitives::Plane(plane) => {
            let [u, v] = plane.axes();
            let (o, d) = line(&ray);
            let p = on_plane(plane.point.to_array(), plane.normal.to_array(), o, d);
            let from = DVec3::from_array(p) - plane.point;
            (plane.normal, u, DVec2::new(from.dot(u), from.dot(v)))
        }
        Primitives::Solid(solid) => {
            let patch = solid.patch(&ray, t);
            (patch.normal, patch.tangent, patch.uv)
        }
    };
    let ng = frame.normal(normal).normalize_or(DVec3::Z);
    let tangent = frame.direction(tangent);
    let tangent = tangent - tangent.dot(ng) * ng;
    let tangent = tangent.try_normalize().unwrap_or_else(|| ng.any_orthonormal_vector());
    Coordinates { uv: uv.as_vec2(), tangent: tangent.as_vec3() }
}
