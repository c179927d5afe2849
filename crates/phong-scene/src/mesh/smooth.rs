//! Shading normals for a mesh that brings none.

use std::ops::Range;

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::{Mesh, NO_INDEX, PIECE, Shared};

/// Vertices that one task smooths.
const GROUP: usize = 1 << 12;

/// Faces that a corner is compared with at most, half of them before and half behind its own
/// in the mesh: a hub of many thousand spokes must not cost its square.
const COMPARED: usize = 512;

impl Mesh {
    /// Gives every corner the mean of the normals of the faces that meet its own at the same
    /// position under at most `crease_degrees` (0–180), weighted by area, in place of the normals
    /// the mesh had.
    ///
    /// Positions count as the same if their coordinates are equal, whatever their numbers, so
    /// seams and triangles that share no vertices are smoothed too. Faces without area give no
    /// normal and get none. The result does not depend on the number of threads. A mesh of more
    /// than `u32::MAX / 3` triangles is left with geometric normals, as is one with an index out of
    /// range.
    ///
    /// ```
    /// use phong_scene::Mesh;
    /// # use glam::Vec3;
    /// // Two faces of a roof whose normals differ by 90°.
    /// let mut roof = Mesh {
    ///     positions: [Vec3::Y, Vec3::Y + Vec3::Z, Vec3::X, -Vec3::X].into(),
    ///     indices: [[0, 1, 2], [1, 0, 3]].into(),
    ///     ..Mesh::default()
    /// };
    /// roof.smooth(60.0);
    /// assert_eq!(roof.normals.len(), 6); // the ridge stays sharp
    /// roof.smooth(100.0);
    /// assert_eq!(roof.normals[0], Vec3::Y); // the ridge is round
    /// ```
    pub fn smooth(&mut self, crease_degrees: f64) {
        self.normals = Shared::default();
        self.normal_indices = Shared::default();
        if self.indices.len() > (u32::MAX / 3) as usize || !self.has_sound_indices() {
            return;
        }
        let least = libm::cos(crease_degrees.clamp(0.0, 180.0).to_radians());
        let areas = self.area_vectors();
        let places = places(&self.positions);
        let place = |i: u32| places.as_ref().map_or(i, |places| places[i as usize]) as usize;

        // The faces at every place, in ascending order, all places behind one another.
        let mut ends = vec![0_u32; self.positions.len() + 1];
        for &corner in self.indices.iter().flatten() {
            ends[place(corner) + 1] += 1;
        }
        for i in 1..ends.len() {
            ends[i] += ends[i - 1];
        }
        let starts = ends;
        let mut next = starts.clone();
        let mut faces = vec![0_u32; 3 * self.indices.len()];
        let mut slots = self.indices.to_vec();
        for (face, corners) in slots.iter_mut().enumerate() {
            for corner in corners {
                let slot = &mut next[place(*corner)];
                faces[*slot as usize] = face as u32;
                *corner = *slot;
                *slot += 1;
            }
        }
        drop(next);

        // Each group of places writes its normals, and in place of the faces the normals' numbers.
        let mut rest = faces.as_mut_slice();
        let mut tasks = Vec::new();
        for first in (0..self.positions.len()).step_by(GROUP) {
            let last = (first + GROUP).min(self.positions.len());
            let (mine, others) = rest.split_at_mut((starts[last] - starts[first]) as usize);
            tasks.push((&starts[first..=last], mine));
            rest = others;
        }
        let groups: Vec<Vec<Vec3>> = tasks
            .into_par_iter()
            .map(|(starts, faces)| {
                let mut normals = Vec::with_capacity(starts.len());
                let mut scratch = Vec::new();
                for ends in starts.windows(2) {
                    let range = (ends[0] - starts[0]) as usize..(ends[1] - starts[0]) as usize;
                    smooth_place(&mut faces[range], &areas, least, &mut normals, &mut scratch);
                }
                normals
            })
            .collect();
        drop(areas);

        let mut bases = Vec::with_capacity(groups.len());
        let mut total = 0;
        for group in &groups {
            bases.push(total as u32);
            total += group.len();
        }
        self.normals.reserve_exact(total);
        self.normals.extend(groups.iter().flatten());
        drop(groups);
        slots.par_iter_mut().zip(self.indices.par_iter()).with_min_len(PIECE).for_each(
            |(slots, corners)| {
                for (slot, &corner) in slots.iter_mut().zip(corners) {
                    let number = faces[*slot as usize];
                    let base = bases[place(corner) / GROUP];
                    *slot = if number == NO_INDEX { NO_INDEX } else { base + number };
                }
            },
        );
        if self.normals.len() != self.positions.len() || self.indices != slots {
            self.normal_indices = slots.into();
        }
    }

    /// Twice the area of every face along its normal, in units that make the mesh's size 1.
    pub(super) fn area_vectors(&self) -> Vec<Vec3> {
        let size = self.bounds().size().max_element();
        let scale = if size > 0.0 { size.recip() } else { 1.0 };
        let face = |corners: &[u32; 3]| {
            let [a, b, c] = corners.map(|i| self.positions[i as usize].as_dvec3() * scale);
            (b - a).cross(c - a).as_vec3()
        };
        self.indices.par_iter().with_min_len(PIECE).map(face).collect()
    }
}

/// Adds the normals of one place to `normals`, and replaces each of its faces by the number of
/// the normal that the face's corner gets.
fn smooth_place(
    faces: &mut [u32],
    areas: &[Vec3],
    least: f64,
    normals: &mut Vec<Vec3>,
    scratch: &mut Vec<(DVec3, f64)>,
) {
    scratch.clear();
    scratch.extend(faces.iter().map(|&face| {
        let area = areas[face as usize].as_dvec3();
        (area, area.length())
    }));
    let first = normals.len();
    // Where all are within half the angle of their mean, no two are farther apart than the whole.
    let mean: DVec3 = scratch.iter().map(|(area, _)| *area).sum();
    let half = (0.5 + 0.5 * least).max(0.0).sqrt() * mean.length();
    if mean != DVec3::ZERO && scratch.iter().all(|(area, l)| *l > 0.0 && area.dot(mean) >= half * l)
    {
        normals.push(unit(mean));
        faces.fill(first as u32);
        return;
    }
    for (i, face) in faces.iter_mut().enumerate() {
        let (own, length) = scratch[i];
        if length == 0.0 {
            *face = NO_INDEX;
            continue;
        }
        let sum: DVec3 = scratch[window(i, scratch.len())]
            .iter()
            .filter(|(area, l)| own.dot(*area) >= least * length * l)
            .map(|(area, _)| *area)
            .sum();
        let normal = unit(if sum == DVec3::ZERO { own } else { sum });
        // Corners of one round part have the same sum to the bit, and share it.
        let from = first.max(normals.len().saturating_sub(8));
        let number = normals[from..].iter().position(|n| *n == normal).map_or_else(
            || {
                normals.push(normal);
                normals.len() - 1
            },
            |at| from + at,
        );
        *face = number as u32;
    }
}

fn window(i: usize, count: usize) -> Range<usize> {
    if count <= COMPARED {
        return 0..count;
    }
    let start = i.saturating_sub(COMPARED / 2).min(count - COMPARED);
    start..start + COMPARED
}

fn unit(v: DVec3) -> Vec3 {
    (v / v.length()).as_vec3()
}

/// For every position the first one with the same coordinates; `None` if all differ.
pub(super) fn places(positions: &[Vec3]) -> Option<Vec<u32>> {
    let key = |p: Vec3| {
        // Adding 0 makes −0 the same as 0.
        let [x, y, z] = (p + 0.0).to_array().map(|c| u64::from(c.to_bits()));
        let mixed = (x | y << 32).wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ z;
        (mixed ^ mixed >> 29).wrapping_mul(0xbf58_476d_1ce4_e5b9)
    };
    let mut sorted: Vec<(u64, u32)> =
        positions.par_iter().enumerate().map(|(i, p)| (key(*p), i as u32)).collect();
    sorted.par_sort_unstable();
    let mut places: Option<Vec<u32>> = None;
    for run in sorted.chunk_by(|a, b| a.0 == b.0).filter(|run| run.len() > 1) {
        // Of equal keys, all but freaks are of equal positions.
        let mut distinct: Vec<u32> = Vec::new();
        for &(_, i) in run {
            let same = |j: &&u32| positions[**j as usize] == positions[i as usize];
            match distinct.iter().find(same) {
                Some(&first) => {
                    places.get_or_insert_with(|| (0..positions.len() as u32).collect())
                        [i as usize] = first;
                }
                None => distinct.push(i),
            }
        }
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A closed box of unit edges, its corners shared.
    fn cube() -> Mesh {
        let positions =
            (0..8).map(|i| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32));
        let quads =
            [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let indices = quads.iter().flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]).collect();
        Mesh { positions: positions.collect(), indices, ..Mesh::default() }
    }

    fn corner_normals(mesh: &Mesh) -> Vec<[Vec3; 3]> {
        let numbers =
            if mesh.normal_indices.is_empty() { &mesh.indices } else { &mesh.normal_indices };
        numbers.iter().map(|t| t.map(|i| mesh.normals[i as usize])).collect()
    }

    #[test]
    fn the_edges_of_a_cube_stay_sharp_under_sixty_degrees() {
        let mut cube = cube();
        cube.smooth(60.0);
        assert_eq!(cube.normals.len(), 24);
        for (triangle, normals) in cube.indices.iter().zip(corner_normals(&cube)) {
            let [a, b, c] = triangle.map(|i| cube.positions[i as usize]);
            assert_eq!(normals, [(b - a).cross(c - a); 3]);
        }
    }

    #[test]
    fn under_a_wide_crease_a_cube_has_one_normal_a_corner_and_needs_no_numbers() {
        let mut cube = cube();
        cube.smooth(100.0);
        assert_eq!((cube.normals.len(), cube.normal_indices.len()), (8, 0));
        for (p, n) in cube.positions.iter().zip(&cube.normals) {
            // Faces count by area: one or two triangles of a side meet at a corner.
            assert!((*p - 0.5).dot(*n) > 0.7, "{p} {n}");
        }
    }

    #[test]
    fn triangles_that_share_no_vertex_are_smoothed_like_those_that_do() {
        let shared = cube();
        let mut soup = Mesh {
            positions: shared
                .indices
                .iter()
                .flatten()
                .map(|&i| shared.positions[i as usize])
                .collect(),
            indices: (0..12).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
            ..Mesh::default()
        };
        soup.positions[0].x = -0.0;
        for crease in [30.0, 100.0] {
            let mut shared = shared.clone();
            shared.smooth(crease);
            soup.smooth(crease);
            assert_eq!(corner_normals(&soup), corner_normals(&shared));
        }
    }

    #[test]
    fn a_face_without_area_gives_no_normal_and_gets_none() {
        let mut mesh = cube();
        mesh.indices.push([0, 0, 7]);
        mesh.smooth(60.0);
        assert_eq!(mesh.normals.len(), 24);
        assert_eq!(mesh.normal_indices[12], [NO_INDEX; 3]);
    }

    #[test]
    fn tiny_and_huge_meshes_have_the_same_normals() {
        let mut expected = cube();
        expected.smooth(100.0);
        for scale in [1e-30, 1e-6, 1e18, 1e30] {
            let mut scaled = cube();
            scaled.positions.iter_mut().for_each(|p| *p *= scale);
            scaled.smooth(100.0);
            for (a, b) in expected.normals.iter().zip(&scaled.normals) {
                assert!(a.distance(*b) < 1e-6, "{scale}: {a} {b}");
            }
        }
    }

    #[test]
    fn a_hub_of_many_spokes_is_smoothed_in_time_to_unit_normals() {
        let n = 100_000_u32;
        let rim = (0..n).map(|i| {
            let angle = std::f64::consts::TAU * f64::from(i) / f64::from(n);
            let wave = if i % 2 == 0 { 0.0 } else { 1e-3 };
            Vec3::new(libm::cos(angle) as f32, libm::sin(angle) as f32, wave)
        });
        let mut mesh = Mesh {
            positions: rim.chain([Vec3::Z]).collect(),
            indices: (0..n).map(|i| [i, (i + 1) % n, n]).collect(),
            ..Mesh::default()
        };
        mesh.smooth(60.0);
        assert!(mesh.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-6));
    }

    #[test]
    fn any_number_of_threads_gives_the_same_bits() {
        let mut mesh = cube();
        for level in 0..7 {
            // Split every triangle and ruffle what is new.
            let mut finer = Mesh { positions: mesh.positions.clone(), ..Mesh::default() };
            for (i, t) in mesh.indices.iter().enumerate() {
                let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
                let ruffle = 0.02 * ((i * 31 + level * 7) % 11) as f32;
                let middle = finer.positions.len() as u32;
                finer.positions.push((a + b + c) / 3.0 + ruffle * (b - a).cross(c - a));
                finer.indices.extend([
                    [t[0], t[1], middle],
                    [t[1], t[2], middle],
                    [t[2], t[0], middle],
                ]);
            }
            mesh = finer;
        }
        let smoothed = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let mut mesh = mesh.clone();
            pool.install(|| mesh.smooth(40.0));
            (mesh.normals, mesh.normal_indices)
        };
        assert!(smoothed(1) == smoothed(5));
    }
}
