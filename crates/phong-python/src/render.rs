//! `phong.render` and its kin: pictures, shares of pictures, and explained pixels.

use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

use phong::aov::Aov;
use phong::film::{Film, Window};
use phong::image::Encoding;
use phong::part::Settings;
use phong::render::{Cancel, Event, Progress, RenderOptions, render as render_film};
use phong::terms::{Term, TermSet};
use phong::view::ViewError;
use phong_scene::{Diagnostic, closest};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyString};

use crate::errors::{cancelled, memory_error, value_error, view_error};
use crate::files::memory;
use crate::image::{Image, part_bytes};
use crate::look::image_with;
use crate::scene::Scene;
use crate::state::{Ready, Snapshot};
use crate::work;

/// A way to stop work from another thread.
#[pyclass(module = "phong", name = "Cancel", frozen)]
#[derive(Default)]
pub(crate) struct Token(Arc<Cancel>);

#[pymethods]
impl Token {
    #[new]
    fn new() -> Self {
        Self::default()
    }

    /// Asks all work that was given this to stop, for good: it raises `phong.Cancelled`.
    fn cancel(&self) {
        self.0.cancel();
    }

    /// Whether it was asked to stop.
    #[getter]
    fn is_cancelled(&self) -> bool {
        self.0.is_cancelled()
    }
}

/// What the layers' names stand for.
fn layers(
    names: &Bound<'_, PyAny>,
    scene: &phong_scene::Scene,
) -> PyResult<(TermSet, Vec<Aov>, Option<u32>)> {
    let (mut terms, mut aovs, mut lights) = (TermSet::NONE, Vec::new(), None);
    let names: Vec<String> = match names.cast::<PyString>() {
        Ok(one) => vec![one.to_cow()?.into_owned()],
        Err(_) => names.extract().map_err(|_| {
            crate::arrays::neither(
                "layers",
                "names of layers, like (\"depth\", \"diffuse\")",
                names,
            )
        })?,
    };
    for name in names {
        if name == "terms" {
            terms = terms.or(TermSet::of_scene(scene));
        } else if name == "lights" {
            lights = Some(u32::try_from(scene.lights.len()).unwrap_or(u32::MAX));
        } else if let Some(term) = Term::from_name(&name) {
            terms = terms.with(term);
        } else if let Some(aov) = Aov::from_name(&name) {
            aovs.push(aov);
        } else {
            let known = || {
                let terms = Term::ALL.into_iter().map(Term::name);
                ["terms", "lights"]
                    .into_iter()
                    .chain(terms)
                    .chain(Aov::ALL.into_iter().map(Aov::name))
            };
            let meant = closest(&name, known()).map(|name| format!(": did you mean {name:?}?"));
            let all = known().collect::<Vec<_>>().join(", ");
            let meant = meant.unwrap_or_default();
            return Err(value_error(format!(
                "layers: there is no {name:?}{meant} (there are {all})"
            )));
        }
    }
    Ok((terms, aovs, lights))
}

/// What is to be rendered.
pub(crate) struct Asked {
    snapshot: Snapshot,
    options: RenderOptions,
    image: phong_scene::Image,
    max_bytes: Option<u64>,
    warnings: Vec<Diagnostic>,
    threads: usize,
    strict: bool,
}

impl Asked {
    /// Everything that the keywords of `render` say.
    pub(crate) fn new(scene: &Scene, keys: &Bound<'_, PyDict>) -> PyResult<Self> {
        let py = keys.py();
        let keys = keys.copy()?;
        let take = |name: &str| -> PyResult<Option<Bound<'_, PyAny>>> {
            let value = keys.get_item(name)?;
            if value.is_some() {
                keys.del_item(name)?;
            }
            Ok(value.filter(|value| !value.is_none()))
        };
        let whole = |name: &str| -> PyResult<Option<u32>> {
            take(name)?
                .map(|value| {
                    let number = value.call_method0("__index__").and_then(|v| v.extract::<u32>());
                    number.map_err(|_| {
                        value_error(format!(
                            "{name} = {value}: it must be a whole number, 0 or above"
                        ))
                    })
                })
                .transpose()
        };
        let flag = |name: &str, default: bool| -> PyResult<bool> {
            let value = take(name)?;
            value.map_or(Ok(default), |value| {
                value.extract().map_err(|_| crate::arrays::neither(name, "True or False", &value))
            })
        };
        let threads = work::checked_threads(whole("threads")?)?;
        let shadows = flag("shadows", true)?;
        let strict = flag("strict", false)?;
        let crop = take("crop")?;
        let tile = whole("tile")?;
        let max_memory = take("max_memory")?;
        let max_memory: Option<u64> = max_memory
            .map(|value| {
                value
                    .extract()
                    .map_err(|_| crate::arrays::neither("max_memory", "a number of bytes", &value))
            })
            .transpose()?;
        let names = take("layers")?;
        let (snapshot, own, warnings) = {
            let state = scene.state();
            (state.snapshot(), state.scene.image.clone(), state.warnings())
        };
        let (image, said) = image_with(py, &own, &keys)?;
        let warnings = [warnings, said].concat();
        let told = |error: phong::render::OptionsError| value_error(error.to_string());
        let mut options = RenderOptions::of(&image).map_err(told)?.with_shadows(shadows);
        if let Some(crop) = crop {
            let wrong = || {
                value_error(format!("crop = {crop}: it must be (x0, y0, x1, y1), whole numbers"))
            };
            let [x0, y0, x1, y1]: [u32; 4] = crop
                .extract::<Vec<u32>>()
                .ok()
                .and_then(|sides| sides.try_into().ok())
                .ok_or_else(wrong)?;
            options = options
                .with_window(Window { x0, y0, x1, y1 })
                .map_err(|error| value_error(format!("crop: {error}")))?;
        }
        if let Some(tile) = tile {
            options = options.with_tile(tile).map_err(told)?;
        }
        if let Some(names) = names {
            let (terms, aovs, lights) = layers(&names, &snapshot.scene)?;
            options = options.with_terms(terms).with_aovs(&aovs).with_lights(lights);
        }
        let limit = Some(max_memory.unwrap_or_else(memory));
        let film = options.film_bytes();
        if let Some(limit) = limit.filter(|&limit| film > limit) {
            let [width, height] = options.size();
            return Err(memory_error(format!(
                "size = ({width}, {height}): the picture takes {film} bytes, over the limit of {limit}"
            )));
        }
        let max_bytes = limit.map(|limit| limit - film);
        Ok(Self { snapshot, options, image, max_bytes, warnings, threads, strict })
    }
}

/// What came of rendering.
struct Done {
    ready: Ready,
    film: Film,
    complete: bool,
    warnings: Vec<Diagnostic>,
    seconds: [f64; 3],
}

/// Pixels that are no finite colour.
fn not_finite(film: &Film) -> Option<Diagnostic> {
    let count = film.not_finite();
    let pixels = if count == 1 { "1 pixel is" } else { &format!("{count} pixels are") };
    let message = format!("{pixels} infinite or NaN: products of numbers beyond what an f32 holds");
    let help = "look for a light, a colour or a factor that is far too large";
    (count > 0).then(|| Diagnostic::warning(message, None).with_help(help))
}

/// Renders what was asked for; tells how far it is.
fn work_on(
    asked: Asked,
    cancel: &Cancel,
    progress: &Mutex<Progress>,
) -> Result<(Done, RenderOptions), ViewError> {
    let Asked { snapshot, options, image, max_bytes, mut warnings, strict, .. } = asked;
    let began = Instant::now();
    let ready = snapshot.prepare(image, max_bytes)?;
    let found = ready.warnings.iter().filter(|one| !warnings.contains(one));
    warnings.extend(found.cloned().collect::<Vec<_>>());
    if strict && !warnings.iter().all(Diagnostic::is_note) {
        return Err(ViewError::Look(warnings));
    }
    let options = options.with_finishing_of(&ready.scene);
    let built = began.elapsed().as_secs_f64();
    let listen = |event: Event<'_>| {
        if let Event::Progress(now) = event {
            let mut told = progress.lock().unwrap_or_else(PoisonError::into_inner);
            if now.samples_done >= told.samples_done {
                *told = now;
            }
        }
    };
    let outcome = render_film(&ready.view, &options, &listen, cancel);
    warnings.extend(not_finite(&outcome.film));
    let total = began.elapsed().as_secs_f64();
    let seconds = [built, total - built, total];
    let (film, complete) = (outcome.film, outcome.complete);
    Ok((Done { ready, film, complete, warnings, seconds }, options))
}

/// Renders a scene while the interpreter is free.
fn draw(
    py: Python<'_>,
    scene: &Scene,
    asked: Asked,
    cancel: Option<&Bound<'_, Token>>,
    listen: Option<&Bound<'_, PyAny>>,
) -> PyResult<(Done, RenderOptions)> {
    let token = cancel.map_or_else(Arc::default, |token| Arc::clone(&token.get().0));
    let progress = Arc::new(Mutex::new(Progress::default()));
    let told = Arc::clone(&progress);
    let threads = asked.threads;
    let tell = |_: Python<'_>| -> PyResult<()> {
        let Some(listen) = listen else { return Ok(()) };
        let now = *progress.lock().unwrap_or_else(PoisonError::into_inner);
        listen.call1((now.samples_done, now.samples)).map(drop)
    };
    let done = work::run(py, threads, &token, move |cancel| work_on(asked, cancel, &told), tell)?;
    let (done, options) = done.map_err(|error| view_error(py, &error))?;
    scene.state().keep(&done.ready);
    if !done.complete {
        return Err(cancelled(py));
    }
    tell(py)?;
    Ok((done, options))
}

/// Renders a scene. See `phong.render`.
#[pyfunction]
#[pyo3(signature = (scene, keys, cancel = None, listen = None))]
pub(crate) fn _render(
    scene: &Bound<'_, Scene>,
    keys: &Bound<'_, PyDict>,
    cancel: Option<&Bound<'_, Token>>,
    listen: Option<&Bound<'_, PyAny>>,
) -> PyResult<Image> {
    let (py, scene) = (scene.py(), scene.get());
    let asked = Asked::new(scene, keys)?;
    let (done, options) = draw(py, scene, asked, cancel, listen)?;
    let names = ["build", "trace", "total"].map(str::to_owned);
    let seconds = names.into_iter().zip(done.seconds).collect();
    Ok(Image::rendered(done.film, done.ready.scene, options, seconds, done.warnings))
}

/// Renders one share of a picture; the part file. See `phong.render_part`.
#[pyfunction]
#[pyo3(signature = (scene, index, count, keys, cancel = None, listen = None))]
pub(crate) fn _render_part<'py>(
    scene: &Bound<'py, Scene>,
    index: i64,
    count: i64,
    keys: &Bound<'py, PyDict>,
    cancel: Option<&Bound<'py, Token>>,
    listen: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyBytes>> {
    let (py, scene) = (scene.py(), scene.get());
    let mut asked = Asked::new(scene, keys)?;
    let wrong = || {
        let wanted = "shares count from 0, and the last is one less than their number";
        value_error(format!("index = {index} of count = {count}: {wanted}"))
    };
    let share = [u32::try_from(index), u32::try_from(count)];
    let [Ok(index), Ok(count)] = share else { return Err(wrong()) };
    asked.options = asked.options.with_share(index, count).map_err(|_| wrong())?;
    let (done, options) = draw(py, scene, asked, cancel, listen)?;
    let bytes = py.detach(|| {
        let settings = Settings::of(&done.ready.scene, &options, Encoding::default());
        part_bytes(&done.film, &settings)
    })?;
    Ok(PyBytes::new(py, &bytes))
}

/// Compiles a scene for such pictures, so that rendering begins at once.
#[pyfunction]
pub(crate) fn _compile(scene: &Bound<'_, Scene>, keys: &Bound<'_, PyDict>) -> PyResult<()> {
    let (py, scene) = (scene.py(), scene.get());
    let Asked { snapshot, image, max_bytes, threads, .. } = Asked::new(scene, keys)?;
    let work = move |_: &Cancel| snapshot.prepare(image, max_bytes);
    let done = work::run(py, threads, &Arc::default(), work, |_| Ok(()))?;
    let ready = done.map_err(|error| view_error(py, &error))?;
    scene.state().keep(&ready);
    Ok(())
}

/// Into how many tiles such a picture is cut: shares are made of whole ones.
#[pyfunction]
pub(crate) fn _tiles(scene: &Bound<'_, Scene>, keys: &Bound<'_, PyDict>) -> PyResult<u64> {
    let options = Asked::new(scene.get(), keys)?.options;
    let (window, edge) = (options.window(), options.tile());
    Ok(u64::from(window.width().div_ceil(edge)) * u64::from(window.height().div_ceil(edge)))
}

/// Explains a pixel; as JSON, text and LaTeX. See `phong.explain`.
#[pyfunction]
pub(crate) fn _explain(
    scene: &Bound<'_, Scene>,
    x: i64,
    y: i64,
    keys: &Bound<'_, PyDict>,
) -> PyResult<(String, String, String)> {
    let (py, scene) = (scene.py(), scene.get());
    let asked = Asked::new(scene, keys)?;
    let threads = asked.threads;
    let [width, height] = asked.options.size();
    let outside =
        || value_error(format!("pixel ({x}, {y}) is outside the picture of {width} × {height}"));
    let pixel = [u32::try_from(x), u32::try_from(y)];
    let [Ok(x), Ok(y)] = pixel else { return Err(outside()) };
    let work = move |cancel: &Cancel| {
        use phong_lab::furniture::expose;
        use phong_lab::tell::{Telling, json, latex, text};
        let Asked { snapshot, options, image, max_bytes, .. } = asked;
        let ready = snapshot.prepare(image, max_bytes)?;
        let told = phong::explain::explain(&ready.view, &options, [x, y]);
        let told = told.map(|mut told| {
            expose(&mut told, &ready.scene, &ready.view, &options, &|_| {}, cancel);
            let telling = Telling::default();
            (json(&told).to_string(), text(&told, &telling), latex(&told, &telling))
        });
        Ok((ready, told))
    };
    let done: Result<_, ViewError> = work::run(py, threads, &Arc::default(), work, |_| Ok(()))?;
    let (ready, told) = done.map_err(|error| view_error(py, &error))?;
    scene.state().keep(&ready);
    told.map_err(|error| value_error(error.to_string()))
}
