//! The scenes that the student draws.

use glam::{DAffine3, DVec3};
use phong_scene::{
    Background, Camera, CameraKind, ConstantMaterial, Image, Light, LightKind, MaterialId, Model,
    Object, Place, Rgb, Scene, Shape,
};

use crate::student::{Body, From, Lamp, Slips, Stuff, Thing, V, World, color};

fn stuff(hex: [u8; 3], [k_a, k_d, k_s]: V, alpha: f64) -> Stuff {
    Stuff { hex, k_a, k_d, k_s, alpha, blinn: false }
}

fn ball(c: V, r: f64, stuff: Stuff) -> Thing {
    Thing { body: Body::Sphere { c, r }, stuff }
}

fn floor(stuff: Stuff) -> Thing {
    Thing { body: Body::Floor { height: 0.0 }, stuff }
}

fn lamp(from: From, color: V) -> Lamp {
    Lamp { from, color, shadows: true, fades: 0.0 }
}

/// Four balls on a floor under one lamp.
pub(crate) fn one_lamp() -> World {
    World {
        size: [84, 56],
        eye: [0.5, 2.4, 7.0],
        at: [0.0, 0.8, 0.0],
        fov: 38.0,
        background: [0.1, 0.15, 0.3],
        things: vec![
            ball([-1.4, 1.0, 0.0], 1.0, stuff([230, 120, 90], [0.1, 0.6, 0.5], 9.0)),
            ball([1.1, 0.8, 0.6], 0.8, stuff([90, 170, 230], [0.15, 0.7, 0.4], 21.0)),
            ball([0.4, 0.4, 2.0], 0.4, stuff([120, 215, 120], [0.1, 0.6, 0.3], 4.0)),
            ball([2.6, 1.3, -2.0], 1.3, stuff([200, 200, 60], [0.05, 0.8, 0.2], 40.0)),
            floor(stuff([215, 200, 190], [0.1, 0.6, 0.2], 15.0)),
        ],
        lamps: vec![lamp(From::Point([-3.0, 4.5, 3.5]), [1.0, 0.95, 0.85])],
    }
}

/// Five balls on a floor under three lights of different colours, the second without shadows.
pub(crate) fn colored() -> World {
    let blinn = |stuff| Stuff { blinn: true, ..stuff };
    World {
        size: [84, 48],
        eye: [-2.0, 3.0, 8.0],
        at: [0.2, 0.7, 0.0],
        fov: 34.0,
        background: [0.05, 0.05, 0.08],
        things: vec![
            ball([-2.0, 0.7, 0.5], 0.7, stuff([220, 60, 50], [0.2, 0.7, 0.3], 12.0)),
            ball([-0.3, 1.1, -0.6], 1.1, blinn(stuff([240, 240, 235], [0.1, 0.5, 0.6], 60.0))),
            ball([1.6, 0.8, 0.4], 0.8, stuff([70, 110, 220], [0.3, 0.8, 0.0], 10.0)),
            ball([0.6, 0.35, 1.9], 0.35, blinn(stuff([250, 180, 40], [0.1, 0.6, 0.8], 20.0))),
            ball([3.2, 1.5, -1.8], 1.5, stuff([80, 190, 110], [0.1, 0.6, 0.3], 5.0)),
            floor(stuff([150, 150, 160], [0.15, 0.65, 0.1], 6.0)),
        ],
        lamps: vec![
            Lamp { fades: 0.05, ..lamp(From::Point([4.0, 6.0, 4.0]), [1.0, 0.8, 0.5]) },
            Lamp { shadows: false, ..lamp(From::Point([-5.0, 3.0, -3.0]), [0.2, 0.3, 0.6]) },
            lamp(From::Sun([0.6, -1.0, -0.5]), [0.35, 0.35, 0.4]),
        ],
    }
}

/// Two balls lit from behind by one lamp, without shadows.
pub(crate) fn backlit() -> World {
    let shadeless = Lamp { shadows: false, ..lamp(From::Point([4.0, 5.0, -6.0]), [0.9; 3]) };
    World {
        things: one_lamp().things.into_iter().take(2).collect(),
        lamps: vec![shadeless],
        ..one_lamp()
    }
}

/// The floor and a lamp, with a ball above the lamp.
pub(crate) fn with_ball_above_lamp() -> World {
    let mut world = one_lamp();
    world.lamps[0].from = From::Point([0.0, 3.0, 2.0]);
    let stuff = world.things[0].stuff;
    world.things.insert(4, ball([0.0, 7.0, 3.0], 2.5, stuff));
    world
}

/// A shiny ball of a low exponent, lit from behind, without shadows.
pub(crate) fn behind() -> World {
    let mut world = backlit();
    for thing in &mut world.things {
        (thing.stuff.alpha, thing.stuff.k_s) = (2.0, 0.8);
    }
    world
}

pub(crate) fn scene(w: &World) -> Scene {
    let dvec = DVec3::from_array;
    let rgb = |v: V| Rgb::from(v.map(|x| x as f32));
    let lights = w.lamps.iter().enumerate().map(|(i, lamp)| {
        let kind = match lamp.from {
            From::Point(at) => LightKind::Point {
                position: dvec(at),
                attenuation: [1.0, lamp.fades, 0.0],
                radius: 0.0,
            },
            From::Sun(travels) => LightKind::Distant { direction: dvec(travels), angle: 0.0 },
        };
        let (color, place) = (rgb(lamp.color), Place::default());
        let (name, shadows) = (format!("light {}", i + 1), lamp.shadows);
        Light { name, kind, color, specular_color: color, shadows, place, ..Light::default() }
    });
    let materials = w.things.iter().map(|Thing { stuff, .. }| ConstantMaterial {
        model: if stuff.blinn { Model::BlinnPhong } else { Model::Phong },
        color: rgb(color(stuff, Slips(&[]))),
        k_a: stuff.k_a as f32,
        k_d: stuff.k_d as f32,
        k_s: stuff.k_s as f32,
        shininess: stuff.alpha as f32,
        ..ConstantMaterial::default()
    });
    let objects = w.things.iter().enumerate().map(|(i, thing)| Object {
        name: format!("thing {}", i + 1),
        shape: match thing.body {
            Body::Sphere { c, r } => Shape::Sphere { center: dvec(c), radius: r },
            Body::Floor { height } => Shape::Plane { point: DVec3::Y * height, normal: DVec3::Y },
        },
        material: MaterialId(i as u32),
        transform: DAffine3::IDENTITY,
        place: Place::default(),
    });
    Scene {
        image: Image {
            size: w.size,
            samples: 1,
            background: Background::Color(rgb(w.background)),
            ..Image::default()
        },
        camera: Camera {
            kind: CameraKind::Perspective { fov: w.fov },
            eye: dvec(w.eye),
            look_at: dvec(w.at),
            up: DVec3::Y,
            aperture: 0.0,
            focus: None,
            shift: glam::DVec2::ZERO,
        },
        lights: lights.collect(),
        materials: materials.map(Into::into).collect(),
        objects: objects.collect(),
        ..Scene::default()
    }
}
