//! Whatever a scene's text says, it is read to a scene or to errors, each at a place in the text.
#![no_main]

use libfuzzer_sys::fuzz_target;
use phong_scene::{Limits, Memory, Reading, read};

/// Words of the language, one a byte, so that the fuzzer finds its way without examples.
const WORDS: &[&str] = &[
    "\n", " = ", "[", "]", "{", "}", ", ", ".", "\"", "'", "\"\"\"", "#", "\\", "\r\n", "é", "-",
    "0", "1", "2.5", "1e300", "nan", "inf", "-1", "0x7f", "true", "1979-05-27", "[0, 0, 0]",
    "[0, 1, 0]", "[1, 2, 3]", "[3, 1, 2, 90]", "\"a\"", "\"b\"", "\"red\"", "\"#f80\"",
    "\"object\"", "\"transparent\"", "version = 1\n", "[camera]\neye = [0, 0, 5]\n",
    "look_at = [0, 0, 0]\n", "[image]\n", "[ambient]\n", "[[light]]\n", "[materials.a]\n",
    "[groups.a]\n", "[[groups.a.sphere]]\n", "[[groups.a.instance]]\n", "[[groups.b.instance]]\n",
    "[[instance]]\n", "[[include]]\n", "[[sphere]]\n", "[[plane]]\n", "[[triangle]]\n",
    "[[disc]]\n", "[[box]]\n", "[[cylinder]]\n", "[[cone]]\n", "[[torus]]\n", "[[mesh]]\n",
    "[[points]]\n", "kind", "name", "position", "direction", "target", "cone", "edge", "color",
    "specular_color", "attenuation", "radius", "angle", "model", "k_a", "k_s", "texture", "channel", "colors", "stops", "space", "kind = \"checker\"\n",
    "kind = \"gradient\"\n", "kind = \"grid\"\n", "kind = \"noise\"\n", "kind = \"cells\"\n", "octaves", "seed", "width", "[textures.a]\n", "{ texture = \"a\" }", "[[0, 1], [1, 0]]", "\"uv\"", "k_e", "shininess", "f0",
    "eta", "k", "roughness", "distribution", "transmission", "dialect", "center", "point",
    "normal", "points", "normals", "uv", "min", "max", "from", "to", "radius_to", "axis", "tube",
    "file", "smooth", "material", "group", "scale", "rotate", "translate", "matrix", "background",
    "size", "fov", "\"point\"", "\"distant\"", "\"spot\"", "\"orthographic\"", "\"phong\"",
    "\"lambert\"", "\"cook-torrance\"", "\"ward\"", "\"mtl\"", "\"blinn\"", "\"a.toml\"",
    "\"b.toml\"", "\"c.ply\"", "center = [0, 0, 0]\n", "radius = 1\n", "material = \"a\"\n",
    "group = \"a\"\n", "group = \"b\"\n", "file = \"b.toml\"\n", "file = \"c.ply\"\n",
];

const TRIANGLE: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n\
    property float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\n\
    end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

fuzz_target!(|data: &[u8]| {
    let half = data.len() / 2;
    let source = Memory::new()
        .with("a.toml", spell(&data[..half]))
        .with("b.toml", spell(&data[half..]))
        .with("c.ply", TRIANGLE.as_bytes());
    let limits = Limits { nesting: 4, ..Limits::default() };
    check(&read("a.toml", None, &source, &limits));
});

/// Bytes as they are, or as words.
fn spell(data: &[u8]) -> Vec<u8> {
    match data.split_first() {
        Some((first, rest)) if first % 8 == 0 => rest.to_vec(),
        Some((_, rest)) => {
            rest.iter().flat_map(|&b| WORDS[usize::from(b) % WORDS.len()].bytes()).collect()
        }
        None => Vec::new(),
    }
}

/// A scene exactly if there is no error, and everything said is said of a place.
fn check(reading: &Reading) {
    let error = reading.diagnostics.iter().any(|d| d.is_error());
    assert_eq!(reading.scene.is_none(), error, "{:?}", reading.diagnostics);
    for diagnostic in &reading.diagnostics {
        let span = diagnostic.span.as_ref().expect("a place");
        // Panics unless within the excerpt and on character boundaries.
        let _ = &span.excerpt[span.range.clone()];
    }
}
