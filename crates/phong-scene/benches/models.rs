//! How fast model files are read, beside `tobj` on the same OBJ text.
//!
//! `cargo bench -p phong-scene --bench models`. The throughput is that of the file's bytes. The
//! meshes bring normals, so that no time goes into making some. The clock is the wall's: with
//! more than one core free, ours uses them all and `tobj` one.

use std::fmt::Write as _;

use divan::Bencher;
use divan::counter::BytesCount;
use phong_scene::{Limits, Memory, read};

fn main() {
    divan::main();
}

/// Waves on a square grid: this many vertices along each side.
const SIDE: usize = 512;

fn height(x: usize, y: usize) -> f64 {
    libm::sin(x as f64 * 0.05) * libm::cos(y as f64 * 0.03)
}

fn grid() -> impl Iterator<Item = [f64; 3]> {
    (0..SIDE * SIDE)
        .map(|i| (i % SIDE, i / SIDE))
        .map(|(x, y)| [x as f64 / SIDE as f64, height(x, y), y as f64 / SIDE as f64])
}

fn triangles() -> impl Iterator<Item = [usize; 3]> {
    let cells = (0..SIDE - 1).flat_map(|y| (0..SIDE - 1).map(move |x| y * SIDE + x));
    cells.flat_map(|at| [[at, at + SIDE, at + 1], [at + 1, at + SIDE, at + SIDE + 1]])
}

/// A file of `v`, `vn` and `f v//vn` lines, as exporters write it.
fn obj() -> Vec<u8> {
    let mut text = String::new();
    let line = |text: std::fmt::Arguments<'_>, to: &mut String| {
        // Writing to a string does not fail.
        let _ = writeln!(to, "{text}");
    };
    for [x, y, z] in grid() {
        line(format_args!("v {x:.6} {y:.6} {z:.6}"), &mut text);
    }
    for [x, y, z] in grid() {
        line(format_args!("vn {x:.4} {y:.4} {z:.4}"), &mut text);
    }
    for [a, b, c] in triangles().map(|t| t.map(|i| i + 1)) {
        line(format_args!("f {a}//{a} {b}//{b} {c}//{c}"), &mut text);
    }
    text.into_bytes()
}

#[divan::bench(sample_count = 20)]
fn obj_by_us(bencher: Bencher<'_, '_>) {
    let text = obj();
    let size = BytesCount::new(text.len());
    let source = Memory::new().with("a.obj", text);
    bencher.counter(size).bench_local(|| read("a.obj", None, &source, &Limits::default()));
}

#[divan::bench(sample_count = 20)]
fn obj_by_tobj(bencher: Bencher<'_, '_>) {
    let text = obj();
    bencher.counter(BytesCount::new(text.len())).bench_local(|| {
        let no_materials = |_: &std::path::Path| Ok(Default::default());
        tobj::load_obj_buf(&mut text.as_slice(), &tobj::LoadOptions::default(), no_materials)
    });
}

#[divan::bench(sample_count = 20)]
fn ply_mesh(bencher: Bencher<'_, '_>) {
    let mut file = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\n\
         property float y\nproperty float z\nproperty float nx\nproperty float ny\n\
         property float nz\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
        SIDE * SIDE,
        triangles().count(),
    )
    .into_bytes();
    for p in grid() {
        file.extend(p.iter().chain(&p).flat_map(|c| (*c as f32).to_le_bytes()));
    }
    for t in triangles() {
        file.push(3);
        file.extend(t.iter().flat_map(|i| (*i as u32).to_le_bytes()));
    }
    let size = BytesCount::new(file.len());
    let source = Memory::new().with("a.ply", file);
    bencher.counter(size).bench_local(|| read("a.ply", None, &source, &Limits::default()));
}

/// A million points of 28 bytes: position, colour, radius.
#[divan::bench(sample_count = 20)]
fn ply_points(bencher: Bencher<'_, '_>) {
    let names = ["x", "y", "z", "red", "green", "blue", "radius"];
    let mut file = b"ply\nformat binary_little_endian 1.0\nelement vertex 1000000\n".to_vec();
    file.extend(names.iter().flat_map(|name| format!("property float {name}\n").into_bytes()));
    file.extend(b"end_header\n");
    for i in 0..1_000_000_u32 {
        file.extend((1..8).flat_map(|k| ((i * k % 1024) as f32 + 0.5).to_le_bytes()));
    }
    let size = BytesCount::new(file.len());
    let source = Memory::new().with("a.ply", file);
    bencher.counter(size).bench_local(|| read("a.ply", None, &source, &Limits::default()));
}

/// Half a million facets, of which each corner stands six times. A scene that says `smooth = false`
/// reads them alone: making normals would take longer.
#[divan::bench(sample_count = 20)]
fn stl_mesh(bencher: Bencher<'_, '_>) {
    let place = |i: usize| [i % SIDE, 0, i / SIDE].map(|c| c as f32);
    let mut file = [&[b' '; 80][..], &(triangles().count() as u32).to_le_bytes()].concat();
    for triangle in triangles() {
        let corners = triangle.into_iter().flat_map(place);
        file.extend([0.0, 1.0, 0.0].into_iter().chain(corners).flat_map(f32::to_le_bytes));
        file.extend([0, 0]);
    }
    let size = BytesCount::new(file.len());
    let scene = b"version = 1\n[camera]\neye = [0, 9, 0]\nlook_at = [1, 0, 1]\n\
                  [[mesh]]\nfile = \"a.stl\"\nsmooth = false\n";
    let source = Memory::new().with("a.stl", file).with("a.toml", *scene);
    bencher.counter(size).bench_local(|| read("a.toml", None, &source, &Limits::default()));
}
