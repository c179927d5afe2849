//! Tangents of groups: what their triangles add, by the angle of each about the point.

use fearless_simd::Simd;
use phong_bvh::Kernel;

use super::Corners;
use super::edges::NONE;
use super::groups::{Groups, Hand};
use super::slopes::{Slopes8, about, unit};
use super::weld::Welded;
use crate::math::lanes::{Lanes3, dot, get, load3, set, store3};

/// Slopes as far apart as that from the first of a group at most are never opposite one another.
const SAME_SIDE: f32 = 0.1;

/// What a group is made of so far.
#[derive(Clone, Copy, Default)]
struct Sum {
    tangent: [f32; 3],
    /// The slopes of its first triangle across the normal.
    first: Option<[[f32; 3]; 2]>,
    /// Whether slopes in it may be opposite one another.
    is_split: bool,
}

/// What tangents are made of.
pub(super) struct Sums<'a> {
    pub(super) mesh: &'a Corners<'a>,
    pub(super) welded: &'a Welded,
    /// The triangles, the numbers of their corners, their slopes and hands.
    pub(super) faces: &'a [u32],
    pub(super) slopes: &'a [Slopes8],
    pub(super) hands: &'a [Hand],
    /// Their groups; what falls off one that falls apart gets a number of its own.
    pub(super) groups: &'a mut Groups,
}

/// Positions and normals of corners that are one.
struct Points {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
}

impl Kernel for Sums<'_> {
    /// The tangent of each group, and 1 or −1 for its hand; then those of what fell off some.
    type Output = Vec<[f32; 4]>;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> Self::Output {
        let points = Points::of(self.mesh, self.welded);
        let mut sums = vec![Sum::default(); self.groups.each.len()];
        for (eight, slopes) in self.slopes.iter().enumerate() {
            let first = 8 * eight;
            let faces = &self.faces[first..self.faces.len().min(first + 8)];
            let numbers = |face: u32| self.welded.numbers[face as usize];
            let mut positions = [[[0.0; 8]; 3]; 3];
            let mut normals: [Lanes3; 3] = [[[0.0; 8]; 3]; 3];
            for (lane, &face) in faces.iter().enumerate() {
                for (i, number) in numbers(face).into_iter().enumerate() {
                    set(&mut positions[i], lane, points.positions[number as usize]);
                    set(&mut normals[i], lane, points.normals[number as usize]);
                }
            }
            let [a, b, c] = &positions;
            let positions = [load3(simd, a), load3(simd, b), load3(simd, c)];
            let mut of_corners = [([[[0.0; 8]; 3]; 2], [0.0; 8]); 3];
            for (i, of_corner) in of_corners.iter_mut().enumerate() {
                let p = [positions[i], positions[(i + 1) % 3], positions[(i + 2) % 3]];
                let (across, angle) = about(load3(simd, &normals[i]), p, slopes.load(simd));
                let [s, t] = across;
                *of_corner = ([store3(s), store3(t)], angle.into());
            }
            // Triangle after triangle, as the original adds them.
            for lane in 0..faces.len() {
                if self.hands[first + lane].is_any {
                    continue;
                }
                for (([s, t], angle), group) in of_corners.iter().zip(self.groups.of[first + lane])
                {
                    if let Some(sum) = sums.get_mut(group as usize) {
                        sum.add([get(s, lane), get(t, lane)], angle[lane]);
                    }
                }
            }
        }
        let tangent = |(sum, hand): (&Sum, &Hand)| hand.with(unit(sum.tangent));
        let mut all: Vec<_> = sums.iter().zip(&self.groups.each).map(tangent).collect();
        self.split(&points, |group| sums[group as usize].is_split, &mut all);
        all
    }
}

impl Sums<'_> {
    /// Tangents of groups that fall apart: each triangle takes those into account whose slopes are not opposite to its.
    fn split(self, points: &Points, is_split: impl Fn(u32) -> bool, all: &mut Vec<[f32; 4]>) {
        let corners = (0..).zip(self.groups.of.as_flattened());
        let split = corners.filter(|&(_, &group)| group != NONE && is_split(group));
        let mut split: Vec<(u32, u32)> = split.map(|(corner, &group)| (group, corner)).collect();
        split.sort_unstable();
        for corners in split.chunk_by(|a, b| a.0 == b.0) {
            let parts: Vec<_> =
                corners.iter().map(|&(_, corner)| self.part(points, corner)).collect();
            for (i, (a, &(group, corner))) in parts.iter().zip(corners).enumerate() {
                let mut sum = [0.0; 3];
                for b in &parts {
                    let goes_along = |k: usize| dot(a.0[k], b.0[k]) > -1.0;
                    let is_any = a.2 || b.2;
                    let is_same = std::ptr::eq(a, b);
                    if (is_any || is_same || goes_along(0) && goes_along(1)) && !b.2 {
                        add(&mut sum, b.0[0], b.1);
                    }
                }
                let tangent = self.groups.each[group as usize].with(unit(sum));
                if i == 0 {
                    all[group as usize] = tangent;
                } else {
                    self.groups.of.as_flattened_mut()[corner as usize] = all.len() as u32;
                    all.push(tangent);
                }
            }
        }
    }

    /// What one triangle adds about one of its corners, and whether it goes along with any.
    fn part(&self, points: &Points, corner: u32) -> ([[f32; 3]; 2], f32, bool) {
        let (face, i) = (corner as usize / 3, corner as usize % 3);
        let numbers = self.welded.numbers[self.faces[face] as usize];
        let p = [0, 1, 2].map(|k| points.positions[numbers[(i + k) % 3] as usize]);
        let n = points.normals[numbers[i] as usize];
        let (across, angle) = about(n, p, Slopes8::of(self.slopes, face));
        (across, angle, self.hands[face].is_any)
    }
}

impl Sum {
    fn add(&mut self, slopes: [[f32; 3]; 2], angle: f32) {
        let first = *self.first.get_or_insert(slopes);
        // NaN is on no side.
        let same_side = |k: usize| dot(first[k], slopes[k]) > SAME_SIDE;
        self.is_split |= !(same_side(0) && same_side(1));
        add(&mut self.tangent, slopes[0], angle);
    }
}

fn add(sum: &mut [f32; 3], slope: [f32; 3], angle: f32) {
    for (sum, slope) in sum.iter_mut().zip(slope) {
        *sum += angle * slope;
    }
}

impl Points {
    fn of(mesh: &Corners<'_>, welded: &Welded) -> Self {
        let position = |&corner: &u32| mesh.positions_of(corner as usize / 3)[corner as usize % 3];
        let normal = |&corner: &u32| mesh.attributes(corner).0.to_array();
        Self {
            positions: welded.first.iter().map(position).collect(),
            normals: welded.first.iter().map(normal).collect(),
        }
    }
}
