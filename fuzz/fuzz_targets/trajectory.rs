//! Whatever a trajectory holds, its atoms are read to a sound scene or to errors, and so are its frames one by one.
#![no_main]

use libfuzzer_sys::fuzz_target;
use phong_fuzz::check;
use phong_scene::{FrameRange, Frames, Limits, Memory, read};

const SCENE: &[u8] = b"version = 1\n[camera]\neye = [0, 0, 50]\nlook_at = [0, 0, 0]\n\
    [[molecule]]\nfile = \"a.xyz\"\ntrajectory = \"a.xtc\"\n";

/// As many atoms as XTC files pack.
const ATOMS: &[u8] = b"10\n\nC 0 0 0\nC 1 0 0\nC 2 0 0\nC 3 0 0\nC 4 0 0\nC 5 0 0\nC 6 0 0\nC 7 0 0\nC 8 0 0\nC 9 0 0\n";

/// A frame of an XTC up to the steps of a nanometre, and the first record of a DCD.
const BEGINNINGS: [&[u8]; 2] = [
    b"\x00\x00\x07\xcb\x00\x00\x00\x0a\x00\x00\x00\x00\x00\x00\x00\x00\
      \x3f\x80\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x3f\x80\x00\x00\
      \x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x3f\x80\x00\x00\x00\x00\x00\x0a\x44\x7a\x00\x00",
    b"\x54\x00\x00\x00CORD",
];

fuzz_target!(|data: &[u8]| {
    let Some((kind, rest)) = data.split_first() else { return };
    let beginning = BEGINNINGS.get(usize::from(*kind % 3)).copied().unwrap_or_default();
    let file = [beginning, rest].concat();
    let source = Memory::new().with("a.toml", SCENE).with("a.xyz", ATOMS).with("a.xtc", file);
    let limits = Limits { bytes: 64 << 20, ..Limits::default() };
    check(&read("a.toml", None, &source, &limits));
    let frames = Frames::new(&source, &limits, FrameRange { start: 0, end: None, step: 1 });
    for number in 0..2 {
        check(&frames.read(number, "a.toml", None, &[]));
    }
});
