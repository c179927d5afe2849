//! Lines around things, as pictures show them.
#![expect(clippy::unwrap_used, reason = "in a test, what is not there is a failure")]

use phong::film::LayerKind;
use phong::finish::finish;
use phong::image::Encoding;
use phong::part::Settings;
use phong::render::{Cancel, Lines, RenderOptions, render};
use phong::view::View;
use phong_scene::{Limits, Memory, Scene, read};

/// A picture of 80 × 60 pixels, black where a line of one pixel is and white elsewhere.
const HEAD: &str = "version = 1\n[image]\nsize = [80, 60]\nsamples = 1\nbackground = 1\n\
    [outline]\nwidth = 0.75\n[materials.white]\ncolor = 1\nk_a = 1\nk_d = 0\nk_s = 0\n";
const FLOOR: &str = "[[plane]]\npoint = [0, 0, 0]\nnormal = [0, 1, 0]\nmaterial = \"white\"\n";

fn scene(text: &str) -> Scene {
    let files = Memory::new().with("a.toml", text.as_bytes());
    let reading = read("a.toml", None, &files, &Limits::default());
    reading.scene.unwrap_or_else(|| panic!("{:?}", reading.diagnostics))
}

/// How many pixels of each column lines cover.
fn lines(text: &str) -> Vec<f32> {
    let scene = scene(text);
    let options = RenderOptions::of(&scene.image).unwrap().with_finishing_of(&scene);
    let film = render(&View::of(&scene).unwrap(), &options, &|_| {}, &Cancel::new()).film;
    let finishing = Settings::of(&scene, &options, Encoding::default()).finishing();
    let finished = finish(&film, &finishing);
    let picture = finished.values(LayerKind::Picture).unwrap();
    let covered = |x: usize| (0..60).map(|y| 1.0 - picture[3 * (80 * y + x)]).sum();
    (0..80).map(covered).collect()
}

#[test]
fn a_plane_has_one_line_at_its_horizon_and_none_on_its_slope_whatever_the_camera() {
    let eye = "eye = [0, 1, 6]\nlook_at = [0, 1, 0]\n";
    for kind in [
        "fov = 40".to_owned(),
        "fov = 90".to_owned(),
        "kind = \"panorama\"".to_owned(),
        "kind = \"fisheye\"\nfov = 180".to_owned(),
    ] {
        let columns = lines(&format!("{HEAD}{FLOOR}[camera]\n{eye}{kind}\n"));
        // Beside the middle the circle of a fisheye leaves corners.
        for covered in &columns[36..44] {
            assert!((0.9..1.5).contains(covered), "{kind}: {covered}");
        }
    }
    // Rays side by side that hardly come down meet ground that is far apart.
    let low = "kind = \"orthographic\"\nheight = 20\neye = [0, 15, 20]\nlook_at = [0, 10, -200]\n";
    let columns = lines(&format!("{HEAD}{FLOOR}[camera]\n{low}"));
    assert_eq!(columns, [0.0; 80]);
}

#[test]
fn a_jump_of_the_distance_within_an_object_has_its_line() {
    let camera = "[camera]\neye = [0, 1, 6]\nlook_at = [0, 0, 0]\nfov = 40\n";
    let torus = "[[torus]]\ncenter = [0, 0, 0]\naxis = [0, 1, 0]\nradius = 1.5\ntube = 0.4\nmaterial = \"white\"\n";
    let head = HEAD.replace("[outline]", "[outline]\nobjects = false");
    let columns = lines(&format!("{head}{camera}{torus}"));
    assert!((0.9..1.5).contains(&columns[40]), "its near side before its far one: {}", columns[40]);
}

/// The layers that lines and labels go by, of a ball before a floor and what is added.
fn layers(more: &str) -> [Vec<f32>; 3] {
    let camera = "[camera]\neye = [0, 1, 6]\nlook_at = [0, 1, 0]\nfov = 40\n";
    let ball = "[[sphere]]\ncenter = [0, 1, 0]\nradius = 1\nmaterial = \"white\"\n";
    let scene = scene(&format!("{HEAD}{camera}{FLOOR}{ball}{more}"));
    let options = RenderOptions::of(&scene.image).unwrap().with_aovs(&Lines::NEEDS);
    let film = render(&View::of(&scene).unwrap(), &options, &|_| {}, &Cancel::new()).film;
    Lines::NEEDS.map(|aov| film.layer(LayerKind::Aov(aov)).unwrap().values.to_vec())
}

#[test]
fn what_is_not_there_is_in_no_layer_and_what_is_behind_it_is_as_without_it() {
    let sheet = |keys: &str| {
        format!(
            "[textures.squares]\nkind = \"checker\"\ncolors = [0.1, 0.9]\n[materials.sheet]\n{keys}\n\
             [[disc]]\ncenter = [0, 1, 2]\nnormal = [0.1, 0, 1]\nradius = 2\nmaterial = \"sheet\"\n"
        )
    };
    let without = layers("");
    for keys in ["opacity = 0", "opacity = 0.4\nopacity_mode = \"mask\""] {
        assert!(layers(&sheet(keys)) == without, "{keys}");
    }
    // Of glass and of what is there in part the layers are its own.
    for keys in ["opacity = 0.01", "transmission = 1"] {
        assert!(layers(&sheet(keys))[0].contains(&3.0), "{keys}");
    }
    let holes = layers(&sheet("opacity = { texture = \"squares\" }\nopacity_mode = \"mask\""));
    let is_there = |object: &&f32| **object == 3.0;
    let [all, left] =
        [layers(&sheet("")), holes].map(|[objects, ..]| objects.iter().filter(is_there).count());
    assert!(all > 1000 && left * 10 > all * 3 && left * 10 < all * 7, "{left} of {all}");
}
