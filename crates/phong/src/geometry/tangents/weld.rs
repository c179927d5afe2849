//! Corners of triangles that are one: of the same position, normal and texture coordinates.

use glam::{Vec2, Vec3};

use super::Corners;

/// How many slices the corners are parted into along the longest side of their box.
const SLICES: u16 = 2048;

/// A corner where it lies: three times its triangle, and which of the three it is.
#[derive(Clone, Copy, Default)]
struct Placed {
    position: [f32; 3],
    corner: u32,
}

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
    let mut known = Vec::new();
    let (mut placed, starts) = sliced(mesh, faces);
    let mut rest = &mut placed[..];
    for ends in starts.windows(2) {
        let slice = rest.split_off_mut(..(ends[1] - ends[0]) as usize).unwrap_or_default();
        merge(mesh, stands.as_flattened_mut(), slice, &mut known);
    }
    drop(placed);
    numbered(stands)
}

/// All corners, slice after slice, and where each slice starts and the last ends.
fn sliced(mesh: &Corners<'_>, faces: &[u32]) -> (Vec<Placed>, Vec<u32>) {
    let at = |face: u32| mesh.positions_of(face as usize);
    let [min, max] = bounds(faces.iter().flat_map(|&face| at(face)));
    let along = longest(min, max);
    let size = max[along] - min[along];
    let slice = |position: [f32; 3]| {
        let t = (position[along] - min[along]) / size;
        // NaN becomes 0.
        ((f32::from(SLICES) * t.clamp(0.0, 1.0)) as u16).min(SLICES - 1)
    };
    let mut starts = vec![0; usize::from(SLICES) + 1];
    for position in faces.iter().flat_map(|&face| at(face)) {
        starts[usize::from(slice(position)) + 1] += 1;
    }
    for i in 1..starts.len() {
        starts[i] += starts[i - 1];
    }
    let mut next = starts.clone();
    let mut placed = vec![Placed::default(); 3 * faces.len()];
    for &face in faces {
        for (corner, position) in (3 * face..).zip(at(face)) {
            let next = &mut next[usize::from(slice(position))];
            placed[*next as usize] = Placed { position, corner };
            *next += 1;
        }
    }
    (placed, starts)
}

/// Halves a box of corners until all that it holds is in one place, and welds these.
fn merge(
    mesh: &Corners<'_>,
    stands: &mut [u32],
    placed: &mut [Placed],
    known: &mut Vec<(u32, [f32; 3], Vec3, Vec2)>,
) {
    if placed.len() < 2 {
        return;
    }
    let [min, max] = bounds(placed.iter().map(|placed| placed.position));
    let along = longest(min, max);
    let middle = 0.5 * (max[along] + min[along]);
    if !middle.is_finite() {
        return;
    }
    if !(min[along] < middle && middle < max[along]) {
        known.clear();
        for &Placed { position, corner } in &*placed {
            let (normal, uv) = mesh.attributes(corner);
            let mut all =
                known.iter().filter(|known| (known.1, known.2, known.3) == (position, normal, uv));
            match all.next() {
                Some(&(first, ..)) => stands[corner as usize] = first,
                None => known.push((corner, position, normal, uv)),
            }
        }
        return;
    }
    let (mut left, mut right) = (0, placed.len());
    loop {
        while left < right && placed[left].position[along] < middle {
            left += 1;
        }
        while left < right && placed[right - 1].position[along] >= middle {
            right -= 1;
        }
        if left >= right {
            break;
        }
        placed.swap(left, right - 1);
        (left, right) = (left + 1, right - 1);
    }
    let (lesser, greater) = placed.split_at_mut(left);
    merge(mesh, stands, lesser, known);
    merge(mesh, stands, greater, known);
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

fn bounds(positions: impl Iterator<Item = [f32; 3]>) -> [[f32; 3]; 2] {
    let (mut min, mut max) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for position in positions {
        for axis in 0..3 {
            let x = position[axis];
            min[axis] = if x < min[axis] { x } else { min[axis] };
            max[axis] = if x > max[axis] { x } else { max[axis] };
        }
    }
    [min, max]
}

fn longest(min: [f32; 3], max: [f32; 3]) -> usize {
    let [x, y, z] = [0, 1, 2].map(|axis| max[axis] - min[axis]);
    if y > x && y > z {
        1
    } else if z > x {
        2
    } else {
        0
    }
}
