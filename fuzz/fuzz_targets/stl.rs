//! Whatever an STL file holds, it is read to a sound scene or to errors.
#![no_main]

use libfuzzer_sys::fuzz_target;
use phong_fuzz::{check_file, spell};

const WORDS: &[&str] = &[
    "\n",
    " ",
    "\r\n",
    "\t",
    "0",
    "1",
    "-0",
    "0.5",
    "nan",
    "1e39",
    "1e19",
    "solid\n",
    "solid a\n",
    "endsolid\n",
    "endsolid a\n",
    "facet\n",
    "facet normal 0 0 1\n",
    "facet normal 0 0 -1\n",
    "outer loop\n",
    "endloop\n",
    "endfacet\n",
    "vertex 0 0 0\n",
    "vertex 1 0 0\n",
    "vertex 0 1 0\n",
    "vertex 0 0 1\n",
    "vertex 1 0\n",
    "vertex nan 0 0\n",
    "VERTEX 2 2 2 2\n",
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n",
    "colour 1 0 0\n",
    "#",
    "\\",
    "\0",
    "\0\0\0\0",
    "\0\0",
    "\u{1}\0\0\0",
    "\u{2}\0\0\0",
    "\0\0\u{7f}?",
    "\0\0\u{7f}\u{7f}",
    "????",
];

fuzz_target!(|data: &[u8]| {
    let Some((kind, rest)) = data.split_first() else { return };
    let mut file = spell(rest, WORDS);
    match kind % 4 {
        0 => drop(file.splice(0..0, *b"solid\n")),
        // A binary head whose count is right, or one too high.
        n @ (1 | 2) => {
            let facets = (file.len() / 50) as u32 + u32::from(n - 1);
            file.splice(0..0, [&[b' '; 80][..], &facets.to_le_bytes()].concat());
            file.truncate(84 + file.len().saturating_sub(84) / 50 * 50);
        }
        _ => {}
    }
    check_file("a.stl", file);
});
