//! Patterns and maps of numbers: what is told of them is what is drawn, and far away they are even.

use phong::aov::Aov;
use phong::explain::{End, explain};
use phong::film::LayerKind;
use phong_scene::{Limits, Memory, Scene, read};

use super::drawn;

const HEAD: &str = "version = 1\n[image]\nsize = [16, 12]\nsamples = 2\n[camera]\neye = [0, 1, 6]\n\
    look_at = [0, 0, 0]\nfov = 30\n[[light]]\nkind = \"point\"\nposition = [3, 5, 4]\n";

fn scene(text: &str, ply: &str) -> Scene {
    let files = Memory::new()
        .with("a.toml", format!("{HEAD}{text}").into_bytes())
        .with("a.ply", ply.as_bytes());
    let reading = read("a.toml", None, &files, &Limits::default());
    reading.scene.unwrap_or_else(|| panic!("{:?}", reading.diagnostics))
}

#[test]
fn what_is_told_of_a_pattern_is_what_is_drawn() {
    for pattern in [
        "kind = \"grid\"\nscale = 4\naxes = \"xyz\"",
        "kind = \"stripes\"\nscale = 5\nby = \"radius\"\nspace = \"world\"",
        "kind = \"noise\"\nscale = 5\nseed = 3\nspace = \"uv\"",
        "kind = \"marble\"\nscale = 3",
        "kind = \"wood\"\nscale = 2",
        "kind = \"cells\"\nscale = 4\nby = \"border\"",
    ] {
        let shapes = "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"m\"\n[[plane]]\n\
                      point = [0, -1, 0]\nnormal = [0, 1, 0]\nmaterial = \"m\"\n";
        let text = format!(
            "[textures.t]\n{pattern}\n[materials.m]\ncolor = {{ texture = \"t\" }}\n\
             bump = {{ texture = \"t\", scale = 0.1 }}\nreflection = 0.3\n{shapes}"
        );
        let (view, options, film) = drawn(&scene(&text, ""), &[]);
        let mut values = std::collections::BTreeSet::new();
        for (x, y) in (0..12).flat_map(|y| (0..16).map(move |x| (x, y))) {
            let told = explain(&view, &options, [x, y]).unwrap();
            let picture = film.at(LayerKind::Picture, x, y).unwrap();
            assert_eq!(told.linear.to_array()[..], *picture, "{pattern}: {x} {y}");
            for sample in &told.samples {
                let Some(End::Surface(s)) = sample.ray.as_ref().map(|ray| &ray.end) else {
                    continue;
                };
                let color = s.textures.iter().find(|told| told.parameter == "color").unwrap();
                assert_eq!(color.value, s.color, "{pattern}: {x} {y}");
                values.insert(s.color.r.to_bits());
            }
        }
        assert!(values.len() > 3, "{pattern}: {} values", values.len());
    }
}

#[test]
fn a_property_of_points_is_told_with_its_number_and_drawn_between_them() {
    let ply = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n\
               property float z\nproperty float T\nelement face 1\n\
               property list uchar int vertex_indices\nend_header\n\
               -2 -2 0 10\n2 -2 0 30\n2 2 0 30\n-2 2 0 10\n4 0 1 2 3\n";
    let text = "[textures.T]\nkind = \"map\"\nof = \"T\"\nstops = [[0, 0], [1, 1]]\n[materials.m]\n\
                color = { texture = \"T\" }\n[[mesh]]\nfile = \"a.ply\"\nmaterial = \"m\"\n\
                translate = [0, 0, -1]\n";
    let scene = scene(text, ply);
    let scales = scene.color_scales();
    assert_eq!((scales.len(), scales[0].of, scales[0].range), (1, "T", [10.0, 30.0]));
    let (view, options, film) = drawn(&scene, &[Aov::Albedo]);
    let told = explain(&view, &options, [9, 6]).unwrap();
    let End::Surface(s) = &told.samples[0].ray.as_ref().unwrap().end else { panic!("{told:?}") };
    let told = &s.textures[0];
    let (of, number) = told.number.as_ref().unwrap();
    assert_eq!(of, "T");
    assert!((number - (20.0 + 5.0 * s.p.x)).abs() < 1e-4, "{number} at {}", s.p);
    assert!((f64::from(told.value.r) - (number - 10.0) / 20.0).abs() < 1e-6);
    let albedo = |x| film.at(LayerKind::Aov(Aov::Albedo), x, 6).unwrap()[0];
    assert!(albedo(3) < albedo(8) && albedo(8) < albedo(12));
}
