//! Smooth meshes where light ends: no face shows, and nothing but visibility changes.
#![expect(clippy::unwrap_used, reason = "in a test, what is not there is a failure")]

use phong::explain::{End, Surface, explain};
use phong::film::{Film, LayerKind};
use phong::render::{Cancel, RenderOptions, render};
use phong::view::View;
use phong_scene::{Limits, Memory, Scene, read};

const BALL: &str = include_str!("cases/ball.obj");

/// A coarse ball with smooth normals, lit from the side.
fn scene(more: &str) -> Scene {
    let text = format!(
        "version = 1\n[image]\nsize = [96, 96]\nsamples = 1\nbackground = 0\n{more}[camera]\n\
         kind = \"orthographic\"\neye = [0, 0, 10]\nlook_at = [0, 0, 0]\nheight = 2.4\n\
         [[light]]\nkind = \"distant\"\ndirection = [-1, -0.2, -0.1]\n\
         [materials.m]\ncolor = 1\nk_a = 0\nk_d = 1\nk_s = 0\n\
         [[mesh]]\nfile = \"ball.obj\"\nmaterial = \"m\"\n"
    );
    of(&text)
}

fn of(text: &str) -> Scene {
    let files = Memory::new().with("a.toml", text.as_bytes()).with("ball.obj", BALL.as_bytes());
    let reading = read("a.toml", None, &files, &Limits::default());
    reading.scene.unwrap_or_else(|| panic!("{:?}", reading.diagnostics))
}

fn options(scene: &Scene) -> RenderOptions {
    RenderOptions::of(&scene.image).unwrap()
}

fn drawn(scene: &Scene, options: &RenderOptions) -> Film {
    render(&View::of(scene).unwrap(), options, &|_| {}, &Cancel::new()).film
}

/// Every surface that a pixel's centre meets, with its place and the picture there.
fn surfaces(scene: &Scene, options: &RenderOptions) -> Vec<([u32; 2], Surface, f32)> {
    let view = View::of(scene).unwrap();
    let [width, height] = options.size();
    let pixels = (0..height).step_by(3).flat_map(|y| (0..width).step_by(3).map(move |x| [x, y]));
    pixels
        .filter_map(|pixel| {
            let told = explain(&view, options, pixel).unwrap();
            match told.samples[0].ray.clone()?.end {
                End::Surface(surface) => Some((pixel, *surface, told.linear.r)),
                End::Background(_) | End::Light { .. } => None,
            }
        })
        .collect()
}

#[test]
fn light_ends_where_the_normals_say_and_not_at_the_edges_of_faces() {
    let scene = scene("");
    let dark = |terminator: bool| {
        let told = surfaces(&scene, &options(&scene).with_terminator(terminator));
        let in_light = told.iter().filter(|(_, at, _)| at.lights[0].n_dot_l > 0.02);
        in_light.filter(|(_, at, _)| !at.lights[0].visible).count()
    };
    assert_eq!(dark(true), 0);
    assert!(dark(false) > 20, "{}", dark(false));
}

#[test]
fn where_light_is_seen_the_equation_is_as_it_was() {
    let scene = scene("");
    for terminator in [true, false] {
        for (pixel, at, picture) in surfaces(&scene, &options(&scene).with_terminator(terminator)) {
            let light = &at.lights[0];
            let seen = if light.visible { light.n_dot_l } else { 0.0 };
            assert!((picture - seen).abs() < 1e-6, "{pixel:?}");
        }
    }
}

#[test]
fn the_picture_has_the_bits_that_are_explained() {
    let scene = scene("");
    for terminator in [true, false] {
        let options = options(&scene).with_terminator(terminator);
        let film = drawn(&scene, &options);
        for ([x, y], _, told) in surfaces(&scene, &options) {
            let picture = film.at(LayerKind::Picture, x, y).unwrap()[0];
            assert_eq!(picture.to_bits(), told.to_bits(), "({x}, {y})");
        }
    }
}

#[test]
fn without_it_the_face_has_its_own_horizon() {
    let scene = scene("terminator = false\n");
    for (pixel, at, _) in surfaces(&scene, &options(&scene)) {
        let light = &at.lights[0];
        let above = light.l.unwrap().dot(at.ng) > 0.0 && light.n_dot_l > 0.0;
        assert_eq!(light.above, above, "{pixel:?}");
    }
}

#[test]
fn without_shadows_the_picture_is_the_equation_and_nothing_else() {
    let scene = scene("");
    let mut below = 0;
    for terminator in [true, false] {
        let options = options(&scene).with_shadows(false).with_terminator(terminator);
        for (pixel, at, picture) in surfaces(&scene, &options) {
            let light = &at.lights[0];
            let wanted = light.n_dot_l.max(0.0);
            assert!((picture - wanted).abs() < 1e-6, "{pixel:?}: {picture} for {wanted}");
            below += u32::from(wanted > 0.0 && light.l.unwrap().dot(at.ng) < 0.0);
        }
    }
    assert!(below > 20, "{below}: the light is below the horizon of many a face");
}

#[test]
fn what_has_no_normals_of_its_own_keeps_every_bit() {
    let flat = "[[box]]\nmin = [-1, -1, -1]\nmax = [0.2, 0.3, 0]\n[[sphere]]\ncenter = [0, 0, 0]\n\
                radius = 0.7\n[[plane]]\npoint = [0, -1, 0]\nnormal = [0, 1, 0.2]\n\
                [[mesh]]\nfile = \"ball.obj\"\nsmooth = false\ntranslate = [0.6, 0.5, 0.3]\n";
    let head = "version = 1\n[image]\nsize = [64, 64]\nsamples = 2\n[camera]\neye = [0, 0, 5]\n\
                look_at = [0, 0, 0]\n[[light]]\nkind = \"point\"\nposition = [3, 2, 1]\n";
    let scene = of(&format!("{head}{flat}"));
    let [with, without] =
        [true, false].map(|on| drawn(&scene, &options(&scene).with_terminator(on)));
    let values = |film: &Film| film.layer(LayerKind::Picture).unwrap().values.to_vec();
    assert_eq!(values(&with), values(&without));
}

#[test]
fn what_stands_before_the_light_still_takes_it_away() {
    let blocked = "[[disc]]\ncenter = [4, 0.8, 0.4]\nnormal = [1, 0, 0]\nradius = 3\n";
    let text = "version = 1\n[image]\nsize = [96, 96]\nsamples = 1\n[camera]\n\
                kind = \"orthographic\"\neye = [0, 0, 10]\nlook_at = [0, 0, 0]\nheight = 2.4\n\
                [[light]]\nkind = \"point\"\nposition = [9, 0, 0]\n\
                [[mesh]]\nfile = \"ball.obj\"\nrotate = [0, 1, 0, 20]\n";
    let seen = |text: String| {
        let scene = of(&text);
        let told = surfaces(&scene, &options(&scene));
        told.iter().filter(|(_, at, _)| at.lights[0].visible).count()
    };
    assert!(seen(text.to_owned()) > 100);
    assert_eq!(seen(format!("{text}{blocked}")), 0);
}

#[test]
fn a_transform_that_leaves_the_shape_leaves_the_border_of_light() {
    let plain = scene("");
    let told = |more: &str| {
        let mut moved = scene("");
        moved.objects[0].transform = of(&format!(
            "version = 1\n[camera]\neye = [0, 0, 1]\nlook_at = [0, 0, 0]\n[[mesh]]\nfile = \"ball.obj\"\n{more}"
        ))
        .objects[0]
            .transform;
        surfaces(&moved, &options(&moved))
    };
    let wanted = surfaces(&plain, &options(&plain));
    // Half a turn about y maps the ball onto itself, and so does a mirror.
    for more in ["scale = [-1, 1, 1]\n", "rotate = [0, 1, 0, 180]\n"] {
        let found = told(more);
        assert!(found.len().abs_diff(wanted.len()) < 4);
        let dark =
            found.iter().filter(|(_, at, _)| at.lights[0].n_dot_l > 0.02 && !at.lights[0].visible);
        assert_eq!(dark.count(), 0, "{more}");
    }
    // Flattened, its normals are still those of a smooth body.
    let flat = told("scale = [1, 0.5, 2]\n");
    let dark =
        flat.iter().filter(|(_, at, _)| at.lights[0].n_dot_l > 0.02 && !at.lights[0].visible);
    assert_eq!(dark.count(), 0);
}

#[test]
fn explain_tells_where_the_light_is_looked_for_from() {
    let scene = scene("");
    let mut above = 0;
    for terminator in [true, false] {
        for (pixel, at, _) in surfaces(&scene, &options(&scene).with_terminator(terminator)) {
            let light = &at.lights[0];
            assert_eq!(light.lifted.is_some(), terminator && light.tested, "{pixel:?}");
            let Some(start) = light.lifted else { continue };
            // The ball's chords are up to a tenth of its radius below it.
            let up = (start - at.p).dot(at.ng.to_vec().as_dvec3());
            assert!(up > 0.0 && up < 0.2 && start.length() < 1.1, "{pixel:?}: {start}");
            above += u32::from(up > 0.01);
        }
    }
    assert!(above > 50, "{above}");
}
