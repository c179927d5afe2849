//! What is given as a cylinder and is no `capsule`: with two radii, with flat ends, or open. Rays meet here in f64,
//! one at a time, what has two radii; flat and open cylinders of one radius they meet [eight at a time](super::capsule).
//! The surface where they do is worked out here for all of them.
//!
//! With the segment from z = 0 to z = 1 of a frame of its own, x and y not scaled, a flat or open one is the
//! [frustum](super::cone) as it stands. Round ends mean the surface swept by a sphere that
//! goes along the segment while its radius `r` goes linearly from one to the other: the hull of
//! the two spheres at the ends. In length, not in z, the radius grows by `k` a unit. The spheres touch
//! their envelope where its normal leans back by `sin β = k`: beside the centre by `r cos β`,
//! and along the axis by `−k r`. So the hull is the two spheres and the frustum between those two circles,
//! all of which are convex. The line is inside from where it first is inside one of them to where it
//! last is. For |k| ≥ 1 the smaller sphere lies inside the other, and there is no frustum.
//!
//! Faces: 0 the side, 1 and 2 the flat ends, 3 and 4 the spheres at the first and second end.

use glam::{DMat3, DVec2, DVec3, Vec3};

use super::{
    capsule::{self, At},
    cone,
    crossing::{Crossings, Line, Span, quadratic},
    patch::{Patch, turn},
};
use crate::{Aabb, Caps, Cylinder, local::Ray};

/// A cylinder in the frame of its axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tapered {
    from: DVec3,
    /// Unit x, y, z; z along the axis.
    frame: DMat3,
    length: f64,
    radii: [f64; 2],
    caps: Caps,
}

impl Tapered {
    /// From a cylinder.
    pub(crate) fn new(cylinder: &Cylinder, caps: Caps) -> Self {
        let numbers = capsule::lane(cylinder, Caps::Round);
        Self { caps, ..Self::of_lane(numbers) }
    }

    /// From the numbers of one lane of a block: the same.
    pub(crate) fn of_lane(numbers: [f32; capsule::BLOCK - 1]) -> Self {
        let [x, y, z, hx, hy, hz, _, radius, radius_to] = numbers.map(f64::from);
        let caps = match (radius < 0.0, radius_to < 0.0) {
            (true, _) => Caps::Flat,
            (_, true) => Caps::Open,
            _ => Caps::Round,
        };
        let axis = 2.0 * DVec3::new(hx, hy, hz);
        Self {
            from: DVec3::new(x, y, z),
            frame: frame(axis),
            length: axis.length(),
            radii: [radius.abs(), radius_to.abs()],
            caps,
        }
    }

    /// Where a ray first meets it, or none. An open one is met from within too.
    pub(crate) fn intersect(&self, ray: &Ray) -> Option<At> {
        let (line, start) = self.line(ray);
        let within = |t: f64| {
            let second_half = line.at(t).z > 0.5 * self.length;
            let t = (start + t) as f32;
            (ray.t_min < t && t < ray.t_max).then_some(At { t, second_half })
        };
        let crossings = self.crossings(&line);
        crossings.as_slice().iter().find_map(|crossing| within(crossing.t))
    }

    /// The surface where `ray` meets it at `t`, in world space.
    pub(crate) fn patch(&self, ray: &Ray, t: f32) -> Patch {
        let (line, start) = self.line(ray);
        let t = f64::from(t) - start;
        let (t, face) = self.crossings(&line).nearest(t).map_or((t, 0), |c| (c.t, c.face));
        let p = line.at(t);
        let local = match (self.caps, face) {
            (Caps::Round, 3) => ball(p, 0.0, self.radii[0]),
            (Caps::Round, 4) => ball(p, self.length, self.radii[1]),
            (Caps::Round, _) => self.envelope(p),
            _ => cone::patch(self.unit(p), self.radii, face),
        };
        let (scale, inverse) = match (self.caps, face) {
            (Caps::Round, _) => (1.0, 1.0),
            _ => (self.length, 1.0 / self.length),
        };
        let DVec3 { x, y, z } = local.p;
        Patch {
            p: self.from + self.frame * DVec3::new(x, y, z * scale),
            normal: self.frame * (local.normal * DVec3::new(1.0, 1.0, inverse)),
            tangent: self.frame * local.tangent,
            ..local
        }
    }

    /// No less than any coordinate in its parts: what roundings in f64 are relative to.
    pub(crate) fn largest(&self) -> DVec3 {
        self.from.abs() + self.length + self.radii[0].max(self.radii[1])
    }

    /// A point in units of the length along the axis, as the frustum has it.
    fn unit(&self, p: DVec3) -> DVec3 {
        DVec3::new(p.x, p.y, p.z / self.length)
    }

    /// The line of `ray` in the frame, from its point closest to the middle, and the ray's `t` there.
    fn line(&self, ray: &Ray) -> (Line, f64) {
        let inverse = self.frame.transpose();
        let o = inverse * (ray.origin.as_dvec3() - self.from);
        let d = inverse * ray.dir.as_dvec3();
        let start = (DVec3::new(0.0, 0.0, 0.5 * self.length) - o).dot(d) / d.length_squared();
        (Line { o: o + start * d, d }, start)
    }

    /// The crossings of a line.
    fn crossings(&self, line: &Line) -> Crossings {
        let capped = match self.caps {
            Caps::Round => return self.hull(line).into(),
            Caps::Flat => true,
            Caps::Open => false,
        };
        let unit = Line { o: self.unit(line.o), d: self.unit(line.d) };
        cone::crossings(&unit, self.radii, capped)
    }

    /// How much the radius grows a unit of length.
    fn slope(&self) -> f64 {
        let [radius, radius_to] = self.radii;
        if self.length > 0.0 { (radius_to - radius) / self.length } else { f64::INFINITY }
    }

    /// The part of a line inside the hull of the two spheres.
    fn hull(&self, line: &Line) -> Option<Span> {
        let [radius, radius_to] = self.radii;
        let k = self.slope();
        if k.abs() >= 1.0 {
            let (z, radius, face) =
                if radius > radius_to { (0.0, radius, 3) } else { (self.length, radius_to, 4) };
            return sphere(line, z, radius, face);
        }
        // Between the circles where the spheres touch their envelope.
        let (low, high) = (-k * radius, self.length - k * radius_to);
        let cos = (1.0 - k * k).sqrt();
        let (base, top) = (radius * cos, radius_to * cos);
        let unit = |p: DVec3, from: f64| DVec3::new(p.x, p.y, (p.z - from) / (high - low));
        let between = Line { o: unit(line.o, low), d: unit(line.d, 0.0) };
        let side = match cone::crossings(&between, [base, top], true).as_slice() {
            [enter, leave] => Some(Span::new(enter.t, leave.t, 0)),
            _ => None,
        };
        let balls = [sphere(line, 0.0, radius, 3), sphere(line, self.length, radius_to, 4)];
        balls
            .into_iter()
            .flatten()
            .fold(side, |hull, ball| Some(hull.map_or(ball, |hull| hull.or(ball))))
    }

    /// The envelope of the spheres around the point `p`.
    fn envelope(&self, p: DVec3) -> Patch {
        let k = self.slope();
        let cos = (1.0 - k * k).max(0.0).sqrt();
        let out = p.truncate().normalize_or(DVec2::X);
        // The sphere that touches there: its middle is farther along than the point by k r.
        let s = p.z + k * p.truncate().length() / cos;
        let s = s.clamp(0.0, self.length);
        let radius = self.radii[0] + k * s;
        let normal = (out * cos).extend(-k);
        Patch {
            p: DVec3::new(0.0, 0.0, s) + radius * normal,
            normal,
            tangent: DVec3::new(-out.y, out.x, 0.0),
            uv: DVec2::new(turn(out.y, out.x), s / self.length),
            curvature: 1.0 / radius,
        }
    }
}

/// A box around a cylinder: no larger than it must be but for what its test may round.
pub(crate) fn bounds(cylinder: &Cylinder, caps: Caps) -> Aabb {
    let Cylinder { from, radius, to, radius_to } = *cylinder;
    let axis = to.as_dvec3() - from.as_dvec3();
    // How far a disc across the axis reaches, and a sphere.
    let reach = match (caps, axis.try_normalize()) {
        (Caps::Flat | Caps::Open, Some(z)) => (1.0 - z * z).max(DVec3::ZERO).map(f64::sqrt),
        _ => DVec3::ONE,
    };
    let size = (to - from).abs().max_element() + radius.max(radius_to);
    let slack = Vec3::splat(size * (16.0 * f32::EPSILON));
    let reach = |radius: f32| (f64::from(radius) * reach).as_vec3() + slack;
    let (first, last) = (reach(radius), reach(radius_to));
    Aabb { lo: (from - first).min(to - last), hi: (from + first).max(to + last) }
}

/// Unit x, y and z of a right-handed frame whose z is along `axis`.
pub(crate) fn frame(axis: DVec3) -> DMat3 {
    let z = axis.normalize_or(DVec3::Z);
    let (x, y) = z.any_orthonormal_pair();
    let (x, y) = if x.cross(y).dot(z) < 0.0 { (y, x) } else { (x, y) };
    DMat3::from_cols(x, y, z)
}

/// The part of a line inside the sphere around (0, 0, z).
fn sphere(line: &Line, z: f64, radius: f64, face: u8) -> Option<Span> {
    let o = line.o - DVec3::new(0.0, 0.0, z);
    let (a, b) = (line.d.length_squared(), o.dot(line.d));
    let across = o.cross(line.d).length_squared();
    let discriminant = a * radius * radius - across;
    let [enter, leave] = quadratic(a, b, o.length_squared() - radius * radius, discriminant)?;
    Some(Span::new(enter, leave, face))
}

/// The sphere around (0, 0, z), which is an end, near the point `p`.
fn ball(p: DVec3, z: f64, radius: f64) -> Patch {
    let middle = DVec3::new(0.0, 0.0, z);
    let normal = (p - middle).normalize_or(DVec3::Z);
    Patch {
        p: middle + radius * normal,
        normal,
        tangent: DVec3::new(-normal.y, normal.x, 0.0),
        uv: DVec2::new(turn(normal.y, normal.x), if z > 0.0 { 1.0 } else { 0.0 }),
        curvature: 1.0 / radius,
    }
}
