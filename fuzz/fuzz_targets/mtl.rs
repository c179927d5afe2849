//! Whatever an MTL file holds, its materials are sound, or there are errors.
#![no_main]

use libfuzzer_sys::fuzz_target;
use phong_fuzz::{check, spell};
use phong_scene::{Limits, Memory, read};

const WORDS: &[&str] = &[
    "\n",
    " ",
    "newmtl a\n",
    "newmtl b\n",
    "Ka ",
    "Kd ",
    "Ks ",
    "Ke ",
    "Ns ",
    "Ni ",
    "Tf ",
    "Tr ",
    "d ",
    "illum ",
    "0",
    "1",
    "2",
    "3",
    "4",
    "5",
    "6",
    "7",
    "8",
    "9",
    "10",
    "-1",
    ".5",
    "0.25",
    "1e39",
    "nan",
    "-halo ",
    "spectral ",
    "xyz ",
    "map_Kd ",
    "bump ",
    "refl ",
    "-o ",
    "-mm ",
    "-clamp ",
    "on ",
    "a b.png",
    "#",
    "\r\n",
    "\t",
    "sharpness ",
    "Pr ",
    "1000 ",
    "-",
];

fuzz_target!(|data: &[u8]| {
    let model = b"mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\n";
    let source = Memory::new().with("a.mtl", spell(data, WORDS)).with("a.obj", *model);
    let reading = read("a.obj", None, &source, &Limits::default());
    check(&reading);
    for m in reading.scene.iter().flat_map(|scene| &scene.materials) {
        let m = &m.at(|_| phong_scene::Rgb::BLACK);
        let numbers = [m.k_a, m.k_d, m.k_s, m.shininess, m.ior];
        assert!(numbers.iter().all(|n| n.is_finite() && *n >= 0.0) && m.ior > 0.0, "{m:?}");
        let colors = [Some(m.color), m.ambient_color, m.specular_color];
        let colors = colors.into_iter().flatten().chain([m.reflection, m.transmission]);
        let mut channels = colors.flat_map(|c| c.to_array());
        assert!(channels.all(|c| c.is_finite() && c >= 0.0), "{m:?}");
    }
});
