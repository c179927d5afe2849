//! Whatever an image or a packed file holds, it is read to a sound scene or to errors.
#![no_main]

use libfuzzer_sys::fuzz_target;
use phong_fuzz::{check, check_file, spell};
use phong_scene::{Limits, Memory, read};

const ENDINGS: [&str; 4] = ["png", "jpg", "hdr", "exr"];

const SCENE: &str = "version = 1\n[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\n\
    [textures.a]\nkind = \"image\"\nfile = \"a.ENDING\"\n[materials.a]\ncolor = { texture = \"a\" }\n\
    [[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"a\"\n";

/// Words of the formats that are text, and the beginnings of the others.
const WORDS: &[&str] = &[
    "#?RADIANCE\n",
    "FORMAT=32-bit_rle_rgbe\n",
    "EXPOSURE=2\n",
    "\n",
    "-Y 2 +X 2\n",
    "-Y 8 +X 8\n",
    "+Y 2 -X 2\n",
    "\u{2}\u{2}\0\u{8}",
    "\u{1}\u{1}\u{1}\u{7}",
    "abcd",
    "0",
    " ",
    "\0",
    "\0\0\0\0",
    "\0\0\0\u{1}",
    "\u{1}\0\0\0",
    "IHDR",
    "\0\0\0\u{d}IHDR",
    "IDAT",
    "IEND",
    "PLTE",
    "JFIF",
    "v/1\u{1}\u{2}\0\0\0",
    "channels\0chlist\0",
    "compression\0compression\0\u{1}\0\0\0\0",
    "dataWindow\0box2i\0\u{10}\0\0\0",
    "R\0",
    "ply\nformat ascii 1.0\n",
];

fuzz_target!(|data: &[u8]| {
    let Some((kind, rest)) = data.split_first() else { return };
    let beginning: &[u8] = match kind / 8 % 4 {
        0 => b"\x89PNG\r\n\x1a\n",
        1 => b"\xff\xd8\xff",
        2 => b"\x76\x2f\x31\x01",
        _ => b"",
    };
    let file = [beginning, &spell(rest, WORDS)[..]].concat();
    if kind % 8 == 7 {
        // The ten bytes of a gzip file's head, and of it whatever they pack.
        check_file("a.ply.gz", [b"\x1f\x8b\x08\0\0\0\0\0\0\xff", rest].concat());
        return;
    }
    let ending = ENDINGS[usize::from(*kind % 4)];
    let source = Memory::new()
        .with("a.toml", SCENE.replace("ENDING", ending))
        .with(&format!("a.{ending}"), file);
    let limits = Limits { bytes: 64 << 20, ..Limits::default() };
    check(&read("a.toml", None, &source, &limits));
});
