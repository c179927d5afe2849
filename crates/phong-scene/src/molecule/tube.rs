//! Tubes along the backbones of proteins and nucleic acids.
//!
//! A tube is a Catmull–Rom curve through the Cα atoms of a protein, or the phosphorus atoms of a nucleic acid
//! (`O5'` at an end that has none), drawn as capsules. It ends where the chain does, or where neighbours are
//! farther apart than residues that are bound to one another can be.

use glam::Vec3;

use super::residue::{is_nucleic, is_protein};
use super::{Molecule, Words, names};
use crate::color::Rgb;
use crate::mesh::{Caps, Cylinders};

/// Pieces of a tube from one residue to the next, an even number.
const PIECES: u32 = 12;

/// The largest distance in Å between the Cα atoms of two residues that are bound: 3.8, with some room.
const PROTEIN_GAP: f32 = 5.0;

/// The same of the phosphorus atoms of nucleotides, which are 5.5 to 7.5 apart.
const NUCLEIC_GAP: f32 = 9.0;

/// The residues of unbroken chains.
#[derive(Debug, Default)]
pub(super) struct Backbones {
    /// For each chain the atoms that its tube goes through, two or more.
    chains: Vec<Vec<u32>>,
    /// For every atom, whether it is of a residue that a tube goes through.
    pub(super) within: Vec<bool>,
}

/// What an atom is by its name.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Place {
    Alpha,
    /// The nitrogen or the second carbon of an amino acid.
    Peptide,
    Phosphorus,
    /// Where a nucleic acid begins that has no phosphorus there.
    Beginning,
    Sugar,
    Other,
}

impl Place {
    fn of(name: &str) -> Self {
        match name {
            "CA" => Self::Alpha,
            "N" | "C" => Self::Peptide,
            "P" => Self::Phosphorus,
            "O5'" | "O5*" => Self::Beginning,
            "C3'" | "C3*" => Self::Sugar,
            _ => Self::Other,
        }
    }
}

/// An atom that a tube may go through.
struct Anchor {
    atom: u32,
    is_nucleic: bool,
    /// The chain and the segment.
    chain: [Option<u32>; 2],
    residue: std::ops::Range<usize>,
}

impl Molecule {
    /// The chains of residues that tubes go along.
    pub(super) fn backbones(&self) -> Backbones {
        let mut found = Backbones { chains: Vec::new(), within: vec![false; self.len()] };
        let Some(atoms) = self.words(names::NAME) else { return found };
        let places: Vec<Place> = atoms.names.iter().map(|name| Place::of(name)).collect();
        let place = |atom: usize| places[atoms.numbers[atom] as usize];
        let residues = self.words(names::RESIDUE);
        let kinds: Vec<[bool; 2]> = residues.map_or_else(Vec::new, |words| {
            words.names.iter().map(|name| [is_protein(name), is_nucleic(name)]).collect()
        });
        let others = [names::CHAIN, names::SEGMENT].map(|name| self.words(name));
        let number = self.numbers(names::NUMBER);
        let word = |words: Option<&Words>, atom: usize| Some(words?.numbers[atom]);
        let same = |a: usize, b: usize| {
            word(residues, a) == word(residues, b)
                && others.iter().all(|words| word(*words, a) == word(*words, b))
                && number.is_none_or(|number| number[a].to_bits() == number[b].to_bits())
        };
        let mut run: Vec<Anchor> = Vec::new();
        let mut start = 0;
        while start < self.len() {
            let end = (start + 1..self.len()).find(|i| !same(start, *i)).unwrap_or(self.len());
            let residue = start..end;
            start = end;
            let first = |wanted: Place| residue.clone().find(|i| place(*i) == wanted);
            let [protein, nucleic] =
                word(residues, residue.start).map_or([false; 2], |word| kinds[word as usize]);
            // Calcium is called so too, and stands alone.
            let alpha = first(Place::Alpha).filter(|atom| {
                let carbon = self.elements.get(*atom).is_none_or(|e| matches!(e, 0 | 6));
                carbon && (protein || first(Place::Peptide).is_some())
            });
            let sugar = nucleic || first(Place::Sugar).is_some();
            let phosphorus = first(Place::Phosphorus).or_else(|| first(Place::Beginning));
            let anchor = alpha.or(phosphorus.filter(|_| sugar)).map(|atom| Anchor {
                atom: atom as u32,
                is_nucleic: alpha.is_none(),
                chain: others.map(|words| word(words, atom)),
                residue,
            });
            let goes_on = run.last().zip(anchor.as_ref()).is_some_and(|(a, b)| self.linked(a, b));
            if !goes_on {
                found.add(&run);
                run.clear();
            }
            run.extend(anchor);
        }
        found.add(&run);
        found
    }

    fn linked(&self, a: &Anchor, b: &Anchor) -> bool {
        let gap = if a.is_nucleic { NUCLEIC_GAP } else { PROTEIN_GAP };
        let distance = self.at(a.atom).distance(self.at(b.atom));
        a.is_nucleic == b.is_nucleic && a.chain == b.chain && distance > 0.0 && distance <= gap
    }

    /// Where an atom is, relative to the origin.
    pub(super) fn at(&self, atom: u32) -> Vec3 {
        Vec3::from_slice(&self.spheres[atom as usize][..3])
    }

    /// The tubes, of the colours of the atoms that they go through; where `blend`, of colours between them.
    pub(super) fn tubes(
        &self,
        backbones: &Backbones,
        colors: &[Rgb],
        blend: bool,
        radius: f32,
    ) -> Cylinders {
        let mut tubes =
            Cylinders { origin: self.origin, caps: Caps::Round, ..Cylinders::default() };
        let (mut segments, mut halves) = (Vec::new(), Vec::new());
        for chain in &backbones.chains {
            let place = |i: usize| self.at(chain[i]);
            let last = chain.len() - 1;
            let tangent = |i: usize| match i {
                0 => place(1) - place(0),
                i if i == last => place(last) - place(last - 1),
                i => 0.5 * (place(i + 1) - place(i - 1)),
            };
            for i in 0..last {
                let curve = Curve([place(i), place(i + 1)], [tangent(i), tangent(i + 1)]);
                let color = |i: usize| colors.get(chain[i] as usize).copied();
                let ends = color(i).zip(color(i + 1));
                let mut from = place(i);
                for piece in 0..PIECES {
                    let share = |quarters: u32| (4 * piece + quarters) as f32 / (4 * PIECES) as f32;
                    let to = curve.at(share(4));
                    let end = |place: Vec3| [place.x, place.y, place.z, radius];
                    segments.push([end(from), end(to)]);
                    from = to;
                    if let Some((a, b)) = ends {
                        let between = |share: f32| {
                            if blend {
                                a * (1.0 - share) + b * share
                            } else if share < 0.5 {
                                a
                            } else {
                                b
                            }
                        };
                        halves.push([between(share(1)), between(share(3))]);
                    }
                }
            }
        }
        tubes.segments = segments.into();
        tubes.colors = halves.into();
        tubes
    }
}

impl Backbones {
    /// Adds a chain, unless it is a residue alone.
    fn add(&mut self, run: &[Anchor]) {
        if run.len() < 2 {
            return;
        }
        for anchor in run {
            self.within[anchor.residue.clone()].fill(true);
        }
        self.chains.push(run.iter().map(|anchor| anchor.atom).collect());
    }

    /// How many pieces their tubes have.
    pub(super) fn pieces(&self) -> u64 {
        self.chains.iter().map(|chain| u64::from(PIECES) * (chain.len() as u64 - 1)).sum()
    }
}

/// A cubic curve between two places with these tangents there (Hermite).
struct Curve([Vec3; 2], [Vec3; 2]);

impl Curve {
    /// The place at a share of the way.
    fn at(&self, t: f32) -> Vec3 {
        let Self([a, b], [from, to]) = *self;
        if t >= 1.0 {
            return b;
        }
        let (t2, t3) = (t * t, t * t * t);
        a * (2.0 * t3 - 3.0 * t2 + 1.0)
            + from * (t3 - 2.0 * t2 + t)
            + b * (3.0 * t2 - 2.0 * t3)
            + to * (t3 - t2)
    }
}
