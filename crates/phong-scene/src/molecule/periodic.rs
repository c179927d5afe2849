//! Images of a cell that repeats: whole cells along its edges, and a layer around them.

use std::collections::BTreeMap;

use glam::{DVec3, I64Vec3};

use super::wrong::Wrong;
use super::{Cell, Molecule, Values};
use crate::limits::Limits;

/// What is kept of an image beside its atoms, with some room.
const BYTES_OF_AN_IMAGE: f64 = 128.0;

/// Which images of the cell are drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Images {
    /// How many cells along each edge, from 1.
    pub(crate) cells: [u32; 3],
    /// How far around these cells images of atoms are drawn, in the places' unit; 0: not.
    pub(crate) layer: f64,
}

impl Images {
    /// The cell alone.
    pub(crate) const ONE: Self = Self { cells: [1; 3], layer: 0.0 };
}

/// One image of the cell.
struct Image {
    /// The number of its first atom, and which atoms it has; `None`: all.
    first: u32,
    atoms: Option<Vec<u32>>,
}

impl Image {
    /// The number of its image of an atom.
    fn number(&self, atom: u32) -> Option<u32> {
        let index = match &self.atoms {
            None => atom,
            Some(atoms) => atoms.binary_search(&atom).ok()? as u32,
        };
        Some(self.first + index)
    }
}

impl Molecule {
    /// Adds the images of its atoms; and how many of the file's bonds lead beyond them. The atoms themselves keep
    /// their numbers.
    ///
    /// # Errors
    /// They are more than the limits allow.
    pub(super) fn add_images(
        &mut self,
        cell: &Cell,
        images: Images,
        limits: &Limits,
    ) -> Result<usize, Wrong> {
        let Images { cells, layer } = images;
        // The layer's width in edges, along each.
        let wide = DVec3::from(cell.heights().map(|height| layer / height));
        let cells = DVec3::from(cells.map(f64::from));
        let expected = (cells + 2.0 * wide).element_product() * self.len() as f64;
        let room = || {
            let message = format!(
                "the images are more than {} atoms or {} bytes, the limits",
                limits.vertices, limits.bytes
            );
            Wrong { message, help: None }
        };
        let each = self.bytes().div_ceil(self.len().max(1) as u64);
        let fits = |atoms: f64| {
            atoms <= limits.vertices as f64 && atoms * each as f64 <= limits.bytes as f64
        };
        let around = wide.ceil();
        let pieces = (cells + 2.0 * around).element_product();
        if !fits(expected) || pieces * BYTES_OF_AN_IMAGE > limits.bytes as f64 {
            return Err(room());
        }
        let shares: Vec<DVec3> = (0..self.len()).map(|i| cell.shares(self.place(i))).collect();
        let around = around.as_i64vec3();
        let end = cells.as_i64vec3() + around;
        let mut found: BTreeMap<[i64; 3], Image> = BTreeMap::new();
        found.insert([0; 3], Image { first: 0, atoms: None });
        let (count, bonds) = (self.len(), std::mem::take(&mut self.bonds));
        for z in -around.z..end.z {
            for y in -around.y..end.y {
                for x in -around.x..end.x {
                    let shift = I64Vec3::new(x, y, z);
                    if shift == I64Vec3::ZERO {
                        continue;
                    }
                    let whole = shift.min_element() >= 0 && shift.as_dvec3().cmplt(cells).all();
                    let near = |atom: &u32| {
                        let at = shares[*atom as usize] + shift.as_dvec3();
                        at.cmpge(-wide).all() && at.cmple(cells + wide).all()
                    };
                    let atoms =
                        (!whole).then(|| (0..count as u32).filter(near).collect::<Vec<u32>>());
                    let more = atoms.as_ref().map_or(count, Vec::len);
                    if !fits((self.len() + more) as f64) {
                        return Err(room());
                    }
                    let first = self.len() as u32;
                    self.copy_atoms(count, atoms.as_deref(), cell.offset(shift.as_dvec3()));
                    if !bonds.is_empty() {
                        found.insert(shift.to_array(), Image { first, atoms });
                    }
                }
            }
        }
        // A bond leads to the nearest image of the other atom.
        let mut beyond = 0;
        for [a, b] in bonds {
            let step = shares[b as usize] - shares[a as usize];
            let step = -step.round().as_i64vec3();
            for (shift, image) in &found {
                let Some(from) = image.number(a) else { continue };
                let to = (I64Vec3::from(*shift) + step).to_array();
                match found.get(&to).and_then(|image| image.number(b)) {
                    Some(to) => self.bonds.push([from, to]),
                    None => beyond += 1,
                }
            }
        }
        Ok(beyond)
    }

    /// Appends copies of some of the first `count` atoms, or of all of these, elsewhere.
    fn copy_atoms(&mut self, count: usize, which: Option<&[u32]>, offset: DVec3) {
        let [x, y, z] = offset.as_vec3().to_array();
        let before = self.spheres.len();
        copy(&mut self.spheres, count, which);
        for sphere in &mut self.spheres[before..] {
            *sphere = [sphere[0] + x, sphere[1] + y, sphere[2] + z, sphere[3]];
        }
        copy(&mut self.elements, count, which);
        copy(&mut self.colors, count, which);
        for column in &mut self.columns {
            match &mut column.values {
                Values::Numbers(numbers) => copy(numbers, count, which),
                Values::Words(words) => copy(&mut words.numbers, count, which),
            }
        }
    }
}

/// Appends copies of some of the first `count` values, if there are any.
fn copy<T: Copy>(values: &mut Vec<T>, count: usize, which: Option<&[u32]>) {
    if values.is_empty() {
        return;
    }
    match which {
        None => values.extend_from_within(..count),
        Some(atoms) => {
            values.reserve(atoms.len());
            for atom in atoms {
                values.push(values[*atom as usize]);
            }
        }
    }
}

impl Cell {
    /// From a place of the cell to the same in the cell that is so many edges away.
    fn offset(&self, edges: DVec3) -> DVec3 {
        self.place(edges) - self.origin
    }

    /// The shares along the edges that a place stands for.
    fn shares(&self, place: DVec3) -> DVec3 {
        let [a, b, c] = self.edges;
        let volume = a.dot(b.cross(c));
        let from = place - self.origin;
        let along = [b.cross(c), c.cross(a), a.cross(b)];
        DVec3::from(along.map(|normal| from.dot(normal) / volume))
    }

    /// The distances between opposite faces.
    fn heights(&self) -> [f64; 3] {
        let [a, b, c] = self.edges;
        let volume = a.dot(b.cross(c)).abs();
        [b.cross(c), c.cross(a), a.cross(b)].map(|normal| volume / normal.length())
    }
}
