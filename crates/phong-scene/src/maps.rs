//! Colour maps of numbers: which of them a scene draws, and between which numbers each of them runs.

use std::collections::BTreeSet;

use glam::{DAffine3, DVec3};

use crate::bounds::Bounds;
use crate::color::Rgb;
use crate::diagnostic::{Diagnostic, Place, Severity, Span};
use crate::furniture::Legend;
use crate::material::{Material, VertexColors};
use crate::mesh::Field;
use crate::scene::{Object, Scene};
use crate::shape::Shape;
use crate::texture::{MapRange, MapSource, Texture, TextureId, TextureKind, TextureSpace};
use crate::wording::{list, quoted};

/// Colours that stand for numbers, as a legend shows them.
#[derive(Clone, Debug, PartialEq)]
pub struct ColorScale<'s> {
    /// The texture.
    pub texture: TextureId,
    /// Its name.
    pub name: &'s str,
    /// What it shows: `height`, the name of a property and so on; of a gradient `distance`.
    pub of: &'s str,
    /// The numbers of the first colour and of the last.
    pub range: [f64; 2],
    /// `t` from 0 to 1, never falling, and the linear colour there.
    pub stops: &'s [(f32, Rgb)],
    /// The unit of the numbers; `None`: none was said.
    pub unit: Option<&'s str>,
}

impl Scene {
    /// The colour scales that materials use: maps of numbers, and gradients, in the order of the textures.
    #[must_use]
    pub fn color_scales(&self) -> Vec<ColorScale<'_>> {
        let used: BTreeSet<u32> = self
            .materials
            .iter()
            .flat_map(Material::textured)
            .map(|(_, by)| by.texture.0)
            .collect();
        used.into_iter().filter_map(|number| self.color_scale(number)).collect()
    }

    /// The colours of this texture as a scale; `None`: they stand for no numbers.
    #[must_use]
    pub fn color_scale(&self, number: u32) -> Option<ColorScale<'_>> {
        let texture = self.textures.get(number as usize)?;
        let (of, range, stops, unit) = match &texture.kind {
            TextureKind::Map { of, stops, unit, .. } => {
                (of.as_str(), self.map_range(number)?, stops, unit.as_deref())
            }
            TextureKind::Gradient { from, to, stops, .. } => {
                ("distance", [*from, *to], stops, None)
            }
            _ => return None,
        };
        let (texture, name) = (TextureId(number), texture.name.as_str());
        Some(ColorScale { texture, name, of, range, stops, unit })
    }

    /// The scene's legend with colours, range, words and unit in itself, also those that it takes from a texture;
    /// `None`: it has none, or no texture has colours for it.
    #[must_use]
    pub fn legend(&self) -> Option<Legend> {
        let legend = self.furniture.legend.as_ref()?;
        let named = self.textures.iter().position(|texture| texture.name == legend.texture);
        let scale = match named {
            Some(number) => self.color_scale(number as u32),
            None if legend.map.is_none() => self.color_scales().into_iter().next(),
            None => None,
        };
        let said = |own: &str, other: Option<&str>| match own {
            "" => other.unwrap_or_default().to_owned(),
            own => own.to_owned(),
        };
        let [from, to] = scale.as_ref().map_or([0.0, 1.0], |scale| scale.range);
        let stops = scale.as_ref().map(|scale| scale.stops.to_vec());
        Some(Legend {
            texture: String::new(),
            map: Some(legend.map.clone().or(stops)?),
            from: Some(legend.from.unwrap_or(from)),
            to: Some(legend.to.unwrap_or(to)),
            text: said(&legend.text, scale.as_ref().map(|scale| scale.of)),
            unit: said(&legend.unit, scale.as_ref().and_then(|scale| scale.unit)),
            ..legend.clone()
        })
    }

    /// The textures, with numbers for every `range = "auto"` of what something has some of.
    #[must_use]
    pub fn ranged_textures(&self) -> Vec<Texture> {
        self.ranged(|_| true)
    }

    /// The same, but for the depth, whose range is another wherever the camera is.
    pub(crate) fn textures_ranged_of_any_camera(&self) -> Vec<Texture> {
        self.ranged(|source| source != MapSource::Depth)
    }

    fn ranged(&self, is_ranged: impl Fn(MapSource<'_>) -> bool) -> Vec<Texture> {
        let mut textures = self.textures.clone();
        for (number, texture) in textures.iter_mut().enumerate() {
            if let TextureKind::Map { of, range: range @ MapRange::Auto, .. } = &mut texture.kind
                && is_ranged(MapSource::of(of))
                && let Some(found) = self.extremes(number as u32)
            {
                *range = MapRange::Between(found);
            }
        }
        textures
    }

    /// Between which numbers a map runs: as it says, or as what it is on has them, and 0 to 1 where nothing
    /// has any; `None`: it is no map.
    fn map_range(&self, number: u32) -> Option<[f64; 2]> {
        let TextureKind::Map { range, .. } = &self.textures.get(number as usize)?.kind else {
            return None;
        };
        Some(match range {
            MapRange::Between(range) => *range,
            MapRange::Auto => self.extremes(number).unwrap_or([0.0, 1.0]),
        })
    }

    /// The least and the largest number of what a map is on; `None`: nothing has any.
    fn extremes(&self, number: u32) -> Option<[f64; 2]> {
        let texture = &self.textures[number as usize];
        let TextureKind::Map { of, axis, .. } = &texture.kind else { return None };
        let users = Users::of(self, number);
        let source = MapSource::of(of);
        if let MapSource::Property(name) = source {
            let fields = users.objects().filter_map(|object| field(&object.shape, name));
            let values = fields.flat_map(|field| field.values.iter().copied());
            return extremes(values.filter(|v| v.is_finite()).map(f64::from));
        }
        let up = axis.unwrap_or(self.camera.up).normalize_or(DVec3::Y);
        let world = || users.world().corners();
        let in_space = || match texture.space {
            TextureSpace::World => world(),
            TextureSpace::Object => users.own().corners(),
            TextureSpace::Uv => {
                Bounds { min: DVec3::ZERO, max: DVec3::new(1.0, 1.0, 0.0) }.corners()
            }
        };
        let from_space = texture.transform.inverse();
        let corners = || in_space().map(|p| from_space.transform_point3(p));
        let forward = (self.camera.look_at - self.camera.eye).normalize_or(DVec3::NEG_Z);
        let found = match source {
            MapSource::X => extremes(corners().map(|p| p.x)),
            MapSource::Y => extremes(corners().map(|p| p.y)),
            MapSource::Z => extremes(corners().map(|p| p.z)),
            MapSource::Height => extremes(corners().map(|p| up.dot(p))),
            MapSource::Depth => extremes(world().map(|p| forward.dot(p - self.camera.eye))),
            MapSource::Radius => {
                let corners = corners();
                let bounds = corners.into_iter().fold(Bounds::EMPTY, Bounds::with);
                let nearest = bounds.min.max(-bounds.max).max(DVec3::ZERO).length();
                let [_, farthest] = extremes(corners.map(DVec3::length))?;
                Some([nearest, farthest])
            }
            MapSource::Normal => Some([-1.0, 1.0]),
            MapSource::Property(_) => None,
        };
        found.filter(|range| range.iter().all(|v| v.is_finite()))
    }
}

/// The properties of points that textures show which these materials use, each once, with the number of the
/// first texture that shows it; in the order of the textures. A scene draws the first [`Field::MOST`].
#[must_use]
pub fn properties_shown<'t>(
    materials: &[Material],
    is_used: impl Fn(usize) -> bool,
    textures: &'t [Texture],
) -> Vec<(&'t str, usize)> {
    let used: BTreeSet<u32> = materials
        .iter()
        .enumerate()
        .filter(|(number, _)| is_used(*number))
        .flat_map(|(_, material)| material.textured())
        .map(|(_, by)| by.texture.0)
        .collect();
    let mut shown: Vec<(&str, usize)> = Vec::new();
    for number in used.into_iter().map(|number| number as usize) {
        if let Some(TextureKind::Map { of, .. }) = textures.get(number).map(|texture| &texture.kind)
            && let Some(name) = MapSource::of(of).property()
            && !shown.iter().any(|(known, _)| *known == name)
        {
            shown.push((name, number));
        }
    }
    shown
}

fn extremes(values: impl IntoIterator<Item = f64>) -> Option<[f64; 2]> {
    let all = |[low, high]: [f64; 2], v: f64| [low.min(v), high.max(v)];
    let found = values.into_iter().fold([f64::INFINITY, f64::NEG_INFINITY], all);
    (found[0] <= found[1]).then_some(found)
}

/// The field of this name, if the points of a shape have it.
fn field<'s>(shape: &'s Shape, name: &str) -> Option<&'s Field> {
    shape.fields().iter().find(|field| *field.name == *name)
}

/// The objects that a texture is on.
struct Users<'s> {
    scene: &'s Scene,
    /// Whether each material uses it.
    materials: Vec<bool>,
}

impl<'s> Users<'s> {
    fn of(scene: &'s Scene, texture: u32) -> Self {
        let uses = |(_, by): &(&str, crate::texture::TextureRef)| by.texture.0 == texture;
        let materials = scene.materials.iter().map(|m| m.textured().iter().any(uses)).collect();
        Self { scene, materials }
    }

    fn is_of(&self, number: u32) -> bool {
        self.materials.get(number as usize).copied().unwrap_or(false)
    }

    fn is_one(&self, object: &Object) -> bool {
        !matches!(object.shape, Shape::Instance(_))
            && object.material_numbers().any(|number| self.is_of(number))
    }

    /// Those of the scene, and those of its groups.
    fn objects(&self) -> impl Iterator<Item = &'s Object> {
        self.scene.all_objects().filter(|object| self.is_one(object))
    }

    /// The box of them all, each in its own space.
    fn own(&self) -> Bounds {
        let boxes = self.objects().map(|object| object.shape.bounds(DAffine3::IDENTITY));
        boxes.fold(Bounds::EMPTY, Bounds::union)
    }

    /// The box of them all where they are placed.
    fn world(&self) -> Bounds {
        let mut groups = Vec::with_capacity(self.scene.groups.len());
        let all = |objects: &[Object], groups: &[Bounds]| {
            let drawn = |object: &&Object| {
                matches!(object.shape, Shape::Instance(_)) || self.is_one(object)
            };
            let boxes = objects.iter().filter(drawn).map(|object| object.bounds(groups));
            boxes.fold(Bounds::EMPTY, Bounds::union)
        };
        for group in &self.scene.groups {
            let next = all(&group.objects, &groups);
            groups.push(next);
        }
        all(&self.scene.objects, &groups)
    }
}

/// Says which maps show what is not there.
pub(crate) fn check(scene: &Scene, say: &mut dyn FnMut(Diagnostic)) {
    for (number, texture) in scene.textures.iter().enumerate() {
        let TextureKind::Map { of, range, .. } = &texture.kind else { continue };
        let users = Users::of(scene, number as u32);
        if users.objects().next().is_none() {
            continue;
        }
        let called = quoted(&texture.name);
        let source = MapSource::of(of);
        covered(scene, number as u32, &users, say);
        if let Some(name) = source.property() {
            let without: Vec<_> =
                users.objects().filter(|object| field(&object.shape, name).is_none()).collect();
            let has_any = without.len() < users.objects().count();
            let (name, objects) = (quoted(name), without.iter().map(|object| object.name.as_str()));
            let objects = list(objects.take(5), "and");
            if !has_any {
                let message = format!(
                    "the texture {called} shows the property {name}, which no points have that it is on: {objects}"
                );
                let help = "properties are those of the vertices of PLY files, and an `[[include]]` that brings the map stands before them; or one of `height`, `radius`, `x`, `y`, `z`, `depth` and `normal`";
                // Solids have none anyway; a file that was to bring some is a mistake.
                let is_of_file = |object: &Object| {
                    matches!(object.shape, Shape::Mesh(_) | Shape::Points(_) | Shape::Cylinders(_))
                };
                let severity = if users.objects().any(is_of_file) {
                    Severity::Error
                } else {
                    Severity::Warning
                };
                let told = Diagnostic::warning(message, at(&texture.place)).with_help(help);
                say(Diagnostic { severity, ..told });
                continue;
            }
            if !without.is_empty() {
                let message = format!(
                    "the texture {called} shows the property {name}, which points of these have not: {objects}"
                );
                let help = "they are drawn in the colour `nan`";
                say(Diagnostic::warning(message, at(&texture.place)).with_help(help));
            }
        }
        if *range == MapRange::Auto && scene.extremes(number as u32).is_none() {
            let message =
                format!("the texture {called} finds no numbers for its `range`: 0 to 1 is taken");
            let help = "planes have no end; `range = [low, high]` says it";
            say(Diagnostic::warning(message, at(&texture.place)).with_help(help));
        }
    }
    let of_objects: BTreeSet<u32> =
        scene.all_objects().flat_map(Object::material_numbers).collect();
    let is_used = |number: usize| of_objects.contains(&(number as u32));
    let shown = properties_shown(&scene.materials, is_used, &scene.textures);
    if let Some((name, number)) = shown.get(Field::MOST) {
        let texture = &scene.textures[*number];
        let message = format!(
            "the texture {} shows the property {}, but a scene draws at most {}, and there are {}",
            quoted(&texture.name),
            quoted(name),
            Field::MOST,
            shown.len()
        );
        say(Diagnostic::error(message, at(&texture.place)));
    }
    let no_colors = scene.furniture.legend.is_some() && scene.legend().is_none();
    if no_colors && !scene.objects.is_empty() {
        let message = "the legend is not drawn: no material uses a texture with colours from one number to another";
        let help = "name the legend's `texture`, or give it a `map`";
        say(Diagnostic::warning(message, None).with_help(help));
    }
}

/// Says which objects have colours of their own, in place of those of a map.
fn covered(scene: &Scene, texture: u32, users: &Users<'_>, say: &mut dyn FnMut(Diagnostic)) {
    let by_color = |object: &&Object| {
        let material = scene.materials.get(object.material.0 as usize);
        let replaced = material.filter(|m| m.vertex_colors == VertexColors::Replace);
        let color = replaced.and_then(|material| material.color.texture());
        color.is_some_and(|by| by.texture.0 == texture)
    };
    for object in users.objects().filter(|object| object.shape.has_colors()).filter(by_color) {
        let name = quoted(&scene.textures[texture as usize].name);
        let message = format!(
            "the points of {} have colours of their own, which are drawn in place of the texture {name}",
            object.name
        );
        say(Diagnostic::warning(message, at(&object.place)));
    }
}

fn at(place: &Place) -> Option<Span> {
    (!place.file.is_empty()).then(|| Span { place: place.clone(), ..Span::default() })
}
