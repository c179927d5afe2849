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
    draw(molecule(), drawing).unwrap()
}

fn draw(molecule: Molecule, drawing: &Drawing) -> Result<draw::Drawn, String> {
    let (file, limits) = (crate::diagnostic::Span::default(), crate::limits::Limits::default());
    molecule.draw(drawing, &file, None, &limits).map_err(|error| error.message)
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
    assert_eq!((cell.outline([1; 3]).len(), Cell::of_angles([1.0; 3], [180.0; 3])), (12, None));
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

/// An atom's name, element, residue with its number, chain and place.
type Atom = (&'static str, u8, &'static str, f32, &'static str, [f32; 3]);

fn chain(atoms: &[Atom]) -> Molecule {
    let mut molecule = Molecule {
        columns: vec![
            Column::of_words(names::NAME),
            Column::of_words(names::RESIDUE),
            Column::of_numbers(names::NUMBER),
            Column::of_words(names::CHAIN),
        ],
        ..Molecule::default()
    };
    for (name, element, residue, number, chain, [x, y, z]) in atoms {
        molecule.spheres.push([*x, *y, *z, 0.0]);
        molecule.elements.push(*element);
        let [n, r, k, c] = &mut molecule.columns[..] else { panic!() };
        n.values.push_word(name.as_bytes());
        r.values.push_word(residue.as_bytes());
        k.values.push_number(*number);
        c.values.push_word(chain.as_bytes());
    }
    molecule
}

#[test]
fn a_tube_goes_through_the_residues_of_a_chain_and_ends_where_it_breaks() {
    let at = |x: f32| [x, x % 2.0, 0.0];
    let atoms = [
        ("CA", 6, "ALA", 1.0, "A", at(0.0)),
        ("CB", 6, "ALA", 1.0, "A", at(1.0)),
        ("CA", 6, "GLY", 2.0, "A", at(3.0)),
        ("CA", 6, "GLY", 3.0, "A", at(6.0)),
        // Too far, and the next of another chain.
        ("CA", 6, "GLY", 9.0, "A", at(16.0)),
        ("CA", 6, "GLY", 10.0, "A", at(19.0)),
        ("CA", 6, "SER", 1.0, "B", at(22.0)),
        ("CA", 20, "CA", 2.0, "B", at(25.0)),
        ("P", 15, "DA", 1.0, "C", at(40.0)),
        ("P", 15, "DG", 2.0, "C", at(46.0)),
    ];
    let tube = Drawing { style: Some(Style::Tube), ..Drawing::default() };
    let drawn = draw(chain(&atoms), &tube).unwrap();
    let [("tube", Shape::Cylinders(tubes)), ("atoms", Shape::Points(rest))] = &drawn.shapes[..]
    else {
        panic!("{drawn:?}")
    };
    assert_eq!(tubes.segments.len(), 12 * (2 + 1 + 1));
    // A residue alone, and a calcium.
    assert_eq!(rest.spheres.iter().map(|s| s[0]).collect::<Vec<_>>(), [22.0, 25.0]);
    // It meets the atoms, without a gap between its pieces.
    assert_eq!(tubes.segments[12][0], [3.0, 1.0, 0.0, 0.5]);
    assert!(tubes.segments[..24].windows(2).all(|pair| pair[0][1] == pair[1][0]));
    assert!(tubes.colors[0] == tubes.colors[35] && tubes.colors[0] != tubes.colors[47]);
    let alone = draw(chain(&atoms[6..8]), &tube).unwrap_err();
    assert!(alone.starts_with("no chain of residues is found"), "{alone}");
}

/// Two particles in a cell of 4 × 4 × 4, tilted, bound over its face.
fn periodic() -> Molecule {
    let mut molecule = Molecule {
        spheres: vec![[0.5, 2.0, 2.0, 0.5], [3.5, 2.0, 2.0, 0.5]],
        bonds: vec![[0, 1]],
        all_bonds: true,
        columns: vec![Column::of_numbers("vx"), Column::of_numbers("zero")],
        ..Molecule::default()
    };
    molecule.columns[0].values.push_number(2.0);
    molecule.columns[0].values.push_number(0.0);
    molecule.columns[1].values.push_number(0.0);
    molecule.columns[1].values.push_number(0.0);
    let edges = [[4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [1.0, 0.0, 4.0]].map(DVec3::from);
    molecule.cell = Some(Cell { origin: DVec3::ZERO, edges });
    molecule
}

#[test]
fn images_repeat_atoms_along_the_edges_and_bonds_lead_over_them() {
    let images = |cells, layer| {
        let images = Images { cells, layer };
        let style = Some(Style::BallAndStick);
        draw(periodic(), &Drawing { images, style, cell: true, ..Drawing::default() })
    };
    let drawn = images([2, 1, 2], 0.0).unwrap();
    let [
        ("atoms", Shape::Points(atoms)),
        ("bonds", Shape::Cylinders(bonds)),
        (_, Shape::Cylinders(cell)),
    ] = &drawn.shapes[..]
    else {
        panic!("{drawn:?}")
    };
    assert_eq!((atoms.spheres.len(), bonds.segments.len()), (8, 2));
    assert_eq!(atoms.spheres[6], [5.5, 2.0, 6.0, 0.5], "along the tilted edge as well");
    let [from, to] = bonds.segments[0];
    assert_eq!((from[0], to[0]), (3.5, 4.5), "to the nearest image");
    assert_eq!(drawn.notes, ["bonds beyond the images are not drawn: 2"]);
    assert_eq!(cell.segments.len(), 33, "each edge once");

    let Ok(drawn) = images([1; 3], 1.0) else { panic!() };
    let Shape::Points(atoms) = &drawn.shapes[0].1 else { panic!() };
    let xs: Vec<f32> = atoms.spheres.iter().map(|s| s[0]).collect();
    // One is 0.97 from the tilted face, and 1 along the edge.
    assert_eq!(xs, [0.5, 3.5, -0.5, 4.5]);
    assert!(images([1; 3], 1e9).unwrap_err().starts_with("the images are more than"));
    let none = Molecule { cell: None, ..periodic() };
    let images = Images { cells: [2, 1, 1], layer: 0.0 };
    let none = draw(none, &Drawing { images, ..Drawing::default() }).unwrap_err();
    assert_eq!(none, "the file says nothing of a cell");
    let cells = [3, 1, 2];
    let cell = periodic().cell.unwrap();
    assert_eq!(Cell::edges(cells), cell.outline(cells).len() as u64);
}

#[test]
fn arrows_have_a_shaft_and_a_head_and_are_as_long_as_their_vectors() {
    let arrows = |columns: [&str; 3], scale| {
        let columns = columns.map(str::to_owned);
        let vectors = Some(Arrows { columns, scale, radius: None });
        let style = Some(Style::Spacefill);
        draw(periodic(), &Drawing { style, vectors, ..Drawing::default() })
    };
    let drawn = arrows(["vx", "zero", "zero"], Some(3.0)).unwrap();
    let ("vectors", Shape::Cylinders(arrows_drawn)) = &drawn.shapes[0] else { panic!("{drawn:?}") };
    let [[from, neck], [base, tip]] = arrows_drawn.segments[..] else { panic!() };
    assert_eq!((from[..3].to_vec(), tip[..3].to_vec()), (vec![0.5, 2.0, 2.0], vec![6.5, 2.0, 2.0]));
    assert!(base[..3] == neck[..3] && base[3] > neck[3] && tip[3] < 0.01 * neck[3]);
    assert_eq!(drawn.notes, ["atoms without an arrow, as their vector is 0 or no number: 1"]);
    // Neighbours are 3 apart, so that the longest is of 7.5.
    let drawn = arrows(["vx", "zero", "zero"], None).unwrap();
    let Shape::Cylinders(guessed) = &drawn.shapes[0].1 else { panic!() };
    assert_eq!(guessed.segments[1][1][0], 8.0);
    let nothing = arrows(["zero"; 3], None).unwrap_err();
    assert_eq!(nothing, "no atom has a vector: all are 0, or no numbers");
    assert!(arrows(["vx", "vy", "zero"], None).unwrap_err().contains("no column"));
    assert!(arrows(["vx", "zero", "zero"], Some(1e18)).unwrap_err().contains("too long"));
}
