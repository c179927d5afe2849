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
    rounded(p, unit(cross(ab, ac)), u.splat(0.0), [slack, slack, slack])
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

/// Where the ray meets the plane. The plane's own numbers round in f64 only.
#[inline(always)]
pub(super) fn flat<F: Lanes<Scalar = f64>>(plane: &Plane, o: [F; 3], d: [F; 3]) -> Point<F> {
    let point = splat3(o[0], plane.point.to_array());
    let normal = splat3(o[0], plane.normal.to_array());
    let slack = splat3(o[0], (f64::EPSILON * 8.0 * plane.point.abs()).to_array());
    rounded(on_plane(point, normal, o, d), normal, o[0].splat(0.0), slack)
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
    let bend = F::select(along2.gt(bend * bend), bend, along2.sqrt());
    let p_error = [
        rounding[0] + bend + slack[0],
        rounding[1] + bend + slack[1],
        rounding[2] + bend + slack[2],
    ];
    Point { p, p_error, ng }
}
