//! XTC files: one that GROMACS' own library wrote, and what is made of it by damage.

use glam::DVec3;

use super::{Fault, read, sections};
use crate::source::{Blob, Memory, Source};

/// Three frames of twelve atoms, in picometres; `waters.xtc` holds them as GROMACS' library packs them.
const FRAMES: [[[i32; 3]; 12]; 3] = include!("../../../tests/trajectories/waters.txt");

fn water() -> Vec<u8> {
    include_bytes!("../../../tests/trajectories/waters.xtc").to_vec()
}

fn blob(bytes: Vec<u8>) -> Box<dyn Blob> {
    Memory::new().with("a", bytes).open("a").expect("memory")
}

/// The frames' bytes, and what is wrong behind them.
fn frames(bytes: &[u8]) -> (Vec<Vec<u8>>, Option<(u64, String)>) {
    let mut all = Vec::new();
    let found = sections(&*blob(bytes.to_vec()), &mut |range| {
        all.push(bytes[range.start as usize..range.end as usize].to_vec());
        true
    });
    (all, found.expect("memory").err())
}

fn message(fault: Fault) -> String {
    let Fault::Broken(message) = fault else { panic!("{fault:?}") };
    message
}

fn error(bytes: Vec<u8>) -> String {
    message(read(&*blob(bytes), false, 12).expect_err("a fault"))
}

#[test]
fn packed_places_are_those_that_were_packed() {
    let (all, broken) = frames(&water());
    assert_eq!((all.len(), broken), (3, None));
    for (bytes, wanted) in all.into_iter().zip(FRAMES) {
        let frame = read(&*blob(bytes), true, 12).expect("a frame");
        for (place, picometres) in frame.places.iter().zip(wanted) {
            let wanted = DVec3::from(picometres.map(|n| f64::from(n) * 0.01));
            assert!(place.distance(wanted) < 1e-9, "{place} {wanted}");
        }
        let cell = frame.cell.expect("a cell");
        assert!(cell.edges[0].distance(DVec3::X * 20.0) < 1e-5, "{cell:?}");
    }
    let frame = read(&*blob(water()), false, 12).expect("a frame");
    assert_eq!((frame.count, frame.said, frame.broken), (3, 0, None));
}

#[test]
fn nine_atoms_and_fewer_are_not_packed() {
    let mut file: Vec<u8> = [1995, 1, 7, 0].into_iter().flat_map(u32::to_be_bytes).collect();
    file.extend([0; 36]);
    file.extend(1_u32.to_be_bytes());
    file.extend([0.5_f32, -1.0, 2.0].into_iter().flat_map(f32::to_be_bytes));
    let frame = read(&*blob(file.clone()), false, 1).expect("a frame");
    assert_eq!((frame.places, frame.cell), (vec![DVec3::new(5.0, -10.0, 20.0)], None));
    file[55] = 2;
    let told = message(read(&*blob(file), false, 1).expect_err("a fault"));
    assert!(told.contains("1 atoms, but 2 places"), "{told}");
}

#[test]
fn frames_of_2023_tell_their_length_in_eight_bytes() {
    let (all, _) = frames(&water());
    let mut frame = all[0].clone();
    frame[..4].copy_from_slice(&2023_u32.to_be_bytes());
    frame.splice(88..88, [0; 4]);
    let read = read(&*blob(frame.clone()), false, 12).expect("a frame");
    assert!(read.places[0].distance(DVec3::from(FRAMES[0][0].map(|n| f64::from(n) * 0.01))) < 1e-9);
    frame[88] = 0xff;
    assert!(error(frame.clone()).contains("cut short"), "{}", error(frame));
}

#[test]
fn what_is_wrong_with_a_frame_is_told() {
    let whole = water();
    let first = frames(&whole).0[0].len();
    let changed = |at: usize, number: u32| {
        let mut bytes = whole.clone();
        bytes[at..at + 4].copy_from_slice(&number.to_be_bytes());
        bytes
    };
    assert!(error(whole[..first - 4].to_vec()).contains("cut short"));
    assert!(error(whole[..30].to_vec()).contains("cut short"));
    assert!(error(changed(4, 0)).contains("0 is not how many atoms"));
    assert!(error(changed(4, 13)).contains("13 atoms, but 12 places"));
    // The steps of a nanometre, the least place along x, the span, and how many bytes there are.
    assert!(error(changed(56, 0)).contains("has 0 steps"));
    assert!(error(changed(60, i32::MAX as u32)).contains("reach from"));
    assert!(error(changed(84, 7)).contains("span 7"));
    assert!(error(changed(84, 73)).contains("span 73"));
    assert!(error(changed(88, 1)).contains("not all are told"));
    let other = message(read(&*blob(whole.clone()), false, 11).expect_err("a fault"));
    assert!(other.contains("it has 12 atoms, but the file of atoms has 11"), "{other}");

    let cut = whole[..whole.len() - 4].to_vec();
    let frame = read(&*blob(cut.clone()), false, 12).expect("a frame");
    assert!(frame.count == 2 && frame.broken.is_some_and(|told| told.contains("cut short")));
    let (all, broken) = frames(&cut);
    assert!(all.len() == 2 && broken.is_some_and(|(frame, _)| frame == 2));
}

#[test]
fn damaged_frames_are_read_or_refused() {
    let whole = water();
    for at in 0..whole.len() {
        for byte in [0, 1, 0x7f, 0xff] {
            let mut damaged = whole.clone();
            damaged[at] = byte;
            let _ = frames(&damaged);
            let _ = read(&*blob(damaged), true, 12);
        }
        let _ = read(&*blob(whole[..at].to_vec()), true, 12);
    }
}
