//! The chemical elements: symbols, radii, masses and the colours that they are drawn in.
//!
//! Covalent radii: B. Cordero et al., *Covalent radii revisited*, Dalton Trans. (2008) 2832. Van der
//! Waals radii: A. Bondi, J. Phys. Chem. 68 (1964) 441, and M. Mantina et al., J. Phys. Chem. A 113 (2009)
//! 5806, for the elements of the main groups; of the others S. Alvarez, Dalton Trans. (2013) 8617. Masses:
//! IUPAC's standard atomic weights. Colours: those of Jmol, which go on from Corey, Pauling and Koltun's.

/// The atomic number of hydrogen.
pub(crate) const HYDROGEN: u8 = 1;

/// What is known of an element.
struct Element {
    symbol: &'static str,
    /// In Å; 0: not known.
    covalent: f32,
    /// In Å; 0: not known.
    van_der_waals: f32,
    /// Red, green and blue, sRGB.
    color: u32,
    /// In atomic mass units.
    mass: f64,
}

/// The colour of what is of no known element.
const NO_ELEMENT: [u8; 3] = [0xff, 0x14, 0x93];

const fn element(
    symbol: &'static str,
    covalent: f32,
    van_der_waals: f32,
    color: u32,
    mass: f64,
) -> Element {
    Element { symbol, covalent, van_der_waals, color, mass }
}

/// All elements; hydrogen, number 1, is the first.
static ELEMENTS: [Element; 118] = [
    element("H", 0.31, 1.20, 0xff_ffff, 1.008),
    element("He", 0.28, 1.40, 0xd9_ffff, 4.003),
    element("Li", 1.28, 1.82, 0xcc_80ff, 6.94),
    element("Be", 0.96, 1.53, 0xc2_ff00, 9.012),
    element("B", 0.84, 1.92, 0xff_b5b5, 10.81),
    element("C", 0.76, 1.70, 0x90_9090, 12.011),
    element("N", 0.71, 1.55, 0x30_50f8, 14.007),
    element("O", 0.66, 1.52, 0xff_0d0d, 15.999),
    element("F", 0.57, 1.47, 0x90_e050, 18.998),
    element("Ne", 0.58, 1.54, 0xb3_e3f5, 20.18),
    element("Na", 1.66, 2.27, 0xab_5cf2, 22.99),
    element("Mg", 1.41, 1.73, 0x8a_ff00, 24.305),
    element("Al", 1.21, 1.84, 0xbf_a6a6, 26.982),
    element("Si", 1.11, 2.10, 0xf0_c8a0, 28.085),
    element("P", 1.07, 1.80, 0xff_8000, 30.974),
    element("S", 1.05, 1.80, 0xff_ff30, 32.06),
    element("Cl", 1.02, 1.75, 0x1f_f01f, 35.45),
    element("Ar", 1.06, 1.88, 0x80_d1e3, 39.948),
    element("K", 2.03, 2.75, 0x8f_40d4, 39.098),
    element("Ca", 1.76, 2.31, 0x3d_ff00, 40.078),
    element("Sc", 1.70, 2.58, 0xe6_e6e6, 44.956),
    element("Ti", 1.60, 2.46, 0xbf_c2c7, 47.867),
    element("V", 1.53, 2.42, 0xa6_a6ab, 50.941),
    element("Cr", 1.39, 2.45, 0x8a_99c7, 51.996),
    element("Mn", 1.39, 2.45, 0x9c_7ac7, 54.938),
    element("Fe", 1.32, 2.44, 0xe0_6633, 55.845),
    element("Co", 1.26, 2.40, 0xf0_90a0, 58.933),
    element("Ni", 1.24, 1.63, 0x50_d050, 58.693),
    element("Cu", 1.32, 1.40, 0xc8_8033, 63.546),
    element("Zn", 1.22, 1.39, 0x7d_80b0, 65.38),
    element("Ga", 1.22, 1.87, 0xc2_8f8f, 69.723),
    element("Ge", 1.20, 2.11, 0x66_8f8f, 72.63),
    element("As", 1.19, 1.85, 0xbd_80e3, 74.922),
    element("Se", 1.20, 1.90, 0xff_a100, 78.971),
    element("Br", 1.20, 1.85, 0xa6_2929, 79.904),
    element("Kr", 1.16, 2.02, 0x5c_b8d1, 83.798),
    element("Rb", 2.20, 3.03, 0x70_2eb0, 85.468),
    element("Sr", 1.95, 2.49, 0x00_ff00, 87.62),
    element("Y", 1.90, 2.75, 0x94_ffff, 88.906),
    element("Zr", 1.75, 2.52, 0x94_e0e0, 91.224),
    element("Nb", 1.64, 2.56, 0x73_c2c9, 92.906),
    element("Mo", 1.54, 2.45, 0x54_b5b5, 95.95),
    element("Tc", 1.47, 2.44, 0x3b_9e9e, 97.907),
    element("Ru", 1.46, 2.46, 0x24_8f8f, 101.07),
    element("Rh", 1.42, 2.44, 0x0a_7d8c, 102.906),
    element("Pd", 1.39, 1.63, 0x00_6985, 106.42),
    element("Ag", 1.45, 1.72, 0xc0_c0c0, 107.868),
    element("Cd", 1.44, 1.58, 0xff_d98f, 112.414),
    element("In", 1.42, 1.93, 0xa6_7573, 114.818),
    element("Sn", 1.39, 2.17, 0x66_8080, 118.71),
    element("Sb", 1.39, 2.06, 0x9e_63b5, 121.76),
    element("Te", 1.38, 2.06, 0xd4_7a00, 127.6),
    element("I", 1.39, 1.98, 0x94_0094, 126.904),
    element("Xe", 1.40, 2.16, 0x42_9eb0, 131.293),
    element("Cs", 2.44, 3.43, 0x57_178f, 132.905),
    element("Ba", 2.15, 2.49, 0x00_c900, 137.327),
    element("La", 2.07, 2.98, 0x70_d4ff, 138.905),
    element("Ce", 2.04, 2.88, 0xff_ffc7, 140.116),
    element("Pr", 2.03, 2.92, 0xd9_ffc7, 140.908),
    element("Nd", 2.01, 2.95, 0xc7_ffc7, 144.242),
    element("Pm", 1.99, 0.00, 0xa3_ffc7, 144.913),
    element("Sm", 1.98, 2.90, 0x8f_ffc7, 150.36),
    element("Eu", 1.98, 2.87, 0x61_ffc7, 151.964),
    element("Gd", 1.96, 2.83, 0x45_ffc7, 157.25),
    element("Tb", 1.94, 2.79, 0x30_ffc7, 158.925),
    element("Dy", 1.92, 2.87, 0x1f_ffc7, 162.5),
    element("Ho", 1.92, 2.81, 0x00_ff9c, 164.93),
    element("Er", 1.89, 2.83, 0x00_e675, 167.259),
    element("Tm", 1.90, 2.79, 0x00_d452, 168.934),
    element("Yb", 1.87, 2.80, 0x00_bf38, 173.054),
    element("Lu", 1.87, 2.74, 0x00_ab24, 174.967),
    element("Hf", 1.75, 2.63, 0x4d_c2ff, 178.49),
    element("Ta", 1.70, 2.53, 0x4d_a6ff, 180.948),
    element("W", 1.62, 2.57, 0x21_94d6, 183.84),
    element("Re", 1.51, 2.49, 0x26_7dab, 186.207),
    element("Os", 1.44, 2.48, 0x26_6696, 190.23),
    element("Ir", 1.41, 2.41, 0x17_5487, 192.217),
    element("Pt", 1.36, 1.75, 0xd0_d0e0, 195.084),
    element("Au", 1.36, 1.66, 0xff_d123, 196.967),
    element("Hg", 1.32, 1.55, 0xb8_b8d0, 200.592),
    element("Tl", 1.45, 1.96, 0xa6_544d, 204.38),
    element("Pb", 1.46, 2.02, 0x57_5961, 207.2),
    element("Bi", 1.48, 2.07, 0x9e_4fb5, 208.98),
    element("Po", 1.40, 1.97, 0xab_5c00, 208.982),
    element("At", 1.50, 2.02, 0x75_4f45, 209.987),
    element("Rn", 1.50, 2.20, 0x42_8296, 222.018),
    element("Fr", 2.60, 3.48, 0x42_0066, 223.02),
    element("Ra", 2.21, 2.83, 0x00_7d00, 226.025),
    element("Ac", 2.15, 2.80, 0x70_abfa, 227.028),
    element("Th", 2.06, 2.93, 0x00_baff, 232.038),
    element("Pa", 2.00, 2.88, 0x00_a1ff, 231.036),
    element("U", 1.96, 1.86, 0x00_8fff, 238.029),
    element("Np", 1.90, 2.82, 0x00_80ff, 237.048),
    element("Pu", 1.87, 2.81, 0x00_6bff, 244.064),
    element("Am", 1.80, 2.83, 0x54_5cf2, 243.061),
    element("Cm", 1.69, 3.05, 0x78_5ce3, 247.07),
    element("Bk", 0.00, 3.40, 0x8a_4fe3, 247.07),
    element("Cf", 0.00, 3.05, 0xa1_36d4, 251.08),
    element("Es", 0.00, 2.70, 0xb3_1fd4, 252.083),
    element("Fm", 0.00, 0.00, 0xb3_1fba, 257.095),
    element("Md", 0.00, 0.00, 0xb3_0da6, 258.098),
    element("No", 0.00, 0.00, 0xbd_0d87, 259.101),
    element("Lr", 0.00, 0.00, 0xc7_0066, 262.11),
    element("Rf", 0.00, 0.00, 0xcc_0059, 267.122),
    element("Db", 0.00, 0.00, 0xd1_004f, 268.126),
    element("Sg", 0.00, 0.00, 0xd9_0045, 271.134),
    element("Bh", 0.00, 0.00, 0xe0_0038, 270.133),
    element("Hs", 0.00, 0.00, 0xe6_002e, 269.134),
    element("Mt", 0.00, 0.00, 0xeb_0026, 278.156),
    element("Ds", 0.00, 0.00, 0xeb_0026, 281.165),
    element("Rg", 0.00, 0.00, 0xeb_0026, 281.166),
    element("Cn", 0.00, 0.00, 0xeb_0026, 285.177),
    element("Nh", 0.00, 0.00, 0xeb_0026, 286.182),
    element("Fl", 0.00, 0.00, 0xeb_0026, 289.19),
    element("Mc", 0.00, 0.00, 0xeb_0026, 289.194),
    element("Lv", 0.00, 0.00, 0xeb_0026, 293.204),
    element("Ts", 0.00, 0.00, 0xeb_0026, 293.208),
    element("Og", 0.00, 0.00, 0xeb_0026, 294.214),
];

fn of(number: u8) -> Option<&'static Element> {
    ELEMENTS.get(usize::from(number).checked_sub(1)?)
}

/// The atomic number of a symbol, in capitals or not; deuterium and tritium are hydrogen.
pub(crate) fn number_of(symbol: &[u8]) -> Option<u8> {
    let same = |element: &Element| element.symbol.as_bytes().eq_ignore_ascii_case(symbol);
    match symbol {
        [] => None,
        b"D" | b"T" | b"d" | b"t" => Some(HYDROGEN),
        _ => ELEMENTS.iter().position(same).map(|at| at as u8 + 1),
    }
}

/// The element of a united atom that is named after its group, `Me` or `ME1`; `None`: it is none. Names
/// like `CH3` begin with a symbol.
pub(crate) fn number_of_group(name: &[u8]) -> Option<u8> {
    let letters = name.iter().take_while(|b| b.is_ascii_alphabetic()).count();
    name[..letters].eq_ignore_ascii_case(b"Me").then(|| number_of(b"C")).flatten()
}

/// The element of a label that begins with its symbol, like `C12`, `Fe3+` or `OW`: two letters if they
/// are a symbol written as one (`Cl`, and `CL` before a digit or the end), else the first.
pub(crate) fn number_of_label(label: &[u8]) -> Option<u8> {
    let letters = label.iter().take_while(|b| b.is_ascii_alphabetic()).count();
    let both = || number_of(&label[..2]);
    match letters {
        0 => None,
        1 => number_of(&label[..1]),
        _ if letters == 2 || label[1].is_ascii_lowercase() => {
            both().or_else(|| number_of(&label[..1]))
        }
        _ => number_of(&label[..1]),
    }
}

/// The element that is nearest to a mass in atomic mass units; `None`: none is within 0.3.
pub(crate) fn number_of_mass(mass: f64) -> Option<u8> {
    let off = |element: &Element| (element.mass - mass).abs();
    let (at, nearest) = (1..).zip(&ELEMENTS).min_by(|(_, a), (_, b)| off(a).total_cmp(&off(b)))?;
    (off(nearest) < 0.3).then_some(at)
}

/// The covalent radius in Å; `None`: not known.
pub(crate) fn covalent_radius(number: u8) -> Option<f32> {
    of(number).map(|element| element.covalent).filter(|radius| *radius > 0.0)
}

/// The van der Waals radius in Å; `None`: not known.
pub(crate) fn van_der_waals_radius(number: u8) -> Option<f32> {
    of(number).map(|element| element.van_der_waals).filter(|radius| *radius > 0.0)
}

/// The colour that the element is drawn in, sRGB; of what is none, deep pink.
pub(crate) fn color_of(number: u8) -> [u8; 3] {
    of(number).map_or(NO_ELEMENT, |element| {
        let [_, red, green, blue] = element.color.to_be_bytes();
        [red, green, blue]
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn symbol_of(number: u8) -> Option<&'static str> {
        of(number).map(|element| element.symbol)
    }

    #[test]
    fn symbols_and_labels_name_their_elements() {
        assert_eq!(
            (number_of(b"C"), number_of(b"fe"), number_of(b"D")),
            (Some(6), Some(26), Some(1))
        );
        assert_eq!(number_of(b"Xx"), None);
        for (label, symbol) in [
            ("C12", "C"),
            ("Fe3+", "Fe"),
            ("OW", "O"),
            ("CL1", "Cl"),
            ("HW1", "H"),
            ("HG11", "Hg"),
            ("Cl", "Cl"),
            ("CA", "Ca"),
            ("Namely", "Na"),
            ("CARBON", "C"),
            ("1", ""),
        ] {
            let number = number_of_label(label.as_bytes());
            assert_eq!(number.and_then(symbol_of).unwrap_or(""), symbol, "{label}");
        }
    }

    #[test]
    fn a_mass_names_its_element() {
        assert_eq!((number_of_mass(12.0), number_of_mass(15.9994)), (Some(6), Some(8)));
        assert_eq!((number_of_mass(1.0), number_of_mass(0.0)), (Some(1), None));
        assert_eq!(number_of_mass(f64::NAN), None);
    }

    #[test]
    fn carbon_is_as_it_was_published() {
        assert_eq!((covalent_radius(6), van_der_waals_radius(6)), (Some(0.76), Some(1.70)));
        assert_eq!((color_of(6), color_of(0)), ([0x90; 3], NO_ELEMENT));
    }
}
