//! One file after another, in the order of the text, into the parts of a scene.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use glam::DAffine3;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::change::Changes;
use super::draft::{Draft, DraftShape, Looks, Named, Part, say_unknown_name};
use super::notes::Notes;
use super::path::normal;
use super::table::{Values, say_unknown};
use super::text::{Spot, Text};
use super::texture::{self, ImageFiles, Images, TextureNames};
use super::{material, reuse, settings, shape, syntax};
use crate::ambient_occlusion::AmbientOcclusion;
use crate::camera::Camera;
use crate::change::Change;
use crate::clip::Clip;
use crate::color::Rgb;
use crate::diagnostic::Diagnostic;
use crate::fog::Fog;
use crate::format::input::Models;
use crate::furniture::Furniture;
use crate::keys::{self, Kind, Table};
use crate::light::Light;
use crate::limits::Limits;
use crate::material::Material;
use crate::molecule::Topology;
use crate::outline::Outline;
use crate::scene::{Image, Scene};
use crate::sky::Sky;
use crate::source::Source;
use crate::texture::Texture;
use crate::tone::Tone;
use crate::wording::quoted;

/// Reads a scene's files; names between them are looked up when all are read.
pub(super) struct Reader<'a> {
    pub(super) source: &'a dyn Source,
    pub(super) limits: &'a Limits,
    /// Bonds of earlier frames; `None`: there are no frames.
    pub(super) topology: Option<&'a Topology>,
    /// Where the readers of models are found.
    pub(super) models: &'static Models,
    pub(super) notes: Notes,
    /// What is laid over the text.
    pub(super) changes: Changes<'a>,
    pub(super) image: Image,
    pub(super) camera: Option<Camera>,
    pub(super) ambient: Rgb,
    pub(super) ambient_occlusion: Option<AmbientOcclusion>,
    pub(super) fog: Option<Fog>,
    pub(super) outline: Option<Outline>,
    pub(super) furniture: Furniture,
    label_count: usize,
    pub(super) tone: Option<Tone>,
    /// Where the legend names its texture, or begins.
    pub(super) legend_spot: Spot,
    pub(super) sky: Option<Sky>,
    /// The clips, and where in `material_names` the material of each one's cap is.
    pub(super) clips: Vec<(Clip, Option<usize>)>,
    clip_count: usize,
    pub(super) lights: Vec<Light>,
    light_count: usize,
    pub(super) materials: Named<Material>,
    pub(super) textures: Named<Texture>,
    /// The images of textures that were read.
    pub(super) images: ImageFiles,
    /// The textures that materials name.
    pub(super) texture_names: TextureNames,
    /// The materials that shapes name, and where.
    pub(super) material_names: Vec<(String, Spot)>,
    /// What fragments are made of.
    pub(super) fragments: Vec<Looks>,
    /// The models that were read.
    pub(super) read: reuse::Models,
    pub(super) groups: Named<Vec<Draft>>,
    pub(super) drafts: Vec<Draft>,
    /// How many shapes of each kind there were so far.
    counts: BTreeMap<&'static str, usize>,
    /// The files that are being read, outermost first, as lexically normal paths.
    pub(super) open: Vec<String>,
    /// The properties of points that maps show, as far as the text was looked through.
    pub(super) fields: Vec<String>,
    /// How many files were read, and bytes of text.
    pub(super) files: u32,
    pub(super) bytes: u64,
}

/// What is read in the order of the text.
enum Item<'t> {
    Material(&'t str, &'t DeTable<'t>),
    Texture(&'t str, &'t DeTable<'t>),
    Light(&'t DeTable<'t>),
    Clip(&'t DeTable<'t>),
    Label(&'t DeTable<'t>),
    Shape(&'static Table, &'t DeTable<'t>, Option<u32>),
    Include(&'t DeTable<'t>),
}

impl<'a> Reader<'a> {
    /// Nothing read yet.
    pub(super) fn new(source: &'a dyn Source, limits: &'a Limits, models: &'static Models) -> Self {
        Self {
            source,
            limits,
            topology: None,
            models,
            notes: Notes::default(),
            changes: Changes::default(),
            image: Image::default(),
            camera: None,
            ambient: Rgb::WHITE,
            ambient_occlusion: None,
            fog: None,
            outline: None,
            furniture: Furniture::default(),
            label_count: 0,
            tone: None,
            legend_spot: Spot::new(0, 0..0),
            sky: None,
            clips: Vec::new(),
            clip_count: 0,
            lights: Vec::new(),
            light_count: 0,
            materials: Named::new(),
            textures: Named::new(),
            images: ImageFiles::default(),
            texture_names: TextureNames::default(),
            material_names: Vec::new(),
            fragments: Vec::new(),
            read: reuse::Models::default(),
            groups: Named::new(),
            drafts: Vec::new(),
            counts: BTreeMap::new(),
            open: Vec::new(),
            fields: Vec::new(),
            files: 0,
            bytes: 0,
        }
    }

    /// Reads the scene whose text this is; `None` if a diagnostic is an error.
    /// Over it lie these changes, whose values are in `values`.
    pub(super) fn read(
        mut self,
        path: &str,
        text: String,
        changes: &'a [Change],
        values: &'a [String],
    ) -> (Option<Scene>, Vec<Diagnostic>) {
        let text = Arc::new(Text::new(path.into(), text, Vec::new()));
        let number = self.notes.add(Arc::clone(&text));
        self.changes = Changes::new(changes, values, &mut self.notes);
        self.text(path, &text, number);
        self.say_unused();
        self.resolve()
    }

    /// Reads one more file.
    pub(super) fn file(&mut self, path: &str, text: Text) {
        let text = Arc::new(text);
        let number = self.notes.add(Arc::clone(&text));
        self.text(path, &text, number);
    }

    fn text(&mut self, path: &str, text: &Text, number: u32) {
        self.files += 1;
        self.bytes += text.text.len() as u64;
        self.open.push(normal(path));
        let mut mended = String::new();
        let document = syntax::parse(&text.text, number, &mut mended, &mut self.notes);
        self.document(document.get_ref(), path, number);
        self.open.pop();
    }

    fn document(&mut self, document: &DeTable<'_>, path: &str, file: u32) {
        let head = Spot::new(file, 0..0);
        let main = self.open.len() == 1;
        let mut items = Vec::new();
        for (name, value) in document {
            let at = Spot::new(file, name.span());
            let Some(key) = keys::SCENE.find(name.get_ref(), None) else {
                say_unknown(&mut self.notes, at, name.get_ref(), &keys::SCENE, None);
                continue;
            };
            match key.kind {
                Kind::Table(_) if !main => {
                    let message = format!("`[{}]` stands in an included file", key.name);
                    let help = "it belongs in the scene itself; included are lights, materials, groups and shapes";
                    self.notes.error(at, message).help = Some(help.to_owned());
                }
                Kind::Table(table) => {
                    if let Some(text) = self.table(key.name, value, file) {
                        self.setting(table, text, Spot::new(file, value.span()), path);
                    }
                }
                Kind::Tables(table) => {
                    for (text, spot) in self.tables(key.name, value, file) {
                        let item = match key.name {
                            "light" => Item::Light(text),
                            "clip" => Item::Clip(text),
                            "label" => Item::Label(text),
                            "include" => Item::Include(text),
                            _ => Item::Shape(table, text, None),
                        };
                        items.push((spot, item));
                    }
                }
                Kind::Named(_) if key.name == "groups" => self.groups(value, file, &mut items),
                Kind::Named(_) => {
                    for (name, text, spot) in self.named(key.name, value, file) {
                        items.push(match key.name {
                            "textures" => (spot, Item::Texture(name, text)),
                            _ => (spot, Item::Material(name, text)),
                        });
                    }
                }
                _ => self.version(value, file),
            }
        }
        if main {
            self.say_missing(document, head);
            self.settings_not_written(document, head, path);
        }
        items.sort_by_key(|(spot, _)| spot.start);
        // Files that stand before the maps that show something of them must be read with it; first what
        // materials of the same text use, for a file has the first few only.
        let mut used = BTreeSet::new();
        for (_, item) in &items {
            if let Item::Material(name, text) = item {
                let over = self.changes.over("materials", &[name]);
                texture::note_used(text, &over, &mut used);
            }
        }
        for first in [true, false] {
            for (_, item) in &items {
                if let Item::Texture(name, text) = item
                    && used.contains(*name) == first
                {
                    let over = self.changes.over("textures", &[name]);
                    texture::note_property(text, &over, &mut self.fields);
                }
            }
        }
        for (spot, item) in items {
            self.item(spot, &item, path);
        }
    }

    fn version(&mut self, value: &Spanned<DeValue<'_>>, file: u32) {
        let number = value.get_ref().as_integer();
        if number.is_none_or(|number| number.as_str() != "1") {
            let message = "this is not a version that can be read".to_string();
            self.notes.error(Spot::new(file, value.span()), message).help =
                Some("the only version so far is `version = 1`".to_owned());
        }
    }

    fn say_missing(&mut self, document: &DeTable<'_>, head: Spot) {
        self.notes.miss_version(document, head);
        if !document.contains_key("camera") && !self.notes.lost_something(head) {
            self.notes.error(head, "the scene has no `[camera]`").help =
                Some("`[camera]` needs at least `eye` and `look_at`".to_owned());
        }
    }

    /// `[image]`, `[ambient]` and the like where the text has none, and something is laid
    /// over them.
    fn settings_not_written(&mut self, document: &DeTable<'_>, head: Spot, path: &str) {
        for name in ["image", "ambient", "ambient_occlusion", "sky", "fog", "outline", "tone"]
            .into_iter()
            .chain(settings::FURNITURE)
        {
            let Some(Kind::Table(table)) = keys::SCENE.find(name, None).map(|key| key.kind) else {
                continue;
            };
            if !document.contains_key(name) && !self.changes.over(name, &[]).is_empty() {
                self.setting(table, &DeTable::new(), head, path);
            }
        }
    }

    /// Says what of the changes is of nothing that there is.
    fn say_unused(&mut self) {
        // What is missing may be in what could not be read.
        if self.notes.has_errors() {
            return;
        }
        for laid in self.changes.unused() {
            let (list, of) = (laid.target.list.name, laid.target.of.unwrap_or_default());
            match list {
                "materials" => {
                    let known = self.materials.names();
                    say_unknown_name(&mut self.notes, "material", of, known, laid.at);
                }
                "textures" => {
                    let known = self.textures.names();
                    say_unknown_name(&mut self.notes, "texture", of, known, laid.at);
                }
                _ => {
                    let count = match list {
                        "light" => self.light_count,
                        "clip" => self.clip_count,
                        "label" => self.label_count,
                        _ => self.counts.get(list).copied().unwrap_or(0),
                    };
                    let message = format!("the scene has no {list} {of} to change");
                    let help = format!("it has {count} of them, counted from 1");
                    self.notes.error(laid.at, message).help = Some(help);
                }
            }
        }
    }

    /// `[image]`, `[camera]` and the like.
    fn setting(&mut self, table: &'static Table, text: &DeTable<'_>, spot: Spot, path: &str) {
        let over = self.changes.over(table.name, &[]);
        let values = Values::read_changed(table, text, spot, &over, &mut self.notes);
        match table.name {
            "camera" => self.camera = settings::camera(&values, &mut self.notes),
            "ambient" => self.ambient = values.color("color").unwrap_or(Rgb::WHITE),
            "sky" => {
                let images = &mut Images {
                    path,
                    source: self.source,
                    limits: self.limits,
                    read: &mut self.images,
                };
                self.sky = settings::sky(&values, images, &mut self.notes);
            }
            "tone" => self.tone = settings::tone(&values, &mut self.notes),
            "fog" => self.fog = settings::fog(&values, &mut self.notes),
            "ambient_occlusion" => {
                let mut occlusion = AmbientOcclusion::default();
                self.ambient_occlusion = values.fill(&mut occlusion).map(|()| occlusion);
            }
            "outline" => {
                let mut outline = Outline::default();
                self.outline = values.fill(&mut outline).map(|()| outline);
            }
            name if settings::FURNITURE.contains(&name) => {
                if name == "legend" {
                    self.legend_spot = values.spot_of("texture");
                }
                settings::furniture(name, &values, &mut self.furniture, &mut self.notes);
            }
            _ => self.image = settings::image(&values).unwrap_or_default(),
        }
    }

    fn groups<'t>(
        &mut self,
        value: &'t Spanned<DeValue<'t>>,
        file: u32,
        items: &mut Vec<(Spot, Item<'t>)>,
    ) {
        for (name, text, spot) in self.named("groups", value, file) {
            let Some(group) = self.groups.declare("group", name, spot, &mut self.notes) else {
                continue;
            };
            for (kind, value) in text {
                if let Some(key) = keys::GROUP.find(kind.get_ref(), None) {
                    let Kind::Tables(table) = key.kind else { continue };
                    for (text, spot) in self.tables(key.name, value, file) {
                        items.push((spot, Item::Shape(table, text, Some(group))));
                    }
                } else {
                    let at = Spot::new(file, kind.span());
                    say_unknown(&mut self.notes, at, kind.get_ref(), &keys::GROUP, None);
                }
            }
        }
    }

    fn item(&mut self, spot: Spot, item: &Item<'_>, path: &str) {
        match *item {
            Item::Material(name, text) => {
                let over = self.changes.over("materials", &[name]);
                let notes = &mut self.notes;
                let values = Values::read_changed(&keys::MATERIAL, text, spot, &over, notes);
                let names = &mut self.texture_names;
                let read = material::material(&values, name, names, &mut self.notes);
                let declared = self.materials.declare("material", name, spot, &mut self.notes);
                if let Some(number) = declared {
                    self.materials.items[number as usize].2 = read;
                }
            }
            Item::Texture(name, text) => {
                let over = self.changes.over("textures", &[name]);
                let notes = &mut self.notes;
                let values = Values::read_changed(&keys::TEXTURE, text, spot, &over, notes);
                let limits = self.left_of_models();
                let images = &mut Images {
                    path,
                    source: self.source,
                    limits: &limits,
                    read: &mut self.images,
                };
                let read = texture::texture(&values, name, images, &mut self.notes);
                let declared = self.textures.declare("texture", name, spot, &mut self.notes);
                if let Some(number) = declared {
                    self.textures.items[number as usize].2 = read;
                }
            }
            Item::Light(text) => {
                self.light_count += 1;
                let over = self.changes.over("light", &[&self.light_count.to_string()]);
                let notes = &mut self.notes;
                let values = Values::read_changed(&keys::LIGHT, text, spot, &over, notes);
                self.lights.extend(settings::light(&values, self.light_count, &mut self.notes));
            }
            Item::Clip(text) => {
                self.clip_count += 1;
                let over = self.changes.over("clip", &[&self.clip_count.to_string()]);
                let notes = &mut self.notes;
                let values = Values::read_changed(&keys::CLIP, text, spot, &over, notes);
                let cap = values.text("cap").map(|name| {
                    self.material_names.push((name, values.spot_of("cap")));
                    self.material_names.len() - 1
                });
                let clip = settings::clip(&values, &mut self.notes);
                self.clips.extend(clip.map(|clip| (clip, cap)));
            }
            Item::Label(text) => {
                self.label_count += 1;
                let over = self.changes.over("label", &[&self.label_count.to_string()]);
                let notes = &mut self.notes;
                let values = Values::read_changed(&keys::LABEL, text, spot, &over, notes);
                self.furniture.labels.extend(settings::label(&values, &mut self.notes));
            }
            Item::Shape(table, text, group) => {
                let drafts = self.shape(table, text, spot, path);
                match group {
                    Some(group) => {
                        let group = &mut self.groups.items[group as usize].2;
                        group.get_or_insert_default().extend(drafts);
                    }
                    None => self.drafts.extend(drafts),
                }
            }
            Item::Include(text) => {
                let values = Values::read(&keys::INCLUDE, text, spot, &mut self.notes);
                self.include(&values, path);
            }
        }
    }

    /// The objects of one table: several where its file holds several parts.
    fn shape(
        &mut self,
        table: &'static Table,
        text: &DeTable<'_>,
        spot: Spot,
        path: &str,
    ) -> Vec<Draft> {
        let numbered = self.numbered(table.name);
        let number = numbered.rsplit(' ').next().unwrap_or_default();
        let own = text.get("name").and_then(|name| name.get_ref().as_str()).unwrap_or_default();
        let over = self.changes.over(table.name, &[number, own]);
        let v = Values::read_changed(table, text, spot, &over, &mut self.notes);
        let transform = shape::transform(&v, &mut self.notes);
        let name = v.text("name").unwrap_or(numbered);
        // Kept apart, so that it is looked up even if the shape itself is faulty.
        let material = v.text("material").map(|name| {
            self.material_names.push((name, v.spot_of("material")));
            self.material_names.len() - 1
        });
        let parts: Vec<Part> = match table.name {
            "mesh" => self.mesh(&v, path),
            "points" => self.points(&v, path),
            "cylinders" => self.cylinders(&v, path),
            "molecule" => self.molecule(&v, path),
            "instance" => {
                let group = v.text("group").into_iter();
                group.map(|name| DraftShape::Instance(name, v.spot_of("group")).into()).collect()
            }
            kind => {
                let shape = shape::shape(kind, &v, &mut self.notes);
                shape.map(|shape| DraftShape::Shape(shape).into()).into_iter().collect()
            }
        };
        // Whatever is wrong has been said: the scene will not be used, its names still are.
        let transform = transform.unwrap_or(DAffine3::IDENTITY);
        let place = self.notes.place(spot);
        let one = parts.len() == 1;
        let draft = |part: Part| Draft {
            name: if one || part.name.is_empty() {
                name.clone()
            } else {
                format!("{name}: {}", part.name)
            },
            shape: part.shape,
            material,
            // A product with the identity would lose the sign of a 0.
            transform: if part.transform == DAffine3::IDENTITY {
                transform
            } else {
                transform * part.transform
            },
            place: place.clone(),
        };
        parts.into_iter().map(draft).collect()
    }

    /// The name of the next shape of this kind.
    pub(super) fn numbered(&mut self, kind: &'static str) -> String {
        let count = self.counts.entry(kind).or_default();
        *count += 1;
        format!("{kind} {count}")
    }

    /// A table, where there must be one.
    fn table<'t>(
        &mut self,
        name: &str,
        value: &'t Spanned<DeValue<'t>>,
        file: u32,
    ) -> Option<&'t DeTable<'t>> {
        let table = value.get_ref().as_table();
        if table.is_none() {
            let message = format!("`{name}` must be one table");
            self.notes.error(Spot::new(file, value.span()), message).help =
                Some(format!("write `[{name}]`"));
        }
        table
    }

    /// The tables of a list, where there must be one.
    fn tables<'t>(
        &mut self,
        name: &str,
        value: &'t Spanned<DeValue<'t>>,
        file: u32,
    ) -> Vec<(&'t DeTable<'t>, Spot)> {
        let mut wrong = |value: &Spanned<DeValue<'_>>| {
            let message = format!("`{name}` must be a list of tables");
            self.notes.error(Spot::new(file, value.span()), message).help =
                Some(format!("write `[[{name}]]`"));
        };
        let Some(items) = value.get_ref().as_array() else {
            wrong(value);
            return Vec::new();
        };
        let mut tables = Vec::with_capacity(items.len());
        for item in items {
            match item.get_ref().as_table() {
                Some(table) => tables.push((table, Spot::new(file, item.span()))),
                None => wrong(item),
            }
        }
        tables
    }

    /// Tables by name, in the order of the text, where there must be such.
    fn named<'t>(
        &mut self,
        name: &str,
        value: &'t Spanned<DeValue<'t>>,
        file: u32,
    ) -> Vec<(&'t str, &'t DeTable<'t>, Spot)> {
        let mut wrong = |value: &Spanned<DeValue<'_>>, what: String| {
            self.notes
                .error(Spot::new(file, value.span()), format!("{what} must be a table"))
                .help = Some(format!("write `[{name}.NAME]`"));
        };
        let Some(entries) = value.get_ref().as_table() else {
            wrong(value, format!("`{name}`"));
            return Vec::new();
        };
        let mut tables = Vec::with_capacity(entries.len());
        for (key, value) in entries {
            match value.get_ref().as_table() {
                Some(table) => {
                    tables.push((key.get_ref().as_ref(), table, Spot::new(file, value.span())));
                }
                None => wrong(value, quoted(key.get_ref())),
            }
        }
        tables.sort_by_key(|(_, _, spot)| spot.start);
        tables
    }
}
