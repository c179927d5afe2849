//! Bonds that hold for more than one frame of a trajectory.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

/// The bonds of the first frames that were drawn, by file and selection: atoms that move stay bound.
#[derive(Debug, Default)]
pub(crate) struct Topology(Mutex<BTreeMap<[String; 2], Found>>);

/// Bonds, and the elements of the atoms that they are of.
#[derive(Debug)]
struct Found {
    elements: Vec<u8>,
    bonds: Vec<[u32; 2]>,
}

impl Topology {
    /// The bonds of a selection of a file's atoms: those that were found earlier, if the atoms are of
    /// the same elements, else those that are found now.
    pub(super) fn bonds(
        &self,
        of: [&str; 2],
        elements: &[u8],
        find: impl FnOnce() -> Vec<[u32; 2]>,
    ) -> Vec<[u32; 2]> {
        let key = of.map(str::to_owned);
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(found) = known.get(&key).filter(|found| found.elements == elements) {
            return found.bonds.clone();
        }
        let bonds = find();
        known.insert(key, Found { elements: elements.to_vec(), bonds: bonds.clone() });
        bonds
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bonds_are_found_anew_where_the_atoms_are_others() {
        let topology = Topology::default();
        let bonds = |of, elements: &[u8], find| topology.bonds([of, ""], elements, || vec![find]);
        assert_eq!(bonds("a", &[1, 6], [0, 1]), [[0, 1]]);
        assert_eq!(bonds("a", &[1, 6], [7, 8]), [[0, 1]]);
        assert_eq!(bonds("b", &[1, 6], [2, 3]), [[2, 3]]);
        assert_eq!(bonds("a", &[1, 8], [4, 5]), [[4, 5]]);
    }
}
