//! Pixels under filters that are negative in places.
#![expect(clippy::unwrap_used, reason = "in a test, what is not there is a failure")]

use phong::explain::explain;
use phong::film::{Film, LayerKind};
use phong::render::{Cancel, RenderOptions, render};
use phong::view::View;
use phong_scene::{FilterKind, Limits, Memory, read};

/// A ball whose light is 1 everywhere.
const BALL: &str = "version = 1\n[image]\nsize = [64, 40]\nbackground = BACKGROUND\n\
    [camera]\neye = [0, 0, 6]\nlook_at = [0, 0, 0]\n\
    [materials.white]\ncolor = 1\nk_a = 1\nk_d = 0\nk_s = 0\n\
    [[sphere]]\ncenter = [0, 0, 0]\nradius = 1.5\nmaterial = \"white\"\n";

fn view(background: &str) -> View {
    let text = BALL.replace("BACKGROUND", background);
    let files = Memory::new().with("a.toml", text.into_bytes());
    let reading = read("a.toml", None, &files, &Limits::default());
    let scene = reading.scene.unwrap_or_else(|| panic!("{:?}", reading.diagnostics));
    View::of(&scene).unwrap()
}

fn options(samples: u32) -> RenderOptions {
    let options = RenderOptions::new([64, 40]).unwrap().with_samples(samples).unwrap();
    options.with_filter(FilterKind::Mitchell).with_lights(Some(0))
}

fn film(view: &View, samples: u32) -> Film {
    render(view, &options(samples), &|_| {}, &Cancel::new()).film
}

#[test]
fn what_is_even_all_over_stays_like_itself_for_any_number_of_samples() {
    let view = view("1");
    for samples in 1..=12 {
        let film = film(&view, samples);
        for value in film.layer(LayerKind::Picture).unwrap().values.iter() {
            assert!((value - 1.0).abs() < 1e-6, "{value} of {samples} samples");
        }
    }
    for x in 0..64 {
        let told = explain(&view, &options(2), [x, 20]).unwrap();
        assert_eq!(told.linear.to_array(), [1.0; 3], "explained at {x}");
    }
}

#[test]
fn over_a_transparent_background_light_is_cut_with_its_cover() {
    let view = view("\"transparent\"");
    for samples in [2, 4, 16] {
        let film = film(&view, samples);
        let values = |kind| film.layer(kind).unwrap().values.to_vec();
        let [alpha, light, rest] =
            [LayerKind::Alpha, LayerKind::Picture, LayerKind::Unlit].map(values);
        assert!(alpha.iter().all(|alpha| (0.0..=1.0).contains(alpha)));
        for (alpha, light) in alpha.iter().zip(light.chunks(3)) {
            assert!((light[0] - alpha).abs() < 1e-6, "{light:?} where {alpha} is covered");
        }
        assert_eq!(rest, light);
    }
}
