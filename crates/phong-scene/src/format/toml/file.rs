//! What a scene names by file: other scene files, and models.

use super::draft::{Draft, DraftShape, Looks, Part};
use super::path::{join, normal};
use super::reader::Reader;
use super::table::Values;
use super::text::{self, Text};
use crate::format::input::{Input, Named, ReadModel, Wanted};
use crate::fragment::Fragment;
use crate::limits::Limits;
use crate::mesh::{Caps, Mesh, Points, Shared};
use crate::scene::Object;
use crate::shape::{GroupId, Shape};
use crate::source::trouble;
use crate::texels::Texels;
use crate::texture::Texture;
use crate::wording::{self, Word};

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
        let found = (self.models.find)(&inner, self.source);
        if matches!(found, Named::Model(_) | Named::Foreign(_) | Named::Refused(_)) {
            return self.include_model(v, path);
        }
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

    /// `[[include]]` of a model: all of it, at this place.
    fn include_model(&mut self, v: &Values, path: &str) {
        let Some((file, mut fragment, number)) = self.fragment(v, path, Wanted::Anything, None)
        else {
            return;
        };
        if fragment.camera.is_some() {
            let message = format!("the camera of {} is not used", wording::path(&file));
            self.notes.warning(v.spot_of("file"), message);
        }
        self.lights.append(&mut fragment.lights);
        let place = self.notes.place(v.spot);
        for part in self.parts(fragment, number, v, Some) {
            let kind = match &part.shape {
                DraftShape::Shape(shape) | DraftShape::Part(shape, ..) => shape.kind(),
                DraftShape::Instance(..) => "instance",
            };
            let name = self.numbered(kind);
            let Part { name: own, shape, transform } = part;
            let name = if own.is_empty() { name } else { own };
            self.drafts.push(Draft {
                name,
                shape,
                material: None,
                transform,
                place: place.clone(),
            });
        }
    }

    /// `[[mesh]]`: the triangles of its file.
    pub(super) fn mesh(&mut self, v: &Values, path: &str) -> Vec<Part> {
        let Some((file, fragment, number)) = self.fragment(v, path, Wanted::Anything, None) else {
            return Vec::new();
        };
        let mut read = std::mem::take(&mut self.read);
        let mut smooth = |mesh: &mut Mesh| match (v.flag("smooth"), v.number("smooth")) {
            (Some(false), _) => drop_normals(mesh),
            (_, Some(degrees)) => read.smooth(mesh, degrees),
            _ if mesh.normals.is_empty() => read.smooth(mesh, 60.0),
            _ => {}
        };
        let mut others = false;
        let parts = self.parts(fragment, number, v, |mut shape| {
            match &mut shape {
                Shape::Mesh(mesh) => smooth(mesh),
                Shape::Triangle { .. } | Shape::Instance(_) => {}
                _ => others = true,
            }
            (!others).then_some(shape)
        });
        self.read = read;
        if others {
            let help = "write `[[points]]` to draw a sphere at each";
            let message = format!("{} holds points without faces", wording::path(&file));
            self.notes.error(v.spot_of("file"), message).help = Some(help.to_owned());
        }
        parts
    }

    /// `[[points]]`: the points of its file; of a mesh, its vertices.
    pub(super) fn points(&mut self, v: &Values, path: &str) -> Vec<Part> {
        let radius = v.number("radius").map(|radius| radius as f32);
        let Some((file, fragment, number)) = self.fragment(v, path, Wanted::Points, radius) else {
            return Vec::new();
        };
        let mut without_radius = false;
        let parts = self.parts(fragment, number, v, |shape| match (shape, radius) {
            (Shape::Mesh(mesh), Some(radius)) => Some(vertices(*mesh, radius).into()),
            (Shape::Mesh(_), None) => {
                without_radius = true;
                None
            }
            (shape, _) => Some(shape),
        });
        if without_radius {
            let message = format!("{} gives its points no radius", wording::path(&file));
            let help = "write `radius = ..`, the radius of the spheres";
            self.notes.error(v.spot, message).help = Some(help.to_owned());
        }
        parts
    }

    /// `[[cylinders]]`: the segments of its file.
    pub(super) fn cylinders(&mut self, v: &Values, path: &str) -> Vec<Part> {
        let radius = v.number("radius").map(|radius| radius as f32);
        let caps = v.word("caps").and_then(Caps::of_word).unwrap_or_default();
        let Some((file, fragment, number)) = self.fragment(v, path, Wanted::Segments, radius)
        else {
            return Vec::new();
        };
        let (mut others, mut empty) = (false, 0);
        let parts = self.parts(fragment, number, v, |shape| match shape {
            Shape::Cylinders(mut cylinders) => {
                cylinders.caps = caps;
                empty += cylinders.drop_empty();
                (!cylinders.segments.is_empty()).then_some(Shape::Cylinders(cylinders))
            }
            Shape::Instance(_) => Some(shape),
            _ => {
                others = true;
                None
            }
        });
        let file = wording::path(&file);
        if others {
            let help = "a PLY file has them in an element `edge` of `vertex1` and `vertex2`";
            let message = format!("{file} holds no edges");
            self.notes.error(v.spot_of("file"), message).help = Some(help.to_owned());
        }
        if empty > 0 {
            let message = format!(
                "edges without length in {file}: {empty}; they are left out, since their ends \
                 are not round"
            );
            self.notes.warning(v.spot_of("file"), message);
            if parts.is_empty() {
                let message = format!("there is nothing to draw: no edge of {file} is left");
                self.notes.error(v.spot_of("file"), message);
            }
        }
        parts
    }

    /// The objects of the fragment of this number, those of its groups as groups of the scene; each
    /// shape as `make` makes it, or left out.
    pub(super) fn parts(
        &mut self,
        fragment: Fragment,
        number: usize,
        v: &Values,
        mut make: impl FnMut(Shape) -> Option<Shape>,
    ) -> Vec<Part> {
        let place = self.notes.place(v.spot);
        // Behind the file and its number, so that a file may be named twice.
        let file = v.text("file").unwrap_or_default();
        let group_name = |group: usize, name: &str| format!("{file} {number}: {name} {group}");
        let names: Vec<_> = fragment
            .groups
            .iter()
            .enumerate()
            .map(|(i, group)| group_name(i, &group.name))
            .collect();
        let mut part = |object: Object| -> Option<Part> {
            let Object { name, shape, material, transform, .. } = object;
            let shape = match make(shape)? {
                Shape::Instance(GroupId(group)) => {
                    let name = names.get(group as usize)?.clone();
                    DraftShape::Instance(name, v.spot_of("file"))
                }
                shape => DraftShape::Part(shape, material, number),
            };
            Some(Part { name, shape, transform })
        };
        for (group, name) in fragment.groups.into_iter().zip(&names) {
            let parts = group.objects.into_iter().filter_map(&mut part);
            let draft = |Part { name, shape, transform }| Draft {
                name,
                shape,
                material: None,
                transform,
                place: place.clone(),
            };
            let drafts = parts.map(draft).collect();
            if let Some(group) = self.groups.declare("group", name, v.spot, &mut self.notes) {
                self.groups.items[group as usize].2 = Some(drafts);
            }
        }
        fragment.objects.into_iter().filter_map(part).collect()
    }

    /// What the file that `v` names holds, and the number of its list of materials.
    fn fragment(
        &mut self,
        v: &Values,
        path: &str,
        wanted: Wanted,
        radius: Option<f32>,
    ) -> Option<(String, Fragment, usize)> {
        let (file, read) = self.reader_of(v, path)?;
        let mut fragment = match self.read.find(&normal(&file), (wanted, self.fields.len()), radius)
        {
            Some(fragment) => fragment,
            None => self.read_file(v, &file, read, wanted, radius)?,
        };
        let number = self.take_materials(v, &mut fragment);
        Some((file, fragment, number))
    }

    /// Takes the materials and textures of a fragment, if its own are wanted; the number of their list.
    pub(super) fn take_materials(&mut self, v: &Values, fragment: &mut Fragment) -> usize {
        // All of it is of the material that the table names, if it names one.
        self.fragments.push(if v.has("material") {
            Looks::default()
        } else {
            let materials = fragment.materials.split_off(1);
            Looks { materials, textures: std::mem::take(&mut fragment.textures) }
        });
        self.fragments.len() - 1
    }

    /// The file that `v` names and what reads it.
    pub(super) fn reader_of(&mut self, v: &Values, path: &str) -> Option<(String, ReadModel)> {
        let name = v.text("file")?;
        let spot = v.spot_of("file");
        let file = join(path, &name);
        let message = match (self.models.find)(&file, self.source) {
            Named::Model(read) => return Some((file, read)),
            Named::Scene => "a scene cannot be drawn as a model".to_owned(),
            Named::Foreign(format) => {
                format!(
                    "{format} scenes are no part of another scene; `phong convert` makes a .toml"
                )
            }
            Named::Refused(format) => format!("{format} files are not read as models"),
            Named::Unknown => {
                format!("the name {} does not say what the file is", wording::path(&name))
            }
        };
        let help = format!("{}; scenes by `[[include]]`", (self.models.help)());
        self.notes.error(spot, message).help = Some(help);
        None
    }

    fn read_file(
        &mut self,
        v: &Values,
        file: &str,
        read: ReadModel,
        wanted: Wanted,
        radius: Option<f32>,
    ) -> Option<Fragment> {
        let fields = std::mem::take(&mut self.fields);
        let limits = Texels::left(&self.left_of_models(), self.images.read());
        let new = Input::new(file, self.source, &limits);
        let input = Input { radius, wanted, fields: &fields, ..new };
        let fragment = self.read_input(v, &input, read);
        self.fields = fields;
        let fragment = fragment?;
        self.read.keep(normal(file), (wanted, self.fields.len()), radius, &fragment);
        Some(fragment)
    }

    /// The limits of what is read next, where the images of models count that there are already.
    pub(super) fn left_of_models(&self) -> Limits {
        let textures = self.fragments.iter().flat_map(|looks| &looks.textures);
        Texels::left(self.limits, textures.filter_map(Texture::texels))
    }

    /// Reads a file and says what there is to say about it.
    pub(super) fn read_input(
        &mut self,
        v: &Values,
        input: &Input<'_>,
        read: ReadModel,
    ) -> Option<Fragment> {
        let file = input.path;
        let spot = v.spot_of("file");
        if let Err(e) = self.source.open(file) {
            let message = format!("{} cannot be read: {}", wording::path(file), trouble(&e));
            self.notes.error(spot, message);
            return None;
        }
        let mut said = Vec::new();
        let fragment = read(input, &mut said);
        for diagnostic in said {
            let label = self.notes.span(spot);
            let diagnostic = if diagnostic.is_error() {
                diagnostic.with_label("the file is named here", label)
            } else {
                diagnostic
            };
            self.notes.say(spot, diagnostic);
        }
        fragment
    }
}

/// Flat triangles.
fn drop_normals(mesh: &mut Mesh) {
    mesh.normals = Shared::default();
    mesh.normal_indices = Shared::default();
}

/// A sphere at every vertex.
fn vertices(mesh: Mesh, radius: f32) -> Points {
    let spheres = mesh.positions.iter().map(|p| [p.x, p.y, p.z, radius]).collect();
    let Mesh { origin, colors, fields, .. } = mesh;
    Points { origin, spheres, colors, fields, ..Points::default() }
}
