//! Corners of triangles that are one: of the same position, normal and texture coordinates.

use glam::{Vec2, Vec3};

use super::Corners;

/// How many slices the corners are parted into along the longest side of their box.
const SLICES: u16 = 2048;

/// A position, and in the place of a fourth coordinate the bits of the corner that is there.
type Placed = [f32; 4];

/// Corners that are one, numbered together.
pub(super) struct Welded {
    /// The number of each corner of each triangle.
    pub(super) numbers: Vec<[u32; 3]>,
    /// For each number the corner that stands for all of it, rising.
    pub(super) first: Vec<u32>,
}

/// Welds the corners of the triangles, which are looked at in the order of `faces`.
///
/// Which of equal corners stands for them hardly matters, but in the end it decides which edges the sorting of the
/// original misses. So places are halved just as there.
pub(super) fn weld(mesh: &Corners<'_>, faces: &[u32]) -> Welded {
    let all = 0..mesh.indices.len() as u32;
    let mut stands: Vec<_> = all.map(|face| [3 * face, 3 * face + 1, 3 * face + 2]).collect();
    let (corners, starts) = sliced(mesh, faces);
    let mut merging = Merging {
        mesh,
        stands: stands.as_flattened_mut(),
        known: Vec::new(),
        swaps: [Vec::new(), Vec::new()],
    };
    let mut placed = Vec::new();
    for ends in starts.windows(2) {
        placed.clear();
        placed.extend(corners[ends[0] as usize..ends[1] as usize].iter().map(|&corner| {
            let [x, y, z] = mesh.position(mesh.vertex(corner));
            [x, y, z, f32::from_bits(corner)]
        }));
        merging.merge(&mut placed);
    }
    drop(corners);
    numbered(stands)
}

/// All corners, slice after slice, and where each slice starts and the last ends.
fn sliced(mesh: &Corners<'_>, faces: &[u32]) -> (Vec<u32>, Vec<u32>) {
    let mut box_of_all = EMPTY;
    for &vertex in mesh.indices.as_flattened() {
        let [x, y, z] = mesh.position(vertex);
        box_of_all = around(box_of_all, [[x, y, z, 0.0]; 2]);
    }
    let [min, max] = box_of_all;
    let along = longest(min, max);
    let size = max[along] - min[along];
    let slice = |position: &Vec3| {
        let t = (position[along] - min[along]) / size;
        // NaN becomes 0.
        ((f32::from(SLICES) * t.clamp(0.0, 1.0)) as u16).min(SLICES - 1)
    };
    let slices: Vec<u16> = mesh.positions.iter().map(slice).collect();
    let mut starts = vec![0; usize::from(SLICES) + 1];
    for &vertex in mesh.indices.as_flattened() {
        starts[usize::from(slices[vertex as usize]) + 1] += 1;
    }
    for i in 1..starts.len() {
        starts[i] += starts[i - 1];
    }
    let mut next = starts.clone();
    let mut corners = vec![0; 3 * faces.len()];
    for &face in faces {
        for (corner, vertex) in (3 * face..).zip(mesh.indices[face as usize]) {
            let next = &mut next[usize::from(slices[vertex as usize])];
            corners[*next as usize] = corner;
            *next += 1;
        }
    }
    (corners, starts)
}

/// What corners are welded with.
struct Merging<'a> {
    mesh: &'a Corners<'a>,
    /// The corner that stands for each.
    stands: &'a mut [u32],
    /// The corners that stand for others in a place.
    known: Vec<Known>,
    /// Which corners change sides, those of the lesser side and those of the greater.
    swaps: [Vec<u32>; 2],
}

/// A corner that stands for others.
struct Known {
    corner: u32,
    /// Its vertex, if all corners there are one.
    vertex: Option<u32>,
    attributes: ([f32; 3], Vec3, Vec2),
}

impl Merging<'_> {
    /// Halves a box of corners until all that it holds is in one place, and welds these.
    fn merge(&mut self, placed: &mut [Placed]) {
        if placed.len() < 2 {
            return;
        }
        let [min, max] = bounds(placed);
        let along = longest(min, max);
        let middle = 0.5 * (max[along] + min[along]);
        if !middle.is_finite() {
            return;
        }
        if min[along] < middle && middle < max[along] {
            let (lesser, greater) = part(placed, along, middle, &mut self.swaps);
            self.merge(lesser);
            self.merge(greater);
        } else {
            self.weld(placed);
        }
    }

    /// Welds corners in one place.
    fn weld(&mut self, placed: &[Placed]) {
        self.known.clear();
        for &[x, y, z, corner] in placed {
            let corner = corner.to_bits();
            let vertex = self.mesh.vertex(corner);
            if let Some(last) = self.known.last().filter(|last| last.vertex == Some(vertex)) {
                self.stands[corner as usize] = last.corner;
                continue;
            }
            let (normal, uv) = self.mesh.attributes(corner);
            let attributes = ([x, y, z], normal, uv);
            if let Some(known) = self.known.iter().find(|known| known.attributes == attributes) {
                self.stands[corner as usize] = known.corner;
            } else {
                let vertex = Some(vertex).filter(|&vertex| self.mesh.is_one(vertex));
                self.known.push(Known { corner, vertex, attributes });
            }
        }
    }
}

/// Parts corners into those below `middle` and the others: the first that is on the wrong side changes places with the
/// last that is, and so on. Sides are as good as tossed, so nothing branches on them.
fn part<'a>(
    placed: &'a mut [Placed],
    along: usize,
    middle: f32,
    swaps: &mut [Vec<u32>; 2],
) -> (&'a mut [Placed], &'a mut [Placed]) {
    let is_below = |placed: &Placed| placed[along] < middle;
    let below = placed.iter().filter(|placed| is_below(placed)).count();
    let [up, down] = swaps;
    for list in [&mut *up, &mut *down] {
        list.resize(list.len().max(placed.len()), 0);
    }
    let (lesser, greater) = placed.split_at_mut(below);
    let mut count = 0;
    for (i, placed) in lesser.iter().enumerate() {
        up[count] = i as u32;
        count += usize::from(!is_below(placed));
    }
    let mut found = 0;
    for (i, placed) in greater.iter().enumerate().rev() {
        down[found] = i as u32;
        found += usize::from(is_below(placed));
    }
    for (&i, &k) in up[..count].iter().zip(&*down) {
        std::mem::swap(&mut lesser[i as usize], &mut greater[k as usize]);
    }
    (lesser, greater)
}

/// Numbers corners by those that stand for them.
fn numbered(mut stands: Vec<[u32; 3]>) -> Welded {
    let mut first = Vec::with_capacity(stands.len() / 2);
    let mut numbers = vec![[0; 3]; stands.len()];
    let all = numbers.as_flattened_mut();
    for (corner, &stand) in (0..).zip(stands.as_flattened()) {
        if corner == stand {
            all[corner as usize] = first.len() as u32;
            first.push(corner);
        }
    }
    for stand in stands.as_flattened_mut() {
        *stand = all[*stand as usize];
    }
    Welded { numbers: stands, first }
}

/// The bounds of nothing.
const EMPTY: [Placed; 2] = [[f32::INFINITY; 4], [f32::NEG_INFINITY; 4]];

/// The bounds of positions; what they have for a fourth coordinate is of no use.
fn bounds(placed: &[Placed]) -> [Placed; 2] {
    // Four at a time, so that one does not wait for the other.
    let mut all = [EMPTY; 4];
    let (fours, rest) = placed.as_chunks::<4>();
    for four in fours {
        for (bounds, position) in all.iter_mut().zip(four) {
            *bounds = around(*bounds, [*position; 2]);
        }
    }
    for (bounds, position) in all.iter_mut().zip(rest) {
        *bounds = around(*bounds, [*position; 2]);
    }
    let [a, b, c, d] = all;
    around(around(a, b), around(c, d))
}

/// The bounds of two boxes.
#[inline(always)]
fn around([mut min, mut max]: [Placed; 2], [low, high]: [Placed; 2]) -> [Placed; 2] {
    for axis in 0..4 {
        min[axis] = if low[axis] < min[axis] { low[axis] } else { min[axis] };
        max[axis] = if high[axis] > max[axis] { high[axis] } else { max[axis] };
    }
    [min, max]
}

fn longest(min: Placed, max: Placed) -> usize {
    let [x, y, z] = [0, 1, 2].map(|axis| max[axis] - min[axis]);
    if y > x && y > z {
        1
    } else if z > x {
        2
    } else {
        0
    }
}
