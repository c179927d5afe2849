//! The triangle, the sphere and the cylinder against plain f64 geometry, which shares no line with the kernels.
//!
//! The kernels work in f32, so for a ray that all but grazes an edge either answer is right. Where the
//! line between is, and how far `t` may be off, is stated here: with `M` the distance of what is
//! farthest from the origin and `u` = 2⁻²⁴,
//!
//! - a corner of a triangle is seen at most `8 u M` beside its place: subtracting the origin rounds by
//!   `u M`, and so do the slope, its product and the difference, along two axes. The edge functions of
//!   the corners as seen are exact. So a ray that passes all edges at more than that is decided rightly,
//!   and meets the plane at most `8 u M / |cos|` from where it should;
//! - the vector from the ray to a sphere's middle is off by at most `16 u M`, which moves a root by as
//!   much and by `16 u M r / h` more, `h` being half the chord;
//! - a cylinder is seen at most `24 u M` beside its place, whatever its ends and radii. The oracle knows it by the
//!   distance of a point from it alone. Along a ray that is a convex function, so its roots are found by halving.
//!
//! Every other answer is held to these bounds, and enough cases must lie outside of the doubt.

mod random;

use glam::{DVec3, Vec3};
use phong_bvh::{BuildOptions, Caps, Cylinder, Hit, Primitives, Ray, Sphere, World};

use random::Random;

const U: f64 = 1.0 / 16_777_216.0;

impl Random {
    /// In [−1, 1).
    fn signed(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn point(&mut self) -> DVec3 {
        DVec3::new(self.signed(), self.signed(), self.signed())
    }
}

/// What f64 says: missed, hit at `t` give or take a bound, or in doubt.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Verdict {
    Miss,
    Hit { t: f64, bound: f64 },
    Doubt,
}

/// Whether `t` is within the ray's interval, by more than a bound.
fn within(ray: &Ray, t: f64, bound: f64) -> Verdict {
    let (from, to) = (t - f64::from(ray.t_min), f64::from(ray.t_max) - t);
    match from.min(to) {
        room if room > bound => Verdict::Hit { t, bound },
        room if room < -bound => Verdict::Miss,
        _ => Verdict::Doubt,
    }
}

fn triangle(ray: &Ray, corners: [Vec3; 3]) -> Verdict {
    let (o, d) = (ray.origin, ray.dir.as_dvec3());
    let [a, b, c] = corners.map(|v| v.as_dvec3() - o);
    let far = a.abs().max(b.abs()).max(c.abs()).max_element();
    let off = 8.0 * U * far;
    // On which side of an edge the ray passes, and how far from it.
    let side = |p: DVec3, q: DVec3| {
        let normal = (q - p).cross(d);
        normal.dot(p) / normal.length().max(f64::MIN_POSITIVE)
    };
    let sides = [side(a, b), side(b, c), side(c, a)];
    let left = sides.iter().filter(|s| **s > off).count();
    let right = sides.iter().filter(|s| **s < -off).count();
    if left > 0 && right > 0 {
        return Verdict::Miss;
    }
    if left < 3 && right < 3 {
        return Verdict::Doubt;
    }
    let normal = (b - a).cross(c - a).normalize_or(DVec3::Z);
    let t = normal.dot(a) / normal.dot(d);
    within(ray, t, off / normal.dot(d).abs() + U * t.abs())
}

fn sphere(ray: &Ray, sphere: &Sphere) -> Verdict {
    let d = ray.dir.as_dvec3();
    let c = sphere.center.as_dvec3() - ray.origin;
    let r = f64::from(sphere.radius);
    let middle = c.dot(d) / d.dot(d);
    let q = (c - middle * d).length();
    let off = 16.0 * U * (c.length() + r);
    if q > r + off {
        return Verdict::Miss;
    }
    if q > r - off {
        return Verdict::Doubt;
    }
    let h = (r * r - q * q).sqrt() / d.length();
    let bound = off * (1.0 + r / h);
    match within(ray, middle - h, bound) {
        // The ray may begin within, and then leaves.
        Verdict::Miss if middle - h < f64::from(ray.t_min) => within(ray, middle + h, bound),
        Verdict::Miss => Verdict::Miss,
        verdict => verdict,
    }
}

/// Where a convex function is least.
fn least(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..120 {
        let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        if f(a) < f(b) { high = b } else { low = a }
    }
    low.midpoint(high)
}

/// Where a function that is negative at `inside` and positive at `outside` is zero.
fn root(mut inside: f64, mut outside: f64, f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..120 {
        let middle = inside.midpoint(outside);
        if f(middle) < 0.0 { inside = middle } else { outside = middle }
    }
    inside.midpoint(outside)
}

/// How far a point is outside of a closed cylinder; negative: within.
fn outside(p: DVec3, cylinder: &Cylinder, caps: Caps) -> f64 {
    let (from, to) = (cylinder.from.as_dvec3(), cylinder.to.as_dvec3());
    let (r, r_to) = (f64::from(cylinder.radius), f64::from(cylinder.radius_to));
    if caps == Caps::Round {
        let beyond = |s: f64| (p - from.lerp(to, s)).length() - (r + s * (r_to - r));
        let s = least(0.0, 1.0, beyond);
        return beyond(s).min(beyond(0.0)).min(beyond(1.0));
    }
    let (axis, length) = (to - from).normalize_and_length();
    let z = (p - from).dot(axis);
    let side = (p - from - z * axis).length() - (r + z / length * (r_to - r));
    let lean = libm::hypot((r_to - r) / length, 1.0);
    (side / lean).max(-z).max(z - length)
}

fn cylinder(ray: &Ray, cylinder: &Cylinder, caps: Caps) -> Verdict {
    let (o, d) = (ray.origin, ray.dir.as_dvec3());
    let (from, to) = (cylinder.from.as_dvec3() - o, cylinder.to.as_dvec3() - o);
    let r = f64::from(cylinder.radius.max(cylinder.radius_to));
    let off = 24.0 * U * (from.length() + to.length() + r);
    let f = |t: f64| outside(o + t * d, cylinder, caps);
    let reach = 2.0 * ((to - from).length() + r);
    let near = (from + to).dot(d) / 2.0;
    let best = least(near - reach, near + reach, f);
    let depth = -f(best);
    if depth < -off {
        return Verdict::Miss;
    }
    if depth < off {
        return Verdict::Doubt;
    }
    // A convex function is no flatter at its root than from there to where it is least.
    let crossing = |end: f64| {
        let t = root(best, end, f);
        (t, off * (1.0 + (t - best).abs() / depth) + U * t.abs())
    };
    let (enter, bound) = crossing(near - 2.0 * reach);
    match within(ray, enter, bound) {
        Verdict::Miss if enter < f64::from(ray.t_min) => {
            let (leave, bound) = crossing(near + 2.0 * reach);
            within(ray, leave, bound)
        }
        verdict => verdict,
    }
}

/// Holds an answer to the verdict; whether there was one.
fn holds(verdict: Verdict, hit: Hit, case: &dyn std::fmt::Debug) -> bool {
    match verdict {
        Verdict::Miss => assert!(!hit.is_some(), "{hit:?} should be none: {case:?}"),
        Verdict::Hit { t, bound } => {
            assert!(hit.is_some(), "no hit, should be at {t}: {case:?}");
            let error = (f64::from(hit.t) - t).abs();
            assert!(error <= bound, "{} is {error:e} from {t}, > {bound:e}: {case:?}", hit.t);
        }
        Verdict::Doubt => return false,
    }
    true
}

/// A ray to a target, from some way off, through an interval that may end or begin close to it.
fn ray(random: &mut Random, target: DVec3, dir: DVec3, size: f64) -> Ray {
    let axes = [DVec3::X, DVec3::NEG_Y, DVec3::Z, DVec3::new(0.6, 0.0, -0.8)];
    let dir = if random.bits().is_multiple_of(5) { random.of(&axes) } else { dir };
    let dir = dir.try_normalize().unwrap_or(DVec3::Y);
    let distance = size * random.of(&[0.0, 0.3, 1.0, 10.0, 300.0]);
    let mut ray = Ray::new((target - distance * dir).as_vec3(), dir.as_vec3());
    match random.bits() % 5 {
        0 => ray.t_max = (distance * (1.0 + 0.01 * random.signed())) as f32,
        1 => ray.t_min = (distance * (1.0 + 0.01 * random.signed())) as f32,
        _ => {}
    }
    ray
}

fn bvh(geometry: Primitives) -> World {
    World::of(vec![geometry], BuildOptions::default()).expect("one primitive")
}

/// Rays against a primitive; unoptimized, four times fewer, since kernels are slow there.
const CASES: usize = if cfg!(debug_assertions) { 15_000 } else { 60_000 };

#[test]
fn a_triangle_is_hit_where_f64_says() {
    let mut random = Random(1);
    let (mut hits, mut misses, mut doubts) = (0, 0, 0);
    for _ in 0..CASES {
        let scale = random.of(&[1e-15, 1e-6, 1.0, 1.0, 1e4, 1e12]);
        let at = random.point();
        let mut corners = [0; 3].map(|_| at + random.point());
        // Slivers: a corner close to the middle of the other two.
        if random.bits().is_multiple_of(4) {
            let middle = (corners[0] + corners[1]) / 2.0;
            corners[2] = middle + random.of(&[1e-1, 1e-3, 1e-5]) * random.point();
        }
        let corners = corners.map(|v| (scale * v).as_vec3());
        let [a, b, c] = corners.map(Vec3::as_dvec3);
        // Within, on a corner, on an edge, beside it by little and by less.
        let edge = a.lerp(b, 0.5 + 0.5 * random.signed());
        let beside = random.of(&[0.1, 1e-2, 1e-4, 1e-6]) * (c - edge) * random.of(&[1.0, -1.0]);
        let inner = (a + b + c) / 3.0 + 0.2 * random.signed() * (a - c);
        let target = random.of(&[inner, inner, a, edge, edge + beside, edge + beside]);
        // Across, or all but along the plane.
        let along = (b - a) + random.signed() * (c - a);
        let graze = along.normalize_or(DVec3::X) + random.of(&[1e-2, 1e-5]) * random.point();
        let dir = if random.bits().is_multiple_of(4) { graze } else { random.point() };
        let ray = ray(&mut random, target, dir, scale);
        let geometry = Primitives::triangles(corners.to_vec(), vec![[0, 1, 2]]);
        let bvh = bvh(geometry);
        let (hit, verdict) = (bvh.intersect(&ray), triangle(&ray, corners));
        if !holds(verdict, hit, &(ray, corners)) {
            doubts += 1;
        } else if hit.is_some() {
            hits += 1;
        } else {
            misses += 1;
        }
        assert_eq!(bvh.occluded(&ray), hit.is_some(), "{ray:?} {corners:?}");
    }
    assert!(
        hits > CASES / 5 && misses > CASES / 10,
        "{hits} hits, {misses} misses, {doubts} in doubt"
    );
}

#[test]
fn a_sphere_is_hit_where_f64_says() {
    let mut random = Random(2);
    let (mut hits, mut misses, mut doubts) = (0, 0, 0);
    for _ in 0..CASES {
        let scale = random.of(&[1e-12, 1e-6, 1.0, 1.0, 1e4, 1e12]);
        let center = (scale * random.point()).as_vec3();
        let radius = (scale * random.of(&[1e-2, 0.1, 0.5, 2.0])) as f32;
        let (c, r) = (center.as_dvec3(), f64::from(radius));
        let dir = random.point().try_normalize().unwrap_or(DVec3::X);
        // Through the middle, anywhere, and grazing from both sides.
        let beside = dir.cross(random.point()).try_normalize().unwrap_or(DVec3::Z);
        let graze = 1.0 + random.of(&[1e-2, 1e-4, 1e-6, -1e-6, -1e-4, -1e-2]);
        let target = random.of(&[c, c + r * beside * 0.5, c + r * beside * graze]);
        let ray = ray(&mut random, target, dir, scale);
        let s = Sphere { center, radius };
        let bvh = bvh(Primitives::spheres(vec![s]));
        let (hit, verdict) = (bvh.intersect(&ray), sphere(&ray, &s));
        if !holds(verdict, hit, &(ray, s)) {
            doubts += 1;
        } else if hit.is_some() {
            hits += 1;
        } else {
            misses += 1;
        }
        assert_eq!(bvh.occluded(&ray), hit.is_some(), "{ray:?} {s:?}");
    }
    assert!(
        hits > CASES * 2 / 3 && misses > CASES / 6,
        "{hits} hits, {misses} misses, {doubts} in doubt"
    );
}

#[test]
fn a_cylinder_is_hit_where_f64_says() {
    let mut random = Random(3);
    let (mut hits, mut misses, mut doubts) = (0, 0, 0);
    for _ in 0..CASES / 3 {
        let scale = random.of(&[1e-12, 1e-6, 1.0, 1.0, 1e4, 1e12]);
        let from = random.point();
        let axis = random.point();
        let axis = random.of(&[DVec3::X, DVec3::NEG_Y, axis, axis]);
        let thick = random.of(&[2e-3, 0.02, 0.3, 2.0]);
        let caps = random.of(&[Caps::Round, Caps::Round, Caps::Flat]);
        let taper = random.of(&[1.0, 1.0, 0.5, 3.0]);
        let radius = (scale * thick) as f32;
        let c = Cylinder {
            from: (scale * from).as_vec3(),
            radius,
            to: (scale * (from + random.of(&[1.0, 1.0, 0.01]) * axis)).as_vec3(),
            radius_to: radius * taper as f32,
        };
        let (a, b, r) = (c.from.as_dvec3(), c.to.as_dvec3(), f64::from(radius));
        // Across, or all but along the axis.
        let graze = (b - a).normalize_or(DVec3::X) + random.of(&[0.1, 1e-2, 1e-3]) * random.point();
        let dir = if random.bits().is_multiple_of(3) { graze } else { random.point() };
        let dir = dir.try_normalize().unwrap_or(DVec3::X);
        let beside = dir.cross(b - a).try_normalize().unwrap_or(dir.any_orthonormal_vector());
        let rim = 1.0 + random.of(&[1e-2, 1e-4, 1e-6, -1e-6, -1e-4, -1e-2]);
        // Between the ends, and beyond them.
        let middle = a.lerp(b, 0.5 + 0.6 * random.signed());
        let target = middle + r * beside * random.of(&[0.0, 0.5, rim, rim]);
        let ray = ray(&mut random, target, dir, scale);
        let bvh = bvh(Primitives::cylinders(vec![c], caps));
        let (hit, verdict) = (bvh.intersect(&ray), cylinder(&ray, &c, caps));
        if !holds(verdict, hit, &(ray, c, caps)) {
            doubts += 1;
        } else if hit.is_some() {
            hits += 1;
        } else {
            misses += 1;
        }
        assert_eq!(bvh.occluded(&ray), hit.is_some(), "{ray:?} {c:?}");
    }
    assert!(
        hits > CASES * 2 / 15 && misses > CASES / 15,
        "{hits} hits, {misses} misses, {doubts} in doubt"
    );
}
