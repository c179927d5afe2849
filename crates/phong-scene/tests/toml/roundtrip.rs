//! What is written reads back to what it was written from.

use std::fs;
use std::path::Path;

use glam::{DVec3, Vec2, Vec3};
use phong_scene::{
    ExportOptions, Folder, Limits, MaterialId, Memory, Mesh, Object, Place, Scene, Shape, read,
};

use crate::{folder, summary};

/// A scene written as TOML, and read back from memory.
#[track_caller]
pub(crate) fn written_and_read(scene: Scene) -> (String, Scene) {
    let export = scene.export(&ExportOptions::default(), "out.toml").expect("a scene");
    let mut files = Memory::new();
    let mut text = String::new();
    for file in &export.files {
        let mut bytes = Vec::new();
        file.write(&mut bytes).expect("memory");
        if file.name == "out.toml" {
            text = String::from_utf8(bytes.clone()).expect("text");
        }
        files = files.with(file.name.as_str(), bytes);
    }
    let reading = read("out.toml", None, &files, &Limits::default());
    let errors: Vec<_> = reading.diagnostics.iter().filter(|d| d.is_error()).collect();
    assert!(errors.is_empty(), "{errors:?}\n{text}");
    (text, reading.scene.expect("a scene"))
}

/// Everything of a scene that can be seen, as text: without places, and with the corners of
/// triangles instead of the numbers that stand for them.
pub(crate) fn seen(mut scene: Scene) -> String {
    scene.lights.iter_mut().for_each(|light| light.place = Place::default());
    scene.clips.iter_mut().for_each(|clip| clip.place = Place::default());
    scene.furniture.labels.iter_mut().for_each(|label| label.place = Place::default());
    scene.materials.iter_mut().for_each(|material| material.place = Place::default());
    for texture in &mut scene.textures {
        texture.place = Place::default();
        // An image goes along under another name.
        if let phong_scene::TextureKind::Image { file, .. } = &mut texture.kind {
            file.clear();
        }
    }
    if let Some(phong_scene::SkyKind::Image { file, place, .. }) =
        scene.sky.as_mut().map(|sky| &mut sky.kind)
    {
        (*file, *place) = (String::new(), Place::default());
    }
    let in_groups = scene.groups.iter_mut().flat_map(|group| &mut group.objects);
    for object in scene.objects.iter_mut().chain(in_groups) {
        plain(object);
    }
    summary(&scene)
}

fn plain(object: &mut Object) {
    object.place = Place::default();
    let origin = match &mut object.shape {
        Shape::Instance(_) => {
            object.material = MaterialId(0); // its objects have their own
            DVec3::ZERO
        }
        Shape::Mesh(mesh) => {
            **mesh = corners(mesh);
            std::mem::take(&mut mesh.origin)
        }
        Shape::Points(points) => std::mem::take(&mut points.origin),
        Shape::Cylinders(cylinders) => std::mem::take(&mut cylinders.origin),
        _ => DVec3::ZERO,
    };
    object.transform.translation += object.transform.matrix3 * origin;
}

/// The mesh with every corner a vertex of its own.
fn corners(mesh: &Mesh) -> Mesh {
    let of = |own: &[[u32; 3]]| if own.is_empty() { mesh.indices.to_vec() } else { own.to_vec() };
    let normal = |i: u32| mesh.normals.get(i as usize).copied().unwrap_or(Vec3::ZERO);
    let uv = |i: u32| mesh.uvs.get(i as usize).copied().unwrap_or(Vec2::ZERO);
    let at = |i: u32| mesh.positions[i as usize];
    let color = |i: u32| mesh.colors.get(i as usize).copied();
    let (n, t) = (of(&mesh.normal_indices), of(&mesh.uv_indices));
    Mesh {
        origin: mesh.origin,
        positions: mesh.indices.iter().flatten().map(|&i| at(i)).collect(),
        normals: n.iter().flatten().map(|&i| normal(i)).collect(),
        uvs: t.iter().flatten().map(|&i| uv(i)).collect(),
        colors: mesh.indices.iter().flatten().filter_map(|&i| color(i)).collect(),
        face_materials: mesh.face_materials.clone(),
        ..Mesh::default()
    }
}

/// Writing and reading gives the same scene, and writing it again the same text.
#[track_caller]
pub(crate) fn assert_comes_back(scene: &Scene, what: &str) {
    let (text, back) = written_and_read(scene.clone());
    let (before, after) = (seen(scene.clone()), seen(back.clone()));
    if let Some((a, b)) = before.lines().zip(after.lines()).find(|(a, b)| a != b) {
        let same = a.chars().zip(b.chars()).take_while(|(a, b)| a == b).count();
        let around = |line: &str| line.chars().skip(same.saturating_sub(80)).take(200).collect();
        let [a, b]: [String; 2] = [a, b].map(around);
        panic!("{what}: … {a}\ncomes back as … {b}\nfrom\n{text}");
    }
    assert_eq!(before.lines().count(), after.lines().count(), "{what}:\n{text}");
    let (again, _) = written_and_read(back);
    assert!(text == again, "{what}: the same scene gives the same text");
}

#[test]
fn every_scene_of_the_gallery_comes_back() {
    let gallery = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let mut count = 0;
    for entry in fs::read_dir(gallery).expect("the gallery") {
        let path = entry.expect("an entry").path();
        if path.extension().is_some_and(|ending| ending == "toml") {
            let name = path.to_str().expect("a name");
            let scene = read(name, None, &Folder, &Limits::default()).scene.expect("a scene");
            assert_comes_back(&scene, name);
            count += 1;
        }
    }
    assert!(count >= 12);
}

#[test]
fn every_good_scene_of_these_tests_comes_back() {
    for entry in fs::read_dir(folder().join("good")).expect("the cases") {
        let path = entry.expect("an entry").path();
        // Of several materials a mesh becomes several meshes: below.
        let several = path.ends_with("a_model_brings_its_materials_unless_one_is_named.toml");
        if path.extension().is_some_and(|ending| ending == "toml") && !several {
            let name = path.to_str().expect("a name");
            let scene = read(name, None, &Folder, &Limits::default()).scene.expect("a scene");
            assert_comes_back(&scene, name);
        }
    }
}
