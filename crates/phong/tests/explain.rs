//! What `explain` says is what the film holds, bit for bit.
#![expect(clippy::unwrap_used, reason = "in a test, what is not there is a failure")]

use std::path::Path;

use phong::explain::{End, Explanation, explain};
use phong::film::LayerKind;
use phong::render::{Cancel, RenderOptions, render};
use phong::terms::{TermSet, Terms};
use phong::view::View;
use phong_scene::{FilterKind, Folder, Limits};

fn compiled(file: &str) -> (View, RenderOptions) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(file);
    let reading = phong_scene::read(path.to_str().unwrap(), None, &Folder, &Limits::default());
    let scene = reading.scene.unwrap_or_else(|| panic!("{file}: {:?}", reading.diagnostics));
    let options = RenderOptions::of(&scene.image).unwrap().with_size([20, 12]).unwrap();
    let options = options.with_samples(3).unwrap().with_terms(TermSet::ALL);
    (View::of(&scene).unwrap(), options)
}

/// Every gallery scene.
fn gallery() -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let mut names: Vec<String> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .filter(|name| Path::new(name).extension().is_some_and(|e| e == "toml"))
        .collect();
    names.sort();
    assert!(names.len() >= 4, "a gallery of {names:?}");
    names
}

#[test]
fn the_explained_sum_is_the_pixel_of_the_film_in_every_gallery_scene() {
    for file in gallery() {
        let (scene, options) = compiled(&file);
        for filter in [FilterKind::Box, FilterKind::Mitchell] {
            let options = options.clone().with_filter(filter);
            let film = render(&scene, &options, &|_| {}, &Cancel::new()).film;
            for y in 0..options.size()[1] {
                for x in 0..options.size()[0] {
                    let told = explain(&scene, &options, [x, y]).unwrap();
                    let at = |kind| film.at(kind, x, y).unwrap().to_vec();
                    assert_eq!(
                        told.linear.to_array().to_vec(),
                        at(LayerKind::Picture),
                        "{file} {x} {y}"
                    );
                    assert_eq!(vec![told.alpha], at(LayerKind::Alpha), "{file} {x} {y}");
                    for (term, value) in told.terms.iter() {
                        let drawn = at(LayerKind::Term(term));
                        assert_eq!(value.to_array().to_vec(), drawn, "{file} {x} {y}");
                    }
                    parts_add_up(&told, &file);
                }
            }
        }
    }
}

/// What was told of each light and ray sums to what the sample brought.
fn parts_add_up(told: &Explanation, file: &str) {
    for sample in &told.samples {
        let Some(ray) = &sample.ray else { continue };
        assert_eq!(ray.terms(), sample.terms, "{file}: {:?}", told.pixel);
        let End::Surface(surface) = &ray.end else { continue };
        let emission = surface.material.k_e * surface.c_e() * surface.cover;
        let mut sum = Terms { ambient: surface.ambient, emission, ..Terms::default() };
        for lit in &surface.lights {
            sum.ambient += lit.ambient;
            sum.diffuse += lit.diffuse;
            sum.specular += lit.specular;
        }
        for (branch, term) in [
            (&surface.reflection, &mut sum.reflection),
            (&surface.transmission, &mut sum.transmission),
        ] {
            if let Some(onward) = branch {
                let brought =
                    onward.ray.as_ref().map(|ray| ray.terms().total()).unwrap_or_default();
                assert_eq!(brought, onward.light);
                *term = onward.weight * brought;
            }
        }
        if let Some(through) = &surface.through {
            sum.transmission += through.weight * through.light;
        }
        assert_eq!(sum, surface.terms, "{file}: {:?}", told.pixel);
    }
}

#[test]
fn a_pixel_outside_the_picture_is_refused() {
    let (scene, options) = compiled("two-balls.toml");
    let error = explain(&scene, &options, [20, 0]).unwrap_err();
    assert_eq!(error.to_string(), "pixel (20, 0) is outside the picture of 20 × 12");
}
