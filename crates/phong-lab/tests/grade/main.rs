//! Planted mistakes are recognised, and right pictures pass.
#![expect(clippy::unwrap_used, reason = "in a test, what is not there is a failure")]
#![allow(clippy::disallowed_methods, reason = "the student uses std, as students do")]

mod planted;
mod student;

use std::path::Path;

use glam::{DAffine3, DVec3};
use phong::image::{Picture, Plane, Transfer};
use phong_lab::grade::{Grade, grade};
use phong_scene::{
    Background, Camera, CameraKind, ConstantMaterial, Folder, Image, Light, LightKind, Limits,
    MaterialId, Model, Object, Place, Rgb, Scene, Shape,
};
use student::{Body, Lamp, Slip, Thing, V, World, draw};

/// Three balls on a floor under a lamp and the sun; `blinn` changes the lobe of all.
fn world(blinn: bool) -> World {
    let ball = |c: V, r, color: V, alpha| Thing {
        body: Body::Sphere { c, r },
        color,
        k_a: 0.1,
        k_d: 0.6,
        k_s: 0.4,
        alpha,
        blinn,
    };
    let floor = Body::Floor { height: 0.0 };
    let color = [0.7, 0.6, 0.5];
    let things = vec![
        ball([-1.4, 1.0, 0.0], 1.0, [0.8, 0.2, 0.1], 9.0),
        ball([1.1, 0.8, 0.6], 0.8, [0.1, 0.4, 0.8], 21.0),
        ball([0.4, 0.4, 2.0], 0.4, [0.2, 0.7, 0.2], 3.0),
        Thing { body: floor, color, k_a: 0.1, k_d: 0.6, k_s: 0.2, alpha: 15.0, blinn },
    ];
    World {
        size: [144, 96],
        eye: [0.5, 2.4, 7.0],
        at: [0.0, 0.8, 0.0],
        fov: 38.0,
        background: [0.1, 0.15, 0.3],
        things,
        lamps: vec![
            Lamp::Point { at: [-3.0, 4.5, 3.5], color: 0.6 },
            Lamp::Sun { travels: [-1.0, -1.2, -0.8], color: 0.5 },
        ],
    }
}

/// Balls alone in the dark, lit from the side and from behind, without shadows.
fn backlit() -> World {
    World {
        things: world(false).things.into_iter().take(2).collect(),
        lamps: vec![
            Lamp::Point { at: [4.0, 5.0, -6.0], color: 0.9 },
            Lamp::Sun { travels: [1.0, -0.5, -0.4], color: 0.5 },
        ],
        ..world(false)
    }
}

fn scene(w: &World, shadows: bool) -> Scene {
    let dvec = DVec3::from_array;
    let rgb = |v: V| Rgb::from(v.map(|x| x as f32));
    let lights = w.lamps.iter().enumerate().map(|(i, lamp)| {
        let (kind, color) = match *lamp {
            Lamp::Point { at, color } => {
                let position = dvec(at);
                (LightKind::Point { position, attenuation: [1.0, 0.0, 0.0], radius: 0.0 }, color)
            }
            Lamp::Sun { travels, color } => {
                (LightKind::Distant { direction: dvec(travels), angle: 0.0 }, color)
            }
        };
        let (color, place) = (Rgb::grey(color as f32), Place::default());
        Light { name: format!("light {i}"), kind, color, specular_color: color, shadows, place }
    });
    let materials = w.things.iter().map(|thing| ConstantMaterial {
        model: if thing.blinn { Model::BlinnPhong } else { Model::Phong },
        color: rgb(thing.color),
        k_a: thing.k_a as f32,
        k_d: thing.k_d as f32,
        k_s: thing.k_s as f32,
        shininess: thing.alpha as f32,
        ..ConstantMaterial::default()
    });
    let objects = w.things.iter().enumerate().map(|(i, thing)| Object {
        name: format!("thing {i}"),
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
        },
        ambient: Rgb::WHITE,
        lights: lights.collect(),
        materials: materials.map(Into::into).collect(),
        textures: Vec::new(),
        objects: objects.collect(),
        groups: Vec::new(),
    }
}

fn picture(w: &World, slip: Slip) -> Picture {
    let levels = draw(w, slip);
    let plane = |channel: usize, name: &str| Plane {
        name: name.to_owned(),
        values: levels.iter().map(|level| f32::from(level[channel]) / 255.0).collect(),
    };
    let planes = vec![plane(0, "R"), plane(1, "G"), plane(2, "B")];
    Picture { size: w.size, planes, transfer: Transfer::Srgb, levels: Some(255) }
}

fn graded(w: &World, shadows: bool, slip: Slip) -> Grade {
    grade(&scene(w, shadows), &picture(w, slip)).unwrap()
}

#[test]
fn a_right_picture_passes() {
    for blinn in [false, true] {
        let grade = graded(&world(blinn), true, Slip::None);
        assert!(grade.pass, "{:?}", grade.residual);
        for (name, factor) in grade.terms.iter().take(3) {
            assert!((factor.unwrap() - 1.0).abs() < 0.02, "{name}: {factor:?}");
        }
    }
}

#[test]
fn causes_that_draw_the_same_picture_are_both_named() {
    // From under the floor the sun lights nothing, as if it were not there.
    let grade = graded(&world(false), true, Slip::SunReversed);
    let causes: Vec<&str> = grade.candidates.iter().map(|c| c.cause.as_str()).take(2).collect();
    assert!(causes.contains(&"distant-reversed") && causes.contains(&"first-light-only"));
}

#[test]
fn a_picture_of_another_size_is_refused() {
    let world = world(false);
    let other = World { size: [10, 10], ..self::world(false) };
    let error = grade(&scene(&world, true), &picture(&other, Slip::None)).unwrap_err();
    assert_eq!(error.to_string(), "the picture is 10 × 10, but the scene's is 144 × 96");
}

#[test]
fn terms_that_are_missing_are_named() {
    let factor = |slip, i: usize| graded(&world(false), true, slip).terms[i].1.unwrap();
    assert!(factor(Slip::NoAmbient, 0).abs() < 0.05);
    assert!(factor(Slip::NoDiffuse, 1).abs() < 0.05);
    assert!(factor(Slip::NoSpecular, 2).abs() < 0.05);
}

/// The scene beside this file, and the picture that another program drew of it.
fn by_another_program() -> (Scene, Picture) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/grade");
    let toml = folder.join("pov_ray.toml");
    let reading = phong_scene::read(&toml.to_string_lossy(), None, &Folder, &Limits::default());
    let png = std::fs::read(folder.join("pov_ray.png")).unwrap();
    (reading.scene.unwrap(), Picture::read(&png).unwrap())
}

#[test]
fn a_right_picture_by_another_program_passes() {
    let (scene, picture) = by_another_program();
    let told = grade(&scene, &picture).unwrap();
    assert!(told.pass, "{:?} {:?}", told.residual, told.cause);
    assert!(told.residual.pixels > 5000, "{:?}", told.residual);
    for (name, factor) in told.terms {
        match factor {
            Some(factor) => assert!((factor - 1.0).abs() < 0.03, "{name}: {factor}"),
            None => assert_eq!(name, "emission"),
        }
    }
}

#[test]
fn a_picture_by_another_program_of_a_scene_changed_a_little_fails() {
    let (mut scene, picture) = by_another_program();
    for material in &mut scene.materials {
        material.shininess = (2.0 * material.shininess.constant().unwrap()).into();
    }
    let told = grade(&scene, &picture).unwrap();
    assert_eq!((told.pass, told.cause.as_deref()), (false, Some("exponent-half")));
}

#[test]
fn a_picture_of_something_else_is_not_recognised() {
    let (scene, mut picture) = by_another_program();
    let size = picture.size;
    let mut told = |draw: &dyn Fn(f32, f32) -> f32, what: &str| {
        for plane in &mut picture.planes {
            let place = |i: usize| (i as u32 % size[0], i as u32 / size[0]);
            let value = |i| {
                let (x, y) = place(i);
                draw(x as f32 / size[0] as f32, y as f32 / size[1] as f32)
            };
            plane.values = (0..plane.values.len()).map(value).collect();
        }
        let told = grade(&scene, &picture).unwrap();
        assert!(!told.pass && told.cause.is_none(), "{what}: {:?} {:?}", told.cause, told.residual);
    };
    told(&|x, y| ((8.0 * x).floor() + (6.0 * y).floor()) % 2.0, "a chessboard");
    told(&|x, _| x, "a ramp");
    told(&|x, y| (37.0 * x).sin() * (29.0 * y).cos() * 0.5 + 0.5, "waves");
    let other = picture_of_the_other_world(size);
    let told = grade(&scene, &other).unwrap();
    assert!(!told.pass && told.cause.is_none(), "another scene: {:?}", told.cause);
}

fn picture_of_the_other_world(size: [u32; 2]) -> Picture {
    picture(&World { size, ..world(false) }, Slip::None)
}

#[test]
fn what_is_no_number_is_told_with_its_place_and_the_rest_is_graded() {
    let world = world(false);
    let broken = |slip| {
        let mut picture = picture(&world, slip);
        for i in [700, 701, 900] {
            picture.planes[1].values[i] = f32::NAN;
        }
        grade(&scene(&world, true), &picture).unwrap()
    };
    let right = broken(Slip::None);
    assert_eq!((right.pass, right.cause.as_deref()), (false, Some("not-a-number")));
    let evidence = &right.candidates[0].evidence;
    assert_eq!(evidence, "3 pixels are no number, the first at (124, 4)");
    assert!(
        right.residual.rms.is_finite()
            && right.terms.iter().filter_map(|t| t.1).all(f64::is_finite)
    );
    let wrong = broken(Slip::NoSpecular);
    assert_eq!(wrong.cause.as_deref(), Some("not-a-number + specular-missing"));
}
