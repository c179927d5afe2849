//! A scene as text and raw arrays, and back to the very same: what is pickled and digested.

use std::sync::Arc;

use glam::DVec3;
use phong_scene::{
    Caps, Cylinders, ExportOptions, Field, Format, Framing, LightKind, Limits, Memory, Mesh,
    Object, Points, Scene, Shape, Shared, Side, SkyKind, TexelValues, Texels, TextureKind, read,
};
use pyo3::PyResult;
use serde_json::{Value, json};

use crate::errors::{runtime_error, value_error};
use crate::raw::{Raw, of_bytes, to_bytes};
use crate::state::{Automatic, State};

/// A scene as text and raw arrays.
pub(crate) struct Packed {
    /// A JSON object: the scene's own text, and what it does not say.
    pub(crate) text: String,
    /// The arrays, each once.
    pub(crate) arrays: Vec<Vec<u8>>,
}

/// Arrays that are packed, each once.
#[derive(Default)]
struct Arrays {
    /// Where each lies in memory.
    known: Vec<usize>,
    bytes: Vec<Vec<u8>>,
}

impl Arrays {
    fn put<T: Raw>(&mut self, array: &Shared<T>) -> Value {
        if array.is_empty() {
            return Value::Null;
        }
        let address = Shared::address(array);
        let number = self.known.iter().position(|&known| known == address).unwrap_or_else(|| {
            self.known.push(address);
            self.bytes.push(to_bytes(array));
            self.known.len() - 1
        });
        json!(number)
    }

    /// The pixels of an image; in the text a single pixel, in a file of this name, stands for them.
    fn image(&mut self, texels: &Arc<Texels>, file: &mut String, name: String) -> Value {
        let (kind, bytes) = match texels.values() {
            TexelValues::Bytes(values) => ("bytes", values.clone()),
            TexelValues::Shorts(values) => {
                ("shorts", values.iter().flat_map(|v| v.to_le_bytes()).collect())
            }
            TexelValues::Floats(values) => {
                ("floats", values.iter().flat_map(|v| v.to_le_bytes()).collect())
            }
        };
        let address = Arc::as_ptr(texels).addr();
        let number = self.known.iter().position(|&known| known == address).unwrap_or_else(|| {
            self.known.push(address);
            self.bytes.push(bytes);
            self.known.len() - 1
        });
        let [width, height] = texels.size();
        let told = json!({
            "file": file,
            "pixels": [width, height, texels.channels()],
            "kind": kind,
            "array": number,
        });
        *file = name;
        told
    }

    /// Numbers of points, with their names.
    fn fields(&mut self, fields: &[Field]) -> Vec<Value> {
        let field =
            |Field { name, values }: &Field| json!({ "name": &**name, "array": self.put(values) });
        fields.iter().map(field).collect()
    }

    /// The arrays of a shape; `None`: it has none, and stands in the text.
    fn shape(&mut self, shape: &Shape) -> Option<Value> {
        // Taken apart without `..`: what a shape gains must be thought of here.
        Some(match shape {
            Shape::Mesh(mesh) => {
                let Mesh {
                    origin,
                    positions,
                    indices,
                    normals,
                    normal_indices,
                    uvs,
                    uv_indices,
                    colors,
                    face_materials,
                    fields,
                } = &**mesh;
                json!({
                    "kind": "mesh",
                    "origin": origin.to_array().map(f64::to_bits),
                    "arrays": [
                        self.put(positions),
                        self.put(indices),
                        self.put(normals),
                        self.put(normal_indices),
                        self.put(uvs),
                        self.put(uv_indices),
                        self.put(colors),
                        self.put(face_materials),
                    ],
                    "fields": self.fields(fields),
                })
            }
            Shape::Points(points) => {
                let Points { origin, spheres, colors, guessed, fields } = &**points;
                json!({
                    "kind": "points",
                    "origin": origin.to_array().map(f64::to_bits),
                    "arrays": [self.put(spheres), self.put(colors)],
                    "guessed": guessed.map(f32::to_bits),
                    "fields": self.fields(fields),
                })
            }
            Shape::Cylinders(cylinders) => {
                let Cylinders { origin, segments, colors, caps, guessed, fields } = &**cylinders;
                let caps = match caps {
                    Caps::Round => "round",
                    Caps::Flat => "flat",
                    Caps::Open => "none",
                };
                json!({
                    "kind": "cylinders",
                    "origin": origin.to_array().map(f64::to_bits),
                    "arrays": [self.put(segments), self.put(colors)],
                    "caps": caps,
                    "guessed": guessed.map(f32::to_bits),
                    "fields": self.fields(fields),
                })
            }
            _ => return None,
        })
    }
}

/// Packs a scene.
pub(crate) fn pack(state: &State) -> PyResult<Packed> {
    let mut scene = Scene::clone(&state.scene);
    let mut arrays = Arrays::default();
    let materials: Vec<_> = scene.materials.iter().map(|m| m.name.clone()).collect();
    for (number, material) in scene.materials.iter_mut().enumerate() {
        // Names of their own, so that each is written, in order.
        material.name = format!("m{number}");
    }
    let textures = scene.textures.iter_mut().enumerate();
    let mut images: Vec<_> = textures
        .map(|(number, texture)| match &mut texture.kind {
            TextureKind::Image { file, texels, .. } => {
                Some(arrays.image(texels, file, image_file(number)))
            }
            _ => None,
        })
        .collect();
    if let Some(SkyKind::Image { file, texels, .. }) = scene.sky.as_mut().map(|sky| &mut sky.kind) {
        // After those of all textures.
        images.push(Some(arrays.image(texels, file, image_file(images.len()))));
    }
    // Objects have other names in the text.
    let clips: Vec<_> =
        scene.clips.iter_mut().map(|clip| std::mem::take(&mut clip.objects)).collect();
    let lamps = scene.lights.iter_mut().map(|light| {
        let LightKind::Mesh { attenuation } = light.kind else { return None };
        light.kind = LightKind::Point { position: DVec3::ZERO, attenuation, radius: 0.0 };
        Some(std::mem::take(&mut light.object))
    });
    let lamps: Vec<Option<String>> = lamps.collect();
    let mut take = |object: &mut Object| {
        let bulk = arrays.shape(&object.shape);
        if bulk.is_some() {
            object.shape = Shape::default();
        }
        let told = json!([object.name, object.material.0, bulk]);
        "object".clone_into(&mut object.name);
        told
    };
    let objects: Vec<_> = scene.objects.iter_mut().map(&mut take).collect();
    let in_groups = scene.groups.iter_mut().flat_map(|group| &mut group.objects);
    let in_groups: Vec<_> = in_groups.map(&mut take).collect();
    let export =
        scene.export(&ExportOptions { images: false, ..ExportOptions::default() }, "scene.toml");
    let export = export.map_err(|error| value_error(error.to_string()))?;
    let text = export.text().map_err(|error| runtime_error(error.to_string()))?;
    let framing = state.framing.as_ref().map(|framing| {
        let Framing { side, up, eye, look_at, fov, color } = framing;
        let bits = |v: &DVec3| v.to_array().map(f64::to_bits);
        json!({
            "side": *side as u8,
            "up": bits(up),
            "eye": eye.as_ref().map(bits),
            "look_at": look_at.as_ref().map(bits),
            "fov": fov.map(f64::to_bits),
            "color": color.map(|color| color.to_array().map(f32::to_bits)),
        })
    });
    let text = json!({
        "version": 3,
        "text": text,
        "materials": materials,
        "objects": objects,
        "in_groups": in_groups,
        "images": images,
        "clips": clips,
        "lamps": lamps,
        "parts": state.parts,
        "framing": framing,
        "automatic": [state.automatic.lights, state.automatic.bare],
    });
    Ok(Packed { text: text.to_string(), arrays: arrays.bytes })
}

/// A pixel, as a file: it stands for an image in the text of a scene that is packed.
const PIXEL: &[u8] =
    b"\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\0\0\0\x01\0\0\0\x01\x08\x06\0\0\0\x1f\x15\xc4\x89\
    \0\0\0\x0dIDAT\x78\x9c\x63\x68\x68\xf8\xff\x1f\0\x06\x82\x02\xff\xb3\xbe\x51\x33\
    \0\0\0\0IEND\xae\x42\x60\x82";

/// What the file of an image is called in such a text.
fn image_file(number: usize) -> String {
    format!("image-{number}.png")
}

/// What is said of a pickle that makes no sense.
fn broken() -> pyo3::PyErr {
    value_error("the pickled scene is damaged, or of another version of phong")
}

/// The scene that was packed.
pub(crate) fn unpack(text: &str, arrays: &[&[u8]]) -> PyResult<State> {
    let packed: Value = serde_json::from_str(text).map_err(|_| broken())?;
    if packed["version"] != 3 {
        return Err(broken());
    }
    let toml = packed["text"].as_str().ok_or_else(broken)?;
    let images = packed["images"].as_array().ok_or_else(broken)?;
    let mut files = Memory::new().with("scene.toml", toml.as_bytes());
    for number in 0..images.len() {
        files = files.with(image_file(number), PIXEL);
    }
    let reading = read("scene.toml", Some(Format::Toml), &files, &Limits::default());
    let mut scene = reading.scene.ok_or_else(broken)?;
    let names = packed["materials"].as_array().ok_or_else(broken)?;
    if names.len() > scene.materials.len() {
        return Err(broken());
    }
    let mut taken = Taken { arrays, shared: Vec::new() };
    let objects = packed["objects"].as_array().ok_or_else(broken)?;
    let in_groups = packed["in_groups"].as_array().ok_or_else(broken)?;
    let grouped = scene.groups.iter_mut().flat_map(|group| &mut group.objects);
    give_back(scene.objects.iter_mut(), objects, &mut taken)?;
    give_back(grouped, in_groups, &mut taken)?;
    for texture in &mut scene.textures {
        if let TextureKind::Image { file, texels, .. } = &mut texture.kind {
            taken.give_image_back(file, texels, images)?;
        }
    }
    if let Some(SkyKind::Image { file, texels, place, .. }) =
        scene.sky.as_mut().map(|sky| &mut sky.kind)
    {
        taken.give_image_back(file, texels, images)?;
        *place = phong_scene::Place::default();
    }
    let clips = packed["clips"].as_array().ok_or_else(broken)?;
    for (clip, names) in scene.clips.iter_mut().zip(clips) {
        let names = names.as_array().ok_or_else(broken)?.iter();
        let names = names.map(|name| name.as_str().map(str::to_owned));
        clip.objects = names.collect::<Option<_>>().ok_or_else(broken)?;
        clip.place = phong_scene::Place::default();
    }
    let lamps = packed["lamps"].as_array().ok_or_else(broken)?;
    for (light, name) in scene.lights.iter_mut().zip(lamps) {
        if let (Some(name), Some(attenuation)) = (name.as_str(), light.kind.attenuation()) {
            light.kind = LightKind::Mesh { attenuation };
            name.clone_into(&mut light.object);
        }
    }
    scene.materials.truncate(names.len());
    for (material, name) in scene.materials.iter_mut().zip(names) {
        name.as_str().ok_or_else(broken)?.clone_into(&mut material.name);
    }
    let flag = |number: usize| packed["automatic"][number].as_bool().ok_or_else(broken);
    let automatic = Automatic { lights: flag(0)?, bare: flag(1)? };
    let parts: Vec<u64> = packed["parts"]
        .as_array()
        .and_then(|parts| parts.iter().map(Value::as_u64).collect())
        .ok_or_else(broken)?;
    if parts.len() != scene.objects.len() || !parts.is_sorted_by(|a, b| a < b) {
        return Err(broken());
    }
    let framing = framing(&packed["framing"])?;
    for place in scene.objects.iter_mut().map(|object| &mut object.place) {
        *place = phong_scene::Place::default();
    }
    Ok(State::new(scene, framing, automatic).numbered(parts))
}

/// Gives objects their names, materials and arrays back.
fn give_back<'a>(
    objects: impl Iterator<Item = &'a mut Object>,
    told: &[Value],
    taken: &mut Taken<'_>,
) -> PyResult<()> {
    let mut told = told.iter();
    for object in objects {
        let one = told.next().ok_or_else(broken)?;
        one[0].as_str().ok_or_else(broken)?.clone_into(&mut object.name);
        object.material.0 = number(&one[1])?;
        if !one[2].is_null() {
            object.shape = taken.shape(&one[2])?;
        }
    }
    if told.next().is_some() { Err(broken()) } else { Ok(()) }
}

fn number(value: &Value) -> PyResult<u32> {
    value.as_u64().and_then(|number| u32::try_from(number).ok()).ok_or_else(broken)
}

/// The radius that was guessed, of packed points or cylinders.
fn guessed(packed: &Value) -> PyResult<Option<f32>> {
    match &packed["guessed"] {
        Value::Null => Ok(None),
        bits => Ok(Some(f32::from_bits(number(bits)?))),
    }
}

fn vector(value: &Value) -> PyResult<DVec3> {
    let bits: Vec<u64> = value
        .as_array()
        .and_then(|bits| bits.iter().map(Value::as_u64).collect())
        .ok_or_else(broken)?;
    match bits[..] {
        [x, y, z] => Ok(DVec3::from_array([x, y, z].map(f64::from_bits))),
        _ => Err(broken()),
    }
}

fn framing(packed: &Value) -> PyResult<Option<Framing>> {
    if packed.is_null() {
        return Ok(None);
    }
    let sides =
        [Side::Front, Side::Back, Side::Left, Side::Right, Side::Top, Side::Bottom, Side::Iso];
    let side = packed["side"].as_u64();
    let side = sides.into_iter().find(|&known| Some(known as u64) == side).ok_or_else(broken)?;
    let perhaps = |key: &str| {
        let value = &packed[key];
        if value.is_null() { Ok(None) } else { vector(value).map(Some) }
    };
    let color = match &packed["color"] {
        Value::Null => None,
        bits => {
            let channel = |i: usize| number(&bits[i]).map(f32::from_bits);
            Some(phong_scene::Rgb::new(channel(0)?, channel(1)?, channel(2)?))
        }
    };
    Ok(Some(Framing {
        side,
        up: vector(&packed["up"])?,
        eye: perhaps("eye")?,
        look_at: perhaps("look_at")?,
        fov: packed["fov"].as_u64().map(f64::from_bits),
        color,
    }))
}

/// Arrays that are unpacked: what was one array is one again.
struct Taken<'a> {
    arrays: &'a [&'a [u8]],
    shared: Vec<(usize, Box<dyn std::any::Any>)>,
}

impl Taken<'_> {
    fn get<T: Raw + 'static>(&mut self, number: &Value) -> PyResult<Shared<T>> {
        if number.is_null() {
            return Ok(Shared::default());
        }
        let number = self::number(number)? as usize;
        let mut known = self.shared.iter().filter(|(known, _)| *known == number);
        if let Some(array) = known.find_map(|(_, any)| any.downcast_ref::<Shared<T>>()) {
            return Ok(array.clone());
        }
        let array: Shared<T> =
            self.arrays.get(number).and_then(|bytes| of_bytes(bytes)).ok_or_else(broken)?;
        self.shared.push((number, Box::new(array.clone())));
        Ok(array)
    }

    /// Gives a texture or a sky the name and the pixels of its image back.
    fn give_image_back(
        &mut self,
        file: &mut String,
        texels: &mut Arc<Texels>,
        images: &[Value],
    ) -> PyResult<()> {
        let number = (0..images.len()).find(|&number| image_file(number) == *file);
        let packed = &images[number.ok_or_else(broken)?];
        packed["file"].as_str().ok_or_else(broken)?.clone_into(file);
        let number = self::number(&packed["array"])? as usize;
        let mut known = self.shared.iter().filter(|(known, _)| *known == number);
        if let Some(same) = known.find_map(|(_, any)| any.downcast_ref::<Arc<Texels>>()) {
            *texels = Arc::clone(same);
            return Ok(());
        }
        let bytes = *self.arrays.get(number).ok_or_else(broken)?;
        let values = match packed["kind"].as_str() {
            Some("bytes") => TexelValues::Bytes(bytes.to_vec()),
            Some("shorts") => {
                let (values, []) = bytes.as_chunks() else { return Err(broken()) };
                TexelValues::Shorts(values.iter().map(|&v| u16::from_le_bytes(v)).collect())
            }
            Some("floats") => {
                let (values, []) = bytes.as_chunks() else { return Err(broken()) };
                TexelValues::Floats(values.iter().map(|&v| f32::from_le_bytes(v)).collect())
            }
            _ => return Err(broken()),
        };
        let side = |side: usize| self::number(&packed["pixels"][side]);
        let image = Texels::new([side(0)?, side(1)?], side(2)? as usize, values);
        *texels = Arc::new(image.map_err(|_| broken())?);
        self.shared.push((number, Box::new(Arc::clone(texels))));
        Ok(())
    }

    fn fields(&mut self, packed: &Value) -> PyResult<Vec<Field>> {
        // What was packed before points had any has none.
        let all = packed.as_array().map(Vec::as_slice).unwrap_or_default();
        let field = |packed: &Value| {
            let name = packed["name"].as_str().ok_or_else(broken)?.into();
            Ok(Field { name, values: self.get(&packed["array"])? })
        };
        all.iter().map(field).collect()
    }

    fn shape(&mut self, packed: &Value) -> PyResult<Shape> {
        let origin = vector(&packed["origin"])?;
        let array = |number: usize| packed["arrays"][number].clone();
        Ok(match packed["kind"].as_str() {
            Some("mesh") => Mesh {
                origin,
                positions: self.get(&array(0))?,
                indices: self.get(&array(1))?,
                normals: self.get(&array(2))?,
                normal_indices: self.get(&array(3))?,
                uvs: self.get(&array(4))?,
                uv_indices: self.get(&array(5))?,
                colors: self.get(&array(6))?,
                face_materials: self.get(&array(7))?,
                fields: self.fields(&packed["fields"])?,
            }
            .into(),
            Some("points") => {
                let guessed = guessed(packed)?;
                let (spheres, colors) = (self.get(&array(0))?, self.get(&array(1))?);
                let fields = self.fields(&packed["fields"])?;
                Points { origin, spheres, colors, guessed, fields }.into()
            }
            Some("cylinders") => {
                let caps = match packed["caps"].as_str() {
                    Some("round") => Caps::Round,
                    Some("flat") => Caps::Flat,
                    Some("none") => Caps::Open,
                    _ => return Err(broken()),
                };
                let (segments, colors) = (self.get(&array(0))?, self.get(&array(1))?);
                let fields = self.fields(&packed["fields"])?;
                let guessed = guessed(packed)?;
                Cylinders { origin, segments, colors, caps, guessed, fields }.into()
            }
            _ => return Err(broken()),
        })
    }
}
