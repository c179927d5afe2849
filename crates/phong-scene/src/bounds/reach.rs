//! How far things reach along directions: their support functions.
//!
//! A thing lies within a half-space exactly if it reaches no farther along the half-space's
//! normal than the half-space does. Boxes are six half-spaces, and a picture's view is four.

use std::array::from_fn;

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::{Bounds, bounds_of_groups};
use crate::mesh::{Caps, Cylinders, Mesh, PIECE, Points};
use crate::scene::{Object, Scene};
use crate::shape::{Shape, disc, farther, farthest};

impl Scene {
    /// The largest `p · n` of all points p of all objects but planes, for each n of `along`;
    /// −∞ if there are none. Of an instance, its group's box counts.
    pub(crate) fn reach<const N: usize>(&self, along: [DVec3; N]) -> [f64; N] {
        let groups = bounds_of_groups(&self.groups);
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
        Some(match *self {
            Self::Mesh(ref mesh) => mesh.reach(along),
            Self::Points(ref points) => points.reach(along),
            Self::Cylinders(ref cylinders) => cylinders.reach(along),
            Self::Instance(group) => match groups.get(group.0 as usize) {
                Some(bounds) if !bounds.is_empty() => farthest(along, &bounds.corners()),
                _ => return None,
            },
            ref single => return single.own_reach(along),
        })
    }
}

impl Mesh {
    fn reach<const N: usize>(&self, along: [DVec3; N]) -> [f64; N] {
        let (min, max) = self.extremes();
        // A position outside the box belongs to no triangle.
        let within = |p: &&Vec3| p.cmpge(min).all() && p.cmple(max).all();
        let nowhere = [f64::NEG_INFINITY; N];
        let reach = |far: [f64; N], p: &Vec3| {
            let p = p.as_dvec3();
            from_fn(|i| {
                let along = p.dot(along[i]);
                if along > far[i] { along } else { far[i] }
            })
        };
        let of_piece = |piece: &[Vec3]| piece.iter().filter(within).fold(nowhere, reach);
        let reach = self.positions.par_chunks(PIECE).map(of_piece).reduce(|| nowhere, farther);
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
        let spheres = self.spheres.par_iter().with_min_len(PIECE).map(reach);
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
        let segments = self.segments.par_iter().with_min_len(PIECE).map(reach);
        let reach = segments.reduce(|| [f64::NEG_INFINITY; N], farther);
        from_fn(|i| reach[i] + self.origin.dot(along[i]))
    }
}
