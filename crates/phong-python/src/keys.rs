//! Tables of the scene text as Python says them: a kind and a dictionary of keys.
//!
//! They are written as text and read by the one reader of scene text, so that every key, default,
//! range and word of help is the text's own, and a new key needs nothing here.

use phong_scene::{Diagnostic, Format, Limits, Memory, Scene, Source, read};
use pyo3::exceptions::PyOverflowError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};
use toml::{Table, Value};

use crate::errors::{kind_of, scene_error, type_error, value_error};

/// Dictionaries and lists within one another, at most.
const MOST_DEPTH: usize = 16;

/// A table as Python says it: an object with a kind and its keys.
pub(crate) struct Said<'py> {
    /// The name of its table in the scene text.
    pub(crate) kind: String,
    /// Its keys and values.
    pub(crate) keys: Bound<'py, PyDict>,
    /// What it is called among others; `None`: nothing.
    pub(crate) name: Option<String>,
}

impl<'py> Said<'py> {
    /// An object of the package's own classes; `None`: it is something else.
    pub(crate) fn of(object: &Bound<'py, PyAny>) -> Option<Self> {
        let kind = object.getattr("_kind").ok()?.extract().ok()?;
        let keys = object.getattr("_keys").ok()?.cast_into().ok()?;
        let name = object.getattr("_name").ok().and_then(|name| name.extract().ok());
        Some(Self { kind, keys, name })
    }

    /// One that must be of this kind; `argument` is what errors call it.
    pub(crate) fn expect(object: &Bound<'py, PyAny>, kind: &str, argument: &str) -> PyResult<Self> {
        Self::of(object).filter(|said| said.kind == kind).ok_or_else(|| {
            let class = class_of(kind);
            type_error(format!("{argument} must be a phong.{class}, not {}", kind_of(object)))
        })
    }
}

/// Tables that are to be read together.
#[derive(Default)]
pub(crate) struct Text {
    document: Table,
    textures: Table,
}

impl Text {
    /// A value, with the textures that it is made of put among the tables.
    pub(crate) fn value(
        &mut self,
        value: &Bound<'_, PyAny>,
        key: &str,
        depth: usize,
    ) -> PyResult<Value> {
        if depth > MOST_DEPTH {
            return Err(value_error(format!("{key}: lists or dictionaries too deep")));
        }
        if let Some(said) = Said::of(value) {
            if said.kind != "texture" {
                return Err(type_error(format!("{key} cannot be a phong.{}", kind_of(value))));
            }
            let name = self.texture(&said)?;
            return Ok(Value::Table(Table::from_iter([("texture".to_owned(), name.into())])));
        }
        // A truth value is a whole number too, so it is asked for first.
        if let Ok(flag) = value.cast::<PyBool>() {
            return Ok(flag.is_true().into());
        }
        if value.is_instance_of::<PyInt>() {
            let number = value.extract::<i64>();
            return number.map(Value::Integer).map_err(|error| {
                if error.is_instance_of::<PyOverflowError>(value.py()) {
                    value_error(format!("{key} = {value}: the number is too large"))
                } else {
                    error
                }
            });
        }
        if let Ok(number) = value.cast::<PyFloat>() {
            return Ok(number.value().into());
        }
        if let Ok(text) = value.cast::<PyString>() {
            return Ok(text.to_cow()?.into_owned().into());
        }
        if let Ok(entries) = value.cast::<PyDict>() {
            let mut table = Table::new();
            for (name, value) in entries {
                let name: String =
                    name.extract().map_err(|_| type_error(format!("{key}: keys must be text")))?;
                // A texture stands by its name.
                let of_texture = name == "texture";
                let value =
                    match Said::of(&value).filter(|said| of_texture && said.kind == "texture") {
                        Some(said) => self.texture(&said)?.into(),
                        None => self.value(&value, key, depth + 1)?,
                    };
                table.insert(name, value);
            }
            return Ok(table.into());
        }
        if value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>() {
            let items = value.try_iter()?.map(|item| self.value(&item?, key, depth + 1));
            return Ok(Value::Array(items.collect::<PyResult<_>>()?));
        }
        // Arrays and numbers of numpy, paths, and whatever else knows how to become a number.
        if let Ok(plain) =
            value.call_method0("tolist").or_else(|_| value.call_method0("__fspath__"))
        {
            return self.value(&plain, key, depth + 1);
        }
        if let Ok(number) = value.extract::<f64>() {
            return Ok(number.into());
        }
        Err(type_error(format!("{key} cannot be a {}", kind_of(value))))
    }

    /// The keys of a table; those that are `None` are not said.
    pub(crate) fn table(&mut self, keys: &Bound<'_, PyDict>) -> PyResult<Table> {
        let mut table = Table::new();
        for (key, value) in keys {
            let key: String = key.extract().map_err(|_| type_error("keys must be text"))?;
            if !value.is_none() {
                let value = self.value(&value, &key, 0)?;
                table.insert(key, value);
            }
        }
        Ok(table)
    }

    fn texture(&mut self, said: &Said<'_>) -> PyResult<String> {
        let table = self.table(&said.keys)?;
        let name =
            said.name.clone().unwrap_or_else(|| format!("texture {}", self.textures.len() + 1));
        if self.textures.get(&name).is_some_and(|other| *other != Value::Table(table.clone())) {
            return Err(value_error(format!("two different textures are called {name:?}")));
        }
        self.textures.insert(name.clone(), table.into());
        Ok(name)
    }

    /// Puts in the one table of this name: `[name]`.
    pub(crate) fn put(&mut self, name: &str, table: impl Into<Value>) {
        self.document.insert(name.to_owned(), table.into());
    }

    /// Puts in a table of a list: `[[name]]`.
    pub(crate) fn push(&mut self, name: &str, table: Table) {
        let list = self.document.entry(name).or_insert_with(|| Value::Array(Vec::new()));
        if let Value::Array(list) = list {
            list.push(table.into());
        }
    }

    /// Puts in a table by a name: `[kind.name]`.
    pub(crate) fn name(&mut self, kind: &str, name: &str, table: Table) {
        let named = self.document.entry(kind).or_insert_with(|| Table::new().into());
        if let Value::Table(named) = named {
            named.insert(name.to_owned(), table.into());
        }
    }

    /// Textures that a table may name: those that it names are taken.
    pub(crate) fn know_textures(&mut self, known: Table, table: &Table) {
        let named = |name: &str| {
            let mut names = table.values().filter_map(|value| value.get("texture")?.as_str());
            names.any(|other| other == name)
        };
        for (name, texture) in known.into_iter().filter(|(name, _)| named(name)) {
            self.textures.entry(name).or_insert(texture);
        }
    }

    /// The scene of these tables with what is to be said of them, or what is wrong with them; `what`
    /// is what errors call it. Files that it names are opened in `files`.
    pub(crate) fn read(
        mut self,
        py: Python<'_>,
        what: &str,
        files: &dyn Source,
    ) -> PyResult<(Scene, Vec<Diagnostic>)> {
        self.put("version", 1);
        if !self.document.contains_key("camera") {
            let point = |z: f64| Value::Array(vec![0.0.into(), 0.0.into(), z.into()]);
            let camera = [("eye".to_owned(), point(1.0)), ("look_at".to_owned(), point(0.0))];
            self.put("camera", Table::from_iter(camera));
        }
        if !self.textures.is_empty() {
            let textures = std::mem::take(&mut self.textures);
            self.put("textures", textures);
        }
        let files = Overlaid { path: what.to_owned(), text: self.document.to_string(), files };
        let reading = read(what, Some(Format::Toml), &files, &Limits::default());
        let (unsound, mut said): (Vec<_>, Vec<_>) =
            reading.diagnostics.into_iter().map(placeless).partition(Diagnostic::is_error);
        let scene = reading.scene.ok_or_else(|| scene_error(py, &unsound))?;
        if !said.is_empty() {
            // That so small a scene has no lights or no objects is no news.
            let of_whole = scene.check();
            said.retain(|one| of_whole.iter().all(|other| other.message != one.message));
        }
        Ok((scene, said))
    }
}

/// The same at no line: the text was made here, and nobody has it.
fn placeless(mut diagnostic: Diagnostic) -> Diagnostic {
    if let Some(span) = &mut diagnostic.span {
        (span.place.line, span.place.column) = (0, 0);
    }
    diagnostic
}

/// The name of the class that stands for a table.
fn class_of(kind: &str) -> String {
    let mut letters = kind.chars();
    letters.next().map(|first| first.to_uppercase().chain(letters).collect()).unwrap_or_default()
}

/// One text before the files of another source.
#[derive(Debug)]
struct Overlaid<'a> {
    path: String,
    text: String,
    files: &'a dyn Source,
}

impl Source for Overlaid<'_> {
    fn open(&self, path: &str) -> std::io::Result<Box<dyn phong_scene::Blob>> {
        if path == self.path {
            return Memory::new().with(path, self.text.as_bytes()).open(path);
        }
        self.files.open(path)
    }
}

/// Says if a table is wrong in itself: a check as early as where it is made.
#[pyfunction]
pub(crate) fn check_keys(kind: &str, keys: &Bound<'_, PyDict>) -> PyResult<()> {
    let py = keys.py();
    let mut text = Text::default();
    let keys = keys.copy()?;
    let material = keys.get_item("material")?;
    if let Some(material) = material.filter(|_| kind != "material") {
        // It may be one of the scene's by name, and is a thing of its own otherwise.
        let is_one = material.is_instance_of::<PyString>()
            || Said::of(&material).is_some_and(|said| said.kind == "material");
        if !is_one {
            return Err(type_error(format!(
                "material must be a phong.Material or the name of one, not {}",
                kind_of(&material)
            )));
        }
        keys.del_item("material")?;
    }
    let table = text.table(&keys)?;
    let class = class_of(kind);
    match kind {
        "camera" | "image" => text.put(kind, table),
        "material" | "texture" => {
            // Textures that are named are those of the scene it will be in.
            for (_, value) in &table {
                if let Value::Table(by) = value
                    && let Some(Value::String(name)) = by.get("texture")
                {
                    let white = Table::from_iter([("kind".to_owned(), "checker".into())]);
                    text.know_textures(Table::from_iter([(name.clone(), white.into())]), &table);
                }
            }
            text.name(&format!("{kind}s"), kind, table);
        }
        _ => text.push(kind, table),
    }
    text.read(py, &class, &phong_scene::Folder).map(drop)
}
