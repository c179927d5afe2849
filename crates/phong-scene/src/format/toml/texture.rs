//! `[textures.NAME]`, and what takes its values from one.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use glam::{DAffine3, DVec3};
use toml::de::DeTable;

use super::change::Laid;
use super::draft::{Named, say_unknown_name};
use super::notes::Notes;
use super::path::{join, normal};
use super::shape;
use super::table::Values;
use super::text::Spot;
use crate::check::{material as judge, texture as texture_judge};
use crate::limits::Limits;
use crate::material::Material;
use crate::source::Source;
use crate::texels::{self, Texels};
use crate::texture::{MapSource, Texture, TextureId, TextureKind, TextureRef};
use crate::wording;

/// The images of textures, each file of which is read once.
#[derive(Debug, Default)]
pub(super) struct ImageFiles(BTreeMap<String, Result<Arc<Texels>, String>>);

impl ImageFiles {
    /// Those that could be read.
    pub(super) fn read(&self) -> impl Iterator<Item = &Texels> {
        self.0.values().flatten().map(AsRef::as_ref)
    }
}

/// Where the images of one file's textures are found.
pub(super) struct Images<'a> {
    /// The file that names them.
    pub(super) path: &'a str,
    pub(super) source: &'a dyn Source,
    pub(super) limits: &'a Limits,
    pub(super) read: &'a mut ImageFiles,
}

impl Images<'_> {
    /// The pixels of the image of this name, which stands there; `None`: what is wrong has been said.
    pub(super) fn load(
        &mut self,
        file: &str,
        spot: Spot,
        notes: &mut Notes,
    ) -> Option<Arc<Texels>> {
        let path = join(self.path, file);
        let key = normal(&path);
        if !self.read.0.contains_key(&key) {
            let limits = Texels::left(self.limits, self.read.read());
            let mut warn = |message: String| {
                notes.warning(spot, format!("{}: {message}", wording::path(&path)));
            };
            let read = texels::load(&path, self.source, &limits, &mut warn);
            self.read.0.insert(key.clone(), read);
        }
        match &self.read.0[&key] {
            Ok(texels) => Some(Arc::clone(texels)),
            Err(message) => {
                let message = format!("{} cannot be read: {message}", wording::path(&path));
                notes.error(spot, message);
                None
            }
        }
    }
}

/// A texture; what is wrong with it has been said.
pub(super) fn texture(
    v: &Values,
    name: &str,
    images: &mut Images<'_>,
    notes: &mut Notes,
) -> Option<Texture> {
    let mut texture =
        Texture { name: name.to_owned(), place: notes.place(v.spot), ..Texture::default() };
    v.fill(&mut texture)?;
    texture.transform = place(v, notes)?;
    if let TextureKind::Image { file, texels, .. } = &mut texture.kind {
        *texels = images.load(file, v.spot_of("file"), notes)?;
    }
    let sound =
        notes.judge(|key| v.spot_of(key), |faults| texture_judge::texture(&texture, faults));
    sound.then_some(texture)
}

/// Notes the names of the textures that a material uses.
pub(super) fn note_used(text: &DeTable<'_>, over: &[&Laid<'_>], names: &mut BTreeSet<String>) {
    let values = text.values().map(toml::Spanned::get_ref);
    for value in values.chain(over.iter().map(|laid| laid.value.get_ref())) {
        let texture = value.get("texture").and_then(|name| name.get_ref().as_str());
        names.extend(texture.map(str::to_owned));
    }
}

/// Notes the property of points that a texture shows, if it does.
pub(super) fn note_property(text: &DeTable<'_>, over: &[&Laid<'_>], names: &mut Vec<String>) {
    let laid = |key: &str| over.iter().find(|laid| laid.target.key.name == key);
    let said = |key: &str| match laid(key) {
        Some(laid) => laid.value.get_ref().as_str(),
        None => text.get(key).and_then(|value| value.get_ref().as_str()),
    };
    let (Some("map"), Some(of)) = (said("kind"), said("of")) else { return };
    let Some(name) = MapSource::of(of).property() else { return };
    if !names.iter().any(|known| known == name) {
        names.push(name.to_owned());
    }
}

/// Where it lies in its space. A `scale` that is the kind's own is none of it.
fn place(v: &Values, notes: &mut Notes) -> Option<DAffine3> {
    if !v.has_own("scale") {
        return shape::transform(v, notes);
    }
    if v.has("matrix") {
        if let Some(other) = ["rotate", "translate"].into_iter().find(|key| v.has(key)) {
            notes.error(v.spot_of(other), format!("`{other}` stands beside `matrix`")).help =
                Some("write the matrix alone, or none".to_owned());
            return None;
        }
        return v.matrix("matrix");
    }
    shape::placement(v, DVec3::ONE, notes)
}

/// The textures that materials name, in the order of the text. Until they are looked up, a
/// material's textures are numbered by this list.
#[derive(Default)]
pub(super) struct TextureNames(Vec<TextureName>);

struct TextureName {
    name: String,
    /// Where the parameter's value stands.
    spot: Spot,
}

impl TextureNames {
    /// The texture of this name, which stands there.
    pub(super) fn take(&mut self, by: TextureRef, name: &str, spot: Spot) -> TextureRef {
        let texture = TextureId(self.0.len() as u32);
        self.0.push(TextureName { name: name.to_owned(), spot });
        TextureRef { texture, ..by }
    }

    /// Says of every texture named that is not there; which of them are named.
    pub(super) fn look_up(&self, textures: &Named<Texture>, notes: &mut Notes) -> BTreeSet<u32> {
        let mut used = BTreeSet::new();
        for TextureName { name, spot } in &self.0 {
            match textures.find(name) {
                Some(number) => drop(used.insert(number)),
                None => say_unknown_name(notes, "texture", name, textures.names(), *spot),
            }
        }
        used
    }

    /// Gives a material its textures, and says of every value that a parameter cannot have. Where
    /// one of them is not there, which has been said, the first of the scene stands in.
    pub(super) fn settle(
        &self,
        material: &Material,
        named: &Named<Texture>,
        textures: &[Texture],
        notes: &mut Notes,
    ) -> Material {
        let spots: BTreeMap<_, _> = material
            .textured()
            .into_iter()
            .map(|(key, by)| (key, &self.0[by.texture.0 as usize]))
            .collect();
        let number = |TextureId(at): TextureId| named.find(&self.0[at as usize].name);
        let settled = material.renumber_textures(|id| TextureId(number(id).unwrap_or(0)));
        let all_there = spots.values().all(|TextureName { name, .. }| named.find(name).is_some());
        if let (Some(first), true) = (spots.values().next(), all_there) {
            let spot_of = |key: &str| spots.get(key).map_or(first.spot, |name| name.spot);
            notes.judge(spot_of, |faults| judge::material(&settled, Some(textures), faults));
        }
        settled
    }
}
