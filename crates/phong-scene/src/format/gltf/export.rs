//! A scene as glTF 2.0: one binary file (`.glb`), or text with its numbers in a `.bin` beside it.

use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

use glam::{DAffine3, Vec3};
use serde_json::{Map, Value, json};

use super::surface::{base_color, surface};
use crate::camera::CameraKind;
use crate::color::Rgb;
use crate::diagnostic::Diagnostic;
use crate::format::export::flat::{leave_out, listed, say_fields};
use crate::format::export::merge::Size;
use crate::format::export::{Account, File, Writing};
use crate::light::{Light, LightKind};
use crate::material::VertexColors;
use crate::mesh::{Mesh, NO_INDEX};
use crate::scene::{Image, Object, Scene};
use crate::shape::Shape;

/// The scene as glTF: what the name ends with says whether it is binary.
pub(crate) fn write_gltf(
    scene: Scene,
    options: &Writing,
    name: &str,
    account: &mut Account,
) -> Result<Vec<File>, Box<Diagnostic>> {
    Size::of(&scene).check(options.max_bytes)?;
    // Camera and lights have a place in it: they are told here.
    let quiet = Writing { bare: true, ..*options };
    let held = |shape: &Shape| {
        matches!(
            shape,
            Shape::Mesh(_) | Shape::Triangle { .. } | Shape::Points(_) | Shape::Cylinders(_)
        )
    };
    leave_out(&scene, &quiet, "triangles, points and lines", held, account);
    say_fields(&scene, account);
    if !options.bare {
        let mut lost = Vec::new();
        if scene.image != Image::default() {
            lost.push("settings of a picture (`[image]`)");
        }
        if scene.camera.shift != glam::DVec2::ZERO {
            lost.push("shift of the picture in its plane");
        }
        if scene.ambient != Rgb::WHITE || scene.ambient_occlusion.is_some() {
            lost.push("ambient light");
        }
        if scene.sky.is_some() {
            lost.push("sky");
        }
        if scene.fog.is_some() {
            lost.push("fog");
        }
        if scene.outline.is_some() {
            lost.push("lines around things");
        }
        if scene.image.cel.is_some() {
            lost.push("steps of luminance (`cel`)");
        }
        if !scene.furniture.is_empty() {
            lost.push("title, scale bar, axes, legend or labels");
        }
        if scene.tone.is_some() {
            lost.push("exposure, white balance or curve (`[tone]`)");
        }
        if !scene.clips.is_empty() {
            lost.push("clips: what they cut away is there");
        }
        if scene.lights.iter().any(|light| light.kind.extent() > 0.0) {
            lost.push("size of lights, and so no soft shadows");
        }
        if scene.lights.iter().any(|light| light.kind.has_surface() && light.visible) {
            lost.push("lights that are seen");
        }
        if scene.lights.iter().any(|light| matches!(light.kind, LightKind::Mesh { .. })) {
            lost.push("meshes that shine");
        }
        for what in lost {
            account.drop(Diagnostic::warning(format!("glTF holds no {what}"), None));
        }
        let by_square = [0.0, 0.0, 1.0];
        let fades = scene.lights.iter().filter_map(|light| light.kind.attenuation());
        let count = fades.filter(|fade| *fade != by_square).count();
        if count > 0 {
            let message = format!(
                "glTF's lights fade with the square of the distance, other than {count} of the scene's"
            );
            account.drop(Diagnostic::warning(message, None));
        }
    }
    let mut writer =
        Writer { scene: &scene, root: Map::new(), bytes: Vec::new(), meshes: BTreeMap::new() };
    writer.write(options.bare, account);
    let Writer { mut root, bytes, .. } = writer;
    // All of it is in the numbers and the text now.
    drop(scene);
    let bytes = Arc::new(bytes);
    let length = bytes.len();
    if name.to_ascii_lowercase().ends_with(".gltf") {
        let beside = format!("{}.bin", &name[..name.len() - 5]);
        let own = beside.rsplit('/').next().unwrap_or_default();
        root.insert("buffers".into(), json!([{ "byteLength": length, "uri": escaped(own) }]));
        let text = format!("{:#}\n", Value::Object(root));
        let numbers = File::new(beside, move |to| to.write_all(&bytes));
        return Ok(vec![File::text(name, text), numbers]);
    }
    root.insert("buffers".into(), json!([{ "byteLength": length }]));
    let mut text = Value::Object(root).to_string();
    while !text.len().is_multiple_of(4) {
        text.push(' ');
    }
    Ok(vec![File::new(name, move |to| {
        let total = 12 + 8 + text.len() + 8 + length;
        let too_long = |_| std::io::Error::other("a binary glTF file holds at most 4 GiB");
        let number = |n: usize| u32::try_from(n).map(u32::to_le_bytes).map_err(too_long);
        to.write_all(b"glTF\x02\0\0\0")?;
        to.write_all(&number(total)?)?;
        to.write_all(&number(text.len())?)?;
        to.write_all(b"JSON")?;
        to.write_all(text.as_bytes())?;
        to.write_all(&number(length)?)?;
        to.write_all(b"BIN\0")?;
        to.write_all(&bytes)
    })])
}

/// A name as part of a URI.
fn escaped(name: &str) -> String {
    let plain = |b: u8| b.is_ascii_alphanumeric() || b"-._~".contains(&b);
    let one = |b: u8| if plain(b) { char::from(b).to_string() } else { format!("%{b:02X}") };
    name.bytes().map(one).collect()
}

/// What is written so far.
struct Writer<'s> {
    scene: &'s Scene,
    root: Map<String, Value>,
    /// The numbers of all accessors.
    bytes: Vec<u8>,
    /// The numbers of meshes, by the addresses of objects that instances share.
    meshes: BTreeMap<usize, Option<usize>>,
}

impl<'s> Writer<'s> {
    /// Adds to a list of the document; its number there.
    fn push(&mut self, list: &str, value: Value) -> usize {
        let list = self.root.entry(list).or_insert_with(|| json!([]));
        let Value::Array(list) = list else { return 0 };
        list.push(value);
        list.len() - 1
    }

    fn write(&mut self, bare: bool, account: &mut Account) {
        let generator = concat!("phong ", env!("CARGO_PKG_VERSION"));
        self.root.insert("asset".into(), json!({ "version": "2.0", "generator": generator }));
        let mut used = Vec::new();
        for material in &self.scene.materials {
            let (value, more) = surface(material, account);
            used.extend(more);
            self.push("materials", value);
        }
        let mut roots = Vec::new();
        for object in &self.scene.objects {
            roots.extend(self.node(object, account));
        }
        if !bare {
            roots.extend(self.camera(account));
            let shines = |light: &Light| !matches!(light.kind, LightKind::Mesh { .. });
            let lights: Vec<&Light> = self.scene.lights.iter().filter(|l| shines(l)).collect();
            if !lights.is_empty() {
                used.push("KHR_lights_punctual");
                account.carry("light", lights.len());
                roots.extend(lights.into_iter().enumerate().map(|(i, light)| self.light(i, light)));
            }
        }
        used.sort_unstable();
        used.dedup();
        if !used.is_empty() {
            self.root.insert("extensionsUsed".into(), json!(used));
        }
        self.root.insert("scenes".into(), json!([{ "nodes": roots }]));
        self.root.insert("scene".into(), json!(0));
        let count = self.scene.all_objects().filter(|o| has_radius(&o.shape)).count();
        if count > 0 {
            let names = self.scene.all_objects().filter(|o| has_radius(&o.shape));
            let names = listed(names.map(|o| o.name.as_str()), count);
            account
                .map(format!("spheres are points, cylinders lines, without their radius: {names}"));
        }
    }

    /// The node of an object; `None`: there is nothing in it.
    fn node(&mut self, object: &'s Object, account: &mut Account) -> Option<usize> {
        let mut node = Map::new();
        node.insert("name".into(), json!(object.name));
        let mut place = object.transform;
        match &object.shape {
            Shape::Instance(group) => {
                let group = self.scene.groups.get(group.0 as usize)?;
                let children: Vec<_> =
                    group.objects.iter().filter_map(|child| self.node(child, account)).collect();
                if children.is_empty() {
                    return None;
                }
                node.insert("children".into(), json!(children));
            }
            shape => {
                let key = std::ptr::from_ref(object) as usize;
                let mesh = if let Some(known) = self.meshes.get(&key) {
                    *known
                } else {
                    let mesh = self.mesh(object, account);
                    self.meshes.insert(key, mesh);
                    mesh
                };
                node.insert("mesh".into(), json!(mesh?));
                place *= DAffine3::from_translation(origin(shape));
            }
        }
        if place != DAffine3::IDENTITY {
            node.insert("matrix".into(), json!(glam::DMat4::from(place).to_cols_array()));
        }
        Some(self.push("nodes", Value::Object(node)))
    }

    /// The mesh of an object; `None`: it holds none of its shape.
    fn mesh(&mut self, object: &Object, account: &mut Account) -> Option<usize> {
        let own = object.material.0;
        let primitives = match &object.shape {
            Shape::Mesh(mesh) => {
                account.carry("triangle", mesh.indices.len());
                let mut used: Vec<u32> = mesh.face_materials.to_vec();
                used.sort_unstable();
                used.dedup();
                match used[..] {
                    [] => vec![self.triangles(mesh, own)],
                    [only] => vec![self.triangles(mesh, only)],
                    _ => used
                        .iter()
                        .map(|of| {
                            let part = mesh.part(|face| mesh.face_materials[face] == *of);
                            self.triangles(&part, *of)
                        })
                        .collect(),
                }
            }
            Shape::Triangle { points, normals, .. } => {
                account.carry("triangle", 1);
                let mesh = Mesh {
                    positions: points.iter().map(|p| p.as_vec3()).collect(),
                    indices: [[0, 1, 2]].into(),
                    normals: normals.iter().flatten().map(|n| n.as_vec3()).collect(),
                    ..Mesh::default()
                };
                vec![self.triangles(&mesh, own)]
            }
            Shape::Points(points) => {
                account.carry("point", points.spheres.len());
                let spheres = points.spheres.iter();
                let places: Vec<_> = spheres.map(|&[x, y, z, _]| Vec3::new(x, y, z)).collect();
                vec![self.primitive(0, &places, &points.colors, own)]
            }
            Shape::Cylinders(cylinders) => {
                account.carry("line", cylinders.segments.len());
                let ends = cylinders.segments.iter().flatten();
                let places: Vec<_> = ends.map(|&[x, y, z, _]| Vec3::new(x, y, z)).collect();
                let colors: Vec<Rgb> = cylinders.colors.iter().flatten().copied().collect();
                vec![self.primitive(1, &places, &colors, own)]
            }
            _ => return None,
        };
        Some(self.push("meshes", json!({ "name": object.name, "primitives": primitives })))
    }

    /// Points or lines.
    fn primitive(&mut self, mode: u32, places: &[Vec3], colors: &[Rgb], material: u32) -> Value {
        let mut attributes = Map::new();
        attributes.insert("POSITION".into(), json!(self.vectors(places, true)));
        if !colors.is_empty() {
            attributes.insert("COLOR_0".into(), json!(self.colors(colors, material)));
        }
        json!({ "mode": mode, "attributes": attributes, "material": material })
    }

    /// Triangles: a vertex for each place with its normal and texture coordinates.
    fn triangles(&mut self, mesh: &Mesh, material: u32) -> Value {
        let numbers = |own: &[[u32; 3]], face: usize, count: usize| match (count, own.get(face)) {
            (0, _) => [NO_INDEX; 3],
            (_, None) => mesh.indices[face],
            (_, Some(own)) => *own,
        };
        let mut known: HashMap<[u32; 3], u32> = HashMap::new();
        let mut vertices: Vec<[u32; 3]> = Vec::new();
        let mut flat: Vec<Vec3> = Vec::new();
        let mut indices: Vec<u32> = Vec::with_capacity(3 * mesh.indices.len());
        let normal_count = mesh.normals.len() as u32;
        let smooth = mesh.normal_indices.is_empty() && !mesh.normals.is_empty()
            || mesh.normal_indices.iter().flatten().any(|i| *i != NO_INDEX);
        for (face, corners) in mesh.indices.iter().enumerate() {
            let mut normals = numbers(&mesh.normal_indices, face, mesh.normals.len());
            let uvs = numbers(&mesh.uv_indices, face, mesh.uvs.len());
            if smooth && normals.contains(&NO_INDEX) {
                // A normal of its own for a corner that has none.
                let [a, b, c] = corners.map(|i| mesh.positions[i as usize]);
                let number = normal_count + flat.len() as u32;
                flat.push((b - a).cross(c - a).normalize_or(Vec3::Y));
                normals = normals.map(|i| if i == NO_INDEX { number } else { i });
            }
            for k in 0..3 {
                let key = [corners[k], if smooth { normals[k] } else { NO_INDEX }, uvs[k]];
                indices.push(*known.entry(key).or_insert_with(|| {
                    vertices.push(key);
                    vertices.len() as u32 - 1
                }));
            }
        }
        let places: Vec<_> = vertices.iter().map(|[p, ..]| mesh.positions[*p as usize]).collect();
        let mut attributes = Map::new();
        attributes.insert("POSITION".into(), json!(self.vectors(&places, true)));
        if smooth {
            let normal = |i: u32| match i.checked_sub(normal_count) {
                Some(own) => flat.get(own as usize).copied(),
                None => mesh.normals.get(i as usize).copied(),
            };
            let normals = vertices.iter().map(|[_, n, _]| normal(*n).unwrap_or(Vec3::Y));
            let normals: Vec<_> = normals.map(|n| n.normalize_or(Vec3::Y)).collect();
            attributes.insert("NORMAL".into(), json!(self.vectors(&normals, false)));
        }
        if !mesh.uvs.is_empty() {
            let uv = |i: u32| mesh.uvs.get(i as usize).copied().unwrap_or_default();
            // The second coordinate grows down the image there.
            let down = |i: u32| [uv(i).x, 1.0 - uv(i).y];
            let all: Vec<f32> = vertices.iter().flat_map(|[.., i]| down(*i)).collect();
            let count = vertices.len();
            let accessor = self.floats(&all, json!({ "type": "VEC2", "count": count }));
            attributes.insert("TEXCOORD_0".into(), json!(accessor));
        }
        if !mesh.colors.is_empty() {
            let color = |i: u32| mesh.colors.get(i as usize).copied().unwrap_or_default();
            let colors: Vec<_> = vertices.iter().map(|[i, ..]| color(*i)).collect();
            attributes.insert("COLOR_0".into(), json!(self.colors(&colors, material)));
        }
        let view = self.view(indices.iter().flat_map(|i| i.to_le_bytes()), Some(34963));
        let accessor = json!({
            "bufferView": view, "componentType": 5125, "type": "SCALAR", "count": indices.len()
        });
        let indices = self.push("accessors", accessor);
        json!({ "attributes": attributes, "indices": indices, "material": material })
    }

    /// Colours, by which a reader multiplies the material's.
    fn colors(&mut self, colors: &[Rgb], material: u32) -> usize {
        let of = self.scene.materials.get(material as usize);
        let how = of.map_or(VertexColors::Multiply, |m| m.vertex_colors);
        let replaced = of.filter(|_| how == VertexColors::Replace);
        let base = replaced.map_or(Rgb::WHITE, |m| base_color(&m.at(|_| Rgb::grey(0.5))));
        let share = |c: f32, base: f32| match how {
            VertexColors::Ignore => 1.0,
            _ if base > 0.0 => c / base,
            _ => c,
        };
        let all = colors
            .iter()
            .flat_map(|c| [share(c.r, base.r), share(c.g, base.g), share(c.b, base.b)]);
        let all: Vec<f32> = all.collect();
        self.floats(&all, json!({ "type": "VEC3", "count": colors.len() }))
    }

    fn vectors(&mut self, vectors: &[Vec3], bounds: bool) -> usize {
        let all: Vec<f32> = vectors.iter().flat_map(Vec3::to_array).collect();
        let mut accessor = json!({ "type": "VEC3", "count": vectors.len() });
        if bounds {
            let start = (Vec3::INFINITY, Vec3::NEG_INFINITY);
            let (low, high) =
                vectors.iter().fold(start, |(low, high), v| (low.min(*v), high.max(*v)));
            accessor["min"] = json!(low.to_array());
            accessor["max"] = json!(high.to_array());
        }
        self.floats(&all, accessor)
    }

    fn floats(&mut self, numbers: &[f32], mut accessor: Value) -> usize {
        let view = self.view(numbers.iter().flat_map(|n| n.to_le_bytes()), Some(34962));
        accessor["bufferView"] = json!(view);
        accessor["componentType"] = json!(5126);
        self.push("accessors", accessor)
    }

    fn view(&mut self, bytes: impl Iterator<Item = u8>, target: Option<u32>) -> usize {
        let start = self.bytes.len();
        self.bytes.extend(bytes);
        let length = self.bytes.len() - start;
        let view = json!({
            "buffer": 0, "byteOffset": start, "byteLength": length, "target": target
        });
        self.push("bufferViews", view)
    }

    fn camera(&mut self, account: &mut Account) -> Option<usize> {
        let camera = &self.scene.camera;
        let [width, height] = self.scene.image.size.map(f64::from);
        let value = match camera.kind {
            CameraKind::Perspective { fov } => json!({ "type": "perspective", "perspective": {
                "yfov": fov.to_radians(), "aspectRatio": width / height, "znear": 1e-3
            } }),
            CameraKind::Orthographic { height: tall } => {
                let (ymag, xmag) = (0.5 * tall, 0.5 * tall * width / height);
                json!({ "type": "orthographic", "orthographic": {
                    "xmag": xmag, "ymag": ymag, "znear": 1e-3, "zfar": 1e6
                } })
            }
            CameraKind::Fisheye { .. } | CameraKind::Panorama => {
                let message = "glTF holds no camera of this kind".to_owned();
                account.drop(Diagnostic::warning(message, None));
                return None;
            }
        };
        let camera_number = self.push("cameras", value);
        let forward = (camera.look_at - camera.eye).normalize_or(-glam::DVec3::Z);
        let matrix = looking(camera.eye, forward, camera.up);
        let node = json!({ "name": "camera", "camera": camera_number, "matrix": matrix });
        Some(self.push("nodes", node))
    }

    /// The node of a light, which is this one of those that are written. Its intensity is π times ours, which
    /// a reader divides by.
    fn light(&mut self, number: usize, light: &Light) -> usize {
        let Rgb { r, g, b } = light.color;
        let most = r.max(g).max(b).max(f32::MIN_POSITIVE);
        let (kind, position, direction) = match light.kind {
            LightKind::Distant { direction, .. } => ("directional", glam::DVec3::ZERO, direction),
            // It has no place of its own, and is not written.
            LightKind::Mesh { .. } => ("point", glam::DVec3::ZERO, -glam::DVec3::Y),
            LightKind::Point { position, .. } | LightKind::Sphere { position, .. } => {
                ("point", position, -glam::DVec3::Y)
            }
            LightKind::Spot { position, target, .. } => ("spot", position, target - position),
            LightKind::Rectangle { position, direction, .. }
            | LightKind::Disc { position, direction, .. } => ("spot", position, direction),
        };
        let mut value = json!({
            "type": kind, "name": light.name, "color": [r / most, g / most, b / most],
            "intensity": most * std::f32::consts::PI
        });
        if let LightKind::Spot { cone, edge, .. } = light.kind {
            let (inner, outer) = (cone.to_radians(), edge.to_radians());
            value["spot"] = json!({ "innerConeAngle": inner, "outerConeAngle": outer });
        }
        if light.kind.facing().is_some() {
            // To one side, as nearly as the format has it.
            let half = std::f64::consts::FRAC_PI_2;
            value["spot"] = json!({ "innerConeAngle": 0.999 * half, "outerConeAngle": half });
        }
        if let Some(range) = light.range {
            value["range"] = json!(range);
        }
        let extensions = self.root.entry("extensions").or_insert_with(|| json!({}));
        let all = &mut extensions["KHR_lights_punctual"]["lights"];
        if all.is_null() {
            *all = json!([]);
        }
        if let Value::Array(all) = all {
            all.push(value);
        }
        let up = direction.any_orthogonal_vector();
        let matrix = looking(position, direction.normalize_or(-glam::DVec3::Y), up);
        let extension = json!({ "KHR_lights_punctual": { "light": number } });
        self.push("nodes", json!({ "name": light.name, "matrix": matrix, "extensions": extension }))
    }
}

/// Where something stands that looks along its own −Z.
fn looking(eye: glam::DVec3, forward: glam::DVec3, up: glam::DVec3) -> [f64; 16] {
    let right = forward.cross(up).normalize_or(forward.any_orthonormal_vector());
    let up = right.cross(forward);
    let matrix = glam::DMat3::from_cols(right, up, -forward);
    glam::DMat4::from(DAffine3 { matrix3: matrix, translation: eye }).to_cols_array()
}

/// What is added to the positions of a shape.
fn origin(shape: &Shape) -> glam::DVec3 {
    match shape {
        Shape::Mesh(mesh) => mesh.origin,
        Shape::Points(points) => points.origin,
        Shape::Cylinders(cylinders) => cylinders.origin,
        _ => glam::DVec3::ZERO,
    }
}

fn has_radius(shape: &Shape) -> bool {
    matches!(shape, Shape::Points(_) | Shape::Cylinders(_))
}
