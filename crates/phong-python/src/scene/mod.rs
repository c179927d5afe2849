//! `phong.Scene`: what is drawn, and what it looks like.

mod materials;
mod settings;

use std::sync::{Mutex, MutexGuard, PoisonError};

use glam::{DAffine3, DVec3};
use phong_scene::{
    ExportOptions, Folder, Format, Framing, Limits, MaterialId, NamedLook, Object, Points, Reading,
    Scene as SceneText, Shape, closest,
};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyList, PyTuple, PyType};

use crate::arrays::{neither, transforms};
use crate::errors::{diagnostics, os_error, scene_error, value_error};
use crate::files::{Beside, TEXT, format_of, memory, path_of, read_frame};
use crate::keys::{Said, Text};
use crate::look::{image_with, side};
use crate::part::Part;
use crate::state::{Automatic, State, Subject};
use crate::{bulk, content, look};

/// What is drawn, and what it looks like.
#[pyclass(module = "phong", frozen, subclass)]
pub(crate) struct Scene {
    state: Mutex<State>,
}

impl Scene {
    pub(crate) fn of(state: State) -> Self {
        Self { state: Mutex::new(state) }
    }

    /// Its state. Nobody may wait for the interpreter while it is held.
    pub(crate) fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Where a part stands.
    fn place(&self, part: &Part) -> PyResult<usize> {
        self.state().place(part.number).ok_or_else(|| {
            value_error(format!("part: {:?} is no part of this scene, or was removed", part.name))
        })
    }

    /// Adds a shape, called `name` or by its kind and a number.
    fn put(
        &self,
        shape: Shape,
        material: MaterialId,
        name: Option<String>,
        transform: DAffine3,
    ) -> Part {
        let mut state = self.state();
        let name = name.unwrap_or_else(|| state.free_object_name(shape.kind()));
        let object = Object { name: name.clone(), shape, material, transform, ..Object::default() };
        let number = state.add(object);
        Part { number, name }
    }
}

#[pymethods]
impl Scene {
    /// A scene with nothing in it: see the class.
    #[new]
    #[pyo3(signature = (camera = None, lights = None, ambient = None, background = None, **settings))]
    fn new(
        py: Python<'_>,
        camera: Option<&Bound<'_, PyAny>>,
        lights: Option<&Bound<'_, PyAny>>,
        ambient: Option<&Bound<'_, PyAny>>,
        background: Option<&Bound<'_, PyAny>>,
        settings: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let framing = camera.is_none().then(Framing::default);
        let automatic = Automatic { lights: lights.is_none(), bare: false };
        let scene = Self::of(State::new(SceneText::default(), framing, automatic));
        if let Some(camera) = camera {
            scene.set_camera(camera)?;
        }
        if let Some(lights) = lights {
            scene.set_lights(lights)?;
        }
        if let Some(ambient) = ambient {
            scene.set_ambient(ambient)?;
        }
        if let Some(background) = background {
            let keys = PyDict::new(py);
            keys.set_item("background", background)?;
            scene.set_image(&keys)?;
        }
        if settings.is_some() {
            scene.set_settings(settings)?;
        }
        Ok(scene)
    }

    /// Reads a scene (`.toml`) or a bare model (`.obj`, `.ply`, each also `.gz`).
    ///
    /// A bare model has an automatic camera and lights. `format`: what it is, where its name does not
    /// say. `lenient`: what can be drawn of a damaged model is. `frame`: which frame of its trajectories
    /// is read, from 0. Warnings are found in `check()`.
    /// Raises `phong.SceneError` with all diagnostics, each with file, line and column.
    #[classmethod]
    #[pyo3(signature = (path, format = None, lenient = false, *, frame = 0))]
    fn read(
        class: &Bound<'_, PyType>,
        path: &Bound<'_, PyAny>,
        format: Option<&str>,
        lenient: bool,
        frame: u64,
    ) -> PyResult<Py<PyAny>> {
        let path = path_of(path)?;
        let format = format.map(format_of).transpose()?;
        let limits = Limits { lenient, bytes: memory(), ..Limits::default() };
        let work = move |_: &_| read_frame(frame, &path, format, &Folder, &limits);
        let reading = crate::work::quietly(class.py(), None, work)?;
        made(class, of_reading(class.py(), reading)?)
    }

    /// Reads the text of a scene; files that it names are looked for in `folder` (default: the current one).
    /// `frame`: which frame of its trajectories is read, from 0.
    ///
    /// Raises `phong.SceneError` with all diagnostics.
    #[classmethod]
    #[pyo3(signature = (text, folder = None, *, frame = 0))]
    fn parse(
        class: &Bound<'_, PyType>,
        text: String,
        folder: Option<&Bound<'_, PyAny>>,
        frame: u64,
    ) -> PyResult<Py<PyAny>> {
        let folder = folder.map(path_of).transpose()?.unwrap_or_else(|| ".".to_owned());
        let work = move |_: &_| {
            let files = Beside { text, folder };
            let limits = Limits { bytes: memory(), ..Limits::default() };
            read_frame(frame, TEXT, Some(Format::Toml), &files, &limits)
        };
        let reading = crate::work::quietly(class.py(), None, work)?;
        made(class, of_reading(class.py(), reading)?)
    }

    /// Adds a sphere at every centre; the part that they are.
    ///
    /// `centers`: shape (N, 3), any float or integer dtype, scene units. `radii`: one number, or shape
    /// (N,); above 0. `colors`: one for all, or shape (N, 3): floats are linear, `uint8` is sRGB, text is
    /// `"#rrggbb"` or a CSS name; they replace the material's. `material`: a `phong.Material`, or the name
    /// of one of the scene's. `name`: what `explain` calls them. `fields`: numbers by name, one or shape
    /// (N,), for textures of `kind="map"`; NaN is unknown.
    ///
    /// Raises `ValueError` or `TypeError` with the argument, the index, the value, and what is wanted.
    #[pyo3(signature = (centers, radii, colors = None, material = None, name = None, *, fields = None))]
    fn add_spheres(
        &self,
        centers: &Bound<'_, PyAny>,
        radii: &Bound<'_, PyAny>,
        colors: Option<&Bound<'_, PyAny>>,
        material: Option<&Bound<'_, PyAny>>,
        name: Option<String>,
        fields: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Part> {
        let points = bulk::spheres(centers, radii, colors, fields)?;
        let material = self.material(material)?;
        Ok(self.put(points.into(), material, name, DAffine3::IDENTITY))
    }

    /// Moves the spheres of a part, or changes their radii or colours; what is not given stays.
    ///
    /// Arrays are as of `add_spheres`. Only this part is built again by the next picture, and new
    /// colours alone build nothing. Raises as `add_spheres`, and `ValueError` for a part of another
    /// kind.
    #[pyo3(signature = (part, centers = None, radii = None, colors = None, *, fields = None))]
    fn update_spheres(
        &self,
        part: &Part,
        centers: Option<&Bound<'_, PyAny>>,
        radii: Option<&Bound<'_, PyAny>>,
        colors: Option<&Bound<'_, PyAny>>,
        fields: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<()> {
        let place = self.place(part)?;
        let old = match &self.state().scene.objects[place].shape {
            Shape::Points(points) => Points::clone(points),
            other => {
                let kind = other.kind();
                return Err(value_error(format!("part: {:?} is a {kind}, no spheres", part.name)));
            }
        };
        let points = bulk::moved(old, centers, radii, colors, fields)?;
        self.replace(part, points.into())
    }

    /// Adds triangles; the part that they are.
    ///
    /// `vertices`: shape (N, 3), any float or integer dtype. `faces`: shape (M, 3), whole numbers from 0,
    /// counter-clockwise seen from outside. `normals`: shape (N, 3), any length but 0; without, faces
    /// that meet under 60° are smoothed, or under `smooth` degrees; `smooth=False` leaves them flat.
    /// `uv`: shape (N, 2). `colors`: one, or shape (N, 3), as of `add_spheres`, and so are `fields`.
    ///
    /// Raises `ValueError` or `TypeError` with the argument, the index, the value, and what is wanted.
    #[pyo3(signature = (vertices, faces, normals = None, uv = None, colors = None, material = None,
                        *, smooth = None, name = None, fields = None))]
    #[expect(clippy::too_many_arguments, reason = "they are the keywords of a Python function")]
    fn add_mesh(
        &self,
        vertices: &Bound<'_, PyAny>,
        faces: &Bound<'_, PyAny>,
        normals: Option<&Bound<'_, PyAny>>,
        uv: Option<&Bound<'_, PyAny>>,
        colors: Option<&Bound<'_, PyAny>>,
        material: Option<&Bound<'_, PyAny>>,
        smooth: Option<&Bound<'_, PyAny>>,
        name: Option<String>,
        fields: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Part> {
        let mesh = bulk::mesh(vertices, faces, normals, uv, colors, smooth, fields)?;
        let material = self.material(material)?;
        Ok(self.put(mesh.into(), material, name, DAffine3::IDENTITY))
    }

    /// Adds a cylinder from every start to every end; the part that they are.
    ///
    /// `starts`, `ends`: shape (N, 3). `radii`: one number, shape (N,), or (N, 2) for both ends.
    /// `colors`: one, shape (N, 3), or (N, 2, 3) for the halves. `fields`: as of `add_spheres`, or shape
    /// (N, 2) for the ends. `caps`: `"round"`, `"flat"` or `"none"`.
    ///
    /// Raises `ValueError` or `TypeError` with the argument, the index, the value, and what is wanted.
    #[pyo3(signature = (starts, ends, radii, colors = None, material = None, *, caps = "round",
                        name = None, fields = None))]
    #[expect(clippy::too_many_arguments, reason = "they are the keywords of a Python function")]
    fn add_cylinders(
        &self,
        starts: &Bound<'_, PyAny>,
        ends: &Bound<'_, PyAny>,
        radii: &Bound<'_, PyAny>,
        colors: Option<&Bound<'_, PyAny>>,
        material: Option<&Bound<'_, PyAny>>,
        caps: &str,
        name: Option<String>,
        fields: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Part> {
        let cylinders = bulk::cylinders(starts, ends, radii, colors, caps, fields)?;
        let material = self.material(material)?;
        Ok(self.put(cylinders.into(), material, name, DAffine3::IDENTITY))
    }

    /// Adds a shape, like `phong.Sphere(center=(0, 1, 0), radius=1)`; the part that it is.
    ///
    /// `transform`: shape (4, 4) or (3, 4), for column vectors; it follows the shape's own. Raises
    /// `phong.SceneError` for a shape that makes no sense.
    #[pyo3(signature = (shape, transform = None))]
    fn add(
        &self,
        shape: &Bound<'_, PyAny>,
        transform: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Part> {
        let py = shape.py();
        let place = match transform {
            None => DAffine3::IDENTITY,
            Some(transform) => match transforms("transform", transform)?[..] {
                [one] => one,
                _ => return Err(value_error("transform must be of shape (4, 4)")),
            },
        };
        let said = Said::of(shape).filter(|said| {
            !matches!(said.kind.as_str(), "camera" | "light" | "material" | "texture" | "image")
        });
        let Some(said) = said else {
            return Err(neither("shape", "a shape like phong.Sphere", shape));
        };
        let keys = said.keys.copy()?;
        let material = keys.get_item("material")?;
        if material.is_some() {
            keys.del_item("material")?;
        }
        let material = self.material(material.as_ref())?;
        let mut text = Text::default();
        let table = text.table(&keys)?;
        let named = table.contains_key("name");
        text.push(&said.kind, table);
        let (read, warnings) = text.read(py, &said.kind, &Folder)?;
        let mut objects = read.objects.into_iter();
        let (Some(object), None) = (objects.next(), objects.next()) else {
            return Err(value_error(format!(
                "{}: its file holds several things; read it with phong.Scene.read",
                said.kind
            )));
        };
        let name = named.then_some(object.name);
        let part = self.put(object.shape, material, name, place * object.transform);
        self.state().say(Subject::Part(part.number), warnings);
        Ok(part)
    }

    /// Draws a part at other places as well; their parts.
    ///
    /// `transforms`: shape (4, 4) or (N, 4, 4), for column vectors. They share the part's geometry,
    /// which is built once. `keep=False`: it is no longer drawn where it was. Each copy may get a
    /// material of its own.
    #[pyo3(signature = (part, transforms, *, keep = true))]
    fn instance(
        &self,
        part: &Part,
        transforms: &Bound<'_, PyAny>,
        keep: bool,
    ) -> PyResult<Vec<Part>> {
        let all = self::transforms("transforms", transforms)?;
        let place = self.place(part)?;
        let mut state = self.state();
        let original = state.scene.objects[place].clone();
        let mut parts = Vec::with_capacity(all.len());
        for (index, transform) in all.into_iter().enumerate() {
            let name = format!("{} / {}", original.name, index + 1);
            let transform = transform * original.transform;
            let number = state.add(Object { name: name.clone(), transform, ..original.clone() });
            parts.push(Part { number, name });
        }
        if !keep {
            state.remove(place);
        }
        Ok(parts)
    }

    /// Takes a part away; others keep their numbers. Raises `ValueError` if it is gone already.
    fn remove(&self, part: &Part) -> PyResult<()> {
        let place = self.place(part)?;
        self.state().remove(place);
        Ok(())
    }

    /// Every part, in order.
    #[getter]
    fn parts(&self) -> Vec<Part> {
        let state = self.state();
        let objects = state.parts.iter().zip(&state.scene.objects);
        objects.map(|(&number, object)| Part { number, name: object.name.clone() }).collect()
    }

    /// Looks at it from a side, so that all of it is in the picture, whatever its size.
    ///
    /// `view`: `"front" "back" "left" "right" "top" "bottom" "iso"`. `up`: `"x"`, `"y"` (default),
    /// `"z"`, one of them with a minus, or three numbers. `fov`: vertical, degrees. Lights that nobody
    /// has set follow the camera.
    #[pyo3(signature = (view = "iso", up = None, *, fov = None))]
    fn frame(&self, view: &str, up: Option<&Bound<'_, PyAny>>, fov: Option<f64>) -> PyResult<()> {
        if let Some(fov) = fov.filter(|fov| !(*fov > 0.0 && *fov < 180.0)) {
            return Err(value_error(format!(
                "fov = {fov}: it must be above 0 and below 180 degrees"
            )));
        }
        let up = up.map(look::up).transpose()?.unwrap_or(DVec3::Y);
        let framing = Framing { side: side(view)?, up, fov, ..Framing::default() };
        let mut state = self.state();
        state.framing = Some(framing);
        state.look();
        Ok(())
    }

    /// Everything that is wrong with it, and what can hardly be meant: `phong.Diagnostic`s.
    fn check<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let (scene, said) = {
            let state = self.state();
            (state.framed(), state.warnings())
        };
        let mut all = said;
        let found = crate::work::quietly(py, None, move |_: &_| scene.check())?;
        all.extend(found.into_iter().filter(|one| !all.contains(one)).collect::<Vec<_>>());
        diagnostics(py, &all)
    }

    /// Its text. Arrays stand in files that it names: `phong.convert` writes them as well.
    fn to_toml(&self) -> PyResult<String> {
        let framed = self.state().framed();
        let export = framed.export(&ExportOptions::default(), "scene.toml");
        let export = export.map_err(|error| value_error(error.to_string()))?;
        export.text().map_err(|error| os_error(error.to_string()))
    }

    /// A look by its name: `lecture`, `publication`, `clay`, `flat`, `ink`, `tachyon`, `vmd`, `pymol` or
    /// `technical`. It sets lights, ambient light, fog, outline, background and the factors of materials,
    /// by the camera as it is now.
    fn look(&self, name: &str) -> PyResult<()> {
        let Some(look) = NamedLook::from_name(name) else {
            let names = NamedLook::ALL.map(NamedLook::name);
            let meant = closest(name, names).map(|name| format!(": did you mean {name:?}?"));
            return Err(value_error(format!(
                "look: there is no {name:?}{} (there are {})",
                meant.unwrap_or_default(),
                names.join(", ")
            )));
        };
        let mut state = self.state();
        let mut dressed = state.framed();
        dressed.put_on(look);
        state.automatic = Automatic::default();
        let scene = state.objects();
        let (camera, image) = (scene.camera.clone(), scene.image.clone());
        let image = phong_scene::Image { background: dressed.image.background, ..image };
        *scene = SceneText { camera, image, ..dressed };
        Ok(())
    }

    /// The tables of its text but for the objects, as a dictionary made of it.
    fn _tables(&self) -> PyResult<String> {
        Ok(self.text()?.to_string())
    }

    /// Another camera: `scene.camera = …`.
    fn set_camera(&self, camera: &Bound<'_, PyAny>) -> PyResult<()> {
        let said = Said::expect(camera, "camera", "camera")?;
        let mut text = Text::default();
        let table = text.table(&said.keys)?;
        text.put("camera", table);
        let (read, said) = text.read(camera.py(), "Camera", &Folder)?;
        let mut state = self.state();
        state.say(Subject::Camera, said);
        state.look().camera = read.camera;
        state.framing = None;
        Ok(())
    }

    /// Other lights: `scene.lights = …`.
    fn set_lights(&self, lights: &Bound<'_, PyAny>) -> PyResult<()> {
        let py = lights.py();
        let mut text = Text::default();
        let several = if Said::of(lights).is_some() {
            vec![lights.clone()]
        } else {
            let all = lights
                .try_iter()
                .map_err(|_| neither("lights", "a list of phong.Light", lights))?;
            all.collect::<PyResult<_>>()?
        };
        for (index, light) in several.iter().enumerate() {
            let said = Said::expect(light, "light", &format!("lights[{index}]"))?;
            let table = text.table(&said.keys)?;
            text.push("light", table);
        }
        let (read, said) = text.read(py, "lights", &Folder)?;
        let mut state = self.state();
        state.say(Subject::Lights, said);
        state.look().lights = read.lights;
        state.automatic.lights = false;
        if state.automatic.bare {
            // The rest stays as the model was shown.
            let framed = state.framed();
            state.look().image.background = framed.image.background;
            state.automatic.bare = false;
        }
        Ok(())
    }

    /// Another ambient light: `scene.ambient = …`.
    fn set_ambient(&self, ambient: &Bound<'_, PyAny>) -> PyResult<()> {
        let keys = PyDict::new(ambient.py());
        keys.set_item("color", ambient)?;
        let mut text = Text::default();
        let table = text.table(&keys)?;
        text.put("ambient", table);
        let (read, said) = text.read(ambient.py(), "ambient", &Folder)?;
        let mut state = self.state();
        state.say(Subject::Ambient, said);
        state.look().ambient = read.ambient;
        Ok(())
    }

    /// Lays keys of `[image]` (`size`, `samples`, `background`, …) over the scene's own.
    fn set_image(&self, keys: &Bound<'_, PyDict>) -> PyResult<()> {
        let image = self.state().scene.image.clone();
        let (image, said) = image_with(keys.py(), &image, keys)?;
        let mut state = self.state();
        state.say(Subject::Image, said);
        state.look().image = image;
        Ok(())
    }

    /// Other tables that stand alone (`fog`, `ambient_occlusion`, `clip`, …): dictionaries of their keys,
    /// or lists of such; `None` takes one away. Those that are not given stay.
    #[pyo3(signature = (**settings))]
    fn set_settings(&self, settings: Option<&Bound<'_, PyDict>>) -> PyResult<()> {
        settings.map_or(Ok(()), |settings| self.change_settings(settings))
    }

    /// Another material for what has the one of a name, or for a part. Nothing is built again where the
    /// material was this part's alone.
    fn set_material(&self, which: &Bound<'_, PyAny>, material: &Bound<'_, PyAny>) -> PyResult<()> {
        self.give_material(which, material)
    }

    /// The text of everything but bulk arrays, those as bytes, and what only Python knows.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let py = slf.py();
        let packed = content::pack(&slf.get().state())?;
        let arrays: Vec<_> = packed.arrays.iter().map(|bytes| PyBytes::new(py, bytes)).collect();
        let arguments = (slf.get_type(), packed.text, PyList::new(py, arrays)?);
        let restore = py.import("phong._scene")?.getattr("_restore")?;
        (restore, arguments).into_pyobject(py)
    }

    /// Undoes `__reduce__`.
    #[classmethod]
    #[expect(clippy::needless_pass_by_value, reason = "arguments are given whole")]
    fn _unpack(
        class: &Bound<'_, PyType>,
        text: &str,
        arrays: Vec<Bound<'_, PyBytes>>,
    ) -> PyResult<Py<PyAny>> {
        let arrays: Vec<&[u8]> = arrays.iter().map(PyBytesMethods::as_bytes).collect();
        made(class, content::unpack(text, &arrays)?)
    }

    /// All that the digest is of, as bytes.
    fn _content<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let packed = content::pack(&self.state())?;
        let arrays: Vec<_> = packed.arrays.iter().map(|bytes| PyBytes::new(py, bytes)).collect();
        (packed.text, PyList::new(py, arrays)?).into_pyobject(py)
    }

    fn __copy__(slf: &Bound<'_, Self>) -> PyResult<Py<PyAny>> {
        let state = slf.get().state().clone();
        made(&slf.get_type(), state)
    }

    fn __deepcopy__(slf: &Bound<'_, Self>, _memo: &Bound<'_, PyAny>) -> PyResult<Py<PyAny>> {
        Self::__copy__(slf)
    }
}

impl Scene {
    /// Gives a part another shape.
    fn replace(&self, part: &Part, shape: Shape) -> PyResult<()> {
        let place = self.place(part)?;
        self.state().objects().objects[place].shape = shape;
        Ok(())
    }
}

/// The scene that was read, with what was said of it.
fn of_reading(py: Python<'_>, reading: Reading) -> PyResult<State> {
    let Reading { scene, bare, diagnostics } = reading;
    let Some(scene) = scene else { return Err(scene_error(py, &diagnostics)) };
    let framing = bare.then(Framing::default);
    let mut state = State::new(scene, framing, Automatic { lights: bare, bare });
    state.say(Subject::Text, diagnostics);
    Ok(state)
}

/// A scene of this class.
fn made(class: &Bound<'_, PyType>, state: State) -> PyResult<Py<PyAny>> {
    let made = class.call0()?;
    *made.cast::<Scene>()?.get().state() = state;
    Ok(made.unbind())
}
