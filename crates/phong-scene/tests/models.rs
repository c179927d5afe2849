//! Model files in, summaries and diagnostics out.
//!
//! Beside every `NAME.obj`, `.mtl`, `.ply`, `.stl`, `.off` and `.gltf` lies `NAME.txt`: what reading it gives, as
//! text; beside files of atoms `NAME.ENDING.txt`.
//! `PHONG_BLESS=1` writes the texts anew.

mod differing;
mod mutated;

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use phong_scene::{
    Diagnostic, Limits, Material, Memory, Mesh, NO_INDEX, Object, Reading, Scene, Shape, read,
};

use differing::differing;

#[test]
fn obj_files_give_what_lies_beside_them() -> io::Result<()> {
    for_each("obj", |name, source| Ok(read(name, None, source, &Limits::default())))
}

#[test]
fn ply_files_give_what_lies_beside_them() -> io::Result<()> {
    for_each("ply", |name, source| Ok(read(name, None, source, &Limits::default())))
}

#[test]
fn stl_files_give_what_lies_beside_them() -> io::Result<()> {
    for_each("stl", |name, source| Ok(read(name, None, source, &Limits::default())))
}

#[test]
fn off_files_give_what_lies_beside_them() -> io::Result<()> {
    for_each("off", |name, source| Ok(read(name, None, source, &Limits::default())))
}

#[test]
fn files_of_atoms_give_what_lies_beside_them() -> io::Result<()> {
    for ending in ["xyz", "pdb", "pdbqt", "gro", "lammpstrj", "data", "cif"] {
        for_each_of("atoms", ending, |name, source| {
            Ok(read(name, None, source, &Limits::default()))
        })?;
    }
    Ok(())
}

#[test]
fn gltf_files_give_what_lies_beside_them() -> io::Result<()> {
    for_each("gltf", |name, source| Ok(read(name, None, source, &Limits::default())))
}

#[test]
fn tachyon_scenes_give_what_lies_beside_them() -> io::Result<()> {
    for_each_of("tachyon", "dat", |name, source| Ok(read(name, None, source, &Limits::default())))
}

#[test]
fn nff_scenes_give_what_lies_beside_them() -> io::Result<()> {
    for_each("nff", |name, source| Ok(read(name, None, source, &Limits::default())))
}

#[test]
fn mtl_files_give_what_lies_beside_them() -> io::Result<()> {
    for_each("mtl", |name, source| {
        // One triangle of each material.
        let bytes = fs::read(folder("mtl").join(name))?;
        let mut model = format!("mtllib {name}\nv 0 0 0\nv 1 0 0\nv 0 1 0\n");
        for line in String::from_utf8_lossy(&bytes).lines() {
            if let Some(name) = line.trim().strip_prefix("newmtl ") {
                model.extend(["usemtl ", name, "\nf 1 2 3\n"]);
            }
        }
        let source = source.clone().with("model.obj", model.into_bytes());
        Ok(read("model.obj", None, &source, &Limits::default()))
    })
}

fn folder(kind: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests").join(kind)
}

/// Reads every file of a kind among its neighbours, and compares.
fn for_each(kind: &str, read: impl Fn(&str, &Memory) -> io::Result<Reading>) -> io::Result<()> {
    for_each_of(kind, kind, read)
}

/// The same of the files in `kind` whose names end so.
fn for_each_of(
    kind: &str,
    wanted: &str,
    read: impl Fn(&str, &Memory) -> io::Result<Reading>,
) -> io::Result<()> {
    let mut source = Memory::new();
    let mut names = Vec::new();
    for entry in fs::read_dir(folder(kind))? {
        let entry = entry?;
        let (path, name) = (entry.path(), entry.file_name().to_string_lossy().into_owned());
        source = source.with(name.as_str(), fs::read(&path)?);
        if path.extension().is_some_and(|ending| ending == wanted) {
            names.push(name);
        }
    }
    names.sort();
    assert!(!names.is_empty());
    let bless = std::env::var_os("PHONG_BLESS").is_some();
    let mut wrong = Vec::new();
    for name in names {
        let reading = read(&name, &source)?;
        assert_eq!(reading.scene.is_none(), reading.diagnostics.iter().any(Diagnostic::is_error));
        let actual = tell(&reading);
        // Files of several endings may be called the same.
        let text = if kind == wanted { "txt".to_owned() } else { format!("{wanted}.txt") };
        let beside = folder(kind).join(&name).with_extension(text);
        let expected = fs::read_to_string(&beside).unwrap_or_default();
        if bless {
            fs::write(&beside, &actual)?;
        } else if actual != expected {
            wrong.push(format!("{name}: expected\n{expected}\nbut it is\n{actual}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
    Ok(())
}

fn tell(reading: &Reading) -> String {
    let mut text = Vec::new();
    for diagnostic in &reading.diagnostics {
        text.push(format!("{diagnostic}"));
        let Some(span) = diagnostic.span.as_ref().filter(|s| !s.excerpt.is_empty()) else {
            continue;
        };
        let before = span.excerpt[..span.range.start].chars().count();
        let meant = span.excerpt[span.range.clone()].chars().count().max(1);
        text.push(format!("    {}\n    {}{}", span.excerpt, " ".repeat(before), "^".repeat(meant)));
    }
    if let Some(scene) = &reading.scene {
        tell_scene(&mut text, scene);
        if !reading.bare {
            text.push(format!("{:?}", scene.camera));
            text.extend(scene.lights.iter().map(|light| {
                format!("{}: {:?} {:?}", light.name, light.kind, light.color.to_array())
            }));
            text.extend(
                scene.clips.iter().map(|clip| {
                    format!("clip: {:?} {:?} of {:?}", clip.kind, clip.cap, clip.objects)
                }),
            );
        }
    }
    text.iter().map(|line| line.trim_end().to_owned() + "\n").collect()
}

fn tell_scene(text: &mut Vec<String>, scene: &Scene) {
    for group in &scene.groups {
        text.push(format!("group {:?}", group.name));
        group.objects.iter().for_each(|object| tell_object(text, object, scene));
    }
    for object in &scene.objects {
        let bounds = scene.bounds();
        text.push(format!("{}: {} to {}", object.name, bounds.min, bounds.max));
        tell_object(text, object, scene);
    }
    // Material 0 is that of things without one.
    for material in &scene.materials[1..] {
        text.push(differing(material, &Material::default()));
    }
}

fn tell_object(text: &mut Vec<String>, object: &Object, scene: &Scene) {
    if object.transform != glam::DAffine3::IDENTITY {
        text.push(format!("  {:?}", object.transform.to_cols_array()));
    }
    if object.material.0 > 0 {
        text.push(format!("  of material {:?}", scene.materials[object.material.0 as usize].name));
    }
    match &object.shape {
        Shape::Mesh(mesh) => tell_mesh(text, mesh, &scene.materials),
        Shape::Points(points) => {
            text.push(format!("  origin {}", points.origin));
            for (i, sphere) in points.spheres.iter().take(8).enumerate() {
                let color =
                    points.colors.get(i).map_or(String::new(), |c| format!(" {:?}", c.to_array()));
                text.push(format!("  {sphere:?}{color}"));
            }
            text.push(format!("  {} in all", points.spheres.len()));
        }
        Shape::Cylinders(cylinders) => {
            text.push(format!("  origin {}, {:?}", cylinders.origin, cylinders.caps));
            for (i, ends) in cylinders.segments.iter().take(8).enumerate() {
                let colors =
                    cylinders.colors.get(i).map(|ends| ends.map(phong_scene::Rgb::to_array));
                let colors = colors.map_or(String::new(), |colors| format!(" {colors:?}"));
                text.push(format!("  {ends:?}{colors}"));
            }
            text.push(format!("  {} in all", cylinders.segments.len()));
        }
        other => text.push(format!("  {other:?}")),
    }
}

fn tell_mesh(text: &mut Vec<String>, mesh: &Mesh, materials: &[Material]) {
    text.push(format!("  origin {}", mesh.origin));
    let few = |count: usize| count.min(16);
    let index = |i: u32| if i == NO_INDEX { "-".to_owned() } else { i.to_string() };
    let list = |triangles: &[[u32; 3]]| {
        let triangle = |t: &[u32; 3]| t.map(index).join(" ");
        let shown = triangles[..few(triangles.len())].iter().map(triangle);
        let text = shown.collect::<Vec<_>>().join(", ");
        if text.is_empty() { "numbered like the positions".to_owned() } else { text }
    };
    text.push(format!(
        "  {} positions, {} triangles: {}",
        mesh.positions.len(),
        mesh.indices.len(),
        list(&mesh.indices)
    ));
    for (what, count, numbers) in [
        ("normals", mesh.normals.len(), &mesh.normal_indices),
        ("uvs", mesh.uvs.len(), &mesh.uv_indices),
    ] {
        if count > 0 {
            text.push(format!("  {count} {what}: {}", list(numbers)));
        }
    }
    for color in &mesh.colors[..few(mesh.colors.len())] {
        text.push(format!("  colour {:?}", color.to_array()));
    }
    let mut used = BTreeMap::new();
    for material in &mesh.face_materials {
        *used.entry(*material).or_insert(0) += 1;
    }
    for (material, count) in used {
        text.push(format!("  {count} of material {:?}", materials[material as usize].name));
    }
}

#[test]
fn where_there_is_no_scene_everything_there_is_to_say_is_the_error() {
    let source = Memory::new().with("broken.toml", b"version = 1\nsphere = 3\nlamp = 4\n".to_vec());
    let reading = read("broken.toml", None, &source, &Limits::default());
    let all = reading.diagnostics.clone();
    let error = reading.into_scene().err();
    assert!(all.len() > 1, "{all:?}");
    let lines = error.map(|error| error.to_string().lines().count());
    assert_eq!(lines, Some(all.len()));
}
