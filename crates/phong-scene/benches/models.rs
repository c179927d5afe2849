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

/// Half a million triangles with normals in one binary glTF file.
#[divan::bench(sample_count = 20)]
fn glb_mesh(bencher: Bencher<'_, '_>) {
    let vectors: Vec<u8> =
        grid().flat_map(|p| p.map(|c| c as f32)).flat_map(f32::to_le_bytes).collect();
    let indices: Vec<u8> = triangles().flatten().flat_map(|i| (i as u32).to_le_bytes()).collect();
    let (count, corners) = (SIDE * SIDE, indices.len() / 4);
    let (places, length) = (vectors.len(), 2 * vectors.len() + indices.len());
    let mut text = format!(
        "{{\"asset\":{{\"version\":\"2.0\"}},\"meshes\":[{{\"primitives\":[{{\"attributes\":\
         {{\"POSITION\":0,\"NORMAL\":1}},\"indices\":2}}]}}],\"accessors\":[\
         {{\"bufferView\":0,\"componentType\":5126,\"type\":\"VEC3\",\"count\":{count}}},\
         {{\"bufferView\":1,\"componentType\":5126,\"type\":\"VEC3\",\"count\":{count}}},\
         {{\"bufferView\":2,\"componentType\":5125,\"type\":\"SCALAR\",\"count\":{corners}}}],\
         \"bufferViews\":[{{\"buffer\":0,\"byteLength\":{places}}},\
         {{\"buffer\":0,\"byteOffset\":{places},\"byteLength\":{places}}},\
         {{\"buffer\":0,\"byteOffset\":{},\"byteLength\":{}}}],\
         \"buffers\":[{{\"byteLength\":{length}}}]}}",
        2 * places,
        indices.len(),
    );
    while !text.len().is_multiple_of(4) {
        text.push(' ');
    }
    let number = |n: usize| (n as u32).to_le_bytes();
    let head = [number(2), number(28 + text.len() + length), number(text.len())].concat();
    let mut file =
        [&b"glTF"[..], &head, b"JSON", text.as_bytes(), &number(length), b"BIN\0"].concat();
    file.extend([&vectors[..], &vectors[..], &indices[..]].concat());
    let size = BytesCount::new(file.len());
    let source = Memory::new().with("a.glb", file);
    assert!(read("a.glb", None, &source, &Limits::default()).scene.is_some());
    bencher.counter(size).bench_local(|| read("a.glb", None, &source, &Limits::default()));
}

/// A million spheres of four colours, a line each.
#[divan::bench(sample_count = 20)]
fn tachyon_spheres(bencher: Bencher<'_, '_>) {
    let mut text =
        "BEGIN_SCENE\nRESOLUTION 8 6\nCAMERA ZOOM 1 ASPECTRATIO 1 ANTIALIASING 0 RAYDEPTH 4 \
                    CENTER 0 0 -9 VIEWDIR 0 0 1 UPDIR 0 1 0 END_CAMERA\n"
            .to_owned();
    for c in 0..4 {
        let _ = writeln!(
            text,
            "TEXDEF C{c} AMBIENT 0.1 DIFFUSE 0.7 SPECULAR 0 OPACITY 1 PHONG PLASTIC 0.3 PHONG_SIZE 40 \
             COLOR 0.{c} 0.1 0.2 TEXFUNC 0"
        );
    }
    for i in 0..1_000_000_u32 {
        let [x, y, z] = [1, 3, 7].map(|k| f64::from(i * k % 1024) + 0.5);
        let _ = writeln!(text, "SPHERE CENTER {x:.4} {y:.4} {z:.4} RAD 0.45 C{}", i % 4);
    }
    text.push_str("END_SCENE\n");
    let size = BytesCount::new(text.len());
    let source = Memory::new().with("a.dat", text.into_bytes());
    assert!(read("a.dat", None, &source, &Limits::default()).scene.is_some());
    bencher.counter(size).bench_local(|| read("a.dat", None, &source, &Limits::default()));
}

/// A million particles of a LAMMPS dump, a line each.
#[divan::bench(sample_count = 20)]
fn lammps_dump(bencher: Bencher<'_, '_>) {
    let mut text =
        "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1000000\nITEM: BOX BOUNDS pp pp pp\n0 1024\n\
                    0 1024\n0 1024\nITEM: ATOMS id type x y z\n"
            .to_owned();
    for i in 0..1_000_000_u32 {
        let [x, y, z] = [1, 3, 7].map(|k| f64::from(i * k % 1024) + 0.5);
        let _ = writeln!(text, "{} {} {x:.4} {y:.4} {z:.4}", i + 1, i % 4 + 1);
    }
    let size = BytesCount::new(text.len());
    let source = Memory::new().with("a.lammpstrj", text.into_bytes());
    assert!(read("a.lammpstrj", None, &source, &Limits::default()).scene.is_some());
    bencher.counter(size).bench_local(|| read("a.lammpstrj", None, &source, &Limits::default()));
}
