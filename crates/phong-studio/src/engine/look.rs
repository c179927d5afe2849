//! What is laid over a scene without building it anew: camera, lights, materials, textures, ambient
//! light, and the picture's own settings.
//!
//! A scene without its objects is written as a text of its own, and values are laid over that by the
//! reader, as `--set` lays them over the scene's own text. So a value means the same here and there,
//! is held against the same table, and nothing of a large model is read again.

use phong::camera::Camera;
use phong::glam::{DQuat, DVec3};
use phong::image::srgb_level;
use phong::math::wide;
use phong::scene::{
    CameraKind, Change, Diagnostic, ExportOptions, Memory, Param, Rgb, Scene, SceneError,
    read_changed,
};
use serde_json::{Map, Value, json};

use super::opened::{Base, Opened, small};

/// What the text of a look is called where something is said about it.
const NAME: &str = "scene.toml";

/// What can be laid over a scene, by the first word of its keys.
const PARTS: [&str; 6] = ["image", "camera", "ambient", "light", "materials", "textures"];

/// Whether a key is one of the look.
pub(super) fn allowed(path: &str) -> Result<(), String> {
    let first = path.split('.').next().unwrap_or_default();
    if PARTS.contains(&first) {
        return Ok(());
    }
    Err(format!("`{path}` is changed in the text; over it are laid keys of {}", PARTS.join(", ")))
}

/// All of a scene but its objects, as text.
pub(super) fn text(scene: &Scene) -> Result<String, String> {
    let Scene { image, camera, ambient, lights, materials, textures, objects: _, groups: _ } =
        scene.clone();
    let bare = Scene {
        image,
        camera,
        ambient,
        lights,
        materials,
        textures,
        objects: Vec::new(),
        groups: Vec::new(),
    };
    let export = bare.export(&ExportOptions::default(), NAME);
    let export = export.map_err(|diagnostic| diagnostic.message.clone())?;
    let mut text = Vec::new();
    let file = export.files.first().ok_or("the scene has no text")?;
    file.write(&mut text).map_err(|error| error.to_string())?;
    String::from_utf8(text).map_err(|error| error.to_string())
}

/// The scene, without its objects, with these values laid over it; and all its values by their keys.
pub(super) fn laid_over(base: &Base, set: &Map<String, Value>) -> Result<(Scene, Value), String> {
    let changes: Result<Vec<Change>, String> =
        changes(set).map(|words| Change::parse(&words)).collect();
    let files = Memory::new().with(NAME, base.look.as_bytes());
    let reading = read_changed(NAME, None, &files, &small(), &changes?);
    let mut scene = reading.into_scene().map_err(|SceneError(said)| {
        let error = said.iter().find(|diagnostic| diagnostic.is_error());
        error.map_or_else(String::new, in_short)
    })?;
    let (lights, materials) = (&base.scene.lights, &base.scene.materials);
    if (scene.lights.len(), scene.materials.len()) != (lights.len(), materials.len()) {
        return Err("lights and materials are added in the text".to_owned());
    }
    // Places and names are those of the scene's own text.
    for (light, written) in scene.lights.iter_mut().zip(lights) {
        light.place.clone_from(&written.place);
    }
    for (material, written) in scene.materials.iter_mut().zip(materials) {
        material.place.clone_from(&written.place);
        material.name.clone_from(&written.name);
    }
    let text = text(&scene)?;
    let values: toml::Table = toml::from_str(&text).map_err(|error| error.to_string())?;
    let values = serde_json::to_value(values).map_err(|error| error.to_string())?;
    Ok((scene, values))
}

fn in_short(diagnostic: &Diagnostic) -> String {
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

/// How near to looking straight up or down the eye may be turned, degrees.
const POLE: f64 = 2.0;

impl Opened {
    fn camera(&self) -> Result<phong::scene::Camera, String> {
        Ok(laid_over(self.base()?, self.set())?.0.camera)
    }

    fn place(&mut self, eye: DVec3, look_at: DVec3) -> Result<(), String> {
        let list = |v: DVec3| json!(v.to_array());
        let values = [("camera.eye", list(eye)), ("camera.look_at", list(look_at))];
        self.lay(values.into_iter().map(|(path, value)| (path.to_owned(), value)).collect())
    }

    /// Turns the eye about the point that is looked at; a camera that looks around turns about itself.
    pub(super) fn turn(&mut self, by: [f64; 2]) -> Result<(), String> {
        let [right, down] = finite(by)?;
        let camera = self.camera()?;
        let around = matches!(camera.kind, CameraKind::Fisheye { .. } | CameraKind::Panorama);
        let (center, moved) =
            if around { (camera.eye, camera.look_at) } else { (camera.look_at, camera.eye) };
        let up = camera.up.normalize_or(DVec3::Y);
        let offset = moved - center;
        let side = up.cross(offset).normalize_or(up.any_orthonormal_vector());
        let half_turn = std::f64::consts::PI;
        let height = wide::acos((offset.normalize_or(up).dot(up)).clamp(-1.0, 1.0));
        let pole = POLE.to_radians();
        let wanted = (height - down * half_turn).clamp(pole, half_turn - pole);
        let tilt = rotation(side, wanted - height);
        let offset = rotation(up, -right * half_turn) * (tilt * offset);
        if around {
            self.place(center, center + offset)
        } else {
            self.place(center + offset, center)
        }
    }

    /// Moves the eye and `look_at` across the view, so that the scene follows the pointer.
    pub(super) fn shift(&mut self, by: [f64; 2]) -> Result<(), String> {
        let [right, down] = finite(by)?;
        let camera = self.camera()?;
        let ready = Camera::new(&camera);
        let forward = (camera.look_at - camera.eye).normalize_or(-DVec3::Z);
        let x = forward.cross(camera.up).normalize_or(forward.any_orthonormal_vector());
        let y = x.cross(forward);
        // A picture of one pixel: places in it are heights.
        let middle = ready.place(camera.look_at, [1, 1]);
        let beside = ready.place(camera.look_at + x, [1, 1]);
        let unit = match (middle, beside) {
            (Some(middle), Some(beside)) => (beside - middle).length(),
            _ => 1.0 / (camera.look_at - camera.eye).length(),
        };
        let way = (y * down - x * right) / unit;
        self.place(camera.eye + way, camera.look_at + way)
    }

    /// Brings the eye nearer or further away.
    pub(super) fn zoom(&mut self, by: f64) -> Result<(), String> {
        if !(by.is_finite() && by > 0.0) {
            return Err("a zoom is by a number above 0".to_owned());
        }
        let camera = self.camera()?;
        if let CameraKind::Orthographic { height } = camera.kind {
            let set = [("camera.height".to_owned(), json!(height * by))];
            return self.lay(set.into_iter().collect());
        }
        self.place(camera.look_at + (camera.eye - camera.look_at) * by, camera.look_at)
    }
}

fn finite(by: [f64; 2]) -> Result<[f64; 2], String> {
    if by.iter().all(|n| n.is_finite() && n.abs() <= 100.0) {
        Ok(by)
    } else {
        Err("a turn or a move is by at most 100".to_owned())
    }
}

/// By an angle about a unit axis. (glam's own takes the platform's sine.)
fn rotation(axis: DVec3, angle: f64) -> DQuat {
    let (sin, cos) = wide::sin_cos(angle / 2.0);
    let v = axis * sin;
    DQuat::from_xyzw(v.x, v.y, v.z, cos)
}
