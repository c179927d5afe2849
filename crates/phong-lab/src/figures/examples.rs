//! The model at work: plastics and metal, solids under two lights, mirror and glass, a molecule.

use glam::DVec3;
use phong::film::LayerKind;
use phong::math::wide;
use phong_scene::{
    Background, Camera, CameraKind, ConstantMaterial, Image, Light, LightKind, Object, Rgb, Scene,
    Shape,
};

use super::drawing::Drawing;
use super::mark::Point;
use super::stage::{self, distant, object};
use super::{Number, Plate, Setting};

const TITLE: &str = "Phong at work";
const EQUATION: &str = "*k*_a *C*_a + Σ (*k*_d (*l*·*n*) *C*_d + *k*_s (*r*·*e*)^{*α*} *C*_s)";
/// A picture's size, units.
const SIZE: Point = Point::new(430.0, 194.0);

pub(super) fn draw(setting: Setting) -> Plate {
    let mut numbers = Vec::new();
    for (words, scene) in scenes() {
        let spots = stage::spots(&stage::measured(&scene));
        let apart = spots.iter().map(|spot| spot.terms.total() - spot.sum);
        let worst = apart.map(|rgb| f64::from(rgb.map(f32::abs).max_channel())).fold(0.0, f64::max);
        numbers.push(Number::new(format!("{words}: sum of the terms − picture"), worst, ""));
        let bounced =
            |spot: &&stage::Spot| !(spot.terms.reflection + spot.terms.transmission).is_black();
        let share = spots.iter().filter(bounced).count() as f64 / spots.len() as f64;
        numbers.push(Number::new(format!("{words}: hit pixels with mirror or glass"), share, ""));
    }
    Plate {
        title: TITLE,
        equation: EQUATION,
        caption: "Plastics whose highlights keep the light’s colour and metal that tints it; \
                  solids under two lights; mirror and glass rays added to the sum; and a molecule.",
        numbers,
        drawing: drawing(setting),
    }
}

fn drawing(setting: Setting) -> Drawing {
    let mut drawing = Drawing::slide();
    drawing.header(TITLE, EQUATION);
    for (index, (words, scene)) in scenes().into_iter().enumerate() {
        let (column, row) = ((index % 2) as f64, (index / 2) as f64);
        let at = Point::new(40.0 + 450.0 * column, 70.0 + 234.0 * row);
        let film = stage::shown(&scene, SIZE, setting);
        drawing.image(at, SIZE, stage::bitmap(&film, &[LayerKind::Picture]));
        drawing.note(at + Point::new(0.5 * SIZE.x, SIZE.y + 20.0), words);
    }
    drawing
}

fn scenes() -> [(&'static str, Scene); 4] {
    [
        ("plastics and metal", plastics()),
        ("solids, two lights", solids()),
        ("mirror and glass", mirror_and_glass()),
        ("benzene", benzene()),
    ]
}

fn scene(eye: DVec3, look_at: DVec3, fov: f64) -> Scene {
    let sky = Background::Gradient {
        top: Rgb::from_srgb8([0xb9, 0xd0, 0xe8]),
        bottom: Rgb::from_srgb8([0xf1, 0xf4, 0xf7]),
    };
    let size = (0.5 * SIZE).to_array().map(|side| side as u32);
    Scene {
        image: Image { size, samples: 1, background: sky, ..Image::default() },
        camera: Camera {
            kind: CameraKind::Perspective { fov },
            eye,
            look_at,
            up: DVec3::Y,
            aperture: 0.0,
            focus: None,
            shift: glam::DVec2::ZERO,
        },
        lights: vec![
            point(DVec3::new(-5.0, 7.0, 6.0), 0.8),
            distant(DVec3::new(2.0, 3.0, 2.0), 0.35),
        ],
        materials: vec![floor().into()],
        objects: vec![object(Shape::Plane { point: DVec3::ZERO, normal: DVec3::Y }, 0)],
        ..Scene::default()
    }
}

/// Adds shapes of one material.
fn add(scene: &mut Scene, material: ConstantMaterial, shapes: impl IntoIterator<Item = Shape>) {
    let number = scene.materials.len() as u32;
    scene.materials.push(material.into());
    scene.objects.extend(shapes.into_iter().map(|shape| -> Object { object(shape, number) }));
}

fn point(position: DVec3, color: f32) -> Light {
    let kind = LightKind::Point { position, attenuation: [1.0, 0.0, 0.0], radius: 0.0 };
    Light { kind, ..distant(DVec3::Y, color) }
}

fn floor() -> ConstantMaterial {
    ConstantMaterial {
        color: Rgb::from_srgb8([0xd3, 0xda, 0xe1]),
        k_s: 0.0,
        ..plastic([0; 3], 1.0)
    }
}

fn plastic(srgb: [u8; 3], shininess: f32) -> ConstantMaterial {
    let color = Rgb::from_srgb8(srgb);
    ConstantMaterial {
        color,
        k_a: 0.2,
        k_d: 0.75,
        k_s: 0.6,
        shininess,
        ..ConstantMaterial::default()
    }
}

fn metal(srgb: [u8; 3], shininess: f32) -> ConstantMaterial {
    let base = plastic(srgb, shininess);
    ConstantMaterial { specular_color: None, k_a: 0.15, k_d: 0.4, k_s: 1.1, ..base }
}

fn sphere(x: f64, y: f64, z: f64, radius: f64) -> Shape {
    Shape::Sphere { center: DVec3::new(x, y, z), radius }
}

fn plastics() -> Scene {
    let mut scene = scene(DVec3::new(0.0, 2.6, 9.0), DVec3::new(0.0, 0.8, 0.0), 24.0);
    let balls = [
        plastic([0xc4, 0x3d, 0x2b], 8.0),
        plastic([0x3d, 0x84, 0xd6], 40.0),
        plastic([0x2f, 0x8f, 0x5b], 200.0),
        metal([0xd9, 0xa4, 0x3b], 30.0),
    ];
    for (index, material) in balls.into_iter().enumerate() {
        add(&mut scene, material, [sphere(2.0 * index as f64 - 3.0, 0.85, 0.0, 0.85)]);
    }
    scene
}

fn solids() -> Scene {
    let mut scene = scene(DVec3::new(0.6, 3.4, 9.0), DVec3::new(0.0, 0.62, 0.0), 23.5);
    let tube = DVec3::new(-2.7, 0.35, 0.2);
    let torus = Shape::Torus { center: tube, axis: DVec3::Y, radius: 0.85, tube: 0.35 };
    add(&mut scene, plastic([0xd6, 0x7b, 0x24], 40.0), [torus]);
    let [from, to] = [0.0, 1.7].map(|y| DVec3::new(-0.75, y, -0.5));
    let cone = Shape::Cone { from, to, radius: 0.75, radius_to: 0.0, capped: true };
    add(&mut scene, plastic([0x3d, 0x84, 0xd6], 40.0), [cone]);
    let [from, to] = [0.0, 1.35].map(|y| DVec3::new(1.0, y, 0.3));
    let cylinder = Shape::Cylinder { from, to, radius: 0.55, capped: true };
    add(&mut scene, plastic([0x9b, 0x3d, 0x83], 40.0), [cylinder]);
    let block = Shape::Box { min: DVec3::new(2.1, 0.0, -0.7), max: DVec3::new(3.4, 1.1, 0.6) };
    add(&mut scene, plastic([0x2f, 0x8f, 0x5b], 40.0), [block]);
    scene
}

fn mirror_and_glass() -> Scene {
    let mut scene = scene(DVec3::new(0.0, 2.2, 9.0), DVec3::new(0.0, 0.85, 0.0), 24.0);
    let black = plastic([0x05, 0x05, 0x06], 300.0);
    let mirror = ConstantMaterial { reflection: Rgb::grey(0.85), k_d: 0.1, ..black.clone() };
    add(&mut scene, mirror, [sphere(-1.4, 1.0, -0.3, 1.0)]);
    let glass = ConstantMaterial {
        reflection: Rgb::WHITE,
        transmission: Rgb::grey(0.96),
        fresnel: true,
        k_a: 0.0,
        k_d: 0.0,
        ..black
    };
    add(&mut scene, glass, [sphere(1.2, 0.85, 0.7, 0.85)]);
    add(&mut scene, plastic([0xc4, 0x3d, 0x2b], 40.0), [sphere(-3.3, 0.6, 0.5, 0.6)]);
    add(&mut scene, plastic([0xd9, 0xa4, 0x3b], 40.0), [sphere(2.9, 0.7, -1.2, 0.7)]);
    add(&mut scene, plastic([0x3d, 0x84, 0xd6], 40.0), [sphere(0.0, 0.4, 1.5, 0.4)]);
    scene
}

/// C₆H₆, balls and sticks, a unit an ångström.
fn benzene() -> Scene {
    let mut scene = scene(DVec3::new(0.0, 8.0, 13.0), DVec3::new(0.0, 1.1, 0.0), 19.0);
    let at = |step: u32, radius: f64| {
        let (sin, cos) = wide::sin_cos(f64::from(60 * step).to_radians());
        DVec3::new(radius * cos, 1.3, radius * sin)
    };
    let ball = |center, radius| Shape::Sphere { center, radius };
    let stick = |from, to| Shape::Cylinder { from, to, radius: 0.16, capped: false };
    let (ring, edge) = (1.39, 2.48);
    add(&mut scene, plastic([0x4a, 0x4f, 0x57], 60.0), (0..6).map(|i| ball(at(i, ring), 0.5)));
    add(&mut scene, plastic([0xf0, 0xf0, 0xf0], 60.0), (0..6).map(|i| ball(at(i, edge), 0.32)));
    let sticks =
        (0..6).flat_map(|i| [stick(at(i, ring), at(i + 1, ring)), stick(at(i, ring), at(i, edge))]);
    add(&mut scene, plastic([0x9a, 0xa2, 0xac], 60.0), sticks);
    scene
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pictures_are_the_sums_of_their_terms_mirror_and_glass_included() {
        let numbers = draw(Setting::DRAFT).numbers;
        for pair in numbers.chunks(2) {
            assert_eq!(pair[0].value, 0.0, "{pair:?}");
            assert_eq!(
                pair[1].value > 0.02,
                pair[1].name.contains("mirror and glass:"),
                "{pair:?}"
            );
        }
    }
}
