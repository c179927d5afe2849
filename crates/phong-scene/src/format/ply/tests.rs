//! What the files in `tests/ply/` cannot show: sizes, threads, and limits.

use glam::Vec3;
use proptest::prelude::*;

use super::*;
use crate::color::Rgb;
use crate::format::export::PlyEncoding;
use crate::limits::Limits;
use crate::mesh::{Cylinders, Field, Mesh, Points};
use crate::source::Memory;

fn model(bytes: &[u8], limits: &Limits, radius: Option<f32>) -> (Option<Shape>, String) {
    let source = Memory::new().with("a.ply", bytes);
    let mut out = Vec::new();
    let model = read(&Input { radius, ..Input::new("a.ply", &source, limits) }, &mut out);
    let told: Vec<_> = out.iter().map(ToString::to_string).collect();
    (model.map(|mut model| model.objects.remove(0).shape), told.join("\n"))
}

fn mesh(bytes: &[u8]) -> Mesh {
    match model(bytes, &Limits::default(), None) {
        (Some(Shape::Mesh(mesh)), _) => *mesh,
        other => panic!("{other:?}"),
    }
}

fn points(bytes: &[u8], radius: Option<f32>) -> Points {
    match model(bytes, &Limits::default(), radius) {
        (Some(Shape::Points(points)), _) => *points,
        other => panic!("{other:?}"),
    }
}

fn told(bytes: &[u8]) -> String {
    model(bytes, &Limits::default(), None).1
}

/// A file whose header says `format` and `elements`.
fn file(format: &str, elements: &str, body: &[u8]) -> Vec<u8> {
    let header = format!("ply\nformat {format} 1.0\n{elements}\nend_header\n");
    [header.as_bytes(), body].concat()
}

const LITTLE: &str = "binary_little_endian";

fn floats(values: impl IntoIterator<Item = f32>) -> Vec<u8> {
    values.into_iter().flat_map(f32::to_le_bytes).collect()
}

#[test]
fn many_points_are_the_same_for_any_number_of_threads() {
    let elements = "element vertex 100000\nproperty float x\nproperty float y\nproperty float z\n\
        property float radius\nproperty uchar red\nproperty uchar green\nproperty uchar blue";
    let mut body = Vec::new();
    for i in 0..100_000_u32 {
        body.extend(floats([i as f32, 0.5, -1.0, 1.0 + i as f32]));
        body.extend([(i % 256) as u8, 0, 255]);
    }
    let bytes = file(LITTLE, elements, &body);
    let all = points(&bytes, Some(9.0));
    assert_eq!(all.spheres[77_777], [77_777.0, 0.5, -1.0, 77_778.0]);
    assert_eq!(all.colors[300], Rgb::from_srgb8([44, 0, 255]));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let alone = pool.install(|| points(&bytes, None));
    assert!(all.spheres == alone.spheres && all.colors == alone.colors);
}

#[test]
fn a_bad_vertex_among_many_is_found_by_its_number() {
    let elements = "element vertex 50000\nproperty float x\nproperty float y\nproperty float z";
    let mut values: Vec<_> = (0..150_000).map(|i| i as f32).collect();
    values[3 * 43_210 + 1] = f32::NAN;
    let told = told(&file(LITTLE, elements, &floats(values)));
    assert_eq!(
        told,
        "a.ply: warning: vertex 43210 (counted from 0): its `y` is NaN; it is left out"
    );
}

#[test]
fn faces_of_one_length_and_of_many_give_the_same_triangles() {
    let face = |corners: &[u32]| {
        let mut row = vec![corners.len() as u8];
        row.extend(corners.iter().flat_map(|i| i.to_le_bytes()));
        row
    };
    let vertices = "element vertex 30000\nproperty float x\nproperty float y\nproperty float z\n";
    let positions =
        floats((0..30_000).flat_map(|i| [(i / 3) as f32, (i % 3) as f32, (i * i % 7) as f32]));
    let triangles: Vec<_> = (0..9_999_u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let list = "property list uchar int vertex_indices";
    let mut body = positions.clone();
    for triangle in &triangles {
        body.extend(face(triangle));
    }
    let uniform = mesh(&file(LITTLE, &format!("{vertices}element face 9999\n{list}"), &body));
    assert!(uniform.indices == triangles);
    // One quad at the end: nothing of what was read before may be kept twice.
    body.extend(face(&[0, 3, 4, 1]));
    let mixed = mesh(&file(LITTLE, &format!("{vertices}element face 10000\n{list}"), &body));
    assert!(mixed.indices[..9_999] == triangles[..]);
    assert_eq!(mixed.indices.len(), 10_001);
}

/// Triangles with texture coordinates and a colour each, with quads at these places among them, and what `bad`
/// says of a row's first vertex.
fn dressed(count: usize, quads: &[usize], bad: impl Fn(usize) -> Option<u32>) -> Vec<u8> {
    let elements = format!(
        "element vertex 30000\nproperty float x\nproperty float y\nproperty float z\nelement face {}\n\
         property uchar flags\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\n\
         property uchar red\nproperty uchar green\nproperty uchar blue",
        count + quads.len()
    );
    let mut body =
        floats((0..30_000).flat_map(|i| [(i / 3) as f32, (i % 3) as f32, (i * i % 7) as f32]));
    let mut row = |corners: &[u32], i: usize| {
        body.extend([9, corners.len() as u8]);
        body.extend(corners.iter().flat_map(|i| i.to_le_bytes()));
        body.push(2 * corners.len() as u8);
        body.extend(floats((0..2 * corners.len()).map(|k| (i + k) as f32)));
        body.extend([i as u8, (i / 256) as u8, 7]);
    };
    for i in 0..count {
        if quads.contains(&i) {
            row(&[0, 3, 4, 1], 0);
        }
        let first = 3 * i as u32;
        row(&[bad(i).unwrap_or(first), first + 1, first + 2], i);
    }
    if quads.contains(&count) {
        row(&[0, 3, 4, 1], 0);
    }
    file(LITTLE, &elements, &body)
}

#[test]
fn faces_with_more_than_corners_are_the_same_whether_their_rows_are_regular_or_not() {
    let corners = |mesh: &Mesh, triangles: std::ops::Range<usize>| -> Vec<_> {
        let corner = |t: usize, k: usize| {
            let [at, uv] = [mesh.indices[t][k], mesh.uv_indices[t][k]].map(|i| i as usize);
            (mesh.positions[at], mesh.uvs[uv], mesh.colors[at])
        };
        triangles.flat_map(|t| [0, 1, 2].map(|k| corner(t, k))).collect()
    };
    let count = 9_999;
    let regular = mesh(&dressed(count, &[], |_| None));
    let expected = corners(&regular, 0..count);
    assert_eq!(expected[3 * 9_000 + 1].1, glam::Vec2::new(9_002.0, 9_003.0));
    // A quad in front: all are walked. One later: those behind it.
    let walked = mesh(&dressed(count, &[0], |_| None));
    assert!(corners(&walked, 2..count + 2) == expected);
    for at in [7_000, count] {
        let mixed = mesh(&dressed(count, &[at], |_| None));
        assert!(corners(&mixed, 0..at) == expected[..3 * at]);
        assert!(corners(&mixed, at + 2..count + 2) == expected[3 * at..]);
    }
    let bad = |i: usize| (i == 8_000).then_some(70_000);
    let said = told(&dressed(count, &[], bad));
    assert!(said.contains("face 8000") && said.contains("70000"), "{said}");
    assert_eq!(said.replace("8000", "8001"), told(&dressed(count, &[0], bad)));
    let lenient = Limits { lenient: true, ..Limits::default() };
    let whole = dressed(count, &[], bad);
    for bytes in [&whole[..], &whole[..whole.len() - 5]] {
        let (regular, said) = model(bytes, &lenient, None);
        let Some(Shape::Mesh(regular)) = regular else { panic!("{said}") };
        let (left, behind) = (regular.indices.len(), usize::from(bytes.len() == whole.len()));
        assert_eq!(left, count - 2 + behind);
        assert!(corners(&regular, 8_000..left)[..] == expected[3 * 8_001..3 * (left + 1)]);
    }
}

#[test]
fn going_over_a_limit_is_an_error_before_anything_is_allocated() {
    let elements = "element vertex 1000\nproperty float x\nproperty float y\nproperty float z";
    let bytes = file(LITTLE, elements, &floats(vec![1.0; 3000]));
    let told = |limits| model(&bytes, &limits, None).1;
    assert_eq!(
        told(Limits { bytes: 15_999, ..Limits::default() }),
        "a.ply: error: the model takes 16000 bytes of memory or more; 15999 are allowed"
    );
    assert_eq!(
        told(Limits { vertices: 999, ..Limits::default() }),
        "a.ply: error: the model has 1000 vertices, more than the 999 allowed"
    );
}

#[test]
fn a_count_that_no_file_can_hold_is_refused() {
    for format in ["ascii", LITTLE] {
        let elements =
            "element vertex 4000000000000000\nproperty float x\nproperty float y\nproperty float z";
        let told = told(&file(format, elements, b"0 0 0\n"));
        assert!(told.contains("the file has room for"), "{told}");
        let elements = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
            element face 1\nproperty list uint int vertex_indices";
        let body = [floats([0.0; 9]), u32::MAX.to_le_bytes().to_vec()].concat();
        if format == LITTLE {
            let told = self::told(&file(format, elements, &body));
            assert_eq!(told, "a.ply: error: the file ends after 0 of 1 rows of the element `face`");
        }
    }
}

#[test]
fn doubles_far_from_the_origin_keep_their_detail() {
    let elements = "element vertex 3\nproperty double x\nproperty double y\nproperty double z";
    let values = [5e6, 1.0, 2.0, 5e6 + 1e-3, 1.5, 2.0, 5e6 + 3.0, 1.0, 2.0_f64];
    let body: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
    let cloud = points(&file(LITTLE, elements, &body), None);
    let x = cloud.origin.x + f64::from(cloud.spheres[1][0]);
    assert!((x - 5_000_000.001).abs() < 1e-9, "{x}");
    assert_eq!((cloud.origin.y, cloud.origin.z), (0.0, 0.0));
}

#[test]
fn the_radius_comes_from_the_file_else_from_the_caller_else_from_the_spacing() {
    let xyz = "element vertex 3\nproperty float x\nproperty float y\nproperty float z";
    let plain = file("ascii", xyz, b"0 0 0\n4 0 0\n8 0 0\n");
    assert_eq!(points(&plain, Some(0.5)).spheres[1], [4.0, 0.0, 0.0, 0.5]);
    assert_eq!(points(&plain, None).spheres[1], [4.0, 0.0, 0.0, 2.0]);
    let own = file("ascii", &format!("{xyz}\nproperty float radius"), b"0 0 0 1\n4 0 0 2\n8 0 0 3");
    assert_eq!(points(&own, Some(0.5)).spheres[2][3], 3.0);
}

/// The same mesh in any of the three formats; `wide` adds what is to be skipped, and doubles.
fn write(format: &str, mesh: &Mesh, wide: bool) -> Vec<u8> {
    let number = if wide { "double" } else { "float" };
    let odd = if wide {
        "element odd 2\nproperty list ushort short stuff\nproperty char c\n"
    } else {
        ""
    };
    let flags = if wide { "property list uchar float weights\n" } else { "" };
    let elements = format!(
        "comment \nobj_info x\n{odd}element vertex {}\nproperty {number} z\nproperty {number} x\n\
         property {number} y\n{flags}element face {}\nproperty list uchar uint vertex_index",
        mesh.positions.len(),
        mesh.indices.len()
    );
    let mut body = Vec::new();
    let mut put = |little: &[u8], text: String, end: bool| match format {
        "ascii" => body.extend((text + if end { "\n" } else { " " }).into_bytes()),
        LITTLE => body.extend(little),
        _ => body.extend(little.iter().rev()),
    };
    if wide {
        for i in 0..2_u8 {
            put(&[i, 0], i.to_string(), false);
            if i == 1 {
                put(&[7, 1], "263".to_owned(), false);
            }
            put(&[9], "9".to_owned(), true);
        }
    }
    for p in &mesh.positions {
        for (i, v) in [p.z, p.x, p.y].into_iter().enumerate() {
            let (last, text) = (i == 2 && !wide, format!("{v:?}"));
            if wide {
                put(&f64::from(v).to_le_bytes(), text, last);
            } else {
                put(&v.to_le_bytes(), text, last);
            }
        }
        if wide {
            put(&[1], "1".to_owned(), false);
            put(&0.5_f32.to_le_bytes(), "0.5".to_owned(), true);
        }
    }
    for t in &mesh.indices {
        put(&[3], "3".to_owned(), false);
        for (i, v) in t.iter().enumerate() {
            put(&v.to_le_bytes(), v.to_string(), i == 2);
        }
    }
    file(format, &elements, &body)
}

proptest! {
    #[test]
    fn a_mesh_reads_back_to_the_bit_from_every_format(
        positions in prop::collection::vec(prop::array::uniform3(-1e6..1e6_f32), 3..40),
        picks in prop::collection::vec((0..1000_u32, 1..1000_u32, 1..1000_u32), 1..60),
        wide: bool,
    ) {
        let n = positions.len() as u32;
        // Three different vertices.
        let indices = picks.iter().map(|&(a, b, c)| {
            let first = a % n;
            let second = (first + 1 + b % (n - 1)) % n;
            let third = (0..n).map(|i| (c + i) % n).find(|i| *i != first && *i != second);
            [first, second, third.unwrap()]
        }).collect();
        let original = Mesh { positions: positions.into_iter().map(Vec3::from).collect(), indices, ..Mesh::default() };
        for format in ["ascii", LITTLE, "binary_big_endian"] {
            let read = mesh(&write(format, &original, wide));
            prop_assert_eq!(&read.positions, &original.positions);
            prop_assert_eq!(&read.indices, &original.indices);
        }
    }

    #[test]
    fn a_file_cut_anywhere_is_an_error(cut in 0.0..1.0_f64, wide: bool, which in 0..2_usize) {
        let original = Mesh {
            positions: [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z].into(),
            indices: [[0, 1, 2], [2, 1, 3]].into(),
            ..Mesh::default()
        };
        let whole = write([LITTLE, "binary_big_endian"][which], &original, wide);
        let cut = (cut * whole.len() as f64) as usize;
        let (part, told) = model(&whole[..cut], &Limits::default(), None);
        prop_assert!(part.is_none() && told.contains("error"), "{}", told);
    }
}

#[test]
fn what_is_written_reads_back_to_the_bit() {
    let mesh = Mesh {
        origin: glam::DVec3::new(5e6, 0.0, 0.0),
        positions: [Vec3::ZERO, Vec3::X, Vec3::new(0.1, 1e-7, 0.0), Vec3::Z].into(),
        indices: [[0, 1, 2], [0, 2, 3]].into(),
        normals: [Vec3::Z, Vec3::X].into(),
        normal_indices: [[0, 0, 0], [1, 0, crate::mesh::NO_INDEX]].into(),
        colors: [0.1, 0.5, 2.0, 0.0].map(Rgb::grey).into(),
        ..Mesh::default()
    };
    let corner = |m: &Mesh, face: usize, corner: usize| {
        let at = m.indices[face][corner] as usize;
        let numbers = if m.normal_indices.is_empty() { &m.indices } else { &m.normal_indices };
        let normal = m.normals.get(numbers[face][corner] as usize);
        (m.origin + m.positions[at].as_dvec3(), normal.copied(), m.colors[at])
    };
    for encoding in [PlyEncoding::Ascii, PlyEncoding::Binary] {
        let mut file = Vec::new();
        mesh.write_ply(encoding, &mut file).unwrap();
        let read = self::mesh(&file);
        // Vertex 0 has two normals.
        assert_eq!((read.positions.len(), read.indices.len()), (5, 2));
        for (face, i) in [(0, 0), (0, 1), (0, 2), (1, 0), (1, 1), (1, 2)] {
            assert_eq!(corner(&read, face, i), corner(&mesh, face, i));
        }
        let cloud = Points {
            origin: glam::DVec3::ZERO,
            spheres: [[0.1, -2.0, 3e9, 0.5], [1.0, 2.0, 3.0, 1e-9]].into(),
            colors: [Rgb::new(0.25, 1.0, 7.5), Rgb::BLACK].into(),
            ..Points::default()
        };
        let mut file = Vec::new();
        cloud.write_ply(encoding, &mut file).unwrap();
        let read = points(&file, None);
        assert_eq!((read.spheres, read.colors), (cloud.spheres, cloud.colors));
        for radius_to in [0.5, 0.25] {
            let bonds = Cylinders {
                segments: [
                    [[0.1, 0.0, 0.0, 0.5], [1.0, 0.0, 0.0, radius_to]],
                    [[1.0, 0.0, 0.0, 0.125], [0.1, 0.0, 0.0, 0.125]],
                ]
                .into(),
                colors: [[Rgb::BLACK, Rgb::WHITE], [Rgb::WHITE, Rgb::grey(0.1)]].into(),
                ..Cylinders::default()
            };
            let mut file = Vec::new();
            bonds.write_ply(encoding, &mut file).unwrap();
            let Some(Shape::Cylinders(read)) = model(&file, &Limits::default(), None).0 else {
                panic!("no cylinders")
            };
            assert_eq!((read.segments, read.colors), (bonds.segments, bonds.colors));
        }
    }
}

/// The shape of a file of which maps show these properties.
fn shown(bytes: &[u8], fields: &[&str]) -> Shape {
    let source = Memory::new().with("a.ply", bytes);
    let fields: Vec<_> = fields.iter().map(|name| (*name).to_owned()).collect();
    let limits = Limits::default();
    let input = Input { fields: &fields, ..Input::new("a.ply", &source, &limits) };
    let mut out = Vec::new();
    read(&input, &mut out).unwrap_or_else(|| panic!("{out:?}")).objects.remove(0).shape
}

#[test]
fn what_maps_show_is_read_with_the_points_and_written_again() {
    let elements = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
        property float T\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n";
    let points = b"0 0 0 1.5 9 0 0\n1 0 0 nan 8 0 0\nnan 1 0 2.5 7 0 0\n0 1 1 -3 6 0 0\n";
    let ascii = file("ascii", &format!("{elements}element face 0"), points);
    let Shape::Points(cloud) = shown(&ascii, &["T", "absent", "red"]) else { panic!("no points") };
    let names: Vec<_> = cloud.fields.iter().map(|field| &*field.name).collect();
    assert_eq!(names, ["T", "red"]);
    // The third point has no place.
    let bits = |field: &Field| field.values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&cloud.fields[0]), [1.5, f32::NAN, -3.0].map(f32::to_bits));
    assert_eq!(cloud.fields[1].values, [9.0, 8.0, 6.0]);
    for encoding in [PlyEncoding::Ascii, PlyEncoding::Binary] {
        let mut written = Vec::new();
        cloud.write_ply(encoding, &mut written).unwrap();
        let Shape::Points(again) = shown(&written, &["T", "red"]) else { panic!("no points") };
        assert_eq!(bits(&again.fields[0]), bits(&cloud.fields[0]));
        assert_eq!(again.fields[1], cloud.fields[1]);
        let positions = [Vec3::ZERO, Vec3::X, Vec3::Y].into();
        let fields = vec![Field { name: "u".into(), values: [1.0, f32::NAN, 0.1].into() }];
        let mesh = Mesh { positions, indices: [[0, 1, 2]].into(), fields, ..Mesh::default() };
        let mut written = Vec::new();
        mesh.write_ply(encoding, &mut written).unwrap();
        let Shape::Mesh(again) = shown(&written, &["u"]) else { panic!("no mesh") };
        assert_eq!(bits(&again.fields[0]), bits(&mesh.fields[0]));
        let ends = [[[0.0, 0.0, 0.0, 0.5], [1.0, 0.0, 0.0, 0.5]]; 2];
        let fields = vec![Field { name: "q".into(), values: [1.0, 2.0, 3.0, 2.0].into() }];
        let bonds = Cylinders { segments: ends.into(), fields, ..Cylinders::default() };
        let mut written = Vec::new();
        bonds.write_ply(encoding, &mut written).unwrap();
        let Shape::Cylinders(again) = shown(&written, &["q"]) else { panic!("no cylinders") };
        assert_eq!(again.fields, bonds.fields);
    }
}

/// Points in a row, and 60,000 edges from each to the next; their radii are their numbers and 1.
fn edges(change: impl Fn(usize) -> Option<[u32; 2]>) -> Vec<u8> {
    let elements = "element vertex 60001\nproperty float x\nproperty float y\nproperty float z\n\
        element edge 60000\nproperty int vertex1\nproperty int vertex2\nproperty float radius";
    let mut body = floats((0..60_001).flat_map(|i| [i as f32, 0.0, 0.0]));
    for i in 0..60_000_u32 {
        for end in change(i as usize).unwrap_or([i, i + 1]) {
            body.extend(end.to_le_bytes());
        }
        body.extend((1.0 + i as f32).to_le_bytes());
    }
    file(LITTLE, elements, &body)
}

#[test]
fn edges_of_many_blocks_stay_in_order_and_a_bad_one_is_told_by_its_number() {
    let Some(Shape::Cylinders(all)) = model(&edges(|_| None), &Limits::default(), None).0 else {
        panic!("no cylinders");
    };
    assert_eq!(all.segments.len(), 60_000);
    for (i, ends) in all.segments.iter().enumerate() {
        let [x, radius] = [i as f32, 1.0 + i as f32];
        assert_eq!(*ends, [[x, 0.0, 0.0, radius], [x + 1.0, 0.0, 0.0, radius]]);
    }
    let told = told(&edges(|i| (i == 50_000).then_some([0, 70_000])));
    assert!(told.contains("edge 50000") && told.contains("70000"), "{told}");
}

#[test]
fn an_edge_whose_vertex_was_left_out_takes_only_itself_away() {
    let mut bytes = edges(|_| None);
    let place = bytes.windows(11).position(|part| part == b"end_header\n").unwrap() + 11;
    // The second point has no place.
    bytes[place + 12..][..4].copy_from_slice(&f32::NAN.to_le_bytes());
    let (model, told) = model(&bytes, &Limits::default(), None);
    let Some(Shape::Cylinders(left)) = model else { panic!("{told}") };
    assert_eq!(left.segments.len(), 59_998);
    assert_eq!(left.segments[0][0], [2.0, 0.0, 0.0, 3.0]);
    assert!(told.contains("a vertex is left out: 2"), "{told}");
}
