//! Planted mistakes are recognised, and right pictures pass.
#![expect(clippy::unwrap_used, reason = "in a test, what is not there is a failure")]
#![allow(clippy::disallowed_methods, reason = "the student uses std, as students do")]

mod student;

use glam::{DAffine3, DVec3};
use phong::grade::{Grade, grade};
use phong::image::{Picture, Plane, Transfer};
use phong_scene::{
    Background, Camera, CameraKind, Image, Light, LightKind, Material, MaterialId, Model, Object,
    Place, Rgb, Scene, Shape,
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
    let materials = w.things.iter().map(|thing| Material {
        model: if thing.blinn { Model::BlinnPhong } else { Model::Phong },
        color: rgb(thing.color),
        k_a: thing.k_a as f32,
        k_d: thing.k_d as f32,
        k_s: thing.k_s as f32,
        shininess: thing.alpha as f32,
        ..Material::default()
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
        materials: materials.collect(),
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
    Picture { size: w.size, planes, transfer: Transfer::Srgb }
}

fn graded(w: &World, shadows: bool, slip: Slip) -> Grade {
    grade(&scene(w, shadows), &picture(w, slip)).unwrap()
}

#[track_caller]
fn recognised(w: &World, shadows: bool, slip: Slip, cause: &str) {
    let grade = graded(w, shadows, slip);
    assert!(!grade.pass, "{slip:?} passes: {:?}", grade.residual);
    let list: Vec<_> =
        grade.candidates.iter().map(|c| (&c.cause, c.residual.rms * 255.0)).collect();
    assert_eq!(grade.cause.as_deref(), Some(cause), "{slip:?}: {list:?}");
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
fn every_planted_mistake_in_a_phong_scene_is_recognised() {
    for (slip, cause) in [
        (Slip::ReflectionSign, "reflection-sign"),
        (Slip::EyeBackwards, "reflection-sign"),
        (Slip::AmbientPerLight, "ambient-per-light"),
        (Slip::NoAmbient, "ambient-missing"),
        (Slip::NoAmbientInShadow, "ambient-not-in-shadow"),
        (Slip::NoDiffuse, "diffuse-missing"),
        (Slip::NoSpecular, "specular-missing"),
        (Slip::InsideOut, "normal-inside-out"),
        (Slip::NoGamma, "gamma-missing"),
        (Slip::GammaTwice, "gamma-twice"),
        (Slip::Gamma22, "gamma-2.2"),
        (Slip::UpsideDown, "upside-down"),
        (Slip::LeftRight, "left-right"),
        (Slip::BlueFirst, "blue-first"),
        (Slip::NoShadows, "shadows-missing"),
        (Slip::Acne, "shadow-acne"),
        (Slip::BlinnForPhong, "blinn-not-phong"),
        (Slip::ExponentHalf, "exponent-half"),
        (Slip::LongL, "light-unnormalized"),
        (Slip::TintedHighlight, "specular-tinted"),
        (Slip::HighlightTimesCosine, "specular-times-cosine"),
        (Slip::FirstLightOnly, "first-light-only"),
        (Slip::InverseSquare, "inverse-square"),
        (Slip::HorizontalFov, "fov-horizontal"),
    ] {
        recognised(&world(false), true, slip, cause);
    }
}

#[test]
fn mistakes_with_the_halfway_vector_are_recognised() {
    recognised(&world(true), true, Slip::HalfSum, "half-unnormalized");
    recognised(&world(true), true, Slip::HalfMean, "half-mean");
}

#[test]
fn a_reversed_sun_is_recognised_where_no_floor_hides_it() {
    let mut world = world(false);
    world.things.truncate(3);
    recognised(&world, true, Slip::SunReversed, "distant-reversed");
}

#[test]
fn causes_that_draw_the_same_picture_are_both_named() {
    // From under the floor the sun lights nothing, as if it were not there.
    let grade = graded(&world(false), true, Slip::SunReversed);
    let causes: Vec<&str> = grade.candidates.iter().map(|c| c.cause.as_str()).take(2).collect();
    assert!(causes.contains(&"distant-reversed") && causes.contains(&"first-light-only"));
}

#[test]
fn missing_clamps_show_where_no_shadow_hides_them() {
    let mut world = backlit();
    let unshadowed = |slip, cause| recognised(&backlit(), false, slip, cause);
    world.lamps.truncate(1);
    unshadowed(Slip::NoDiffuseClamp, "clamp-missing-diffuse");
    unshadowed(Slip::NoSpecularClamp, "clamp-missing-specular");
}

#[test]
fn a_shadow_ray_that_does_not_end_at_the_light_is_recognised() {
    let mut world = world(false);
    // A lamp between the balls and a wall of a ball behind it.
    world.lamps[0] = Lamp::Point { at: [0.0, 3.0, 2.0], color: 0.6 };
    let wall =
        Thing { body: Body::Sphere { c: [0.0, 7.0, 3.0], r: 2.5 }, ..world.things.pop().unwrap() };
    let floor = Thing { body: Body::Floor { height: 0.0 }, ..wall };
    world.things.push(Thing { body: Body::Sphere { c: [0.0, 7.0, 3.0], r: 2.5 }, ..floor });
    world.things.push(Thing { body: Body::Floor { height: 0.0 }, ..floor });
    recognised(&world, true, Slip::EndlessShadowRay, "shadow-ray-endless");
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
