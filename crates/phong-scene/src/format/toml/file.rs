//! What a scene names by file: other scene files, and models.

use std::path::{Component, Path, PathBuf};

use super::draft::DraftShape;
use super::reader::Reader;
use super::table::Values;
use super::text::{self, Spot, Text};
use crate::format::model::Part;
use crate::format::{Format, models_are_read_from, read_model};
use crate::mesh::{Mesh, Points};
use crate::shape::Shape;
use crate::source::trouble;
use crate::wording;

/// Most files that a scene may include, those included by others too: a file that includes the
/// next one twice, and so on, would otherwise double the work at every step.
const MOST_FILES: u32 = 10_000;

impl Reader<'_> {
    /// `[[include]]`: reads the file at this place.
    pub(super) fn include(&mut self, v: &Values, path: &str) {
        let Some(name) = v.text("file") else { return };
        let spot = v.spot_of("file");
        let inner = join(path, &name);
        let normal = normal(&inner);
        if self.open.contains(&normal) {
            let from = self.open.iter().position(|open| *open == normal).unwrap_or(0);
            let round = self.open[from..].join(" → ");
            let message = format!(
                "the file includes itself: {}",
                wording::path(&format!("{round} → {normal}"))
            );
            self.notes.error(spot, message);
            return;
        }
        if self.open.len() as u64 > u64::from(self.limits.nesting) {
            let message = format!("includes go deeper than {}", self.limits.nesting);
            self.notes.error(spot, message);
            return;
        }
        if self.files >= MOST_FILES {
            self.notes.error(spot, format!("more than {MOST_FILES} files are included"));
            return;
        }
        let mut limits = self.limits.clone();
        limits.text_bytes = limits.text_bytes.saturating_sub(self.bytes);
        match text::load(&inner, self.source, &limits) {
            Ok(text) => {
                let mut at = self.notes.text(v.spot.file).at.clone();
                at.push(v.spot.start);
                self.file(&inner, Text::new(inner.as_str().into(), text, at));
            }
            Err(message) => {
                let message = format!("{} cannot be read: {message}", wording::path(&inner));
                self.notes.error(spot, message);
            }
        }
    }

    /// `[[mesh]]`: the parts of its file, each with the file's name for it.
    pub(super) fn mesh(&mut self, v: &Values, path: &str) -> Vec<(String, DraftShape)> {
        let Some((file, parts, model)) = self.model(v, path, None) else { return Vec::new() };
        let smooth = |mesh: &mut Mesh| match (v.flag("smooth"), v.number("smooth")) {
            (Some(false), _) => drop_normals(mesh),
            (_, Some(degrees)) => {
                drop_normals(mesh);
                mesh.smooth(degrees);
            }
            _ if mesh.normals.is_empty() => mesh.smooth(60.0),
            _ => {}
        };
        let mut shapes = Vec::with_capacity(parts.len());
        for part in parts {
            let Part::Mesh { name, mut mesh } = part else {
                let help = "write `[[points]]` to draw a sphere at each";
                let message = format!("{} holds points without faces", wording::path(&file));
                self.notes.error(v.spot_of("file"), message).help = Some(help.to_owned());
                return Vec::new();
            };
            smooth(&mut mesh);
            shapes.push(if mesh.face_materials.is_empty() || v.has("material") {
                mesh.face_materials = Vec::new();
                (name, DraftShape::Shape(Shape::Mesh(Box::new(mesh))))
            } else {
                (name, DraftShape::Model(Box::new(mesh), model))
            });
        }
        shapes
    }

    /// `[[points]]`: the points of its file; of a mesh, its vertices.
    pub(super) fn points(&mut self, v: &Values, path: &str) -> Vec<(String, DraftShape)> {
        let radius = v.number("radius").map(|radius| radius as f32);
        let Some((file, parts, _)) = self.model(v, path, radius) else { return Vec::new() };
        let mut shapes = Vec::with_capacity(parts.len());
        for part in parts {
            let (name, points) = match (part, radius) {
                (Part::Points { name, points }, _) => (name, points),
                (Part::Mesh { name, mesh }, Some(radius)) => (name, vertices(mesh, radius)),
                (Part::Mesh { .. }, None) => {
                    let message = format!("{} gives its points no radius", wording::path(&file));
                    let help = "write `radius = ..`, the radius of the spheres";
                    self.notes.error(v.spot, message).help = Some(help.to_owned());
                    return Vec::new();
                }
            };
            shapes.push((name, DraftShape::Shape(Shape::Points(Box::new(points)))));
        }
        shapes
    }

    /// The parts of the file that `v` names, and the number of its list of materials.
    fn model(
        &mut self,
        v: &Values,
        path: &str,
        radius: Option<f32>,
    ) -> Option<(String, Vec<Part>, usize)> {
        let name = v.text("file")?;
        let spot = v.spot_of("file");
        let file = join(path, &name);
        let Some(format) = Format::of_path(&file) else {
            self.say_format(
                spot,
                &format!("the name {} does not say what the file is", wording::path(&name)),
            );
            return None;
        };
        if !matches!(format, Format::Obj | Format::Ply) {
            let message = match format {
                Format::Toml => "a scene cannot be drawn as a model".to_owned(),
                _ => format!("{format} files are not read yet"),
            };
            self.say_format(spot, &message);
            return None;
        }
        if let Err(e) = self.source.open(&file) {
            let message = format!("{} cannot be read: {}", wording::path(&file), trouble(&e));
            self.notes.error(spot, message);
            return None;
        }
        let mut said = Vec::new();
        let model = read_model(&file, format, radius, self.source, self.limits, &mut said);
        for diagnostic in said {
            let label = self.notes.span(spot);
            let diagnostic = if diagnostic.is_error() {
                diagnostic.with_label("the file is named here", label)
            } else {
                diagnostic
            };
            self.notes.say(spot, diagnostic);
        }
        let model = model?;
        self.models.push(if v.has("material") { Vec::new() } else { model.materials });
        Some((file, model.parts, self.models.len() - 1))
    }

    fn say_format(&mut self, spot: Spot, message: &str) {
        self.notes.error(spot, message).help =
            Some(format!("{}; scenes by `[[include]]`", models_are_read_from()));
    }
}

/// Flat triangles.
fn drop_normals(mesh: &mut Mesh) {
    mesh.normals = Vec::new();
    mesh.normal_indices = Vec::new();
}

/// A sphere at every vertex.
fn vertices(mesh: Mesh, radius: f32) -> Points {
    let spheres = mesh.positions.iter().map(|p| [p.x, p.y, p.z, radius]).collect();
    Points { origin: mesh.origin, spheres, colors: mesh.colors }
}

/// `file` as it is written in the file at `path`: relative to that one's folder.
fn join(path: &str, file: &str) -> String {
    let folder = Path::new(path).parent().unwrap_or(Path::new(""));
    folder.join(file).to_string_lossy().into_owned()
}

/// A path without `.` and, where that can be told from the path alone, `..`.
pub(super) fn normal(path: &str) -> String {
    let mut normal = PathBuf::new();
    for part in Path::new(path).components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir
                if matches!(normal.components().next_back(), Some(Component::Normal(_))) =>
            {
                normal.pop();
            }
            _ => normal.push(part),
        }
    }
    normal.to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_relative_to_the_one_that_names_it() {
        assert_eq!(join("scenes/a.toml", "lights/b.toml"), "scenes/lights/b.toml");
        assert_eq!(join("a.toml", "b.toml"), "b.toml");
        assert_eq!(join("scenes/a.toml", "/b.toml"), "/b.toml");
    }

    #[test]
    fn two_ways_to_the_same_file_have_one_normal_path() {
        assert_eq!(normal("./a/../b/./c.toml"), "b/c.toml");
        assert_eq!(normal("../a.toml"), "../a.toml");
        assert_eq!(normal("../../a/../b.toml"), "../../b.toml");
    }
}
