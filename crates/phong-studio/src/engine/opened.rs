//! What is open: a scene's text, the last of it that could be read, and what is laid over that.

use std::io;
use std::sync::Arc;

use phong::geometry::{Geometry, GeometryOptions};
use phong::look::Look;
use phong::scene::{
    Blob, Change, Diagnostic, Format, MapRange, Memory, NamedLook, Reading, Scene, Source, Texture,
    TextureKind, trouble,
};
use phong::terms::TermSet;
use phong::view::View;
use phong_lab::tell;
use serde_json::{Map, Value};

use super::Bounds;
use super::frames::Frame;
use super::handles::{self, Grab, Spot};
use super::look::{self, Base};
use super::writing::written;
use crate::protocol::Handle;

/// A scene or a model.
#[derive(Clone, Debug)]
pub(super) struct Opened {
    pub(super) path: String,
    /// `None`: a bare model has no text.
    pub(super) text: Option<String>,
    /// The text that its file had.
    pub(super) as_read: Option<String>,
    diagnostics: Vec<Diagnostic>,
    /// Whether the text as it is now could be read.
    is_sound: bool,
    /// The last that could be read.
    base: Option<Arc<Base>>,
    /// What is laid over it, by the paths of keys.
    pub(super) set: Map<String, Value>,
    /// The handle that is held.
    grab: Option<Grab>,
    /// The look that a bare model has on.
    pub(super) dressed: Option<NamedLook>,
    /// Which frame of a trajectory is shown.
    pub(super) frame: Frame,
}

/// What reading needs besides a text.
#[derive(Clone, Copy)]
pub(super) struct Files<'a> {
    pub(super) source: &'a dyn Source,
    pub(super) bounds: &'a Bounds,
}

/// What is laid over a scene, to be put back.
pub(super) struct Before {
    base: Option<Arc<Base>>,
    set: Map<String, Value>,
}

/// What a picture shows.
#[derive(Debug)]
pub(super) struct Shown {
    pub(super) view: View,
    /// The scene, with all that is laid over it.
    pub(super) scene: Scene,
    /// All but the objects, by the keys of the text.
    pub(super) values: Value,
    /// Its colours, as `#rrggbb`.
    pub(super) wells: Map<String, Value>,
    pub(super) handles: Vec<Handle>,
    /// The terms that it can have.
    pub(super) terms: TermSet,
}

impl Opened {
    /// Reads a file; with it goes its text.
    pub(super) fn of_file(path: &str, files: Files<'_>) -> Result<(Self, Option<String>), String> {
        let text = match Format::of_path(path) {
            Some(Format::Toml) => Some(text_of(path, files)?),
            _ => None,
        };
        let (diagnostics, is_sound) = (Vec::new(), false);
        let (path, set) = (path.to_owned(), Map::new());
        let (base, grab, dressed) = (None, None, None);
        let frame = Frame::default();
        let (text_now, as_read) = (text.clone(), text.clone());
        let mut opened = Self {
            path,
            text: text_now,
            as_read,
            diagnostics,
            is_sound,
            base,
            set,
            grab,
            dressed,
            frame,
        };
        opened.read(files)?;
        match opened.diagnostics.iter().find(|diagnostic| diagnostic.is_error()) {
            // A text can be mended in the page; a model cannot.
            Some(error) if text.is_none() => Err(error.message.clone()),
            _ => Ok((opened, text)),
        }
    }

    /// Takes another text, and what is laid over it if that is said.
    pub(super) fn edit(
        &mut self,
        text: String,
        set: Option<Map<String, Value>>,
        files: Files<'_>,
    ) -> Result<(), String> {
        if self.text.is_none() {
            return Err("a bare model has no text to edit".to_owned());
        }
        self.text = Some(text);
        self.grab = None;
        self.read(files)?;
        if self.is_sound {
            // What is laid over the scene may name what is no longer there.
            let set = set.unwrap_or_else(|| std::mem::take(&mut self.set));
            self.set.clear();
            if self.lay(set, files).is_err() || self.shown().is_err() {
                self.set.clear();
            }
        }
        Ok(())
    }

    /// Writes values into the text, and takes back what was laid over these keys; where that cannot
    /// be, all is as it was.
    pub(super) fn write(
        &mut self,
        set: &Map<String, Value>,
        files: Files<'_>,
    ) -> Result<(), String> {
        let text = self.text.as_deref().ok_or("a bare model has no text to write into")?;
        if !self.is_sound {
            return Err("nothing is written into a text that cannot be read".to_owned());
        }
        let new = written(text, set)?;
        if new.len() as u64 > Bounds::TEXT {
            return Err(format!("a text of more than {} bytes", Bounds::TEXT));
        }
        let mut next = self.with_text(new);
        next.read(files)?;
        if let Some(error) = next.first_error() {
            return Err(error);
        }
        let mut left = self.set.clone();
        left.retain(|path, _| !set.contains_key(path));
        next.lay(left, files)?;
        next.shown()?;
        *self = next;
        Ok(())
    }

    /// The same with another text, which is still to be read, and nothing laid over it.
    pub(super) fn with_text(&self, text: String) -> Self {
        Self {
            path: self.path.clone(),
            text: Some(text),
            as_read: self.as_read.clone(),
            diagnostics: Vec::new(),
            is_sound: false,
            base: self.base.clone(),
            set: Map::new(),
            grab: None,
            dressed: None,
            frame: self.frame.clone(),
        }
    }

    /// Drags a handle.
    pub(super) fn drag(
        &mut self,
        path: &str,
        [from, to]: [[f64; 2]; 2],
        files: Files<'_>,
    ) -> Result<(), String> {
        if !from.iter().chain(&to).all(|x| x.is_finite() && x.abs() < 1e7) {
            return Err("a handle is dragged to a place near the picture".to_owned());
        }
        if !self.grab.as_ref().is_some_and(|grab| grab.is(path, from)) {
            let shown = self.shown()?;
            let spot = self.spots(&self.scene()?)?.into_iter().find(|spot| spot.path == path);
            let spot = spot.ok_or_else(|| format!("there is no handle `{path}`"))?;
            let camera = shown.view.camera().clone();
            self.grab = Some(Grab::new(spot, from, camera, shown.scene.image.size));
        }
        let values = self.grab.as_ref().map(|grab| grab.dragged(to)).transpose()?;
        self.lay(values.unwrap_or_default(), files)
    }

    /// Lets go of the handle that is held; its keys, and what is laid over them.
    pub(super) fn let_go(&mut self) -> Map<String, Value> {
        let Some(grab) = self.grab.take() else { return Map::new() };
        let keys = grab.keys();
        self.set
            .iter()
            .filter(|(path, _)| keys.contains(path))
            .map(|(k, v)| (k.clone(), v.clone()))
            .collect()
    }

    fn spots(&self, scene: &Scene) -> Result<Vec<Spot>, String> {
        Ok(handles::spots(scene, self.text.as_deref(), &self.base()?.middles))
    }

    pub(super) fn read(&mut self, files: Files<'_>) -> Result<(), String> {
        self.read_as(self.frame.clone(), files)?;
        if !self.is_sound && self.frame.number > 0 {
            // The text names other files now, or the file has become shorter.
            let mut first = self.clone();
            first.read_as(self.frame.other(0), files)?;
            if first.is_sound {
                *self = first;
            }
        }
        Ok(())
    }

    /// Reads it with this frame of its trajectories.
    pub(super) fn read_as(&mut self, mut frame: Frame, files: Files<'_>) -> Result<(), String> {
        let read = |source: &dyn Source| frame.read(&self.path, source, &files.bounds.limits, &[]);
        let reading = self.reading(files, read);
        self.frame = frame;
        self.diagnostics = reading.diagnostics;
        self.is_sound = false;
        let Some(scene) = reading.scene else { return Ok(()) };
        self.base = Some(self.based(scene, Map::new(), files.bounds)?);
        self.is_sound = true;
        Ok(())
    }

    /// What `read` makes of the files, with the text as it is now, and with the look on.
    fn reading(&self, files: Files<'_>, read: impl FnOnce(&dyn Source) -> Reading) -> Reading {
        let mut reading = match &self.text {
            Some(text) => read(&Edited { path: &self.path, text, source: files.source }),
            None => read(files.source),
        };
        if let (Some(scene), Some(look)) = (&mut reading.scene, self.dressed) {
            scene.put_on(look);
        }
        reading
    }

    /// A scene made ready; arrays that are those of the scene before are shared with it, and their
    /// trees not built again.
    fn based(
        &self,
        mut scene: Scene,
        laid: Map<String, Value>,
        bounds: &Bounds,
    ) -> Result<Arc<Base>, String> {
        let before = self.base.as_ref();
        for (new, old) in scene.objects.iter_mut().zip(before.iter().flat_map(|b| &b.scene.objects))
        {
            new.shape.share(&old.shape);
        }
        let options =
            GeometryOptions { max_bytes: Some(bounds.bytes), ..GeometryOptions::default() };
        let geometry = match before {
            Some(before) => before.geometry.update(&scene),
            None => Geometry::new(&scene, options),
        };
        let geometry = Arc::new(geometry.map_err(|error| error.to_string())?);
        let look = look::text(&scene)?;
        let stand_ins = look::stand_ins(&scene)?;
        let middles = handles::middles(&scene);
        Ok(Arc::new(Base { scene, geometry, look, stand_ins, laid, middles }))
    }

    /// The first error that reading ended with.
    pub(super) fn first_error(&self) -> Option<String> {
        self.diagnostics.iter().find(|diagnostic| diagnostic.is_error()).map(look::in_short)
    }

    /// Shows another frame; after an error it is to be put back as it was.
    pub(super) fn show_frame(&mut self, number: u64, files: Files<'_>) -> Result<(), String> {
        let count = self.frame.count;
        if number >= count {
            return Err(match count {
                1 => "nothing that is open has several frames".to_owned(),
                _ => format!("there is no frame {number}: there are {count}, 0 to {}", count - 1),
            });
        }
        if !self.is_sound() {
            return Err("no other frame is shown of a text that cannot be read".to_owned());
        }
        let set = std::mem::take(&mut self.set);
        self.read_as(self.frame.other(number), files)?;
        if let Some(error) = self.first_error() {
            return Err(error);
        }
        self.lay(set, files)
    }

    /// Whether the text can be drawn, and all there is to say about it.
    pub(super) fn diagnostics(&self) -> (bool, Vec<Value>) {
        (self.is_sound, self.diagnostics.iter().map(tell::diagnostic).collect())
    }

    /// What a picture of it shows now.
    pub(super) fn shown(&self) -> Result<Shown, String> {
        let base = self.base()?;
        let (scene, values) = look::laid_over(base, &self.set)?;
        let view = View::new(Arc::clone(&base.geometry), look_of(base, &scene));
        let view = view.map_err(|error| error.to_string())?;
        let wells = look::wells(&scene);
        let whole = Scene { objects: base.scene.objects.clone(), ..scene };
        let spots = self.spots(&whole)?;
        let size = whole.image.size;
        let handles = spots.iter().filter_map(|spot| spot.seen(view.camera(), size)).collect();
        let terms = TermSet::of_scene(&whole);
        Ok(Shown { view, scene: whole, values, wells, handles, terms })
    }

    /// What a picture of it would show with more laid over it.
    pub(super) fn view_with(&self, more: &Map<String, Value>) -> Result<View, String> {
        let base = self.base()?;
        let mut set = self.set.clone();
        for (path, value) in more {
            if !look::is_of_look(path) {
                return Err(format!("`{path}` is not laid over a single answer"));
            }
            set.insert(path.clone(), value.clone());
        }
        let (scene, _) = look::laid_over(base, &set)?;
        View::new(Arc::clone(&base.geometry), look_of(base, &scene))
            .map_err(|error| error.to_string())
    }

    /// The scene with what is laid over it, objects and all.
    pub(super) fn scene(&self) -> Result<Scene, String> {
        let base = self.base()?;
        let (laid, _) = look::laid_over(base, &self.set)?;
        let (objects, groups) = (base.scene.objects.clone(), base.scene.groups.clone());
        Ok(Scene { objects, groups, ..laid })
    }

    pub(super) fn base(&self) -> Result<&Base, String> {
        self.base.as_deref().ok_or_else(|| "there is no picture of this scene yet".to_owned())
    }

    /// Whether the text as it is now could be read.
    pub(super) fn is_sound(&self) -> bool {
        self.is_sound
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
    pub(super) fn reset(&mut self, files: Files<'_>) -> Result<(), String> {
        let nothing = self.set.keys().map(|path| (path.clone(), Value::Null)).collect();
        self.lay(nothing, files)
    }

    /// What is laid over the scene now.
    pub(super) fn before(&self) -> Before {
        Before { base: self.base.clone(), set: self.set.clone() }
    }

    /// Lays over the scene what was laid over it before.
    pub(super) fn put_back(&mut self, before: Before) {
        (self.base, self.set, self.grab) = (before.base, before.set, None);
    }

    /// Lays values over the scene; where one of them cannot be, all is as it was.
    pub(super) fn lay(
        &mut self,
        values: Map<String, Value>,
        files: Files<'_>,
    ) -> Result<(), String> {
        let mut set = self.set.clone();
        for (path, value) in values {
            look::allowed(&path)?;
            if value.is_null() {
                set.shift_remove(&path);
            } else {
                set.insert(path, value);
            }
        }
        let objects = |set: &Map<String, Value>| -> Map<String, Value> {
            let of_objects = set.iter().filter(|(path, _)| !look::is_of_look(path));
            of_objects.map(|(path, value)| (path.clone(), value.clone())).collect()
        };
        let laid = objects(&set);
        let base = if laid == self.base()?.laid {
            self.base.clone()
        } else {
            // Objects are changed by reading the text with these values laid over it.
            let changes: Result<Vec<Change>, String> =
                look::changes(&laid).map(|words| Change::parse(&words)).collect();
            let (changes, limits) = (changes?, &files.bounds.limits);
            let read =
                |source: &dyn Source| self.frame.reading(&self.path, source, limits, &changes);
            let reading = self.reading(files, read);
            let scene = reading.into_scene().map_err(|error| look::first_error(&error))?;
            Some(self.based(scene, laid, files.bounds)?)
        };
        look::laid_over(base.as_deref().ok_or("nothing can be drawn yet")?, &set)?;
        (self.base, self.set) = (base, set);
        Ok(())
    }
}

/// All of a text file.
pub(super) fn text_of(path: &str, Files { source, bounds }: Files<'_>) -> Result<String, String> {
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

/// The look of what is laid over a scene, whose objects some ranges of numbers are found from.
fn look_of(base: &Base, scene: &Scene) -> Look {
    let is_open =
        |texture: &Texture| matches!(texture.kind, TextureKind::Map { range: MapRange::Auto, .. });
    if !scene.textures.iter().any(is_open) {
        return Look::new(scene);
    }
    let Scene { objects, groups, .. } = &base.scene;
    let (objects, groups) = (objects.clone(), groups.clone());
    Look::new(&Scene { objects, groups, ..scene.clone() })
}
