//! Golden pictures: each scene under `golden/` is rendered and must equal the 16-bit PNG beside it, with
//! no differing value. `PHONG_BLESS=1` writes the pictures anew; look at them before committing.

use std::collections::BTreeSet;
use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};

use phong::film::{Film, LayerKind, Window};
use phong::finish::{Finished, Finishing, finish};
use phong::image::{self, Bits, Content, Encoding, Format, Picture};
use phong::part::Settings;
use phong::render::{Cancel, RenderOptions, render};
use phong::view::View;
use phong_scene::{Folder, Limits, Tone};

/// One test for each scene, named `group::name` as its file is.
macro_rules! golden {
    ($($group:ident: $($name:ident)*;)*) => {
        const NAMES: &[(&str, &[&str])] =
            &[$((stringify!($group), &[$(stringify!($name)),*])),*];
        $(mod $group {
            $(#[test]
            fn $name() {
                crate::hold(stringify!($group), stringify!($name));
            })*
        })*
    };
}

golden! {
    cameras: fisheye landscape lens orthographic panorama perspective up wide;
    film: background cel empty filter_box filter_gaussian filter_mitchell filter_tent gradient odd_size
        one_pixel outline seed tone_filmic tone_reinhard transparent transparent_mirror;
    lights: attenuation below_horizon colored disc distant enclosed mesh point range rectangle shadow shadow_off
        shadow_touching specular_color sphere spot spot_hard;
    materials: blinn_phong cook_torrance default ggx lambert normalize opacity oren_nayar per_light phong
        times_cosine tint ward;
    shapes: box_corner clip_box clip_plane coincident cone cone_frustum cylinder cylinder_open cylinders cylinders_flat
        cylinders_open disc ellipsoid mesh_crease mesh_flat
        mesh_smooth plane plane_below points sphere sphere_displaced sphere_far sphere_inside torus
        torus_far triangle triangle_back triangle_normals;
    terms: ambient ambient_color diffuse emission fog occlusion reflection reflection_depth shininess_0 shininess_1000
        shininess_3 sky sky_image specular specular_object sum total_internal total_internal_plain transmission
        transmission_dark transmission_plain transmission_thin trapped;
    textures: checker_floor checker_spaces checker_uv color_maps gradient image maps numbers patterns vertex_colors;
    transforms: include instance instance_nested matrix mirrored order rotate rotate_list scale;
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden")
}

#[track_caller]
fn hold(group: &str, name: &str) {
    let scene = folder().join(group).join(format!("{name}.toml"));
    let golden = scene.with_extension("png");
    let actual = drawn(&scene);
    let expected = fs::read(&golden).ok();
    if std::env::var_os("PHONG_BLESS").is_some_and(|v| v == "1") {
        if expected.is_none_or(|expected| decoded(&expected) != decoded(&actual)) {
            fs::write(&golden, actual).expect("writable");
        }
        return;
    }
    let expected = expected
        .unwrap_or_else(|| panic!("{} is missing: PHONG_BLESS=1 writes it", golden.display()));
    let same = decoded(&actual) == decoded(&expected);
    assert!(same, "{}", difference(group, name, &actual, &expected));
}

/// The PNG that a scene gives.
fn drawn(path: &Path) -> Vec<u8> {
    let reading = phong_scene::read(&path.to_string_lossy(), None, &Folder, &Limits::default());
    // Warnings are welcome: a lamp within a ball is what one of the scenes is about.
    let scene = reading.scene.unwrap_or_else(|| panic!("{:#?}", reading.diagnostics));
    let options = RenderOptions::of(&scene.image).expect("the scene has been checked");
    let options = options.with_finishing_of(&scene);
    let compiled = View::of(&scene).expect("compiles");
    let film = render(&compiled, &options, &|_| {}, &Cancel::new()).film;
    let settings = Settings::of(&scene, &options, Encoding::default());
    written(&finish(&film, &settings.finishing()), false)
}

fn encoded(film: &Film, linear: bool, tone: Tone) -> Vec<u8> {
    written(&finish(film, &Finishing::default().with_tone(tone)), linear)
}

fn written(finished: &Finished<'_>, linear: bool) -> Vec<u8> {
    let encoding = Encoding { bits: Bits::Sixteen, linear };
    let mut bytes = Cursor::new(Vec::new());
    image::write(finished, Content::Layer(LayerKind::Picture), Format::Png, &encoding, &mut bytes)
        .expect("memory takes it");
    bytes.into_inner()
}

fn decoded(png: &[u8]) -> Picture {
    Picture::read(png).expect("a whole PNG")
}

/// Leaves the picture as it is now and the difference beside each other; says where it is worst.
fn difference(group: &str, name: &str, actual: &[u8], expected: &[u8]) -> String {
    let kept = Path::new(env!("CARGO_TARGET_TMPDIR")).join("golden").join(group);
    fs::create_dir_all(&kept).expect("a folder for the pictures");
    fs::write(kept.join(format!("{name}.actual.png")), actual).expect("writable");
    let (actual, expected) = (decoded(actual), decoded(expected));
    let kind = |p: &Picture| (p.size, p.planes.iter().map(|q| q.name.clone()).collect::<String>());
    if kind(&actual) != kind(&expected) {
        return format!("{group}/{name} is {:?}, not {:?}", kind(&actual), kind(&expected));
    }
    let at = |p: &Picture, pixel: usize| -> Vec<u16> {
        p.planes.iter().map(|plane| (plane.values[pixel] * 65535.0).round() as u16).collect()
    };
    let [width, height] = actual.size;
    let apart: Vec<Vec<u16>> = (0..width as usize * height as usize)
        .map(|pixel| {
            let pairs = at(&actual, pixel).into_iter().zip(at(&expected, pixel));
            pairs.map(|(a, e)| a.abs_diff(e)).collect()
        })
        .collect();
    let count = apart.iter().flatten().filter(|d| **d > 0).count();
    let largest = |pixel: &usize| apart[*pixel].iter().copied().max();
    let worst = (0..apart.len()).rev().max_by_key(largest).expect("a pixel");
    let most = largest(&worst).expect("a channel");
    // Any difference is to be seen: the largest is white.
    let mut diff = Film::new(actual.size, Window::full(actual.size), 64, &[LayerKind::Picture]);
    diff.layers[0].values = apart
        .iter()
        .flat_map(|pixel| &pixel[..3])
        .map(|d| f32::from(*d) / f32::from(most))
        .collect();
    fs::write(kept.join(format!("{name}.diff.png")), encoded(&diff, true, Tone::default()))
        .expect("writable");
    format!(
        "{group}/{name}: {count} values differ, by {most}/65535 at most, at ({}, {}): {:?}, not {:?}; see {}",
        worst as u32 % width,
        worst as u32 / width,
        at(&actual, worst),
        at(&expected, worst),
        kept.display()
    )
}

#[test]
fn every_scene_is_in_the_list_and_every_picture_has_a_scene() {
    let mut found = BTreeSet::new();
    for group in fs::read_dir(folder()).expect("the golden folder") {
        let group = group.expect("an entry");
        for entry in fs::read_dir(group.path()).expect("a group") {
            let path = entry.expect("an entry").path();
            match path.extension().and_then(|e| e.to_str()) {
                Some("toml" | "png") => {}
                _ => continue,
            }
            let stem = path.file_stem().expect("a name").to_string_lossy().into_owned();
            found.insert((group.file_name().to_string_lossy().into_owned(), stem));
        }
    }
    let listed: BTreeSet<(String, String)> = NAMES
        .iter()
        .flat_map(|(group, names)| names.iter().map(|n| ((*group).to_owned(), (*n).to_owned())))
        .collect();
    let missing: Vec<_> = found.difference(&listed).collect();
    assert!(missing.is_empty(), "not in the list: {missing:?}");
    assert!(found.is_superset(&listed), "without a file: {:?}", listed.difference(&found));
}

#[test]
fn a_difference_of_one_step_is_found_and_told() {
    let size = [2, 1];
    let picture = |green: u16| {
        let mut film = Film::new(size, Window::full(size), 64, &[LayerKind::Picture]);
        let levels = [0, 1, 2, 3, green, 5];
        film.layers[0].values = levels.iter().map(|&v| f32::from(v) / 65535.0).collect();
        encoded(&film, true, Tone::default())
    };
    assert_ne!(decoded(&picture(4)), decoded(&picture(5)));
    let said = difference("harness", "one_step", &picture(5), &picture(4));
    assert!(said.contains("1 values differ, by 1/65535 at most, at (1, 0)"), "{said}");
    let diff = Path::new(env!("CARGO_TARGET_TMPDIR")).join("golden/harness/one_step.diff.png");
    let diff = decoded(&fs::read(diff).expect("left there"));
    let [red, green, blue] = diff.rgb().expect("a colour");
    assert_eq!((red, green, blue), (&[0.0, 0.0][..], &[0.0, 1.0][..], &[0.0, 0.0][..]));
}
