//! Whatever a file of atoms holds, it is read to a sound scene or to errors.
#![no_main]

use libfuzzer_sys::fuzz_target;
use phong_fuzz::{check_file, spell};

const ENDINGS: [&str; 6] = ["xyz", "pdb", "cif", "gro", "lammpstrj", "data"];

const WORDS: &[&str] = &[
    "\n",
    " ",
    "0",
    "1",
    "2",
    "3",
    "-1.5",
    "0.000",
    "1e39",
    "nan",
    "?",
    ".",
    "#",
    "'",
    "\n;",
    "\r\n",
    "C ",
    "O ",
    "Na ",
    "1 2 3\n",
    "3\n\n",
    "Lattice=\"2 0 0 0 3 0 0 0 4\" ",
    "Properties=species:S:1:pos:R:3",
    ":color:I:3",
    ":radius:R:1\n",
    "ATOM      1  CA  ALA A   1       1.000   2.000   3.000  1.00 10.00           C\n",
    "HETATM99999 ZN   ZN AA000       1.000   2.000   4.000  0.50 10.00          ZN2+\n",
    "ATOM      2  CB AALA A   1       1.000   2.000   3.000  0.40 10.00\n",
    "CONECT    1    2\n",
    "MODEL        1\n",
    "ENDMDL\n",
    "CRYST1   20.000   20.000   20.000  90.00  90.00 120.00 P 1\n",
    "data_x\n",
    "loop_\n",
    "_atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n",
    "_atom_site_fract_x\n_atom_site_fract_y\n_atom_site_fract_z\n",
    "_atom_site.type_symbol\n",
    "_atom_site.label_alt_id\n",
    "_atom_site.pdbx_PDB_model_num\n",
    "_cell_length_a 1\n_cell_length_b 2\n_cell_length_c 3\n",
    "ITEM: TIMESTEP\n0\n",
    "ITEM: NUMBER OF ATOMS\n2\n",
    "ITEM: BOX BOUNDS pp pp pp\n0 1\n0 1\n0 1\n",
    "ITEM: BOX BOUNDS xy xz yz pp pp pp\n0 1 1\n0 1 0\n0 1 1\n",
    "ITEM: ATOMS id type x y z\n",
    "ITEM: ATOMS element xs ys zs radius\n",
    "title\n    1\n    1SOL     OW    1   0.230   0.628   0.113\n   1.0 1.0 1.0\n",
    "2 atoms\n",
    "1 bonds\n",
    "0 1 xlo xhi\n",
    "\nAtoms # full\n\n",
    "\nAtoms\n\n",
    "\nBonds\n\n",
    "\nMasses\n\n",
];

fuzz_target!(|data: &[u8]| {
    let Some((kind, rest)) = data.split_first() else { return };
    let name = format!("a.{}", ENDINGS[usize::from(*kind) % ENDINGS.len()]);
    check_file(&name, spell(rest, WORDS));
});
