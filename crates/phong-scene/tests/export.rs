//! Scenes as OBJ with MTL and as PLY: what is there, what is told to be missing, what comes back.

use glam::{DAffine3, DVec3, Vec3};
use phong_scene::{
    Caps, Cylinders, Export, ExportOptions, Field, Format, Limits, Memory, Mesh, Object,
    PlyEncoding, Reading, Rgb, Scene, Shape, read,
};

const HEAD: &str = "version = 1\n[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\n\
                    [[light]]\nkind = \"distant\"\ndirection = [0, 0, -1]\n";
const FACE: &str = "[[triangle]]\npoints = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\n";

fn scene(text: &str) -> Scene {
    let text = if text.starts_with("version") { text.to_owned() } else { format!("{HEAD}{text}") };
    let reading = read_in(&Memory::new().with("a.toml", text.into_bytes()), "a.toml");
    reading.scene.unwrap_or_else(|| panic!("{:?}", reading.diagnostics))
}

fn read_in(files: &Memory, path: &str) -> Reading {
    read(path, None, files, &Limits::default())
}

fn export(scene: Scene, format: Format, bare: bool) -> (Memory, Vec<(String, String)>, Export) {
    let options = ExportOptions { format, ply: PlyEncoding::Ascii, bare, ..Default::default() };
    let name = if format == Format::Obj { "b.obj" } else { "b.ply" };
    let export = scene.export(&options, name).expect("something to write");
    let mut files = Memory::new();
    let mut texts = Vec::new();
    for file in &export.files {
        let mut bytes = Vec::new();
        file.write(&mut bytes).expect("memory");
        texts.push((file.name.clone(), String::from_utf8(bytes.clone()).expect("text")));
        files = files.with(file.name.as_str(), bytes);
    }
    (files, texts, export)
}

fn told(export: &Export) -> String {
    export.account.dropped.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
}

#[test]
fn what_obj_cannot_hold_is_told_by_name_and_place() {
    let text = format!("{FACE}[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nname = \"the ball\"\n");
    let (_, _, export) = export(scene(&text), Format::Obj, false);
    let told = told(&export);
    for wanted in [
        "warning: OBJ holds no camera",
        "a.toml:5:1: warning: OBJ holds no lights, so 1 light is left out: `light 1`",
        "a.toml:10:1: warning: OBJ holds triangles, so 1 sphere is left out: `the ball`",
    ] {
        assert!(told.contains(wanted), "{told}");
    }
    assert_eq!(export.account.carried["triangle"], 1);
}

#[test]
fn numbers_that_maps_show_are_told_where_a_format_holds_none() {
    let field = Field { name: "heat".into(), values: [1.0, 2.0, 3.0].into() };
    let mesh = Mesh {
        positions: [Vec3::ZERO, Vec3::X, Vec3::Y].into(),
        indices: [[0, 1, 2]].into(),
        fields: vec![field],
        ..Mesh::default()
    };
    let objects = vec![Object { name: "plate".to_owned(), ..Object::from(Shape::from(mesh)) }];
    for format in [Format::Obj, Format::Stl, Format::Gltf, Format::Tachyon] {
        let scene = Scene { objects: objects.clone(), ..Scene::default() };
        let options = ExportOptions { format, ..Default::default() };
        let told = told(&scene.export(&options, "b").expect("something to write"));
        let wanted = "the numbers of points that maps show are not written: those of plate";
        assert!(told.contains(wanted), "{format}: {told}");
    }
}

#[test]
fn a_bare_model_loses_nothing_it_had() {
    let files =
        Memory::new().with("a.obj", *b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\n");
    let model = read_in(&files, "a.obj").scene.expect("a model");
    for format in [Format::Obj, Format::Ply] {
        let (_, texts, export) = export(model.clone(), format, true);
        assert!(export.account.dropped.is_empty(), "{}", told(&export));
        assert_eq!(texts.len(), 1, "no materials: {texts:?}");
    }
}

#[test]
fn pure_red_of_an_mtl_file_is_pure_red_in_the_scene_and_again_in_mtl() {
    let files = Memory::new()
        .with("a.mtl", *b"newmtl red\nKd 1 0 0\n")
        .with("a.obj", *b"mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n");
    let model = read_in(&files, "a.obj").scene.expect("a model");
    let red = Rgb::new(1.0, 0.0, 0.0);
    assert_eq!(model.materials[1].color, red.into());
    assert_eq!(model.materials[1].k_d, 1.0.into());
    let (files, texts, export) = export(model.clone(), Format::Obj, true);
    assert_eq!(texts[1], ("b.mtl".to_owned(), "newmtl red\nKd 1 0 0\nillum 1\n".to_owned()));
    assert!(export.account.dropped.is_empty() && export.account.mapped.is_empty());
    let again = read_in(&files, "b.obj").scene.expect("a model");
    assert_eq!(again.materials[1].color, red.into());
    // And by way of a scene.
    let toml = model.export(&ExportOptions::default(), "c.toml").expect("a scene");
    let mut text = Vec::new();
    toml.files[0].write(&mut text).expect("memory");
    let text = String::from_utf8(text).expect("text");
    assert!(
        text.contains("[materials.red]\nmodel = \"lambert\"\ncolor = [1, 0, 0]\nk_d = 1\n"),
        "{text}"
    );
}

/// Every MTL file of the readers' tests says the same again after it was written.
#[test]
fn materials_of_mtl_files_are_written_as_they_were() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/mtl");
    for name in ["defaults", "dissolve", "illumination"] {
        let text = std::fs::read(folder.join(name).with_extension("mtl")).expect("a file");
        let mut model = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n".to_owned();
        for line in String::from_utf8_lossy(&text).lines() {
            if let Some(name) = line.trim().strip_prefix("newmtl ") {
                model.extend(["usemtl ", name, "\nf 1 2 3\n"]);
            }
        }
        let files = Memory::new().with("a.mtl", text).with("a.obj", model.into_bytes());
        let before = read_in(&files, "a.obj").scene.expect("a model");
        let (files, texts, export) = export(before.clone(), Format::Obj, true);
        assert!(export.account.dropped.is_empty(), "{name}: {}", told(&export));
        let after = read_in(&files, "b.obj").scene.expect("a model");
        assert_eq!(before.materials.len(), after.materials.len());
        for (before, after) in before.materials.iter().zip(&after.materials).skip(1) {
            let seen = |m: &phong_scene::Material| {
                let m = m.at(|_| Rgb::BLACK);
                let near = |c: Rgb| c.map(|c| (c * 1e5).round());
                let ambient = m.k_a * m.ambient_color.unwrap_or(m.color);
                let specular = m.k_s * m.specular_color.unwrap_or(m.color);
                let colors = [ambient, m.k_d * m.color, specular, m.reflection, m.transmission];
                (m.name.clone(), colors.map(near), m.k_s > 0.0, m.fresnel)
            };
            assert_eq!(seen(before), seen(after), "{name}: {}", texts[1].1);
        }
    }
}

#[test]
fn a_highlight_of_phong_becomes_one_of_blinn_with_the_formula() {
    let text = format!("[materials.m]\nshininess = 8\n{FACE}material = \"m\"\n");
    let (files, texts, export) = export(scene(&text), Format::Obj, false);
    let Some((_, mtl)) = texts.get(1) else { panic!("no MTL") };
    assert!(mtl.contains("Ns 32\nillum 2\n"), "{mtl}");
    assert!(export.account.mapped[0].contains("(R·E)^n becomes (N·H)^4n = 32"));
    let back = read_in(&files, "b.obj").scene.expect("a model");
    assert_eq!(back.materials[1].shininess, 32.0.into());
}

#[test]
fn what_mtl_cannot_say_of_a_material_is_told() {
    for (keys, wanted) in [
        ("reflection = 0.5", "the mirror"),
        ("model = \"oren-nayar\"", "Oren and Nayar's roughness"),
        ("model = \"ggx\"", "the Fresnel reflectance of facets"),
        ("model = \"blinn-phong\"\nnormalize = true", "normalised"),
        ("ambient_rule = \"per-light\"", "ambient light per light"),
    ] {
        let text = format!("[materials.m]\n{keys}\n{FACE}material = \"m\"\n");
        let (_, _, export) = export(scene(&text), Format::Obj, false);
        let told = told(&export);
        assert!(told.contains("material `m`: MTL does not hold"), "{keys}: {told}");
        assert!(told.contains(wanted), "{keys}: {told}");
    }
    // A mirror as strong as the highlight is one that MTL has, and so is light of its own.
    let text = format!(
        "[materials.m]\nmodel = \"blinn-phong\"\nk_s = 0.5\nreflection = 0.5\nk_e = 0.5\n\
         emission_color = [1, 0.5, 0]\n{FACE}material = \"m\"\n"
    );
    let (files, _, export) = export(scene(&text), Format::Obj, false);
    assert!(!told(&export).contains("MTL"), "{}", told(&export));
    let back = read_in(&files, "b.obj").scene.expect("a model");
    assert_eq!(back.materials[1].reflection, Rgb::grey(0.5).into());
    assert_eq!(back.materials[1].k_e, 1.0.into());
    assert_eq!(back.materials[1].emission_color, Some(Rgb::new(0.5, 0.25, 0.0).into()));
}

#[test]
fn triangles_are_written_where_instances_place_them() {
    let text = "[groups.g]\n[[groups.g.triangle]]\npoints = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\n\
                [[instance]]\ngroup = \"g\"\ntranslate = [0, 0, 2]\n\
                [[instance]]\ngroup = \"g\"\nscale = [-1, 1, 1]\n";
    for format in [Format::Obj, Format::Ply] {
        let (files, texts, export) = export(scene(text), format, false);
        assert!(
            export.account.mapped.iter().any(|how| how.starts_with("2 instances are unfolded"))
        );
        let back = read_in(&files, if format == Format::Obj { "b.obj" } else { "b.ply" });
        let back = back.scene.unwrap_or_else(|| panic!("{texts:?} {:?}", back.diagnostics));
        let Shape::Mesh(mesh) = &back.objects[0].shape else { panic!("a mesh") };
        let corner = |face: usize, i: usize| mesh.positions[mesh.indices[face][i] as usize];
        assert_eq!(corner(0, 0), Vec3::new(0.0, 0.0, 2.0));
        // Mirrored, it still faces the viewer.
        let [a, b, c] = [0, 1, 2].map(|i| corner(1, i));
        assert_eq!((b - a).cross(c - a), Vec3::Z);
        assert!(mesh.normals.iter().all(|n| *n == Vec3::Z), "flat triangles stay flat");
    }
}

#[test]
fn objects_keep_their_names_and_materials_their_faces() {
    let text = format!(
        "[materials.\"a b\"]\n[materials.c]\n{FACE}material = \"c\"\nname = \"one\"\n\
         {FACE}material = \"a b\"\nname = \"two\\n#2\"\n"
    );
    let (files, texts, _) = export(scene(&text), Format::Obj, false);
    let lines: Vec<_> = texts[0].1.lines().filter(|l| l.starts_with(['o', 'u', 'm'])).collect();
    assert_eq!(lines, ["mtllib b.mtl", "o one", "usemtl c", "o two__2", "usemtl a b"]);
    let back = read_in(&files, "b.obj");
    assert!(back.diagnostics.is_empty(), "{:?}", back.diagnostics);
}

#[test]
fn spheres_alone_become_points_with_the_colours_of_their_materials() {
    let text = "[materials.red]\ncolor = [1, 0, 0]\n\
                [[sphere]]\ncenter = [1, 2, 3]\nradius = 0.5\nmaterial = \"red\"\nscale = 2\n\
                [[sphere]]\ncenter = [0, 0, 0]\nradius = 1\n\
                [[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nscale = [1, 2, 1]\n";
    let (files, texts, export) = export(scene(text), Format::Ply, false);
    assert!(told(&export).contains("PLY holds no ellipsoids; 1 are left out: `sphere 3`"));
    let back = read_in(&files, "b.ply").scene.expect("points");
    let Shape::Points(points) = &back.objects[0].shape else { panic!("{texts:?}") };
    assert_eq!(points.spheres, [[2.0, 4.0, 6.0, 1.0], [0.0, 0.0, 0.0, 1.0]]);
    assert_eq!(points.colors, [Rgb::new(1.0, 0.0, 0.0), Rgb::grey(0.8)]);
}

#[test]
fn cylinders_alone_become_edges_and_what_has_no_place_is_told() {
    let ends = |y: f32| [[0.0, y, 0.0, 0.25], [1.0, y, 0.0, 0.5]];
    let cylinders = |caps| Cylinders { segments: [ends(1.0)].into(), caps, ..Cylinders::default() };
    let mut scene = scene("[materials.red]\ncolor = [1, 0, 0]\n");
    for (caps, transform) in [
        (Caps::Flat, DAffine3::from_scale(DVec3::splat(2.0))),
        (Caps::Round, DAffine3::from_scale(DVec3::new(1.0, 2.0, 1.0))),
    ] {
        let name = format!("{caps:?}");
        scene.objects.push(Object { name, transform, ..Object::from(cylinders(caps)) });
    }
    let (files, texts, export) = export(scene, Format::Ply, false);
    let told = told(&export);
    assert!(told.contains("PLY does not say that ends are not round: `Flat`"), "{told}");
    assert!(told.contains("cylinders that are not round; 1 are left out: `Round`"), "{told}");
    let back = read_in(&files, "b.ply").scene.expect("cylinders");
    let Shape::Cylinders(back) = &back.objects[0].shape else { panic!("{texts:?}") };
    assert_eq!(back.segments, [[[0.0, 2.0, 0.0, 0.5], [2.0, 2.0, 0.0, 1.0]]]);
}

#[test]
fn far_away_triangles_keep_their_detail() {
    let far = "[[triangle]]\npoints = [[4e6, 0, 0], [4000001.5, 0, 0], [4e6, 1.25, 0]]\n";
    let (files, texts, _) = export(scene(far), Format::Ply, false);
    let back = read_in(&files, "b.ply").scene.expect("a model");
    let Shape::Mesh(mesh) = &back.objects[0].shape else { panic!("{texts:?}") };
    let at = |i: usize| mesh.origin + mesh.positions[mesh.indices[0][i] as usize].as_dvec3();
    assert_eq!(at(1), DVec3::new(4_000_001.5, 0.0, 0.0));
}

#[test]
fn a_scene_without_anything_for_the_format_is_refused() {
    let ball = scene("[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\n");
    let plane = scene("[[plane]]\npoint = [0, 0, 0]\nnormal = [0, 1, 0]\n");
    let empty = scene(HEAD);
    for (scene, format) in [(ball, Format::Obj), (plane, Format::Ply), (empty, Format::Obj)] {
        let options = ExportOptions { format, ..Default::default() };
        let error = scene.export(&options, "b").expect_err("nothing to write");
        assert!(error.message.contains("nothing would be in the file"), "{error}");
    }
}

#[test]
fn instances_that_unfold_beyond_memory_are_refused() {
    let mut text =
        "[groups.g0]\n[[groups.g0.triangle]]\npoints = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\n"
            .to_owned();
    for level in 1..=20 {
        text.extend(["[groups.g", &level.to_string(), "]\n"]);
        for _ in 0..2 {
            let (outer, inner) = (level.to_string(), (level - 1).to_string());
            text.extend(["[[groups.g", &outer, ".instance]]\ngroup = \"g", &inner, "\"\n"]);
        }
    }
    text += "[[instance]]\ngroup = \"g20\"\n";
    let options = ExportOptions { format: Format::Obj, max_bytes: 1 << 20, ..Default::default() };
    let error = scene(&text).export(&options, "b.obj").expect_err("too much");
    assert!(error.message.contains("1048576 triangles"), "{error}");
}

/// One of each shape, placed evenly and unevenly, one of them in a group.
const SOLIDS: &str = "[[sphere]]\ncenter = [1, 2, 3]\nradius = 2\nscale = [1, 3, 1]\n\
    [[box]]\nmin = [5, 0, 0]\nmax = [6, 2, 1]\nrotate = [0, 1, 1, 30]\n\
    [[cylinder]]\nfrom = [10, 0, 0]\nto = [10, 2, 1]\nradius = 0.5\n\
    [[cone]]\nfrom = [15, 0, 0]\nto = [15, 2, 0]\nradius = 1\n\
    [[cone]]\nfrom = [15, 5, 0]\nto = [15, 7, 0]\nradius = 0\nradius_to = 0.5\n\
    [[torus]]\ncenter = [20, 0, 0]\naxis = [1, 1, 0]\nradius = 1\ntube = 0.25\n\
    [groups.g]\n[[groups.g.sphere]]\ncenter = [0, 0, 0]\nradius = 0.1\n\
    [[instance]]\ngroup = \"g\"\nscale = 10\n[[instance]]\ngroup = \"g\"\ntranslate = [0, 9, 0]\n";

fn capsules() -> Scene {
    let mut scene = scene(SOLIDS);
    let between = |y: f32, a: f32, b: f32, length: f32| [[0.0, y, -20.0, a], [length, y, -20.0, b]];
    for (caps, y) in [(Caps::Round, 0.0), (Caps::Flat, 10.0)] {
        let segments = [
            between(y, 0.5, 0.5, 2.0),
            between(y + 3.0, 0.5, 0.2, 2.0),
            between(y + 6.0, 0.1, 0.7, 0.3),
        ];
        let colors = [[Rgb::WHITE; 2], [Rgb::WHITE, Rgb::BLACK], [Rgb::BLACK, Rgb::WHITE]];
        let cylinders = Cylinders {
            segments: segments.into(),
            colors: colors.into(),
            caps,
            ..Default::default()
        };
        scene.objects.push(Object::from(cylinders));
    }
    scene
}

fn tessellated(scene: Scene, format: Format, tolerance: f64) -> Result<Export, String> {
    let tessellate = Some(tolerance);
    let options =
        ExportOptions { format, tessellate, max_bytes: 1 << 30, ..ExportOptions::default() };
    scene.export(&options, "b.ply").map_err(|error| error.to_string())
}

#[test]
fn triangles_in_place_of_solids_are_closed_and_face_outwards() {
    let export = tessellated(capsules(), Format::Ply, 0.02).expect("triangles");
    let said = export.account.mapped.join("\n");
    for wanted in ["2 cones become", "6 cylinders become", "1 box becomes 12 triangles", "0.02"] {
        assert!(said.contains(wanted), "{said}");
    }
    assert!(!told(&export).contains("left out: `sphere"), "{}", told(&export));
    let mut bytes = Vec::new();
    export.files[0].write(&mut bytes).expect("memory");
    let model = read_in(&Memory::new().with("b.ply", bytes), "b.ply").scene.expect("a model");
    let Shape::Mesh(mesh) = &model.objects[0].shape else { panic!("a mesh") };
    // Every edge is there as often one way as the other.
    let mut edges = std::collections::BTreeMap::new();
    let mut volume = 0.0;
    for (face, corners) in mesh.indices.iter().enumerate() {
        let places = corners.map(|i| mesh.positions[i as usize]);
        let [a, b, c] = places.map(Vec3::as_dvec3);
        volume += a.dot(b.cross(c)) / 6.0;
        let normals =
            if mesh.normal_indices.is_empty() { corners } else { &mesh.normal_indices[face] };
        let flat = (b - a).cross(c - a);
        for normal in normals.iter().map(|i| mesh.normals[*i as usize].as_dvec3()) {
            assert!(flat.dot(normal) > 0.0, "{places:?} {normal}");
        }
        for i in 0..3 {
            let [from, to] =
                [places[i], places[(i + 1) % 3]].map(|p| p.to_array().map(f32::to_bits));
            *edges.entry((from, to)).or_insert(0) += 1;
            *edges.entry((to, from)).or_insert(0) -= 1;
        }
    }
    assert!(edges.values().all(|open| *open == 0), "closed");
    assert!(volume > 0.0, "{volume}");
}

#[test]
fn triangles_stay_within_the_tolerance_wherever_they_are_placed() {
    use std::f64::consts::PI;
    // Spheres, as an ellipsoid and by an instance ten times as large; a torus: what their points are off.
    let off: [(&str, &dyn Fn(DVec3) -> f64); 3] = [
        ("[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nscale = 3\n", &|p| p.length() - 3.0),
        (
            "[groups.g]\n[[groups.g.sphere]]\ncenter = [0, 0, 0]\nradius = 0.1\n\
             [[instance]]\ngroup = \"g\"\nscale = 10\n",
            &|p| p.length() - 1.0,
        ),
        ("[[torus]]\ncenter = [0, 0, 0]\naxis = [0, 1, 0]\nradius = 2\ntube = 0.5\n", &|p| {
            DVec3::new(DVec3::new(p.x, 0.0, p.z).length() - 2.0, p.y, 0.0).length() - 0.5
        }),
    ];
    for (text, off) in off {
        for tolerance in [0.2, 0.01, 0.002] {
            let export = tessellated(scene(text), Format::Ply, tolerance).expect("triangles");
            let mut bytes = Vec::new();
            export.files[0].write(&mut bytes).expect("memory");
            let model =
                read_in(&Memory::new().with("b.ply", bytes), "b.ply").scene.expect("a model");
            let Shape::Mesh(mesh) = &model.objects[0].shape else { panic!("a mesh") };
            let mut most = 0.0_f64;
            for corners in &mesh.indices[..] {
                let [a, b, c] =
                    corners.map(|i| mesh.origin + mesh.positions[i as usize].as_dvec3());
                for shares in [[1.0, 1.0, 1.0], [1.0, 1.0, 0.0], [0.0, 1.0, 1.0], [1.0, 0.0, 1.0]] {
                    let [i, j, k]: [f64; 3] = shares;
                    most = most.max(off((i * a + j * b + k * c) / (i + j + k)).abs());
                }
            }
            assert!(most <= tolerance && most > 0.1 * tolerance, "{text} {tolerance}: {most}");
        }
    }
    // A circle of radius 1 within 1 − cos (π / 8) is cut into 8.
    let disc = "[[disc]]\ncenter = [0, 0, 0]\nnormal = [0, 1, 0]\nradius = 1\n";
    let export = tessellated(scene(disc), Format::Ply, 1.0 - libm::cos(PI / 8.0) + 1e-9);
    assert_eq!(export.expect("a disc").account.carried["triangle"], 8);
}

#[test]
fn a_tolerance_that_is_none_or_too_fine_is_refused() {
    let ball = || scene("[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\n");
    for (tolerance, wanted) in [
        (0.0, "a tolerance is a number above 0"),
        (-1.0, "a tolerance is a number above 0"),
        (f64::NAN, "a tolerance is a number above 0"),
        (1e-9, "a.toml:8:1: error: a tolerance of 0.000000001 is finer than numbers"),
    ] {
        let error = tessellated(ball(), Format::Ply, tolerance).expect_err("refused");
        assert!(error.contains(wanted), "{error}");
    }
    let mut many = ball();
    for _ in 0..1000 {
        many.objects.push(many.objects[0].clone());
    }
    let error = tessellated(many, Format::Ply, 1e-6).expect_err("refused");
    assert!(error.contains("bytes of memory; 1073741824 are allowed"), "{error}");
}
