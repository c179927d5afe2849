//! Which edges of triangles are beside one another: those of the same corners, the other way round.

use super::weld::Welded;

/// No edge, or no group.
pub(super) const NONE: u32 = u32::MAX;

/// An edge, told by the corner that it starts from: three times its triangle, and which of the three it is.
#[derive(Clone, Copy, Default)]
struct Edge {
    /// The greater of the numbers of its ends; the lesser is that of its bucket.
    to: u32,
    edge: u32,
}

/// For each edge of each triangle `faces` the edge beside it, or [`NONE`]: here and below, triangles are told by their
/// places among these.
pub(super) fn beside(welded: &Welded, faces: &[u32]) -> Vec<[u32; 3]> {
    let all = || {
        let numbers = faces.iter().map(|&face| welded.numbers[face as usize]);
        (0..).zip(numbers.flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]]))
    };
    let mut starts = vec![0_u32; welded.first.len() + 1];
    for (_, [a, b]) in all() {
        starts[a.min(b) as usize + 1] += 1;
    }
    for i in 1..starts.len() {
        starts[i] += starts[i - 1];
    }
    // In a bucket are from its start on the edges that leave its corner, and from its end on those that arrive.
    let mut next: Vec<[u32; 2]> = starts.windows(2).map(|ends| [ends[0], ends[1]]).collect();
    let mut sorted = vec![Edge::default(); 3 * faces.len()];
    for (edge, [a, b]) in all() {
        let [leaving, arriving] = &mut next[a.min(b) as usize];
        *arriving -= u32::from(b <= a);
        let at = if a < b { *leaving } else { *arriving };
        *leaving += u32::from(a < b);
        sorted[at as usize] = Edge { to: a.max(b), edge };
    }
    let mut beside = vec![[NONE; 3]; faces.len()];
    let pairs = beside.as_flattened_mut();
    let last = (1..starts.len()).rev().find(|&i| starts[i] > starts[i - 1]);
    for (i, [middle, _]) in (1..).zip(next) {
        let (start, end) = (starts[i - 1], starts[i]);
        let bucket = &mut sorted[start as usize..end as usize];
        if last == Some(i) && bucket.len() > 2 {
            let number = i as u32 - 1;
            let whole = all().map(|(edge, [a, b])| (a.min(b), Edge { to: a.max(b), edge }));
            let leaves = |edge: u32| {
                welded.numbers[faces[edge as usize / 3] as usize][edge as usize % 3] == number
            };
            pair_unsorted(&left_unsorted(whole.collect(), number), pairs, leaves);
        } else {
            let (leaving, arriving) = bucket.split_at_mut((middle - start) as usize);
            pair(leaving, arriving, pairs);
        }
    }
    beside
}

/// Pairs edges of the same corners: the first that leaves with the first that arrives, and so on.
fn pair(leaving: &mut [Edge], arriving: &mut [Edge], beside: &mut [u32]) {
    for edges in [&mut *leaving, &mut *arriving] {
        edges.sort_unstable_by_key(|edge| (edge.to, edge.edge));
    }
    let mut arriving = arriving.iter().peekable();
    for a in leaving {
        while arriving.next_if(|b| b.to < a.to).is_some() {}
        if let Some(b) = arriving.next_if(|b| b.to == a.to) {
            beside[a.edge as usize] = b.edge;
            beside[b.edge as usize] = a.edge;
        }
    }
}

/// Pairs edges that follow one another, are of the same corners, and run the other way round.
fn pair_unsorted(edges: &[Edge], beside: &mut [u32], leaves: impl Fn(u32) -> bool) {
    for (i, a) in edges.iter().enumerate() {
        if beside[a.edge as usize] != NONE {
            continue;
        }
        let a_leaves = leaves(a.edge);
        let others = edges[i + 1..].iter().take_while(|b| b.to == a.to);
        let mut found =
            others.filter(|b| leaves(b.edge) != a_leaves && beside[b.edge as usize] == NONE);
        if let Some(b) = found.next() {
            beside[a.edge as usize] = b.edge;
            beside[b.edge as usize] = a.edge;
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
