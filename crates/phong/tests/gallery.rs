//! The gallery: every scene under `scenes/` reads without a word and gives a picture worth a look.

use std::fs;
use std::path::Path;

use phong::film::LayerKind;
use phong::render::{Cancel, RenderOptions, render};
use phong::view::View;
use phong_scene::{Folder, Image, Limits, srgb_encode};

/// What a small picture is like, as the eye has it: sRGB values.
struct Look {
    mean: f64,
    deviation: f64,
    /// Share of pixels in which every channel is over 1.
    burnt: f64,
}

fn look(path: &Path) -> Look {
    let reading = phong_scene::read(&path.to_string_lossy(), None, &Folder, &Limits::default());
    assert!(reading.diagnostics.is_empty(), "{:#?}", reading.diagnostics);
    let scene = reading.scene.expect("a scene, for there is no error");
    let size = scene.image.size.map(|side| side.div_ceil(8));
    let image = Image { size, samples: 1, ..scene.image };
    let options = RenderOptions::of(&image).expect("the scene has been checked");
    let compiled = View::of(&scene).expect("compiles");
    let film = render(&compiled, &options, &|_| {}, &Cancel::new()).film;
    let picture = &film.layer(LayerKind::Picture).expect("a picture").values;
    let n = picture.len() as f64;
    let clamped = picture.iter().map(|v| f64::from(v.clamp(0.0, 1.0)));
    let seen: Vec<f64> = clamped.map(srgb_encode).collect();
    let mean = seen.iter().sum::<f64>() / n;
    let deviation = (seen.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / n).sqrt();
    let burnt = picture.chunks_exact(3).filter(|p| p.iter().all(|v| *v > 1.0)).count();
    Look { mean, deviation, burnt: burnt as f64 * 3.0 / n }
}

#[test]
fn every_scene_is_neither_dark_nor_burnt_nor_empty() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let mut seen = 0;
    for entry in fs::read_dir(folder).expect("the gallery") {
        let path = entry.expect("an entry").path();
        if path.extension().is_none_or(|e| e != "toml") {
            continue;
        }
        seen += 1;
        let name = path.display();
        let Look { mean, deviation, burnt } = look(&path);
        assert!((0.1..0.9).contains(&mean), "{name}: mean {mean}");
        assert!(deviation > 0.06, "{name}: deviation {deviation}");
        assert!(burnt < 0.02, "{name}: {burnt} of the pixels are burnt out");
    }
    assert!(seen >= 12, "only {seen} scenes");
}
