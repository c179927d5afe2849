//! The same bits, whatever the number of threads, the size of a tile, the cut of the picture and the SIMD level.

use std::fmt::Write;
use std::sync::{Arc, LazyLock};

use phong::aov::Aov;
use phong::explain::explain;
use phong::film::{Film, LayerKind, Window};
use phong::geometry::{Geometry, GeometryOptions};
use phong::look::Look;
use phong::render::{Cancel, RenderOptions, render};
use phong::terms::{Term, TermSet};
use phong::view::View;
use phong_bvh::{BuildOptions, Level, Preset};
use phong_scene::{
    AmbientRule, Background, CameraKind, FilterKind, Fog, Limits, Memory, Reading, Rgb, Scene,
};

/// A scene with its picture as everybody else must draw it: one thread, the default tiles.
struct Case {
    name: &'static str,
    written: Scene,
    scene: View,
    options: RenderOptions,
    film: Film,
}

static CASES: LazyLock<Vec<Case>> = LazyLock::new(|| {
    [("everything", EVERYTHING.to_owned()), ("mesh", with(MESH)), ("points", with(POINTS))]
        .into_iter()
        .map(|(name, text)| {
            let source = Memory::new()
                .with("scene.toml", text.into_bytes())
                .with("mesh.obj", bumpy_ball(96).into_bytes())
                .with("points.ply", cloud(3000).into_bytes());
            let Reading { scene, diagnostics, .. } =
                phong_scene::read("scene.toml", None, &source, &Limits::default());
            assert!(diagnostics.is_empty(), "{name}: {diagnostics:#?}");
            let scene = scene.expect("a scene, for there is no error");
            // `cost` alone is exempt.
            let aovs = [Aov::Depth, Aov::Normal, Aov::Position, Aov::Object, Aov::Shadow];
            let options = RenderOptions::of(&scene.image).expect("the scene has been checked");
            let options = options.with_terms(TermSet::ALL).with_aovs(&aovs);
            let written = scene.clone();
            let scene = View::of(&scene).expect("compiles");
            let film = drawn(&scene, &options, 1);
            Case { name, written, scene, options, film }
        })
        .collect()
});

const EVERYTHING: &str = include_str!("agreement/everything.toml");

const MESH: &str = "[[mesh]]\nfile = \"mesh.obj\"";

const POINTS: &str = "[[points]]\nfile = \"points.ply\"\nradius = 0.05";

/// A picture of one shape that comes from a file.
fn with(shape: &str) -> String {
    format!(
        "version = 1\n[image]\nsize = [70, 50]\nsamples = 2\n[camera]\neye = [0, 1, 4]\nlook_at = [0, 0, 0]\n\
         [[light]]\nkind = \"point\"\nposition = [3, 4, 5]\n[[light]]\nkind = \"distant\"\n\
         direction = [1, -1, -1]\ncolor = 0.4\n[materials.clay]\ncolor = \"#b07040\"\nk_s = 0.4\n{shape}\nmaterial = \"clay\"\n"
    )
}

/// A ball with bumps, in `2 n²` triangles.
fn bumpy_ball(n: usize) -> String {
    let mut obj = String::new();
    for j in 0..=n {
        for i in 0..n {
            let (u, v) = (i as f64 / n as f64 * 2.0, j as f64 / n as f64);
            let (phi, theta) = (u * std::f64::consts::PI, v * std::f64::consts::PI);
            let r = 1.0 + 0.06 * libm::sin(9.0 * phi) * libm::sin(11.0 * theta);
            let (x, z) = (libm::cos(phi) * libm::sin(theta), libm::sin(phi) * libm::sin(theta));
            let _ = writeln!(obj, "v {} {} {}", r * x, r * libm::cos(theta), r * z);
        }
    }
    for j in 0..n {
        for i in 0..n {
            let k = (i + 1) % n;
            let (a, b, c, d) =
                (j * n + i + 1, j * n + k + 1, (j + 1) * n + i + 1, (j + 1) * n + k + 1);
            let _ = writeln!(obj, "f {a} {b} {c}\nf {b} {d} {c}");
        }
    }
    obj
}

/// Points in a ball, from a counter stepped by the plastic number: even, and the same everywhere.
fn cloud(n: u32) -> String {
    let mut ply = format!(
        "ply\nformat ascii 1.0\nelement vertex {n}\nproperty float x\nproperty float y\nproperty float z\n\
         end_header\n"
    );
    for i in 1..=n {
        let at = |step: f64| (f64::from(i) * step).fract() * 2.4 - 1.2;
        let _ = writeln!(ply, "{} {} {}", at(0.819_172_513), at(0.671_043_607), at(0.549_700_478));
    }
    ply
}

fn drawn(scene: &View, options: &RenderOptions, threads: usize) -> Film {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    pool.install(|| render(scene, options, &|_| {}, &Cancel::new())).film
}

/// Every layer, bit for bit.
#[track_caller]
fn assert_same(name: &str, a: &Film, b: &Film) {
    assert_eq!(a.layers.len(), b.layers.len());
    for (p, q) in a.layers.iter().zip(&b.layers) {
        assert_eq!(p.kind, q.kind);
        let bits = |values: &[f32]| values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
        let apart = bits(&p.values).iter().zip(&bits(&q.values)).filter(|(x, y)| x != y).count();
        assert_eq!(p.values.len(), q.values.len());
        assert_eq!(apart, 0, "{name}: values of `{}` differ", p.kind.name());
    }
}

#[test]
fn the_cases_show_something() {
    for case in CASES.iter() {
        let normals = &case.film.layer(LayerKind::Aov(Aov::Normal)).expect("asked for").values;
        let hit = normals.chunks_exact(3).filter(|n| **n != [0.0; 3]).count();
        let pixels = case.film.width() as usize * case.film.height() as usize;
        assert!(hit * 5 > pixels, "{}: {hit} of {pixels} pixels show a surface", case.name);
        assert!(case.film.is_complete());
    }
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    for case in CASES.iter() {
        for threads in [2, 7] {
            assert_same(case.name, &drawn(&case.scene, &case.options, threads), &case.film);
        }
    }
}

#[test]
fn the_size_of_a_tile_changes_no_bit() {
    for case in CASES.iter() {
        for tile in [1, 8, 64] {
            let options = case.options.clone().with_tile(tile).expect("not 0");
            assert_same(case.name, &drawn(&case.scene, &options, 2), &case.film);
        }
    }
}

#[test]
fn a_crop_is_a_part_of_the_whole() {
    for case in CASES.iter() {
        let window = Window { x0: 13, y0: 7, x1: 59, y1: 42 };
        let options = case.options.clone().with_window(window).expect("within");
        let part = drawn(&case.scene, &options, 2);
        for layer in &part.layers {
            for y in window.y0..window.y1 {
                for x in window.x0..window.x1 {
                    let bits = |film: &Film| {
                        let values = film.at(layer.kind, x, y).expect("within");
                        values.iter().map(|v| v.to_bits()).collect::<Vec<_>>()
                    };
                    let (a, b) = (bits(&part), bits(&case.film));
                    assert_eq!(a, b, "{}: {} at ({x}, {y})", case.name, layer.kind.name());
                }
            }
        }
    }
}

#[test]
fn shares_put_together_are_the_whole() {
    for case in CASES.iter() {
        let mut parts = (0..3).map(|i| {
            let options = case.options.clone().with_share(i, 3).expect("one of 3");
            drawn(&case.scene, &options, 2)
        });
        let mut whole = parts.next().expect("a first share");
        assert!(!whole.is_complete());
        for part in parts {
            whole.merge(&part).expect("shares of one picture");
        }
        assert!(whole.is_complete());
        assert_same(case.name, &whole, &case.film);
    }
}

#[test]
fn the_picture_is_the_sum_of_its_terms() {
    for case in CASES.iter() {
        let layer = |kind| &case.film.layer(kind).expect("asked for").values;
        let picture = layer(LayerKind::Picture);
        let terms: Vec<_> = Term::ALL.map(|term| layer(LayerKind::Term(term))).into();
        for (i, value) in picture.iter().enumerate() {
            let sum: f32 = terms.iter().map(|term| term[i]).fold(0.0, |sum, term| sum + term);
            assert_eq!(sum.to_bits(), value.to_bits(), "{}: value {i}", case.name);
        }
    }
}

#[test]
fn the_simd_level_and_the_preset_of_the_build_change_no_bit() {
    let levels: Vec<Level> = Level::ALL.into_iter().filter(|level| level.is_available()).collect();
    assert!(!levels.is_empty());
    for case in CASES.iter() {
        let held = |level, preset| {
            let build = Some(BuildOptions { level, preset });
            let options = GeometryOptions { build, ..GeometryOptions::default() };
            let geometry = Geometry::new(&case.written, options).expect("trees are built");
            let scene = View::new(Arc::new(geometry), Look::new(&case.written)).expect("fits");
            let film = drawn(&scene, &case.options, 2);
            assert_same(&format!("{} at {level:?}, {preset:?}", case.name), &film, &case.film);
        };
        for level in &levels {
            held(Some(*level), Preset::Balanced);
        }
        for preset in [Preset::Fast, Preset::Best, Preset::Compact] {
            held(None, preset);
        }
    }
}

#[test]
fn what_is_explained_is_what_is_drawn() {
    for case in CASES.iter() {
        for y in (0..case.film.height()).step_by(5) {
            for x in (0..case.film.width()).step_by(3) {
                let told = explain(&case.scene, &case.options, [x, y]).expect("a pixel of it");
                let drawn = case.film.at(LayerKind::Picture, x, y).expect("a pixel of it");
                let bits = |values: &[f32]| values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
                let told = told.terms.total().to_array();
                assert_eq!(bits(&told), bits(drawn), "{} at ({x}, {y})", case.name);
            }
        }
    }
}

/// A few spheres and a floor, of which every ray is one of eight.
fn few_things() -> Scene {
    let source = Memory::new().with("scene.toml", include_bytes!("agreement/few.toml").to_vec());
    let Reading { scene, diagnostics, .. } =
        phong_scene::read("scene.toml", None, &source, &Limits::default());
    assert!(diagnostics.is_empty(), "{diagnostics:#?}");
    scene.expect("a scene, for there is no error")
}

fn few(kind: CameraKind, aperture: f64, background: Background) -> View {
    let mut scene = few_things();
    (scene.camera.kind, scene.camera.aperture) = (kind, aperture);
    scene.image.background = background;
    View::of(&scene).expect("compiles")
}

#[test]
fn every_camera_filter_and_background_is_drawn_as_explained_in_tiles_of_any_size() {
    let black_to_grey = Background::Gradient { top: Rgb::BLACK, bottom: Rgb::grey(0.5) };
    for (kind, aperture, samples, filter, background) in [
        (CameraKind::Perspective { fov: 40.0 }, 0.2, 5, FilterKind::Mitchell, black_to_grey),
        (CameraKind::Perspective { fov: 40.0 }, 0.0, 1, FilterKind::Box, Background::Transparent),
        (CameraKind::Orthographic { height: 4.0 }, 0.1, 3, FilterKind::Tent, black_to_grey),
        (CameraKind::Fisheye { fov: 170.0 }, 0.0, 6, FilterKind::Mitchell, Background::Transparent),
        (CameraKind::Fisheye { fov: 100.0 }, 0.0, 1, FilterKind::Mitchell, black_to_grey),
        (CameraKind::Panorama, 0.0, 2, FilterKind::Gaussian, Background::Color(Rgb::grey(0.3))),
    ] {
        let name = format!("{kind:?}, {samples} samples, {filter:?}, {background:?}");
        let scene = few(kind, aperture, background);
        let size = [21, 13];
        let options = RenderOptions::new(size).expect("a size").with_samples(samples);
        let options = options.expect("at least one").with_terms(TermSet::ALL);
        let options = options.with_filter(filter);
        let film = drawn(&scene, &options, 1);
        for tile in [1, 3, 9, 64] {
            let options = options.clone().with_tile(tile).expect("not 0");
            assert_same(&format!("{name}, tiles of {tile}"), &drawn(&scene, &options, 2), &film);
        }
        for (x, y) in (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y))) {
            let told = explain(&scene, &options, [x, y]).expect("a pixel of it");
            let is = |kind, told: &[f32]| {
                let bits = |values: &[f32]| values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
                let drawn = film.at(kind, x, y).expect("a pixel of it");
                assert_eq!(bits(told), bits(drawn), "{name}: {} at ({x}, {y})", kind.name());
            };
            is(LayerKind::Picture, &told.linear.to_array());
            is(LayerKind::Alpha, &[told.alpha]);
            for (term, value) in told.terms.iter() {
                is(LayerKind::Term(term), &value.to_array());
            }
        }
    }
}

#[test]
fn a_lights_layer_has_the_bits_of_a_picture_in_which_all_else_is_dark() {
    let text = include_str!("agreement/lights.toml");
    // So many that they are not all kept at once.
    let more =
        |i: u32| format!("[[light]]\nkind = \"point\"\nposition = [{i}, 4, 5]\ncolor = 0.0{i}\n");
    let text = text.to_owned() + &(1..=12).map(more).collect::<String>();
    let lamp = "v 0 0 0\nv 0.6 0 0\nv 0 0.5 0\nv 0 0 0.4\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
    let source = Memory::new().with("scene.toml", text.into_bytes());
    let source = source.with("lamp.obj", lamp.as_bytes());
    let read = phong_scene::read("scene.toml", None, &source, &Limits::default());
    let lit = read.scene.unwrap_or_else(|| panic!("{:#?}", read.diagnostics));
    let options = RenderOptions::of(&lit.image).expect("checked");
    let count = lit.lights.len() as u32;
    let picture = |scene: &Scene, options: &RenderOptions| {
        drawn(&View::of(scene).expect("compiles"), options, 1)
    };
    for samples in [1, 2] {
        let options = options.clone().with_samples(samples).expect("a few");
        let film = picture(&lit, &options.clone().with_lights(Some(count)));
        for kind in (0..count).map(LayerKind::Light).chain([LayerKind::Unlit]) {
            let mut dark = lit.clone();
            for (number, light) in (0..).zip(&mut dark.lights) {
                if kind != LayerKind::Light(number) {
                    (light.color, light.specular_color) = (Rgb::BLACK, Rgb::BLACK);
                }
            }
            if kind != LayerKind::Unlit {
                dark.image.background = Background::Color(Rgb::BLACK);
                dark.fog = dark.fog.map(|fog| Fog { color: Some(Rgb::BLACK), ..fog });
                for material in &mut dark.materials {
                    material.emission_color = Some(Rgb::BLACK.into());
                    if material.ambient_rule == AmbientRule::Once {
                        material.ambient_color = Some(Rgb::BLACK.into());
                    }
                }
            }
            let alone = picture(&dark, &options);
            let (layer, alone) = (film.layer(kind), alone.layer(LayerKind::Picture));
            let [layer, alone] = [layer, alone].map(|layer| &layer.expect("a layer").values);
            assert_eq!(layer, alone, "{} of {samples}", kind.name());
            assert!(alone.iter().any(|value| *value > 0.0), "{} is seen", kind.name());
        }
    }
}

#[test]
fn without_lights_the_layer_of_the_rest_is_the_picture() {
    let scene = Scene { lights: Vec::new(), ..few_things() };
    let options = RenderOptions::new([21, 13]).expect("a size").with_lights(Some(0));
    let film = drawn(&View::of(&scene).expect("compiles"), &options, 1);
    let [rest, picture] = [LayerKind::Unlit, LayerKind::Picture].map(|kind| film.layer(kind));
    assert_eq!(rest.expect("a layer").values, picture.expect("a layer").values);
}

#[test]
fn layers_of_lights_sum_to_the_picture_and_are_the_same_in_any_cut() {
    let case = &CASES[0];
    let count = case.written.lights.len() as u32;
    let window = Window { x0: 20, y0: 14, x1: 44, y1: 30 };
    // A filter with weights below 0 lets samples cancel, each of which is rounded.
    let options = RenderOptions::of(&case.written.image).expect("checked");
    let options = options.with_window(window).expect("within the picture");
    let plain = options.with_filter(FilterKind::Box).with_terms(TermSet::ALL);
    let without = drawn(&case.scene, &plain, 1);
    let options = plain.with_lights(Some(count));
    let film = drawn(&case.scene, &options, 2);
    let cut = drawn(&case.scene, &options.clone().with_tile(8).expect("a tile"), 1);
    let at = |film: &Film, kind, i: u32| -> Vec<f32> {
        let [x, y] = [window.x0 + i % window.width(), window.y0 + i / window.width()];
        film.at(kind, x, y).expect("a layer").to_vec()
    };
    let lights: Vec<_> = (0..count).map(LayerKind::Light).chain([LayerKind::Unlit]).collect();
    for i in 0..window.width() * window.height() {
        let picture = at(&film, LayerKind::Picture, i);
        assert_eq!(picture, at(&without, LayerKind::Picture, i), "the picture is as it was");
        let (mut sum, mut size) = ([0.0_f64; 3], [0.0_f32; 3]);
        for &kind in &lights {
            let values = at(&film, kind, i);
            assert_eq!(values, at(&cut, kind, i), "{}", kind.name());
            for (channel, value) in values.into_iter().enumerate() {
                sum[channel] += f64::from(value);
                size[channel] += value.abs();
            }
        }
        for channel in 0..3 {
            let ulp = f64::from(size[channel].next_up() - size[channel]);
            let off = (sum[channel] - f64::from(picture[channel])).abs();
            assert!(off <= lights.len() as f64 * ulp, "pixel {i}: {sum:?}, and not {picture:?}");
        }
    }
    let is_seen = |&&kind: &&LayerKind| {
        film.layer(kind).is_some_and(|layer| layer.values.iter().any(|v| *v > 0.0))
    };
    assert!(lights.iter().filter(is_seen).count() > 2, "several lights are seen here");
}
