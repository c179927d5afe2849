//! What is laid over a scene without building it anew: camera, lights, materials, textures, ambient
//! light, and the picture's own settings.
//!
//! A scene without its objects is written as a text of its own, and values are laid over that by the
//! reader, as `--set` lays them over the scene's own text. So a value means the same here and there,
//! is held against the same table, and nothing of a large model is read again.

use std::collections::BTreeMap;
use std::sync::Arc;

use phong::geometry::Geometry;
use phong::glam::DVec3;
use phong::image::srgb_level;
use phong::scene::{
    Change, Diagnostic, ExportOptions, Limits, Memory, Param, Rgb, Scene, SceneError, SkyKind,
    Texels, TextureKind, read_changed,
};
use serde_json::{Map, Value, json};

use super::Bounds;

/// A scene that could be read.
#[derive(Debug)]
pub(super) struct Base {
    pub(super) scene: Scene,
    pub(super) geometry: Arc<Geometry>,
    /// All but the objects as a text of its own, which values are laid over.
    pub(super) look: String,
    /// A file for each image that the text names.
    pub(super) stand_ins: Memory,
    /// What was laid over the objects when they were read.
    pub(super) laid: Map<String, Value>,
    /// The objects' middles; empty where there are too many to take hold of.
    pub(super) middles: Vec<DVec3>,
}

/// What the text of a look is called where something is said about it.
const NAME: &str = "scene.toml";

/// What can be laid over a scene, by the first word of its keys.
const PARTS: [&str; 18] = [
    "image",
    "camera",
    "ambient",
    "ambient_occlusion",
    "sky",
    "fog",
    "clip",
    "outline",
    "furniture",
    "title",
    "scale_bar",
    "axes",
    "legend",
    "label",
    "tone",
    "light",
    "materials",
    "textures",
];

/// Objects, by the first word of their keys. What is laid over them is more work: the text is read
/// with it.
const OBJECTS: [&str; 13] = [
    "sphere",
    "plane",
    "triangle",
    "disc",
    "box",
    "cylinder",
    "cone",
    "torus",
    "mesh",
    "points",
    "cylinders",
    "molecule",
    "instance",
];

/// Whether a key is one of the look.
pub(super) fn is_of_look(path: &str) -> bool {
    PARTS.contains(&path.split('.').next().unwrap_or_default())
}

/// Whether a key is one that values are laid over.
pub(super) fn allowed(path: &str) -> Result<(), String> {
    let first = path.split('.').next().unwrap_or_default();
    if is_of_look(path) || OBJECTS.contains(&first) {
        return Ok(());
    }
    let parts = PARTS.join(", ");
    Err(format!(
        "`{path}` is changed in the text; over it are laid keys of {parts}, and of objects"
    ))
}

/// All of a scene but its objects, as text.
pub(super) fn text(scene: &Scene) -> Result<String, String> {
    let mut bare = Scene { objects: Vec::new(), groups: Vec::new(), ..scene.clone() };
    // The objects that they name are not there.
    bare.clips.iter_mut().for_each(|clip| clip.objects.clear());
    for (number, texture) in bare.textures.iter_mut().enumerate() {
        if let TextureKind::Image { file, .. } = &mut texture.kind {
            *file = image_file(number);
        }
    }
    if let Some(SkyKind::Image { file, .. }) = bare.sky.as_mut().map(|sky| &mut sky.kind) {
        SKY_FILE.clone_into(file);
    }
    let options = ExportOptions { images: false, ..ExportOptions::default() };
    let export = bare.export(&options, NAME);
    let export = export.map_err(|diagnostic| diagnostic.message.clone())?;
    export.text().map_err(|error| error.to_string())
}

/// A small file for each image of a scene, by the name that its text has: nothing is encoded anew at each
/// change, and what the values of a texture may be is judged as of the image itself.
pub(super) fn stand_ins(scene: &Scene) -> Result<Memory, String> {
    let mut files = Memory::new();
    for (number, texture) in scene.textures.iter().enumerate() {
        if let TextureKind::Image { texels, .. } = &texture.kind {
            let bytes = texels.stand_in().map_err(|error| error.to_string())?;
            files = files.with(image_file(number), bytes);
        }
    }
    if let Some(SkyKind::Image { texels, .. }) = scene.sky.as_ref().map(|sky| &sky.kind) {
        let bytes = texels.stand_in().map_err(|error| error.to_string())?;
        files = files.with(SKY_FILE, bytes);
    }
    Ok(files)
}

/// What the image of the sky is called in the text of a look.
const SKY_FILE: &str = "image-sky.png";

/// What the image of a texture is called in the text of a look.
fn image_file(texture: usize) -> String {
    format!("image-{texture}.png")
}

/// Puts the images of a scene in the place of what stood for them.
fn give_images_back(scene: &mut Scene, own: &Scene) {
    let images = own.textures.iter().enumerate().filter_map(|(number, texture)| {
        let TextureKind::Image { file, texels, .. } = &texture.kind else { return None };
        Some((image_file(number), (file, texels)))
    });
    if let (Some(sky), Some(own)) = (&mut scene.sky, &own.sky)
        && let SkyKind::Image { file, place, texels, .. } = &mut sky.kind
        && let SkyKind::Image { file: own_file, place: own_place, texels: own_texels, .. } =
            &own.kind
        && file == SKY_FILE
    {
        file.clone_from(own_file);
        place.clone_from(own_place);
        texels.clone_from(own_texels);
    }
    let images: BTreeMap<String, (&String, &Arc<Texels>)> = images.collect();
    for texture in &mut scene.textures {
        if let TextureKind::Image { file, texels, .. } = &mut texture.kind
            && let Some((own_file, own_texels)) = images.get(file)
        {
            file.clone_from(own_file);
            texels.clone_from(own_texels);
        }
    }
}

/// The scene, without its objects, with these values laid over it; and all its values by their keys.
pub(super) fn laid_over(base: &Base, set: &Map<String, Value>) -> Result<(Scene, Value), String> {
    let of_look = set.iter().filter(|(path, _)| is_of_look(path));
    let of_look = of_look.map(|(path, value)| (path.clone(), value.clone())).collect();
    let changes: Result<Vec<Change>, String> =
        changes(&of_look).map(|words| Change::parse(&words)).collect();
    let files = base.stand_ins.clone().with(NAME, base.look.as_bytes());
    let reading = read_changed(NAME, None, &files, &small(), &changes?);
    let mut scene = reading.into_scene().map_err(|error| first_error(&error))?;
    let (lights, materials) = (&base.scene.lights, &base.scene.materials);
    if (scene.lights.len(), scene.materials.len()) != (lights.len(), materials.len()) {
        return Err("lights and materials are added in the text".to_owned());
    }
    // Places and names are those of the scene's own text.
    for (light, written) in scene.lights.iter_mut().zip(lights) {
        light.place.clone_from(&written.place);
    }
    for (clip, written) in scene.clips.iter_mut().zip(&base.scene.clips) {
        clip.place.clone_from(&written.place);
        clip.objects.clone_from(&written.objects);
    }
    give_images_back(&mut scene, &base.scene);
    for (material, written) in scene.materials.iter_mut().zip(materials) {
        material.place.clone_from(&written.place);
        material.name.clone_from(&written.name);
    }
    let text = text(&scene)?;
    let values: toml::Table = toml::from_str(&text).map_err(|error| error.to_string())?;
    let values = serde_json::to_value(values).map_err(|error| error.to_string())?;
    Ok((scene, values))
}

/// What the first error of a reading says.
pub(super) fn first_error(SceneError(said): &SceneError) -> String {
    let error = said.iter().find(|diagnostic| diagnostic.is_error());
    error.map_or_else(String::new, in_short)
}

pub(super) fn in_short(diagnostic: &Diagnostic) -> String {
    match &diagnostic.help {
        Some(help) => format!("{} ({help})", diagnostic.message),
        None => diagnostic.message.clone(),
    }
}

/// What is laid over a scene as `KEY=VALUE`, each as `--set` takes it.
pub(super) fn changes(set: &Map<String, Value>) -> impl Iterator<Item = String> {
    set.iter().map(|(path, value)| format!("{path}={}", as_toml(value)))
}

/// A value as TOML.
fn as_toml(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::Bool(_) | Value::Number(_) => value.to_string(),
        Value::String(text) => toml::Value::String(text.clone()).to_string(),
        Value::Array(values) => {
            let values: Vec<String> = values.iter().map(as_toml).collect();
            format!("[{}]", values.join(", "))
        }
        Value::Object(values) => {
            let key = |key: &str| toml::Value::String(key.to_owned()).to_string();
            let values: Vec<String> = values
                .iter()
                .map(|(k, value)| format!("{} = {}", key(k), as_toml(value)))
                .collect();
            format!("{{ {} }}", values.join(", "))
        }
    }
}

/// The colours of lights, materials and the ambient light, as `#rrggbb`; those that a texture gives
/// are left out.
pub(super) fn wells(scene: &Scene) -> Map<String, Value> {
    let mut wells = Map::new();
    let mut put = |path: String, color: Rgb| {
        let [r, g, b] = color.to_array().map(srgb_level);
        wells.insert(path, json!(format!("#{r:02x}{g:02x}{b:02x}")));
    };
    put("ambient.color".to_owned(), scene.ambient);
    for (i, light) in scene.lights.iter().enumerate() {
        put(format!("light.{}.color", i + 1), light.color);
        put(format!("light.{}.specular_color", i + 1), light.specular_color);
    }
    for material in &scene.materials {
        let color = material.color.constant();
        // What is not said is as the reader takes it: the material's own colour.
        let or_own = |c: Option<Param<Rgb>>| c.map_or(color, Param::constant);
        for (key, color) in [
            ("color", color),
            ("ambient_color", or_own(material.ambient_color)),
            ("specular_color", or_own(material.specular_color)),
            ("emission_color", or_own(material.emission_color)),
            ("reflection", material.reflection.constant()),
            ("transmission", material.transmission.constant()),
        ] {
            if let Some(color) = color {
                put(format!("materials.{}.{key}", material.name), color);
            }
        }
    }
    wells
}

/// What reading a small text of our own making may use.
fn small() -> Limits {
    Limits { text_bytes: Bounds::TEXT, ..Limits::default() }
}
