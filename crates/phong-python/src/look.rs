//! What a scene looks like as its text says it, and from where it is looked at.

use glam::DVec3;
use phong_scene::{Diagnostic, ExportOptions, Folder, Image, Scene, Side, closest};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};
use toml::Table;

use crate::arrays::Numbers;
use crate::errors::{os_error, value_error};
use crate::keys::Text;

/// A scene without objects as the tables of its text.
pub(crate) fn tables(scene: Scene) -> PyResult<Table> {
    let export =
        scene.export(&ExportOptions { images: false, ..ExportOptions::default() }, "scene.toml");
    let export = export.map_err(|error| value_error(error.to_string()))?;
    let text = export.text().map_err(|error| os_error(error.to_string()))?;
    text.parse().map_err(|error| value_error(format!("the scene has no text: {error}")))
}

/// A picture's settings with some keys of `[image]` laid over them, and what is to be said of these.
pub(crate) fn image_with(
    py: Python<'_>,
    image: &Image,
    keys: &Bound<'_, PyDict>,
) -> PyResult<(Image, Vec<Diagnostic>)> {
    let mut text = Text::default();
    let over = text.table(keys)?;
    if over.is_empty() {
        return Ok((image.clone(), Vec::new()));
    }
    let own = tables(Scene { image: image.clone(), ..Scene::default() })?;
    let mut table = match own.get("image") {
        Some(toml::Value::Table(table)) => table.clone(),
        _ => Table::new(),
    };
    table.extend(over);
    text.put("image", table);
    let (read, said) = text.read(py, "render", &Folder)?;
    Ok((read.image, said))
}

/// A side of a model by its name.
pub(crate) fn side(view: &str) -> PyResult<Side> {
    let sides = [
        ("front", Side::Front),
        ("back", Side::Back),
        ("left", Side::Left),
        ("right", Side::Right),
        ("top", Side::Top),
        ("bottom", Side::Bottom),
        ("iso", Side::Iso),
    ];
    let found = sides.iter().find(|(name, _)| *name == view).map(|(_, side)| *side);
    found.ok_or_else(|| {
        let meant = closest(view, sides.iter().map(|(name, _)| *name));
        let meant = meant.map(|name| format!(": did you mean {name:?}?")).unwrap_or_default();
        let names = sides.map(|(name, _)| name).join(", ");
        value_error(format!("view = {view:?}{meant} (there are {names})"))
    })
}

/// Which way is up: the name of an axis, or a direction.
pub(crate) fn up(up: &Bound<'_, PyAny>) -> PyResult<DVec3> {
    if let Ok(text) = up.cast::<PyString>() {
        let text = text.to_cow()?;
        let axis = match text.trim_start_matches(['+', '-']) {
            "x" => DVec3::X,
            "y" => DVec3::Y,
            "z" => DVec3::Z,
            _ => {
                return Err(value_error(format!(
                    "up = {text:?}: it must be \"x\", \"y\", \"z\", one of them with a minus, or three numbers"
                )));
            }
        };
        return Ok(if text.starts_with('-') { -axis } else { axis });
    }
    vector("up", up)
}

/// Three numbers with a direction.
fn vector(name: &'static str, object: &Bound<'_, PyAny>) -> PyResult<DVec3> {
    let numbers = Numbers::of(name, object)?;
    match numbers.flat()?[..] {
        [x, y, z] if DVec3::new(x, y, z).try_normalize().is_some() => Ok(DVec3::new(x, y, z)),
        _ => Err(value_error(format!("{name} must be three finite numbers, not all 0"))),
    }
}
