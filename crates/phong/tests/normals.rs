//! Shading normals: which side they are turned to, and how those of unequal length interpolate.
#![expect(clippy::unwrap_used, reason = "in a test, what is not there is a failure")]

use phong::aov::Aov;
use phong::explain::{End, Surface, explain};
use phong::film::{Film, LayerKind};
use phong::render::{Cancel, RenderOptions, render};
use phong::view::View;
use phong_scene::{Limits, Memory, Scene, read};

const BALL: &str = include_str!("cases/ball.obj");
const RIM: &str = include_str!("cases/rim.toml");
const LONG: &str = include_str!("cases/long.obj");

/// The scene of a text, whose mesh is this OBJ file.
fn scene(text: &str, obj: &str) -> Scene {
    let files = Memory::new().with("a.toml", text.as_bytes());
    let files = files.with("ball.obj", obj.as_bytes()).with("long.obj", obj.as_bytes());
    let reading = read("a.toml", None, &files, &Limits::default());
    reading.scene.unwrap_or_else(|| panic!("{:?}", reading.diagnostics))
}

fn drawn(scene: &Scene) -> Film {
    let options = RenderOptions::of(&scene.image).unwrap().with_samples(1).unwrap();
    let options = options.with_aovs(&[Aov::Normal]);
    render(&View::of(scene).unwrap(), &options, &|_| {}, &Cancel::new()).film
}

/// The surfaces that the samples of a pixel met.
fn surfaces(scene: &Scene, pixel: [u32; 2]) -> Vec<Surface> {
    let options = RenderOptions::of(&scene.image).unwrap();
    let told = explain(&View::of(scene).unwrap(), &options, pixel).unwrap();
    let met = told.samples.into_iter().filter_map(|sample| match sample.ray?.end {
        End::Surface(surface) => Some(*surface),
        End::Background(_) | End::Light { .. } => None,
    });
    met.collect()
}

/// The largest difference between two films' pictures.
fn apart(a: &Film, b: &Film, kind: LayerKind) -> f32 {
    let [a, b] = [a, b].map(|film| &film.layer(kind).unwrap().values);
    a.iter().zip(b.iter()).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

/// The same faces the other way round.
fn turned_inside_out(obj: &str) -> String {
    let line = |line: &str| match line.strip_prefix("f ") {
        Some(corners) => {
            let corners: Vec<_> = corners.split_whitespace().rev().collect();
            format!("f {}\n", corners.join(" "))
        }
        None => format!("{line}\n"),
    };
    obj.lines().map(line).collect()
}

#[test]
fn at_a_silhouette_the_normal_looks_out_of_the_surface_and_the_rim_is_lit() {
    let met = surfaces(&scene(RIM, BALL), [210, 120]);
    assert!(met.len() > 2);
    let mut beyond = 0;
    for at in met {
        let lit = &at.lights[0];
        assert!(at.n.dot(at.ng) > 0.0 && at.ng.dot(at.e) > 0.0, "{:?} on {:?}", at.n, at.ng);
        assert!((0.95..1.0).contains(&lit.n_dot_l) && lit.visible, "{lit:?}");
        assert!((lit.diffuse.r - lit.n_dot_l).abs() < 1e-6);
        beyond += u32::from(at.n.dot(at.e) < 0.0);
    }
    assert!(beyond > 0, "some of them look away from the eye");
}

#[test]
fn the_order_of_corners_does_not_matter_to_what_is_seen() {
    let outside = drawn(&scene(RIM, BALL));
    let inside_out = drawn(&scene(RIM, &turned_inside_out(BALL)));
    assert!(apart(&outside, &inside_out, LayerKind::Picture) < 1e-5);
    assert!(apart(&outside, &inside_out, LayerKind::Aov(Aov::Normal)) < 1e-5);
}

#[test]
fn the_normal_layer_has_the_normal_that_is_explained() {
    let scene = scene(&RIM.replace("samples = 16", "samples = 1"), BALL);
    let film = drawn(&scene);
    for pixel in [[210, 120], [120, 40], [35, 130]] {
        let at = &surfaces(&scene, pixel)[0];
        let layer = film.at(LayerKind::Aov(Aov::Normal), pixel[0], pixel[1]).unwrap();
        assert_eq!(layer, at.n.to_array());
        assert!(at.n.dot(at.ng) > 0.0);
    }
}

#[test]
fn mirror_and_refracted_rays_leave_on_their_own_side_of_the_surface() {
    let glass = "reflection = 1\ntransmission = 1\nior = 1.5\nk_a = 0\n";
    let text = RIM.replace("k_a = 0\n", glass).replace("samples = 16", "samples = 4\ndepth = 1");
    let (mirrored, mut bent) = (scene(&text, BALL), 0);
    for x in 205..220 {
        for at in surfaces(&mirrored, [x, 120]) {
            let away = |dir: phong::math::Dir3| dir.dot(at.ng);
            let ray = at.reflection.unwrap().ray.unwrap();
            assert!(away(ray.dir) > 0.0, "{ray:?}");
            bent += u32::from(away(ray.dir) < 2e-4);
            let plain = at.n.mirror(at.e);
            assert!(away(ray.dir) < 2e-4 || plain.dot(ray.dir) > 1.0 - 1e-6);
            if let Some(through) = at.transmission.and_then(|onward| onward.ray) {
                assert!(away(through.dir) < 0.0, "{through:?}");
            }
        }
    }
    assert!(bent > 0, "some mirror rays have to be bent");
}

#[test]
fn models_that_divide_by_the_cosine_to_the_eye_stay_finite_and_lit_at_the_rim() {
    let models = [
        "k_s = 0.5\nmodel = \"ggx\"\nroughness = 0.4\n",
        "model = \"oren-nayar\"\nsigma = 0.4\n",
        "k_s = 0.5\nmodel = \"ward\"\nroughness_x = 0.4\nroughness_y = 0.2\n",
    ];
    for model in models {
        let text = RIM.replace("k_s = 0\n", model);
        let film = drawn(&scene(&text, BALL));
        let values = &film.layer(LayerKind::Picture).unwrap().values;
        assert!(values.iter().all(|v| v.is_finite() && *v >= 0.0), "{model}");
        let rim = film.at(LayerKind::Picture, 210, 120).unwrap()[0];
        assert!(rim > 0.2, "{model}: {rim}");
    }
}

/// `long.obj` with its normals changed.
fn long(change: impl Fn([f64; 3]) -> [f64; 3]) -> String {
    let line = |line: &str| match line.strip_prefix("vn ") {
        Some(n) => {
            let n: Vec<f64> = n.split_whitespace().map(|v| v.parse().unwrap()).collect();
            let [x, y, z] = change([n[0], n[1], n[2]]);
            format!("vn {x:e} {y:e} {z:e}\n")
        }
        None => format!("{line}\n"),
    };
    LONG.lines().map(line).collect()
}

fn unit(n: [f64; 3]) -> [f64; 3] {
    n.map(|v| v / glam::DVec3::from(n).length())
}

#[test]
fn normals_of_any_length_are_drawn_as_unit_ones_with_and_without_a_transform() {
    let stretched = "scale = 1\nrotate = [0, 0, 1, 30]\n";
    let plain = include_str!("cases/long.toml").to_owned();
    let turned = plain.replace("scale = 1\n", stretched);
    for text in [plain, include_str!("cases/long-scaled.toml").to_owned(), turned] {
        let wanted = drawn(&scene(&text, &long(unit)));
        for obj in [LONG.to_owned(), long(|n| unit(n).map(|v| v * 1e-25))] {
            let found = drawn(&scene(&text, &obj));
            assert!(apart(&wanted, &found, LayerKind::Aov(Aov::Normal)) < 1e-6);
            assert!(apart(&wanted, &found, LayerKind::Picture) < 1e-5);
        }
    }
}

#[test]
fn a_scale_of_a_thousandth_leaves_normals_as_they_were() {
    let texts = [include_str!("cases/long.toml"), include_str!("cases/long-scaled.toml")];
    let [one, other] = texts.map(|text| drawn(&scene(text, LONG)));
    for pixel in [40, 75, 110] {
        let [one, other] =
            [&one, &other].map(|film| film.at(LayerKind::Aov(Aov::Normal), pixel, 75).unwrap());
        assert!(one.iter().zip(other).all(|(a, b)| (a - b).abs() < 2e-3), "{one:?} {other:?}");
    }
}
