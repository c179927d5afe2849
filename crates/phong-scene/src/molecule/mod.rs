//! Atoms and particles: what is read of a file about them, and how they are drawn.
//!
//! A [`Molecule`] is what readers of formats make: places, elements, columns by name, bonds and a cell,
//! in flat arrays. A [`Drawing`] says what of it is drawn and how; [`Molecule::draw`] makes spheres and
//! cylinders of the two. Places are in Å where the format says so, else in the file's own unit.

mod alternate;
mod arrows;
mod bonds;
mod color;
mod column;
mod draw;
mod maps;
mod periodic;
mod residue;
mod select;
mod style;
mod topology;
mod tube;
mod wrong;

#[cfg(test)]
mod tests;

pub(crate) use alternate::Alternates;
pub(crate) use arrows::Arrows;
pub(crate) use column::{Column, Values, Words};
pub(crate) use maps::ColorMap;
pub(crate) use periodic::Images;
pub(crate) use select::Selection;
pub(crate) use style::{Drawing, Spans, Style};
pub(crate) use topology::Topology;

use glam::DVec3;

use crate::color::Rgb;

/// The names of the columns that more than one format has.
pub(crate) mod names {
    /// The atom's name within its residue, or its label: `CA`.
    pub(crate) const NAME: &str = "name";
    /// The residue's name: `ALA`.
    pub(crate) const RESIDUE: &str = "residue";
    /// The residue's number.
    pub(crate) const NUMBER: &str = "number";
    /// The chain.
    pub(crate) const CHAIN: &str = "chain";
    /// The segment.
    pub(crate) const SEGMENT: &str = "segment";
    /// The B-factor, in Å².
    pub(crate) const B_FACTOR: &str = "b-factor";
    /// The share of the molecules that have an atom there.
    pub(crate) const OCCUPANCY: &str = "occupancy";
    /// The charge, in elementary charges.
    pub(crate) const CHARGE: &str = "charge";
    /// The type of a particle.
    pub(crate) const TYPE: &str = "type";
    /// The molecule that a particle is of.
    pub(crate) const MOLECULE: &str = "molecule";
}

/// Atoms or particles. Every array holds one value an atom, or none at all.
#[derive(Clone, Debug, Default)]
pub(crate) struct Molecule {
    /// Added, in f64, to every place.
    pub(crate) origin: DVec3,
    /// `[x, y, z, radius]`, relative to `origin`; radius 0: the file gives none.
    pub(crate) spheres: Vec<[f32; 4]>,
    /// Atomic numbers; 0: not known. Empty: the file says nothing of elements.
    pub(crate) elements: Vec<u8>,
    /// The file's own linear colours.
    pub(crate) colors: Vec<Rgb>,
    /// What else is known of each.
    pub(crate) columns: Vec<Column>,
    /// Pairs of atoms that the file calls bound.
    pub(crate) bonds: Vec<[u32; 2]>,
    /// Whether those are all bonds, so that none need be found.
    pub(crate) all_bonds: bool,
    /// The cell that repeats.
    pub(crate) cell: Option<Cell>,
}

/// A parallelepiped that repeats.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cell {
    /// One corner.
    pub(crate) origin: DVec3,
    /// The edges from there.
    pub(crate) edges: [DVec3; 3],
}

impl Cell {
    /// The cell of these lengths and angles in degrees (between edges 2 and 3, 1 and 3, 1 and 2), the
    /// first edge along X and the second in the plane of X and Y. `None`: there is no such cell.
    pub(crate) fn of_angles(lengths: [f64; 3], angles: [f64; 3]) -> Option<Self> {
        let cosine = |degrees: f64| match degrees {
            90.0 => 0.0,
            120.0 => -0.5,
            60.0 => 0.5,
            _ => libm::cos(degrees.to_radians()),
        };
        let [a, b, c] = lengths;
        let [alpha, beta, gamma] = angles.map(cosine);
        let sine = (1.0 - gamma * gamma).max(0.0).sqrt();
        let x = beta;
        let y = (alpha - beta * gamma) / sine;
        let height = 1.0 - x * x - y * y;
        let sound = lengths.iter().all(|l| l.is_finite() && *l > 0.0)
            && sine > 1e-6
            && height > 1e-9
            && y.is_finite();
        sound.then(|| Self {
            origin: DVec3::ZERO,
            edges: [
                DVec3::new(a, 0.0, 0.0),
                DVec3::new(b * gamma, b * sine, 0.0),
                DVec3::new(c * x, c * y, c * height.sqrt()),
            ],
        })
    }

    /// Whether it is the cube of 1 Å, which stands for none in files of structures without a cell.
    pub(crate) fn stands_for_none(&self) -> bool {
        self.edges.iter().zip(DVec3::AXES).all(|(edge, axis)| edge.distance(axis) < 1e-3)
    }

    /// The place that shares along the edges stand for.
    pub(crate) fn place(&self, shares: DVec3) -> DVec3 {
        let [a, b, c] = self.edges;
        self.origin + a * shares.x + b * shares.y + c * shares.z
    }

    /// The distance between the faces that are nearest to one another.
    pub(crate) fn thickness(&self) -> f64 {
        let [a, b, c] = self.edges;
        let volume = a.dot(b.cross(c)).abs();
        let areas = [b.cross(c), c.cross(a), a.cross(b)].map(DVec3::length);
        volume / areas.into_iter().fold(0.0, f64::max).max(f64::MIN_POSITIVE)
    }

    /// How many edges so many cells side by side have, each counted once.
    pub(crate) fn edges(cells: [u32; 3]) -> u64 {
        let [a, b, c] = cells.map(u64::from);
        let along = |n: u64, m: u64, l: u64| n.saturating_mul(m + 1).saturating_mul(l + 1);
        along(a, b, c).saturating_add(along(b, a, c)).saturating_add(along(c, a, b))
    }

    /// The ends of the edges of so many cells side by side, each once.
    pub(crate) fn outline(&self, cells: [u32; 3]) -> Vec<[DVec3; 2]> {
        let mut edges = Vec::new();
        let corner =
            |[x, y, z]: [u32; 3]| self.place(DVec3::new(f64::from(x), f64::from(y), f64::from(z)));
        let [a, b, c] = cells;
        for z in 0..=c {
            for y in 0..=b {
                for x in 0..=a {
                    let from = [x, y, z];
                    for axis in (0..3).filter(|axis| from[*axis] < cells[*axis]) {
                        let mut to = from;
                        to[axis] += 1;
                        edges.push([corner(from), corner(to)]);
                    }
                }
            }
        }
        edges
    }
}

impl Molecule {
    /// How many atoms there are.
    pub(crate) fn len(&self) -> usize {
        self.spheres.len()
    }

    /// The column of this name.
    pub(crate) fn column(&self, name: &str) -> Option<&Column> {
        self.columns.iter().find(|column| column.name == name)
    }

    /// The words of the column of this name, if it holds some.
    pub(crate) fn words(&self, name: &str) -> Option<&Words> {
        match &self.column(name)?.values {
            Values::Words(words) => Some(words),
            Values::Numbers(_) => None,
        }
    }

    /// The numbers of the column of this name, if it holds some.
    pub(crate) fn numbers(&self, name: &str) -> Option<&[f32]> {
        match &self.column(name)?.values {
            Values::Numbers(numbers) => Some(numbers),
            Values::Words(_) => None,
        }
    }

    /// Where an atom is, as the file counts.
    pub(crate) fn place(&self, atom: usize) -> DVec3 {
        let [x, y, z, _] = self.spheres[atom];
        self.origin + DVec3::new(x.into(), y.into(), z.into())
    }

    /// Appends what a later piece of the same file holds, with the same columns.
    pub(crate) fn append(&mut self, mut later: Self) {
        self.spheres.append(&mut later.spheres);
        self.elements.append(&mut later.elements);
        self.colors.append(&mut later.colors);
        if self.columns.is_empty() {
            self.columns = later.columns;
        } else {
            let pairs = self.columns.iter_mut().zip(later.columns);
            pairs.for_each(|(mine, theirs)| mine.values.append(theirs.values));
        }
    }

    /// Sorts the atoms by a column of numbers, if there is one. Bonds are not known yet.
    pub(crate) fn sort_by_column(&mut self, name: &str) {
        let Some(numbers) = self.numbers(name).filter(|numbers| !numbers.is_sorted()) else {
            return;
        };
        let mut order: Vec<u32> = (0..numbers.len() as u32).collect();
        order.sort_by(|a, b| numbers[*a as usize].total_cmp(&numbers[*b as usize]));
        sort(&mut self.spheres, &order);
        sort(&mut self.elements, &order);
        sort(&mut self.colors, &order);
        for column in &mut self.columns {
            match &mut column.values {
                Values::Numbers(numbers) => sort(numbers, &order),
                Values::Words(words) => sort(&mut words.numbers, &order),
            }
        }
    }

    /// Keeps the atoms that `keep` says, and the bonds between them.
    pub(crate) fn retain(&mut self, keep: &[bool]) {
        if keep.iter().all(|keep| *keep) {
            return;
        }
        filter(&mut self.spheres, keep);
        filter(&mut self.elements, keep);
        filter(&mut self.colors, keep);
        for column in &mut self.columns {
            match &mut column.values {
                Values::Numbers(numbers) => filter(numbers, keep),
                Values::Words(words) => filter(&mut words.numbers, keep),
            }
        }
        let mut next = 0;
        let mut number = |keep: &bool| {
            next += u32::from(*keep);
            keep.then(|| next - 1)
        };
        let numbers: Vec<Option<u32>> = keep.iter().map(&mut number).collect();
        let new = |atom: u32| numbers.get(atom as usize).copied().flatten();
        self.bonds = self.bonds.iter().filter_map(|[a, b]| Some([new(*a)?, new(*b)?])).collect();
    }

    /// Bytes that the arrays take.
    pub(crate) fn bytes(&self) -> u64 {
        let columns = self.columns.len() as u64 * 4;
        let color = if self.colors.is_empty() { 0 } else { 12 };
        let element = u64::from(!self.elements.is_empty());
        self.len() as u64 * (16 + columns + color + element) + self.bonds.len() as u64 * 8
    }
}

/// Keeps the values that `keep` says.
fn filter<T>(values: &mut Vec<T>, keep: &[bool]) {
    let mut kept = keep.iter();
    values.retain(|_| kept.next().copied().unwrap_or(false));
}

/// Puts values in this order, if there are any.
fn sort<T: Copy>(values: &mut Vec<T>, order: &[u32]) {
    if !values.is_empty() {
        *values = order.iter().map(|i| values[*i as usize]).collect();
    }
}
