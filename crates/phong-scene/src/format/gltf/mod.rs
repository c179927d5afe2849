//! glTF 2.0: as text with its buffers in it or beside it, and as one binary file (GLB).
//!
//! | in the file | read as |
//! |---|---|
//! | nodes of the scene (of the first, of all, where none is named) | objects where their nodes stand; a mesh of several nodes is a group, placed by instances |
//! | meshes without nodes at all | objects where they are |
//! | a root of the scene that is another node's child | a warning; drawn as a root, or once, below the root that it belongs to |
//! | primitives: triangles, strips, fans | meshes; without `NORMAL`, flat |
//! | points; lines, strips and loops of them | spheres, as those of PLY files are; capsules of 0.2 % of their extent in radius, of a bare model thick enough to be seen |
//! | `COLOR_0` | linear colours, times the material's: what it scatters, and what it mirrors where it is everywhere as metallic; a material without images that does not say how metallic it is is then no metal. Their alpha is not drawn |
//! | accessors: strided, sparse, normalised, without a view | numbers, as the format says |
//! | skins | the mesh bent to where its bones stand in the file; morph targets are not applied |
//! | cameras | the camera of the first node that has one |
//! | `KHR_lights_punctual` | lights of their intensity / π; point and spot lights fall off with the square, and end at their `range`; all are dimmed alike, which is told, where white would be white ten times over |
//! | metallic and rough materials | GGX with α = roughness², Smith, Schlick; F₀ = 0.04 and the base colour for metals, of which no diffuse colour is left |
//! | ambient light, of which the format says nothing | `k_a` is 0.1, for metals 0.4, in place of what they would mirror; by the mean of an image of metal |
//! | `KHR_materials_ior`, `_specular`, `_emissive_strength`, `_pbrSpecularGlossiness` | F₀, the glow, a roughness of 1 − glossiness |
//! | `KHR_materials_transmission`, `alphaMode` `BLEND` | rays that go straight on, by the factor and by 1 − alpha |
//! | `KHR_materials_unlit` | a surface that glows in its colour, and is not lit |
//! | images of base colour, metal and roughness, normals, occlusion, emission | textures, from buffers, texts and files, with `KHR_texture_transform`; α is of an image of its own, and so are the colours where the share of metal varies, whose facets are then perfect mirrors |
//! | `texCoord`, also of `KHR_texture_transform` | the mesh's coordinates are of the set of the material's first image (colour, metal, normals, occlusion, emission); another image of another set is a warning, and lies by the same |
//! | `alphaMode` with an image of the base colour | `opacity` by its alpha, a mask by `alphaCutoff` |
//! | a base colour whose image cannot be read | a warning; the factor, or a grey of 0.8 where that is white |
//! | images of base colour and of metal that lie differently | a warning; everywhere as metallic as the mean |
//! | other images | a warning |
//! | other extensions | a warning; where the file requires one, an error |
//!
//! What is wrong is said with a JSON pointer. What is out of range, or cut short, refuses the file,
//! unless it is read leniently: then what can be drawn is.
//!
//! Own reader on `serde_json`: the crate `gltf` checks a document before it looks at it, and stops
//! there, so that one bad mesh among many would leave nothing; it knows no limits.

mod bright;
mod buffer;
mod bytes;
pub(crate) mod export;
mod images;
mod json;
mod material;
mod nodes;
mod primitive;
mod surface;
mod uri;

use std::collections::{BTreeMap, BTreeSet};
use std::io;
use std::ops::Range;
use std::sync::Arc;

use glam::{DAffine3, DMat4};
use serde_json::Value;

use self::buffer::Buffers;
use self::bytes::Bytes;
use self::images::Images;
use self::json::{At, Fault, Result};
use self::nodes::Node;
use self::primitive::{Pose, Reader, matrix};
use super::export::free_name;
use super::input::Input;
use super::text::{Findings, whole};
use crate::diagnostic::{Diagnostic, Place, Span};
use crate::fragment::Fragment;
use crate::material::MaterialId;
use crate::scene::{Group, Object};
use crate::shape::{GroupId, Shape};
use crate::source::{Blob, trouble};
use crate::transform::is_regular;

/// What a binary file begins with, and the names of its two chunks.
const MAGIC: &[u8] = b"glTF";
const JSON: &[u8] = b"JSON";
const BIN: &[u8] = b"BIN\0";

/// The extensions that are understood, or change nothing that is drawn.
const KNOWN: [&str; 9] = [
    nodes::LIGHTS,
    "KHR_mesh_quantization",
    "KHR_materials_unlit",
    "KHR_materials_ior",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_emissive_strength",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_texture_transform",
];

/// Whether a file that begins so is surely glTF.
pub(crate) fn is_gltf(head: &[u8]) -> bool {
    let has = |words: &[u8]| head.windows(words.len()).any(|part| part == words);
    head.starts_with(MAGIC)
        || head.trim_ascii_start().starts_with(b"{") && has(b"\"asset\"") && has(b"\"version\"")
}

/// Reads a glTF file; `None` if a diagnostic is an error.
pub(crate) fn read(input: &Input<'_>, out: &mut Vec<Diagnostic>) -> Option<Fragment> {
    let file: Arc<str> = input.path.into();
    let mut findings = Findings::default();
    let fragment = document(&file, input, &mut findings);
    let sound = !findings.any_error();
    findings.tell(&file, out);
    match fragment {
        Ok(fragment) => fragment.filter(|_| sound),
        Err(error) => {
            let message = format!("cannot be read: {}", trouble(&error));
            out.push(Diagnostic::error(message, whole(&file)));
            None
        }
    }
}

/// Reads the file and what it names.
fn document(
    file: &Arc<str>,
    input: &Input<'_>,
    findings: &mut Findings,
) -> io::Result<Option<Fragment>> {
    let limits = input.limits;
    let blob = input.source.open(file)?;
    if blob.len() > limits.bytes {
        return Err(io::Error::new(io::ErrorKind::FileTooLarge, "it is larger than is allowed"));
    }
    let mut head = [0; MAGIC.len()];
    let (text, binary) = if blob.read_full(&mut head, 0)? == MAGIC.len() && head == MAGIC {
        match chunks(blob.as_ref())? {
            Ok((text, binary)) => (text, Some(binary)),
            Err(message) => {
                findings.error("broken files", || whole(file), || message);
                return Ok(None);
            }
        }
    } else {
        (0..blob.len(), None)
    };
    let length = text.end - text.start;
    if length > limits.text_bytes {
        let message = format!("its JSON has more than {} bytes", limits.text_bytes);
        return Err(io::Error::new(io::ErrorKind::FileTooLarge, message));
    }
    let mut bytes = Vec::new();
    bytes.try_reserve_exact(length as usize)?;
    bytes.resize(length as usize, 0);
    let read = blob.read_full(&mut bytes, text.start)?;
    bytes.truncate(read);
    let binary = match binary {
        Some(binary) => Some(Bytes::of(blob, binary.start, binary.end - binary.start, true)?),
        None => None,
    };
    let text = &bytes[..];
    let text = text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text);
    let value: Value = match serde_json::from_slice(text) {
        Ok(value) => value,
        Err(error) => {
            let (line, column) = (error.line() as u32, error.column() as u32);
            let place = Place { file: Arc::clone(file), line, column };
            let said = error.to_string();
            let said = said.rsplit_once(" at line").map_or(said.as_str(), |(said, _)| said);
            let message = format!("the JSON is broken: {said}");
            let span = Span { place, ..Span::default() };
            findings.error("broken files", || span, || message);
            return Ok(None);
        }
    };
    drop(bytes);
    let root = At::root(&value);
    let fragment = assemble(&root, binary, file, input, findings);
    Ok(fragment.map_err(|fault| tell(findings, true, file, fault)).ok())
}

/// Where the text of a binary file lies, and the bytes behind it, if there are any.
type Chunks = (Range<u64>, Range<u64>);

/// The chunks of a binary file; or what is wrong with it.
fn chunks(blob: &dyn Blob) -> io::Result<std::result::Result<Chunks, String>> {
    let there = blob.len();
    let word = |at: u64| -> io::Result<Option<[u8; 4]>> {
        let mut bytes = [0; 4];
        Ok((blob.read_full(&mut bytes, at)? == bytes.len()).then_some(bytes))
    };
    let number = |at: u64| Ok::<_, io::Error>(word(at)?.map(u32::from_le_bytes).map(u64::from));
    let message = match (number(4)?, number(8)?) {
        (Some(2), Some(length)) if length > there => {
            Some(format!("the file is cut short: {there} of its {length} bytes are there"))
        }
        (Some(2), _) => None,
        (Some(other), _) => Some(format!("it is binary glTF {other}; only 2 is read")),
        (None, _) => Some("the file ends within its head".to_owned()),
    };
    if let Some(message) = message {
        return Ok(Err(message));
    }
    let chunk = |at: u64, kind: &[u8]| -> io::Result<Option<Range<u64>>> {
        let (length, named) = (number(at)?, word(at + 4)?);
        let end = length.map(|length| at + 8 + length).filter(|end| *end <= there);
        Ok(end.filter(|_| named.is_some_and(|name| name == kind)).map(|end| at + 8..end))
    };
    let Some(json) = chunk(12, JSON)? else {
        return Ok(Err("the file holds no chunk of JSON".to_owned()));
    };
    // Chunks begin at multiples of four; some programs put the second right behind the first all the same.
    let end = json.end;
    let aligned = chunk(end.next_multiple_of(4), BIN)?;
    let binary = if aligned.is_some() { aligned } else { chunk(end, BIN)? };
    Ok(Ok((json, binary.unwrap_or_default())))
}

/// Says a fault: an error, unless it leaves something to be drawn leniently.
fn tell(findings: &mut Findings, fatal: bool, file: &Arc<str>, fault: Fault) {
    let Fault { pointer, message } = fault;
    let pointer = if pointer.is_empty() { "/".to_owned() } else { pointer };
    let message = || format!("{pointer}: {message}");
    findings.damage(!fatal, "faults of the document", || whole(file), message);
}

/// All that the document's scene holds.
fn assemble<'a>(
    root: &At<'a>,
    binary: Option<Bytes>,
    file: &Arc<str>,
    input: &Input<'a>,
    findings: &mut Findings,
) -> Result<Fragment> {
    let Input { path, source, limits, radius, .. } = *input;
    check_version(root)?;
    check_extensions(root, file, findings)?;
    let nodes = nodes::drawn(root, (file, findings))?;
    let buffers = Buffers::read(root, path, binary, source, limits)?;
    let reader = Reader { root: root.clone(), buffers, file: Arc::clone(file), limits, radius };
    let images = Images::new(root.clone(), path, source, limits);
    let mut scene = Scene {
        lenient: limits.lenient,
        reader,
        fragment: Fragment::default(),
        images,
        materials: BTreeMap::new(),
        names: BTreeSet::new(),
        findings,
    };
    scene.draw(&nodes)?;
    let Scene { mut fragment, images, .. } = scene;
    fragment.textures = images.textures;
    if let Some(times) = bright::dim(&mut fragment) {
        let message = || {
            format!(
                "the lights would make all white, {times:.0} times over: they are dimmed so much"
            )
        };
        findings.note("bright lights", || whole(file), message);
    }
    Ok(fragment)
}

fn check_version(root: &At<'_>) -> Result<()> {
    let asset = root.need("asset")?;
    for key in ["version", "minVersion"] {
        let Some(at) = asset.get(key) else { continue };
        let version = at.text()?;
        let major = version.split('.').next().unwrap_or_default();
        if major != "2" || key == "minVersion" && version != "2.0" {
            return Err(at.fault(format!("it is glTF {version}; only 2.0 is read")));
        }
    }
    asset.need("version").map(|_| ())
}

fn check_extensions(root: &At<'_>, file: &Arc<str>, findings: &mut Findings) -> Result<()> {
    let mut required = BTreeSet::new();
    for at in root.list("extensionsRequired")? {
        let name = at.text()?;
        required.insert(name);
        if !KNOWN.contains(&name) {
            let message = format!("the file requires `{name}`, which is not understood");
            return Err(at.fault(message));
        }
    }
    for at in root.list("extensionsUsed")? {
        let name = at.text()?;
        if !KNOWN.contains(&name) {
            findings.warning(
                "extensions that are not used",
                || whole(file),
                || format!("{}: `{name}` is not understood, and not used", at.pointer),
            );
        }
    }
    Ok(())
}

/// What is drawn so far.
struct Scene<'a, 'f> {
    lenient: bool,
    reader: Reader<'a>,
    fragment: Fragment,
    /// The images of materials.
    images: Images<'a>,
    /// By the number of a material, and whether vertices have colours: its number here, and the set of texture
    /// coordinates that its images lie in.
    materials: BTreeMap<(usize, bool), (MaterialId, u64)>,
    /// The names of groups.
    names: BTreeSet<String>,
    findings: &'f mut Findings,
}

impl<'a> Scene<'a, '_> {
    fn draw(&mut self, nodes: &[Node<'a>]) -> Result<()> {
        let root = self.reader.root.clone();
        let place = Place { file: Arc::clone(&self.reader.file), ..Place::default() };
        let meshes = root.list("meshes")?;
        let mut uses = vec![Vec::new(); meshes.len()];
        let mut cameras = 0;
        for node in nodes {
            match nodes::camera(&root, node) {
                Ok(None) => {}
                Ok(Some(camera)) => {
                    cameras += 1;
                    self.fragment.camera.get_or_insert(camera);
                }
                Err(fault) => self.fault(fault),
            }
            match nodes::light(&root, node, &place) {
                Ok(light) => self.fragment.lights.extend(light),
                Err(fault) => self.fault(fault),
            }
            let Some(number) = node.at.get("mesh") else { continue };
            match uses.get_mut(number.index()?) {
                Some(uses) => uses.push(node),
                None => self.fault(number.fault("there is no such mesh")),
            }
        }
        if cameras > 1 {
            self.warn("cameras", format!("there are {cameras} cameras; the first is used"));
        }
        let unused = uses.iter().filter(|uses| uses.is_empty()).count();
        let without_nodes = root.list("nodes")?.is_empty();
        if unused > 0 && !without_nodes {
            self.warn("meshes", format!("meshes that the scene does not use: {unused}; not drawn"));
        }
        for (mesh, nodes) in meshes.iter().zip(&uses) {
            if let Err(fault) = self.mesh(mesh, nodes, without_nodes) {
                self.fault(fault);
            }
        }
        if self.fragment.objects.is_empty() {
            let message = || "there is nothing to draw: no mesh is left".to_owned();
            self.findings.error("empty models", || whole(&self.reader.file), message);
        }
        Ok(())
    }

    /// One mesh, where these nodes stand.
    fn mesh(&mut self, at: &At<'a>, nodes: &[&Node<'a>], alone: bool) -> Result<()> {
        let mut placed = Vec::new();
        for node in nodes {
            if let Some(skin) = node.at.get("skin") {
                // Its bones say where it stands, and not its node.
                let pose = self.pose(&skin)?;
                let objects = self.primitives(at, Some(&pose))?;
                self.fragment.objects.extend(objects);
            } else if is_regular(node.to_world.matrix3) && node.to_world.is_finite() {
                placed.push(node.to_world);
            } else {
                let message =
                    format!("{}: it has no extent; its mesh is not drawn", node.at.pointer);
                self.warn("nodes without extent", message);
            }
        }
        if alone {
            placed.push(DAffine3::IDENTITY);
        }
        let Some(first) = placed.first().copied() else { return Ok(()) };
        let mut objects = self.primitives(at, None)?;
        if objects.is_empty() {
            return Ok(());
        }
        if placed.len() == 1 {
            for object in &mut objects {
                object.transform = first;
            }
            self.fragment.objects.append(&mut objects);
            return Ok(());
        }
        let name = free_name(&at.name("mesh"), &mut self.names);
        let group = GroupId(self.fragment.groups.len() as u32);
        self.fragment.groups.push(Group { name, objects });
        let instance = |transform| Object {
            name: String::new(),
            transform,
            ..Object::from(Shape::Instance(group))
        };
        self.fragment.objects.extend(placed.into_iter().map(instance));
        Ok(())
    }

    /// The objects of a mesh, in its own space.
    fn primitives(&mut self, at: &At<'a>, pose: Option<&Pose>) -> Result<Vec<Object>> {
        let moved = |weights: &At<'_>| -> Result<bool> {
            Ok(weights.items()?.iter().any(|weight| weight.number().is_ok_and(|w| w != 0.0)))
        };
        if at.get("weights").map_or(Ok(false), |weights| moved(&weights))? {
            self.warn("morphs", format!("{}: morph targets are not applied", at.pointer));
        }
        let mut objects = Vec::new();
        for primitive in at.need("primitives")?.items()? {
            match self.primitive(&primitive, pose) {
                Ok(object) => objects.extend(object),
                Err(fault) => self.fault(fault),
            }
        }
        Ok(objects)
    }

    fn primitive(&mut self, at: &At<'a>, pose: Option<&Pose>) -> Result<Option<Object>> {
        let colored = at.get("attributes").is_some_and(|all| all.get("COLOR_0").is_some());
        let (material, set) = match self.material(at.get("material").as_ref(), colored) {
            Ok(material) => material,
            Err(Fault { pointer, message }) => {
                let message = format!("{pointer}: {message}; the default material is used");
                self.warn("materials that cannot be read", message);
                (MaterialId::default(), 0)
            }
        };
        let shape = self.reader.shape((at, set), pose, self.findings)?;
        let object = |shape| Object { name: String::new(), material, ..Object::from(shape) };
        Ok(shape.map(object))
    }

    /// The material of a primitive, whose vertices may have colours. Material 0 is of what names none: whoever takes
    /// the model chooses it.
    fn material(&mut self, at: Option<&At<'a>>, colored: bool) -> Result<(MaterialId, u64)> {
        let Some(at) = at else { return Ok((MaterialId::default(), 0)) };
        let number = at.index()?;
        if let Some(known) = self.materials.get(&(number, colored)) {
            return Ok(*known);
        }
        let Reader { root, buffers, file, .. } = &self.reader;
        let of = root.item("materials", number).map_err(|f| at.fault(f.message))?;
        let from = (buffers, file);
        let (material, set) =
            material::read((&of, colored), &mut self.images, from, self.findings)?;
        let id = MaterialId(self.fragment.materials.len() as u32);
        self.fragment.materials.push(material);
        self.materials.insert((number, colored), (id, set));
        Ok((id, set))
    }

    /// Where the bones of a skin stand.
    fn pose(&self, skin: &At<'a>) -> Result<Pose> {
        let root = &self.reader.root;
        let at = root.item("skins", skin.index()?).map_err(|f| skin.fault(f.message))?;
        // What there is to say of them has been said.
        let said = &mut Findings::default();
        let worlds: BTreeMap<usize, DAffine3> = nodes::drawn(root, (&self.reader.file, said))?
            .into_iter()
            .filter_map(|node| {
                let number = node.at.pointer.rsplit('/').next()?.parse().ok()?;
                Some((number, node.to_world))
            })
            .collect();
        let inverse = match at.get("inverseBindMatrices") {
            Some(index) => {
                let Reader { buffers, limits, .. } = &self.reader;
                buffers.rows::<16>(root, &index, limits)?
            }
            None => Vec::new(),
        };
        let bone = |(i, joint): (usize, At<'a>)| -> Result<DMat4> {
            let number = joint.index()?;
            let world = worlds.get(&number).copied().unwrap_or(DAffine3::IDENTITY);
            let inverse = inverse.get(i).map_or(DMat4::IDENTITY, |numbers| matrix(*numbers));
            Ok(DMat4::from(world) * inverse)
        };
        at.need("joints")?
            .items()?
            .into_iter()
            .enumerate()
            .map(bone)
            .collect::<Result<_>>()
            .map(Pose)
    }

    fn fault(&mut self, fault: Fault) {
        tell(self.findings, !self.lenient, &self.reader.file, fault);
    }

    fn warn(&mut self, plural: &'static str, message: String) {
        self.findings.warning(plural, || whole(&self.reader.file), || message);
    }
}
