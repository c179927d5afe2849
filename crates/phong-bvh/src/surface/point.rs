//! The point of a surface that a ray met, solved again in f64: for one ray, or for four at once.

use glam::{DVec3, Vec3};

use crate::{Plane, Ray, Wide};

/// What rounding to f32 changes at most, relative: half of ε, and a trifle for rounding the bound.
const ROUNDING: f64 = 0.500_001 * f32::EPSILON as f64;

/// A surface before it is rounded to f32.
pub(super) struct Point<F> {
    pub(super) p: [F; 3],
    pub(super) p_error: [F; 3],
    pub(super) ng: [F; 3],
}

#[inline(always)]
fn dot<F: Wide>(a: [F; 3], b: [F; 3]) -> F {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// `a + k b`.
#[inline(always)]
fn along<F: Wide>(a: [F; 3], k: F, b: [F; 3]) -> [F; 3] {
    [a[0] + k * b[0], a[1] + k * b[1], a[2] + k * b[2]]
}

#[inline(always)]
fn minus<F: Wide>(a: [F; 3], b: [F; 3]) -> [F; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
fn cross<F: Wide>(a: [F; 3], b: [F; 3]) -> [F; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The direction of `v`; z where it has none.
#[inline(always)]
pub(super) fn unit<F: Wide>(v: [F; 3]) -> [F; 3] {
    let square = dot(v, v);
    let (zero, one, least) = (square.like(0.0), square.like(1.0), square.like(1e-290));
    let inverse = one / square.root();
    [
        square.above(least, v[0] * inverse, zero),
        square.above(least, v[1] * inverse, zero),
        square.above(least, v[2] * inverse, one),
    ]
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
pub(super) fn triangle<F: Wide>([a, b, c]: [[F; 3]; 3], u: F, v: F) -> Point<F> {
    let (ab, ac) = (minus(b, a), minus(c, a));
    let p = along(along(a, u, ab), v, ac);
    let slack = farthest(p, a).or_larger(farthest(p, b)).or_larger(farthest(p, c));
    let slack = slack * (8.0 * ROUNDING);
    rounded(p, unit(cross(ab, ac)), u.like(0.0), [slack, slack, slack])
}

/// How far one point is from another along the axis where that is most.
#[inline(always)]
fn farthest<F: Wide>(p: [F; 3], q: [F; 3]) -> F {
    let [x, y, z] = minus(q, p);
    x.size().or_larger(y.size()).or_larger(z.size())
}

/// Of the two points where the line of the ray meets the sphere the one nearer to the hit; where
/// rounding takes the line past the sphere, the nearest of the sphere.
#[inline(always)]
pub(super) fn sphere<F: Wide>(center: [F; 3], radius: F, o: [F; 3], d: [F; 3], t: F) -> Point<F> {
    let normal = on_sphere(center, radius, o, d, t);
    let slack = radius * (16.0 * ROUNDING);
    let curvature = radius.like(1.0) / radius;
    rounded(along(center, radius, normal), normal, curvature, [slack, slack, slack])
}

/// The normal of the sphere there.
#[inline(always)]
pub(super) fn on_sphere<F: Wide>(center: [F; 3], radius: F, o: [F; 3], d: [F; 3], t: F) -> [F; 3] {
    let o = minus(o, center);
    let per_length = radius.like(1.0) / dot(d, d);
    let middle = radius.like(0.0) - dot(o, d) * per_length;
    let off = along(o, middle, d);
    let half = ((radius * radius - dot(off, off)).or_larger(radius.like(0.0)) * per_length).root();
    let reach = t.above(middle, half, half.like(0.0) - half);
    unit(along(off, reach, d))
}

/// Where the ray meets the plane. The plane's own numbers round in f64 only.
#[inline(always)]
pub(super) fn flat<F: Wide>(plane: &Plane, o: [F; 3], d: [F; 3]) -> Point<F> {
    let point = like(o[0], plane.point);
    let normal = like(o[0], plane.normal);
    let slack = like(o[0], f64::EPSILON * 8.0 * plane.point.abs());
    rounded(on_plane(point, normal, o, d), normal, o[0].like(0.0), slack)
}

#[inline(always)]
pub(super) fn on_plane<F: Wide>(point: [F; 3], normal: [F; 3], o: [F; 3], d: [F; 3]) -> [F; 3] {
    let t = dot(minus(point, o), normal) / dot(d, normal);
    let p = along(o, t, d);
    along(p, t.like(0.0) - dot(minus(p, point), normal), normal)
}

#[inline(always)]
fn like<F: Wide>(width: F, v: DVec3) -> [F; 3] {
    [width.like(v.x), width.like(v.y), width.like(v.z)]
}

/// A point of the world with its unit normal and no less than its greatest curvature, given how far
/// the next ray must keep off besides what rounding `p` costs.
///
/// Rounding moves `p` along the surface as well, and so does rounding away from it, by as much as
/// two roundings more; and a curved surface bends away below: by `e² κ / 2`. That matters to rays
/// going in, on small shapes far from the world's origin.
#[inline(always)]
pub(super) fn rounded<F: Wide>(p: [F; 3], ng: [F; 3], curvature: F, slack: [F; 3]) -> Point<F> {
    let rounding = [p[0].size() * ROUNDING, p[1].size() * ROUNDING, p[2].size() * ROUNDING];
    let along2 = dot(rounding, rounding) * 9.0;
    let bend = curvature * along2 * 0.5;
    // No deeper than it is along, at the apex of a cone neither: 0 × ∞ is no number.
    let bend = along2.above(bend * bend, bend, along2.root());
    let p_error = [
        rounding[0] + bend + slack[0],
        rounding[1] + bend + slack[1],
        rounding[2] + bend + slack[2],
    ];
    Point { p, p_error, ng }
}
