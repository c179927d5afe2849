//! A scene as text, written by the tables of keys that the reader reads it by.
//!
//! Keys whose default is meant are left out, numbers have the fewest digits that read back to the
//! same bits, and meshes and points become PLY files beside the text. The same scene gives the
//! same bytes.

mod concepts;
mod text;

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::sync::Arc;

use glam::DVec3;

use super::table::default;
use crate::clip::Cap;
use crate::diagnostic::{Diagnostic, Span};
use crate::format::export::{Account, File, PlyEncoding, Writing, free_name, split_all};
use crate::furniture::Furniture;
use crate::keys::{self, Key, Keyed, Kind, Table, Value};
use crate::limits::LARGEST;
use crate::material::{Material, MaterialId};
use crate::mesh::{Cylinders, Field, Mesh};
use crate::scene::{Object, Scene};
use crate::shape::Shape;
use crate::sky::SkyKind;
use crate::texels::{TexelValues, Texels};
use crate::texture::{Encoding, Texture, TextureKind};
use crate::wording::quoted;

/// The scene as the text of `file` and the files that it names, in the order of the text.
///
/// # Errors
/// A position or direction that the text has no number for.
pub(crate) fn write_toml(
    scene: Scene,
    options: &Writing,
    file: &str,
    account: &mut Account,
) -> Result<Vec<File>, Box<Diagnostic>> {
    if options.bare {
        account.map("camera, lights and background are those a bare model is shown with".into());
        let [width, height] = scene.image.size;
        account.map(format!(
            "the camera stands where the model fills a picture of {width} × {height}; one of \
             narrower shape cuts off its sides"
        ));
    }
    let Scene {
        image,
        camera,
        ambient,
        ambient_occlusion,
        fog,
        outline,
        mut furniture,
        tone,
        sky,
        clips,
        lights,
        materials,
        textures,
        objects,
        groups,
    } = scene;
    let texture_names = texture_names(&textures, account);
    if let Some(legend) = &mut furniture.legend {
        let named = textures.iter().position(|texture| texture.name == legend.texture);
        legend.texture = named.map(|number| texture_names[number].clone()).unwrap_or_default();
    }
    let stem = file.strip_suffix(".toml").unwrap_or(file).to_owned();
    let group_names = groups.iter().map(|group| group.name.clone()).collect();
    let mut out = Writer {
        text: "version = 1\n".to_owned(),
        stem,
        materials: Materials::new(materials, account),
        texture_names,
        group_names,
        counts: BTreeMap::new(),
        files: Vec::new(),
        ply: options.ply,
        images: options.images,
        written: Vec::new(),
        account,
        trouble: None,
    };
    for (key, table) in keys::SCENE.keys().filter_map(|key| match key.kind {
        Kind::Table(table) => Some((key, table)),
        _ => None,
    }) {
        let header = format!("[{}]", key.name);
        match table.name {
            "image" => out.setting(&header, table, None, |key| key.get(&image)),
            "camera" => {
                let kind = table.word_of(&camera);
                out.setting(&header, table, kind, |key| key.get(&camera));
            }
            "sky" => {
                if let Some(mut sky) = sky.clone() {
                    if let SkyKind::Image { file, texels, .. } = &mut sky.kind {
                        out.image(&header, texels, Curve::Srgb, file);
                    }
                    let kind = table.word_of(&sky);
                    out.table(&header, table, kind, |key| key.get(&sky));
                }
            }
            "fog" => {
                if let Some(fog) = fog {
                    let kind = table.word_of(&fog);
                    out.table(&header, table, kind, |key| key.get(&fog));
                }
            }
            "outline" => {
                if let Some(outline) = outline {
                    out.table(&header, table, None, |key| key.get(&outline));
                }
            }
            "furniture" | "title" | "scale_bar" | "axes" | "legend" => {
                out.furniture(&header, table, &furniture);
            }
            "tone" => {
                if let Some(tone) = tone {
                    let kind = table.word_of(&tone);
                    out.table(&header, table, kind, |key| key.get(&tone));
                }
            }
            "ambient_occlusion" => {
                if let Some(occlusion) = ambient_occlusion {
                    out.table(&header, table, None, |key| key.get(&occlusion));
                }
            }
            _ => out.setting(&header, table, None, |_| Some(Value::Color(ambient))),
        }
    }
    for label in &furniture.labels {
        out.table("[[label]]", &keys::LABEL, None, |key| said(key, label));
    }
    for clip in &clips {
        let kind = keys::CLIP.word_of(clip);
        let cap = match clip.cap {
            Cap::Of(material) => out.materials.names.get(material.0 as usize).cloned(),
            _ => None,
        };
        out.table("[[clip]]", &keys::CLIP, kind, |key| concepts::clip(clip, cap.as_deref(), key));
        out.account.carry("clip", 1);
    }
    for (i, light) in lights.iter().enumerate() {
        let kind = keys::LIGHT.word_of(light);
        out.table("[[light]]", &keys::LIGHT, kind, |key| concepts::light(light, i + 1, key));
    }
    out.account.carry("light", lights.len());
    let groups: Vec<_> = groups
        .into_iter()
        .map(|group| (group.name, split_all(group.objects, out.account)))
        .collect();
    let objects = split_all(objects, out.account);
    let in_groups = groups.iter().flat_map(|(_, objects)| objects);
    out.materials.say_used(in_groups.chain(&objects));
    out.textures(&textures);
    out.all_materials();
    for (name, objects) in groups {
        let name = text::name(&name);
        out.text.extend(["\n[groups.", &name, "]\n"]);
        out.account.carry("group", 1);
        out.objects(&format!("groups.{name}."), objects);
    }
    out.objects("", objects);
    let Writer { text, mut files, trouble, .. } = out;
    files.insert(0, File::text(file, text));
    trouble.map_or(Ok(files), |trouble| Err(Box::new(trouble)))
}

/// The value of a key; nothing where that is no text at all.
fn said<T: Keyed>(key: &Key, of: &T) -> Option<Value> {
    key.get(of).filter(|value| !matches!(value, Value::Text(text) if text.is_empty()))
}

/// How the linear floats of an image become the whole numbers of a PNG.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Curve {
    /// Unchanged: a texture says that they are linear.
    AsTheyAre,
    /// Encoded as sRGB, which is what a sky takes whole numbers for.
    Srgb,
}

struct Writer<'a> {
    text: String,
    /// What the names of files begin with.
    stem: String,
    materials: Materials,
    texture_names: Vec<String>,
    group_names: Vec<String>,
    /// How many shapes of each kind are written, as the reader counts them.
    counts: BTreeMap<&'static str, usize>,
    files: Vec<File>,
    ply: PlyEncoding,
    /// Whether images are written beside the text.
    images: bool,
    /// The images that are written, by their names.
    written: Vec<(Arc<Texels>, Curve, String)>,
    account: &'a mut Account,
    /// The first number that cannot be written.
    trouble: Option<Diagnostic>,
}

impl Writer<'_> {
    /// A table that is left out if all of it is as by default.
    fn setting(
        &mut self,
        header: &str,
        table: &'static Table,
        word: Option<&str>,
        say: impl Fn(&Key) -> Option<Value>,
    ) {
        let before = self.text.len();
        self.table(header, table, word, say);
        if self.text[before..].trim() == header {
            self.text.truncate(before);
        }
    }

    /// One of the tables of what a figure needs beside its picture, if there is such a thing.
    fn furniture(&mut self, header: &str, table: &'static Table, furniture: &Furniture) {
        // What is by default is written all the same: the table says that it is there.
        fn written<T: Keyed>(out: &mut Writer<'_>, header: &str, table: &'static Table, of: &T) {
            out.table(header, table, None, |key| said(key, of));
        }
        let Furniture { style, title, scale_bar, axes, legend, labels: _ } = furniture;
        match (table.name, title, scale_bar, axes, legend) {
            ("title", Some(title), ..) => written(self, header, table, title),
            ("scale_bar", _, Some(bar), ..) => written(self, header, table, bar),
            ("axes", _, _, Some(axes), _) => written(self, header, table, axes),
            ("legend", .., Some(legend)) => written(self, header, table, legend),
            ("furniture", ..) => self.setting(header, table, None, |key| key.get(style)),
            _ => {}
        }
    }

    /// A header, and every key of the table to which `say` has something that is not its default.
    fn table(
        &mut self,
        header: &str,
        table: &'static Table,
        word: Option<&str>,
        say: impl Fn(&Key) -> Option<Value>,
    ) {
        self.text.extend(["\n", header, "\n"]);
        for key in table.keys().filter(|key| key.applies(word)) {
            let Some(mut value) = say(key) else { continue };
            self.fit(header, key, &mut value);
            if default(key).as_ref() != Some(&value) {
                let value = text::value(&value, key.kind, &self.texture_names);
                // Writing to a string does not fail.
                let _ = writeln!(self.text, "{} = {value}", key.name);
            }
        }
    }

    /// Brings a value into its key's range, which foreign formats may have left, and says so.
    fn fit(&mut self, header: &str, key: &Key, value: &mut Value) {
        let most = if matches!(key.kind, Kind::Reflectance) { 1.0 } else { LARGEST };
        let beyond = |v: &DVec3| v.abs().max_element() > LARGEST;
        match (value, key.kind) {
            (Value::Number(n), Kind::Number(range)) if !range.holds(*n) => {
                let nearest = n.clamp(range.min, range.max);
                let (was, is) = (text::number(*n), text::number(nearest));
                self.account.map(format!("{header}: `{}` {was} becomes {is}, the most", key.name));
                *n = nearest;
            }
            (Value::Color(color), _) if f64::from(color.max_channel()) > most => {
                self.account.map(format!("{header}: `{}` is cut to {most:e}", key.name));
                *color = color.map(|channel| channel.min(most as f32));
            }
            (Value::Vector(v), _) if beyond(v) => self.too_large(header, key.name),
            (Value::Vectors(vs), _) if vs.iter().any(beyond) => self.too_large(header, key.name),
            (Value::Matrix(m), _)
                if [m.matrix3.x_axis, m.matrix3.y_axis, m.matrix3.z_axis, m.translation]
                    .iter()
                    .any(beyond) =>
            {
                self.too_large(header, key.name);
            }
            _ => {}
        }
    }

    fn too_large(&mut self, header: &str, key: &str) {
        let message = format!("{header}: `{key}` is too large: scenes hold up to {LARGEST:e}");
        self.trouble.get_or_insert_with(|| Diagnostic::error(message, None));
    }

    /// Writes an image beside the text, once, and gives `file` its name: where the file was is somewhere
    /// else from there.
    fn image(&mut self, header: &str, texels: &Arc<Texels>, curve: Curve, file: &mut String) {
        if !self.images {
            return;
        }
        let same = |(other, by, _): &&(Arc<Texels>, Curve, String)| {
            // Whole numbers are written as they are.
            let is_whole = !matches!(texels.values(), TexelValues::Floats(_));
            Arc::ptr_eq(other, texels) && (is_whole || *by == curve)
        };
        if let Some((.., name)) = self.written.iter().find(same) {
            file.clone_from(name);
            return;
        }
        *file = format!("{}-image-{}.png", self.stem, self.written.len() + 1);
        if let TexelValues::Floats(values) = texels.values()
            && values.iter().any(|value| !(0.0..=1.0).contains(value))
        {
            let message =
                format!("{header}: a PNG holds 0 to 1; brighter and negative values are cut off");
            self.account.drop(Diagnostic::warning(message, None));
        }
        let pixels = Arc::clone(texels);
        let srgb = curve == Curve::Srgb;
        self.files.push(File::new(file.clone(), move |to| pixels.write_png(srgb, to)));
        self.written.push((Arc::clone(texels), curve, file.clone()));
    }

    fn textures(&mut self, textures: &[Texture]) {
        for (number, texture) in textures.iter().enumerate() {
            let header = format!("[textures.{}]", text::name(&self.texture_names[number]));
            let mut texture = texture.clone();
            if self.images
                && let TextureKind::Image { file, texels, encoding, .. } = &mut texture.kind
            {
                // A PNG has no floats, and its numbers would be taken for sRGB.
                if let (TexelValues::Floats(_), Encoding::Auto) = (texels.values(), *encoding) {
                    *encoding = Encoding::Linear;
                }
                self.image(&header, texels, Curve::AsTheyAre, file);
            }
            let texture = &texture;
            let kind = keys::TEXTURE.word_of(texture);
            self.table(&header, &keys::TEXTURE, kind, |key| concepts::texture(texture, key));
            self.account.carry("texture", 1);
        }
    }

    fn all_materials(&mut self) {
        let materials = std::mem::take(&mut self.materials.all);
        for (i, material) in materials.iter().enumerate() {
            if self.materials.is_implied(i, materials.len(), material) {
                continue;
            }
            let header = format!("[materials.{}]", text::name(&self.materials.names[i]));
            let model = keys::MATERIAL.word_of(material);
            self.table(&header, &keys::MATERIAL, model, |key| concepts::material(material, key));
            self.account.carry("material", 1);
        }
    }

    /// The objects of the scene, or of a group whose headers begin with `prefix`.
    fn objects(&mut self, prefix: &str, objects: Vec<Object>) {
        let known = keys::GROUP.keys().filter_map(|key| match key.kind {
            Kind::Tables(table) => Some((key.name, table)),
            _ => None,
        });
        let tables: BTreeMap<_, _> = known.collect();
        for mut object in objects {
            let kind = object.shape.kind();
            let Some(table) = tables.get(kind) else { continue };
            let number = self.counts.get(kind).map_or(1, |count| count + 1);
            let file = format!("{}.{kind}-{number}.ply", self.stem);
            if !is_seen(&object, self.account) {
                continue;
            }
            say_unwritten(&object, self.account);
            let beside = sidecar(&mut object, &file, self.ply);
            self.counts.insert(kind, number);
            self.account.carry(kind, 1);
            let material = self.materials.name_of(object.material).map(str::to_owned);
            let group = match object.shape {
                Shape::Instance(group) => self.group_names.get(group.0 as usize).cloned(),
                _ => None,
            };
            let has_file = beside.is_some();
            self.table(&format!("[[{prefix}{kind}]]"), table, None, |key| match key.name {
                "file" if has_file => Some(Value::Text(file.clone())),
                "group" => group.clone().map(Value::Text),
                "material" => material.clone().map(Value::Text),
                "name" => concepts::name(&object.name, &format!("{kind} {number}")),
                "scale" | "rotate" | "translate" | "matrix" => {
                    concepts::placed(&object.transform, key.name)
                }
                _ => concepts::shape(&object.shape, key),
            });
            self.files.extend(beside);
        }
    }
}

/// Whether there is anything to see; if not, that is said.
fn is_seen(object: &Object, account: &mut Account) -> bool {
    let empty = match &object.shape {
        Shape::Mesh(mesh) => mesh.indices.is_empty(),
        Shape::Points(points) => points.spheres.is_empty(),
        Shape::Cylinders(cylinders) => cylinders.segments.is_empty(),
        _ => false,
    };
    if empty {
        let message = format!("{} is empty and left out", object.name);
        let span = Span { place: object.place.clone(), ..Span::default() };
        account.drop(Diagnostic::warning(message, span));
    }
    !empty
}

/// Says which numbers of points a file beside the text has no name for.
fn say_unwritten(object: &Object, account: &mut Account) {
    for field in object.shape.fields().iter().filter(|field| !Field::is_name(&field.name)) {
        let message = format!(
            "the numbers {} of {} are not written: a PLY file names them by one word that nothing else in it has",
            quoted(&field.name),
            object.name
        );
        let span = Span { place: object.place.clone(), ..Span::default() };
        account.drop(Diagnostic::warning(message, span));
    }
}

/// What goes into a file beside the text, if anything does.
///
/// The origin of data far from 0 becomes part of the placement, so that the file holds the very
/// numbers and not their sums.
fn sidecar(object: &mut Object, name: &str, ply: PlyEncoding) -> Option<File> {
    let (file, origin) = match &mut object.shape {
        Shape::Mesh(mesh) => {
            // The text still says whether it has normals.
            let normals = mesh.normals.iter().take(1).copied().collect();
            let mut mesh = std::mem::replace(&mut **mesh, Mesh { normals, ..Mesh::default() });
            let origin = std::mem::take(&mut mesh.origin);
            (File::new(name, move |to| mesh.write_ply(ply, to)), origin)
        }
        Shape::Points(points) => {
            let mut points = std::mem::take(&mut **points);
            let origin = std::mem::take(&mut points.origin);
            (File::new(name, move |to| points.write_ply(ply, to)), origin)
        }
        Shape::Cylinders(cylinders) => {
            // The text still says what the ends look like.
            let rest = Cylinders { caps: cylinders.caps, ..Cylinders::default() };
            let mut cylinders = std::mem::replace(&mut **cylinders, rest);
            let origin = std::mem::take(&mut cylinders.origin);
            (File::new(name, move |to| cylinders.write_ply(ply, to)), origin)
        }
        _ => return None,
    };
    if origin != DVec3::ZERO {
        object.transform.translation = object.transform.transform_point3(origin);
    }
    Some(file)
}

/// A name of its own for every texture.
fn texture_names(textures: &[Texture], account: &mut Account) -> Vec<String> {
    let mut taken = BTreeSet::new();
    let mut name = |texture: &Texture| {
        let base = if texture.name.is_empty() { "unnamed" } else { &texture.name };
        let name = free_name(base, &mut taken);
        if name != texture.name {
            account.map(format!("a second texture `{}` is called `{name}`", texture.name));
        }
        name
    };
    textures.iter().map(&mut name).collect()
}

/// The materials and their names in the text.
struct Materials {
    all: Vec<Material>,
    names: Vec<String>,
    /// Which of them objects are of.
    used: BTreeSet<u32>,
}

impl Materials {
    /// Gives every material a name of its own: model files may bring the same one twice, or none.
    fn new(all: Vec<Material>, account: &mut Account) -> Self {
        let mut taken = BTreeSet::new();
        let mut names = Vec::with_capacity(all.len());
        for material in &all {
            let base = if material.name.is_empty() { "unnamed" } else { &material.name };
            let name = free_name(base, &mut taken);
            if name != material.name {
                account.map(format!("a second material `{}` is called `{name}`", material.name));
            }
            names.push(name);
        }
        Self { all, names, used: BTreeSet::new() }
    }

    fn say_used<'o>(&mut self, objects: impl Iterator<Item = &'o Object>) {
        let real = objects.filter(|object| !matches!(object.shape, Shape::Instance(_)));
        self.used = real.map(|object| object.material.0).collect();
    }

    /// Whether the reader makes this material by itself: the last, called default, nothing but
    /// defaults, for shapes that name none.
    fn is_implied(&self, number: usize, count: usize, material: &Material) -> bool {
        let plain = Material { place: material.place.clone(), ..Material::default() };
        number + 1 == count && *material == plain && self.used.contains(&(number as u32))
    }

    /// The name to write; `None`: shapes that name none are of it.
    fn name_of(&self, material: MaterialId) -> Option<&str> {
        let name = self.names.get(material.0 as usize).map(String::as_str);
        name.filter(|&name| name != "default")
    }
}
