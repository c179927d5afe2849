//! Whatever a PLY file holds, it is read to a sound scene or to errors.
#![no_main]

use libfuzzer_sys::fuzz_target;
use phong_fuzz::{check_file, spell};

const WORDS: &[&str] = &[
    "\n",
    " ",
    "0",
    "1",
    "2",
    "3",
    "4",
    "5",
    "-1",
    "0.5",
    "nan",
    "1e39",
    "16777217 ",
    "\r\n",
    "\t",
    "element vertex 3\n",
    "element vertex 4\n",
    "element face 1\n",
    "element face 2\n",
    "element tristrips 1\n",
    "element odd 2\n",
    "property float x\n",
    "property float y\n",
    "property float z\n",
    "property double x\n",
    "property short y\n",
    "property uchar z\n",
    "property float nx\n",
    "property float ny\n",
    "property float nz\n",
    "property uchar red\n",
    "property uchar green\n",
    "property uchar blue\n",
    "property float red\n",
    "property float radius\n",
    "property float s\n",
    "property float t\n",
    "property list uchar int vertex_indices\n",
    "property list uint short vertex_index\n",
    "property list char float odd\n",
    "property list double int odd\n",
    "comment \n",
    "comment TextureFile a.png\n",
    "obj_info \n",
    "end_header\n",
    "format ascii 1.0\n",
    "property float x\nproperty float y\nproperty float z\n",
    "0 0 0\n",
    "1 0 0\n",
    "0 1 0\n",
    "3 0 1 2\n",
    "4 0 1 2 3\n",
    "\0",
    "\u{1}",
    "\u{2}",
    "\u{3}",
    "\u{4}",
    "\0\0\0\0",
    "\u{3}\0\0\0\0\u{1}\0\0\0\u{2}\0\0\0",
    "?",
    "\0\0\u{7f}?",
    "f_dc_0",
    "99999999999",
];

fuzz_target!(|data: &[u8]| {
    let Some((format, rest)) = data.split_first() else { return };
    let mut file = spell(rest, WORDS);
    let named = ["ascii", "binary_little_endian", "binary_big_endian"];
    if let Some(name) = named.get(usize::from(format % 4)) {
        file.splice(0..0, format!("ply\nformat {name} 1.0\n").into_bytes());
    }
    check_file("a.ply", file);
});
