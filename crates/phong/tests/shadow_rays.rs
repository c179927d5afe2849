//! Where shadow rays start and end: lights in, on or a hair from a surface, and within luminous bodies.
#![expect(clippy::unwrap_used, reason = "in a test, what is not there is a failure")]

use phong::aov::Aov;
use phong::explain::{End, Lit, explain};
use phong::film::{Film, LayerKind};
use phong::render::{Cancel, RenderOptions, render};
use phong::view::View;
use phong_scene::{Light, LightKind, Limits, Memory, Scene, read};

const ROOM: &str = include_str!("cases/room.toml");

fn scene(text: &str) -> Scene {
    let files = Memory::new().with("a.toml", text.as_bytes()).with("room.obj", ROOM_OBJ.as_bytes());
    let reading = read("a.toml", None, &files, &Limits::default());
    reading.scene.unwrap_or_else(|| panic!("{:?}", reading.diagnostics))
}

/// A small picture, its red alone.
fn picture(text: &str) -> Vec<f32> {
    layer(text, LayerKind::Picture).into_iter().step_by(3).collect()
}

/// The share of lights that each pixel's centre sees.
fn seen(text: &str) -> Vec<f32> {
    layer(text, LayerKind::Aov(Aov::Shadow))
}

fn layer(text: &str, kind: LayerKind) -> Vec<f32> {
    let scene = scene(text);
    let options = RenderOptions::of(&scene.image).unwrap().with_size([60, 40]).unwrap();
    let options = options.with_samples(1).unwrap().with_aovs(&[Aov::Shadow]);
    let film: Film = render(&View::of(&scene).unwrap(), &options, &|_| {}, &Cancel::new()).film;
    film.layer(kind).unwrap().values.to_vec()
}

/// How many pixels differ by more than a fiftieth.
fn apart(a: &[f32], b: &[f32]) -> usize {
    a.iter().zip(b).filter(|(a, b)| (*a - *b).abs() > 0.02).count()
}

fn share(seen: &[f32]) -> f32 {
    seen.iter().sum::<f32>() / seen.len() as f32
}

fn lamp_at(position: &str) -> String {
    ROOM.replace("position = [0.3, 2.5, 0.2]", &format!("position = {position}"))
}

/// The room's walls, each of two triangles.
const ROOM_OBJ: &str = "v -2.5 -1 -4\nv 2.5 -1 -4\nv 2.5 2.5 -4\nv -2.5 2.5 -4\n\
    v -2.5 -1 4\nv 2.5 -1 4\nv 2.5 2.5 4\nv -2.5 2.5 4\n\
    f 1 2 3 4\nf 5 6 7 8\nf 1 2 6 5\nf 4 3 7 8\nf 1 4 8 5\nf 2 3 7 6\n";

#[test]
fn a_lamp_in_the_plane_of_the_ceiling_lights_the_room_as_one_just_below_it() {
    let below = picture(&lamp_at("[0.3, 2.499, 0.2]"));
    assert!(share(&below) > 0.3, "{}", share(&below));
    for height in ["2.5", "2.4999999", "2.499999", "2.49999"] {
        let there = picture(&lamp_at(&format!("[0.3, {height}, 0.2]")));
        // The edge of the ball's shadow moves by less than a pixel, and what grazes the ceiling is dark.
        assert!(apart(&below, &there) < 40, "{height}: {} pixels", apart(&below, &there));
    }
}

#[test]
fn a_lamp_in_a_wall_of_triangles_or_in_a_corner_lights_the_room_too() {
    let body = "[[box]]\nmin = [-2.5, -1, -4]\nmax = [2.5, 2.5, 4]\n";
    let mesh = "[[mesh]]\nfile = \"room.obj\"\n";
    for (inside, there) in [
        ("[-2.499, 1.1, -0.7]", "[-2.5, 1.1, -0.7]"),
        ("[-2.499, 2.499, -3.999]", "[-2.5, 2.5, -4]"),
        ("[0.3, 1.2, -3.999]", "[0.3, 1.2, -4]"),
    ] {
        let wanted = picture(&lamp_at(inside));
        assert!(share(&wanted) > 0.2);
        for text in [lamp_at(there), lamp_at(there).replace(body, mesh)] {
            let found = picture(&text);
            // Around the lamp its own walls, which it grazes, are darker.
            assert!(apart(&wanted, &found) < 80, "{there}: {}", apart(&wanted, &found));
        }
    }
}

#[test]
fn a_lamp_behind_the_ceiling_does_not_light_the_room() {
    for height in ["2.5001", "2.501", "3"] {
        let seen = seen(&lamp_at(&format!("[0.3, {height}, 0.2]")));
        // A point of the edge between two walls is in both.
        assert!(share(&seen) < 5.0 / 2400.0, "{height}: {}", share(&seen));
    }
}

#[test]
fn a_lamp_on_a_ball_lights_what_is_before_it_and_not_what_the_ball_hides() {
    // Just off the top of the ball, and on it: the floor around is dark, and the walls are lit down to a
    // height that differs by a pixel or two.
    let off = picture(&lamp_at("[0, 1.0005, 0]"));
    let on = picture(&lamp_at("[0, 1, 0]"));
    assert!((0.2..0.9).contains(&share(&off)), "{}", share(&off));
    assert!(apart(&off, &on) < 100, "{}", apart(&off, &on));
}

/// A ball, a lamp within another one over it, and the floor.
fn lantern(glow: &str, body: &str) -> String {
    format!(
        "version = 1\n[image]\nsize = [60, 40]\nsamples = 1\n[camera]\neye = [0, 2, 6]\n\
         look_at = [0, 0.5, 0]\nfov = 60\n[[light]]\nkind = \"point\"\nposition = [0.5, 3, 0]\n\
         [materials.lamp]\n{glow}\n[[sphere]]\ncenter = [-1, 0.5, 0]\nradius = 0.5\n\
         [[plane]]\npoint = [0, 0, 0]\nnormal = [0, 1, 0]\n{body}"
    )
}

#[test]
fn a_lamp_within_a_luminous_body_is_seen_from_outside_it() {
    let bare = seen(&lantern("", ""));
    assert!(share(&bare) > 0.3);
    let ball = "[[sphere]]\ncenter = [0.5, 3, 0]\nradius = 0.3\nmaterial = \"lamp\"\n";
    let bodies = [
        ball.to_owned(),
        ball.replace("center = [0.5, 3, 0]", "center = [0.6, 2.9, 0.1]"),
        format!("{ball}scale = [1, 1.1, 1]\ntranslate = [0, -0.3, 0]\n"),
        "[[box]]\nmin = [0.3, 2.8, -0.2]\nmax = [0.7, 3.2, 0.2]\nmaterial = \"lamp\"\n".to_owned(),
        format!("{ball}{}", ball.replace("0.3", "0.2")),
        "[[instance]]\ngroup = \"g\"\ntranslate = [0.5, 3, 0]\n[groups.g]\n\
         [[groups.g.sphere]]\ncenter = [0, 0, 0]\nradius = 0.3\nmaterial = \"lamp\"\n"
            .to_owned(),
    ];
    for body in bodies {
        let dark = seen(&lantern("", &body));
        assert!(share(&dark) < 0.05, "a body that does not glow stands in the way: {body}");
        let lit = seen(&lantern("k_e = 1", &body));
        // The body itself is in the picture, and casts no shadow.
        assert!(apart(&bare, &lit) < 20, "{body}: {}", apart(&bare, &lit));
    }
}

#[test]
fn a_luminous_ball_that_holds_no_lamp_casts_a_shadow() {
    let ball = "[[sphere]]\ncenter = [0.5, 1, 0]\nradius = 0.3\nmaterial = \"lamp\"\n";
    let (bare, shadowed) = (seen(&lantern("", "")), seen(&lantern("k_e = 1", ball)));
    assert!(apart(&bare, &shadowed) > 10, "{}", apart(&bare, &shadowed));
    // A shadow within the way to a lamp in a luminous ball stays as well.
    let both = format!("{ball}{}", ball.replace("0.5, 1, 0", "0.5, 3, 0"));
    assert!(apart(&shadowed, &seen(&lantern("k_e = 1", &both))) < 20);
}

/// What the only light does at a pixel's centre.
fn light_at(text: &str, pixel: [u32; 2]) -> Lit {
    let scene = scene(text);
    let options = RenderOptions::of(&scene.image).unwrap();
    let told = explain(&View::of(&scene).unwrap(), &options, pixel).unwrap();
    match told.samples[0].ray.clone().unwrap().end {
        End::Surface(mut surface) => surface.lights.remove(0),
        End::Background(_) | End::Light { .. } => panic!("nothing there"),
    }
}

#[test]
fn explain_names_what_blocks_a_light_and_not_the_body_around_it() {
    let ball = "[[sphere]]\ncenter = [0.5, 3, 0]\nradius = 0.3\nmaterial = \"lamp\"\n";
    let floor = [45, 36];
    let dark = light_at(&lantern("", ball), floor);
    assert!(!dark.visible && dark.blocker.is_some_and(|b| b.object == "sphere 2"));
    let lit = light_at(&lantern("k_e = 1", ball), floor);
    assert!(lit.visible && lit.tested && lit.blocker.is_none());
    assert!(
        (lit.distance - dark.distance).abs() == 0.0,
        "what is told is the light's own distance"
    );
}

/// A post on a floor under this light, which is out of sight.
fn under(light: &str, files: &[(&str, &str)], samples: u32) -> Result<Vec<f32>, String> {
    let text = format!(
        "version = 1\n[image]\nsize = [20, 12]\nsamples = {samples}\n\
         [camera]\neye = [0, 4, 3]\nlook_at = [0, 0, 0]\nfov = 40\n\
         [materials.floor]\ncolor = 0.8\nk_a = 0\nk_s = 0.2\nshininess = 5\n\
         [[plane]]\npoint = [0, 0, 0]\nnormal = [0, 1, 0]\nmaterial = \"floor\"\n\
         [[sphere]]\ncenter = [0, 0.5, 0.2]\nradius = 0.4\nmaterial = \"floor\"\n{light}"
    );
    let mut memory = Memory::new().with("a.toml", text.into_bytes());
    for (name, text) in files {
        memory = memory.with(*name, text.as_bytes());
    }
    let reading = read("a.toml", None, &memory, &Limits::default());
    let scene = reading.scene.ok_or_else(|| format!("{:?}", reading.diagnostics))?;
    let options = RenderOptions::of(&scene.image).unwrap();
    let film = render(&View::of(&scene).unwrap(), &options, &|_| {}, &Cancel::new()).film;
    Ok(film.layer(LayerKind::Picture).unwrap().values.iter().copied().step_by(3).collect())
}

/// A rectangle of 1.5 by 1 that faces the floor, in two triangles.
const SHEET: &str =
    "v -0.75 4 -0.5\nv 0.75 4 -0.5\nv 0.75 4 0.5\nv -0.75 4 0.5\nf 1 2 3\nf 1 3 4\n";

#[test]
fn a_mesh_of_two_triangles_lights_as_the_rectangle_that_they_are() {
    let rectangle = "[[light]]\nkind = \"rectangle\"\nposition = [0, 4, 0]\ndirection = [0, -1, 0]\n\
                     up = [0, 0, 1]\nwidth = 1.5\nheight = 1\nattenuation = [0.2, 0, 0.1]\n";
    let mesh = "[[light]]\nkind = \"mesh\"\nobject = \"mesh 1\"\nattenuation = [0.2, 0, 0.1]\n\
                [[mesh]]\nfile = \"sheet.obj\"\n";
    let rectangle = under(rectangle, &[], 64).unwrap();
    let mesh = under(mesh, &[("sheet.obj", SHEET)], 64).unwrap();
    let each = || rectangle.iter().zip(&mesh).map(|(a, b)| (a - b).abs());
    let (largest, mean) = (each().fold(0.0, f32::max), each().sum::<f32>() / mesh.len() as f32);
    assert!(share(&rectangle) > 0.1 && largest < 0.05 && mean < 0.004, "{largest} {mean}");
}

#[test]
fn a_mesh_that_is_tiny_is_a_point_light_from_each_side() {
    let point = "[[light]]\nkind = \"point\"\nposition = [1, 3, 1]\ncolor = [0.8, 1, 1]\n";
    let mesh = "[[light]]\nkind = \"mesh\"\nobject = \"lamp\"\ncolor = [0.8, 1, 1]\n\
                [[mesh]]\nname = \"lamp\"\nfile = \"tent.obj\"\nscale = 1e-4\ntranslate = [1, 3, 1]\n";
    let tent = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
    let point = under(point, &[], 4).unwrap();
    let mesh = under(mesh, &[("tent.obj", tent)], 4).unwrap();
    let alike = point.iter().zip(&mesh).filter(|(a, b)| (*a - *b).abs() < 2e-3).count();
    // A shadow's edge may take or leave a sample.
    assert!(alike > point.len() - 6 && share(&point) > 0.1, "{alike} of {}", point.len());
}

#[test]
fn a_mesh_of_too_many_triangles_is_no_light_and_one_that_is_gone_is_told() {
    let fan = |n: usize| {
        let corner = |i: usize| format!("v {} 4 {}\n", i as f32 * 0.01, (i % 2) as f32);
        let face = |i: usize| format!("f {i} {} {}\n", i + 1, i + 2);
        (0..n + 2).map(corner).chain((1..=n).map(face)).collect::<String>()
    };
    let light = "[[light]]\nkind = \"mesh\"\nobject = \"mesh 1\"\n[[mesh]]\nfile = \"fan.obj\"\n";
    let refused = under(light, &[("fan.obj", &fan(257))], 1).unwrap_err();
    assert!(refused.contains("has 257 triangles, and a mesh that shines at most 256"), "{refused}");
    assert!(share(&under(light, &[("fan.obj", &fan(256))], 1).unwrap()) > 0.0);
    let text = "version = 1\n[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\n\
                [[sphere]]\ncenter = [0, 0, 0]\nradius = 1\n";
    let mut scene = scene(text);
    let kind = LightKind::Mesh { attenuation: [1.0, 0.0, 0.0] };
    scene.lights = vec![Light { kind, object: "mesh 7".into(), ..Light::default() }];
    let error = View::of(&scene).unwrap_err().to_string();
    assert!(error.contains("there is no mesh of at most 256 triangles called"), "{error}");
}
