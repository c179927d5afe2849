//! What is open: a scene's text, the last of it that could be read, and what is laid over that.

use std::io;
use std::sync::Arc;

use phong::geometry::{Geometry, GeometryOptions};
use phong::look::Look;
use phong::scene::{Blob, Diagnostic, Format, Image, Memory, Scene, Source, read, trouble};
use phong::view::View;
use phong_lab::tell;
use serde_json::{Map, Value};

use super::Bounds;
use super::look::{self, Base};

/// A scene or a model.
#[derive(Debug)]
pub(super) struct Opened {
    path: String,
    /// `None`: a bare model has no text.
    text: Option<String>,
    diagnostics: Vec<Diagnostic>,
    /// Whether the text as it is now could be read.
    is_sound: bool,
    /// The last that could be read.
    base: Option<Base>,
    /// What is laid over it, by the paths of keys.
    set: Map<String, Value>,
}

/// What a picture shows.
#[derive(Debug)]
pub(super) struct Shown {
    pub(super) view: View,
    pub(super) image: Image,
    /// All but the objects, by the keys of the text.
    pub(super) values: Value,
    /// Its colours, as `#rrggbb`.
    pub(super) wells: Map<String, Value>,
}

impl Opened {
    /// Reads a file; with it goes its text.
    pub(super) fn of_file(
        path: &str,
        source: &dyn Source,
        bounds: &Bounds,
    ) -> Result<(Self, Option<String>), String> {
        let text = match Format::of_path(path) {
            Some(Format::Toml) => Some(text_of(path, source, bounds)?),
            _ => None,
        };
        let (diagnostics, is_sound) = (Vec::new(), false);
        let (path, set) = (path.to_owned(), Map::new());
        let mut opened = Self { path, text: text.clone(), diagnostics, is_sound, base: None, set };
        opened.read(source, bounds)?;
        match opened.diagnostics.iter().find(|diagnostic| diagnostic.is_error()) {
            // A text can be mended in the page; a model cannot.
            Some(error) if text.is_none() => Err(error.message.clone()),
            _ => Ok((opened, text)),
        }
    }

    /// Takes another text.
    pub(super) fn edit(
        &mut self,
        text: String,
        source: &dyn Source,
        bounds: &Bounds,
    ) -> Result<(), String> {
        if self.text.is_none() {
            return Err("a bare model has no text to edit".to_owned());
        }
        self.text = Some(text);
        self.read(source, bounds)?;
        // What is laid over the scene may name what is no longer there.
        if self.is_sound && self.shown().is_err() {
            self.set.clear();
        }
        Ok(())
    }

    fn read(&mut self, source: &dyn Source, bounds: &Bounds) -> Result<(), String> {
        let reading = match &self.text {
            Some(text) => {
                let edited = Edited { path: &self.path, text, source };
                read(&self.path, None, &edited, &bounds.limits)
            }
            None => read(&self.path, None, source, &bounds.limits),
        };
        self.diagnostics = reading.diagnostics;
        self.is_sound = false;
        let Some(scene) = reading.scene else { return Ok(()) };
        let options =
            GeometryOptions { max_bytes: Some(bounds.bytes), ..GeometryOptions::default() };
        let geometry = Geometry::new(&scene, options).map_err(|error| error.to_string())?;
        let look = look::text(&scene)?;
        self.base = Some(Base { scene, geometry: Arc::new(geometry), look });
        self.is_sound = true;
        Ok(())
    }

    /// Whether the text can be drawn, and all there is to say about it.
    pub(super) fn diagnostics(&self) -> (bool, Vec<Value>) {
        (self.is_sound, self.diagnostics.iter().map(tell::diagnostic).collect())
    }

    /// What a picture of it shows now.
    pub(super) fn shown(&self) -> Result<Shown, String> {
        let base = self.base()?;
        let (scene, values) = look::laid_over(base, &self.set)?;
        let view = View::new(Arc::clone(&base.geometry), Look::new(&scene));
        let view = view.map_err(|error| error.to_string())?;
        let wells = look::wells(&scene);
        Ok(Shown { view, image: scene.image, values, wells })
    }

    /// The scene with what is laid over it, objects and all.
    pub(super) fn scene(&self) -> Result<Scene, String> {
        let base = self.base()?;
        let (laid, _) = look::laid_over(base, &self.set)?;
        let (objects, groups) = (base.scene.objects.clone(), base.scene.groups.clone());
        Ok(Scene { objects, groups, ..laid })
    }

    pub(super) fn base(&self) -> Result<&Base, String> {
        self.base.as_ref().ok_or_else(|| "there is no picture of this scene yet".to_owned())
    }

    pub(super) fn path(&self) -> &str {
        &self.path
    }

    pub(super) fn text(&self) -> Option<&str> {
        self.text.as_deref()
    }

    pub(super) fn set(&self) -> &Map<String, Value> {
        &self.set
    }

    /// Takes back all that is laid over the scene.
    #[allow(clippy::unnecessary_wraps, reason = "one of several changes, of which others can fail")]
    pub(super) fn reset(&mut self) -> Result<(), String> {
        self.set.clear();
        Ok(())
    }

    /// Lays over the scene what was laid over it before.
    pub(super) fn put_back(&mut self, set: Map<String, Value>) {
        self.set = set;
    }

    /// Lays values over the scene; where one of them cannot be, all is as it was.
    pub(super) fn lay(&mut self, values: Map<String, Value>) -> Result<(), String> {
        let mut set = self.set.clone();
        for (path, value) in values {
            look::allowed(&path)?;
            if value.is_null() {
                set.shift_remove(&path);
            } else {
                set.insert(path, value);
            }
        }
        look::laid_over(self.base()?, &set)?;
        self.set = set;
        Ok(())
    }

    /// The command line that draws what is shown.
    pub(super) fn command(&self) -> Option<String> {
        if self.text.is_none() && !self.set.is_empty() {
            return None;
        }
        let mut command = format!("phong render {}", quoted(&self.path));
        for change in look::changes(&self.set) {
            command.push_str(" --set ");
            command.push_str(&quoted(&change));
        }
        Some(command)
    }
}

/// A word for a shell: in single quotes where it holds anything but plain letters.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=,".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        return word.to_owned();
    }
    format!("'{}'", word.replace('\'', "'\\''"))
}

/// All of a text file.
fn text_of(path: &str, source: &dyn Source, bounds: &Bounds) -> Result<String, String> {
    let cannot = |error: &io::Error| format!("cannot read {path}: {}", trouble(error));
    let file = source.open(path).map_err(|error| cannot(&error))?;
    if file.len() > bounds.limits.text_bytes {
        return Err(format!("{path} is longer than {} bytes", bounds.limits.text_bytes));
    }
    let mut bytes = vec![0; file.len() as usize];
    let read = file.read_full(&mut bytes, 0).map_err(|error| cannot(&error))?;
    bytes.truncate(read);
    String::from_utf8(bytes).map_err(|_| format!("{path} is not UTF-8 text"))
}

/// The files of a source, one of them as it was edited.
#[derive(Debug)]
struct Edited<'a> {
    path: &'a str,
    text: &'a str,
    source: &'a dyn Source,
}

impl Source for Edited<'_> {
    fn open(&self, path: &str) -> io::Result<Box<dyn Blob>> {
        if path == self.path {
            return Memory::new().with(path, self.text.as_bytes()).open(path);
        }
        self.source.open(path)
    }
}
