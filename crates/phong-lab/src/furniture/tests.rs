use phong::film::Window;
use phong::image::Encoding;
use phong::render::{Cancel, RenderOptions, render};
use phong::view::View;
use phong_scene::{CameraKind, Limits, Memory, read};

use super::*;

const BALL: &str = "version = 1\n[image]\nsize = [96, 64]\nsamples = 1\n[camera]\neye = [0, 0, 5]\n\
                    look_at = [0, 0, 0]\n[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\n";

fn scene(furniture: &str) -> Scene {
    let text = format!("{BALL}{furniture}");
    let files = Memory::new().with("a.toml", text.as_bytes());
    let reading = read("a.toml", None, &files, &Limits::default());
    assert!(reading.scene.is_some(), "{:?}", reading.diagnostics);
    reading.scene.unwrap()
}

fn drawn(scene: &Scene, window: Option<Window>) -> (Film, Settings) {
    let options = RenderOptions::of(&scene.image).unwrap().with_finishing_of(scene);
    let options = match window {
        Some(window) => options.with_window(window).unwrap(),
        None => options,
    };
    let view = View::of(scene).unwrap();
    let film = render(&view, &options, &|_| {}, &Cancel::new()).film;
    (film, Settings::of(scene, &options, Encoding::default()))
}

/// Red of every pixel as it is seen.
fn seen(film: &Film, settings: &Settings) -> Vec<f32> {
    let finished = finish(film, settings);
    let picture = finished.values(LayerKind::Picture).unwrap();
    picture.iter().step_by(3).copied().collect()
}

const ALL: &str = "[title]\ntext = \"T\"\n[scale_bar]\n[axes]\n[legend]\nmap = \"viridis\"\n\
                   [[label]]\ntext = \"L\"\nat = [0, 0, 1]\n";

#[test]
fn furniture_is_drawn_and_the_film_is_as_it_was() {
    let (film, settings) = drawn(&scene(ALL), None);
    let before = film.clone();
    let finished = finish(&film, &settings);
    assert_eq!(finished.film().layer(LayerKind::Picture), before.layer(LayerKind::Picture));
    assert_eq!(finished.film().layers.len(), 2, "what labels need is not shown");
    let plain = film.layer(LayerKind::Picture).unwrap().values.iter().step_by(3);
    let changed = seen(&film, &settings).iter().zip(plain).filter(|(a, b)| a != b).count();
    assert!(changed > 300, "{changed} pixels");
}

#[test]
fn a_part_of_a_picture_has_the_furniture_of_the_whole() {
    let scene = scene(ALL);
    let (film, settings) = drawn(&scene, None);
    let whole = seen(&film, &settings);
    let window = Window { x0: 20, y0: 10, x1: 90, y1: 60 };
    let (film, settings) = drawn(&scene, Some(window));
    let part = seen(&film, &settings);
    for (i, value) in part.iter().enumerate() {
        let (x, y) = (20 + i % 70, 10 + i / 70);
        assert_eq!(*value, whole[y * 96 + x], "{x} {y}");
    }
}

#[test]
fn a_label_is_hidden_by_what_stands_before_its_point() {
    let label = |at: &str, more: &str| {
        let text = format!("[[label]]\ntext = \"L\"\nat = {at}\n{more}\n");
        let scene = scene(&text);
        let (film, settings) = drawn(&scene, None);
        !finishing(&film, &settings).patches.is_empty()
    };
    assert!(label("[0, 0, 1]", ""), "on the ball, before its middle");
    assert!(!label("[0, 0, 0]", ""), "in the ball");
    assert!(label("[0, 0, 0]", "radius = 1"), "the ball is its own");
    assert!(!label("[0, 0, -1]", ""), "behind it");
    assert!(label("[0, 0, -1]", "hidden = \"never\""));
    assert!(!label("[0, 0, 9]", "hidden = \"never\""), "behind the eye");
    assert!(!label("[40, 0, 0]", "hidden = \"never\""), "beside the picture");
    assert!(label("[1.5, 0, -1]", ""), "nothing is before it");
}

#[test]
fn cameras_that_look_around_have_labels_too() {
    for kind in [CameraKind::Fisheye { fov: 120.0 }, CameraKind::Panorama] {
        let label = |at: &str, more: &str| {
            let mut scene = scene(&format!("[[label]]\ntext = \"L\"\nat = {at}\n{more}\n"));
            scene.camera.kind = kind;
            let (film, settings) = drawn(&scene, None);
            let patches = finishing(&film, &settings).patches;
            patches.first().map(|patch| patch.window)
        };
        assert!(label("[0, 0, 1]", "").is_some(), "{kind:?}: on the ball");
        assert_eq!(label("[0, 0, -1]", ""), None, "{kind:?}: behind it");
        assert!(label("[0, 0, -1]", "hidden = \"never\"").is_some(), "{kind:?}");
        let behind = label("[3, 0, 7]", "hidden = \"never\"");
        assert_eq!(behind.is_some(), kind == CameraKind::Panorama, "it looks behind itself");
    }
}

#[test]
fn what_is_put_together_has_the_furniture_of_its_settings() {
    let (film, settings) = drawn(&scene(ALL), None);
    let finished = finish(&film, &settings);
    let settled = settled(&film, settings.clone());
    assert_eq!(settled.furniture().unwrap().furniture.labels[0].hidden, Hidden::Never);
    // As the picture of another program keeps it: lines in the film, and furniture beside it.
    let own = phong::finish(&film, &settings.finishing()).into_film();
    let again = finish(&own, &settled);
    assert_eq!(again.values(LayerKind::Picture), finished.values(LayerKind::Picture));
}

#[test]
fn an_svg_is_the_picture_with_outlines_over_it() {
    let (film, settings) = drawn(&scene(ALL), None);
    let svg = svg(&film, &settings, &Encoding::default()).unwrap();
    assert!(svg.starts_with("<svg") && svg.ends_with("</svg>\n"));
    assert!(svg.contains("<title>T</title>") && svg.contains("data:image/png;base64,"));
    assert!(
        svg.contains("<linearGradient") && svg.matches("<g role").count() == 5,
        "{}",
        svg.len()
    );
    assert!(!svg.contains("<text"), "letters are outlines");
}

#[test]
fn letters_that_the_font_lacks_and_bars_without_a_scale_are_told() {
    let told = |text: &str| {
        warnings(&scene(text)).into_iter().map(|said| said.message).collect::<Vec<_>>()
    };
    assert_eq!(told(ALL), [""; 0]);
    assert_eq!(
        told("[title]\ntext = \"水 a\"\n[[label]]\ntext = \"≪\"\nat = [0, 0, 0]\n"),
        [
            "title: the font has no 水 (U+6C34), left out",
            "label 1: the font has no ≪ (U+226A), left out"
        ]
    );
    // A legend has its unit from its texture.
    let map = "[legend]\n[textures.t]\nkind = \"map\"\nof = \"height\"\nrange = [-1, 1]\n\
               stops = \"coolwarm\"\nunit = \"米\"\n[materials.m]\ncolor = { texture = \"t\" }\n\
               [[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"m\"\n";
    assert_eq!(told(map), ["legend: the font has no 米 (U+7C73), left out"]);
    let mut around = scene("[scale_bar]\n");
    around.camera.kind = CameraKind::Panorama;
    assert_eq!(warnings(&around).len(), 1);
    let (film, settings) = drawn(&around, None);
    assert!(finishing(&film, &settings).patches.is_empty());
}

#[test]
fn furniture_without_room_is_told() {
    let told = |text: &str| {
        let mut scene = scene(text);
        scene.camera.kind = CameraKind::Orthographic { height: 6.0 };
        crowded(&scene).into_iter().map(|said| said.to_string()).collect::<Vec<_>>()
    };
    let small = "[furniture]\nsize = 4\nmargin = 2\n";
    assert_eq!(
        told(&format!("{small}[title]\ntext = \"T\"\n[scale_bar]\n[axes]\nlength = 9\n")),
        [""; 0]
    );
    let long = told(&format!("{small}[scale_bar]\nlength = 50\n"));
    assert!(
        long.len() == 1 && long[0].contains("it is 533 pixels long in a picture of 96"),
        "{long:?}"
    );
    let short = told(&format!("{small}[scale_bar]\nlength = 1e-9\n"));
    assert!(short.len() == 1 && short[0].contains("shorter than a pixel"), "{short:?}");
    assert!(long[0].contains("`length = 2` fits") && short[0].contains("`length = 2` fits"));
    let wide = told("[title]\ntext = \"Benzenehexacarboxylicacid\"\n");
    assert!(
        wide.len() == 1 && wide[0].contains("title: it reaches out of the picture"),
        "{wide:?}"
    );
    let over = told("[title]\ntext = \"a title\"\n[axes]\nplace = \"top-right\"\nlength = 24\n");
    assert!(over.len() == 1 && over[0].contains("axes: it stands over the title"), "{over:?}");
}

#[test]
fn furniture_of_any_size_is_bounded_by_the_picture() {
    let text =
        "[furniture]\nsize = 1000\n[title]\ntext = \"WWWWWWWW\"\n[scale_bar]\nlength = 1e17\n\
                [axes]\nlength = 1000\n[legend]\nmap = \"grey\"\n"
            .replace("\"grey\"", "[[0, 0], [1, 1]]");
    let mut scene = scene(&text);
    scene.image.dpi = Some(1e17);
    let (film, settings) = drawn(&scene, None);
    for patch in finishing(&film, &settings).patches {
        assert!(patch.window.fits([96, 64]) && patch.pixels.len() as u64 == patch.window.pixels());
    }
}

#[test]
fn many_labels_as_large_as_the_picture_take_a_few_pictures_of_memory() {
    let label = "[[label]]\ntext = \"WW\"\nat = [0, 0, 1]\n";
    let scene = scene(&format!("[furniture]\nsize = 900\n{}", label.repeat(40)));
    let (film, settings) = drawn(&scene, None);
    let patches = finishing(&film, &settings).patches;
    let pixels: u64 = patches.iter().map(|patch| patch.window.pixels()).sum();
    assert!(patches.len() > 1 && pixels <= 3 * 96 * 64, "{} {pixels}", patches.len());
    assert!(patches.iter().all(|patch| patch.window.fits([96, 64])));
}
