//! What is asked of pictures and formulas: the answers of the program, as its JSON.

use std::path::Path;

use numpy::PyReadonlyArray2;
use phong::image::{Draft, Picture, Plane, Transfer, place};
use phong_lab::eval::{Column, Table, WrongRow};
use phong_lab::figures::{CATALOGUE, Finish, Setting, find};
use phong_lab::fit::{self, FitError, Model};
use phong_lab::{compare, grade};
use phong_scene::{Export, ExportOptions, Folder, Format, Limits, PlyEncoding, Rgb, closest, read};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyList, PyString};
use serde_json::{Map, Value as Json, json};

use crate::arrays::{Numbers, colors, frozen, neither};
use crate::errors::{diagnostics, os_error, type_error, unreadable, value_error, view_error};
use crate::files::{format_of, memory, path_of};
use crate::image::Image;
use crate::scene::Scene;
use crate::work;

/// A picture: an image, the path of one, or an array of pixels.
fn picture(name: &'static str, object: &Bound<'_, PyAny>) -> PyResult<Picture> {
    let py = object.py();
    if let Ok(image) = object.cast::<Image>() {
        return Ok(image.get().picture());
    }
    if object.is_instance_of::<PyString>() || object.hasattr("__fspath__")? {
        let path = phong_scene::path_of(&path_of(object)?);
        let read = py.detach(|| -> Result<Picture, PyErr> {
            let bytes = std::fs::read(&path)
                .map_err(|error| unreadable(&format!("{name}: {}", path.display()), &error))?;
            let limit = memory();
            Picture::read_within(&bytes, limit)
                .map_err(|error| value_error(format!("{name}: {}: {error}", path.display())))
        });
        return read;
    }
    let numbers = Numbers::of(name, object)?;
    let [height, width, channels @ (3 | 4)] = numbers.shape()[..] else {
        return Err(value_error(format!(
            "{name} must be a phong.Image, a path, or an array of shape (H, W, 3) or (H, W, 4), not of {:?}",
            numbers.shape()
        )));
    };
    if height == 0 || width == 0 {
        return Err(value_error(format!("{name} has no pixels")));
    }
    let bytes = numbers.is_bytes();
    if numbers.is_whole() && !bytes {
        return Err(type_error(format!(
            "{name}: whole numbers must be bytes (dtype uint8, sRGB); linear light is written as floats"
        )));
    }
    let values = numbers.flat()?;
    let scale = if bytes { 255.0 } else { 1.0 };
    let plane = |(channel, name): (usize, &&str)| Plane {
        name: (*name).to_owned(),
        values: values.iter().skip(channel).step_by(channels).map(|v| (v / scale) as f32).collect(),
    };
    let size = [u32::try_from(width), u32::try_from(height)];
    let [Ok(width), Ok(height)] = size else {
        return Err(value_error(format!("{name} is too large")));
    };
    Ok(Picture {
        size: [width, height],
        planes: ["R", "G", "B", "A"][..channels].iter().enumerate().map(plane).collect(),
        transfer: if bytes { Transfer::Srgb } else { Transfer::Linear },
        levels: bytes.then_some(255),
        lossy: None,
    })
}

/// Two pictures compared: as JSON, and the largest difference of each pixel. See `phong.compare`.
#[pyfunction]
pub(crate) fn _compare<'py>(
    a: &Bound<'py, PyAny>,
    b: &Bound<'py, PyAny>,
    tolerance: f64,
) -> PyResult<(String, Bound<'py, PyAny>)> {
    let py = a.py();
    if tolerance.is_nan() || tolerance < 0.0 {
        return Err(value_error(format!("tolerance = {tolerance}: it must be 0 or above")));
    }
    let (a, b) = (picture("a", a)?, picture("b", b)?);
    let [width, height] = a.size;
    let compared = work::quietly(py, None, move |_| compare::compare(&a, &b))?;
    let found = compared.map_err(|error| value_error(error.to_string()))?;
    let told = compare::json(&found, tolerance).to_string();
    Ok((told, frozen(py, found.largest, &[height as usize, width as usize])?))
}

/// A picture graded, as JSON. See `phong.grade`.
#[pyfunction]
pub(crate) fn _grade(scene: &Bound<'_, Scene>, image: &Bound<'_, PyAny>) -> PyResult<String> {
    let py = scene.py();
    let picture = picture("image", image)?;
    let mut own = scene.get().state().scene_for(picture.size);
    own.image.size = picture.size;
    let size = picture.size;
    let graded = work::quietly(py, None, move |_| grade::grade(&own, &picture))?;
    let graded = graded.map_err(|error| match &error {
        grade::GradeError::View(error) => view_error(py, error),
        error => value_error(format!("image: {error}")),
    })?;
    Ok(grade::json(&graded, size).to_string())
}

/// One model matched to another, as JSON. See `phong.fit`.
#[pyfunction]
pub(crate) fn _fit(py: Python<'_>, a: String, b: String) -> PyResult<String> {
    let found = work::quietly(py, None, move |_| -> Result<_, FitError> {
        let from: fit::Lobe = a.parse()?;
        if b.contains(':') { fit::hold(from, b.parse()?) } else { fit::fit(from, b.parse()?) }
    })?;
    let found = found.map_err(|error| {
        let meant = match &error {
            FitError::UnknownModel { name } => closest(name, Model::ALL.iter().map(|m| m.name())),
            _ => None,
        };
        let help = meant.map(|name| format!(": did you mean {name:?}?")).unwrap_or_default();
        value_error(format!("{error}{help}"))
    })?;
    Ok(fit::json(&found).to_string())
}

/// Rows that are evaluated between two looks at signals.
const ROWS: usize = 1 << 16;

/// A formula at many places: its values, and how many numbers each has. See `phong.evaluate`.
///
/// `constant` are the parameters that are the same for all, as JSON; `arrays` the vectors and the
/// parameters that are arrays: a row for each place, or one row for all.
#[pyfunction]
#[expect(clippy::needless_pass_by_value, reason = "arguments of Python functions are given whole")]
pub(crate) fn _evaluate<'py>(
    py: Python<'py>,
    model: &str,
    count: usize,
    constant: &str,
    arrays: Vec<(String, PyReadonlyArray2<'py, f64>)>,
) -> PyResult<(Bound<'py, PyAny>, usize)> {
    let params: Map<String, Json> = serde_json::from_str(constant)
        .map_err(|error| value_error(format!("params cannot be told: {error}")))?;
    let mut columns = Vec::with_capacity(arrays.len());
    for (name, array) in &arrays {
        let (rows, width) = array.as_array().dim();
        let values = array.as_slice().map_err(|error| type_error(format!("{name}: {error}")))?;
        if rows != count && rows != 1 {
            return Err(value_error(format!("{name} has {rows} rows; wanted are {count}")));
        }
        columns.push(Column { name, values, width });
    }
    let table = Table { model, columns: &columns, params: &params };
    let (mut values, mut width) = (Vec::new(), 1);
    for first in (0..count).step_by(ROWS) {
        py.check_signals()?;
        let rows = first..(first + ROWS).min(count);
        let found = py.detach(|| table.evaluate(rows, &mut values));
        width = found.map_err(|WrongRow { row, why }| {
            let at = if count == 1 { String::new() } else { format!(" (at flat index {row})") };
            value_error(format!("{why}{at}"))
        })?;
    }
    Ok((numpy::PyArray1::from_vec(py, values).into_any(), width))
}

/// A scene written in another format: what became of it, as JSON. See `phong.convert`.
#[pyfunction]
pub(crate) fn _convert(
    scene: &Bound<'_, Scene>,
    path: &Bound<'_, PyAny>,
    to: Option<&str>,
    ascii: bool,
    tessellate: Option<f64>,
) -> PyResult<String> {
    let py = scene.py();
    let path = phong_scene::path_of(&path_of(path)?);
    let format = match to {
        Some(name) => Format::of_ending(name),
        None => Format::of_path(&path.to_string_lossy()),
    };
    let format = format.filter(|format| Format::writable().contains(format)).ok_or_else(|| {
        let names: Vec<_> = Format::writable().into_iter().map(Format::ending).collect();
        value_error(format!(
            "path: written are {}; end it so, or say it with to=",
            names.join(", ")
        ))
    })?;
    let (own, bare) = {
        let state = scene.get().state();
        (state.framed(), state.automatic.bare)
    };
    let ply = if ascii { PlyEncoding::Ascii } else { PlyEncoding::Binary };
    let max_bytes = memory();
    let options = ExportOptions { format, ply, bare, max_bytes, tessellate, images: true };
    work::quietly(py, None, move |_| write_files(own, &options, &path))?
}

/// Writes a scene's files, all or none.
fn write_files(
    scene: phong_scene::Scene,
    options: &ExportOptions,
    path: &Path,
) -> PyResult<String> {
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let exported = scene.export(options, &name);
    let Export { files, account } = exported.map_err(|error| value_error(error.to_string()))?;
    let mut drafts = Vec::new();
    for file in &files {
        let at = path.with_file_name(&file.name);
        let failed = |error: phong::image::SaveError| os_error(error.to_string());
        let mut draft = Draft::create(&at).map_err(failed)?;
        let content = |out: &mut dyn phong::image::WriteSeek| {
            let mut out = std::io::BufWriter::with_capacity(1 << 18, out);
            file.write(&mut out)?;
            std::io::Write::flush(&mut out)
        };
        draft.write(content).map_err(failed)?;
        drafts.push(draft);
    }
    place(drafts).map_err(|error| os_error(error.to_string()))?;
    let files: Vec<_> = files
        .iter()
        .map(|file| path.with_file_name(&file.name).to_string_lossy().into_owned())
        .collect();
    Ok(json!({
        "format": options.format.to_string(),
        "files": files,
        "carried": account.carried,
        "mapped": account.mapped,
        "dropped": account.dropped.iter().map(ToString::to_string).collect::<Vec<_>>(),
    })
    .to_string())
}

/// Everything there is to say of a file. See `phong.check`.
#[pyfunction]
pub(crate) fn _check<'py>(
    path: &Bound<'py, PyAny>,
    format: Option<&str>,
) -> PyResult<Bound<'py, PyList>> {
    let py = path.py();
    let path = path_of(path)?;
    let format = format.map(format_of).transpose()?;
    let limits = Limits { bytes: memory(), ..Limits::default() };
    let reading = work::quietly(py, None, move |_| read(&path, format, &Folder, &limits))?;
    diagnostics(py, &reading.diagnostics)
}

/// A figure of the lecture: its words and numbers as JSON, SVG and PNG. See `phong.figure`.
#[pyfunction]
pub(crate) fn _figure<'py>(
    py: Python<'py>,
    name: &str,
    keys: &Bound<'py, PyDict>,
) -> PyResult<(String, String, Bound<'py, PyBytes>)> {
    let entry = find(name).ok_or_else(|| {
        let names = || CATALOGUE.iter().map(|entry| entry.name);
        let meant = closest(name, names()).map(|name| format!(": did you mean {name:?}?"));
        let all = names().collect::<Vec<_>>().join(", ");
        value_error(format!(
            "there is no figure {name:?}{} (there are {all})",
            meant.unwrap_or_default()
        ))
    })?;
    let between = |key: &'static str, least: f64, most: f64| -> PyResult<Option<f64>> {
        let Some(value) = keys.get_item(key)?.filter(|value| !value.is_none()) else {
            return Ok(None);
        };
        let number: f64 = value.extract().map_err(|_| neither(key, "a number", &value))?;
        if !(least..=most).contains(&number) {
            return Err(value_error(format!(
                "{key} = {number}: it must be from {least} to {most}"
            )));
        }
        Ok(Some(number))
    };
    let color = keys.get_item("color")?.filter(|value| !value.is_none());
    let color = color.map(|color| colors("color", &color, 1, "one colour")).transpose()?;
    let color = color.and_then(|colors| colors.first().copied());
    if color.is_some_and(Rgb::is_black) {
        return Err(value_error("color: of a black ball nothing can be measured"));
    }
    let dark = keys.get_item("dark")?.is_some_and(|dark| dark.is_truthy().unwrap_or(false));
    let setting = Setting {
        theta: between("theta", 5.0, 80.0)?,
        alpha: between("alpha", 1.0, 1000.0)?,
        color,
        dark,
        ..Finish::Slide.into()
    };
    let (told, svg, png) = work::quietly(py, None, move |_| {
        let figure = entry.draw(setting);
        let numbers: Map<String, Json> =
            figure.numbers().iter().map(|n| (n.name.clone(), json!(n.value))).collect();
        let units: Map<String, Json> =
            figure.numbers().iter().map(|n| (n.name.clone(), json!(n.unit))).collect();
        let told = json!({
            "name": entry.name,
            "title": figure.title(),
            "caption": figure.caption(),
            "numbers": numbers,
            "units": units,
        });
        (told.to_string(), figure.svg(), figure.png())
    })?;
    Ok((told, svg, PyBytes::new(py, &png)))
}

/// Every figure's name, and what it shows.
#[pyfunction]
pub(crate) fn _figures() -> Vec<(&'static str, &'static str)> {
    CATALOGUE.iter().map(|entry| (entry.name, entry.line)).collect()
}
