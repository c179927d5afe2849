//! An automatic camera and two lights, so that a bare model looks good without a word.

mod around;
mod flat;
mod follow;
mod guessed;

use std::collections::BTreeMap;

use glam::DVec3;

use crate::bounds::Bounds;
use crate::camera::{Camera, CameraKind};
use crate::color::Rgb;
use crate::diagnostic::{Diagnostic, Place, Span};
use crate::fragment::Fragment;
use crate::light::{Light, LightKind};
use crate::scene::{Background, Group, Object, Scene};
use crate::shape::Shape;
use crate::source::ending;
use crate::texture::Param;

/// Share of the picture that the model's box may fill, along the tighter direction.
const FILL: f64 = 0.9;

/// From where a bare model is looked at.
///
/// ```
/// use glam::DVec3;
/// use phong_scene::{Side, Framing};
/// // A map, north at the picture's upper edge.
/// let above = Framing { side: Side::Top, up: DVec3::Z, ..Framing::default() };
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Framing {
    /// Which side faces the camera. Default: [`Side::Iso`].
    pub side: Side,
    /// The direction of the model that points up, of any length but 0. Default: +Y. For any other
    /// the sides are turned with it by the shortest way: where Z is up, −Y is the front.
    pub up: DVec3,
    /// Position of the eye; `None`: where everything fits into the picture.
    pub eye: Option<DVec3>,
    /// The point in the middle of the picture; `None`: that which leaves the same margin on both
    /// sides, or, seen from an `eye` of one's own, the middle of the model's box.
    pub look_at: Option<DVec3>,
    /// Vertical field of view in degrees, in (0, 180); `None`: 40.
    pub fov: Option<f64>,
    /// Linear diffuse colour of what has no material and no colour of its own; `None`: a light clay.
    pub color: Option<Rgb>,
}

impl Default for Framing {
    fn default() -> Self {
        Self {
            side: Side::default(),
            up: DVec3::Y,
            eye: None,
            look_at: None,
            fov: None,
            color: None,
        }
    }
}

/// The side of a model that faces the camera.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Side {
    /// The side that +Z points to.
    Front,
    /// The side opposite to the front.
    Back,
    /// The side that −X points to.
    Left,
    /// The side that +X points to.
    Right,
    /// The side that up points to; the front is at the picture's lower edge.
    Top,
    /// The side opposite to the top; the front is at the picture's upper edge.
    Bottom,
    /// Along the diagonal between front, right and top.
    #[default]
    Iso,
}

/// A scene that shows a fragment by `framing`: background, camera and lights are automatic where
/// the fragment brings none.
///
/// Material 0 is of what has none; the model's own follow. Meshes without normals are smoothed
/// where faces meet under 60°.
pub(crate) fn frame(fragment: Fragment, framing: &Framing, place: &Place) -> Scene {
    let mut materials = fragment.materials;
    if let Some(plain) = materials.first_mut() {
        plain.k_a = Param::Constant(1.0);
        plain.place = place.clone();
    }
    let mut numbers = BTreeMap::new();
    let mut named = |mut object: Object| {
        let kind = object.shape.kind();
        let number = numbers.entry(kind).or_insert(0);
        *number += 1;
        object.name = format!("{kind} {number}");
        object.place = place.clone();
        if let Shape::Mesh(mesh) = &mut object.shape
            && mesh.normals.is_empty()
        {
            mesh.smooth(60.0);
        }
        object
    };
    let objects = fragment.objects.into_iter().map(&mut named).collect();
    let groups = fragment.groups.into_iter().map(|group| {
        let objects = group.objects.into_iter().map(&mut named).collect();
        Group { objects, ..group }
    });
    let mut scene = Scene {
        // Foreign materials often have a white ambient colour; a dim light suits them all.
        ambient: Rgb::grey(0.15),
        materials,
        textures: fragment.textures,
        groups: groups.collect(),
        objects,
        ..Scene::default()
    };
    // What is to be said of the view is said when it is chosen.
    let _ = scene.frame(framing);
    if let Some(camera) = fragment.camera {
        scene.camera = camera;
        scene.restore_guessed();
        scene.enlarge_guessed();
    }
    if !fragment.lights.is_empty() {
        scene.lights = fragment.lights;
    }
    scene
}

impl Scene {
    /// Looks at a bare model's scene by `framing`: replaces camera, lights, background and the
    /// colour of material 0. The picture's size counts: everything fits into it with a margin.
    ///
    /// The camera is a perspective one; two distant lights stand behind it, a key light over its
    /// left shoulder and a weaker one low on its right, which throws no shadows.
    ///
    /// Spheres whose radius was guessed are at least 1½ pixels in radius, lines ¾; a flat model that would
    /// be seen from its edge is turned. What there is to say about the view is returned: warnings.
    pub fn frame(&mut self, framing: &Framing) -> Vec<Diagnostic> {
        let mut said = Vec::new();
        self.restore_guessed();
        let (mut to_eye, up) = directions(framing.side, framing.up);
        let thinnest = flat::thinnest(self);
        if framing.eye.is_none()
            && let Some(turned) = flat::turned(to_eye, up, thinnest)
        {
            to_eye = turned;
            let message = "the model is flat, and would be seen from its edge: it is turned";
            said.push(self.word(message, "choose another side with `--view`"));
        }
        if framing.up == DVec3::Y && lies_on_xy(thinnest) && !self.has_no_other_up() {
            let message = "the model lies flat in X and Y: perhaps Z is up in it";
            said.push(self.word(message, "`--up z` shows it so"));
        }
        self.camera = self.fit(framing, to_eye, up);
        self.enlarge_guessed();
        self.lights = lights(&self.camera);
        self.image.background = Background::Gradient {
            top: Rgb::from_srgb8([0xd8, 0xdf, 0xe8]),
            bottom: Rgb::from_srgb8([0x8e, 0x99, 0xa6]),
        };
        if let Some(material) = self.materials.first_mut() {
            let color = framing.color.unwrap_or(Rgb::from_srgb8([0xd9, 0xcf, 0xc2]));
            material.color = color.into();
        }
        said
    }

    /// Lights it as a bare model is lit, from behind its own camera: replaces its lights.
    pub fn light(&mut self) {
        self.lights = lights(&self.camera);
    }

    /// A warning about the file that the model is from.
    fn word(&self, message: &str, help: &str) -> Diagnostic {
        let place = self.objects.first().map(|object| object.place.clone());
        let place = place.filter(|place| !place.file.is_empty());
        let span = place.map(|place| Span { place, ..Span::default() });
        Diagnostic::warning(message, span).with_help(help)
    }

    /// Whether up is known: Y is up in glTF, and molecules have no up.
    fn has_no_other_up(&self) -> bool {
        let is_molecule = |object: &Object| match &object.shape {
            Shape::Points(points) => points.guessed.is_none(),
            Shape::Cylinders(_) => true,
            _ => false,
        };
        self.is_of_gltf() || self.objects.iter().all(is_molecule)
    }

    /// Whether it is that of a glTF file, which may bring its own camera.
    fn is_of_gltf(&self) -> bool {
        let ending = self.objects.first().and_then(|object| ending(&object.place.file));
        ending.is_some_and(|ending| {
            ["gltf", "glb"].iter().any(|known| ending.eq_ignore_ascii_case(known))
        })
    }

    /// The camera that looks from a side and has everything in the picture, with a margin.
    ///
    /// The picture's edges are four planes through the eye. Each just touches the model if the
    /// eye lies as far along its normal as the model reaches: two edges left and right give the
    /// eye's place across and a distance, those above and below its height and another distance,
    /// and the larger counts.
    fn fit(&self, framing: &Framing, to_eye: DVec3, up: DVec3) -> Camera {
        let fov = framing.fov.unwrap_or(40.0);
        let [width, height] = self.image.size.map(|side| f64::from(side.max(1)));
        let right = up.cross(to_eye).normalize_or(DVec3::X);
        let image_up = to_eye.cross(right);
        let bounds = self.bounds();
        let bounds = if bounds.is_empty() { Bounds::EMPTY.with(DVec3::ZERO) } else { bounds };
        let center = bounds.center();

        // In the frame of right, up and to_eye around the middle of the model.
        let tan_y = libm::tan(0.5 * fov.to_radians()) * FILL;
        let tan_x = tan_y * width / height;
        let edges = [
            right + tan_x * to_eye,
            tan_x * to_eye - right,
            image_up + tan_y * to_eye,
            tan_y * to_eye - image_up,
        ];
        let reach = self.reach(edges);
        let [east, west, north, south] =
            std::array::from_fn(|i| (reach[i] - center.dot(edges[i])).max(0.0));
        let (x, y) = match framing.look_at {
            Some(target) => ((target - center).dot(right), (target - center).dot(image_up)),
            None => (0.5 * (east - west), 0.5 * (north - south)),
        };
        let across = ((east - x) / tan_x).max((west + x) / tan_x);
        let distance = across.max((north - y) / tan_y).max((south + y) / tan_y);
        // A single point: step back as far as it is from nothing. f64 must tell eye from target.
        let scale = center.abs().max_element();
        let least = if bounds.size() == DVec3::ZERO { scale.max(1.0) } else { scale * 1e-9 };
        let middle = center + x * right + y * image_up;
        let look_at =
            framing.look_at.unwrap_or(if framing.eye.is_some() { center } else { middle });
        let eye = framing.eye.unwrap_or(middle + to_eye * distance.max(least));
        let forward = look_at - eye;
        let along_up = forward.cross(up).length() <= 1e-6 * forward.length() * up.length();
        let up = if along_up { image_up } else { up };
        let kind = CameraKind::Perspective { fov };
        Camera { kind, eye, look_at, up, ..Camera::default() }
    }
}

/// Whether a model, as scans and terrains do, lies flat in X and Y without being wholly flat.
fn lies_on_xy(thinnest: Option<(DVec3, f64)>) -> bool {
    thinnest.is_some_and(|(normal, thickness)| {
        normal.z.abs() > 0.95 && (0.02..=0.25).contains(&thickness)
    })
}

/// The unit direction from the model to the eye, and the picture's up.
fn directions(side: Side, up: DVec3) -> (DVec3, DVec3) {
    // In a frame where Y is up and Z is the front.
    let (to_eye, image_up) = match side {
        Side::Front => (DVec3::Z, DVec3::Y),
        Side::Back => (DVec3::NEG_Z, DVec3::Y),
        Side::Left => (DVec3::NEG_X, DVec3::Y),
        Side::Right => (DVec3::X, DVec3::Y),
        Side::Top => (DVec3::Y, DVec3::NEG_Z),
        Side::Bottom => (DVec3::NEG_Y, DVec3::Z),
        Side::Iso => (DVec3::ONE.normalize_or(DVec3::Z), DVec3::Y),
    };
    let up = up.normalize_or(DVec3::Y);
    // The shortest turn from Y to up (Rodrigues); half a turn goes about X.
    let (axis, cosine) = (DVec3::Y.cross(up), up.y);
    let turn = |v: DVec3| {
        if cosine < -1.0 + 1e-12 {
            DVec3::new(v.x, -v.y, -v.z)
        } else {
            cosine * v + axis.cross(v) + axis * (axis.dot(v) / (1.0 + cosine))
        }
    };
    (turn(to_eye), turn(image_up))
}

/// A key light over the camera's left shoulder, and a weaker one low on its right.
fn lights(camera: &Camera) -> Vec<Light> {
    let forward = (camera.look_at - camera.eye).normalize_or(DVec3::NEG_Z);
    let right = forward.cross(camera.up).normalize_or(DVec3::X);
    let up = right.cross(forward);
    let light = |name: &str, direction: DVec3, color: f32, shadows: bool| Light {
        name: name.to_owned(),
        kind: LightKind::Distant { direction, angle: 0.0 },
        color: Rgb::grey(color),
        specular_color: Rgb::grey(color),
        shadows,
        ..Light::default()
    };
    vec![
        light("key light", forward + 0.6 * right - 0.8 * up, 1.0, true),
        light("fill light", forward - 0.9 * right - 0.1 * up, 0.3, false),
    ]
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::material::Material;
    use crate::mesh::Mesh;

    const SIDES: [Side; 7] =
        [Side::Front, Side::Back, Side::Left, Side::Right, Side::Top, Side::Bottom, Side::Iso];

    /// Where a point is in the picture: −1 to 1 across and up if it is within.
    fn project(camera: &Camera, aspect: f64, p: DVec3) -> (f64, f64) {
        let CameraKind::Perspective { fov } = camera.kind else { panic!("{camera:?}") };
        let forward = (camera.look_at - camera.eye).normalize_or(DVec3::ZERO);
        let right = forward.cross(camera.up).normalize_or(DVec3::ZERO);
        let d = p - camera.eye;
        let half = d.dot(forward) * libm::tan(0.5 * fov.to_radians());
        (d.dot(right) / (half * aspect), d.dot(right.cross(forward)) / half)
    }

    /// A scene of one box.
    fn boxed(min: DVec3, max: DVec3) -> Scene {
        let mut scene = frame(Fragment::default(), &Framing::default(), &Place::default());
        scene.objects = vec![Object::from(Shape::Box { min, max })];
        scene
    }

    #[test]
    fn everything_fits_with_a_margin_and_touches_it_on_opposite_sides() {
        let boxes = [
            (DVec3::ZERO, DVec3::ONE),
            (DVec3::splat(-1e9), DVec3::new(1e9, -0.9e9, 1e3)),
            (DVec3::splat(1e-9), DVec3::new(2e-9, 1.5e-9, 9e-9)),
            (DVec3::new(-5.0, 2.0, -5.0), DVec3::new(5.0, 2.0, 5.0)),
            (DVec3::new(5e6, 0.0, 5e6), DVec3::new(5e6 + 1.0, 1.0, 5e6 + 1.0)),
        ];
        for (min, max) in boxes {
            for side in SIDES {
                for up in [DVec3::Y, DVec3::Z, DVec3::NEG_Y, DVec3::new(1.0, 2.0, -3.0)] {
                    for size in [[100, 400], [100, 100], [1600, 900]] {
                        let mut scene = boxed(min, max);
                        scene.image.size = size;
                        let _ = scene.frame(&Framing { side, up, ..Framing::default() });
                        let aspect = f64::from(size[0]) / f64::from(size[1]);
                        let corners = Bounds { min, max }.corners();
                        let seen = corners.map(|c| project(&scene.camera, aspect, c));
                        let most = |f: fn((f64, f64)) -> f64| {
                            seen.map(f).into_iter().fold(f64::NEG_INFINITY, f64::max)
                        };
                        let [east, west, north, south] =
                            [most(|p| p.0), most(|p| -p.0), most(|p| p.1), most(|p| -p.1)];
                        let told = format!("{side:?} {up} {size:?} {:?}", scene.camera);
                        let (x, y) = (east.max(west), north.max(south));
                        assert!((x.max(y) - FILL).abs() < 1e-4, "{told}");
                        assert!(
                            (if x > y { east - west } else { north - south }).abs() < 1e-4,
                            "{told}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn a_sphere_is_framed_by_its_outline_and_not_by_its_box() {
        let mut scene = boxed(DVec3::ZERO, DVec3::ONE);
        scene.objects[0].shape = Shape::Sphere { center: DVec3::ZERO, radius: 1.0 };
        scene.image.size = [1, 1];
        let _ = scene.frame(&Framing { fov: Some(60.0), ..Framing::default() });
        // Tangents from the eye leave at the angle whose sine is radius over distance.
        let half = libm::atan(libm::tan(30_f64.to_radians()) * FILL);
        assert!((scene.camera.eye.length() - 1.0 / libm::sin(half)).abs() < 1e-12);
        assert!(scene.camera.look_at.length() < 1e-12);
    }

    #[test]
    fn a_single_point_and_nothing_at_all_have_a_camera_that_looks_at_them() {
        let point = DVec3::new(1e7, 0.0, -3.0);
        let mut nothing = boxed(point, point);
        nothing.objects.clear();
        for mut scene in [nothing, boxed(point, point)] {
            let _ = scene.frame(&Framing::default());
            let Camera { eye, look_at, .. } = scene.camera;
            assert!(eye.is_finite() && eye.distance(look_at) > 1e-3, "{eye} {look_at}");
        }
    }

    #[test]
    fn what_one_chooses_to_look_at_is_in_the_middle_and_everything_still_fits() {
        let mut scene = boxed(DVec3::ZERO, DVec3::ONE);
        let _ = scene.frame(&Framing { look_at: Some(DVec3::ZERO), ..Framing::default() });
        assert_eq!(scene.camera.look_at, DVec3::ZERO);
        for corner in (Bounds { min: DVec3::ZERO, max: DVec3::ONE }).corners() {
            let (x, y) = project(&scene.camera, 16.0 / 9.0, corner);
            assert!(x.abs().max(y.abs()) <= FILL + 1e-9, "{corner}");
        }
    }

    #[test]
    fn the_front_is_what_z_points_to_or_minus_y_where_z_is_up() {
        assert_eq!(directions(Side::Front, DVec3::Y), (DVec3::Z, DVec3::Y));
        assert_eq!(directions(Side::Front, DVec3::Z), (DVec3::NEG_Y, DVec3::Z));
        assert_eq!(directions(Side::Right, 2.0 * DVec3::Z), (DVec3::X, DVec3::Z));
        assert_eq!(directions(Side::Top, DVec3::Z), (DVec3::Z, DVec3::Y));
        assert_eq!(directions(Side::Front, DVec3::NEG_Y), (DVec3::NEG_Z, DVec3::NEG_Y));
    }

    #[test]
    fn an_eye_of_ones_own_wins_and_looking_along_up_still_has_an_up() {
        let framing = Framing { eye: Some(DVec3::new(0.5, 9.0, 0.5)), ..Framing::default() };
        let camera = {
            let mut scene = boxed(DVec3::ZERO, DVec3::ONE);
            let _ = scene.frame(&framing);
            scene.camera
        };
        assert_eq!(camera.eye.y, 9.0);
        assert!((camera.look_at - camera.eye).cross(camera.up).length() > 0.1);
    }

    #[test]
    fn a_bare_mesh_becomes_a_smooth_object_with_its_materials_behind_the_default() {
        let mesh = Mesh {
            positions: [Vec3::ZERO, Vec3::X, Vec3::Y].into(),
            indices: [[0, 1, 2]].into(),
            face_materials: [1].into(),
            ..Mesh::default()
        };
        let red = Material { name: "red".to_owned(), ..Material::default() };
        let fragment = Fragment::of(mesh, vec![red]);
        let place = Place::default();
        let scene =
            frame(fragment, &Framing { color: Some(Rgb::BLACK), ..Framing::default() }, &place);
        assert_eq!(
            (scene.materials[0].color, scene.materials[1].name.as_str()),
            (Rgb::BLACK.into(), "red")
        );
        assert_eq!((scene.objects[0].name.as_str(), scene.lights.len()), ("mesh 1", 2));
        let Shape::Mesh(mesh) = &scene.objects[0].shape else { panic!("{:?}", scene.objects) };
        assert_eq!((mesh.face_materials[0], mesh.normals.len()), (1, 3));
    }
}
