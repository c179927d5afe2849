//! Scenes as OBJ with MTL and as PLY: what is there, what is told to be missing, what comes back.

use glam::{DAffine3, DVec3, Vec3};
use phong_scene::{
    Caps, Cylinders, Export, ExportOptions, Format, Limits, Memory, Object, PlyEncoding, Reading,
    Rgb, Scene, Shape, read,
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
        ("k_e = 0.5", "the light of its own"),
    ] {
        let text = format!("[materials.m]\n{keys}\n{FACE}material = \"m\"\n");
        let (_, _, export) = export(scene(&text), Format::Obj, false);
        let told = told(&export);
        assert!(told.contains("material `m`: MTL does not hold"), "{keys}: {told}");
        assert!(told.contains(wanted), "{keys}: {told}");
    }
    // A mirror as strong as the highlight is one that MTL has.
    let text = format!(
        "[materials.m]\nmodel = \"blinn-phong\"\nk_s = 0.5\nreflection = 0.5\n{FACE}material = \"m\"\n"
    );
    let (files, _, export) = export(scene(&text), Format::Obj, false);
    assert!(!told(&export).contains("MTL"), "{}", told(&export));
    let back = read_in(&files, "b.obj").scene.expect("a model");
    assert_eq!(back.materials[1].reflection, Rgb::grey(0.5).into());
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
