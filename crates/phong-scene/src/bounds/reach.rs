//! How far things reach along directions: their support functions.
//!
//! A thing lies within a half-space exactly if it reaches no farther along the half-space's
//! normal than the half-space does. Boxes are six half-spaces, and a picture's view is four.

use std::array::from_fn;

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::Bounds;
use crate::mesh::{Caps, Cylinders, Mesh, Points};
use crate::scene::{Object, Scene};
use crate::shape::Shape;

impl Scene {
    /// The largest `p · n` of all points p of all objects but planes, for each n of `along`;
    /// −∞ if there are none. Of an instance, its group's box counts.
    pub(crate) fn reach<const N: usize>(&self, along: [DVec3; N]) -> [f64; N] {
        let groups = self.group_bounds();
        let reaches = self.objects.iter().filter_map(|object| object.reach(along, &groups));
        reaches.fold([f64::NEG_INFINITY; N], farther)
    }
}

impl Object {
    /// The same of one object; `None` if it has no end.
    pub(super) fn reach<const N: usize>(
        &self,
        along: [DVec3; N],
        groups: &[Bounds],
    ) -> Option<[f64; N]> {
        // (A p + t) · n = p · Aᵀ n + t · n
        let across = self.transform.matrix3.transpose();
        let reach = self.shape.reach(along.map(|n| across * n), groups)?;
        Some(from_fn(|i| reach[i] + self.transform.translation.dot(along[i])))
    }
}

impl Shape {
    pub(super) fn reach<const N: usize>(
        &self,
        along: [DVec3; N],
        groups: &[Bounds],
    ) -> Option<[f64; N]> {
        let disc = |center: DVec3, normal: DVec3, radius: f64| disc(along, center, normal, radius);
        let all = |points: &[DVec3]| {
            let reaches = points.iter().map(|p| along.map(|n| p.dot(n)));
            reaches.fold([f64::NEG_INFINITY; N], farther)
        };
        Some(match *self {
            Self::Plane { .. } => return None,
            Self::Sphere { center, radius } => along.map(|n| center.dot(n) + radius * n.length()),
            Self::Triangle { ref points, .. } => all(points),
            Self::Disc { center, normal, radius } => disc(center, normal, radius),
            Self::Box { min, max } => all(&Bounds { min, max }.corners()),
            Self::Cylinder { from, to, radius, .. } => {
                farther(disc(from, to - from, radius), disc(to, to - from, radius))
            }
            Self::Cone { from, to, radius, radius_to, .. } => {
                farther(disc(from, to - from, radius), disc(to, to - from, radius_to))
            }
            Self::Torus { center, axis, radius, tube } => {
                let ring = disc(center, axis, radius);
                from_fn(|i| ring[i] + tube * along[i].length())
            }
            Self::Mesh(ref mesh) => mesh.reach(along),
            Self::Points(ref points) => points.reach(along),
            Self::Cylinders(ref cylinders) => cylinders.reach(along),
            Self::Instance(group) => match groups.get(group.0 as usize) {
                Some(bounds) if !bounds.is_empty() => all(&bounds.corners()),
                _ => return None,
            },
        })
    }
}

impl Mesh {
    fn reach<const N: usize>(&self, along: [DVec3; N]) -> [f64; N] {
        let (min, max) = self.extremes();
        // A position outside the box belongs to no triangle.
        let within = |p: &&Vec3| p.cmpge(min).all() && p.cmple(max).all();
        let reach = |p: &Vec3| along.map(|n| p.as_dvec3().dot(n));
        let positions = self.positions.par_iter().with_min_len(1 << 12).filter(within).map(reach);
        let reach = positions.reduce(|| [f64::NEG_INFINITY; N], farther);
        from_fn(|i| reach[i] + self.origin.dot(along[i]))
    }
}

impl Points {
    fn reach<const N: usize>(&self, along: [DVec3; N]) -> [f64; N] {
        let lengths = along.map(DVec3::length);
        let reach = |&[x, y, z, radius]: &[f32; 4]| {
            let center = Vec3::new(x, y, z).as_dvec3();
            from_fn(|i| center.dot(along[i]) + f64::from(radius) * lengths[i])
        };
        let spheres = self.spheres.par_iter().with_min_len(1 << 12).map(reach);
        let reach = spheres.reduce(|| [f64::NEG_INFINITY; N], farther);
        from_fn(|i| reach[i] + self.origin.dot(along[i]))
    }
}

impl Cylinders {
    fn reach<const N: usize>(&self, along: [DVec3; N]) -> [f64; N] {
        let lengths = along.map(DVec3::length);
        let reach = |ends: &[[f32; 4]; 2]| {
            let [(a, r), (b, r_to)] =
                ends.map(|[x, y, z, radius]| (Vec3::new(x, y, z).as_dvec3(), f64::from(radius)));
            let end = |p: DVec3, radius: f64| match self.caps {
                Caps::Round => from_fn(|i| p.dot(along[i]) + radius * lengths[i]),
                Caps::Flat | Caps::Open => disc(along, p, b - a, radius),
            };
            farther(end(a, r), end(b, r_to))
        };
        let segments = self.segments.par_iter().with_min_len(1 << 12).map(reach);
        let reach = segments.reduce(|| [f64::NEG_INFINITY; N], farther);
        from_fn(|i| reach[i] + self.origin.dot(along[i]))
    }
}

/// How far a disc reaches.
fn disc<const N: usize>(along: [DVec3; N], center: DVec3, normal: DVec3, radius: f64) -> [f64; N] {
    let axis = normal.normalize_or_zero();
    along.map(|n| center.dot(n) + radius * (n - axis * axis.dot(n)).length())
}

fn farther<const N: usize>(a: [f64; N], b: [f64; N]) -> [f64; N] {
    from_fn(|i| a[i].max(b[i]))
}
