//! Frames of DCD files, which move the atoms of another file.

use glam::DVec3;

use super::{FrameRange, Frames};
use crate::change::Change;
use crate::diagnostic::Diagnostic;
use crate::format::read_changed;
use crate::format::trajectory::read;
use crate::limits::Limits;
use crate::scene::Scene;
use crate::source::{Memory, Source};

/// How a trajectory is written.
#[derive(Clone, Copy)]
struct Written {
    big: bool,
    cell: Option<[f64; 6]>,
    /// The first atom stands still.
    fixed: bool,
    said: i32,
}

const PLAIN: Written = Written { big: false, cell: None, fixed: false, said: 3 };

impl Written {
    fn integer(self, number: i32) -> [u8; 4] {
        if self.big { number.to_be_bytes() } else { number.to_le_bytes() }
    }

    fn record(self, bytes: &[u8]) -> Vec<u8> {
        let mark = self.integer(bytes.len() as i32);
        [&mark[..], bytes, &mark].concat()
    }

    /// Three frames of two atoms; in frame f the second is at `[f, 2, 3]`.
    fn file(self) -> Vec<u8> {
        let mut numbers = [0; 20];
        (numbers[0], numbers[8], numbers[19]) = (self.said, self.fixed.into(), 24);
        numbers[10] = self.cell.is_some().into();
        let numbers: Vec<u8> = numbers.into_iter().flat_map(|n| self.integer(n)).collect();
        let mut file = self.record(&[b"CORD", &numbers[..]].concat());
        file.extend(self.record(&[&self.integer(1)[..], &[b' '; 80]].concat()));
        file.extend(self.record(&self.integer(2)));
        if self.fixed {
            file.extend(self.record(&self.integer(2)));
        }
        for frame in 0..3_u8 {
            if let Some(cell) = self.cell {
                let number = |n: f64| if self.big { n.to_be_bytes() } else { n.to_le_bytes() };
                file.extend(self.record(&cell.into_iter().flat_map(number).collect::<Vec<u8>>()));
            }
            for pair in [[9.0, f32::from(frame)], [9.0, 2.0], [9.0, 3.0]] {
                let told = if self.fixed && frame > 0 { &pair[1..] } else { &pair[..] };
                let number = |n: &f32| if self.big { n.to_be_bytes() } else { n.to_le_bytes() };
                file.extend(self.record(&told.iter().flat_map(number).collect::<Vec<u8>>()));
            }
        }
        file
    }
}

fn files(dcd: Vec<u8>) -> Memory {
    let atoms = b"2\n\nC 0 0 0\nO 1.2 0 0\n";
    Memory::new().with("dir/a.xyz", *atoms).with("dir/a.dcd", dcd)
}

fn changes() -> Vec<Change> {
    let set = |words: &str| Change::parse(words).unwrap();
    vec![set("molecule.1.trajectory=a.dcd"), set("molecule.1.style=spacefill")]
}

/// The first frame, or what is said of it.
fn first(dcd: Vec<u8>) -> (Option<Scene>, Vec<Diagnostic>) {
    let reading = read_changed("dir/a.xyz", None, &files(dcd), &Limits::default(), &changes());
    (reading.scene, reading.diagnostics)
}

fn places(scene: &Scene) -> Vec<[f64; 3]> {
    let crate::shape::Shape::Points(points) = &scene.objects[0].shape else { panic!() };
    let place = |s: &[f32; 4]| points.origin + DVec3::new(s[0].into(), s[1].into(), s[2].into());
    points.spheres.iter().map(|s| place(s).to_array()).collect()
}

#[test]
fn a_trajectory_is_read_in_either_order_of_bytes_with_cells_and_fixed_atoms() {
    for big in [false, true] {
        for cell in [None, Some([9.0, 0.0, 8.0, 0.0, 0.0, 7.0])] {
            for fixed in [false, true] {
                let written = Written { big, cell, fixed, ..PLAIN };
                let (scene, said) = first(written.file());
                assert_eq!(places(&scene.unwrap()), [[9.0; 3], [0.0, 2.0, 3.0]]);
                assert_eq!(said.len(), 1, "{said:?}");
                assert!(said[0].message.contains("others follow it"), "{said:?}");

                let (files, limits, changes) =
                    (files(written.file()), Limits::default(), changes());
                let range = FrameRange { start: 0, end: None, step: 1 };
                let frames = Frames::new(&files, &limits, range);
                for number in [0, 2, 1] {
                    let reading = frames.read(number, "dir/a.xyz", None, &changes);
                    assert_eq!(reading.diagnostics, []);
                    let at = [[9.0; 3], [number as f64, 2.0, 3.0]];
                    assert_eq!(places(&reading.scene.unwrap()), at);
                }
                assert_eq!(frames.numbers().unwrap(), [0, 1, 2]);
            }
        }
    }
}

#[test]
fn the_cube_of_one_angstrom_that_stands_for_none_is_no_cell() {
    let changes = [changes(), vec![Change::parse("molecule.1.cell=true").unwrap()]].concat();
    for (length, is_cell) in [(9.0, true), (1.0, false)] {
        let cell = Some([length, 0.0, length, 0.0, 0.0, length]);
        let files = files(Written { cell, ..PLAIN }.file());
        let reading = read_changed("dir/a.xyz", None, &files, &Limits::default(), &changes);
        assert_eq!(reading.scene.is_some(), is_cell, "{:?}", reading.diagnostics);
    }
}

#[test]
fn frames_of_an_xtc_are_read_one_by_one_up_to_the_one_that_is_broken() {
    let xtc = include_bytes!("../../../tests/trajectories/waters.xtc");
    let atoms = include_bytes!("../../../tests/trajectories/waters.xyz");
    let limits = Limits::default();
    let files = |xtc: &[u8]| Memory::new().with("dir/a.xyz", *atoms).with("dir/a.dcd", xtc);
    let range = FrameRange { start: 0, end: None, step: 1 };
    let whole = files(xtc);
    let frames = Frames::new(&whole, &limits, range);
    for (number, x) in [(0, 3.24), (2, 2.79), (1, 3.12)] {
        let reading = frames.read(number, "dir/a.xyz", None, &changes());
        assert_eq!(reading.diagnostics, []);
        let first = places(&reading.scene.unwrap())[0][0];
        assert!((first - x).abs() < 1e-6, "{number}: {first}");
    }
    assert_eq!(frames.numbers().unwrap(), [0, 1, 2]);

    let cut = files(&xtc[..xtc.len() - 4]);
    let frames = Frames::new(&cut, &limits, range);
    let reading = frames.read(0, "dir/a.xyz", None, &changes());
    let said = reading.diagnostics[0].to_string();
    assert!(reading.scene.is_none() && said.contains("frame 2: byte 284: the frame"), "{said}");
    assert!(said.starts_with("dir/a.dcd: "), "{said}");
    let (scene, said) = {
        let reading = read_changed("dir/a.xyz", None, &cut, &limits, &changes());
        (reading.scene, reading.diagnostics)
    };
    assert!(scene.is_some() && said[0].message.contains("sound for 2 frames"), "{said:?}");
}

#[test]
fn what_is_wrong_with_a_trajectory_is_told() {
    let whole = PLAIN.file();
    let start = whole.len() - 3 * 48;
    let error = |dcd: Vec<u8>| {
        let (scene, said) = first(dcd);
        assert!(scene.is_none());
        said[0].message.clone()
    };
    let cut = error(whole[..start + 20].to_vec());
    assert!(cut.contains("its first frame is cut short"), "{cut}");
    assert!(error(whole[..start].to_vec()).contains("it has no frame"));
    assert!(error(whole[..40].to_vec()).contains("does not begin as one"));
    let mut other = whole.clone();
    other[start - 8] = 3;
    let other = error(other);
    assert!(other.contains("it has 3 atoms, but the file of atoms has 2"), "{other}");
    let mut broken = whole.clone();
    broken[start + 12] = 7;
    let broken = error(broken);
    assert!(broken.contains("a record of 8 bytes does not end where it says"), "{broken}");
    let mut huge = whole.clone();
    huge[start - 8..start - 4].copy_from_slice(&i32::MAX.to_le_bytes());
    assert!(error(huge).contains("atoms"));
    let files = Memory::new().with("a.xyz", *b"1\n\nC 0 0 0\n");
    let gone = read_changed("a.xyz", None, &files, &Limits::default(), &changes());
    assert!(gone.diagnostics[0].message.contains("a.dcd"), "{:?}", gone.diagnostics);

    let (scene, said) = first(Written { said: 9, ..PLAIN }.file());
    assert!(scene.is_some() && said[0].message.contains("says that it has 9 frames, but it has 3"));
    let mut lost = whole;
    lost[start + 4..start + 8].copy_from_slice(&f32::NAN.to_le_bytes());
    let (scene, said) = first(lost);
    assert_eq!(places(&scene.unwrap()).len(), 1);
    assert!(said[0].message.contains("places of the trajectory that are none: 1"), "{said:?}");
}

#[test]
fn titles_beyond_the_length_of_their_record_are_skipped() {
    let mut whole = PLAIN.file();
    let more = [b' '; 80];
    // Two titles in a record that says it has one.
    whole[96] = 2;
    whole.splice(100..100, more);
    assert_eq!(places(&first(whole).0.unwrap())[1], [0.0, 2.0, 3.0]);
}

#[test]
fn damaged_trajectories_are_read_or_refused() {
    let whole = Written { cell: Some([9.0, 0.0, 8.0, 0.0, 0.0, 7.0]), fixed: true, ..PLAIN }.file();
    for at in 0..whole.len() {
        for byte in [0, 1, 0x7f, 0xff] {
            let mut damaged = whole.clone();
            damaged[at] = byte;
            let blob = Memory::new().with("a", damaged).open("a").unwrap();
            let _ = read(&*blob, true, 2);
        }
        let blob = Memory::new().with("a", whole[..at].to_vec()).open("a").unwrap();
        let _ = read(&*blob, true, 2);
    }
}

#[test]
fn cells_of_degrees_cosines_and_matrices_are_the_same() {
    let whole = |cell| Written { cell: Some(cell), ..PLAIN }.file();
    let cell = |numbers| {
        let blob = Memory::new().with("a", whole(numbers)).open("a").unwrap();
        read(&*blob, false, 2).unwrap().cell.unwrap()
    };
    let degrees = cell([4.0, 60.0, 4.0, 90.0, 90.0, 5.0]);
    let cosines = cell([4.0, 0.5, 4.0, 0.0, 0.0, 5.0]);
    for (a, b) in degrees.edges.iter().zip(cosines.edges) {
        assert!(a.distance(b) < 1e-12, "{a} {b}");
    }
    let matrix = cell([4.0, -2.0, 4.0, 0.0, 0.0, 5.0]);
    assert_eq!(matrix.edges[0], DVec3::new(4.0, -2.0, 0.0));
}

#[test]
fn atoms_of_a_dump_take_the_places_of_their_numbers() {
    let dump = |columns: &str, rows: &str| {
        let text = format!(
            "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n0 9\n0 9\n0 9\n\
             ITEM: ATOMS {columns}\n{rows}"
        );
        let files = files(PLAIN.file()).with("dir/a.lammpstrj", text.into_bytes());
        read_changed("dir/a.lammpstrj", None, &files, &Limits::default(), &changes())
    };
    let radii = |reading: &crate::scene::Reading| {
        let scene = reading.scene.as_ref().expect("a scene");
        let crate::shape::Shape::Points(points) = &scene.objects[0].shape else { panic!() };
        points.spheres.iter().map(|s| s[3]).collect::<Vec<_>>()
    };
    let ordered = dump("id radius x y z", "1 0.5 0 0 0\n2 0.25 3 0 0\n");
    let turned = dump("id radius x y z", "2 0.25 3 0 0\n1 0.5 0 0 0\n");
    assert_eq!(radii(&turned), radii(&ordered));
    assert_eq!(places(&turned.scene.unwrap()), places(&ordered.scene.unwrap()));
    let without = dump("radius x y z", "0.5 0 0 0\n0.25 3 0 0\n");
    assert!(without.scene.is_none());
    assert!(without.diagnostics[0].message.contains("no `id`"), "{:?}", without.diagnostics);
}

#[test]
fn so_many_bytes_and_so_many_frames_are_looked_through_and_no_more() {
    let three = Memory::new().with("a.xyz", *b"1\n\nH 0 0 0\n1\n\nH 0 0 1\n1\n\nH 0 0 2\n");
    let (limits, range) = (Limits::default(), FrameRange { start: 0, end: None, step: 1 });
    for (bytes, count, found) in [(u64::MAX, 9, 3), (u64::MAX, 2, 2), (12, 9, 2), (24, 9, 3)] {
        let frames = Frames::new(&three, &limits, range).within(bytes, count);
        assert!(frames.read(1, "a.xyz", None, &[]).scene.is_some());
        assert_eq!(frames.numbers().unwrap().len(), found, "{bytes} {count}");
    }
    // The places of frames in a DCD are known without reading it.
    let files = files(PLAIN.file());
    let frames = Frames::new(&files, &limits, range).within(1, 9);
    assert!(frames.read(0, "dir/a.xyz", None, &changes()).scene.is_some());
    assert_eq!(frames.numbers().unwrap(), [0, 1, 2]);
}
