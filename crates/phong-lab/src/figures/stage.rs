//! Small scenes, rendered: a ball under lights, and what can be read off its picture.

use glam::{DAffine3, DVec3, Vec3};
use phong::aov::Aov;
use phong::film::{Film, LayerKind};
use phong::render::{Cancel, RenderOptions, render};
use phong::terms::{Term, TermSet, Terms};
use phong::view::View;
use phong_scene::{
    Background, Camera, CameraKind, ConstantMaterial, Image, Light, LightKind, MaterialId, Object,
    Place, Rgb, Scene, Shape, srgb_encode,
};

use super::drawing::Drawing;
use super::mark::{Bitmap, Point};
use super::symbols::lamp;
use super::{Finish, Setting, raster, style};

/// Edge of the square pictures that numbers are measured on, pixels.
const MEASURED: u32 = 160;
/// Height of what a ball's camera sees, in radii: the ball with a little air.
pub(super) const VIEW: f64 = 2.08;

/// The layers of the terms that a ball under lights has.
pub(super) const AMBIENT: LayerKind = LayerKind::Term(Term::Ambient);
pub(super) const DIFFUSE: LayerKind = LayerKind::Term(Term::Diffuse);
pub(super) const SPECULAR: LayerKind = LayerKind::Term(Term::Specular);

/// The plastic of the balls: blue, unless the setting says otherwise.
pub(super) fn plastic(setting: Setting) -> ConstantMaterial {
    ConstantMaterial {
        color: setting.color.unwrap_or(Rgb::from_srgb8([0x3d, 0x84, 0xd6])),
        k_a: 0.2,
        k_d: 0.8,
        k_s: 0.6,
        shininess: setting.alpha_or(24.0) as f32,
        ..ConstantMaterial::default()
    }
}

/// The channel in which the plastic is brightest, and what it is called.
#[derive(Clone, Copy, Debug)]
pub(super) struct Channel(usize);

impl Channel {
    pub(super) fn of(setting: Setting) -> Self {
        let color = plastic(setting).color.to_array();
        let brightest = (0..3).rev().max_by(|&a, &b| color[a].total_cmp(&color[b]));
        Self(brightest.unwrap_or(2))
    }

    pub(super) fn name(self) -> &'static str {
        ["red", "green", "blue"][self.0]
    }

    pub(super) fn value(self, color: Rgb) -> f64 {
        f64::from(color.to_array()[self.0])
    }
}

/// A light so far away that its direction, `to_light`, is the same everywhere.
pub(super) fn distant(to_light: DVec3, color: f32) -> Light {
    Light {
        name: "light".to_owned(),
        kind: LightKind::Distant { direction: -to_light, angle: 0.0 },
        color: Rgb::grey(color),
        specular_color: Rgb::grey(color),
        ..Light::default()
    }
}

/// The unit ball at the origin, looked at from far away in the direction `eye`.
pub(super) fn ball(material: ConstantMaterial, lights: Vec<Light>, eye: DVec3) -> Scene {
    let sphere = Shape::Sphere { center: DVec3::ZERO, radius: 1.0 };
    Scene {
        image: Image {
            size: [MEASURED; 2],
            samples: 1,
            background: Background::Transparent,
            ..Image::default()
        },
        camera: Camera {
            kind: CameraKind::Orthographic { height: VIEW },
            eye: 10.0 * eye,
            look_at: DVec3::ZERO,
            up: DVec3::Y,
            aperture: 0.0,
            focus: None,
            shift: glam::DVec2::ZERO,
        },
        lights,
        materials: vec![material.into()],
        objects: vec![object(sphere, 0)],
        ..Scene::default()
    }
}

/// A shape where it stands, of material number `material`.
pub(super) fn object(shape: Shape, material: u32) -> Object {
    Object {
        name: "object".to_owned(),
        shape,
        material: MaterialId(material),
        transform: DAffine3::IDENTITY,
        place: Place::default(),
    }
}

/// The scene as the figure shows it, `size` units large.
pub(super) fn shown(scene: &Scene, size: Point, setting: Setting) -> Film {
    let (scale, samples) = match setting.finish {
        Finish::Draft => (1.0, 1),
        Finish::Slide => (raster::SCALE, 16),
    };
    let pixels = (scale * size).to_array().map(|side| side.round() as u32);
    let image = Image { size: pixels, samples, ..scene.image.clone() };
    film(&Scene { image, ..scene.clone() }, &[])
}

/// The scene as its numbers are measured: one sample a pixel, at its centre.
pub(super) fn measured(scene: &Scene) -> Film {
    film(scene, &[Aov::Normal, Aov::Position])
}

fn film(scene: &Scene, aovs: &[Aov]) -> Film {
    let options = RenderOptions::of(&scene.image)
        .expect("a figure's picture has a size")
        .with_terms(TermSet::of_scene(scene))
        .with_aovs(aovs);
    let scene = View::of(scene).expect("a scene of a few shapes compiles");
    render(&scene, &options, &|_| {}, &Cancel::new()).film
}

/// The terms at the point `p` of a scene, seen from the direction `eye`: a picture of one pixel.
pub(super) fn probe(scene: &Scene, p: DVec3, eye: DVec3) -> Terms {
    let mut scene = scene.clone();
    scene.image.size = [1, 1];
    scene.camera.look_at = p;
    scene.camera.eye = p + 10.0 * eye;
    if eye.cross(scene.camera.up).length() < 1e-6 {
        // From right above, which side of the only pixel is up does not matter.
        scene.camera.up = eye.any_orthonormal_vector();
    }
    spots(&measured(&scene)).first().map(|spot| spot.terms).unwrap_or_default()
}

/// Where the camera of a [`ball`] in the direction `eye` sees `p`, on a picture of it at `at`.
pub(super) fn seen(p: DVec3, eye: DVec3, at: Point, size: f64) -> Point {
    let right = (-eye).cross(DVec3::Y).normalize_or_zero();
    let up = right.cross(-eye).normalize_or_zero();
    at + Point::splat(0.5 * size) + size / VIEW * Point::new(p.dot(right), -p.dot(up))
}

/// Draws, beside a picture of a ball, a lamp where its light comes from and the way it shines. Light
/// from behind the eye has no way on paper; then there is no arrow.
pub(super) fn light_from(drawing: &mut Drawing, to_light: DVec3, eye: DVec3, at: Point, size: f64) {
    let center = at + Point::splat(0.5 * size);
    let across = seen(to_light.normalize_or_zero(), eye, at, size) - center;
    let (way, share) = (across.normalize_or_zero(), across.length() * VIEW / size);
    if share < 0.1 {
        return;
    }
    // The ball's edge is 0.48 of the picture from its middle.
    let edge = center + 0.5 * size * way;
    lamp(drawing, edge + 17.0 * way, 4.5);
    let tip = edge - 0.34 * size * share * way;
    drawing.arrow(edge + 5.0 * way, tip, style::LIGHT, 2.0);
}

/// A pixel of a measured ball.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spot {
    /// The normal there.
    pub(super) n: Vec3,
    /// The point itself.
    pub(super) p: Vec3,
    pub(super) terms: Terms,
    /// The picture.
    pub(super) sum: Rgb,
}

/// The pixels of a measured film that show the ball.
pub(super) fn spots(film: &Film) -> Vec<Spot> {
    let triple = |kind, x, y| -> [f32; 3] {
        film.at(kind, x, y).and_then(|values| values.try_into().ok()).unwrap_or_default()
    };
    let mut spots = Vec::new();
    for (y, x) in (0..film.height()).flat_map(|y| (0..film.width()).map(move |x| (y, x))) {
        let n = Vec3::from_array(triple(LayerKind::Aov(Aov::Normal), x, y));
        if n == Vec3::ZERO {
            continue;
        }
        spots.push(Spot {
            n,
            p: Vec3::from_array(triple(LayerKind::Aov(Aov::Position), x, y)),
            terms: Terms::from_fn(|term| triple(LayerKind::Term(term), x, y).into()),
            sum: triple(LayerKind::Picture, x, y).into(),
        });
    }
    spots
}

/// The sum of some layers as pixels, background transparent.
pub(super) fn bitmap(film: &Film, layers: &[LayerKind]) -> Bitmap {
    let values: Vec<&[f32]> =
        layers.iter().filter_map(|&kind| Some(&*film.layer(kind)?.values)).collect();
    let alpha = film.layer(LayerKind::Alpha).map_or(&[][..], |layer| &layer.values);
    let mut rgba = Vec::with_capacity(4 * alpha.len());
    for (pixel, &alpha) in alpha.iter().enumerate() {
        for channel in 0..3 {
            let sum: f32 = values.iter().map(|layer| layer[3 * pixel + channel]).sum();
            let straight = if alpha > 0.0 { sum / alpha } else { 0.0 };
            rgba.push(byte(srgb_encode(f64::from(straight.clamp(0.0, 1.0)))));
        }
        rgba.push(byte(f64::from(alpha.clamp(0.0, 1.0))));
    }
    Bitmap { width: film.width(), height: film.height(), rgba }
}

fn byte(share: f64) -> u8 {
    (share * 255.0 + 0.5) as u8
}
