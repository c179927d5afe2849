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
#[derive(Clone, Debug, Default, PartialEq)]
pub struct View {
    /// Which side faces the camera. Default: [`Side::Iso`].
    pub side: Side,
    /// Which axis of the model points up. Default: Y.
    pub up: Up,
    /// Position of the eye; `None`: where everything fits into the picture.
    pub eye: Option<DVec3>,
    /// The point in the middle of the picture; `None`: the middle of the model's box.
    pub look_at: Option<DVec3>,
    /// Vertical field of view in degrees, in (0, 180); `None`: 40.
    pub fov: Option<f64>,
    /// Linear diffuse colour of what has no material and no colour of its own; `None`: a light clay.
    pub color: Option<Rgb>,
}

/// The side of a model that faces the camera.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Side {
    /// The side that +Z points to (−Y where Z is up).
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

/// The axis of a model that points up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Up {
    /// +Y.
    #[default]
    Y,
    /// +Z, as in geography and CAD.
    Z,
}

/// A scene that shows `model` from `view`: camera, lights and background are automatic.
///
/// Material 0 is of what has none; the model's own follow. Meshes without normals are smoothed
/// where faces meet under 60°.
pub(crate) fn frame(model: Model, view: &View, place: &Place) -> Scene {
    let mut materials = vec![Material { place: place.clone(), ..Material::default() }];
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
        ambient: Rgb::WHITE,
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
fn directions(side: Side, up: Up) -> (DVec3, DVec3) {
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
    let place = |v: DVec3| match up {
        Up::Y => v,
        Up::Z => DVec3::new(v.x, -v.z, v.y),
    };
    (place(to_eye), place(image_up))
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
