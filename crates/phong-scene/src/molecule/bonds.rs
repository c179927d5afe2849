//! Bonds by covalent radii: which atoms are near enough to one another, found over a grid of cells.

use rayon::prelude::*;

use crate::elements::{HYDROGEN, covalent_radius};

/// How much farther than the sum of their covalent radii bound atoms may be apart, in Å.
const SLACK: f32 = 0.45;

/// Atoms nearer than this, in Å, are one atom twice, and not bound.
const LEAST: f32 = 0.4;

/// The longest bond between two hydrogens, in Å.
const HYDROGENS: f32 = 0.9;

/// Atoms of a row of cells that are looked at: in matter there are fewer by far.
const MOST: usize = 1 << 9;

/// Cells along an axis, at most.
const CELLS: f32 = (1 << 20) as f32;

/// The pairs of atoms that are bound, each with the lower number first, in the order of the numbers.
/// What is of no known element has no bonds.
pub(super) fn by_radii(spheres: &[[f32; 4]], elements: &[u8]) -> Vec<[u32; 2]> {
    let radii: Vec<f32> = elements.iter().map(|e| covalent_radius(*e).unwrap_or(0.0)).collect();
    let largest = radii.iter().copied().fold(0.0, f32::max);
    let known = |i: &usize| radii.get(*i).is_some_and(|r| *r > 0.0);
    let grid = Grid::new(spheres, (0..spheres.len()).filter(known), 2.0 * largest + SLACK);
    let near = |i: usize| {
        let mut found = Vec::new();
        if !known(&i) {
            return found;
        }
        grid.each_near(spheres[i], |j| {
            let (a, b) = (spheres[i], spheres[j as usize]);
            let d = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
            let square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
            let hydrogens = elements[i] == HYDROGEN && elements[j as usize] == HYDROGEN;
            let most = radii[i] + radii[j as usize] + SLACK;
            let most = if hydrogens { HYDROGENS } else { most };
            if j as usize > i && square >= LEAST * LEAST && square <= most * most {
                found.push([i as u32, j]);
            }
        });
        found.sort_unstable();
        found
    };
    (0..spheres.len()).into_par_iter().with_min_len(1 << 10).flat_map_iter(near).collect()
}

/// Atoms by the cells of a grid that they lie in.
struct Grid {
    low: [f32; 3],
    size: f32,
    /// The number of an atom's cell, and the atom, in order.
    order: Vec<(u64, u32)>,
}

impl Grid {
    fn new(spheres: &[[f32; 4]], atoms: impl Iterator<Item = usize>, size: f32) -> Self {
        let atoms: Vec<u32> = atoms.map(|i| i as u32).collect();
        let mut low = [f32::INFINITY; 3];
        let mut high = [f32::NEG_INFINITY; 3];
        for atom in &atoms {
            for axis in 0..3 {
                low[axis] = low[axis].min(spheres[*atom as usize][axis]);
                high[axis] = high[axis].max(spheres[*atom as usize][axis]);
            }
        }
        let extent = (0..3).map(|axis| high[axis] - low[axis]).fold(0.0, f32::max);
        let size = size.max(extent / CELLS);
        let mut grid = Self { low, size, order: Vec::new() };
        grid.order = atoms
            .into_par_iter()
            .map(|atom| (key(grid.cell(spheres[atom as usize])), atom))
            .collect();
        grid.order.par_sort_unstable();
        grid
    }

    /// The cell of a place; cells are counted from 1, so that there is one before each.
    fn cell(&self, sphere: [f32; 4]) -> [u64; 3] {
        [0, 1, 2].map(|axis| ((sphere[axis] - self.low[axis]) / self.size) as u64 + 1)
    }

    /// Calls `see` with the atoms in the cell of a place and in the cells around it.
    fn each_near(&self, sphere: [f32; 4], mut see: impl FnMut(u32)) {
        let [x, y, z] = self.cell(sphere);
        for z in z - 1..=z + 1 {
            for y in y - 1..=y + 1 {
                let (first, last) = (key([x - 1, y, z]), key([x + 1, y, z]));
                let start = self.order.partition_point(|(key, _)| *key < first);
                let row = self.order[start..].iter().take(MOST);
                row.take_while(|(key, _)| *key <= last).for_each(|(_, atom)| see(*atom));
            }
        }
    }
}

/// A number for a cell; those of cells along X follow one another.
fn key([x, y, z]: [u64; 3]) -> u64 {
    (z << 42) | (y << 21) | x
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_grid_finds_what_all_pairs_find() {
        let number = |i: u32| (i.wrapping_mul(2_654_435_761) >> 8) as f32 / (1 << 24) as f32;
        let spheres: Vec<[f32; 4]> = (0..600)
            .map(|i| [0, 1, 2].map(|a| 14.0 * number(3 * i + a) - 5.0))
            .map(|[x, y, z]| [x, y, z, 0.0])
            .collect();
        let elements: Vec<u8> = (0..600).map(|i| [1, 6, 8, 0, 26][i % 5]).collect();
        let mut expected = Vec::new();
        for i in 0..600 {
            for j in i + 1..600 {
                let (Some(a), Some(b)) =
                    (covalent_radius(elements[i]), covalent_radius(elements[j]))
                else {
                    continue;
                };
                let d = [0, 1, 2].map(|axis| spheres[i][axis] - spheres[j][axis]);
                let square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
                let most = if elements[i] == 1 && elements[j] == 1 { 0.9 } else { a + b + 0.45 };
                if square >= 0.16 && square <= most * most {
                    expected.push([i as u32, j as u32]);
                }
            }
        }
        assert!(expected.len() > 300);
        assert_eq!(by_radii(&spheres, &elements), expected);
    }

    #[test]
    fn many_atoms_at_one_place_take_no_time() {
        let spheres = vec![[1.0; 4]; 1 << 14];
        assert_eq!(by_radii(&spheres, &vec![6; 1 << 14]), Vec::<[u32; 2]>::new());
    }
}
