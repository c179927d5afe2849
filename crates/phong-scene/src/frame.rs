//! An automatic camera and two lights, so that a bare model looks good without a word.

use glam::{DAffine3, DVec3};

use crate::format::model::{Model, Part};
use crate::{
    Background, Bounds, Camera, CameraKind, Image, Light, LightKind, Material, MaterialId, Object,
    Place, Rgb, Scene, Shape,
};

/// Share of the picture that the model's box may fill, along the tighter direction.
const FILL: f64 = 0.9;

/// From where a bare model is looked at.
///
/// ```
/// use glam::DVec3;
/// use phong_scene::{Side, View};
/// // A map, north at the picture's upper edge.
/// let above = View { side: Side::Top, up: DVec3::Z, ..View::default() };
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct View {
    /// Which side faces the camera. Default: [`Side::Iso`].
    pub side: Side,
    /// The direction of the model that points up, of any length but 0. Default: +Y. For any other
    /// the sides are turned with it by the shortest way: where Z is up, −Y is the front.
    pub up: DVec3,
    /// Position of the eye; `None`: where everything fits into the picture.
    pub eye: Option<DVec3>,
    /// The point in the middle of the picture; `None`: the middle of the model's box.
    pub look_at: Option<DVec3>,
    /// Vertical field of view in degrees, in (0, 180); `None`: 40.
    pub fov: Option<f64>,
    /// Linear diffuse colour of what has no material and no colour of its own; `None`: a light clay.
    pub color: Option<Rgb>,
}

impl Default for View {
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

/// A scene that shows `model` from `view`: camera, lights and background are automatic.
///
/// Material 0 is of what has none; the model's own follow. Meshes without normals are smoothed
/// where faces meet under 60°.
pub(crate) fn frame(model: Model, view: &View, place: &Place) -> Scene {
    // Materials of foreign files often have a white ambient colour; a dim light suits them all.
    let ambient = Rgb::grey(0.15);
    let mut materials = vec![Material { k_a: 1.0, place: place.clone(), ..Material::default() }];
    materials.extend(model.materials);
    let (mut meshes, mut clouds) = (0, 0);
    let objects = model
        .parts
        .into_iter()
        .map(|part| {
            let (name, shape) = match part {
                Part::Mesh { mut mesh, .. } => {
                    meshes += 1;
                    mesh.face_materials.iter_mut().for_each(|m| *m += 1);
                    if mesh.normals.is_empty() {
                        mesh.smooth(60.0);
                    }
                    (format!("mesh {meshes}"), Shape::Mesh(Box::new(mesh)))
                }
                Part::Points { points, .. } => {
                    clouds += 1;
                    (format!("points {clouds}"), Shape::Points(Box::new(points)))
                }
            };
            let (material, transform) = (MaterialId(0), DAffine3::IDENTITY);
            Object { name, shape, material, transform, place: place.clone() }
        })
        .collect();
    let mut scene = Scene {
        image: Image::default(),
        camera: Camera {
            kind: CameraKind::Perspective { fov: 40.0 },
            eye: DVec3::Z,
            look_at: DVec3::ZERO,
            up: DVec3::Y,
            aperture: 0.0,
            focus: None,
        },
        ambient,
        lights: Vec::new(),
        materials,
        objects,
        groups: Vec::new(),
    };
    scene.frame(view);
    scene
}

impl Scene {
    /// Looks at a bare model's scene from `view`: replaces camera, lights, background and the
    /// colour of material 0. The picture's size counts: everything fits into it with a margin.
    ///
    /// The camera is a perspective one; two distant lights stand behind it, a key light over its
    /// left shoulder and a weaker one low on its right, which throws no shadows.
    pub fn frame(&mut self, view: &View) {
        let bounds = self.bounds();
        let aspect = f64::from(self.image.size[0].max(1)) / f64::from(self.image.size[1].max(1));
        self.camera = camera(bounds, view, aspect);
        self.lights = lights(&self.camera);
        self.image.background = Background::Gradient {
            top: Rgb::from_srgb8([0xd8, 0xdf, 0xe8]),
            bottom: Rgb::from_srgb8([0x8e, 0x99, 0xa6]),
        };
        if let Some(material) = self.materials.first_mut() {
            material.color = view.color.unwrap_or(Rgb::from_srgb8([0xd9, 0xcf, 0xc2]));
        }
    }
}

/// The camera of `view` for a box and a picture `aspect` times as wide as high.
fn camera(bounds: Bounds, view: &View, aspect: f64) -> Camera {
    let fov = view.fov.unwrap_or(40.0);
    let bounds = if bounds.is_empty() { Bounds::EMPTY.with(DVec3::ZERO) } else { bounds };
    let look_at = view.look_at.unwrap_or(bounds.center());
    let (to_eye, up) = directions(view.side, view.up);
    let forward = -to_eye;
    let right = forward.cross(up).normalize_or(DVec3::X);
    let image_up = right.cross(forward);
    let tan_up = libm::tan(0.5 * fov.to_radians()) * FILL;
    let tan_right = tan_up * aspect;
    // A corner that lies z nearer to the eye than the middle needs the eye at |x| / tan + z.
    let distance = bounds.corners().into_iter().fold(0.0_f64, |distance, corner| {
        let c = corner - look_at;
        let sideways = (c.dot(right).abs() / tan_right).max(c.dot(image_up).abs() / tan_up);
        distance.max(sideways + c.dot(to_eye))
    });
    // A single point, or a flat thing seen edge-on: step back as far as it is from nothing.
    let scale = look_at.abs().max_element();
    let least = if bounds.size() == DVec3::ZERO { scale.max(1.0) } else { scale * 1e-9 };
    let eye = view.eye.unwrap_or(look_at + to_eye * distance.max(least));
    let up = if (look_at - eye).cross(up).length_squared() > 0.0 { up } else { image_up };
    Camera { kind: CameraKind::Perspective { fov }, eye, look_at, up, aperture: 0.0, focus: None }
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
        place: Place::default(),
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
    use crate::Mesh;

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

    #[test]
    fn everything_fits_with_a_margin_and_fills_the_picture_from_every_side() {
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
                    for aspect in [0.25, 1.0, 16.0 / 9.0] {
                        let bounds = Bounds { min, max };
                        let camera = camera(bounds, &View { side, up, ..View::default() }, aspect);
                        let reach = bounds.corners().map(|c| {
                            let (x, y) = project(&camera, aspect, c);
                            x.abs().max(y.abs())
                        });
                        let most = reach.into_iter().fold(0.0, f64::max);
                        let told = format!("{side:?} {up} {aspect} {bounds:?}: {most}");
                        assert!((most - FILL).abs() < 1e-4, "{told}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_single_point_and_nothing_at_all_have_a_camera_that_looks_at_them() {
        for bounds in [Bounds::EMPTY, Bounds::EMPTY.with(DVec3::new(1e7, 0.0, -3.0))] {
            let camera = camera(bounds, &View::default(), 1.5);
            assert!(camera.eye.is_finite() && camera.eye != camera.look_at, "{camera:?}");
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
        let view = View { eye: Some(DVec3::new(0.5, 9.0, 0.5)), ..View::default() };
        let camera = camera(Bounds { min: DVec3::ZERO, max: DVec3::ONE }, &view, 1.0);
        assert_eq!(camera.eye.y, 9.0);
        assert!((camera.look_at - camera.eye).cross(camera.up).length() > 0.1);
    }

    #[test]
    fn a_bare_mesh_becomes_a_smooth_object_with_its_materials_behind_the_default() {
        let mesh = Mesh {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
            indices: vec![[0, 1, 2]],
            face_materials: vec![0],
            ..Mesh::default()
        };
        let red = Material { name: "red".to_owned(), ..Material::default() };
        let model =
            Model { parts: vec![Part::Mesh { name: String::new(), mesh }], materials: vec![red] };
        let place = Place::default();
        let scene = frame(model, &View { color: Some(Rgb::BLACK), ..View::default() }, &place);
        assert_eq!(
            (scene.materials[0].color, scene.materials[1].name.as_str()),
            (Rgb::BLACK, "red")
        );
        assert_eq!((scene.objects[0].name.as_str(), scene.lights.len()), ("mesh 1", 2));
        let Shape::Mesh(mesh) = &scene.objects[0].shape else { panic!("{:?}", scene.objects) };
        assert_eq!((mesh.face_materials[0], mesh.normals.len()), (1, 3));
    }
}
