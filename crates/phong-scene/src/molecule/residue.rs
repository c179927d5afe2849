//! What residues are by their names.

/// Names of the twenty amino acids and of their usual variants.
const PROTEIN: [&str; 41] = [
    "ALA", "ARG", "ASN", "ASP", "CYS", "GLN", "GLU", "GLY", "HIS", "ILE", "LEU", "LYS", "MET",
    "PHE", "PRO", "SER", "THR", "TRP", "TYR", "VAL", "MSE", "SEC", "PYL", "ASX", "GLX", "UNK",
    "HID", "HIE", "HIP", "HSD", "HSE", "HSP", "CYX", "CYM", "ASH", "GLH", "LYN", "ACE", "NME",
    "SEP", "TPO",
];

/// Names of nucleotides.
const NUCLEIC: [&str; 22] = [
    "A", "C", "G", "U", "T", "I", "DA", "DC", "DG", "DT", "DU", "DI", "ADE", "CYT", "GUA", "THY",
    "URA", "RA", "RC", "RG", "RU", "N",
];

/// Names of water, by many programs.
const WATER: [&str; 15] = [
    "HOH", "WAT", "H2O", "DOD", "D2O", "TIP", "TIP2", "TIP3", "TIP4", "TIP5", "T3P", "SOL", "SPC",
    "SPCE", "T4P",
];

/// Names of the sites of water models which hold a charge, and are no atoms: of four sites, of five.
const SITE: [&str; 14] =
    ["MW", "MW1", "M", "M1", "M2", "OM", "EP", "EPW", "EP1", "EP2", "LP", "LP1", "LP2", "LPA"];

/// Names of ions that stand alone.
const ION: [&str; 30] = [
    "NA", "K", "CL", "BR", "MG", "CA", "ZN", "MN", "FE", "FE2", "CU", "CU1", "NI", "CO", "CD",
    "HG", "LI", "RB", "CS", "SR", "BA", "IOD", "F", "NA+", "CL-", "K+", "SOD", "CLA", "POT", "CAL",
];

/// Names of the atoms along the chain of a protein or nucleic acid.
const BACKBONE: [&str; 16] = [
    "N", "CA", "C", "O", "OXT", "P", "OP1", "OP2", "O1P", "O2P", "O5'", "C5'", "C4'", "C3'", "O3'",
    "OT1",
];

fn among(names: &[&str], name: &str) -> bool {
    names.iter().any(|known| known.eq_ignore_ascii_case(name))
}

pub(super) fn is_protein(name: &str) -> bool {
    among(&PROTEIN, name)
}

pub(super) fn is_nucleic(name: &str) -> bool {
    among(&NUCLEIC, name)
}

pub(super) fn is_water(name: &str) -> bool {
    among(&WATER, name)
}

/// Whether what has this name in water is no atom.
pub(super) fn is_site(name: &str) -> bool {
    among(&SITE, name)
}

pub(super) fn is_ion(name: &str) -> bool {
    among(&ION, name)
}

pub(super) fn is_backbone(name: &str) -> bool {
    among(&BACKBONE, name)
}
