//! Fog: what fades, by which distance, and what is told of it.
#![expect(clippy::unwrap_used, reason = "in a test, what is not there is a failure")]

use phong::explain::{End, explain};
use phong::film::{Film, LayerKind};
use phong::render::{Cancel, RenderOptions, render};
use phong::terms::{Term, TermSet};
use phong::view::View;
use phong_scene::{Limits, Memory, Scene, read};

/// One pixel, seen from `eye`, of a wall of 0.8 at a distance of 10 under ambient light alone.
const WALL: &str = "version = 1\n[image]\nsize = [1, 1]\nsamples = 1\nbackground = 0.25\n\
    [camera]\nkind = \"orthographic\"\nheight = 0.001\neye = [0, 0, 10]\nlook_at = [0, 0, 0]\n\
    [materials.wall]\ncolor = 0.8\nk_a = 1\nk_d = 0\nk_s = 0\n\
    [[disc]]\ncenter = [0, 0, 0]\nnormal = [0, 0, 1]\nradius = 100\nmaterial = \"wall\"\n";
/// Everything at once.
const MIXED: &str = include_str!("golden/terms/fog.toml");

fn scene(text: &str) -> Scene {
    let files = Memory::new().with("a.toml", text.as_bytes());
    let reading = read("a.toml", None, &files, &Limits::default());
    reading.scene.unwrap_or_else(|| panic!("{:?}", reading.diagnostics))
}

fn film(text: &str) -> Film {
    let scene = scene(text);
    let options = RenderOptions::of(&scene.image).unwrap().with_terms(TermSet::ALL);
    render(&View::of(&scene).unwrap(), &options, &|_| {}, &Cancel::new()).film
}

/// The ambient term, the fog and the sum, of one pixel.
fn pixel(text: &str) -> [f32; 3] {
    let film = film(text);
    let at = |kind| film.at(kind, 0, 0).unwrap()[0];
    let terms = [LayerKind::Term(Term::Ambient), LayerKind::Term(Term::Fog), LayerKind::Picture];
    terms.map(at)
}

#[track_caller]
fn near(found: [f32; 3], share: f32, light: f32, fog: f32) {
    let expected = [(1.0 - share) * light, share * fog, (1.0 - share) * light + share * fog];
    for (found, expected) in found.into_iter().zip(expected) {
        assert!((found - expected).abs() < 2e-6, "{found} is not {expected}");
    }
}

#[test]
fn each_kind_grows_with_the_distance_as_it_says() {
    let with = |fog: &str| pixel(&format!("{WALL}[fog]\ncolor = 0.5\n{fog}\n"));
    near(with("start = 5\nend = 25"), 0.25, 0.8, 0.5);
    near(with("start = 20\nend = 25"), 0.0, 0.8, 0.5);
    near(with("end = 3"), 1.0, 0.8, 0.5);
    near(with("end = 3\nstrength = 0.75"), 0.75, 0.8, 0.5);
    let e = |x: f32| 1.0 - libm::expf(-x);
    near(with("kind = \"exponential\"\ndensity = 0.07"), e(0.7), 0.8, 0.5);
    near(with("kind = \"exponential-squared\"\ndensity = 0.07"), e(0.49), 0.8, 0.5);
}

#[test]
fn without_a_colour_it_has_that_of_the_background_and_hides_it() {
    near(pixel(&format!("{WALL}[fog]\nend = 20\n")), 0.5, 0.8, 0.25);
    let away = WALL.replace("look_at = [0, 0, 0]", "look_at = [0, 0, 20]");
    let film = film(&format!("{away}[fog]\nend = 20\ncolor = 0.5\nstrength = 0.75\n"));
    let background = film.at(LayerKind::Term(Term::Background), 0, 0).unwrap()[0];
    let sum = film.at(LayerKind::Picture, 0, 0).unwrap()[0];
    assert_eq!((background, sum), (0.0625, 0.4375));
}

#[test]
fn without_a_colour_it_has_that_of_the_skys_horizon() {
    let under = |sky: &str| pixel(&format!("{WALL}[fog]\nend = 20\n[sky]\nkind = {sky}\n"))[1];
    let gradient = "\"gradient\"\nzenith = 0\nhorizon = 0.5\nground = 0\ncolor = 0.5";
    assert_eq!(under(gradient), 0.5 * 0.25);
    assert_eq!(under("\"constant\"\ncolor = 0.7"), 0.5 * 0.7);
    // Wherever the sun is, as bright as it is all around.
    let [east, south] = [[1.0, 0.5, 0.0], [0.0, 0.5, 1.0]]
        .map(|[x, y, z]| under(&format!("\"sun-and-sky\"\nsun = [{x}, {y}, {z}]")));
    assert!(east > 0.1 && (east - south).abs() < 1e-4 * east, "{east} {south}");
}

#[test]
fn over_a_transparent_background_what_is_not_met_has_no_fog() {
    let away = WALL.replace("look_at = [0, 0, 0]", "look_at = [0, 0, 20]");
    let away = away.replace("background = 0.25", "background = \"transparent\"");
    let film = film(&format!("{away}[fog]\nend = 20\ncolor = 0.5\n"));
    assert_eq!(film.at(LayerKind::Picture, 0, 0).unwrap(), [0.0; 3]);
    assert_eq!(film.at(LayerKind::Alpha, 0, 0).unwrap(), [0.0]);
}

#[test]
fn the_distance_is_that_from_the_eye_or_along_the_axis() {
    // Seen 60 degrees off the axis of a wide lens, at twice the distance along it.
    let wide = "version = 1\n[image]\nsize = [3, 3]\nsamples = 1\n\
        [camera]\neye = [0, 0, 10]\nlook_at = [0, 0, 0]\nfov = 137.8\n\
        [materials.wall]\ncolor = 0.8\nk_a = 1\nk_d = 0\nk_s = 0\n\
        [[plane]]\npoint = [0, 0, 0]\nnormal = [0, 0, 1]\nmaterial = \"wall\"\n\
        [fog]\nend = 40\ncolor = 0\n";
    let lights = |text: &str| {
        let film = film(text);
        [[1, 1], [0, 1]].map(|[x, y]| film.at(LayerKind::Picture, x, y).unwrap()[0])
    };
    let [middle, side] = lights(wide);
    assert!((middle - 0.6).abs() < 1e-5 && (side - 0.4).abs() < 1e-3, "{middle} {side}");
    let [middle, side] = lights(&format!("{wide}distance = \"planar\"\n"));
    assert!((middle - 0.6).abs() < 1e-5 && (side - 0.6).abs() < 1e-5, "{middle} {side}");
}

#[test]
fn seen_through_something_or_in_a_mirror_the_way_is_the_whole_one() {
    let sheet = |keys: &str| {
        format!(
            "{WALL}[fog]\nend = 20\ncolor = 0.5\n[materials.s]\nk_a = 0\nk_d = 0\nk_s = 0\n{keys}\n\
             [[disc]]\ncenter = [0, 0, 6]\nnormal = [0, 0, 1]\nradius = 1\nmaterial = \"s\"\n"
        )
    };
    // The first 4 of 10 units and the last 6 together leave a half.
    let film_of = |text: &str| film(text).at(LayerKind::Picture, 0, 0).unwrap()[0];
    let through = film_of(&sheet("opacity = 0"));
    assert!((through - 0.65).abs() < 1e-6, "{through}");
    // There and back: the mirror 4 away, and the back wall 10 behind the eye.
    let behind =
        "[[disc]]\ncenter = [0, 0, 16]\nnormal = [0, 0, 1]\nradius = 9\nmaterial = \"wall\"\n";
    let mirrored = film_of(&format!("{}{behind}", sheet("reflection = 1")));
    assert!((mirrored - (0.3 * 0.8 + 0.7 * 0.5)).abs() < 1e-6, "{mirrored}");
}

#[test]
fn the_explanation_tells_it_and_the_film_is_its_sum() {
    let scene = scene(MIXED);
    let options = RenderOptions::of(&scene.image).unwrap().with_terms(TermSet::ALL);
    let view = View::of(&scene).unwrap();
    let film = render(&view, &options, &|_| {}, &Cancel::new()).film;
    for (x, y) in (0..64).step_by(3).flat_map(|x| (0..48).step_by(4).map(move |y| (x, y))) {
        let told = explain(&view, &options, [x, y]).unwrap();
        let drawn = film.at(LayerKind::Picture, x, y).unwrap();
        assert_eq!(told.linear.to_array(), drawn);
        let sum = Term::ALL.map(|term| film.at(LayerKind::Term(term), x, y).unwrap().to_vec());
        let sum = |c: usize| sum[1..].iter().fold(sum[0][c], |sum, term| sum + term[c]);
        assert_eq!([sum(0), sum(1), sum(2)], drawn);
        for sample in &told.samples {
            let ray = sample.ray.as_ref().unwrap();
            assert_eq!(ray.terms(), sample.terms);
            let fog = ray.fog.unwrap();
            assert_eq!(sample.terms.fog, fog.light);
            if let End::Surface(surface) = &ray.end {
                assert_eq!(sample.terms.ambient, surface.terms.ambient * fog.clear);
            }
        }
    }
    for (tile, threads) in [(1, 2), (64, 3)] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let options = options.clone().with_tile(tile).unwrap();
        let other = pool.install(|| render(&view, &options, &|_| {}, &Cancel::new())).film;
        assert!(film.layers == other.layers, "tiles of {tile}");
    }
}
