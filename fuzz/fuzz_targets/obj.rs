//! Whatever an OBJ file holds, it is read to a sound scene or to errors.
#![no_main]

use libfuzzer_sys::fuzz_target;
use phong_fuzz::{check, spell};
use phong_scene::{Limits, Memory, read};

const WORDS: &[&str] = &[
    "\n",
    " ",
    "v ",
    "vt ",
    "vn ",
    "f ",
    "0",
    "1",
    "2",
    "3",
    "4",
    "5",
    "-1",
    "-2",
    "-3",
    "/",
    "//",
    ".",
    "-",
    "+",
    "e",
    "e9",
    "7",
    "0.5",
    "\\\n",
    "\\\r\n",
    "\r\n",
    "\t",
    "#",
    "usemtl ",
    "mtllib ",
    "a.mtl",
    "g ",
    "o ",
    "s ",
    "l ",
    "p ",
    "curv ",
    "v 0 0 0\n",
    "v 1 0 0\n",
    "v 0 1 0\n",
    "v 1 1 0.5\n",
    "v 0.2 0.3 0\n",
    "vn 0 0 1\n",
    "vt 0 1\n",
    "f 1 2 3\n",
    "f 1 2 3 4\n",
    "f -1 -2 -3 -4\n",
    "f 1//1 2//1 3//1\n",
    "f 1/1 2/1 3/1 4/1 5/1\n",
    "nan",
    "inf",
    "1e39",
    "99999999999",
    "4294967295",
    "1000000.5 ",
    "f 1 2 3 4 5 1 3 2\n",
];

fuzz_target!(|data: &[u8]| {
    let library = b"newmtl a\nKd 1 0 0\n";
    let source = Memory::new().with("a.obj", spell(data, WORDS)).with("a.mtl", *library);
    let limits = Limits { bytes: 64 << 20, ..Limits::default() };
    check(&read("a.obj", None, &source, &limits));
});
