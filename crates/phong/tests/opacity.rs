//! Opacity: surfaces of which a share is there, worked out by hand.
#![expect(clippy::unwrap_used, reason = "in a test, what is not there is a failure")]

use phong::explain::{End, Surface, explain};
use phong::film::LayerKind;
use phong::render::{Cancel, RenderOptions, render};
use phong::terms::{Term, TermSet};
use phong::view::View;
use phong_scene::{Limits, Memory, Rgb, Scene, read};

/// One pixel that looks down −z; light as told, and behind everything a wall of 0.5.
const HEAD: &str = "version = 1\n[camera]\nkind = \"orthographic\"\nheight = 0.001\neye = [0, 0, 10]\n\
    look_at = [0, 0, 0]\n[image]\nsize = [1, 1]\nsamples = 1\n";
const WALL: &str = "[materials.wall]\ncolor = 0.5\nk_a = 1\nk_d = 0\nk_s = 0\n\
    [[plane]]\npoint = [0, 0, -1]\nnormal = [0, 0, 1]\nmaterial = \"wall\"\n";
/// Everything at once, over a transparent background.
const MIXED: &str = include_str!("golden/materials/opacity.toml");

fn scene(text: &str) -> Scene {
    let files = Memory::new().with("a.toml", text.as_bytes());
    let reading = read("a.toml", None, &files, &Limits::default());
    reading.scene.unwrap_or_else(|| panic!("{:?}", reading.diagnostics))
}

/// The pixel and its alpha.
fn pixel(text: &str) -> ([f32; 3], f32) {
    let scene = scene(text);
    let options = RenderOptions::of(&scene.image).unwrap();
    let film = render(&View::of(&scene).unwrap(), &options, &|_| {}, &Cancel::new()).film;
    let at = |kind| film.at(kind, 0, 0).unwrap().to_vec();
    let picture = at(LayerKind::Picture);
    ([picture[0], picture[1], picture[2]], at(LayerKind::Alpha)[0])
}

fn near(text: &str, expected: f32) {
    let ([red, ..], _) = pixel(text);
    assert!((red - expected).abs() < 1e-6, "{red} is not {expected}:\n{text}");
}

/// A sheet of 1 across the ray, of this material.
fn sheet(keys: &str, z: f64, name: &str) -> String {
    format!(
        "[materials.{name}]\ncolor = 1\nk_a = 1\nk_d = 0\nk_s = 0\n{keys}\n\
         [[disc]]\ncenter = [0, 0, {z}]\nnormal = [0, 0, 1]\nradius = 1\nmaterial = \"{name}\"\n"
    )
}

#[test]
fn what_is_behind_counts_what_of_the_surface_is_not_there() {
    near(&format!("{HEAD}{WALL}{}", sheet("opacity = 0.25", 0.0, "a")), 0.25 + 0.75 * 0.5);
    near(&format!("{HEAD}{WALL}{}", sheet("opacity = 0", 0.0, "a")), 0.5);
    near(&format!("{HEAD}{WALL}{}", sheet("opacity = 1", 0.0, "a")), 1.0);
    let two = [sheet("opacity = 0.5", 0.0, "a"), sheet("opacity = 0.25", 1.0, "b")].concat();
    near(&format!("{HEAD}{WALL}{two}"), 0.25 + 0.75 * (0.5 + 0.5 * 0.5));
}

#[test]
fn a_ray_passes_many_surfaces_whatever_the_depth() {
    let many: String =
        (0..40).map(|i| sheet("opacity = 0", 0.1 * f64::from(i), &format!("m{i}"))).collect();
    near(&format!("{HEAD}depth = 0\n{WALL}{many}"), 0.5);
}

#[test]
fn alpha_is_what_of_the_surfaces_is_there_over_a_transparent_background() {
    let head = format!("{HEAD}background = \"transparent\"\n");
    let ([red, ..], alpha) = pixel(&format!("{head}{}", sheet("opacity = 0.25", 0.0, "a")));
    assert_eq!((red, alpha), (0.25, 0.25));
    let two = [sheet("opacity = 0.5", 0.0, "a"), sheet("opacity = 0.25", 1.0, "b")].concat();
    let ([red, ..], alpha) = pixel(&format!("{head}{two}"));
    assert!((red - 0.625).abs() < 1e-6 && (alpha - 0.625).abs() < 1e-6, "{red} {alpha}");
    // Half of it glass that is not bent: what is not there and what is let through add up.
    let glass = "opacity = 0.5\ntransmission = 0.5\nior = 1\nfresnel = false\nk_a = 0.5";
    let glass = sheet(glass, 0.0, "a").replacen("k_a = 1\n", "", 1);
    let (_, alpha) = pixel(&format!("{head}{glass}"));
    assert!((alpha - 0.25).abs() < 1e-6, "{alpha}");
}

#[test]
fn a_background_that_runs_down_the_picture_is_seen_through_where_it_is() {
    let head = format!("{HEAD}background = {{ top = 0, bottom = 0.8 }}\n");
    near(&format!("{head}{}", sheet("opacity = 0.25", 0.0, "a")), 0.25 + 0.75 * 0.4);
}

#[test]
fn seen_at_an_angle_a_surface_may_be_denser() {
    // Seen from the front: (½ + ½ cos(π (1 − 0.5)))² = ¼.
    let sheet = sheet("opacity = 0.5\nopacity_mode = \"angle\"", 0.0, "a");
    near(&format!("{HEAD}{WALL}{sheet}"), 0.25 + 0.75 * 0.5);
    let leaning = sheet.replace("normal = [0, 0, 1]", "normal = [0, 1, 0.001]");
    let ([red, ..], _) = pixel(&format!("{HEAD}{WALL}{leaning}"));
    assert!(red > 0.99, "{red}");
}

#[test]
fn only_so_many_surfaces_are_seen() {
    let stack = |surfaces: &str| {
        let keys = format!("opacity = 0.5\n{surfaces}");
        let sheets: String = (0..3).map(|i| sheet(&keys, f64::from(i), &format!("m{i}"))).collect();
        format!("{HEAD}{WALL}{sheets}")
    };
    near(&stack("surfaces = 1"), 0.5 + 0.5 * 0.5);
    near(&stack("surfaces = 2"), 0.75 + 0.25 * 0.5);
    near(&stack(""), 0.875 + 0.125 * 0.5);
}

/// A floor under a lamp, with a sheet between; the pixel looks at the floor from the side.
fn shaded(keys: &str) -> Rgb {
    let head = HEAD.replace("look_at = [0, 0, 0]", "look_at = [0, -1, 0]\nup = [0, 1, 0]");
    let text = format!(
        "{head}[materials.floor]\ncolor = 1\nk_a = 0\nk_d = 1\nk_s = 0\n\
         [materials.s]\ncolor = 0.5\n{keys}\n\
         [[plane]]\npoint = [0, -1, 0]\nnormal = [0, 1, 0]\nmaterial = \"floor\"\n\
         [[disc]]\ncenter = [0, 1, 0]\nnormal = [0, 1, 0]\nradius = 0.5\nmaterial = \"s\"\n\
         [[light]]\nkind = \"distant\"\ndirection = [0, -1, 0]\n"
    );
    let (rgb, _) = pixel(&text);
    Rgb::from(rgb)
}

#[test]
fn light_goes_on_through_what_is_not_there_and_through_filtered_glass() {
    assert_eq!(shaded("opacity = 0.25"), Rgb::grey(0.75));
    assert_eq!(shaded("opacity = 0.25\nshadow = \"full\""), Rgb::BLACK);
    assert_eq!(shaded("opacity = 1"), Rgb::BLACK);
    let glass = "transmission = [0.5, 0.25, 1]\nreflection = 1\n";
    assert_eq!(shaded(glass), Rgb::BLACK);
    assert_eq!(shaded(&format!("{glass}shadow = \"filtered\"")), Rgb::new(0.5, 0.25, 1.0));
}

#[test]
fn a_ball_takes_light_twice_where_it_goes_in_and_where_it_comes_out() {
    let scene = scene(&format!(
        "{}{WALL}[materials.s]\nopacity = 0.5\n[[sphere]]\ncenter = [0, 0, 3]\nradius = 1\nmaterial = \"s\"\n\
         [[light]]\nkind = \"distant\"\ndirection = [0, 0, -1]\n",
        HEAD.replace("eye = [0, 0, 10]", "eye = [0, 0, 1]")
    ));
    let options = RenderOptions::of(&scene.image).unwrap();
    let told = explain(&View::of(&scene).unwrap(), &options, [0, 0]).unwrap();
    let End::Surface(wall) = &told.samples[0].ray.as_ref().unwrap().end else { panic!("a wall") };
    let lit = &wall.lights[0];
    assert!(lit.visible && lit.blocker.as_ref().is_some_and(|b| b.object == "sphere 1"));
    assert_eq!(lit.visibility, Rgb::grey(0.25));
}

#[test]
fn ambient_light_finds_its_way_through_what_is_not_there() {
    let occlusion = "[ambient_occlusion]\nsamples = 64\ndistance = 4\n";
    // A roof far larger than how far the rays look.
    let roof = |opacity: f64| {
        let text = format!(
            "{HEAD}{WALL}{occlusion}[materials.r]\nopacity = {opacity}\n\
             [[disc]]\ncenter = [0, 0, -0.5]\nnormal = [0, 0, 1]\nradius = 100\nmaterial = \"r\"\n"
        );
        let text = text.replace("eye = [0, 0, 10]", "eye = [0, 0, -0.7]");
        let text = text.replace("look_at = [0, 0, 0]", "look_at = [0, 0, -1]");
        pixel(&text).0[0]
    };
    let (open, half, closed) = (roof(0.0), roof(0.5), roof(1.0));
    assert_eq!(open, 0.5);
    assert!(closed < 0.1 && (half - f32::midpoint(open, closed)).abs() < 1e-5, "{half} {closed}");
}

fn parts_add_up(surface: &Surface, sum_of_rays: &mut u32) {
    let cover = surface.cover;
    let emission = surface.material.k_e * surface.c_e() * cover;
    let mut sum = surface.terms;
    (sum.ambient, sum.emission) = (surface.ambient, emission);
    (sum.diffuse, sum.specular) = (Rgb::BLACK, Rgb::BLACK);
    (sum.reflection, sum.transmission) = (Rgb::BLACK, Rgb::BLACK);
    for lit in &surface.lights {
        sum.ambient += lit.ambient;
        sum.diffuse += lit.diffuse;
        sum.specular += lit.specular;
    }
    for (onward, term) in [
        (&surface.reflection, Term::Reflection),
        (&surface.transmission, Term::Transmission),
        (&surface.through, Term::Transmission),
    ] {
        let Some(onward) = onward else { continue };
        let ray = onward.ray.as_ref();
        assert_eq!(onward.light, ray.map(|ray| ray.terms().total()).unwrap_or_default());
        sum[term] += onward.weight * onward.light;
        if let Some(End::Surface(next)) = ray.map(|ray| &ray.end) {
            parts_add_up(next, sum_of_rays);
        }
        *sum_of_rays += 1;
    }
    assert_eq!(sum, surface.terms);
}

#[test]
fn the_explanation_is_the_pixel_and_its_parts_add_up() {
    let scene = scene(MIXED);
    let options = RenderOptions::of(&scene.image).unwrap().with_terms(TermSet::ALL);
    let view = View::of(&scene).unwrap();
    let film = render(&view, &options, &|_| {}, &Cancel::new()).film;
    let mut rays = 0;
    for (x, y) in (0..64).step_by(3).flat_map(|x| (0..48).step_by(4).map(move |y| (x, y))) {
        let told = explain(&view, &options, [x, y]).unwrap();
        assert_eq!(told.linear.to_array(), film.at(LayerKind::Picture, x, y).unwrap());
        assert_eq!([told.alpha], film.at(LayerKind::Alpha, x, y).unwrap());
        for sample in &told.samples {
            let Some(End::Surface(surface)) = sample.ray.as_ref().map(|ray| &ray.end) else {
                continue;
            };
            assert_eq!(surface.terms, sample.terms);
            parts_add_up(surface, &mut rays);
        }
    }
    assert!(rays > 300, "{rays}");
    for (tile, threads) in [(1, 2), (64, 3)] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let options = options.clone().with_tile(tile).unwrap();
        let other = pool.install(|| render(&view, &options, &|_| {}, &Cancel::new())).film;
        assert!(film.layers == other.layers, "tiles of {tile}");
    }
}
