//! Materials that vary over a surface are drawn, told and looked up as one.
#![expect(clippy::unwrap_used, reason = "in a test, what is not there is a failure")]

#[path = "textures/images.rs"]
mod images;
#[path = "textures/parameters.rs"]
mod parameters;
#[path = "textures/patterns.rs"]
mod patterns;
#[path = "textures/relief.rs"]
mod relief;
#[path = "textures/vertices.rs"]
mod vertices;

use phong::aov::Aov;
use phong::explain::{End, explain};
use phong::film::{Film, LayerKind};
use phong::render::{Cancel, RenderOptions, render};
use phong::terms::TermSet;
use phong::view::View;
use phong_scene::{Limits, Memory, Scene, read};

const HEAD: &str = "version = 1
[image]
size = [24, 16]
samples = 3
background = 0.2
[camera]
eye = [0, 1, 6]
look_at = [0, 0, 0]
fov = 30
[[light]]
kind = \"point\"
position = [3, 5, 4]
[[light]]
kind = \"distant\"
direction = [1, -2, -1]
color = 0.5
[textures.half]
kind = \"checker\"
colors = [0.5, 0.5]
[textures.tiles]
kind = \"checker\"
colors = [\"#c04020\", 0.9]
scale = 3
[textures.rising]
kind = \"gradient\"
from = -1
stops = [[0, 0.1], [1, [1, 0.5, 0.2]]]
[[sphere]]
center = [0, 0, 0]
radius = 1
material = \"m\"
[[plane]]
point = [0, -1, 0]
normal = [0, 1, 0]
material = \"m\"
";

fn scene(material: &str) -> Scene {
    let text = format!("{HEAD}[materials.m]\n{material}");
    let files = Memory::new().with("a.toml", text.into_bytes());
    let reading = read("a.toml", None, &files, &Limits::default());
    reading.scene.unwrap_or_else(|| panic!("{:?}", reading.diagnostics))
}

fn drawn(scene: &Scene, aovs: &[Aov]) -> (View, RenderOptions, Film) {
    let options = RenderOptions::of(&scene.image)
        .unwrap()
        .with_terms(TermSet::of_scene(scene))
        .with_aovs(aovs);
    let view = View::of(scene).unwrap();
    let film = render(&view, &options, &|_| {}, &Cancel::new()).film;
    (view, options, film)
}

fn picture(scene: &Scene) -> Vec<u32> {
    let film = drawn(scene, &[]).2;
    let layer = film.layer(LayerKind::Picture).unwrap();
    layer.values.iter().map(|value| value.to_bits()).collect()
}

#[test]
fn a_texture_of_one_value_has_the_bits_of_that_value() {
    for (model, keys) in [
        ("phong", &["color", "ambient_color", "specular_color", "k_a", "k_d", "k_s"][..]),
        ("phong", &["k_e", "emission_color", "shininess", "reflection", "transmission"]),
        ("blinn-phong", &["shininess", "color"]),
        ("ggx", &["roughness"]),
        ("ward", &["roughness_x", "roughness_y"]),
    ] {
        for key in keys {
            let with = |value: &str| {
                let glow = if *key == "emission_color" { "k_e = 0.3\n" } else { "" };
                scene(&format!("model = \"{model}\"\n{glow}{key} = {value}\n"))
            };
            let textured = picture(&with("{ texture = \"half\" }"));
            assert_eq!(textured, picture(&with("0.5")), "{model}: {key}");
            let twice = picture(&with("{ texture = \"half\", scale = 0.5, offset = 0.5 }"));
            assert_eq!(twice, picture(&with("0.75")), "{model}: {key}");
        }
    }
}

#[test]
fn what_is_explained_of_a_material_that_varies_is_what_is_drawn() {
    let scene = scene(
        "color = { texture = \"tiles\" }
         k_s = { texture = \"rising\", channel = \"g\" }
         shininess = { texture = \"tiles\", scale = 40 }
         reflection = { texture = \"rising\", scale = 0.5 }
         k_e = { texture = \"tiles\", scale = 0.1 }
         ambient_rule = \"both\"
",
    );
    let (view, options, film) = drawn(&scene, &[]);
    let mut values = std::collections::BTreeSet::new();
    for (x, y) in (0..16).flat_map(|y| (0..24).map(move |x| (x, y))) {
        let told = explain(&view, &options, [x, y]).unwrap();
        let at = |kind| film.at(kind, x, y).map(<[f32]>::to_vec);
        assert_eq!(told.linear.to_array().to_vec(), at(LayerKind::Picture).unwrap(), "{x} {y}");
        for (term, value) in told.terms.iter() {
            // A term that the scene cannot have has no layer.
            let drawn = at(LayerKind::Term(term)).unwrap_or(vec![0.0; 3]);
            assert_eq!(value.to_array().to_vec(), drawn, "{x} {y}: {term:?}");
        }
        for sample in &told.samples {
            let Some(End::Surface(s)) = sample.ray.as_ref().map(|ray| &ray.end) else { continue };
            let color = s.textures.iter().find(|told| told.parameter == "color").unwrap();
            assert_eq!((color.texture.as_str(), color.value), ("tiles", s.color));
            assert_eq!(s.textures.len(), 5);
            assert_eq!(s.terms.emission, s.material.k_e * s.color);
            values.insert(s.material.shininess.to_bits());
        }
    }
    assert_eq!(values.len(), 2, "both squares were seen");
}

#[test]
fn the_albedo_is_the_texture_and_the_material_keeps_its_number() {
    let scene = scene("color = { texture = \"tiles\" }\nk_s = { texture = \"tiles\" }\n");
    let (_, _, film) = drawn(&scene, &[Aov::Albedo, Aov::Material]);
    let mut seen = std::collections::BTreeSet::new();
    for (x, y) in (0..16).flat_map(|y| (0..24).map(move |x| (x, y))) {
        let number = film.at(LayerKind::Aov(Aov::Material), x, y).unwrap()[0];
        if number > 0.0 {
            assert_eq!(number, 1.0);
            let albedo = film.at(LayerKind::Aov(Aov::Albedo), x, y).unwrap();
            seen.insert(albedo.iter().map(|v| v.to_bits()).collect::<Vec<_>>());
        }
    }
    assert_eq!(seen.len(), 2, "two colours and nothing between");
}

#[test]
fn an_object_carries_its_texture_along_and_the_world_does_not() {
    let at = |space: &str, place: &str| {
        let text = format!(
            "version = 1\n[image]\nsize = [1, 1]\nsamples = 1\n[camera]\nkind = \"orthographic\"\n\
             height = 0.1\neye = [0.25, 0.25, 5]\nlook_at = [0.25, 0.25, 0]\n\
             [textures.tiles]\nkind = \"checker\"\ncolors = [1, 0]\nspace = \"{space}\"\n\
             [materials.m]\ncolor = {{ texture = \"tiles\" }}\n\
             [groups.g]\n[[groups.g.box]]\nmin = [-9, -9, -9]\nmax = [9, 9, 0.5]\nmaterial = \"m\"\n\
             [[instance]]\ngroup = \"g\"\n{place}\n"
        );
        let files = Memory::new().with("a.toml", text.into_bytes());
        let scene = read("a.toml", None, &files, &Limits::default()).scene.unwrap();
        drawn(&scene, &[Aov::Albedo]).2.at(LayerKind::Aov(Aov::Albedo), 0, 0).unwrap()[0]
    };
    for space in ["object", "world"] {
        assert_eq!(at(space, ""), 1.0, "{space}");
    }
    let moved = "translate = [1, 0, 0]";
    assert_eq!((at("object", moved), at("world", moved)), (0.0, 1.0));
    let twice = "scale = [0.2, 1, 1]";
    assert_eq!((at("object", twice), at("world", twice)), (0.0, 1.0));
}
