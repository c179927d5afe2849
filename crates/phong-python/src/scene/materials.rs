//! Which material an argument means, and another one for what has one.

use std::path::Path;

use phong_scene::{
    Clip, Diagnostic, Folder, Material, MaterialId, Object, Scene as SceneText, Shape, Shared,
    SkyKind, Texture, TextureKind, closest,
};
use pyo3::prelude::*;
use pyo3::types::PyString;
use toml::{Table, Value};

use super::Scene;
use crate::arrays::neither;
use crate::errors::value_error;
use crate::keys::{Said, Text};
use crate::look::tables;
use crate::part::Part;
use crate::state::Subject;

impl Scene {
    /// The material that an argument means.
    pub(super) fn material(&self, given: Option<&Bound<'_, PyAny>>) -> PyResult<MaterialId> {
        let Some(given) = given.filter(|given| !given.is_none()) else {
            return Ok(self.state().default_material());
        };
        if let Ok(name) = given.cast::<PyString>() {
            let name = name.to_cow()?;
            let state = self.state();
            return state.material_named(&name).ok_or_else(|| {
                let names = state.scene.materials.iter().map(|material| material.name.as_str());
                let meant = closest(&name, names).map(|name| format!(": did you mean {name:?}?"));
                let meant = meant.unwrap_or_default();
                value_error(format!("material: the scene has none called {name:?}{meant}"))
            });
        }
        let said = Said::expect(given, "material", "material")?;
        let (material, textures, warnings) = self.read_material(given.py(), &said)?;
        let mut state = self.state();
        let number = state.material(&material, &textures);
        state.say(Subject::Material(number.0), warnings);
        Ok(number)
    }

    /// A material, the textures by which its own are numbered, and what is to be said of it.
    fn read_material(
        &self,
        py: Python<'_>,
        said: &Said<'_>,
    ) -> PyResult<(Material, Vec<Texture>, Vec<Diagnostic>)> {
        let name = said.name.clone().unwrap_or_else(|| "material".to_owned());
        let mut text = Text::default();
        let table = text.table(&said.keys)?;
        let is_textured = table.values().any(Value::is_table);
        if is_textured {
            let known = self.text()?.remove("textures");
            if let Some(Value::Table(known)) = known {
                text.know_textures(known, &table);
            }
        }
        text.name("materials", &name, table);
        // Something is made of it, or it would be told as unused: of textures something that has no numbers
        // for maps to find, which are those of the objects it will be of.
        let origin = || Value::Array(vec![0.0.into(); 3]);
        let (kind, shape) = if is_textured {
            let up = Value::Array(vec![0.0.into(), 1.0.into(), 0.0.into()]);
            ("plane", [("point", origin()), ("normal", up), ("material", name.clone().into())])
        } else {
            let radius = 1.0.into();
            (
                "sphere",
                [("center", origin()), ("radius", radius), ("material", name.clone().into())],
            )
        };
        text.push(kind, Table::from_iter(shape.map(|(key, value)| (key.to_owned(), value))));
        // What maps find is told when the scene is checked, and left out here as all of a whole scene is.
        let (read, warnings) = text.read(py, "Material", &Folder)?;
        let material = read.materials.into_iter().find(|material| material.name == name);
        Ok((material.unwrap_or_default(), read.textures, warnings))
    }

    /// All but its objects, as the tables of a text.
    pub(super) fn text(&self) -> PyResult<Table> {
        let mut framed = self.state().framed();
        // What the objects are called that a clip cuts is put in afterwards: they are not in this text.
        let cut = |clip: &mut Clip| std::mem::take(&mut clip.objects);
        let cut: Vec<Vec<String>> = framed.clips.iter_mut().map(cut).collect();
        for Texture { kind, place, .. } in &mut framed.textures {
            if let TextureKind::Image { file, .. } = kind {
                *file = beside(&place.file, file);
            }
        }
        if let Some(SkyKind::Image { file, place, .. }) =
            framed.sky.as_mut().map(|sky| &mut sky.kind)
        {
            *file = beside(&place.file, file);
        }
        let mut all = tables(SceneText { objects: Vec::new(), groups: Vec::new(), ..framed })?;
        let clips = all.get_mut("clip").and_then(Value::as_array_mut).into_iter().flatten();
        for (clip, names) in clips.zip(cut).filter(|(_, names)| !names.is_empty()) {
            let names: Vec<_> = names.into_iter().map(Value::from).collect();
            clip.as_table_mut().and_then(|clip| clip.insert("objects".to_owned(), names.into()));
        }
        Ok(all)
    }

    /// Gives a name or a part another material: in place where only the look changes.
    pub(super) fn give_material(
        &self,
        which: &Bound<'_, PyAny>,
        material: &Bound<'_, PyAny>,
    ) -> PyResult<()> {
        let number = if let Ok(name) = which.cast::<PyString>() {
            Some(self.material(Some(name.as_any()))?)
        } else {
            let part: Part = which
                .extract()
                .map_err(|_| neither("which", "the name of a material or a part", which))?;
            let place = self.place(&part)?;
            let old = self.state().scene.objects[place].material;
            let alone = {
                let state = self.state();
                let users = state.scene.all_objects().filter(|object| is_of(object, old)).count();
                let own = !matches!(&state.scene.objects[place].shape, Shape::Mesh(mesh) if !mesh.face_materials.is_empty());
                users == 1 && own
            };
            if !alone {
                let new = self.material(Some(material))?;
                let mut state = self.state();
                let object = &mut state.objects().objects[place];
                object.material = new;
                if let Shape::Mesh(mesh) = &mut object.shape {
                    mesh.face_materials = Shared::default();
                }
                return Ok(());
            }
            Some(old)
        };
        let Some(number) = number else { return Ok(()) };
        let (new, warnings) = if material.is_instance_of::<PyString>() {
            let other = self.material(Some(material))?;
            (self.state().scene.materials[other.0 as usize].clone(), Vec::new())
        } else {
            let said = Said::expect(material, "material", "material")?;
            let (material, textures, warnings) = self.read_material(material.py(), &said)?;
            (self.state().with_textures(&material, &textures), warnings)
        };
        let mut state = self.state();
        state.say(Subject::Material(number.0), warnings);
        let slot = &mut state.look().materials[number.0 as usize];
        let name = std::mem::take(&mut slot.name);
        *slot = Material { name, ..new };
        Ok(())
    }
}

/// Whether anything of an object is of a material.
fn is_of(object: &Object, material: MaterialId) -> bool {
    object.material_numbers().any(|number| number == material.0)
}

/// A file as it is found from the current folder, where a scene in another one names it.
fn beside(scene: &str, file: &str) -> String {
    let folder = Path::new(scene).parent().filter(|folder| !folder.as_os_str().is_empty());
    let joined = folder.map(|folder| folder.join(file));
    joined.and_then(|path| path.to_str().map(str::to_owned)).unwrap_or_else(|| file.to_owned())
}
