//! Glass: which rays are followed, and what of a transparent background is seen through it.
#![expect(clippy::unwrap_used, reason = "in a test, what is not there is a failure")]

use phong::explain::{End, Explanation, Onward, explain};
use phong::film::{Film, LayerKind};
use phong::render::{Cancel, RenderOptions, render};
use phong::view::View;
use phong::witness::CutReason;
use phong_scene::{Limits, Memory, Scene};

/// One pixel looking down −z from (0, 0, 10), its background and settings, and whatever is added.
fn text(image: &str, more: &str) -> String {
    format!(
        "version = 1\n[image]\nsize = [1, 1]\nsamples = 1\n{image}\n[ambient]\ncolor = 1\n\
         [camera]\nkind = \"orthographic\"\neye = [0, 0, 10]\nlook_at = [0, 0, 0]\nheight = 0.001\n\
         [materials.glass]\ncolor = 0\nk_a = 0\nk_d = 0\nk_s = 0\nreflection = 1\ntransmission = 1\n\
         [materials.half]\ncolor = 0\nk_a = 0\nk_d = 0\nk_s = 0\nreflection = 0.5\n\
         transmission = 0.5\nfresnel = false\nior = 1\n\
         [materials.tinted]\ncolor = 0\nk_a = 0\nk_d = 0\nk_s = 0\ntransmission = [0.9, 0.6, 0.3]\n\
         fresnel = false\nior = 1\n\
         [materials.mirror]\ncolor = 0\nk_a = 0\nk_d = 0\nk_s = 0\nreflection = 0.5\n{more}"
    )
}

fn scene(text: &str) -> Scene {
    let source = Memory::new().with("scene.toml", text.as_bytes());
    let reading = phong_scene::read("scene.toml", None, &source, &Limits::default());
    reading.scene.unwrap_or_else(|| panic!("{:#?}", reading.diagnostics))
}

fn drawn(text: &str) -> Film {
    let scene = scene(text);
    let options = RenderOptions::of(&scene.image).unwrap();
    render(&View::of(&scene).unwrap(), &options, &|_| {}, &Cancel::new()).film
}

fn alpha(text: &str) -> f32 {
    let film = drawn(text);
    film.at(LayerKind::Alpha, 0, 0).unwrap()[0]
}

fn explained(text: &str) -> Explanation {
    let scene = scene(text);
    let options = RenderOptions::of(&scene.image).unwrap();
    explain(&View::of(&scene).unwrap(), &options, [0, 0]).unwrap()
}

const PANES: &str = "\
    [[box]]\nmin = [-5, -5, 0]\nmax = [5, 5, 1]\nmaterial = \"half\"\n\
    [[box]]\nmin = [-5, -5, 2]\nmax = [5, 5, 3]\nmaterial = \"half\"\n";

/// The mirror and glass rays of one pixel, all that were sent and those that were not.
fn onward(told: &Explanation) -> Vec<Onward> {
    let mut found = Vec::new();
    let mut rays: Vec<_> = told.samples.iter().filter_map(|s| s.ray.clone()).collect();
    while let Some(ray) = rays.pop() {
        let End::Surface(surface) = ray.end else { continue };
        for onward in [surface.reflection, surface.transmission].into_iter().flatten() {
            rays.extend(onward.ray.clone());
            found.push(onward);
        }
    }
    found
}

#[test]
fn rays_that_count_less_than_the_least_weight_are_not_followed() {
    let told = explained(&text("depth = 100\nmin_weight = 0.1\nbackground = 1", PANES));
    let onward = onward(&told);
    let mut cut = 0;
    for onward in &onward {
        let weight = onward.path_weight.max_channel();
        assert_eq!(onward.ray.is_none(), weight < 0.1, "{weight}");
        if onward.ray.is_none() {
            assert_eq!(onward.cut, Some(CutReason::Weight(0.1)));
            // Halves: the most it could have brought is known to the bit.
            assert_eq!(weight, 0.0625);
            cut += 1;
        }
    }
    assert!(cut > 4, "{cut} of {}", onward.len());
}

#[test]
fn a_least_weight_of_0_follows_all_rays_to_the_depth() {
    let told = explained(&text("depth = 7\nmin_weight = 0\nbackground = 1", PANES));
    let reasons: Vec<_> = onward(&told).into_iter().filter_map(|onward| onward.cut).collect();
    assert!(!reasons.is_empty() && reasons.iter().all(|reason| *reason == CutReason::Depth));
}

#[test]
fn what_is_not_followed_is_missing_by_no_more_than_it_is_said_to_be() {
    let image = |least: &str| format!("depth = 10\nmin_weight = {least}\nbackground = 1");
    let value =
        |least: &str| drawn(&text(&image(least), PANES)).at(LayerKind::Picture, 0, 0).unwrap()[0];
    let told = explained(&text(&image("0.01"), PANES));
    let most: f32 = onward(&told)
        .iter()
        .filter(|onward| onward.ray.is_none())
        .map(|onward| onward.path_weight.max_channel())
        .sum();
    let missing = value("0") - value("0.01");
    assert!(missing > 0.0 && missing <= most * 1.0001, "{missing} of {most}");
}

#[test]
fn explained_rays_that_end_add_up_to_the_pixel() {
    let text = text("depth = 20\nmin_weight = 0.02\nbackground = 0.7", PANES);
    let picture = drawn(&text).at(LayerKind::Picture, 0, 0).unwrap().to_vec();
    assert_eq!(explained(&text).linear.to_array().to_vec(), picture);
}

#[test]
fn a_transparent_background_is_seen_through_glass_by_the_weights_of_refracted_rays() {
    let ball = "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"glass\"";
    let f = (1.5_f32 - 1.0) / (1.5 + 1.0);
    let f = f * f;
    let want = 1.0 - (1.0 - f) * (1.0 - f);
    let found = alpha(&text("background = \"transparent\"", ball));
    assert!((found - want).abs() < 1e-6, "{found}, not {want}");
}

#[test]
fn a_tint_counts_by_the_mean_of_its_channels() {
    let pane =
        "[[disc]]\ncenter = [0, 0, 0]\nnormal = [0, 0, 1]\nradius = 1\nmaterial = \"tinted\"";
    let found = alpha(&text("background = \"transparent\"", pane));
    assert!((found - 0.4).abs() < 1e-6, "{found}");
}

#[test]
fn mirrors_and_what_stands_behind_glass_are_opaque() {
    let wall = "[[plane]]\npoint = [0, 0, -5]\nnormal = [0, 0, 1]\n";
    let transparent = "background = \"transparent\"";
    assert_eq!(alpha(&text(transparent, &format!("{PANES}{wall}"))), 1.0);
    let mirror = "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"mirror\"";
    assert_eq!(alpha(&text(transparent, mirror)), 1.0);
    assert_eq!(alpha(&text("background = 0.5", PANES)), 1.0);
    assert_eq!(alpha(&text(transparent, "")), 0.0);
}

#[test]
fn samples_are_summed_to_the_alpha_of_one() {
    let ball = "[[box]]\nmin = [-1, -1, -1]\nmax = [1, 1, 1]\nmaterial = \"glass\"";
    let one = alpha(&text("background = \"transparent\"", ball));
    let text = text("background = \"transparent\"\nfilter = \"mitchell\"", ball);
    let many = alpha(&text.replace("samples = 1\n", "samples = 16\n"));
    assert!((one - many).abs() < 1e-6, "{one} and {many}");
}
