//! Ambient occlusion: how much of the ambient light finds its way, against what can be worked out by hand.
#![expect(clippy::unwrap_used, reason = "in a test, what is not there is a failure")]

use phong::aov::Aov;
use phong::explain::{End, Openness, explain};
use phong::film::{Film, LayerKind, Window};
use phong::render::{Cancel, RenderOptions, render};
use phong::terms::{Term, TermSet};
use phong::view::View;
use phong_scene::{Limits, Memory, Scene, read};

/// A floor seen from straight above, under whatever is added.
const FLOOR: &str = "version = 1\n[image]\nsize = [4, 4]\nsamples = 1\n\
    [camera]\nkind = \"orthographic\"\nheight = 0.001\neye = [0, 0.5, 0]\nlook_at = [0, 0, 0]\nup = [0, 0, -1]\n\
    [materials.default]\nk_a = 0.5\ncolor = 1\n[[plane]]\npoint = [0, 0, 0]\nnormal = [0, 1, 0]\n";

/// Everything at once: a mirror, ambient light by each light, several samples a pixel.
const MIXED: &str = include_str!("golden/terms/occlusion.toml");

fn scene(text: &str) -> Scene {
    let files = Memory::new().with("a.toml", text.as_bytes());
    let reading = read("a.toml", None, &files, &Limits::default());
    reading.scene.unwrap_or_else(|| panic!("{:?}", reading.diagnostics))
}

fn options(scene: &Scene) -> RenderOptions {
    let options = RenderOptions::of(&scene.image).unwrap();
    options.with_terms(TermSet::ALL).with_aovs(&[Aov::Openness])
}

fn film(text: &str, change: impl FnOnce(RenderOptions) -> RenderOptions) -> Film {
    let scene = scene(text);
    let options = change(options(&scene));
    render(&View::of(&scene).unwrap(), &options, &|_| {}, &Cancel::new()).film
}

fn layer(film: &Film, kind: LayerKind) -> &[f32] {
    &film.layer(kind).unwrap().values
}

/// The mean openness of the floor.
fn openness(text: &str) -> f32 {
    let film = film(text, |options| options);
    let shares = layer(&film, LayerKind::Aov(Aov::Openness));
    shares.iter().sum::<f32>() / shares.len() as f32
}

#[test]
fn under_the_open_sky_the_ambient_term_is_as_without_occlusion() {
    let film = film(&format!("{FLOOR}[ambient_occlusion]\n"), |options| options);
    assert!(layer(&film, LayerKind::Aov(Aov::Openness)).iter().all(|&share| share == 1.0));
    assert!(layer(&film, LayerKind::Term(Term::Ambient)).iter().all(|&v| v == 0.5));
}

#[test]
fn a_disc_overhead_takes_the_light_that_a_matt_surface_would_weigh_it_by() {
    // Seen at 45 degrees from its middle, a disc takes sin² 45° of it.
    let over = |samples: u32, distance: &str| {
        openness(&format!(
            "{FLOOR}[[disc]]\ncenter = [0, 1, 0]\nnormal = [0, 1, 0]\nradius = 1\n\
             [ambient_occlusion]\nsamples = {samples}\ndistance = {distance}\n"
        ))
    };
    assert!((over(1024, "10") - 0.5).abs() < 0.01, "{}", over(1024, "10"));
    assert!((over(16, "10") - 0.5).abs() < 0.05, "{}", over(16, "10"));
    assert_eq!(over(64, "0.99"), 1.0, "nothing is that near");
    // To the rim it is √2, so within 1.2 there is a smaller disc of it, at sin² = 1 − 1 / 1.44.
    assert!((over(1024, "1.2") - 1.0 / 1.44).abs() < 0.01, "{}", over(1024, "1.2"));
}

#[test]
fn by_itself_the_distance_follows_the_size_of_the_scene() {
    let heap = |size: f64, distance: &str| {
        let floor = FLOOR.replace("[0, 0.5, 0]", &format!("[0, {}, 0]", 0.5 * size));
        let floor = floor.replace("height = 0.001", &format!("height = {}", 0.001 * size));
        openness(&format!(
            "{floor}[[sphere]]\ncenter = [{c}, {c}, 0]\nradius = {r}\n\
             [ambient_occlusion]\nsamples = 64\n{distance}",
            c = 0.6 * size,
            r = 0.5 * size,
        ))
    };
    let small = heap(1.0, "");
    assert!(small > 0.5 && small < 0.97, "{small}");
    for size in [1e-3, 1e3] {
        assert!((heap(size, "") - small).abs() < 0.02, "{size}: {}, {small}", heap(size, ""));
    }
    // The box is about as long in all directions: a quarter of its diagonal.
    let by_hand = heap(1.0, &format!("distance = {}", 0.25 * 3_f64.sqrt()));
    assert!((by_hand - small).abs() < 0.01, "{by_hand}, {small}");
}

#[test]
fn where_nothing_casts_shadows_all_ambient_light_finds_its_way() {
    let film = film(MIXED, |options| options.with_shadows(false));
    let depths = layer(&film, LayerKind::Aov(Aov::Openness));
    assert!(depths.iter().all(|&share| share == 1.0 || share == 0.0));
}

#[test]
fn where_nothing_casts_shadows_no_ray_to_the_sky_is_traced_or_counted() {
    let scene = Scene { sky: Some(phong_scene::Sky::default()), ..scene(FLOOR) };
    let view = View::of(&scene).unwrap();
    let counted = |shadows: bool| {
        let options = options(&scene).with_shadows(shadows);
        render(&view, &options, &|_| {}, &Cancel::new()).rays.shadow
    };
    assert!(counted(true) > 0);
    assert_eq!(counted(false), 0);
}

#[test]
fn the_bits_do_not_depend_on_tiles_threads_and_crops() {
    let whole = film(MIXED, |options| options);
    let shares = layer(&whole, LayerKind::Aov(Aov::Openness));
    assert!(shares.iter().any(|&share| share > 0.0 && share < 0.7), "something is occluded");
    for (tile, threads) in [(1, 2), (7, 1), (64, 3)] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let other = pool.install(|| film(MIXED, |options| options.with_tile(tile).unwrap()));
        for (a, b) in whole.layers.iter().zip(&other.layers) {
            assert_eq!(a, b, "tiles of {tile}");
        }
    }
    let window = Window { x0: 20, y0: 17, x1: 45, y1: 33 };
    let crop = film(MIXED, |options| options.with_window(window).unwrap());
    for (x, y) in [(20, 17), (31, 22), (44, 32)] {
        for layer in &whole.layers {
            assert_eq!(whole.at(layer.kind, x, y), crop.at(layer.kind, x, y), "{:?}", layer.kind);
        }
    }
}

#[test]
fn the_explanation_tells_it_and_its_parts_are_the_pixel() {
    let scene = scene(MIXED);
    let (view, options) = (View::of(&scene).unwrap(), options(&scene));
    let film = render(&view, &options, &|_| {}, &Cancel::new()).film;
    let mut told = 0;
    for (x, y) in (0..64).step_by(5).flat_map(|x| (0..48).step_by(5).map(move |y| (x, y))) {
        let explained = explain(&view, &options, [x, y]).unwrap();
        let drawn = film.at(LayerKind::Term(Term::Ambient), x, y).unwrap();
        assert_eq!(explained.terms.ambient.to_array(), drawn, "({x}, {y})");
        for sample in &explained.samples {
            let Some(End::Surface(surface)) = sample.ray.as_ref().map(|ray| &ray.end) else {
                continue;
            };
            let Openness { share, rays, distance, .. } = surface.openness.unwrap();
            assert_eq!((rays, distance), (9, 1.5));
            let by_hand = surface.material.k_a * surface.c_a * share;
            let lights = surface.lights.iter().map(|lit| lit.ambient);
            let sum = lights.fold(surface.ambient, |sum, more| sum + more);
            assert_eq!(sum, surface.terms.ambient);
            let off = (surface.ambient.g - by_hand.g).abs();
            assert!(off <= 1e-6, "{} is not {}", surface.ambient.g, by_hand.g);
            told += 1;
        }
    }
    assert!(told > 100, "{told}");
}
