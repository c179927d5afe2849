//! How much of each of our terms is in their picture.

use phong::terms::{Term, Terms};
use phong_scene::srgb_decode;

use super::fault::Fault;
use super::picture::Theirs;
use super::prepared::Prepared;
use super::shade::shade;

/// Terms, each with a column of its own.
const COUNT: usize = Term::ALL.len();

/// The term in whose column another is counted: what mirror and glass rays bring is told as one.
/// `None`: it is not fitted.
fn counted_as(term: Term) -> Option<Term> {
    match term {
        Term::Background | Term::Fog => None,
        Term::Transmission => Some(Term::Reflection),
        own => Some(own),
    }
}

/// What a column is called: the names of the terms that are counted in it.
fn named(column: Term) -> String {
    let names = Term::ALL.into_iter().filter(|&term| counted_as(term) == Some(column));
    names.map(Term::name).collect::<Vec<_>>().join(" and ")
}

/// Least squares over the linear values of inner pixels that are not clipped, and are numbers. `None` for a term
/// that the scene does not have, or that cannot be told from the others.
pub(super) fn fit(right: &Prepared, theirs: &Theirs) -> Vec<(String, Option<f64>)> {
    let mut normal = [[0.0; COUNT]; COUNT];
    let mut side = [0.0; COUNT];
    let nothing = Fault::default();
    for (i, point) in right.points.iter().enumerate() {
        if !right.inner[i] || point.surface.is_none() {
            continue;
        }
        let sum = shade(point, &nothing, &right.facts);
        let mut columns = Terms::default();
        for (term, value) in sum.iter() {
            if let Some(column) = counted_as(term) {
                columns[column] += value;
            }
        }
        let columns = Term::ALL.map(|column| columns[column].to_array());
        let Some(drawn) = theirs.at(i, right.size, None) else { continue };
        for channel in 0..3 {
            let level = f64::from(drawn[channel].value);
            if level.is_nan() || level > 0.995 {
                continue;
            }
            let column = columns.map(|c| f64::from(c[channel]));
            for (a, row) in normal.iter_mut().enumerate() {
                for (b, entry) in row.iter_mut().enumerate() {
                    *entry += column[a] * column[b];
                }
                side[a] += column[a] * srgb_decode(level);
            }
        }
    }
    let factors = solve(normal, side);
    let all = Term::ALL.into_iter().zip(factors);
    all.filter(|&(term, _)| counted_as(term) == Some(term)).map(|(t, f)| (named(t), f)).collect()
}

/// Gaussian elimination with the largest pivot of the diagonal; `None` where a column is zero, or
/// is left without anything of its own.
fn solve<const N: usize>(mut m: [[f64; N]; N], mut y: [f64; N]) -> [Option<f64>; N] {
    let scale: [f64; N] = std::array::from_fn(|i| m[i][i]);
    let mut order = Vec::new();
    for _ in 0..N {
        let free = (0..N).filter(|i| !order.contains(i) && m[*i][*i] > 1e-9 * scale[*i].max(1e-12));
        let Some(pivot) = free.max_by(|&a, &b| m[a][a].total_cmp(&m[b][b])) else { break };
        order.push(pivot);
        for row in (0..N).filter(|&row| row != pivot) {
            let factor = m[row][pivot] / m[pivot][pivot];
            let from = m[pivot];
            for (entry, from) in m[row].iter_mut().zip(from) {
                *entry -= factor * from;
            }
            y[row] -= factor * y[pivot];
        }
    }
    std::array::from_fn(|i| order.contains(&i).then(|| y[i] / m[i][i]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn terms_that_are_there_are_found_and_the_rest_are_none() {
        // Columns (1, 0, 1, 0) and (0, 2, 1, 0) with factors 3 and −1; the others are zero.
        let columns = [[1.0, 0.0, 1.0], [0.0, 2.0, 1.0], [0.0; 3], [0.0; 3]];
        let want = [3.0, -1.0, 0.0, 0.0];
        let dot = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let seen: [f64; 3] = std::array::from_fn(|k| (0..4).map(|c| want[c] * columns[c][k]).sum());
        let normal = std::array::from_fn(|a| std::array::from_fn(|b| dot(columns[a], columns[b])));
        let [a, b, c, d] = solve(normal, columns.map(|column| dot(column, seen)));
        assert!((a.unwrap() - 3.0).abs() < 1e-12 && (b.unwrap() + 1.0).abs() < 1e-12);
        assert_eq!((c, d), (None, None));
    }
}
