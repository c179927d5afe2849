//! STL files that are too large to lie in a folder, read and written.
#![allow(clippy::unwrap_used, reason = "tests")]

use std::io::Write;

use glam::Vec3;
use phong_scene::{ExportOptions, Format, Limits, Memory, Mesh, Reading, Shape, read};

/// A square of waves with so many cells along each side, each of two triangles.
fn waves(side: u32) -> Mesh {
    let place =
        |i: u32| Vec3::new((i % (side + 1)) as f32, (i / (side + 1)) as f32, (i % 7) as f32);
    let cell = |i: u32| {
        let at = i / side * (side + 1) + i % side;
        [[at, at + 1, at + side + 1], [at + 1, at + side + 2, at + side + 1]]
    };
    Mesh {
        positions: (0..(side + 1) * (side + 1)).map(place).collect(),
        indices: (0..side * side).flat_map(cell).collect(),
        ..Mesh::default()
    }
}

fn stl(mesh: &Mesh) -> Vec<u8> {
    let mut file = Vec::new();
    mesh.write_stl(&mut file).unwrap();
    file
}

fn ascii(mesh: &Mesh) -> Vec<u8> {
    let mut text = b"solid waves\n".to_vec();
    for triangle in &mesh.indices {
        write!(text, "facet normal 0 0 0\n outer loop\n").unwrap();
        for p in triangle.map(|i| mesh.positions[i as usize]) {
            writeln!(text, "  vertex {} {} {}", p.x, p.y, p.z).unwrap();
        }
        write!(text, " endloop\nendfacet\n").unwrap();
    }
    [text, b"endsolid waves\n".to_vec()].concat()
}

fn read_with(bytes: &[u8], limits: &Limits) -> Reading {
    read("a.stl", None, &Memory::new().with("a.stl", bytes), limits)
}

fn told(reading: &Reading) -> String {
    reading.diagnostics.iter().map(|d| d.to_string() + "\n").collect()
}

#[track_caller]
fn mesh(reading: Reading) -> Mesh {
    let told = told(&reading);
    let mut scene = reading.scene.unwrap_or_else(|| panic!("{told}"));
    match scene.objects.swap_remove(0).shape {
        Shape::Mesh(mesh) => *mesh,
        other => panic!("{other:?}"),
    }
}

/// The corners of all triangles.
fn corners(mesh: &Mesh) -> Vec<[Vec3; 3]> {
    mesh.indices.iter().map(|t| t.map(|i| mesh.positions[i as usize])).collect()
}

#[test]
fn vertices_are_those_of_first_use_for_any_number_of_threads_and_either_encoding() {
    let waves = waves(200);
    for bytes in [stl(&waves), ascii(&waves)] {
        let read = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| mesh(read_with(&bytes, &Limits::default())))
        };
        let (one, five) = (read(1), read(5));
        assert!(one.positions == five.positions && one.indices == five.indices);
        assert_eq!(one.positions.len(), waves.positions.len());
        assert!(corners(&one) == corners(&waves));
        let mut next = 0;
        for &i in one.indices.iter().flatten() {
            assert!(i <= next, "{i} before {next}");
            next = next.max(i + 1);
        }
    }
}

#[test]
fn facets_that_are_cut_short_are_refused_unless_one_is_lenient() {
    let waves = waves(3);
    let lenient = Limits { lenient: true, ..Limits::default() };
    for (bytes, cut, said) in
        [(stl(&waves), 60, "room for 16 of 18"), (ascii(&waves), 90, "ends within")]
    {
        let bytes = &bytes[..bytes.len() - cut];
        assert!(read_with(bytes, &Limits::default()).scene.is_none());
        let reading = read_with(bytes, &lenient);
        assert!(told(&reading).contains(said), "{}", told(&reading));
        let kept = mesh(reading);
        assert!(corners(&kept) == corners(&waves)[..kept.indices.len()]);
        assert!((16..18).contains(&kept.indices.len()));
    }
}

#[test]
fn a_facet_that_cannot_be_read_as_one_ends_leniently_with_the_file() {
    let text = "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n\
                endloop\nendfacet\nfacet normal 0 0 1\nouter loop\nvertex 1";
    assert!(read_with(text.as_bytes(), &Limits::default()).scene.is_none());
    let reading = read_with(text.as_bytes(), &Limits { lenient: true, ..Limits::default() });
    assert_eq!(told(&reading).lines().count(), 1, "{}", told(&reading));
    assert_eq!(mesh(reading).indices.len(), 1);
}

#[test]
fn limits_hold_before_and_while_a_file_is_read() {
    let waves = waves(120);
    for bytes in [stl(&waves), ascii(&waves)] {
        for (limits, said) in [
            (Limits { triangles: 1000, ..Limits::default() }, "more than 1000 triangles"),
            (Limits { vertices: 1000, ..Limits::default() }, "more than 1000 vertices"),
            (Limits { bytes: 100_000, ..Limits::default() }, "100000 are allowed"),
        ] {
            let reading = read_with(&bytes, &limits);
            assert!(reading.scene.is_none() && told(&reading).contains(said), "{}", told(&reading));
        }
    }
    let mut liar = stl(&waves);
    liar[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
    assert!(told(&read_with(&liar, &Limits::default())).contains("of 4294967295 facets"));
}

#[test]
fn what_is_written_is_read_back_with_its_corners() {
    let waves = waves(5);
    let scene = read_with(&stl(&waves), &Limits::default()).scene.unwrap();
    let options = ExportOptions { format: Format::Stl, bare: true, ..ExportOptions::default() };
    let export = scene.export(&options, "b.stl").unwrap();
    assert_eq!((&export.account.dropped[..], export.account.carried["triangle"]), (&[][..], 50));
    let mut file = Vec::new();
    export.files[0].write(&mut file).unwrap();
    assert!(file == stl(&waves));
}

#[test]
fn what_stl_cannot_hold_is_told_or_refused() {
    let export = |text: &str| {
        let files = Memory::new().with("a.toml", text.as_bytes());
        let scene = read("a.toml", None, &files, &Limits::default()).into_scene().unwrap();
        scene.export(&ExportOptions { format: Format::Stl, ..ExportOptions::default() }, "a.stl")
    };
    let head = "version = 1\n[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\n\
                [materials.red]\ncolor = \"red\"\n";
    let ball = "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\n";
    let triangle = "[[triangle]]\npoints = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\nmaterial = \"red\"\n";
    let error = export(&format!("{head}{ball}")).unwrap_err().to_string();
    assert!(error.contains("STL holds triangles, and the scene has none"), "{error}");
    let account = export(&format!("{head}{ball}{triangle}")).unwrap().account;
    let dropped: String = account.dropped.iter().map(|d| d.to_string() + "\n").collect();
    for said in ["no camera", "1 sphere is left out: `sphere 1`", "STL holds no materials: `red`"] {
        assert!(dropped.contains(said), "{dropped}");
    }
}

#[test]
fn what_a_file_begins_with_says_what_it_is_even_packed_or_named_by_a_scene() {
    let mut packer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    packer.write_all(&ascii(&waves(2))).unwrap();
    let packed = packer.finish().unwrap();
    let scene = b"version = 1\n[camera]\neye = [0, 0, 9]\nlook_at = [0, 0, 0]\n[[mesh]]\nfile = \"a.ply\"\n";
    let files = Memory::new()
        .with("a.ply", ascii(&waves(2)))
        .with("a.obj.gz", packed.clone())
        .with("a.stl.gz", packed)
        .with("b.stl", stl(&waves(2)))
        .with("a.toml", *scene);
    for name in ["a.ply", "a.obj.gz", "a.stl.gz", "b.stl", "a.toml"] {
        assert_eq!(mesh(read(name, None, &files, &Limits::default())).indices.len(), 8, "{name}");
    }
    assert_eq!(Format::of_file("a.obj.gz", &files), Some(Format::Stl));
    let other = read("a.ply", Some(Format::Ply), &files, &Limits::default());
    assert!(other.scene.is_none(), "the format that is given wins");
}
