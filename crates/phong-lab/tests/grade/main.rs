//! Planted mistakes are recognised, and right pictures pass.
#![expect(clippy::unwrap_used, reason = "in a test, what is not there is a failure")]
#![allow(clippy::disallowed_methods, reason = "the student uses std, as students do")]

mod planted;
mod student;
mod worlds;

use std::path::Path;

use phong::image::{Picture, Plane, Transfer};
use phong_lab::grade::{Grade, Grader, grade};
use phong_scene::{Folder, Limits, Scene};
use student::{World, draw};
use worlds::{colored, one_lamp, scene};

fn picture(w: &World, slips: &[&str]) -> Picture {
    let levels = draw(w, slips);
    let plane = |channel: usize, name: &str| Plane {
        name: name.to_owned(),
        values: levels.iter().map(|level| f32::from(level[channel]) / 255.0).collect(),
    };
    let planes = vec![plane(0, "R"), plane(1, "G"), plane(2, "B")];
    Picture { size: w.size, planes, transfer: Transfer::Srgb, levels: Some(255), lossy: None }
}

fn graded(w: &World, slips: &[&str]) -> Grade {
    grade(&scene(w), &picture(w, slips)).unwrap()
}

fn grader(w: &World) -> Grader {
    Grader::new(&scene(w)).unwrap()
}

#[test]
fn a_right_picture_passes_and_has_all_its_terms() {
    for world in [one_lamp(), colored()] {
        let grade = graded(&world, &[]);
        assert!(grade.pass, "{:?}", grade.residual);
        for (name, factor) in grade.terms.iter().take(3) {
            assert!((factor.unwrap() - 1.0).abs() < 0.02, "{name}: {factor:?}");
        }
    }
}

#[test]
fn causes_that_draw_the_same_picture_are_told_as_tied() {
    // Of two lights the second is missing, or the first alone counts.
    let mut world = colored();
    world.lamps.truncate(2);
    let grade = graded(&world, &["first light only"]);
    let causes: Vec<&str> = grade.cause.iter().chain(&grade.tied).map(String::as_str).collect();
    assert!(
        causes.contains(&"first-light-only") && causes.contains(&"one-light-missing"),
        "{causes:?}"
    );
    assert!(grade.confidence <= 1.0 / causes.len() as f64, "{}", grade.confidence);
    assert_eq!(grade.told_apart_by.as_deref(), Some("three lights that reach every surface"));
}

#[test]
fn what_a_scene_cannot_reveal_is_said() {
    let hidden = graded(&one_lamp(), &[]).unrevealed;
    for cause in ["first-light-only", "distant-reversed", "half-mean", "attenuation-missing"] {
        assert!(hidden.contains(&cause), "{cause}: {hidden:?}");
    }
    for cause in ["ambient-missing", "shadows-missing", "eye-constant", "hex-not-decoded"] {
        assert!(!hidden.contains(&cause), "{cause}: {hidden:?}");
    }
}

#[test]
fn what_is_wrong_with_one_object_or_one_light_is_told_with_its_name() {
    let says = |slips: &[&str]| graded(&colored(), slips).candidates[0].says.clone();
    let told = says(&["normals inside out, first ball"]);
    assert!(told.contains("`thing 1`") && !told.contains("`thing 2`"), "{told}");
    let told = says(&["no shadows of the first light"]);
    assert!(told.contains("the light `light 1`"), "{told}");
}

#[test]
fn a_picture_of_another_size_is_refused() {
    let world = one_lamp();
    let other = World { size: [10, 10], ..one_lamp() };
    let error = grade(&scene(&world), &picture(&other, &[])).unwrap_err();
    assert_eq!(error.to_string(), "the picture is 10 × 10, but the scene's is 84 × 56");
}

#[test]
fn terms_that_are_missing_are_named() {
    let factor = |slip: &str, i: usize| graded(&one_lamp(), &[slip]).terms[i].1.unwrap();
    assert!(factor("no ambient", 0).abs() < 0.05);
    assert!(factor("no diffuse", 1).abs() < 0.05);
    assert!(factor("no specular", 2).abs() < 0.05);
}

/// The scene beside this file, and the picture that another program drew of it.
fn by_another_program() -> (Scene, Picture) {
    drawn_by_another_program("pov_ray.png")
}

fn drawn_by_another_program(name: &str) -> (Scene, Picture) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/grade");
    let toml = folder.join("pov_ray.toml");
    let reading = phong_scene::read(&toml.to_string_lossy(), None, &Folder, &Limits::default());
    let png = std::fs::read(folder.join(name)).unwrap();
    (reading.scene.unwrap(), Picture::read(&png).unwrap())
}

#[test]
fn a_right_picture_by_another_program_passes() {
    let (scene, picture) = by_another_program();
    let told = grade(&scene, &picture).unwrap();
    assert!(told.pass, "{:?} {:?}", told.residual, told.cause);
    assert!(told.residual.pixels > 5000, "{:?}", told.residual);
    for (name, factor) in told.terms {
        match factor {
            Some(factor) => assert!((factor - 1.0).abs() < 0.03, "{name}: {factor}"),
            None => assert_eq!(name, "emission"),
        }
    }
}

#[test]
fn a_picture_by_another_program_of_a_scene_changed_a_little_fails() {
    let (mut scene, picture) = by_another_program();
    for material in &mut scene.materials {
        material.shininess = (2.0 * material.shininess.constant().unwrap()).into();
    }
    let told = grade(&scene, &picture).unwrap();
    assert_eq!((told.pass, told.cause.as_deref()), (false, Some("exponent-half")));
}

#[test]
fn a_jpeg_is_graded_with_what_its_compression_may_have_changed() {
    let (scene, picture) = drawn_by_another_program("pov_ray.jpg");
    let told = grade(&scene, &picture).unwrap();
    assert!(told.pass, "{:?} {:?}", told.residual, told.cause);
    let (mut brighter, picture) = drawn_by_another_program("pov_ray.jpg");
    brighter.ambient *= 3.0;
    let told = grade(&brighter, &picture).unwrap();
    assert!(!told.pass, "{:?}", told.residual);
}

#[test]
fn a_picture_of_something_else_is_not_recognised() {
    let (scene, mut picture) = by_another_program();
    let size = picture.size;
    let mut told = |draw: &dyn Fn(f32, f32) -> f32, what: &str| {
        for plane in &mut picture.planes {
            let place = |i: usize| (i as u32 % size[0], i as u32 / size[0]);
            let value = |i| {
                let (x, y) = place(i);
                draw(x as f32 / size[0] as f32, y as f32 / size[1] as f32)
            };
            plane.values = (0..plane.values.len()).map(value).collect();
        }
        let told = grade(&scene, &picture).unwrap();
        assert!(!told.pass && told.cause.is_none(), "{what}: {:?} {:?}", told.cause, told.residual);
    };
    told(&|x, y| ((8.0 * x).floor() + (6.0 * y).floor()) % 2.0, "a chessboard");
    told(&|x, _| x, "a ramp");
    told(&|x, y| (37.0 * x).sin() * (29.0 * y).cos() * 0.5 + 0.5, "waves");
    let other = picture_of_the_other_world(size);
    let told = grade(&scene, &other).unwrap();
    assert!(!told.pass && told.cause.is_none(), "another scene: {:?}", told.cause);
}

fn picture_of_the_other_world(size: [u32; 2]) -> Picture {
    picture(&World { size, ..one_lamp() }, &[])
}

#[test]
fn what_is_no_number_is_told_with_its_place_and_the_rest_is_graded() {
    let world = one_lamp();
    let broken = |slips: &[&str]| {
        let mut picture = picture(&world, slips);
        for i in [700, 701, 900] {
            picture.planes[1].values[i] = f32::NAN;
        }
        grade(&scene(&world), &picture).unwrap()
    };
    let right = broken(&[]);
    assert_eq!((right.pass, right.cause.as_deref()), (false, Some("not-a-number")));
    let evidence = &right.candidates[0].evidence;
    assert_eq!(evidence, "3 pixels are no number, the first at (28, 8)");
    assert!(
        right.residual.rms.is_finite()
            && right.terms.iter().filter_map(|t| t.1).all(f64::is_finite)
    );
    let wrong = broken(&["no specular"]);
    assert_eq!(wrong.cause.as_deref(), Some("not-a-number + specular-missing"));
}

#[test]
fn skies_and_fog_are_parts_of_the_sum_and_what_is_wrong_in_them_is_named() {
    use phong::render::{Cancel, RenderOptions, render};
    use phong::view::View;
    use phong_scene::{Fog, FogKind, Rgb, Sky, SkyKind, Tone, ToneCurve};
    let mut scene = scene(&one_lamp());
    let [zenith, horizon] = [Rgb::new(0.5, 0.7, 1.0), Rgb::new(1.0, 0.8, 0.6)];
    let kind = SkyKind::Gradient { zenith, horizon, ground: None };
    scene.sky = Some(Sky { kind, samples: 4, ..Sky::default() });
    let kind = FogKind::Exponential { density: 0.05 };
    scene.fog = Some(Fog { kind, color: Some(Rgb::grey(0.6)), ..Fog::default() });
    let draw = |scene: &Scene| {
        let options = RenderOptions::of(&scene.image).unwrap().one_sample();
        let view = View::of(scene).unwrap();
        Picture::of_film(&render(&view, &options, &|_| {}, &Cancel::new()).film)
    };
    let grader = Grader::new(&scene).unwrap();
    assert!(grader.grade(&draw(&scene)).unwrap().pass);
    let without = Scene { ambient: Rgb::BLACK, ..scene.clone() };
    let grade = grader.grade(&draw(&without)).unwrap();
    for cause in ["half-pixel", "aspect-ignored", "fov-half", "far-root", "up-ignored"] {
        assert!(grade.unrevealed.contains(&cause), "rays that go elsewhere: {cause}");
    }
    assert_eq!(grade.cause.as_deref(), Some("ambient-missing"), "{grade:#?}");
    scene.tone = Some(Tone { curve: ToneCurve::Filmic, ..Tone::default() });
    let error = Grader::new(&scene).unwrap_err().to_string();
    assert!(error.contains("[tone]"), "{error}");
}
