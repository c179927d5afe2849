//! Files as other programs write them: what came out wrong once, and what it is like.
//!
//! `cases/` holds the inputs of strangers' reports; the neighbours of each stand here.

mod images;

use std::fs;
use std::path::Path;

use phong_scene::{
    ConstantMaterial, Framing, Limits, Memory, Mesh, Model, NO_INDEX, Points, Reading, Rgb, Scene,
    Shape, Side, VertexColors, read,
};

fn case(name: &str) -> Vec<u8> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases").join(name);
    fs::read(path).expect("a case")
}

fn read_with(files: &[(&str, &[u8])], limits: &Limits) -> Reading {
    let source = files.iter().fold(Memory::new(), |m, (name, bytes)| m.with(*name, *bytes));
    read(files[0].0, None, &source, limits)
}

fn reading(name: &str) -> Reading {
    let mut files = vec![(name.to_owned(), case(name))];
    let library = name.replace(".obj", ".mtl");
    if Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases").join(&library).exists() {
        files.push((library.clone(), case(&library)));
    }
    let files: Vec<_> = files.iter().map(|(name, bytes)| (&**name, &**bytes)).collect();
    read_with(&files, &Limits::default())
}

fn text(name: &str, text: &str) -> Reading {
    read_with(&[(name, text.as_bytes())], &Limits::default())
}

fn told(reading: &Reading) -> String {
    reading.diagnostics.iter().map(|d| d.to_string() + "\n").collect()
}

#[track_caller]
fn scene(reading: Reading) -> Scene {
    let told = told(&reading);
    reading.scene.unwrap_or_else(|| panic!("{told}"))
}

#[track_caller]
fn mesh(reading: Reading) -> Mesh {
    match scene(reading).objects.swap_remove(0).shape {
        Shape::Mesh(mesh) => (*mesh).clone(),
        other => panic!("{other:?}"),
    }
}

#[track_caller]
fn points(reading: Reading) -> Points {
    match scene(reading).objects.swap_remove(0).shape {
        Shape::Points(points) => (*points).clone(),
        other => panic!("{other:?}"),
    }
}

/// The only material of an MTL file, of which a face is made.
fn material(mtl: &str) -> (ConstantMaterial, String) {
    let name = mtl.lines().find_map(|line| line.strip_prefix("newmtl ")).expect("a name");
    let obj = format!("mtllib a.mtl\nusemtl {name}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let files = [("a.obj", obj.as_bytes()), ("a.mtl", mtl.as_bytes())];
    let reading = read_with(&files, &Limits::default());
    let told = told(&reading);
    (scene(reading).materials[1].at(|_| Rgb::BLACK), told)
}

fn case_material(name: &str) -> (ConstantMaterial, String) {
    material(&String::from_utf8(case(name)).expect("text"))
}

#[test]
fn an_exponent_of_zero_or_below_is_no_highlight() {
    let (blender, told) = case_material("ns0.mtl");
    assert_eq!((blender.model, blender.k_s), (Model::Lambert, 0.0));
    assert_eq!(told.matches("leaves no highlight").count(), 1, "{told}");
    let (below, _) = material("newmtl a\nNs -1\nKs 1 1 1\n");
    assert_eq!(below.model, Model::Lambert);
    let (_, silent) = material("newmtl a\nNs 0\nKs 0 0 0\n");
    assert_eq!(silent, "", "no highlight was asked for");
    let (above, _) = material("newmtl a\nNs 0.5\nKs 1 1 1\n");
    assert_eq!((above.model, above.shininess), (Model::BlinnPhong, 0.5));
}

#[test]
fn a_transparency_of_one_alone_is_opaque() {
    let (opaque, told) = case_material("tr1.mtl");
    assert!(opaque.transmission.is_black() && opaque.k_d == 1.0);
    assert!(told.contains("it is read as opaque"), "{told}");
    let (half, _) = material("newmtl a\nTr 0.5\n");
    assert_eq!(half.transmission, Rgb::grey(0.5));
    let (said, _) = material("newmtl a\nTr 1\nd 0.25\n");
    assert_eq!(said.k_d, 0.25);
}

#[test]
fn a_white_ambient_colour_is_a_filler_and_any_other_is_meant() {
    let (filler, _) = material("newmtl a\nKa 1 1 1\nKd 0.2 0.4 0.6\n");
    assert_eq!((filler.ambient_color, filler.k_a), (None, 1.0));
    let (meant, _) = material("newmtl a\nKa 1 1 0.9\nKd 0.2 0.4 0.6\n");
    assert_eq!(meant.ambient_color, Some(Rgb::new(1.0, 1.0, 0.9)));
}

#[test]
fn colours_above_one_are_bytes_if_all_are_whole_and_else_a_warning() {
    let (bytes, told) = material("newmtl a\nKd 255 51 0\nKs 1 0 0\n");
    assert_eq!(bytes.color, Rgb::new(1.0, 0.2, 0.0));
    assert!(told.contains("read as bytes"), "{told}");
    let (bright, told) = material("newmtl a\nKd 1.5 1 0\n");
    assert_eq!(bright.color, Rgb::new(1.5, 1.0, 0.0));
    assert!(told.contains("`Kd 1.5 1 0` is above 1"), "{told}");
    let (_, silent) = material("newmtl a\nKd 1 0 1\nKa 0 0 0\n");
    assert_eq!(silent, "");
}

#[test]
fn a_black_diffuse_colour_beside_an_image_is_grey_while_images_are_not_read() {
    let (grey, _) = material("newmtl a\nKd 0 0 0\nmap_Kd wood.png\n");
    assert_eq!(grey.color, Rgb::grey(0.8));
    let (black, _) = material("newmtl a\nKd 0 0 0\n");
    assert!(black.color.is_black());
}

#[test]
fn nothing_is_said_of_materials_that_no_face_uses() {
    let reading = reading("unused_materials.obj");
    assert_eq!(told(&reading), "");
    assert!(reading.scene.is_some());
    let mtl = "newmtl used\nnewmtl unused\nKd nonsense\nmap_Kd a.png\n";
    assert_eq!(material(mtl).1, "");
    let obj = b"mtllib a.mtl\nusemtl unused\nusemtl used\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let files = [("a.obj", &obj[..]), ("a.mtl", mtl.as_bytes())];
    assert_eq!(told(&read_with(&files, &Limits::default())), "", "no face stands behind it");
}

#[test]
fn smoothing_off_is_flat_and_groups_are_round_within_themselves() {
    let flat = mesh(reading("smoothing-off.obj"));
    assert!(flat.normal_indices.iter().flatten().all(|i| *i == NO_INDEX));
    let roof = "v 0 1 0\nv 0 1 1\nv 1 0 0\nv -1 0 0\n";
    let round = mesh(text("a.obj", &format!("{roof}s 1\nf 1 2 3\nf 2 1 4\n")));
    // Numbered like the positions, of which the ridge's are 0 and 1.
    assert!(round.normal_indices.is_empty() && round.normals[0].y == 1.0);
    let sharp = mesh(text("a.obj", &format!("{roof}s 1\nf 1 2 3\ns 2\nf 2 1 4\n")));
    assert_ne!(sharp.normal_indices[0][0], sharp.normal_indices[1][1]);
    assert!(sharp.normals.iter().all(|n| n.y < 0.9));
    let own = format!("{roof}vn 0 0 1\ns off\nf 1//1 2//1 3//1\n");
    assert_eq!(mesh(text("a.obj", &own)).normals.len(), 1, "the file's normals win");
}

#[test]
fn colours_of_obj_and_bytes_of_ply_are_srgb_and_floats_of_ply_linear() {
    let obj = mesh(reading("colours.obj")).colors[0];
    let ply = mesh(reading("colours.ply")).colors[0];
    assert_eq!(ply, Rgb::from_srgb8([128, 64, 200]));
    let close = |a: f32, b: f32| (a - b).abs() < 1e-6;
    assert!(close(obj.r, ply.r) && close(obj.g, ply.g) && close(obj.b, ply.b), "{obj:?}");
    let face = "f 1 2 3\n";
    let bytes = "v 0 0 0 128 64 200\nv 1 0 0 128 64 200\nv 0 1 0 0 1 255\n";
    assert_eq!(mesh(text("a.obj", &format!("{bytes}{face}"))).colors[0], ply);
    let bright = "v 0 0 0 1.5 0 0\nv 1 0 0 0 0 0\nv 0 1 0 0 0 0\n";
    let reading = text("a.obj", &format!("{bright}{face}"));
    assert!(told(&reading).contains("colours above 1: 1"), "{}", told(&reading));
}

const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n\
                   property float z\n";
const FACE: &str = "element face 2\nproperty list uchar int vertex_indices\nend_header\n";

#[test]
fn colours_are_written_as_they_were_read() {
    let ply = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    let text =
        format!("{PLY}{ply}end_header\n0 0 0 1 2 3\n1 0 0 255 0 9\n0 1 0 4 5 6\n1 1 0 7 8 9\n");
    let cloud = points(self::text("a.ply", &text));
    let mut file = Vec::new();
    cloud.write_ply(phong_scene::PlyEncoding::Ascii, &mut file).expect("memory");
    let written = String::from_utf8(file).expect("text");
    assert!(
        written.contains("property uchar red\n") && written.contains(" 255 0 9\n"),
        "{written}"
    );
    let own = Points { colors: vec![Rgb::grey(0.3); 4].into(), ..cloud };
    let mut file = Vec::new();
    own.write_ply(phong_scene::PlyEncoding::Ascii, &mut file).expect("memory");
    let written = String::from_utf8(file).expect("text");
    assert!(written.contains("property float red\n") && written.contains(" 0.3 0.3 0.3\n"));
}

#[test]
fn one_point_that_is_no_number_among_many_is_left_out_and_counted() {
    let reading = reading("nan_cloud.ply");
    assert_eq!(
        told(&reading),
        "nan_cloud.ply:9:1: warning: vertex 1 (counted from 0): its `x` is NaN; it is left out\n"
    );
    assert_eq!(points(reading).spheres.len(), 3);
    let all = format!("{PLY}end_header\nnan 0 0\n0 inf 0\n0 0 -inf\n1.#QNAN 0 0\n");
    let reading = text("a.ply", &all);
    assert!(reading.scene.is_none() && told(&reading).contains("no vertex is left"));
    let rows = "0 0 0\nnan 0 0\n1 0 0\n0 1 0\n3 0 2 3\n3 0 1 2\n";
    let mesh = mesh(text("a.ply", &format!("{PLY}{FACE}{rows}")));
    assert_eq!(mesh.indices, [[0, 2, 3]]);
    let obj = "v 0 0 0\nv nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 3 4\nf 1 2 3\n";
    let reading = text("a.obj", obj);
    let said = told(&reading);
    assert!(said.contains("a.obj:2:3: warning: `nan` is no number: the position is"), "{said}");
    assert!(said.contains("faces that use the 1 positions that are no numbers: 1"), "{said}");
    assert_eq!(self::mesh(reading).indices.len(), 1);
}

#[test]
fn one_bad_colour_or_normal_is_done_without() {
    let colors = "property float red\nproperty float green\nproperty float blue\nend_header\n";
    let rows = "0 0 0 1 1 1\n1 0 0 nan 0 0\n0 1 0 0 -1 0\n1 1 0 0 0 0\n";
    let reading = text("a.ply", &format!("{PLY}{colors}{rows}"));
    assert_eq!(told(&reading).matches("it is grey").count(), 2, "{}", told(&reading));
    assert_eq!(points(reading).colors[1], Rgb::grey(0.8));
    let obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn nan 0 1\nvn 0 0 1\nf 1//1 2//2 3//9\n";
    let reading = text("a.obj", obj);
    let said = told(&reading);
    assert!(said.contains("use a normal out of range: 1"), "{said}");
    assert!(said.contains("normals without a direction: 1"), "{said}");
    assert_eq!(mesh(reading).normal_indices, [[NO_INDEX, 1, NO_INDEX]]);
}

#[test]
fn a_property_that_nothing_reads_may_be_there_twice() {
    let reading = reading("dup_unused.ply");
    assert_eq!(told(&reading), "");
    assert_eq!(mesh(reading).indices, [[0, 1, 2]]);
    let twice = PLY.replace("float z\n", "float z\nproperty float z\n") + "end_header\n";
    assert!(told(&text("a.ply", &twice)).contains("there is a property `z` already"));
}

#[test]
fn a_position_out_of_range_is_refused_unless_one_is_lenient() {
    let obj = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 9\n";
    let ply = format!("{PLY}{FACE}0 0 0\n1 0 0\n0 1 0\n1 1 0\n3 0 1 2\n3 0 1 9\n");
    let lenient = Limits { lenient: true, ..Limits::default() };
    for (name, bytes) in [("a.obj", &obj[..]), ("a.ply", ply.as_bytes())] {
        assert!(read_with(&[(name, bytes)], &Limits::default()).scene.is_none(), "{name}");
        let reading = read_with(&[(name, bytes)], &lenient);
        assert!(told(&reading).contains("left out"), "{}", told(&reading));
        assert_eq!(mesh(reading).indices.len(), 1, "{name}");
    }
}

#[test]
fn a_truncated_file_is_refused_unless_one_is_lenient() {
    let ascii = format!("{PLY}end_header\n0 0 0\n1 0 0\n");
    let head = PLY.replace("ascii", "binary_little_endian") + "end_header\n";
    let binary = [head.into_bytes(), vec![0; 12], vec![63; 12], vec![0; 5]].concat();
    let lenient = Limits { lenient: true, ..Limits::default() };
    for bytes in [ascii.as_bytes(), &binary] {
        assert!(read_with(&[("a.ply", bytes)], &Limits::default()).scene.is_none());
        let reading = read_with(&[("a.ply", bytes)], &lenient);
        assert!(told(&reading).contains("after 2 of 4 rows"), "{}", told(&reading));
        assert_eq!(points(reading).spheres.len(), 2);
    }
}

#[test]
fn alpha_below_one_is_told_and_alpha_of_one_is_not() {
    let head = format!("{PLY}property uchar alpha\nend_header\n");
    let rows = |alpha: u8| format!("0 0 0 255\n1 0 0 255\n0 1 0 255\n1 1 0 {alpha}\n");
    assert_eq!(told(&text("a.ply", &(head.clone() + &rows(255)))), "");
    assert!(told(&text("a.ply", &(head + &rows(7)))).contains("less than opaque"));
}

#[test]
fn points_of_obj_are_drawn_as_those_of_ply_are() {
    assert_eq!(points(text("a.obj", "v 0 0 0\nv 2 0 0\nv 9 9 9\np 1 2\n")).spheres.len(), 2);
    let alone = points(text("a.obj", "v 0 0 0\nv 2 0 0\nv 4 0 0\n"));
    assert_eq!((alone.spheres.len(), alone.guessed), (3, Some(1.0)));
    let both = scene(text("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\np -1\n"));
    assert_eq!(both.objects.iter().map(|o| o.shape.kind()).collect::<Vec<_>>(), ["mesh", "points"]);
    assert!(text("a.obj", "v 0 0 0\np 2\n").scene.is_none());
}

#[test]
fn guessed_spheres_are_at_least_a_pixel_large_in_any_picture() {
    let mut scene = scene(reading("clumps.ply"));
    for height in [64, 1080] {
        scene.image.size = [height, height];
        let _ = scene.frame(&Framing::default());
        let Shape::Points(points) = &scene.objects[0].shape else { panic!("points") };
        let bounds = scene.bounds();
        let distance = bounds.center().distance(scene.camera.eye) + bounds.size().length();
        let tan_20_degrees = 0.363_970_234_266_202_4;
        let pixel = 2.0 * distance * tan_20_degrees / f64::from(height);
        let radius = f64::from(points.spheres[0][3]);
        assert!(radius > 0.5 * pixel && radius < 4.0 * pixel, "{radius} {pixel}");
    }
    let own = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n\
               property float z\nproperty float radius\nend_header\n0 0 0 1e-9\n1 0 0 1e-9\n";
    assert_eq!(points(text("a.ply", own)).spheres[0][3], 1e-9, "the file's own are kept");
}

#[test]
fn a_flat_model_seen_from_its_edge_is_turned_and_relief_is_asked_about() {
    let plate = "v 0 0 0\nv 9 0 0\nv 9 0 5\nv 0 0 5\nf 1 2 3 4\n";
    let mut flat = scene(text("a.obj", plate));
    let said = flat.frame(&Framing { side: Side::Front, ..Framing::default() });
    assert!(said[0].to_string().starts_with("a.obj: warning: the model is flat"), "{said:?}");
    let view = flat.camera.look_at - flat.camera.eye;
    assert!(view.y < -0.5 * view.length(), "{view}");
    assert_eq!(flat.frame(&Framing { side: Side::Top, ..Framing::default() }), []);
    let relief = "v 0 0 0\nv 9 0 1\nv 9 7 0\nv 0 7 1\nf 1 2 3 4\n";
    let said = scene(text("a.obj", relief)).frame(&Framing::default());
    assert!(said[0].message.contains("perhaps Z is up"), "{said:?}");
    let up = Framing { up: glam::DVec3::Z, ..Framing::default() };
    assert_eq!(scene(text("a.obj", relief)).frame(&up), []);
}

#[test]
fn what_the_camera_does_not_see_is_told() {
    let head = "version = 1\n[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 9]\n\
                [[light]]\nkind = \"distant\"\ndirection = [0, 0, -1]\n";
    let ball = |name: &str, z: f64| {
        format!("[[sphere]]\nname = \"{name}\"\ncenter = [0, 0, {z}]\nradius = 1\n")
    };
    let said = told(&text("a.toml", &(head.to_owned() + &ball("behind", 0.0))));
    assert!(said.contains("a.toml:8:1: warning: the camera sees nothing"), "{said}");
    let both = text("a.toml", &(head.to_owned() + &ball("seen", 12.0) + &ball("behind", 0.0)));
    let said = told(&both);
    assert!(said.contains("a.toml:12:1: warning: wholly outside the picture: `behind`"), "{said}");
    let plane = "[[plane]]\npoint = [0, -1, 0]\nnormal = [0, 1, 0]\n";
    assert_eq!(told(&text("a.toml", &(head.to_owned() + &ball("seen", 12.0) + plane))), "");
}

#[test]
fn a_parameter_that_is_0_wherever_its_texture_is_is_told() {
    for (parameter, is_told) in [
        ("k_d = { texture = \"t\", offset = -1 }", true),
        ("shininess = { texture = \"t\", scale = -50 }", true),
        ("color = { texture = \"t\", offset = -1.5 }", true),
        ("color = { texture = \"t\", offset = -0.9 }", false),
        // Of a number red counts, of a colour all three.
        ("k_s = { texture = \"t\", offset = -0.5 }", true),
        ("color = { texture = \"t\", offset = -0.5 }", false),
        ("bump = { texture = \"t\", scale = -1 }", false),
    ] {
        let scene = format!(
            "version = 1\n[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\n\
             [[light]]\nkind = \"distant\"\ndirection = [0, 0, -1]\n\
             [textures.t]\nkind = \"checker\"\ncolors = [[0.5, 1, 0], 0]\n\
             [materials.m]\n{parameter}\n\
             [[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"m\"\n"
        );
        let said = told(&text("a.toml", &scene));
        assert_eq!(said.contains("is 0 everywhere: all of the texture \"t\""), is_told, "{said}");
        assert_eq!(said.contains("a.toml:11:1: warning"), is_told, "{said}");
    }
}

#[test]
fn a_packed_model_is_read_as_it_is_whatever_its_name_says() {
    use std::io::Write;
    let mut packer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    packer.write_all(&case("colours.ply")).expect("memory");
    let bytes = packer.finish().expect("memory");
    for name in ["a.ply.gz", "a.ply"] {
        let mesh = mesh(read_with(&[(name, &bytes)], &Limits::default()));
        assert_eq!(mesh.indices.len(), 1);
    }
    let limits = Limits { bytes: 100, ..Limits::default() };
    assert!(told(&read_with(&[("a.ply.gz", &bytes)], &limits)).contains("more than 100 bytes"));
}

#[test]
#[cfg(unix)]
fn names_need_not_be_utf8() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let folder = std::env::temp_dir().join(format!("phong-names-{}", std::process::id()));
    fs::create_dir_all(&folder).expect("a folder");
    let latin = |name: &[u8]| folder.join(OsStr::from_bytes(name));
    let obj = b"mtllib caf\xe9.mtl\nusemtl gr\xfcn\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n\
                usemtl gr\xf6n\nf 3 2 1\n";
    fs::write(latin(b"mod\xe8le.obj"), obj).expect("a file");
    let mtl = b"newmtl gr\xfcn\nKd 0 1 0\nnewmtl gr\xf6n\nKd 0 0 1\n";
    fs::write(latin(b"caf\xe9.mtl"), mtl).expect("a file");
    let path = phong_scene::path_text(latin(b"mod\xe8le.obj").as_os_str());
    let reading = read(&path, None, &phong_scene::Folder, &Limits::default());
    fs::remove_dir_all(&folder).expect("the folder");
    assert_eq!(told(&reading), "");
    let names: Vec<_> = scene(reading).materials.into_iter().map(|m| m.name).collect();
    assert_eq!(names, ["default", "grün", "grön"]);
}

#[test]
fn a_remark_behind_the_atoms_of_a_lammps_file_is_no_style() {
    let full = include_str!("atoms/water.data");
    let remark = full.replace("Atoms # full", "Atoms # as the manual has them");
    let objects = |text: &str| {
        let reading = read_with(&[("a.data", text.as_bytes())], &Limits::default());
        format!("{:?}", reading.scene.expect("a scene").objects)
    };
    assert_eq!(objects(&remark), objects(full));
}

#[test]
fn a_lamp_of_a_large_ambient_colour_makes_no_bytes_of_the_others() {
    // The Cornell box as it goes about: all numbers are whole, and one is 20.
    let (white, told) = material("newmtl white\nKd 1 1 1\nnewmtl lamp\nKa 20 20 20\nKd 1 1 1\n");
    assert_eq!((white.color, told.contains("bytes")), (Rgb::WHITE, false), "{told}");
}

/// A triangle of three colours, red, green and blue, with these nodes, this list of roots and whatever
/// else belongs into the file and into its primitive.
fn gltf(nodes: &str, roots: &str, more: &str, of_primitive: &str) -> Reading {
    let corners = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA/wAA/wD/AP8AAP//";
    let file = format!(
        r#"{{"asset": {{"version": "2.0"}}, "nodes": {nodes}, "scenes": [{{"nodes": {roots}}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0, "COLOR_0": 1}} {of_primitive}}}]}}],
        "accessors": [{{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3}},
            {{"bufferView": 1, "componentType": 5121, "type": "VEC4", "count": 3, "normalized": true}}],
        "bufferViews": [{{"buffer": 0, "byteOffset": 0, "byteLength": 36}},
            {{"buffer": 0, "byteOffset": 36, "byteLength": 12}}],
        "buffers": [{{"byteLength": 48, "uri": "data:application/octet-stream;base64,{corners}"}}]
        {more}}}"#
    );
    text("a.gltf", &file)
}

#[test]
fn a_gltf_primitive_whose_places_are_packed_is_refused_by_the_name_of_the_packing() {
    let file = |accessor: &str, required: &str| {
        format!(
            r#"{{"asset": {{"version": "2.0"}}, "extensionsUsed": ["KHR_draco_mesh_compression"] {required},
            "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "extensions":
                {{"KHR_draco_mesh_compression": {{"bufferView": 0, "attributes": {{"POSITION": 0}}}}}}}}]}}],
            "accessors": [{{"componentType": 5126, "type": "VEC3", "count": 3 {accessor}}}],
            "bufferViews": [{{"buffer": 0, "byteLength": 36}}],
            "buffers": [{{"byteLength": 36, "uri":
                "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}}]}}"#
        )
    };
    let packed = told(&text("a.gltf", &file("", "")));
    assert!(packed.contains("it is packed by `KHR_draco_mesh_compression`"), "{packed}");
    let required = r#", "extensionsRequired": ["KHR_draco_mesh_compression"]"#;
    let required = told(&text("a.gltf", &file("", required)));
    assert!(required.contains("requires `KHR_draco_mesh_compression`"), "{required}");
    let beside = text("a.gltf", &file(r#", "bufferView": 0"#, ""));
    assert_eq!(mesh(beside).indices.len(), 1, "it is also there as it is");
}

#[test]
fn a_root_of_a_gltf_scene_may_have_a_parent() {
    let nodes = r#"[{"children": [1], "translation": [5, 0, 0]}, {"mesh": 0}]"#;
    for (roots, end, x) in [("[1]", "as if it had none", 0.0), ("[0, 1]", "below it, once", 5.0)] {
        let reading = gltf(nodes, roots, "", "");
        let said = told(&reading);
        assert!(
            said.contains(&format!(
                "warning: /scenes/0/nodes/{}: node 1 has a parent; it is drawn {end}",
                roots.len() / 4
            )),
            "{said}"
        );
        let scene = scene(reading);
        assert_eq!((scene.objects.len(), scene.bounds().min.x), (1, x), "{roots}");
    }
    let round = r#"[{"children": [1]}, {"mesh": 0, "children": [0]}]"#;
    assert!(
        told(&gltf(round, "[1]", "", ""))
            .contains("error: /scenes/0/nodes/0: node 1 is below itself")
    );
}

#[test]
fn colours_of_vertices_are_seen_on_what_gltf_calls_metal() {
    let colors = [Rgb::new(1.0, 0.0, 0.0), Rgb::new(0.0, 1.0, 0.0), Rgb::new(0.0, 0.0, 1.0)];
    let nodes = r#"[{"mesh": 0}]"#;
    // Without a material, and with one that does not say that it is no metal.
    assert_eq!(mesh(gltf(nodes, "[0]", "", "")).colors[..], colors);
    let reading = gltf(nodes, "[0]", r#", "materials": [{"name": "m"}]"#, r#", "material": 0"#);
    assert_eq!(mesh(reading).colors[..], colors);
    let with = |metal: &str| {
        let factor = r#""baseColorFactor": [0.5, 0.5, 0.5, 1]"#;
        let more = format!(r#", "materials": [{{"pbrMetallicRoughness": {{{factor}{metal}}}}}]"#);
        let scene = scene(gltf(nodes, "[0]", &more, r#", "material": 0"#));
        let material = scene.materials[scene.objects[0].material.0 as usize].clone();
        assert_eq!(material.vertex_colors, VertexColors::Multiply);
        assert_eq!(material.color.constant(), Some(Rgb::grey(0.5)));
        assert_eq!(material.ambient_color, None);
        let Shape::Mesh(mesh) = &scene.objects[0].shape else { panic!("a mesh") };
        assert_eq!(mesh.colors[..], colors);
        material
    };
    let unsaid = with("");
    assert_eq!(unsaid.k_d.constant(), Some(1.0), "it scatters them");
    let half = with(r#", "metallicFactor": 0.5"#);
    assert_eq!((half.k_d.constant(), half.specular_color), (Some(0.5), None), "both have them");
    let metal = with(r#", "metallicFactor": 1"#);
    assert_eq!((metal.k_d.constant(), metal.specular_color), (Some(0.0), None), "it mirrors them");
}

#[test]
fn lights_of_a_gltf_file_in_lux_are_dimmed_and_others_are_as_they_are() {
    let lit = |kind: &str, intensity: f64, z: f64| {
        let nodes = format!(
            r#"[{{"mesh": 0}}, {{"translation": [0, 0, {z}], "extensions": {{"KHR_lights_punctual": {{"light": 0}}}}}}]"#
        );
        let more = format!(
            r#", "extensions": {{"KHR_lights_punctual": {{"lights": [{{"type": "{kind}", "intensity": {intensity}}}]}}}}"#
        );
        let reading = gltf(&nodes, "[0, 1]", &more, "");
        let said = told(&reading);
        (scene(reading).lights[0].color.r, said)
    };
    let (sun, said) = lit("directional", 6830.0, 0.0);
    assert!((sun - 1.0).abs() < 1e-6, "{sun}");
    assert!(said.contains("note: the lights would make all white, 2174 times over"), "{said}");
    let pi = std::f32::consts::PI;
    for (kind, intensity, z) in [("directional", 30.0, 0.0), ("point", 1000.0, 10.0)] {
        let (color, said) = lit(kind, intensity, z);
        assert!((color * pi / intensity as f32 - 1.0).abs() < 1e-5 && said.is_empty(), "{said}");
    }
    let (lamp, said) = lit("point", 54_351.0, 10.0);
    assert!(lamp < 54_351.0 / pi && said.contains("dimmed"), "{lamp} {said}");
}

#[test]
fn what_knows_its_up_or_has_none_is_not_asked_whether_it_is_z() {
    let relief = "v 0 0 0\nv 9 0 1\nv 9 7 0\nv 0 7 1\nf 1 2 3 4\n";
    let up = Framing::default();
    assert_eq!(scene(text("a.obj", relief)).frame(&up).len(), 1);
    let flat = "4\n\nC 0 0 0\nC 9 0 1\nC 9 7 0\nC 0 7 1\n";
    assert_eq!(scene(text("a.xyz", flat)).frame(&up), []);
    let mut of_gltf = scene(text("a.obj", relief));
    of_gltf.objects[0].place.file = "a.GLB".into();
    assert_eq!(of_gltf.frame(&up), []);
}
