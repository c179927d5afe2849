//! Which triangles are beside one another: those of an edge of the same corners, the other way round.

use super::weld::Welded;

/// No triangle, or no group.
pub(super) const NONE: u32 = u32::MAX;

/// An edge as a triangle has it: three times the triangle, and which of its corners the edge is behind.
#[derive(Clone, Copy, Default)]
struct Edge {
    /// The greater of the numbers of its corners; the lesser is that of its bucket.
    to: u32,
    edge: u32,
}

/// For each edge of each triangle `faces` the place among these of the triangle beside it, or [`NONE`].
pub(super) fn beside(welded: &Welded, faces: &[u32]) -> Vec<[u32; 3]> {
    let ends = |edge: u32| {
        let numbers = welded.numbers[faces[edge as usize / 3] as usize];
        let (i, next) = [(0, 1), (1, 2), (2, 0)][edge as usize % 3];
        [numbers[i], numbers[next]]
    };
    let all = 0..3 * faces.len() as u32;
    let mut starts = vec![0_u32; welded.first.len() + 1];
    for edge in all.clone() {
        let [a, b] = ends(edge);
        starts[a.min(b) as usize + 1] += 1;
    }
    for i in 1..starts.len() {
        starts[i] += starts[i - 1];
    }
    let mut sorted = vec![Edge::default(); 3 * faces.len()];
    let mut next = starts.clone();
    for edge in all.clone() {
        let [a, b] = ends(edge);
        let next = &mut next[a.min(b) as usize];
        sorted[*next as usize] = Edge { to: a.max(b), edge };
        *next += 1;
    }
    drop(next);
    let mut beside = vec![[NONE; 3]; faces.len()];
    let is_forward = |edge: u32| {
        let [a, b] = ends(edge);
        a < b
    };
    let last = (1..starts.len()).rev().find(|&i| starts[i] > starts[i - 1]);
    for i in 1..starts.len() {
        let bucket = &mut sorted[starts[i - 1] as usize..starts[i] as usize];
        match bucket {
            [] | [_] => continue,
            [_, _] => {}
            _ if last == Some(i) => {
                let number = i as u32 - 1;
                let whole = all.clone().map(|edge| {
                    let [a, b] = ends(edge);
                    (a.min(b), Edge { to: a.max(b), edge })
                });
                let unsorted = left_unsorted(whole.collect(), number);
                bucket.copy_from_slice(&unsorted);
            }
            _ => bucket.sort_unstable_by_key(|edge| (edge.to, edge.edge)),
        }
        pair(bucket, beside.as_flattened_mut(), is_forward);
    }
    beside
}

/// Pairs edges that follow one another, are of the same corners, and run the other way round.
fn pair(edges: &[Edge], beside: &mut [u32], is_forward: impl Fn(u32) -> bool) {
    for (i, a) in edges.iter().enumerate() {
        if beside[a.edge as usize] != NONE {
            continue;
        }
        let forward = is_forward(a.edge);
        let others = edges[i + 1..].iter().take_while(|b| b.to == a.to);
        let mut found =
            others.filter(|b| is_forward(b.edge) != forward && beside[b.edge as usize] == NONE);
        if let Some(b) = found.next() {
            beside[a.edge as usize] = b.edge / 3;
            beside[b.edge as usize] = a.edge / 3;
        }
    }
}

/// The edges whose lesser corner has the greatest number, in the order in which the original has them: of these alone
/// it does not sort what is left once all are sorted by their lesser corner, so that it may miss some.
fn left_unsorted(mut edges: Vec<(u32, Edge)>, greatest: u32) -> Vec<Edge> {
    sort_greatest(&mut edges, greatest);
    let mut last: Vec<Edge> =
        edges.into_iter().filter(|edge| edge.0 == greatest).map(|edge| edge.1).collect();
    let runs: Vec<_> = last.chunk_by_mut(|a, b| a.to == b.to).collect();
    for run in runs.into_iter().rev().skip(1) {
        run.sort_unstable_by_key(|edge| edge.edge);
    }
    last
}

/// Sorts by number as the original does, but only where the greatest number is: the others stay where they are.
fn sort_greatest(edges: &mut [(u32, Edge)], greatest: u32) {
    let mut left = vec![(0..edges.len(), 39_871_946_u32)];
    while let Some((range, seed)) = left.pop() {
        let part = &mut edges[range.clone()];
        if part.len() <= 2 {
            part.sort_unstable_by_key(|edge| edge.0);
            continue;
        }
        let turned = seed.rotate_left(seed & 31);
        let seed = seed.wrapping_add(turned).wrapping_add(3);
        let pivot = part[seed as usize % part.len()].0;
        let (mut a, mut b) = (0, part.len() - 1);
        while a <= b {
            a += part[a..].iter().take_while(|edge| edge.0 < pivot).count();
            b -= part[..=b].iter().rev().take_while(|edge| edge.0 > pivot).count();
            if a <= b {
                part.swap(a, b);
                (a, b) = (a + 1, b.saturating_sub(1));
            }
        }
        left.push((range.start + a..range.end, seed));
        if pivot == greatest {
            left.push((range.start..range.start + b + 1, seed));
        }
    }
}
