//! Files with a camera's way: read as scenes are, by their table of keys.

use std::sync::Arc;

use toml::de::DeTable;

use super::notes::Notes;
use super::syntax;
use super::table::Values;
use super::text::{self, Spot};
use crate::camera::{Camera, CameraKind};
use crate::camera_path::{CameraKey, CameraPath, CameraPathReading};
use crate::check::settings as judge;
use crate::keys::{CAMERA_KEY, CAMERA_PATH};
use crate::limits::Limits;
use crate::source::Source;

/// Reads a file with a camera's way, and everything there is to say about it.
///
/// ```
/// use phong_scene::{Limits, Memory, read_camera_path};
/// let text = "version = 1\npictures = 10\n[[key]]\ntime = 0\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\n";
/// let files = Memory::new().with("way.toml", text.as_bytes());
/// let reading = read_camera_path("way.toml", &files, &Limits::default());
/// assert_eq!(
///     reading.diagnostics[0].to_string(),
///     "way.toml:3:1: error: a way has two keys at least; this is one",
/// );
/// ```
pub fn read_camera_path(path: &str, source: &dyn Source, limits: &Limits) -> CameraPathReading {
    let text = match text::open(path, source, limits) {
        Ok(text) => text,
        Err(error) => return CameraPathReading { path: None, diagnostics: vec![*error] },
    };
    let mut notes = Notes::default();
    let file = notes.add(Arc::clone(&text));
    let mut mended = String::new();
    let document = syntax::parse(&text.text, file, &mut mended, &mut notes);
    let path = whole(document.get_ref(), file, &mut notes);
    let path = path.filter(|_| !notes.has_errors());
    CameraPathReading { path, diagnostics: notes.into_diagnostics() }
}

fn whole(document: &DeTable<'_>, file: u32, notes: &mut Notes) -> Option<CameraPath> {
    let head = Spot::new(file, 0..0);
    let values = Values::read(&CAMERA_PATH, document, head, notes);
    notes.miss_version(document, head);
    let list = document.get("key")?;
    let at = Spot::new(file, list.span());
    let Some(tables) = list.get_ref().as_array() else {
        notes.error(at, "`key` must be a list of tables").help = Some("write `[[key]]`".to_owned());
        return None;
    };
    let mut keys: Vec<CameraKey> = Vec::new();
    for value in tables {
        let at = Spot::new(file, value.span());
        let Some(table) = value.get_ref().as_table() else {
            notes.error(at, "`key` must be a list of tables").help =
                Some("write `[[key]]`".to_owned());
            continue;
        };
        let values = Values::read(&CAMERA_KEY, table, at, notes);
        let before = keys.last().map(|key| key.time);
        keys.extend(key(&values, before, notes));
    }
    if tables.len() < 2 {
        notes.error(at, "a way has two keys at least; this is one");
    }
    Some(CameraPath { pictures: values.integer("pictures")? as u32, keys })
}

/// One key; what is wrong with it has been said.
fn key(v: &Values, before: Option<f64>, notes: &mut Notes) -> Option<CameraKey> {
    let key = CameraKey {
        time: v.number("time")?,
        eye: v.vector("eye")?,
        look_at: v.vector("look_at")?,
        up: v.vector("up")?,
        fov: v.number("fov"),
        height: v.number("height"),
        place: notes.place(v.spot),
    };
    if let Some(before) = before.filter(|before| key.time <= *before) {
        let message = format!("`time` must rise from key to key: before it is {before}");
        notes.error(v.spot_of("time"), message);
    }
    let (kind, eye, look_at, up) = (CameraKind::default(), key.eye, key.look_at, key.up);
    let camera = Camera { kind, eye, look_at, up, ..Camera::default() };
    let sound = notes.judge(|key| v.spot_of(key), |faults| judge::camera(&camera, faults));
    sound.then_some(key)
}
