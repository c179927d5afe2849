//! What the files in `tests/obj/` cannot show: pieces, threads, and limits.

use proptest::prelude::*;

use glam::DVec3;

use super::*;
use crate::limits::Limits;
use crate::mesh::Mesh;
use crate::shape::Shape;
use crate::source::Memory;

fn read(files: &[(&str, &[u8])], limits: &Limits) -> (Option<(Mesh, usize)>, String) {
    let source = files.iter().fold(Memory::new(), |m, (path, bytes)| m.with(*path, *bytes));
    let mut out = Vec::new();
    let model = super::read(&Input::new(files[0].0, &source, limits), &mut out);
    let told: Vec<_> = out.iter().map(ToString::to_string).collect();
    let mesh = model.map(|mut model| match model.objects.remove(0).shape {
        Shape::Mesh(mesh) => (*mesh, model.materials.len()),
        other => panic!("an OBJ file holds a mesh: {other:?}"),
    });
    (mesh, told.join("\n"))
}

fn mesh(text: &str) -> Mesh {
    let (mesh, told) = read(&[("a.obj", text.as_bytes())], &Limits::default());
    mesh.unwrap_or_else(|| panic!("{told}")).0
}

/// A strip of `n` squares, its indices counted from the beginning or backwards.
fn strip(n: usize, backwards: bool) -> String {
    let mut text = String::from("v 0 0 0\nv 0 1 0.5\n");
    for i in 1..=n {
        let count = 2 * i + 2;
        text += &["v ", &i.to_string(), " 0 0\nv ", &i.to_string(), ".0e0 1 .5\n"].concat();
        let corners = [count - 3, count - 1, count, count - 2].map(|corner| {
            if backwards { format!(" -{}", count + 1 - corner) } else { format!(" {corner}") }
        });
        text += &["f", &corners.concat(), "\n"].concat();
    }
    text
}

#[test]
fn a_file_of_many_pieces_is_the_same_for_any_number_of_threads() {
    let text = strip(60_000, false);
    assert!(text.len() > 2 << 20, "{}", text.len());
    let expected = mesh(&text);
    assert_eq!((expected.positions.len(), expected.indices.len()), (120_002, 120_000));
    let relative = mesh(&strip(60_000, true));
    assert!(expected.indices == relative.indices && expected.positions == relative.positions);
    for threads in [1, 3] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let other = pool.install(|| mesh(&text));
        assert!(expected.indices == other.indices && expected.positions == other.positions);
    }
}

#[test]
fn an_index_out_of_range_is_told_with_its_line_in_a_file_of_many_pieces() {
    let mut text = strip(60_000, true);
    let lines = text.lines().count();
    text += "f 1 -9999999 3\nf 120003 1 2\n";
    let (none, told) = read(&[("a.obj", text.as_bytes())], &Limits::default());
    assert!(none.is_none());
    let expected = format!(
        "a.obj:{}:5: error: the face uses position -9999999, but there are 120002 before it\n\
         a.obj:{}:3: error: the face uses position 120003, but there are 120002 in the file",
        lines + 1,
        lines + 2,
    );
    assert_eq!(told, expected);
}

#[test]
fn going_over_a_limit_is_an_error_that_names_it() {
    let text = strip(1000, false);
    let told = |limits: &Limits| read(&[("a.obj", text.as_bytes())], limits).1;
    let (bytes, vertices, triangles) = (10_000, 100, 100);
    assert_eq!(
        told(&Limits { bytes, ..Limits::default() }),
        "a.obj: error: the model takes more than 10000 bytes of memory"
    );
    assert_eq!(
        told(&Limits { vertices, ..Limits::default() }),
        "a.obj: error: the model has more than 100 vertices"
    );
    assert_eq!(
        told(&Limits { triangles, ..Limits::default() }),
        "a.obj: error: the model has more than 100 triangles"
    );
}

#[test]
fn data_far_from_the_origin_keep_their_detail() {
    let text = "v 4500000.0001 0 0\nv 4500001.0002 0 0\nv 4500000 1 0.5\nf 1 2 3\n";
    let mesh = mesh(text);
    let x = mesh.origin.x + f64::from(mesh.positions[1].x);
    assert!((x - 4_500_001.000_2).abs() < 1e-6, "{x}");
    assert_eq!((mesh.origin.y, mesh.origin.z), (0.0, 0.0));
}

#[test]
fn a_missing_file_says_so() {
    let mut out = Vec::new();
    let (files, limits) = (Memory::new(), Limits::default());
    assert!(super::read(&Input::new("b.obj", &files, &limits), &mut out).is_none());
    assert_eq!(out[0].to_string(), "b.obj: error: cannot be read: there is no such file");
}

proptest! {
    #[test]
    fn a_mesh_reads_back_to_the_bit_however_its_faces_count(
        positions in prop::collection::vec(prop::array::uniform3(-1e6..1e6_f32), 3..40),
        picks in prop::collection::vec((0..1000_u32, 1..1000_u32, 1..1000_u32, any::<[bool; 3]>()), 1..60),
        late: bool,
    ) {
        let n = positions.len() as u32;
        let mut faces = String::new();
        let mut indices = Vec::new();
        for &(a, b, c, backwards) in &picks {
            // Three different vertices.
            let first = a % n;
            let second = (first + 1 + b % (n - 1)) % n;
            let third = (0..n).map(|i| (c + i) % n).find(|i| *i != first && *i != second).unwrap();
            indices.push([first, second, third]);
            let corner = |i: usize| {
                let index = indices.last().unwrap()[i];
                // Counted backwards only where all vertices come before.
                if backwards[i] && !late { format!(" -{}", n - index) } else { format!(" {}", index + 1) }
            };
            faces += &["f", &corner(0), &corner(1), &corner(2), "\n"].concat();
        }
        let vertices: String = positions.iter().flat_map(|[x, y, z]| {
            ["v ".to_owned(), x.to_string(), format!(" {y:e} "), format!("{z:?}"), "\n".to_owned()]
        }).collect();
        let read = mesh(&if late { faces + &vertices } else { vertices + &faces });
        prop_assert_eq!(read.origin, DVec3::ZERO);
        let expected: Vec<_> = positions.into_iter().map(glam::Vec3::from).collect();
        prop_assert_eq!(read.positions, expected);
        prop_assert_eq!(read.indices, indices);
    }
}

#[test]
fn what_is_written_reads_back_to_the_bit() {
    let text = "mtllib a.mtl\nv 4500000.125 0.1 0 1 0.5 0.25\nv 4500001 0 0 0 0 0\n\
        v 4500000 1e-7 1.5 0.1 0.2 0.3\nvt 0.1 0.2\nvt 1 0\nvn 0 0 2\nvn 0.6 0.8 0\n\
        usemtl red\nf 1/1/1 2/2/1 3\nusemtl blue\nf 3//2 2/2 1\n";
    let library = "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n";
    let files =
        |text: &str| Memory::new().with("a.obj", text.as_bytes()).with("a.mtl", library.as_bytes());
    let read = |text: &str| {
        let (files, limits) = (files(text), Limits::default());
        let input = Input::new("a.obj", &files, &limits);
        let model = super::read(&input, &mut Vec::new()).unwrap();
        (format!("{:?}", model.objects), model)
    };
    let (first, model) = read(text);
    let Shape::Mesh(mesh) = &model.objects[0].shape else { panic!("{first}") };
    let mut file = b"mtllib a.mtl\n".to_vec();
    mesh.write_obj(&model.materials, &mut file).unwrap();
    let (second, _) = read(str::from_utf8(&file).unwrap());
    assert_eq!(first, second);
}
