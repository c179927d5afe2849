//! Tables of a scene that stand alone: fog, ambient occlusion, clips, and what else there is beside picture,
//! camera, lights and materials.

use phong_scene::{Cap, Folder, Place, Scene as SceneText};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use toml::{Table, Value};

use super::Scene;
use crate::errors::{type_error, value_error};
use crate::keys::Text;
use crate::state::{State, Subject};

/// Tables that are said in another way.
const OTHERS: [&str; 7] =
    ["version", "image", "camera", "ambient", "light", "materials", "textures"];

impl Scene {
    /// The tables that stand alone, as the scene has them.
    pub(super) fn settings(&self) -> PyResult<Table> {
        let tables = self.text()?;
        Ok(tables.into_iter().filter(|(name, _)| !OTHERS.contains(&name.as_str())).collect())
    }

    /// Puts tables in the place of the scene's own; `None` takes one away.
    pub(super) fn change_settings(&self, settings: &Bound<'_, PyDict>) -> PyResult<()> {
        let mut text = Text::default();
        let mut tables = self.settings()?;
        for (name, value) in settings {
            let name: String = name.extract().map_err(|_| type_error("settings must be text"))?;
            if OTHERS.contains(&name.as_str()) {
                return Err(value_error(format!("{name} is no setting: see phong.Scene")));
            }
            if value.is_none() {
                tables.remove(&name);
            } else {
                let value = text.value(&value, &name, 0)?;
                tables.insert(name, value);
            }
        }
        for clip in tables.get("clip").and_then(Value::as_array).into_iter().flatten() {
            stand_in(&self.state(), clip, &mut text);
        }
        for (name, value) in tables {
            text.put(&name, value);
        }
        let (mut read, said) = text.read(settings.py(), "settings", &Folder)?;
        let mut state = self.state();
        for clip in &mut read.clips {
            clip.place = Place::default();
            if let Cap::Of(material) = &mut clip.cap {
                let name = &read.materials[material.0 as usize].name;
                *material = state.material_named(name).unwrap_or_default();
            }
        }
        state.say(Subject::Settings, said);
        // Which objects are closed is looked for where a clip asks.
        let is_cut_anew = state.scene.clips != read.clips;
        let scene = if is_cut_anew { state.objects() } else { state.look() };
        // What a scene gains beside these is a setting.
        let SceneText {
            image, camera, ambient, lights, materials, textures, objects, groups, ..
        } = std::mem::take(scene);
        *scene = SceneText {
            image,
            camera,
            ambient,
            lights,
            materials,
            textures,
            objects,
            groups,
            ..read
        };
        Ok(())
    }
}

/// Puts spheres into a text in the place of those of the scene's objects and materials that a clip names.
fn stand_in(state: &State, clip: &Value, text: &mut Text) {
    let mut sphere = |name: &str, material: Option<&str>| {
        let center = Value::Array(vec![0.0.into(), 0.0.into(), 0.0.into()]);
        let mut table = Table::from_iter([
            ("name".to_owned(), name.into()),
            ("center".to_owned(), center),
            ("radius".to_owned(), 1.0.into()),
        ]);
        if let Some(material) = material {
            text.name("materials", material, Table::new());
            table.insert("material".to_owned(), material.into());
        }
        text.push("sphere", table);
    };
    for name in clip.get("objects").and_then(Value::as_array).into_iter().flatten() {
        let Some(name) = name.as_str() else { continue };
        let top = name.split(" / ").next().unwrap_or_default();
        if state.scene.objects.iter().any(|object| object.name == top || object.name == name) {
            sphere(name, None);
        }
    }
    let cap = clip.get("cap").and_then(Value::as_str);
    if let Some(cap) = cap.filter(|cap| state.material_named(cap).is_some()) {
        sphere("cap", Some(cap));
    }
}
