//! Alternate locations: of atoms that stand at several places, those that are drawn.

use std::collections::BTreeMap;

/// What files say of atoms that may stand elsewhere, too.
#[derive(Clone, Debug, Default)]
pub(crate) struct Alternates {
    /// For every atom the letter of its alternative, 0 for none, and a number of its residue.
    pub(crate) letters: Vec<(u8, u64)>,
}

impl Alternates {
    /// Which atoms are drawn: those of no alternative, and in every residue those of the alternative
    /// with the highest occupancy, the first of the file where several are as high.
    pub(crate) fn kept(&self, occupancies: &[f32]) -> Vec<bool> {
        let mut best: BTreeMap<u64, (u8, f32)> = BTreeMap::new();
        for (atom, (letter, residue)) in self.letters.iter().enumerate() {
            if *letter == 0 {
                continue;
            }
            let occupancy = occupancies.get(atom).copied().filter(|o| !o.is_nan()).unwrap_or(0.0);
            let first = best.entry(*residue).or_insert((*letter, occupancy));
            if occupancy > first.1 {
                *first = (*letter, occupancy);
            }
        }
        let keep = |(letter, residue): &(u8, u64)| {
            *letter == 0 || best.get(residue).is_none_or(|(kept, _)| kept == letter)
        };
        self.letters.iter().map(keep).collect()
    }

    /// Whether there are any.
    pub(crate) fn any(&self) -> bool {
        self.letters.iter().any(|(letter, _)| *letter != 0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_each_residue_the_alternative_of_the_highest_occupancy_is_drawn() {
        let letters = vec![(0, 1), (b'A', 1), (b'B', 1), (b'A', 1), (b'B', 1), (b'B', 2)];
        let alternates = Alternates { letters };
        let kept = alternates.kept(&[1.0, 0.4, 0.6, 0.4, 0.6, 0.1]);
        assert_eq!(kept, [true, false, true, false, true, true]);
        let kept = alternates.kept(&[1.0, 0.5, 0.5, 0.5, 0.5, 0.1]);
        assert_eq!(kept, [true, true, false, true, false, true]);
    }
}
