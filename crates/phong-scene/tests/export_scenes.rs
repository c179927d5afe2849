//! Scenes as glTF and as Tachyon files: what comes back, and what is told to be missing.

use glam::Vec3;
use phong_scene::{
    CameraKind, Cylinders, ExportOptions, Fog, FogKind, Format, Light, LightKind, Limits, Memory,
    Mesh, Object, Rgb, Scene, Shape, VertexColors, read,
};

const SCENE: &str = r#"version = 1
[image]
size = [320, 180]
background = [0.1, 0.2, 0.3]
[camera]
eye = [0, 1, 5]
look_at = [0, 0, 0]
fov = 50
[[light]]
kind = "point"
position = [3, 4, 5]
color = [1, 0.5, 0.25]
[[light]]
kind = "spot"
position = [0, 6, 0]
target = [0, 0, 0]
cone = 20
edge = 25
[materials.red]
model = "blinn-phong"
color = [0.8, 0.1, 0.1]
k_d = 1
shininess = 30
[[triangle]]
points = [[0, 0, 0], [1, 0, 0], [0, 1, 2]]
normals = [[0, 0, 1], [0, 0, 1], [0, 1, 1]]
material = "red"
[groups.two]
[[groups.two.triangle]]
points = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
[[instance]]
group = "two"
translate = [5, 0, 0]
[[instance]]
group = "two"
scale = 2
"#;

fn scene(more: &str) -> Scene {
    let files = Memory::new().with("a.toml", format!("{SCENE}{more}").into_bytes());
    let reading = read("a.toml", None, &files, &Limits::default());
    reading.scene.unwrap_or_else(|| panic!("{:?}", reading.diagnostics))
}

/// The scene that comes back, what is told to be missing, and what was mapped.
fn again(scene: Scene, format: Format, name: &str) -> (Scene, String, String) {
    let options = ExportOptions { format, ..ExportOptions::default() };
    let export = scene.export(&options, name).expect("files");
    let mut files = Memory::new();
    for file in &export.files {
        let mut bytes = Vec::new();
        file.write(&mut bytes).expect("memory");
        files = files.with(file.name.as_str(), bytes);
    }
    let reading = read(name, None, &files, &Limits::default());
    let scene = reading.scene.unwrap_or_else(|| panic!("{:?}", reading.diagnostics));
    let lines: Vec<String> = export.account.dropped.iter().map(|d| format!("{d}\n")).collect();
    (scene, lines.concat(), export.account.mapped.join("\n"))
}

#[test]
fn a_scene_comes_back_from_gltf_with_its_instances_camera_and_lights() {
    for name in ["b.glb", "b.gltf"] {
        let (back, dropped, mapped) = again(scene(""), Format::Gltf, name);
        assert_eq!(
            dropped,
            "warning: glTF holds no settings of a picture (`[image]`)\n\
             warning: glTF's lights fade with the square of the distance, other than 2 of the scene's\n"
        );
        assert!(mapped.contains("GGX with α² = 2/(n + 2)"), "{mapped}");
        assert!(
            matches!(back.camera.kind, CameraKind::Perspective { fov } if (fov - 50.0).abs() < 1e-6)
        );
        let bounds = back.bounds();
        assert!((bounds.max - glam::DVec3::new(6.0, 2.0, 2.0)).length() < 1e-6, "{}", bounds.max);
        let [lamp, spot] = &back.lights[..] else { panic!("{:?}", back.lights) };
        assert!((lamp.color.r - 1.0).abs() < 1e-5 && (lamp.color.b - 0.25).abs() < 1e-5);
        let (at, _) = (spot.kind.position().expect("a place"), spot.kind.direction());
        assert!((at - glam::DVec3::new(0.0, 6.0, 0.0)).length() < 1e-6);
        assert_eq!(back.groups.len(), 1);
        let red = back.materials.iter().find(|m| m.name == "red").expect("a material");
        assert_eq!(red.color, Rgb::new(0.8, 0.1, 0.1).into());
    }
}

#[test]
fn colours_that_multiply_their_materials_are_the_same_in_gltf_and_worked_in_elsewhere() {
    let mut scene = scene("");
    let red = scene.materials.iter_mut().find(|m| m.name == "red").expect("a material");
    red.vertex_colors = VertexColors::Multiply;
    let colors = [Rgb::new(1.0, 0.5, 0.25), Rgb::WHITE, Rgb::grey(0.5)];
    scene.objects[0].shape = Shape::from(Mesh {
        positions: [Vec3::ZERO, Vec3::X, Vec3::Y].into(),
        indices: [[0, 1, 2]].into(),
        colors: colors.into(),
        ..Mesh::default()
    });
    let seen = |scene: &Scene| {
        let Shape::Mesh(mesh) = &scene.objects[0].shape else { panic!("a mesh") };
        let number = mesh.face_materials.first().copied();
        let material = &scene.materials[number.unwrap_or(scene.objects[0].material.0) as usize];
        (mesh.colors.to_vec(), material.vertex_colors)
    };
    let (gltf, ..) = again(scene.clone(), Format::Gltf, "b.glb");
    assert_eq!(seen(&gltf), (colors.to_vec(), VertexColors::Multiply));
    let (obj, _, mapped) = again(scene.clone(), Format::Obj, "b.obj");
    assert!(mapped.contains("times the `color` of their material"), "{mapped}");
    let (worked_in, how) = seen(&obj);
    assert_eq!(how, VertexColors::Replace);
    for (color, written) in worked_in.into_iter().zip(colors) {
        let want = (written * Rgb::new(0.8, 0.1, 0.1)).to_array();
        let near = color.to_array().into_iter().zip(want).all(|(a, b)| (a - b).abs() < 1e-6);
        assert!(near, "{color:?}, not {want:?}");
    }
    scene.materials.iter_mut().for_each(|m| m.vertex_colors = VertexColors::Ignore);
    let (gltf, ..) = again(scene.clone(), Format::Gltf, "b.glb");
    assert_eq!(seen(&gltf).0, [Rgb::WHITE; 3]);
    let (obj, ..) = again(scene, Format::Obj, "b.obj");
    let written = seen(&obj).0;
    assert!(written.iter().take(3).all(|color| (color.r - 0.8).abs() < 1e-6), "{written:?}");
}

#[test]
fn a_light_comes_back_from_gltf_with_its_end() {
    let mut scene = scene("");
    scene.lights[1].range = Some(12.0);
    let (back, ..) = again(scene, Format::Gltf, "b.glb");
    let ranges: Vec<_> = back.lights.iter().map(|light| light.range).collect();
    assert_eq!(ranges, [None, Some(12.0)]);
}

#[test]
fn a_sky_that_tachyon_cannot_hold_is_told() {
    let (_, dropped, _) = again(scene("[sky]\ncolor = 0.5\n"), Format::Tachyon, "b.dat");
    assert!(dropped.contains("Tachyon holds no sky"), "{dropped}");
}

#[test]
fn what_gltf_cannot_hold_is_told() {
    let ball = "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\n";
    let (_, dropped, _) = again(scene(ball), Format::Gltf, "b.glb");
    assert!(dropped.contains("so 1 sphere is left out"), "{dropped}");
}

#[test]
fn a_mesh_that_shines_is_told_of_and_other_lights_are_written() {
    for (format, name, lights) in [(Format::Gltf, "b.glb", 2), (Format::Tachyon, "b.dat", 2)] {
        let mut scene = scene("");
        let kind = LightKind::Mesh { attenuation: [1.0, 0.0, 0.0] };
        let lamp = "lamp".to_owned();
        scene.lights.insert(1, Light { kind, object: lamp.clone(), ..Light::default() });
        let mesh = Mesh {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y].into(),
            indices: vec![[0, 1, 2]].into(),
            ..Mesh::default()
        };
        scene.objects.push(Object { name: lamp, ..Object::from(Shape::from(mesh)) });
        let (back, dropped, _) = again(scene, format, name);
        assert!(dropped.contains("that shine"), "{dropped}");
        assert_eq!(back.lights.len(), lights, "{name}");
    }
}

#[test]
fn steps_of_luminance_that_no_other_format_holds_are_told() {
    for (format, name) in [(Format::Gltf, "b.glb"), (Format::Tachyon, "b.dat")] {
        let mut stepped = scene("");
        stepped.image.cel = Some(3);
        let (_, dropped, _) = again(stepped, format, name);
        assert!(dropped.contains("no steps of luminance"), "{dropped}");
    }
}

#[test]
fn cylinders_of_two_radii_are_told_of_in_tachyon() {
    let mut scene = scene("");
    let segments = [[[0.0, 0.0, 0.0, 0.1], [1.0, 0.0, 0.0, 0.2]]].into();
    let cylinders = Cylinders { segments, ..Cylinders::default() };
    scene.objects.push(Object::from(Shape::Cylinders(cylinders.into())));
    let (_, dropped, _) = again(scene, Format::Tachyon, "b.dat");
    assert!(dropped.contains("1 of two are written with their mean"), "{dropped}");
}

#[test]
fn a_scene_comes_back_from_tachyon_as_it_was() {
    let more = "[fog]\nend = 20\ncolor = 0.5\n[[sphere]]\ncenter = [1, 2, 3]\nradius = 0.5\nmaterial = \"red\"\n\
                [[plane]]\npoint = [0, -1, 0]\nnormal = [0, 1, 0]\n\
                [[torus]]\ncenter = [0, 0, 0]\naxis = [0, 1, 0]\nradius = 1\ntube = 0.1\n";
    let (back, dropped, _) = again(scene(more), Format::Tachyon, "b.dat");
    assert!(dropped.contains("Tachyon holds no tori"), "{dropped}");
    assert!(
        matches!(back.camera.kind, CameraKind::Perspective { fov } if (fov - 50.0).abs() < 1e-4)
    );
    assert!((back.camera.eye - glam::DVec3::new(0.0, 1.0, 5.0)).length() < 1e-6);
    assert_eq!((back.image.size, back.image.samples), ([320, 180], 16));
    assert_eq!(back.lights.len(), 2);
    let kind = FogKind::Linear { start: 0.0, end: 20.0 };
    assert_eq!(back.fog, Some(Fog { kind, color: Some(Rgb::grey(0.5)), ..Fog::default() }));
    let ball = back.objects.iter().find_map(|object| match &object.shape {
        Shape::Points(points) => Some((points.spheres[0], object.material)),
        _ => None,
    });
    let (ball, material) = ball.expect("a sphere");
    assert_eq!(ball, [1.0, 2.0, 3.0, 0.5]);
    assert_eq!(back.materials[material.0 as usize].color, Rgb::new(0.8, 0.1, 0.1).into());
    let triangles = back.objects.iter().map(|object| match &object.shape {
        Shape::Mesh(mesh) => mesh.indices.len(),
        _ => 0,
    });
    assert_eq!(triangles.sum::<usize>(), 3);
}
