//! Scenes in, what was understood out; faulty scenes in, what is said of them out.
//!
//! `good/NAME.toml` is a scene and `good/NAME.txt` a summary of it; `bad/NAME.toml` is a scene
//! with something to say about it and `bad/NAME.txt` all of that. Folders beside them hold what
//! the scenes include. `PHONG_BLESS=1 cargo test -p phong-scene --test toml` writes the texts.

mod cases;
mod choices;
#[path = "../differing/mod.rs"]
mod differing;
mod docs;
mod generated;
mod hostile;
mod images;
mod roundtrip;
mod schema;
mod told;

use std::fs;
use std::path::{Path, PathBuf};

use phong_scene::{
    Camera, Folder, Furniture, Image, Light, Limits, Material, Mesh, Object, Points, Reading,
    Scene, Shape, Texture, read,
};

use crate::differing::differing;

/// Reads a scene of this folder, as if from within it, so that no path of this machine shows.
fn read_case(path: &Path) -> Reading {
    std::env::set_current_dir(folder()).expect("the tests' folder");
    read(path.to_str().expect("a name"), None, &Folder, &Limits::default())
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/toml")
}

/// Holds what is now against what is written; with `PHONG_BLESS=1` writes it.
fn assert_text(path: &Path, now: &str) {
    if std::env::var_os("PHONG_BLESS").is_some_and(|v| v == "1") {
        fs::write(path, now).expect("the text is written");
        return;
    }
    let written = fs::read_to_string(path).unwrap_or_default();
    assert!(written == now, "{} is not what is said now:\n{now}", path.display());
}

fn good(name: &str) {
    let path = Path::new("good").join(name).with_extension("toml");
    let reading = read_case(&path);
    assert_eq!(told::all(&reading.diagnostics), "", "a good scene leaves nothing to say");
    let scene = reading.scene.expect("a scene");
    assert_text(&path.with_extension("txt"), &summary(&scene));
}

fn bad(name: &str) {
    let path = Path::new("bad").join(name).with_extension("toml");
    let reading = read_case(&path);
    assert!(!reading.diagnostics.is_empty(), "a bad scene has something to be told");
    let wrong = reading.diagnostics.iter().any(phong_scene::Diagnostic::is_error);
    assert_eq!(reading.scene.is_none(), wrong, "no scene exactly if something is wrong");
    assert_text(&path.with_extension("txt"), &told::all(&reading.diagnostics));
}

/// Everything in a scene that is not as by default, a line a thing.
fn summary(scene: &Scene) -> String {
    let Scene {
        image,
        camera,
        ambient,
        ambient_occlusion,
        sky,
        fog,
        outline,
        furniture,
        tone,
        clips,
        lights,
        materials,
        textures,
        objects,
        groups,
    } = scene;
    let mut lines = vec![
        differing(image, &Image::default()),
        differing(camera, &Camera::default()),
        format!("ambient {ambient:?}"),
    ];
    lines.extend(sky.iter().map(|sky| format!("{sky:?}")));
    lines.extend(fog.map(|fog| format!("{fog:?}")));
    lines.extend(outline.map(|outline| format!("{outline:?}")));
    if *furniture != Furniture::default() {
        lines.push(format!("{furniture:?}"));
    }
    lines.extend(tone.map(|tone| format!("{tone:?}")));
    lines.extend(clips.iter().map(|clip| format!("{clip:?}")));
    lines.extend(ambient_occlusion.map(|occlusion| format!("{occlusion:?}")));
    lines.extend(lights.iter().map(|light| differing(light, &Light::default())));
    lines.extend(materials.iter().map(|material| differing(material, &Material::default())));
    lines.extend(textures.iter().map(|texture| differing(texture, &Texture::default())));
    lines.extend(objects.iter().map(object_line));
    for group in groups {
        lines.push(format!("group {}", group.name));
        lines.extend(group.objects.iter().map(|object| format!("    {}", object_line(object))));
    }
    lines.join("\n") + "\n"
}

fn object_line(object: &Object) -> String {
    let Object { name, shape, material, transform, place } = object;
    let still = *transform == glam::DAffine3::IDENTITY;
    let moved = if still { String::new() } else { format!(" moved by {transform:?}") };
    let shape = match shape {
        Shape::Mesh(mesh) => differing(&**mesh, &Mesh::default()),
        Shape::Points(points) => differing(&**points, &Points::default()),
        shape => format!("{shape:?}"),
    };
    format!("{name} at {place} of material {}{moved}: {shape}", material.0)
}
