//! `phong.Image`: a picture that was rendered.

use std::borrow::Cow;
use std::io::Cursor;
use std::path::Path;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use numpy::PyArrayMethods as _;
use phong::film::{Film, LayerKind};
use phong::finish::{Finished, Finishing, finish};
use phong::image::{
    Bits, Content, Draft, Encoding, Format, SaveError, WriteError, place, save, write,
};
use phong::part::{self, Join, Part, ReadError, Settings};
use phong::render::RenderOptions;
use phong_lab::furniture;
use phong_scene::{Diagnostic, Exposure, Scene, Tone};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyBytes, PyDict, PyList, PyTuple};

use crate::arrays::frozen;
use crate::errors::{diagnostics, os_error, unreadable, value_error};
use crate::files::{memory, path_of};

/// A picture that was rendered.
#[pyclass(module = "phong", frozen, weakref)]
pub(crate) struct Image {
    film: Arc<Film>,
    made: Made,
    seconds: Vec<(String, f64)>,
    warnings: Vec<Diagnostic>,
    samples: u32,
    array: PyOnceLock<Py<PyAny>>,
    layers: PyOnceLock<Py<PyDict>>,
}

/// What picture it is.
enum Made {
    /// Rendered here: of this scene.
    Here(Arc<Scene>, Box<RenderOptions>, OnceLock<Settings>),
    /// Put together, or unpickled.
    Elsewhere(Settings),
}

impl Image {
    /// A picture that was rendered here.
    pub(crate) fn rendered(
        film: Film,
        scene: Arc<Scene>,
        options: RenderOptions,
        seconds: Vec<(String, f64)>,
        warnings: Vec<Diagnostic>,
    ) -> Self {
        let samples = options.samples();
        // A share is finished when it is put together with the others.
        let own = Finishing::of(&options);
        let finishes = own.lines.is_some() || own.cel.is_some() || !scene.furniture.is_empty();
        let (film, made) = if finishes && film.is_complete() {
            let settings = Settings::of(&scene, &options, Encoding::default());
            let (film, settings) = finished(&film, settings);
            (film, Made::Elsewhere(settings))
        } else {
            (film, Made::Here(scene, Box::new(options), OnceLock::new()))
        };
        Self::of(Arc::new(film), made, seconds, warnings, samples)
    }

    fn of(
        film: Arc<Film>,
        made: Made,
        seconds: Vec<(String, f64)>,
        warnings: Vec<Diagnostic>,
        samples: u32,
    ) -> Self {
        let (array, layers) = (PyOnceLock::new(), PyOnceLock::new());
        Self { film, made, seconds, warnings, samples, array, layers }
    }

    /// A picture that parts were put together to.
    fn joined(film: Film, settings: Settings, seconds: Vec<(String, f64)>) -> Self {
        let samples = settings.picture.iter().find(|(name, _)| name == "samples");
        let samples = samples.and_then(|(_, text)| text.parse().ok()).unwrap_or(0);
        let own = settings.finishing();
        let finishes = own.lines.is_some() || own.cel.is_some() || settings.furniture().is_some();
        let (film, settings) = if finishes && film.is_complete() {
            finished(&film, settings)
        } else {
            (film, settings)
        };
        Self::of(Arc::new(film), Made::Elsewhere(settings), seconds, Vec::new(), samples)
    }

    fn settings(&self) -> &Settings {
        match &self.made {
            Made::Here(scene, options, settings) => {
                settings.get_or_init(|| Settings::of(scene, options, Encoding::default()))
            }
            Made::Elsewhere(settings) => settings,
        }
    }

    /// Its settings, exposed so, or as its scene says.
    fn exposed(&self, exposure: Option<Exposure>) -> Cow<'_, Settings> {
        let mut settings = Cow::Borrowed(self.settings());
        if let Some(exposure) = exposure {
            settings.to_mut().tone.exposure = exposure;
        }
        settings
    }

    /// Its film, finished as files hold it; exposed so, or as its scene says.
    fn finished(&self, exposure: Option<Exposure>) -> Finished<'_> {
        furniture::finish(&self.film, &self.exposed(exposure))
    }

    fn sides(&self) -> [usize; 2] {
        [self.film.height() as usize, self.film.width() as usize]
    }

    /// The picture for those who compare it with others.
    pub(crate) fn picture(&self) -> phong::image::Picture {
        match &self.made {
            Made::Elsewhere(settings) if settings.furniture().is_some() => {
                phong::image::Picture::of_film(&self.finished(None).into_film())
            }
            _ => phong::image::Picture::of_film(&self.film),
        }
    }

    fn save_svg(
        &self,
        path: &Path,
        encoding: Encoding,
        exposure: Option<Exposure>,
    ) -> Result<(), SaveError> {
        let settings = self.exposed(exposure);
        let mut draft = Draft::create(path)?;
        draft.write(|out| {
            let text = furniture::svg(&self.film, &settings, &encoding)?;
            out.write_all(text.as_bytes())?;
            Ok::<_, WriteError>(())
        })?;
        place(vec![draft])
    }

    fn png(&self, encoding: Encoding) -> PyResult<Vec<u8>> {
        let mut out = Cursor::new(Vec::new());
        let content = Content::Layer(LayerKind::Picture);
        write(&self.finished(None), content, Format::Png, &encoding, &mut out)
            .map_err(|error| value_error(error.to_string()))?;
        Ok(out.into_inner())
    }
}

/// A film with its lines, and its settings with the furniture that is still to be drawn over it: not before
/// the picture is exposed.
fn finished(film: &Film, settings: Settings) -> (Film, Settings) {
    let (finishing, mut settled) = (settings.finishing(), furniture::settled(film, settings));
    let finished = finish(film, &finishing);
    if finishing.cel.is_some() {
        // The steps are of light that is exposed so.
        settled.tone.exposure = Exposure::Stops(finished.tone().stops());
    }
    (finished.into_film(), settled)
}

/// Encoding of a PNG by its keywords.
fn encoding(bits: u32, linear: bool) -> PyResult<Encoding> {
    let bits = match bits {
        8 => Bits::Eight,
        16 => Bits::Sixteen,
        _ => return Err(value_error(format!("bits = {bits}: it must be 8 or 16"))),
    };
    Ok(Encoding { bits, linear })
}

/// Exposure by its keyword; `None`: the scene's.
fn exposure(value: Option<&Bound<'_, PyAny>>) -> PyResult<Option<Exposure>> {
    let Some(value) = value else { return Ok(None) };
    if value.extract::<&str>().is_ok_and(|word| word == "auto") {
        return Ok(Some(Exposure::Auto));
    }
    let stops = value.extract::<f64>().ok().filter(|stops| stops.abs() <= Tone::MOST_STOPS);
    let wanted = "it must be from -100 to 100 stops, or \"auto\"";
    let wrong = || value_error(format!("exposure = {value}: {wanted}"));
    Ok(Some(Exposure::Stops(stops.ok_or_else(wrong)?)))
}

/// Red, green, blue and alpha of every pixel, side by side.
fn interleaved(finished: &Finished<'_>) -> Vec<f32> {
    let picture = finished.values(LayerKind::Picture).unwrap_or_default();
    let alpha = finished.values(LayerKind::Alpha).unwrap_or_default();
    let pixels = picture.as_chunks::<3>().0.iter().zip(alpha);
    let mut all = Vec::with_capacity(4 * alpha.len());
    pixels.for_each(|(&[r, g, b], &a)| all.extend_from_slice(&[r, g, b, a]));
    all
}

#[pymethods]
impl Image {
    /// The pixels, of shape (H, W, 4), as `numpy.asarray` asks for them.
    #[pyo3(signature = (dtype = None, copy = None))]
    fn __array__<'py>(
        slf: &Bound<'py, Self>,
        dtype: Option<&Bound<'py, PyAny>>,
        copy: Option<bool>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let py = slf.py();
        let this = slf.get();
        let [height, width] = this.sides();
        let array = this.array.get_or_try_init(py, || {
            let values = py.detach(|| interleaved(&this.finished(None)));
            frozen(py, values, &[height, width, 4]).map(Bound::unbind)
        })?;
        let array = array.bind(py);
        let keys = PyDict::new(py);
        if let Some(dtype) = dtype {
            keys.set_item("dtype", dtype)?;
        }
        // `copy = None` leaves it to numpy whether one is needed.
        keys.set_item("copy", copy)?;
        let numpy = py.import("numpy")?;
        match copy {
            Some(false) | None if dtype.is_none() => Ok(array.clone()),
            None => numpy.getattr("asarray")?.call((array, dtype), None),
            _ => numpy.getattr("array")?.call((array,), Some(&keys)),
        }
    }

    /// Width and height, pixels.
    #[getter]
    fn size(&self) -> (u32, u32) {
        (self.film.width(), self.film.height())
    }

    /// (height, width, 4), as of the array.
    #[getter]
    fn shape(&self) -> (u32, u32, u32) {
        (self.film.height(), self.film.width(), 4)
    }

    /// Samples a pixel.
    #[getter]
    fn samples(&self) -> u32 {
        self.samples
    }

    /// The layers that were asked for, by name: arrays of shape (H, W) or (H, W, channels).
    #[getter]
    fn layers<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let layers = self.layers.get_or_try_init(py, || -> PyResult<Py<PyDict>> {
            let all = PyDict::new(py);
            let [height, width] = self.sides();
            for layer in &self.film.layers {
                if matches!(layer.kind, LayerKind::Picture | LayerKind::Alpha) {
                    continue;
                }
                let channels = layer.kind.channels();
                let shape = [height, width, channels];
                let shape = if channels == 1 { &shape[..2] } else { &shape[..] };
                all.set_item(layer.kind.name(), frozen(py, layer.values.to_vec(), shape)?)?;
            }
            Ok(all.unbind())
        })?;
        layers.bind(py).copy()
    }

    /// What was said of the scene and of the picture.
    #[getter]
    fn warnings<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        diagnostics(py, &self.warnings)
    }

    /// Seconds by stage.
    #[getter]
    fn seconds<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let all = PyDict::new(py);
        for (stage, seconds) in &self.seconds {
            all.set_item(stage, seconds)?;
        }
        Ok(all)
    }

    /// Writes it as PNG, EXR, PFM or SVG, as the name ends: whole or not at all. An SVG is a PNG, and over it
    /// title, scale bar, axes, legend and labels as outlines, sharp at any size.
    ///
    /// Layers lie beside it where the format does not hold them (`a.depth.png` for `a.png`). `bits`: 8
    /// or 16, of a PNG. `exposure`: stops by which a PNG is brighter, or "auto"; None: as the scene's `[tone]`
    /// says, whose curve and white balance a PNG has in any case. `linear`: no sRGB curve in a PNG.
    /// The bytes are those of the program. Raises `OSError`, and `ValueError` for a name it cannot be.
    #[pyo3(signature = (path, bits = 8, exposure = None, *, linear = false))]
    fn save(
        &self,
        py: Python<'_>,
        path: &Bound<'_, PyAny>,
        bits: u32,
        exposure: Option<&Bound<'_, PyAny>>,
        linear: bool,
    ) -> PyResult<()> {
        let (encoding, exposure) = (encoding(bits, linear)?, self::exposure(exposure)?);
        let path = phong_scene::path_of(&path_of(path)?);
        let is_svg = path.extension().is_some_and(|end| end.eq_ignore_ascii_case("svg"));
        let saved = py.detach(|| {
            if is_svg {
                self.save_svg(&path, encoding, exposure)
            } else {
                save(&self.finished(exposure), &path, &encoding)
            }
        });
        saved.map_err(|error| match error {
            SaveError::Unsuitable(message) => {
                value_error(format!("path: {message}; end it in .png, .pfm, .exr or .svg"))
            }
            error => os_error(error.to_string()),
        })
    }

    /// What a PNG of 8 bits holds: (H, W, 4) uint8, the sRGB curve, straight alpha. `exposure` as in `save`.
    #[pyo3(signature = (exposure = None))]
    fn to_srgb8<'py>(
        &self,
        py: Python<'py>,
        exposure: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let exposure = self::exposure(exposure)?;
        let finished = || self.finished(exposure);
        let bytes = py.detach(|| phong::image::srgb8(&finished(), &Encoding::default()));
        let [height, width] = self.sides();
        Ok(numpy::PyArray1::from_vec(py, bytes).reshape([height, width, 4])?.into_any())
    }

    fn _repr_png_<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let png = py.detach(|| self.png(Encoding::default()))?;
        Ok(PyBytes::new(py, &png))
    }

    fn __repr__(&self) -> String {
        let (width, height) = self.size();
        let layers: Vec<_> = self.film.layers.iter().skip(2).map(|l| l.kind.name()).collect();
        let layers = if layers.is_empty() {
            String::new()
        } else {
            format!(", layers {}", layers.join(" "))
        };
        format!("<phong.Image {width} × {height}, samples {}{layers}>", self.samples)
    }

    /// The fingerprint of what it is a picture of.
    #[getter]
    fn scene_fingerprint(&self) -> Option<u32> {
        self.settings().scene()
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        other.cast::<Self>().is_ok_and(|other| {
            let other = other.get();
            Arc::ptr_eq(&self.film, &other.film) || self.film == other.film
        })
    }

    fn __hash__(slf: &Bound<'_, Self>) -> usize {
        Arc::as_ptr(&slf.get().film).addr()
    }

    /// A part file that holds all of it.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let py = slf.py();
        let this = slf.get();
        let bytes = py.detach(|| part_bytes(&this.film, this.settings()))?;
        let restore = py.import("phong._phong")?.getattr("_image_of_part")?;
        let seconds: Vec<_> = this.seconds.clone();
        (restore, (PyBytes::new(py, &bytes), seconds)).into_pyobject(py)
    }
}

/// A film as a part file.
pub(crate) fn part_bytes(film: &Film, settings: &Settings) -> PyResult<Vec<u8>> {
    let mut bytes = Vec::new();
    part::write(film.film_tiles(), settings, &mut bytes)
        .map_err(|error| os_error(error.to_string()))?;
    Ok(bytes)
}

/// Undoes the pickling of an image.
#[pyfunction]
pub(crate) fn _image_of_part(bytes: &[u8], seconds: Vec<(String, f64)>) -> PyResult<Image> {
    let mut bytes = bytes;
    let part = Part::read(&mut bytes, u64::MAX).map_err(|error| value_error(error.to_string()))?;
    Ok(Image::joined(part.film, part.settings, seconds))
}

/// Puts the shares of a picture together. See `phong.merge`.
#[pyfunction]
pub(crate) fn merge(py: Python<'_>, parts: &Bound<'_, PyAny>) -> PyResult<Image> {
    let mut join = Join::default();
    for (index, item) in parts.try_iter()?.enumerate() {
        let item = item?;
        let name = format!("parts[{index}]");
        if let Ok(bytes) = item.cast::<PyBytes>() {
            add(py, &mut join, &name, bytes.as_bytes())?;
            continue;
        }
        let bytes: Vec<u8> = match item.extract::<Vec<u8>>() {
            Ok(bytes) if !item.is_instance_of::<PyList>() => bytes,
            _ => {
                let path = phong_scene::path_of(&path_of(&item)?);
                std::fs::read(&path)
                    .map_err(|error| unreadable(&format!("{name}: {}", path.display()), &error))?
            }
        };
        add(py, &mut join, &name, &bytes)?;
    }
    whole(join)
}

/// Adds a part file to what was gathered before.
fn add(py: Python<'_>, join: &mut Join, name: &str, bytes: &[u8]) -> PyResult<()> {
    let (limit, mut bytes) = (memory(), bytes);
    py.detach(|| join.read(name, &mut bytes, limit)).map_err(|error| match error {
        ReadError::Part(error) => value_error(format!("{name}: {error}")),
        ReadError::Join(error) => value_error(error.to_string()),
    })
}

/// What was gathered, which has to be the whole picture.
fn whole(join: Join) -> PyResult<Image> {
    let (film, settings) = join.finish().map_err(|error| value_error(error.to_string()))?;
    Ok(Image::joined(film, settings, Vec::new()))
}

/// Shares of a picture, put together as they come: `phong.merge` for who has them one after another.
#[pyclass(module = "phong._phong", name = "_Join", frozen)]
#[derive(Default)]
pub(crate) struct Joining(Mutex<Join>);

#[pymethods]
impl Joining {
    #[new]
    fn new() -> Self {
        Self::default()
    }

    /// Adds the bytes of a part file; `name` is what errors call it.
    fn add(&self, py: Python<'_>, name: &str, part: &Bound<'_, PyBytes>) -> PyResult<()> {
        let mut join = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        add(py, &mut join, name, part.as_bytes())
    }

    /// The picture, and nothing is left here. Raises `ValueError` where shares are missing.
    fn finish(&self) -> PyResult<Image> {
        let mut join = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        whole(std::mem::take(&mut *join))
    }
}
