use super::*;
use crate::elements::number_of;
use crate::shape::Shape;

/// A small protein with two chains, a ligand and water; three hydrogens.
fn molecule() -> Molecule {
    let atoms = [
        ("N", "N", "ALA", 1.0, "A", 10.0),
        ("CA", "C", "ALA", 1.0, "A", 20.0),
        ("CB", "C", "ALA", 1.0, "A", 30.0),
        ("HA", "H", "ALA", 1.0, "A", 40.0),
        ("N", "N", "GLY", 12.0, "B", 50.0),
        ("C1", "C", "LIG", 1.0, "B", 60.0),
        ("O", "O", "HOH", 101.0, "A", 70.0),
        ("H1", "H", "HOH", 101.0, "A", 80.0),
        ("H2", "H", "HOH", 101.0, "A", 90.0),
    ];
    let mut molecule = Molecule {
        columns: vec![
            Column::of_words(names::NAME),
            Column::of_words(names::RESIDUE),
            Column::of_numbers(names::NUMBER),
            Column::of_words(names::CHAIN),
            Column::of_numbers(names::B_FACTOR),
        ],
        ..Molecule::default()
    };
    for (i, (name, element, residue, number, chain, b)) in atoms.into_iter().enumerate() {
        molecule.spheres.push([1.5 * i as f32, 0.0, 0.0, 0.0]);
        molecule.elements.push(number_of(element.as_bytes()).unwrap());
        let [n, r, k, c, f] = &mut molecule.columns[..] else { panic!() };
        n.values.push_word(name.as_bytes());
        r.values.push_word(residue.as_bytes());
        k.values.push_number(number);
        c.values.push_word(chain.as_bytes());
        f.values.push_number(b);
    }
    molecule
}

fn selected(text: &str) -> Vec<usize> {
    let chosen = Selection::parse(text).unwrap().of(&molecule()).unwrap();
    (0..chosen.len()).filter(|i| chosen[*i]).collect()
}

#[test]
fn selections_mean_what_they_say() {
    for (text, atoms) in [
        ("all", &[0, 1, 2, 3, 4, 5, 6, 7, 8][..]),
        ("none", &[]),
        ("protein", &[0, 1, 2, 3, 4]),
        ("chain A and not water", &[0, 1, 2, 3]),
        ("CHAIN = A AND NOT WATER", &[0, 1, 2, 3]),
        ("chain != A", &[4, 5]),
        ("not hydrogen and chain A", &[0, 1, 2, 6]),
        ("element N O", &[0, 4, 6]),
        ("residue ALA", &[0, 1, 2, 3]),
        ("residue 10-20 LIG", &[4, 5]),
        ("resid 101", &[6, 7, 8]),
        ("backbone", &[0, 1, 4]),
        ("name CA or name \"C1\"", &[1, 5]),
        ("b-factor > 60 or (x < 2 and element C)", &[1, 6, 7, 8]),
        ("index 1-2", &[0, 1]),
        ("x -1:2", &[0, 1]),
        ("chain A or chain B and water", &[0, 1, 2, 3, 6, 7, 8]),
    ] {
        assert_eq!(selected(text), atoms, "{text}");
    }
}

#[test]
fn what_is_wrong_with_a_selection_is_said_at_its_place() {
    for (text, at, message) in [
        ("", 0..0, "nothing is selected"),
        ("chain A protien", 8..15, ""),
        ("protien", 0..7, "\"protien\" selects nothing that is known"),
        ("chain", 0..5, "`chain` is followed by no value"),
        ("(chain A", 8..8, "a `)` is missing"),
        ("chain A)", 7..8, "this `)` closes nothing"),
        ("chain A and", 11..11, "the selection ends where more is wanted"),
        ("and chain A", 0..3, "`and` stands where atoms are wanted"),
        ("x < ", 4..4, "a number is wanted here"),
        ("water water", 6..11, "\"water\" stands where `and` or `or` is wanted"),
    ] {
        match Selection::parse(text) {
            // A chain may be called so.
            Ok(_) => assert_eq!(message, "", "{text}"),
            Err(wrong) => assert_eq!((wrong.at, wrong.message.as_str()), (at, message), "{text}"),
        }
    }
    let nested = "(".repeat(10_000);
    assert_eq!(
        Selection::parse(&nested).unwrap_err().message,
        "the selection is nested too deeply"
    );
    let (at, wrong) = Selection::parse("all and chian A").unwrap().of(&molecule()).unwrap_err();
    assert_eq!((at, wrong.message.as_str()), (8..13, "the file has no column \"chian\""));
    assert_eq!(wrong.help.as_deref(), Some("did you mean `chain`?"));
}

fn drawn(drawing: &Drawing) -> draw::Drawn {
    molecule().draw(drawing, &crate::diagnostic::Span::default(), None).unwrap()
}

#[test]
fn water_is_left_out_unless_it_is_selected() {
    let drawn_atoms = |select: Option<&str>| {
        let select = select.map(|text| Selection::parse(text).unwrap());
        let drawn = drawn(&Drawing { select, style: Some(Style::Spacefill), ..Drawing::default() });
        let Shape::Points(points) = &drawn.shapes[0].1 else { panic!() };
        (points.spheres.len(), drawn.notes)
    };
    assert_eq!(drawn_atoms(None), (6, vec!["water is not drawn: 3 atoms".to_owned()]));
    assert_eq!(drawn_atoms(Some("all")), (9, vec![]));
    assert_eq!(drawn_atoms(Some("water")), (3, vec![]));
}

#[test]
fn bonds_are_drawn_in_halves_of_their_atoms_colours() {
    let drawn = drawn(&Drawing { style: Some(Style::Sticks), ..Drawing::default() });
    let [("bonds", Shape::Cylinders(bonds))] = &drawn.shapes[..] else { panic!("{drawn:?}") };
    // All in a row, 1.5 Å apart: what reaches that far is bound.
    assert_eq!((bonds.segments.len(), bonds.colors.len()), (4, 4));
    assert_eq!(bonds.segments[0], [[0.0, 0.0, 0.0, 0.22], [1.5, 0.0, 0.0, 0.22]]);
    assert_eq!(bonds.colors[0], [7, 6].map(|e| Rgb::from_srgb8(crate::elements::color_of(e))));
}

#[test]
fn a_cell_of_angles_has_their_edges() {
    let cell = Cell::of_angles([2.0, 3.0, 4.0], [90.0, 90.0, 120.0]).unwrap();
    assert!(cell.edges[1].distance(DVec3::new(-1.5, 3.0 * 0.75_f64.sqrt(), 0.0)) < 1e-12);
    assert_eq!(cell.edges[2], DVec3::new(0.0, 0.0, 4.0));
    assert_eq!((cell.outline().len(), Cell::of_angles([1.0; 3], [180.0; 3])), (12, None));
    assert!((Cell::of_angles([2.0; 3], [90.0; 3]).unwrap().thickness() - 2.0).abs() < 1e-12);
}

#[test]
fn what_is_left_out_takes_its_bonds_along() {
    let mut molecule = molecule();
    molecule.bonds = vec![[0, 1], [1, 2], [2, 4]];
    let keep: Vec<bool> = (0..9).map(|i| i != 1).collect();
    molecule.retain(&keep);
    assert_eq!((molecule.len(), molecule.bonds), (8, vec![[1, 3]]));
}
