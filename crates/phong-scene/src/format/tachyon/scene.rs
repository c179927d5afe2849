//! The statements of all pieces, put together in order.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;

use super::camera::Frame;
use super::clip::Clips;
use super::shapes::{Bulk, ring};
use super::sky::{Gradient, Haze};
use super::texture::{Drawing, Key, Texture, rgb};
use super::things::{Lamp, Mode, Named, Statement, Things};
use crate::ambient_occlusion::{AmbientOcclusion, OcclusionDistance};
use crate::color::Rgb;
use crate::diagnostic::{Diagnostic, Place};
use crate::format::input::Input;
use crate::format::text::{Findings, whole};
use crate::format::triangles::has_room;
use crate::light::{Light, LightKind};
use crate::material::MaterialId;
use crate::mesh::Caps;
use crate::scene::{Background, Image, Object, Scene};
use crate::shape::Shape;

/// What textures are that a name has again.
const TWICE: &str = "textures defined twice";

/// The most files that a scene may include, those that they include counted too.
const INCLUDES: u32 = 1000;

/// How many times its distance from the camera an endless cylinder is drawn to either side.
const ENDLESS: f64 = 1000.0;

/// A shape of which there are few, with its texture, and the number of the clip group that it is in.
type Single = (Shape, Texture, Option<usize>, Place);

/// What has been read of a scene.
pub(super) struct Assembly<'a> {
    /// The file that was asked for.
    pub(super) input: Input<'a>,
    /// How many files have been included.
    included: u32,
    /// How many files include the one that is read.
    pub(super) depth: u32,
    /// What was said of files that were read.
    pub(super) told: Vec<Diagnostic>,
    textures: BTreeMap<Vec<u8>, Texture>,
    /// Things of many kinds, by the numbers of their textures without the colour, and their clip groups.
    groups: BTreeMap<(Key, Option<usize>), usize>,
    bulk: Vec<Bulk>,
    /// Others, with their textures.
    objects: Vec<Single>,
    clips: Clips,
    lamps: Vec<(Lamp, Place)>,
    size: Option<[u64; 2]>,
    frame: Option<Frame>,
    background: Background,
    gradient: Option<Gradient>,
    haze: Option<Haze>,
    mode: Mode,
    /// How many of what is not drawn, in the plural.
    ignored: BTreeMap<&'static str, u64>,
    left_out: u64,
}

impl<'a> Assembly<'a> {
    /// Nothing yet.
    pub(super) fn new(input: Input<'a>) -> Self {
        Self {
            input,
            included: 0,
            depth: 0,
            told: Vec::new(),
            textures: BTreeMap::new(),
            groups: BTreeMap::new(),
            bulk: Vec::new(),
            objects: Vec::new(),
            clips: Clips::default(),
            lamps: Vec::new(),
            size: None,
            frame: None,
            background: Background::default(),
            gradient: None,
            haze: None,
            mode: Mode::default(),
            ignored: BTreeMap::new(),
            left_out: 0,
        }
    }

    /// Whether memory suffices for what was read, and for so many bytes more.
    pub(super) fn has_room(&self, more: u64, file: &Arc<str>, findings: &mut Findings) -> bool {
        let all = self.bulk.iter();
        let (triangles, vertices) =
            all.fold((0, 0), |(t, v), bulk| (t + bulk.triangles(), v + bulk.vertices()));
        let bytes = self.bulk.iter().map(Bulk::bytes).sum::<u64>();
        let bytes = bytes.saturating_add(more).saturating_add(256 * self.objects.len() as u64);
        has_room(triangles, vertices, bytes, self.input.limits, file, findings)
    }

    /// Takes what a piece of a file holds.
    pub(super) fn add(&mut self, things: Things, file: &Arc<str>, findings: &mut Findings) {
        let mut used: Vec<(usize, Texture)> = Vec::new();
        let Things { spheres, cylinders, triangles, statements, left_out, .. } = things;
        self.left_out += left_out;
        for (line, statement) in statements {
            let place =
                Place { file: Arc::clone(file), line: line.min(u32::MAX.into()) as u32, column: 1 };
            if let Statement::Use(named) = statement {
                let texture = match named {
                    Named::Own(texture) => texture,
                    Named::Name(name) => self.texture(&name, &place, findings),
                };
                used.push((self.group(&texture), texture));
            } else {
                self.statement(statement, &used, place, findings);
            }
        }
        let of = |texture: u32| {
            used.get(texture as usize).map_or((0, Rgb::BLACK), |(g, t)| (*g, t.rgb()))
        };
        for (sphere, texture) in spheres {
            let (group, color) = of(texture);
            if let Some(bulk) = self.bulk.get_mut(group) {
                bulk.spheres.push(sphere);
                bulk.sphere_colors.push(color);
            }
        }
        for (ends, texture) in cylinders {
            let (group, color) = of(texture);
            if let Some(bulk) = self.bulk.get_mut(group) {
                bulk.cylinders(Caps::Open).push((ends, color));
            }
        }
        for triangle in triangles {
            let (group, color) = of(triangle.texture);
            if let Some(bulk) = self.bulk.get_mut(group) {
                bulk.triangle(&triangle, color);
            }
        }
    }

    /// The number of the things of this texture.
    fn group(&mut self, texture: &Texture) -> usize {
        let next = self.bulk.len();
        let clip = self.clips.now();
        let number = *self.groups.entry((texture.key(), clip)).or_insert(next);
        if number == next {
            self.bulk.push(Bulk::of(*texture, clip));
        }
        number
    }

    /// The texture of a name.
    fn texture(&mut self, name: &[u8], place: &Place, findings: &mut Findings) -> Texture {
        if let Some(texture) = self.textures.get(name) {
            return *texture;
        }
        let message = || {
            let name = String::from_utf8_lossy(name);
            format!("there is no texture `{name}` before this line; it is grey")
        };
        let span = || crate::diagnostic::Span { place: place.clone(), ..Default::default() };
        findings.warning("textures that are not there", span, message);
        self.textures.insert(name.to_vec(), Texture::DEFAULT);
        Texture::DEFAULT
    }

    /// Takes a statement of which there are few.
    fn statement(
        &mut self,
        statement: Statement,
        used: &[(usize, Texture)],
        place: Place,
        findings: &mut Findings,
    ) {
        let texture = |number: u32| used.get(number as usize).map_or(Texture::DEFAULT, |(_, t)| *t);
        let group = |number: u32| used.get(number as usize).map_or(0, |(group, _)| *group);
        match statement {
            Statement::Define(name, texture) => {
                if self.textures.contains_key(&name) {
                    *self.ignored.entry(TWICE).or_default() += 1;
                }
                self.textures.entry(name).or_insert(texture);
            }
            Statement::Alias(name, of) => {
                let texture = self.texture(&of, &place, findings);
                self.textures.entry(name).or_insert(texture);
            }
            Statement::Light(lamp) => self.lamps.push((lamp, place)),
            Statement::Plane { point, normal, texture: number } => {
                self.object(Shape::Plane { point, normal }, normal, 1.0, texture(number), place);
            }
            Statement::Box { min, max, texture: number } => {
                let (min, max) = (min.min(max), min.max(max));
                let least = (max - min).min_element();
                self.object(Shape::Box { min, max }, DVec3::X, least, texture(number), place);
            }
            Statement::Ring { center, normal, inner, outer, texture: number } => {
                let normal = normal.normalize_or_zero();
                let shape = if inner > 0.0 && inner < outer {
                    ring(center, normal, inner, outer).into()
                } else {
                    Shape::Disc { center, normal, radius: outer }
                };
                self.object(shape, normal, outer, texture(number), place);
            }
            Statement::Cylinder { center, axis, radius, texture: number } => {
                let eye = self.frame.map_or(DVec3::ZERO, |frame| frame.eye().as_dvec3());
                let half = ENDLESS * (center.distance(eye) + radius) * axis.normalize_or_zero();
                let (from, to) = (center - half, center + half);
                let shape = Shape::Cylinder { from, to, radius, capped: false };
                self.object(shape, axis, radius, texture(number), place);
            }
            Statement::Chain { points, radius, texture: number } => {
                let ends = points.windows(2).map(|pair| [pair[0], pair[1]]);
                let ends = ends.chain((points.len() == 1).then(|| [points[0]; 2]));
                let ends = ends.map(|ends| ends.map(|p| [p.x, p.y, p.z, radius]));
                let sound = |ends: &[[f32; 4]; 2]| {
                    ends.as_flattened().iter().all(|n| n.abs() <= crate::limits::LARGEST as f32)
                };
                let (held, bad): (Vec<_>, Vec<_>) =
                    ends.partition(|ends| sound(ends) && radius > 0.0);
                self.left_out += bad.len() as u64;
                let color = texture(number).rgb();
                if let Some(bulk) = self.bulk.get_mut(group(number)) {
                    bulk.cylinders(Caps::Round).extend(held.into_iter().map(|ends| (ends, color)));
                }
            }
            Statement::Mesh(array) => {
                let outside = array.outside;
                if outside > 0 {
                    let message =
                        || format!("triangles that name a vertex that is not there: {outside}");
                    let span = || crate::diagnostic::Span { place, ..Default::default() };
                    let plural = "arrays with vertices that are not there";
                    findings.damage(self.input.limits.lenient, plural, span, message);
                }
                let texture = texture(array.texture);
                if let Some(bulk) = self.bulk.get_mut(group(array.texture)) {
                    self.left_out += bulk.array(array, texture.rgb());
                }
            }
            Statement::Resolution(size) => self.size = Some(size),
            Statement::Camera(frame) => self.frame = Some(frame),
            Statement::Background(color) => {
                self.background = Background::Color(rgb(color));
                self.gradient = None;
            }
            Statement::Gradient(gradient) => self.gradient = Some(gradient),
            Statement::Fog(haze) => self.haze = Some(haze),
            Statement::Mode(mode) => self.mode = mode,
            Statement::BeginClip(planes) => self.clips.begin(&planes, &place),
            Statement::EndClip => self.clips.end(),
            Statement::Include(name) => {
                let name = String::from_utf8_lossy(&name);
                let folder = place.file.rfind(['/', '\\']).map_or("", |end| &place.file[..=end]);
                let own = if name.starts_with('/') { "" } else { folder };
                let path = format!("{own}{name}");
                self.included += 1;
                if self.depth + 1 < self.input.limits.nesting && self.included < INCLUDES {
                    self.depth += 1;
                    super::statements(&path, self);
                    self.depth -= 1;
                } else {
                    let message = || {
                        format!("`{path}` is included too deeply or too often, or includes itself")
                    };
                    let span = || crate::diagnostic::Span { place, ..Default::default() };
                    findings.error("included files", span, message);
                }
            }
            Statement::Use(_) => {}
            Statement::Ignored(what) => *self.ignored.entry(what).or_default() += 1,
        }
    }

    /// Adds an object, if its direction and its size are some.
    fn object(&mut self, shape: Shape, axis: DVec3, size: f64, texture: Texture, place: Place) {
        if axis.try_normalize().is_some() && size > 0.0 && size <= crate::limits::LARGEST {
            self.objects.push((shape, texture, self.clips.now(), place));
        } else {
            self.left_out += 1;
        }
    }

    /// The scene; `None` if there is nothing to draw, which is told.
    pub(super) fn finish(self, file: &Arc<str>, out: &mut Vec<Diagnostic>) -> Option<Scene> {
        if out.iter().any(Diagnostic::is_error) {
            return None;
        }
        let mut findings = Findings::default();
        let scene = self.scene(file, &mut findings);
        findings.tell(file, out);
        Some(scene)
    }

    fn scene(mut self, file: &Arc<str>, findings: &mut Findings) -> Scene {
        self.tell(file, findings);
        let mut warn =
            |plural, message: String| findings.warning(plural, || whole(file), || message);
        let mut scene = Scene::default();
        scene.image.background = self.background;
        match self.size {
            Some(size) => {
                let most = u64::from(Image::LARGEST);
                scene.image.size = size.map(|side| side.clamp(1, most) as u32);
                if size.iter().any(|side| !(1..=most).contains(side)) {
                    let [width, height] = size;
                    warn("sizes", format!("a picture of {width} × {height} pixels is none"));
                }
            }
            None => warn("sizes", "the file says no `RESOLUTION`; the default is used".to_owned()),
        }
        if let Some(frame) = &self.frame {
            let most = u64::from(Image::MOST_SAMPLES);
            scene.image.samples = frame.antialiasing.saturating_add(1).min(most) as u32;
            let bounces = frame.depth.saturating_sub(1).min(Image::DEEPEST.into());
            scene.image.depth = bounces as u32;
            let (camera, told) = frame.camera();
            scene.camera = camera;
            for message in told {
                warn("cameras", message);
            }
        } else {
            warn("cameras", "the file has no `CAMERA`; the default one is used".to_owned());
        }
        if let Some(gradient) = &self.gradient {
            let [top, bottom] = gradient.colors(&scene.camera);
            scene.image.background = Background::Gradient { top, bottom };
        }
        if let Some(haze) = &self.haze {
            let (fog, moved) = haze.fog(self.mode.planar);
            scene.fog = fog;
            if moved {
                let message = "fog begins at the eye, and not at `START`".to_owned();
                warn("fog", message);
            }
        }
        if self.mode.open.is_some() {
            let samples = self.mode.samples.clamp(1, 1024) as u32;
            // Its rays end at nothing.
            let distance = OcclusionDistance::Units(1e6);
            scene.ambient_occlusion = Some(AmbientOcclusion { samples, distance });
        }
        scene.lights = self.lights();
        if let Some(message) = self.shapes(&mut scene) {
            warn("clip groups", message);
        }
        if scene.objects.is_empty() && self.left_out > 0 {
            let message = || "there is nothing to draw: nothing of the file is left".to_owned();
            findings.error("empty scenes", || whole(file), message);
        }
        scene
    }

    /// Says what is not drawn.
    fn tell(&self, file: &Arc<str>, findings: &mut Findings) {
        let mut warn =
            |plural, message: String| findings.warning(plural, || whole(file), || message);
        for (what, count) in &self.ignored {
            let message = match *what {
                TWICE => format!("{what}: {count}; the first definition counts, as in Tachyon"),
                _ => format!("what is not drawn: {what}, {count} in number"),
            };
            warn("things that are not drawn", message);
        }
        let patterned = self.bulk.iter().filter(|bulk| bulk.texture.more).count()
            + self.objects.iter().filter(|(_, texture, ..)| texture.more).count();
        if patterned > 0 {
            let message = "textures have patterns or images (`TEXFUNC` 2 and above) or outlines; their constant \
                           colour is drawn alone";
            warn("patterns", message.to_owned());
        }
        let all = self.bulk.iter().map(|bulk| bulk.texture);
        let mut all = all.chain(self.objects.iter().map(|(_, texture, ..)| *texture));
        if !self.mode.mixed && all.any(|texture| texture.angle && texture.opacity < 1.0) {
            let message = "opacity by angle (`TRANSMODE R3D`) is the same at every angle where what \
                           is behind is added, and not mixed (`TRANS_VMD`)";
            warn("opacities", message.to_owned());
        }
        if self.left_out > 0 {
            let message = format!(
                "things without an extent, or of which a number is none: {}; they are left out",
                self.left_out
            );
            warn("things that are left out", message);
        }
    }

    fn lights(&self) -> Vec<Light> {
        let scale = self.mode.rescale.filter(|scale| *scale >= 0.0).unwrap_or(1.0);
        let light = |(i, (lamp, place)): (usize, &(Lamp, Place))| {
            let Lamp { position, direction, falloff, attenuation, color } = *lamp;
            let direction = direction.map(|d| d.normalize_or(DVec3::NEG_Z));
            let sum: f64 = attenuation.iter().sum();
            let sound = attenuation.iter().all(|share| *share >= 0.0) && sum > 0.0;
            let attenuation = if sound { attenuation } else { [1.0, 0.0, 0.0] };
            let kind = match (position, direction, falloff) {
                (Some(position), Some(direction), Some([start, end])) => {
                    let edge = end.clamp(1e-3, 90.0);
                    let cone = start.clamp(0.0, edge);
                    let target = position + direction;
                    LightKind::Spot { position, target, cone, edge, attenuation, radius: 0.0 }
                }
                (Some(position), ..) => LightKind::Point { position, attenuation, radius: 0.0 },
                (None, direction, _) => {
                    LightKind::Distant { direction: direction.unwrap_or(DVec3::NEG_Z), angle: 0.0 }
                }
            };
            let color = rgb(color) * scale;
            let (name, place) = (format!("light {}", i + 1), place.clone());
            Light {
                name,
                kind,
                color,
                specular_color: color,
                shadows: !self.mode.no_shadows,
                place,
                ..Light::default()
            }
        };
        self.lamps.iter().enumerate().map(light).collect()
    }

    /// Adds all shapes with their materials, and what cuts them; in words what of that is left out.
    fn shapes(&mut self, scene: &mut Scene) -> Option<String> {
        let open = self.mode.open.map_or(0.0, |color| {
            let Rgb { r, g, b } = rgb(color);
            (r + g + b) / 3.0
        });
        let drawing = Drawing { mixed: self.mode.mixed, open };
        let number = |scene: &mut Scene, texture: &Texture| -> MaterialId {
            let id = MaterialId(scene.materials.len() as u32);
            let name = format!("texture {}", id.0);
            scene.materials.push(texture.material(name, drawing, &mut scene.textures));
            id
        };
        let mut known = BTreeMap::new();
        let mut groups = Vec::new();
        for (shape, texture, clip, place) in self.objects.drain(..) {
            groups.push(clip);
            let id =
                *known.entry(texture.key_with_color()).or_insert_with(|| number(scene, &texture));
            scene.objects.push(Object { material: id, place, ..Object::from(shape) });
        }
        for bulk in self.bulk.drain(..) {
            let clip = bulk.clip;
            for (shape, texture) in bulk.shapes() {
                groups.push(clip);
                let id = number(scene, &texture);
                scene.objects.push(Object { material: id, ..Object::from(shape) });
            }
        }
        let mut counts: BTreeMap<&'static str, u32> = BTreeMap::new();
        for object in &mut scene.objects {
            let count = counts.entry(object.shape.kind()).or_default();
            *count += 1;
            object.name = format!("{} {count}", object.shape.kind());
        }
        let (clips, left_out) = std::mem::take(&mut self.clips).of(&scene.objects, &groups);
        scene.clips = clips;
        left_out
    }
}
