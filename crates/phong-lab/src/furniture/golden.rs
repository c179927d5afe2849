//! A figure with all its furniture, as its PNG has it, against the pictures under `tests/furniture`: no value may
//! differ. `PHONG_BLESS=1` writes them anew; look at them before committing.

use std::fs;
use std::io::Cursor;
use std::path::Path;

use phong::film::LayerKind;
use phong::image::{self, Content, Encoding, Format, Picture};
use phong::part::Settings;
use phong::render::{Cancel, RenderOptions, render};
use phong::view::View;
use phong_scene::{Folder, Limits};

use super::finish;

/// The PNG of the figure in so many times its size, points being as many times larger.
fn drawn(scene: &Path, times: u32) -> Vec<u8> {
    let reading = phong_scene::read(&scene.to_string_lossy(), None, &Folder, &Limits::default());
    // That it has no lights is told.
    let mut scene = reading.scene.unwrap_or_else(|| panic!("{:#?}", reading.diagnostics));
    scene.image.size = scene.image.size.map(|side| side * times);
    scene.image.dpi = scene.image.dpi.map(|dpi| dpi * f64::from(times));
    let options = RenderOptions::of(&scene.image).unwrap().with_finishing_of(&scene);
    let film = render(&View::of(&scene).unwrap(), &options, &|_| {}, &Cancel::new()).film;
    let (encoding, mut bytes) = (Encoding::default(), Cursor::new(Vec::new()));
    let finished = finish(&film, &Settings::of(&scene, &options, encoding));
    let picture = Content::Layer(LayerKind::Picture);
    image::write(&finished, picture, Format::Png, &encoding, &mut bytes).unwrap();
    bytes.into_inner()
}

#[track_caller]
fn hold(times: u32, name: &str) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/furniture");
    let actual = drawn(&folder.join("figure.toml"), times);
    let golden = folder.join(name);
    let decoded = |bytes: &[u8]| Picture::read(bytes).unwrap();
    let values = |picture: &Picture| -> Vec<f32> {
        picture.planes.iter().flat_map(|plane| plane.values.iter().copied()).collect()
    };
    if std::env::var_os("PHONG_BLESS").is_some_and(|v| v == "1") {
        return fs::write(golden, actual).unwrap();
    }
    let expected = fs::read(&golden).unwrap_or_else(|e| panic!("{}: {e}", golden.display()));
    let [actual, expected] = [&actual, &expected].map(|bytes| decoded(bytes));
    assert_eq!((actual.size, actual.planes.len()), (expected.size, expected.planes.len()));
    let [actual, expected] = [values(&actual), values(&expected)];
    let apart = actual.iter().zip(&expected).map(|(a, b)| (a - b).abs());
    let (count, most) =
        apart.filter(|d| *d > 0.0).fold((0, 0.0), |(n, most), d: f32| (n + 1, d.max(most)));
    assert_eq!(count, 0, "{name}: so many values differ, by {} of 255 at most", 255.0 * most);
}

#[test]
fn a_figure_is_as_it_was() {
    hold(1, "figure.png");
}

#[test]
fn a_figure_three_times_as_large_is_the_same_and_as_sharp() {
    hold(3, "figure-3x.png");
}
