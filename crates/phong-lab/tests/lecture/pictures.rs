//! What the lecture says of pictures, on pictures of one sphere.

use glam::{DAffine3, DVec3, Vec3};
use phong::aov::Aov;
use phong::explain::{End, Lit, Surface, explain};
use phong::film::{Film, LayerKind};
use phong::math::Dir3;
use phong::render::{Cancel, RenderOptions, render};
use phong::terms::{Term, TermSet, Terms};
use phong::view::View;
use phong_scene::{
    Camera, CameraKind, ConstantMaterial, Image, Light, LightKind, Material, MaterialId, Model,
    Object, Place, Rgb, Scene, Shape,
};

const SIZE: u32 = 48;
const CENTER: DVec3 = DVec3::new(0.2, -0.1, 0.0);
const RADIUS: f64 = 1.5;
const EYE: DVec3 = DVec3::new(0.0, 0.0, 6.0);
const AMBIENT: LayerKind = LayerKind::Term(Term::Ambient);
const DIFFUSE: LayerKind = LayerKind::Term(Term::Diffuse);
const SPECULAR: LayerKind = LayerKind::Term(Term::Specular);

/// An orange plastic ball in front of black, seen from `EYE`, under `lights`.
fn ball(lights: Vec<Light>) -> Scene {
    Scene {
        image: Image { size: [SIZE, SIZE], samples: 1, ..Image::default() },
        camera: Camera {
            kind: CameraKind::Perspective { fov: 35.0 },
            eye: EYE,
            look_at: DVec3::ZERO,
            up: DVec3::Y,
            aperture: 0.0,
            focus: None,
            shift: glam::DVec2::ZERO,
        },
        lights,
        materials: vec![
            ConstantMaterial {
                color: Rgb::new(1.0, 0.5, 0.1),
                k_a: 0.125,
                k_d: 0.5,
                k_s: 0.25,
                shininess: 9.0,
                ..ConstantMaterial::default()
            }
            .into(),
        ],
        objects: vec![Object {
            name: "ball".to_owned(),
            shape: Shape::Sphere { center: CENTER, radius: RADIUS },
            material: MaterialId(0),
            transform: DAffine3::IDENTITY,
            place: Place::default(),
        }],
        ..Scene::default()
    }
}

fn light(kind: LightKind) -> Light {
    Light { name: "light".to_owned(), kind, ..Light::default() }
}

/// Light from the upper left, in front.
fn sun() -> Light {
    light(LightKind::Distant { direction: DVec3::new(1.0, -1.0, -2.0), angle: 0.0 })
}

fn lamp(position: DVec3) -> Light {
    light(LightKind::Point { position, attenuation: [1.0, 0.0, 0.0], radius: 0.0 })
}

#[expect(clippy::needless_pass_by_value, reason = "each test makes its scene for this")]
fn compiled(scene: Scene) -> (View, RenderOptions) {
    let aovs = vec![Aov::Normal, Aov::Position];
    let options =
        RenderOptions::of(&scene.image).unwrap().with_terms(TermSet::ALL).with_aovs(&aovs);
    (View::of(&scene).unwrap(), options)
}

fn film(scene: Scene) -> Film {
    let (scene, options) = compiled(scene);
    render(&scene, &options, &|_| {}, &Cancel::new()).film
}

fn rgb(film: &Film, kind: LayerKind, [x, y]: [u32; 2]) -> Rgb {
    let v = film.at(kind, x, y).unwrap();
    Rgb::new(v[0], v[1], v[2])
}

fn pixels() -> impl Iterator<Item = [u32; 2]> {
    (0..SIZE).flat_map(|y| (0..SIZE).map(move |x| [x, y]))
}

/// The pixels that the ball covers.
fn covered(film: &Film) -> Vec<[u32; 2]> {
    let covered: Vec<_> = pixels().filter(|&p| !rgb(film, AMBIENT, p).is_black()).collect();
    assert!(covered.len() > 1000, "only {} pixels show the ball", covered.len());
    covered
}

/// The surface that a pixel shows, and what its first light does there.
fn told(scene: Scene, pixel: [u32; 2]) -> (Surface, Lit) {
    let (scene, options) = compiled(scene);
    let explanation = explain(&scene, &options, pixel).unwrap();
    let End::Surface(surface) = explanation.samples[0].ray.clone().unwrap().end else {
        panic!("{pixel:?} shows no surface")
    };
    let light = surface.lights[0].clone();
    (*surface, light)
}

fn direction(from: DVec3, to: DVec3) -> Dir3 {
    Dir3::new((to - from).as_vec3()).unwrap()
}

#[track_caller]
fn assert_along(found: Dir3, expected: Dir3, tolerance: f32) {
    let off = (found.to_vec() - expected.to_vec()).length();
    assert!(off < tolerance, "{found:?}, not {expected:?}: {off} apart");
}

/// "n = p − c (may need to normalize)".
#[test]
fn a_spheres_normal_is_p_minus_c_normalized() {
    let film = film(ball(vec![sun()]));
    for pixel in covered(&film) {
        let vector = |aov| {
            let [x, y, z] = rgb(&film, LayerKind::Aov(aov), pixel).to_array();
            Vec3::new(x, y, z)
        };
        let (n, p) = (vector(Aov::Normal), vector(Aov::Position));
        let expected = (p - CENTER.as_vec3()) / RADIUS as f32;
        assert!((n - expected).length() < 1e-5, "{n} and {expected} at {pixel:?}");
    }
}

/// "`camera_position − point_on_sphere`".
#[test]
fn the_eye_vector_points_from_the_point_to_the_camera() {
    for pixel in [[24, 24], [14, 30], [35, 20]] {
        let (surface, _) = told(ball(vec![sun()]), pixel);
        assert_along(surface.e, direction(surface.p, EYE), 1e-6);
    }
}

/// "Point lights are located at a point: `light_position − point_on_sphere`. Distant lights, like the
/// sun, are a fixed direction."
#[test]
fn the_light_vector_depends_on_the_kind_of_light() {
    let place = DVec3::new(-3.0, 2.0, 4.0);
    let mut fixed = Vec::new();
    for pixel in [[24, 24], [14, 30], [35, 20]] {
        let (surface, lamp) = told(ball(vec![lamp(place)]), pixel);
        assert_along(lamp.l.unwrap(), direction(surface.p, place), 1e-6);
        fixed.push(told(ball(vec![sun()]), pixel).1.l.unwrap());
    }
    assert_along(fixed[0], direction(DVec3::ZERO, DVec3::new(-1.0, 1.0, 2.0)), 1e-6);
    assert_eq!(fixed[0], fixed[1]);
    assert_eq!(fixed[0], fixed[2]);
}

/// "Ambient + Diffuse + Specular = Phong Reflection", in every pixel, to the last bit.
#[test]
fn the_three_terms_add_up_to_the_picture() {
    let film = film(ball(vec![sun(), lamp(DVec3::new(3.0, 1.0, 2.0))]));
    for pixel in pixels() {
        let terms = Terms::from_fn(|term| rgb(&film, LayerKind::Term(term), pixel));
        assert_eq!(rgb(&film, LayerKind::Picture, pixel), terms.total());
    }
}

/// "Doesn't use any of the vectors: totally flat."
#[test]
fn the_ambient_term_is_flat() {
    let film = film(ball(vec![sun()]));
    for pixel in covered(&film) {
        assert_eq!(rgb(&film, AMBIENT, pixel), 0.125 * Rgb::new(1.0, 0.5, 0.1));
    }
}

/// "Without this we would get totally black shadows."
#[test]
fn without_ambient_light_the_far_side_is_totally_black() {
    let mut scene = ball(vec![light(LightKind::Distant { direction: DVec3::X, angle: 0.0 })]);
    let with = film(scene.clone());
    scene.ambient = Rgb::BLACK;
    let without = film(scene);
    let dark: Vec<_> = covered(&with)
        .into_iter()
        .filter(|&p| rgb(&with, LayerKind::Aov(Aov::Normal), p).r > 0.0)
        .collect();
    assert!(dark.len() > 300);
    for pixel in dark {
        assert_eq!(rgb(&without, LayerKind::Picture, pixel), Rgb::BLACK);
        assert_eq!(rgb(&with, LayerKind::Picture, pixel), rgb(&with, AMBIENT, pixel));
    }
}

/// "Side oriented toward light: full object color. Side oriented away from light: black." And
/// between them, the cosine.
#[test]
fn the_diffuse_term_is_the_object_colour_times_the_cosine() {
    let film = film(ball(vec![sun()]));
    let l = direction(DVec3::ZERO, DVec3::new(-1.0, 1.0, 2.0));
    let mut brightest = 0.0_f32;
    for pixel in covered(&film) {
        let [x, y, z] = rgb(&film, LayerKind::Aov(Aov::Normal), pixel).to_array();
        let cosine = Dir3::new(Vec3::new(x, y, z)).unwrap().cos(l);
        let found = rgb(&film, DIFFUSE, pixel);
        let expected = 0.5 * cosine * Rgb::new(1.0, 0.5, 0.1);
        let off = (found - expected).to_array().map(f32::abs).into_iter().fold(0.0, f32::max);
        assert!(off < 1e-6, "{found:?}, not {expected:?} at {pixel:?}");
        brightest = brightest.max(found.r);
    }
    assert!((brightest - 0.5).abs() < 1e-3);
}

/// "If you move your head, the shiny spots will move, but the lambertian shade will stay the same."
#[test]
fn moving_the_eye_moves_the_highlight_but_not_the_shade() {
    // The same point of the ball, seen from two places.
    let seen_from = |eye: DVec3| {
        let mut scene = ball(vec![sun()]);
        scene.image.size = [1, 1];
        (scene.camera.eye, scene.camera.look_at) = (eye, CENTER + RADIUS * DVec3::Z);
        told(scene, [0, 0]).0
    };
    let (here, there) = (seen_from(EYE), seen_from(DVec3::new(2.0, -1.0, 6.0)));
    assert!((here.p - there.p).length() < 1e-6);
    assert!((here.terms.diffuse - there.terms.diffuse).max_channel().abs() < 1e-6);
    assert_eq!(here.terms.ambient, there.terms.ambient);
    assert!((here.terms.specular.r - there.terms.specular.r).abs() > 0.01);
    // And in the picture the brightest spot wanders.
    let spot = |eye: DVec3| {
        let mut scene = ball(vec![sun()]);
        scene.camera.eye = eye;
        let film = film(scene);
        let brightness = |p: &[u32; 2]| rgb(&film, SPECULAR, *p).r;
        let p = pixels().max_by(|a, b| brightness(a).total_cmp(&brightness(b))).unwrap();
        let [x, y, z] = rgb(&film, LayerKind::Aov(Aov::Normal), p).to_array();
        Vec3::new(x, y, z)
    };
    let moved = spot(EYE).distance(spot(DVec3::new(3.0, 0.0, 5.0)));
    assert!(moved > 0.1, "{moved}");
}

/// "Shiny spots are tiny blurry images of the light source", the smaller the higher the shininess.
#[test]
fn the_highlight_shrinks_with_shininess_and_keeps_its_peak() {
    let shiny = |shininess: f32, k_s: f32| {
        let mut scene = ball(vec![sun()]);
        let (shininess, k_s) = (shininess.into(), k_s.into());
        scene.materials[0] = Material { shininess, k_s, ..scene.materials[0].clone() };
        film(scene)
    };
    for k_s in [0.25, 0.5, 0.75] {
        let areas = [3.0, 9.0, 200.0].map(|alpha| {
            let film = shiny(alpha, k_s);
            let peak = pixels().map(|p| rgb(&film, SPECULAR, p).r).fold(0.0, f32::max);
            assert!(peak <= k_s && peak > 0.8 * k_s, "{peak} for k_s = {k_s}, α = {alpha}");
            pixels().filter(|&p| rgb(&film, SPECULAR, p).r > 0.5 * k_s).count()
        });
        assert!(areas[0] > areas[1] && areas[1] > areas[2] && areas[2] > 0, "{areas:?}");
    }
}

/// "Blinn-Phong (higher exponent)" looks like Phong: with four times the exponent the two spots
/// cover nearly the same area, with the same exponent Blinn's covers far more.
#[test]
fn blinn_phong_with_a_higher_exponent_looks_like_phong() {
    let area = |model, shininess| {
        let mut scene = ball(vec![sun()]);
        scene.image.size = [96, 96];
        let constant =
            ConstantMaterial { model, shininess, k_s: 1.0, ..ConstantMaterial::default() };
        scene.materials[0] = constant.into();
        let film = film(scene);
        let values = film.layer(SPECULAR).unwrap().values.chunks(3).map(|v| v[0]);
        values.filter(|&v| v > 0.5).count() as f64
    };
    let phong = area(Model::Phong, 30.0);
    assert!(area(Model::BlinnPhong, 30.0) / phong > 2.5);
    let matched = area(Model::BlinnPhong, 120.0) / phong;
    assert!((0.8..1.05).contains(&matched), "{matched}");
}

/// "Σ over m ∈ lights": what two lights show is what each shows, with one ambient term.
#[test]
fn two_lights_are_the_sum_of_each_less_one_ambient_term() {
    let [a, b] = [sun(), lamp(DVec3::new(3.0, 1.0, 2.0))];
    let [one, other, both] =
        [vec![a.clone()], vec![b.clone()], vec![a, b]].map(|lights| film(ball(lights)));
    for pixel in covered(&both) {
        let [one, other, ambient, both] = [
            rgb(&one, LayerKind::Picture, pixel),
            rgb(&other, LayerKind::Picture, pixel),
            rgb(&one, AMBIENT, pixel),
            rgb(&both, LayerKind::Picture, pixel),
        ];
        let off = (one + other - ambient - both).to_array().map(f32::abs);
        assert!(off.iter().all(|&off| off < 3e-7), "{off:?} at {pixel:?}");
    }
}

/// `C_{m,d}`, `C_{m,s}`: a light's colour times the material's, which for the highlight is white.
#[test]
fn a_coloured_light_is_tinted_by_the_object_in_the_shade_but_not_in_the_highlight() {
    let white = film(ball(vec![sun()]));
    let tint = Rgb::new(0.25, 1.0, 0.5);
    let tinted = film(ball(vec![Light { color: tint, specular_color: tint, ..sun() }]));
    let mut shiny = 0;
    for pixel in covered(&white) {
        for term in [DIFFUSE, SPECULAR] {
            let off = rgb(&tinted, term, pixel) - rgb(&white, term, pixel) * tint;
            assert!(off.to_array().iter().all(|off| off.abs() < 1e-7), "{off:?}");
        }
        let highlight = rgb(&tinted, SPECULAR, pixel);
        assert_eq!(highlight.r, 0.25 * highlight.g);
        shiny += usize::from(highlight.g > 0.2);
    }
    assert!(shiny > 10);
}
