//! Triangles that are made: profiles turned about their axes, and balls.

use std::f64::consts::TAU;

use glam::{DVec3, Vec3};

use super::profile::{Profile, Ring};
use crate::color::Rgb;
use crate::mesh::Mesh;

/// What has been made, about one origin.
#[derive(Debug, Default)]
pub(super) struct Turned {
    positions: Vec<Vec3>,
    colors: Vec<Rgb>,
    normals: Vec<Vec3>,
    indices: Vec<[u32; 3]>,
    normal_indices: Vec<[u32; 3]>,
}

impl Turned {
    /// Adds triangles of which every corner has a normal of its own.
    pub(super) fn closed(
        &mut self,
        corners: impl Iterator<Item = (Vec3, Vec3)>,
        triangles: &[[u32; 3]],
        color: Option<Rgb>,
    ) {
        let (first, normal) = (self.positions.len() as u32, self.normals.len() as u32);
        for (position, normal) in corners {
            self.positions.push(position);
            self.normals.push(normal);
            self.colors.extend(color);
        }
        self.indices.extend(triangles.iter().map(|corners| corners.map(|i| first + i)));
        self.normal_indices.extend(triangles.iter().map(|corners| corners.map(|i| normal + i)));
    }

    /// Adds what a profile becomes when it is turned about an axis that begins at `from`.
    pub(super) fn turn(&mut self, profile: &Profile, from: DVec3, axis: DVec3) {
        let axis = axis.normalize_or(DVec3::Y);
        let (u, v) = axis.any_orthonormal_pair();
        let around = profile.around;
        let away = |part: f64| {
            let angle = TAU * part / f64::from(around);
            libm::cos(angle) * u + libm::sin(angle) * v
        };
        let ways: Vec<DVec3> = (0..around).map(|part| away(part.into())).collect();
        let firsts: Vec<u32> = profile
            .rings
            .iter()
            .map(|ring| {
                let first = self.positions.len() as u32;
                let middle = from + ring.along * axis;
                if ring.radius > 0.0 {
                    self.positions
                        .extend(ways.iter().map(|way| (middle + ring.radius * *way).as_vec3()));
                } else {
                    self.positions.push(middle.as_vec3());
                }
                self.colors
                    .extend(ring.color.iter().cycle().take(self.positions.len() - first as usize));
                first
            })
            .collect();
        let last = profile.rings.len().saturating_sub(1);
        let bands = profile.bands.iter().map(|band| ([band.ring, band.ring + 1], band.normals));
        let bands = bands.chain(profile.closing.map(|normals| ([last, 0], normals)));
        let mut before: Option<([f64; 2], u32)> = None;
        for (rings, normals) in bands {
            let ends = rings.map(|ring| (profile.rings[ring], firsts[ring]));
            let points = rings.map(|ring| profile.rings[ring].radius <= 0.0);
            let mut add = |end: usize| -> u32 {
                let [along, out] = normals[end];
                // Where the band before ends with this normal, it is there.
                let known =
                    before.filter(|(normal, _)| end == 0 && *normal == normals[0] && !points[0]);
                if let Some((_, first)) = known {
                    return first;
                }
                let first = self.normals.len() as u32;
                if out == 0.0 {
                    self.normals.push((along * axis).as_vec3());
                } else if points[end] {
                    // The tip of a cone has a normal for each of its triangles.
                    let middles = (0..around).map(|part| away(f64::from(part) + 0.5));
                    self.normals.extend(middles.map(|way| (along * axis + out * way).as_vec3()));
                } else {
                    self.normals
                        .extend(ways.iter().map(|way| (along * axis + out * *way).as_vec3()));
                }
                first
            };
            let starts = [add(0), add(1)];
            before = Some((normals[1], starts[1]));
            self.band(around, ends, [0, 1].map(|end| (starts[end], normals[end][1] == 0.0)));
        }
    }

    /// The triangles of one band.
    fn band(&mut self, around: u32, ends: [(Ring, u32); 2], normals: [(u32, bool); 2]) {
        let point = |end: usize| ends[end].0.radius <= 0.0;
        for part in 0..around {
            let parts = [part, (part + 1) % around];
            let corner = |end: usize, side: usize| {
                let (_, first) = ends[end];
                let (normal, one) = normals[end];
                let position = if point(end) { first } else { first + parts[side] };
                // A tip's normals are by triangle, and not by corner.
                let which = if point(end) { parts[0] } else { parts[side] };
                (position, if one { normal } else { normal + which })
            };
            let [a, b, c, d] = [corner(0, 0), corner(0, 1), corner(1, 0), corner(1, 1)];
            let mut push = |corners: [(u32, u32); 3]| {
                self.indices.push(corners.map(|(position, _)| position));
                self.normal_indices.push(corners.map(|(_, normal)| normal));
            };
            if !point(0) {
                push([a, b, if point(1) { c } else { d }]);
            }
            if !point(1) {
                push([a, d, c]);
            }
        }
    }

    /// All of it.
    pub(super) fn mesh(self, origin: DVec3) -> Mesh {
        // Of things of which but some have a colour, none has one.
        let colored = self.colors.len() == self.positions.len();
        Mesh {
            origin,
            positions: self.positions.into(),
            indices: self.indices.into(),
            normals: self.normals.into(),
            normal_indices: self.normal_indices.into(),
            colors: if colored { self.colors } else { Vec::new() }.into(),
            ..Mesh::default()
        }
    }
}
