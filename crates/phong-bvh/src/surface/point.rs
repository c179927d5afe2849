//! The point of a surface that a ray met, solved again in f64: for one ray, or for four at once.

use glam::Vec3;

use crate::{
    Plane,
    frame::{ROUNDING, unit},
    lanes::{Lanes, cross, dot, splat3, sub},
    local::Ray,
};

/// A surface before it is rounded to f32.
pub(super) struct Point<F> {
    pub(super) p: [F; 3],
    pub(super) p_error: [F; 3],
    pub(super) ng: [F; 3],
}

/// `a + k b`.
#[inline(always)]
fn along<F: Lanes<Scalar = f64>>(a: [F; 3], k: F, b: [F; 3]) -> [F; 3] {
    [a[0] + k * b[0], a[1] + k * b[1], a[2] + k * b[2]]
}

/// The line of a ray: origin and direction.
#[inline(always)]
pub(super) fn line(ray: &Ray) -> ([f64; 3], [f64; 3]) {
    (ray.origin.as_dvec3().to_array(), ray.dir.as_dvec3().to_array())
}

#[inline(always)]
pub(super) fn corners(positions: &[Vec3], indices: [u32; 3]) -> [[f64; 3]; 3] {
    let at = |i: u32| positions[i as usize].as_dvec3().to_array();
    [at(indices[0]), at(indices[1]), at(indices[2])]
}

/// Interpolates in f64, so the point is in the triangle's plane whatever the rounding of u and v.
///
/// The kernel takes the corners relative to the ray's origin, and shears them. Of each coordinate
/// so made up to six roundings are relative to how far the corners are, along any axis.
#[inline(always)]
pub(super) fn triangle<F: Lanes<Scalar = f64>>([a, b, c]: [[F; 3]; 3], u: F, v: F) -> Point<F> {
    let (ab, ac) = (sub(b, a), sub(c, a));
    let p = along(along(a, u, ab), v, ac);
    let slack = farthest(p, a).max(farthest(p, b)).max(farthest(p, c));
    let slack = slack * (8.0 * ROUNDING);
    even(p, unit(cross(ab, ac)), [slack, slack, slack])
}

/// How far one point is from another along the axis where that is most.
#[inline(always)]
fn farthest<F: Lanes<Scalar = f64>>(p: [F; 3], q: [F; 3]) -> F {
    let [x, y, z] = sub(q, p);
    x.abs().max(y.abs()).max(z.abs())
}

/// Of the two points where the line of the ray meets the sphere the one nearer to the hit; where
/// rounding takes the line past the sphere, the nearest of the sphere.
#[inline(always)]
pub(super) fn sphere<F: Lanes<Scalar = f64>>(
    center: [F; 3],
    radius: F,
    o: [F; 3],
    d: [F; 3],
    t: F,
) -> Point<F> {
    let normal = on_sphere(center, radius, o, d, t);
    let slack = radius * (16.0 * ROUNDING);
    let curvature = radius.splat(1.0) / radius;
    rounded(along(center, radius, normal), normal, curvature, [slack, slack, slack])
}

/// The normal of the sphere there.
#[inline(always)]
pub(super) fn on_sphere<F: Lanes<Scalar = f64>>(
    center: [F; 3],
    radius: F,
    o: [F; 3],
    d: [F; 3],
    t: F,
) -> [F; 3] {
    let o = sub(o, center);
    let per_length = radius.splat(1.0) / dot(d, d);
    let middle = radius.splat(0.0) - dot(o, d) * per_length;
    let off = along(o, middle, d);
    let half = ((radius * radius - dot(off, off)).max(radius.splat(0.0)) * per_length).sqrt();
    let reach = F::select(t.gt(middle), half, half.splat(0.0) - half);
    unit(along(off, reach, d))
}

/// The first end of a capsule, half of the way to the second, and the radius.
#[derive(Clone, Copy)]
pub(super) struct Capsule<F> {
    pub(super) from: [F; 3],
    pub(super) half: [F; 3],
    pub(super) radius: F,
}

/// The point of the capsule that the ray meets near `t`.
#[inline(always)]
pub(super) fn capsule<F: Lanes<Scalar = f64>>(
    capsule: Capsule<F>,
    o: [F; 3],
    d: [F; 3],
    t: F,
) -> Point<F> {
    let Capsule { from, half, radius } = capsule;
    let (normal, along_axis) = on_capsule(capsule, o, d, t);
    let middle = along(from, along_axis + 1.0, half);
    let slack = (dot(half, half).sqrt() * 2.0 + radius) * (16.0 * ROUNDING);
    let curvature = radius.splat(1.0) / radius;
    rounded(along(middle, radius, normal), normal, curvature, [slack, slack, slack])
}

/// The normal of the capsule there, and how far along the axis its foot is: −1 at the first end, 1 at
/// the second.
///
/// The steps are those of the kernel (`primitives/capsule.rs`); the ray goes in or out there by the
/// normal at the hit as it is known.
#[inline(always)]
pub(super) fn on_capsule<F: Lanes<Scalar = f64>>(
    Capsule { from, half, radius }: Capsule<F>,
    o: [F; 3],
    d: [F; 3],
    t: F,
) -> ([F; 3], F) {
    let (zero, one) = (t.splat(0.0), t.splat(1.0));
    let clamp = |k: F| {
        let k = F::select(k.gt(one), one, k);
        F::select((-one).gt(k), -one, k)
    };
    let o = sub(sub(o, from), half);
    let per_length = one / dot(d, d);
    let b = -dot(o, d) * per_length;
    let f = along(o, b, d);
    let s = t - b;
    let per_hh = one / dot(half, half).max(t.splat(1e-74));
    let (d_along, f_along) = (dot(d, half) * per_hh, dot(f, half) * per_hh);
    let near = along(f, s, d);
    let out = along(near, -clamp(f_along + s * d_along), half);
    let side = F::select(dot(out, d).gt(zero), one, -one);
    // The side of the cylinder.
    let e = along(d, -d_along, half);
    let g = along(f, -f_along, half);
    let per_ee = one / dot(e, e).max(t.splat(1e-40));
    let c = -dot(g, e) * per_ee;
    let q = along(g, c, e);
    let reach = ((radius * radius - dot(q, q)).max(zero) * per_ee).sqrt();
    let s = c + side * reach;
    let foot = f_along + s * d_along;
    let on_side = along(g, s, e);
    // The sphere at the end.
    let end = clamp(foot);
    let v = along(f, -end, half);
    let k = -dot(v, d) * per_length;
    let w = along(v, k, d);
    let reach = ((radius * radius - dot(w, w)).max(zero) * per_length).sqrt();
    let on_end = along(w, side * reach, d);
    // Whether it is beyond the ends.
    let beyond = foot.abs().gt(one);
    let choose = |at_end: F, at_side: F| F::select(beyond, at_end, at_side);
    let normal = [
        choose(on_end[0], on_side[0]),
        choose(on_end[1], on_side[1]),
        choose(on_end[2], on_side[2]),
    ];
    (unit(normal), end)
}

/// Where the ray meets the plane. The plane's own numbers round in f64 only.
#[inline(always)]
pub(super) fn flat<F: Lanes<Scalar = f64>>(plane: &Plane, o: [F; 3], d: [F; 3]) -> Point<F> {
    let point = splat3(o[0], plane.point.to_array());
    let normal = splat3(o[0], plane.normal.to_array());
    let slack = splat3(o[0], (f64::EPSILON * 8.0 * plane.point.abs()).to_array());
    let p = match plane.axis() {
        Some(0) => on_plane_across::<F, 0>(point, o, d),
        Some(1) => on_plane_across::<F, 1>(point, o, d),
        Some(_) => on_plane_across::<F, 2>(point, o, d),
        None => on_plane(point, normal, o, d),
    };
    even(p, normal, slack)
}

#[inline(always)]
pub(super) fn on_plane<F: Lanes<Scalar = f64>>(
    point: [F; 3],
    normal: [F; 3],
    o: [F; 3],
    d: [F; 3],
) -> [F; 3] {
    let t = dot(sub(point, o), normal) / dot(d, normal);
    let p = along(o, t, d);
    along(p, t.splat(0.0) - dot(sub(p, point), normal), normal)
}

/// The same where the normal lies along an axis, so that two of its numbers are 0.
#[inline(always)]
fn on_plane_across<F: Lanes<Scalar = f64>, const AXIS: usize>(
    point: [F; 3],
    o: [F; 3],
    d: [F; 3],
) -> [F; 3] {
    let t = (point[AXIS] - o[AXIS]) / d[AXIS];
    let mut p = along(o, t, d);
    p[AXIS] = p[AXIS] - (p[AXIS] - point[AXIS]);
    p
}

/// A point of the world with its unit normal and no less than its greatest curvature, given how far
/// the next ray must keep off besides what rounding `p` costs.
///
/// Rounding moves `p` along the surface as well, and so does rounding away from it, by as much as
/// two roundings more; and a curved surface bends away below: by `e² κ / 2`. That matters to rays
/// going in, on small shapes far from the world's origin.
#[inline(always)]
pub(super) fn rounded<F: Lanes<Scalar = f64>>(
    p: [F; 3],
    ng: [F; 3],
    curvature: F,
    slack: [F; 3],
) -> Point<F> {
    let rounding = [p[0].abs() * ROUNDING, p[1].abs() * ROUNDING, p[2].abs() * ROUNDING];
    let along2 = dot(rounding, rounding) * 9.0;
    let bend = curvature * along2 * 0.5;
    // No deeper than it is along, at the apex of a cone neither: 0 × ∞ is NaN.
    let bent = along2.gt(bend * bend);
    let bend = if F::all(bent) { bend } else { F::select(bent, bend, along2.sqrt()) };
    let p_error = [
        rounding[0] + bend + slack[0],
        rounding[1] + bend + slack[1],
        rounding[2] + bend + slack[2],
    ];
    Point { p, p_error, ng }
}

/// [`rounded`] of what does not bend.
#[inline(always)]
fn even<F: Lanes<Scalar = f64>>(p: [F; 3], ng: [F; 3], slack: [F; 3]) -> Point<F> {
    let p_error = [
        p[0].abs() * ROUNDING + slack[0],
        p[1].abs() * ROUNDING + slack[1],
        p[2].abs() * ROUNDING + slack[2],
    ];
    Point { p, p_error, ng }
}
