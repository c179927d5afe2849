//! Bonds between atoms that are named by their serial numbers.

/// Serial numbers, as they are written, of atoms and of bonds.
#[derive(Debug, Default)]
pub(super) struct Serials {
    atoms: Vec<[u8; 5]>,
    bonds: Vec<[[u8; 5]; 2]>,
}

impl Serials {
    /// The serial number of the next atom.
    pub(super) fn atom(&mut self, serial: [u8; 5]) {
        self.atoms.push(serial);
    }

    /// The first of these is bound to the others.
    pub(super) fn connect(&mut self, serials: &[[u8; 5]]) {
        if let Some((first, others)) = serials.split_first() {
            self.bonds.extend(others.iter().map(|other| [*first, *other]));
        }
    }

    /// The bonds, and how many name atoms that are not there, or several of the same number.
    pub(super) fn bonds(&self) -> (Vec<[u32; 2]>, u64) {
        if self.bonds.is_empty() {
            return (Vec::new(), 0);
        }
        let mut sorted: Vec<([u8; 5], u32)> = self.atoms.iter().copied().zip(0..).collect();
        sorted.sort_unstable();
        let find = |serial: &[u8; 5]| {
            let at = sorted.partition_point(|(other, _)| other < serial);
            let (found, atom) = sorted.get(at)?;
            let twice = sorted.get(at + 1).is_some_and(|(other, _)| other == serial);
            (found == serial && !twice).then_some(*atom)
        };
        let mut unknown = 0;
        let bond = |[a, b]: &[[u8; 5]; 2]| {
            let bond = find(a).zip(find(b)).map(|(a, b)| [a.min(b), a.max(b)]);
            unknown += u64::from(bond.is_none());
            bond
        };
        let mut bonds: Vec<[u32; 2]> = self.bonds.iter().filter_map(bond).collect();
        bonds.sort_unstable();
        bonds.dedup();
        (bonds, unknown)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bonds_are_found_by_serial_numbers_however_they_are_written() {
        let mut serials = Serials::default();
        for serial in [b"99999", b"A0000", b"*****", b"*****"] {
            serials.atom(*serial);
        }
        serials.connect(&[*b"A0000", *b"99999", *b"    7"]);
        serials.connect(&[*b"99999", *b"A0000", *b"*****"]);
        assert_eq!(serials.bonds(), (vec![[0, 1]], 2));
    }
}
