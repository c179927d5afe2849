//! What the statements make, put together.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DVec3, Vec3};

use crate::camera::{Camera, CameraKind};
use crate::color::Rgb;
use crate::diagnostic::{Place, Span};
use crate::format::faces::Faces;
use crate::format::text::{Findings, whole};
use crate::format::triangles::{cut, has_room, tell_small, tidy};
use crate::frame::Framing;
use crate::light::{Light, LightKind};
use crate::limits::{LARGEST, Limits};
use crate::material::{ConstantMaterial, Material, MaterialId, Model};
use crate::mesh::{Mesh, NO_INDEX, Points};
use crate::scene::{Background, Image, Object, Scene};
use crate::shape::Shape;

/// What has been read so far.
#[derive(Debug, Default)]
pub(super) struct Assembly {
    pub(super) view: View,
    /// Whether the file has a view at all.
    pub(super) viewed: bool,
    pub(super) background: Rgb,
    /// Where they are, and their own colours if they have some.
    pub(super) lamps: Vec<(DVec3, Option<Rgb>, Place)>,
    looks: Vec<(Look, Place)>,
    /// What is of each of them; the first is of none.
    parts: Vec<Part>,
    left_out: u64,
    /// How many statements have names that the format does not have, and where the first is.
    pub(super) unknown: Option<(u64, Place)>,
    /// How many looks name an image.
    pub(super) images: u64,
}

/// Where the picture is taken from.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    pub(super) from: DVec3,
    pub(super) at: DVec3,
    pub(super) up: DVec3,
    /// Degrees.
    pub(super) angle: f64,
    pub(super) size: Option<[u64; 2]>,
}

impl Default for View {
    fn default() -> Self {
        let from = DVec3::new(0.0, 0.0, 5.0);
        Self { from, at: DVec3::ZERO, up: DVec3::Y, angle: 40.0, size: None }
    }
}

/// What an `f` says.
#[derive(Clone, Copy, Debug)]
pub(super) struct Look {
    pub(super) base: Rgb,
    pub(super) diffuse: f32,
    pub(super) specular: f32,
    pub(super) shine: f32,
    pub(super) through: f32,
    pub(super) ior: f32,
}

impl Look {
    fn material(&self, name: String, place: Place) -> Material {
        let sound = |number: f32| if number > 0.0 { number.min(1e6) } else { 0.0 };
        let through = sound(self.through).min(1.0);
        let ior = if self.ior > 0.0 && self.ior <= 100.0 { self.ior } else { 1.0 };
        Material::from(ConstantMaterial {
            name,
            model: Model::Phong,
            color: self.base,
            k_a: 0.0,
            k_d: sound(self.diffuse),
            k_s: sound(self.specular),
            shininess: sound(self.shine),
            reflection: Rgb::grey(sound(self.specular)),
            transmission: Rgb::grey(through),
            ior,
            fresnel: false,
            place,
            ..ConstantMaterial::default()
        })
    }
}

/// Things of one material.
#[derive(Debug, Default)]
struct Part {
    spheres: Vec<[f32; 4]>,
    cones: Vec<([[f32; 4]; 2], Place)>,
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    /// Where the corners of every face begin, and whether they have normals.
    faces: Faces,
    normal_faces: Faces,
}

fn held(numbers: &[f32]) -> bool {
    numbers.iter().all(|n| n.abs() <= LARGEST as f32)
}

impl Assembly {
    /// What follows is of this look.
    pub(super) fn look(&mut self, look: Look, place: Place) {
        if self.parts.is_empty() {
            self.parts.push(Part::default());
        }
        self.looks.push((look, place));
        self.parts.push(Part::default());
    }

    fn part(&mut self) -> &mut Part {
        if self.parts.is_empty() {
            self.parts.push(Part::default());
        }
        let last = self.parts.len() - 1;
        &mut self.parts[last]
    }

    pub(super) fn sphere(&mut self, [x, y, z, radius]: [f32; 4]) {
        // A negative radius says that its inside is seen, which two-sided surfaces need not know.
        let sphere = [x, y, z, radius.abs()];
        if held(&sphere) && radius != 0.0 {
            self.part().spheres.push(sphere);
        } else {
            self.left_out += 1;
        }
    }

    pub(super) fn cone(&mut self, ends: [[f32; 4]; 2], place: Place) {
        let ends = ends.map(|[x, y, z, radius]| [x, y, z, radius.abs()]);
        let [[ax, ay, az, a], [bx, by, bz, b]] = ends;
        if held(ends.as_flattened()) && a.max(b) > 0.0 && [ax, ay, az] != [bx, by, bz] {
            self.part().cones.push((ends, place));
        } else {
            self.left_out += 1;
        }
    }

    pub(super) fn polygon(&mut self, corners: &[Vec3], normals: &[Vec3]) {
        if !corners.iter().all(|corner| held(&corner.to_array())) {
            self.left_out += 1;
            return;
        }
        let part = self.part();
        let first = part.positions.len() as u32;
        let numbers: Vec<u32> = (first..first.saturating_add(corners.len() as u32)).collect();
        part.positions.extend_from_slice(corners);
        part.faces.push(&numbers);
        let normal = part.normals.len() as u32;
        let sound = |n: &Vec3| if held(&n.to_array()) { *n } else { Vec3::ZERO };
        part.normals.extend(normals.iter().map(sound));
        let own = |i: usize| if normals.is_empty() { NO_INDEX } else { normal + i as u32 };
        let numbers: Vec<u32> = (0..corners.len()).map(own).collect();
        part.normal_faces.push(&numbers);
    }

    /// Says how many statements the format does not have; that there are no others is an error.
    pub(super) fn tell_unknown(&self, findings: &mut Findings) {
        let Some((count, place)) = &self.unknown else { return };
        let span = || Span { place: place.clone(), ..Span::default() };
        if self.parts.is_empty() && self.lamps.is_empty() && !self.viewed {
            let message = || "the file is no NFF: it has none of its statements".to_owned();
            findings.error("other files", span, message);
            return;
        }
        let message =
            || format!("lines that begin with a word which NFF does not have: {count}; not used");
        findings.warning("statements that NFF does not have", span, message);
    }

    /// Whether it says nothing of a view and of light.
    pub(super) fn is_bare(&self) -> bool {
        !self.viewed && self.lamps.is_empty()
    }

    /// Whether memory suffices for what was read.
    pub(super) fn has_room(
        &self,
        limits: &Limits,
        file: &Arc<str>,
        findings: &mut Findings,
    ) -> bool {
        let triangles = self.parts.iter().map(|part| part.faces.indices.len() as u64).sum();
        let vertices = self.parts.iter().map(|part| part.positions.len() as u64).sum::<u64>();
        let others = |part: &Part| (16 * part.spheres.len() + 256 * part.cones.len()) as u64;
        let others: u64 = self.parts.iter().map(others).sum();
        let bytes = 24 * vertices + 24 * triangles + others;
        has_room(triangles, vertices, bytes, limits, file, findings)
    }

    /// The scene.
    pub(super) fn finish(self, file: &Arc<str>, findings: &mut Findings) -> Scene {
        let mut scene = Scene::default();
        let mut warn =
            |plural, message: String| findings.warning(plural, || whole(file), || message);
        if self.left_out > 0 {
            let message = format!(
                "things without an extent, or of which a number is none: {}; they are left out",
                self.left_out
            );
            warn("things that are left out", message);
        }
        if self.images > 0 {
            let message =
                format!("fills with an image behind them, which is not drawn: {}", self.images);
            warn("images", message);
        }
        let (viewed, lit) = (self.viewed, !self.lamps.is_empty());
        if viewed && !lit {
            warn("lights", "the file has no light (`l`); it is lit as a bare model is".to_owned());
        }
        if !viewed && lit {
            warn("views", "the file has no view (`v`); the camera is automatic".to_owned());
        }
        scene.image.background = Background::Color(self.background);
        let View { from, at, up, angle, size } = self.view;
        if let Some(size) = size {
            scene.image.size = size.map(|side| side.clamp(1, Image::LARGEST.into()) as u32);
        }
        let fov = if angle > 0.0 && angle < 180.0 { angle } else { 40.0 };
        let at = if at == from { from + DVec3::NEG_Z } else { at };
        let kind = CameraKind::Perspective { fov };
        scene.camera = Camera { kind, eye: from, look_at: at, up, ..Camera::default() };
        scene.lights = lights(self.lamps);
        for (i, (look, place)) in self.looks.into_iter().enumerate() {
            scene.materials.push(look.material(format!("fill {}", i + 1), place));
        }
        for (number, part) in self.parts.into_iter().enumerate() {
            part.shapes(MaterialId(number as u32), file, findings, &mut scene.objects);
        }
        let mut counts: BTreeMap<&'static str, u32> = BTreeMap::new();
        for object in &mut scene.objects {
            let count = counts.entry(object.shape.kind()).or_default();
            *count += 1;
            object.name = format!("{} {count}", object.shape.kind());
        }
        if scene.objects.is_empty() && (self.left_out > 0 || self.unknown.is_some()) {
            let message = || "there is nothing to draw: nothing of the file is left".to_owned();
            findings.error("empty scenes", || whole(file), message);
        }
        if viewed && !lit {
            scene.light();
        } else if !viewed {
            let lights = std::mem::take(&mut scene.lights);
            scene.frame(&Framing::default());
            if lit {
                scene.lights = lights;
            }
        }
        scene
    }
}

fn lights(lamps: Vec<(DVec3, Option<Rgb>, Place)>) -> Vec<Light> {
    let count = lamps.len() as f32;
    let each = Rgb::grey(count.sqrt() / count);
    let light = |(i, (position, own, place)): (usize, (DVec3, Option<Rgb>, Place))| {
        let color = own.unwrap_or(each);
        let kind = LightKind::Point { position, attenuation: [1.0, 0.0, 0.0], radius: 0.0 };
        let name = format!("light {}", i + 1);
        Light { name, kind, color, specular_color: color, place, ..Light::default() }
    };
    lamps.into_iter().enumerate().map(light).collect()
}

impl Part {
    fn shapes(
        self,
        material: MaterialId,
        file: &Arc<str>,
        findings: &mut Findings,
        objects: &mut Vec<Object>,
    ) {
        let Self { spheres, cones, positions, normals, faces, normal_faces } = self;
        let mut add = |shape: Shape, place| {
            objects.push(Object { material, place, ..Object::from(shape) });
        };
        if !spheres.is_empty() {
            let points = Points { spheres: spheres.into(), ..Points::default() };
            add(points.into(), Place::default());
        }
        for ([[ax, ay, az, radius], [bx, by, bz, radius_to]], place) in cones {
            let [from, to] = [[ax, ay, az], [bx, by, bz]].map(|p| Vec3::from(p).as_dvec3());
            let [radius, radius_to] = [radius, radius_to].map(f64::from);
            let shape = if radius == radius_to {
                Shape::Cylinder { from, to, radius, capped: false }
            } else {
                Shape::Cone { from, to, radius, radius_to, capped: false }
            };
            add(shape, place);
        }
        let Faces { indices, polygons, dropped } = faces;
        tell_small(dropped, findings, file);
        if indices.is_empty() {
            return;
        }
        // A normal that no corner uses says that a mesh without any is flat.
        let normals = if normals.is_empty() { vec![Vec3::Z] } else { normals };
        let mut mesh = Mesh {
            positions: positions.into(),
            indices: indices.into(),
            normals: normals.into(),
            normal_indices: normal_faces.indices.into(),
            ..Mesh::default()
        };
        cut(&mut mesh, &polygons, findings, file);
        tidy(&mut mesh, 0, findings, file);
        if !mesh.indices.is_empty() {
            add(mesh.into(), Place::default());
        }
    }
}
