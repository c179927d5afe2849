//! How much of each of our terms is in their picture.

use phong_scene::srgb_decode;

use super::Prepared;
use super::picture::Theirs;
use super::shade::{Wrong, shade};

const NAMES: [&str; 4] = ["ambient", "diffuse", "specular", "reflection and transmission"];

/// Least squares over the linear values of inner pixels that are not clipped, and are numbers. `None` for a term
/// that the scene does not have, or that cannot be told from the others.
pub(super) fn fit(right: &Prepared, theirs: &Theirs) -> [(&'static str, Option<f64>); 4] {
    let mut normal = [[0.0; 4]; 4];
    let mut side = [0.0; 4];
    for (i, point) in right.points.iter().enumerate() {
        if !right.inner[i] || point.surface.is_none() {
            continue;
        }
        let sum = shade(&right.scene, point, &Wrong::default());
        let columns =
            [sum.ambient, sum.diffuse, sum.specular, sum.secondary].map(phong_scene::Rgb::to_array);
        let drawn = theirs.at(i, right.size, None);
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
    std::array::from_fn(|i| (NAMES[i], factors[i]))
}

/// Gaussian elimination with the largest pivot of the diagonal; `None` where a column is zero, or
/// is left without anything of its own.
fn solve(mut m: [[f64; 4]; 4], mut y: [f64; 4]) -> [Option<f64>; 4] {
    let scale: [f64; 4] = std::array::from_fn(|i| m[i][i]);
    let mut order = Vec::new();
    for _ in 0..4 {
        let free = (0..4).filter(|i| !order.contains(i) && m[*i][*i] > 1e-9 * scale[*i].max(1e-12));
        let Some(pivot) = free.max_by(|&a, &b| m[a][a].total_cmp(&m[b][b])) else { break };
        order.push(pivot);
        for row in (0..4).filter(|&row| row != pivot) {
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
