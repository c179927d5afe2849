//! `phong compare` as a program: images, scenes, models, and what cannot be compared.
#![expect(clippy::unwrap_used, reason = "in a test, what is not there is a failure")]

mod support;

use std::fs;

use support::{BALLS, Given, given};

/// The balls, with shadows and without, as pictures of 8 bits.
fn pictures() -> Given {
    let folder = given(&[("a.toml", BALLS), ("broken.toml", "version = 1\n[camera]\neye = 3\n")]);
    folder.done("render a.toml -o a.png --quiet");
    folder.done("render a.toml -o b.png --no-shadows --quiet");
    folder
}

/// A PFM of 2 × 1 pixels, grey but for one value.
fn pfm(folder: &Given, name: &str, last: f32) {
    let mut file = b"PF\n2 1\n-1.0\n".to_vec();
    for value in [0.5, 0.5, 0.5, 0.5, 0.5, last] {
        file.extend(f32::to_le_bytes(value));
    }
    fs::write(folder.path(name), file).unwrap();
}

#[test]
fn two_images_are_told_in_columns() {
    let folder = pictures();
    let then = folder.when("compare a.png b.png --tolerance 0.01");
    assert_eq!(then.code, Some(1));
    let text = String::from_utf8(then.out).unwrap();
    for words in ["psnr", "ΔE 2000", "over 0.01", "of 1200 pixels", "worst pixels", "A (R G B)"] {
        assert!(text.contains(words), "`{words}` is not in:\n{text}");
    }
    assert!(text.lines().all(|line| line.chars().count() <= 100), "{text}");
    let same = folder.done("compare a.png a.png");
    assert!(String::from_utf8(same.out).unwrap().contains("nothing differs"));
}

#[test]
fn programs_are_told_everything_and_what_is_promised() {
    let folder = pictures();
    let told = folder.when("compare a.png b.png --json").json();
    let number = |key: &str| told[key].as_f64().unwrap();
    assert!(number("max") > number("rms") && number("rms") > number("mean"));
    assert!(number("mean") > 0.0 && number("psnr") > 0.0 && number("over_1_255") > 0.0);
    assert_eq!((&told["same_size"], &told["within_tolerance"]), (&true.into(), &false.into()));
    assert_eq!(told["channels"].as_array().unwrap().len(), 3);
    assert!(told["delta_e_2000"]["max"].as_f64().unwrap() > 1.0);
    let worst = &told["worst_pixels"][0];
    assert_eq!((&worst["at"], &worst["difference"]), (&told["worst"], &told["max"]));
    let (a, b) = (worst["a"][0].as_f64().unwrap(), worst["b"][0].as_f64().unwrap());
    assert!(b > a, "without shadows it is brighter");
    let over = told["over_tolerance"]["pixels"].as_u64().unwrap();
    assert!(over > 0 && over < 1200);
}

#[test]
fn differences_are_drawn_with_their_scale_or_written_as_numbers() {
    let folder = pictures();
    folder.when("compare a.png b.png -o d.png");
    let drawn = phong::image::Picture::read(&folder.bytes("d.png")).unwrap();
    // 40 pixels, enlarged six times, and a margin.
    assert_eq!(drawn.size, [6 * 40 + 16, 8 + 6 * 30 + 8 + 10 + 6 + 17 + 8]);
    folder.when("compare a.png b.png --diff d.pfm");
    let written = phong::image::Picture::read(&folder.bytes("d.pfm")).unwrap();
    assert_eq!(written.size, [40, 30]);
    let told = folder.when("compare a.png b.png --json").json();
    let max = written.planes.iter().flat_map(|p| &p.values).copied().fold(0.0, f32::max);
    assert!((f64::from(max) - told["max"].as_f64().unwrap()).abs() < 1e-6);
}

#[test]
fn what_is_not_finite_is_told_and_drawn_and_never_the_same() {
    let folder = given(&[]);
    pfm(&folder, "a.pfm", 0.25);
    pfm(&folder, "nan.pfm", f32::NAN);
    pfm(&folder, "inf.pfm", f32::INFINITY);
    for broken in ["nan.pfm", "inf.pfm"] {
        let words = format!("compare a.pfm {broken} --tolerance 1000 -o d.png");
        let then = folder.when(&words);
        assert_eq!(then.code, Some(1), "{}", then.err);
        let text = String::from_utf8(then.out).unwrap();
        assert!(text.contains("not finite    1 pixel"), "{text}");
        let told = folder.when(&format!("compare a.pfm {broken} --json")).json();
        assert_eq!((&told["not_finite"], &told["mean"]), (&1.into(), &0.0.into()));
        assert_eq!((&told["max"], &told["worst"]), (&serde_json::Value::Null, &[1, 0][..].into()));
    }
    assert_eq!(folder.done("compare nan.pfm nan.pfm --json").json()["max"], 0.0);
}

#[test]
fn two_scenes_are_held_against_each_other_term_by_term() {
    let brighter = BALLS.replace("[materials.mirror]", "[materials.mirror]\nk_s = 0.6");
    let folder = given(&[("a.toml", BALLS), ("b.toml", &brighter)]);
    let then = folder.when("compare a.toml b.toml -o ab.png");
    assert_eq!(then.code, Some(1), "{}", then.err);
    let text = String::from_utf8(then.out).unwrap();
    assert!(text.contains("phong explain a.toml ") && text.contains("phong explain b.toml "));
    assert!(
        text.lines().any(|l| l.starts_with("diffuse") && l.trim_end().ends_with('-')),
        "{text}"
    );
    assert!(text.lines().any(|l| l.starts_with("specular") && l.contains('%')), "{text}");
    let drawn = phong::image::Picture::read(&folder.bytes("ab.png")).unwrap();
    assert_eq!(drawn.size[0], 3 * 2 * 40 + 2 * 8 + 16, "A, B and their difference");

    let told = folder.when("compare a.toml b.toml --json").json();
    assert_eq!(told["terms"]["diffuse"]["max"], 0.0);
    assert_eq!(told["terms"]["specular"]["share"].as_f64().unwrap().min(0.5), 0.5);
    // The highlight is doubled, and k_s alone differs: so is its mean.
    let specular = &told["terms"]["specular"];
    let ratio = specular["mean_b"].as_f64().unwrap() / specular["mean_a"].as_f64().unwrap();
    assert!(ratio > 1.0, "{specular}");
    // What the hint says is the pixel that was compared.
    let hint = told["explain"][1].as_str().unwrap().strip_prefix("phong ").unwrap().to_owned();
    let explained = folder.done(&format!("{hint} --json")).json();
    let value = explained["linear"][0].as_f64().unwrap();
    let compared = told["worst_pixels"][0]["b"][0].as_f64().unwrap();
    assert!((value - compared).abs() < 1e-6, "{value} {compared}");
    folder.done("compare a.toml a.toml");
}

#[test]
fn one_scene_is_held_against_itself_in_another_model() {
    let folder = given(&[("a.toml", BALLS)]);
    let then = folder.when("compare a.toml --model blinn-phong --json");
    assert_eq!(then.code, Some(1), "{}", then.err);
    let told = then.json();
    assert_eq!(told["sides"][0]["model"], serde_json::Value::Null);
    let changed = &told["sides"][1]["materials"][0];
    assert!(changed["to"].as_str().unwrap().starts_with("blinn-phong:128.7"), "{changed}");
    assert_eq!(told["terms"]["diffuse"]["max"], 0.0, "diffuse does not know the lobe");
    assert!(told["terms"]["specular"]["max"].as_f64().unwrap() > 0.0);
    let same = folder.done("compare a.toml --model phong:32 --model phong --json").json();
    assert_eq!(same["max"], 0.0);
    let text = folder.when("compare a.toml --model phong --model ggx:0.2").out;
    let text = String::from_utf8(text).unwrap();
    assert!(text.contains("in the model ggx:0.2") && !text.contains("phong explain"), "{text}");
    assert_eq!(folder.when("compare a.toml --model oren-nayar").code, Some(1));
}

#[test]
fn what_cannot_be_compared_is_refused_with_the_way_out() {
    let folder = pictures();
    fs::write(folder.path("text.png"), "no picture").unwrap();
    folder.done("render a.toml -o small.png --size 20x30 --quiet");
    fs::write(folder.path("wide.toml"), BALLS.replace("[40, 30]", "[50, 30]")).unwrap();
    let refused = |words: &str, told: &[&str]| folder.when(words).is_refused(told);
    refused("compare a.png text.png", &["text.png", "no PNG, PPM, JPEG, PFM or OpenEXR"]);
    refused("compare a.png nowhere.png", &["nowhere.png"]);
    refused("compare a.png a.jpeg", &["a.jpeg"]);
    refused("compare a.png small.png", &["a.png is 40x30 and small.png is 20x30"]);
    refused("compare a.png", &["nothing to compare a.png with", "another image"]);
    refused("compare a.toml", &["nothing to compare a.toml with", "--model"]);
    refused("compare a.toml a.png", &["a.toml is a scene", "phong grade a.toml a.png"]);
    refused("compare a.png a.toml", &["a.toml is a scene", "phong grade a.toml a.png"]);
    refused("compare a.toml wide.toml", &["40x30", "50x30", "--size 40x30"]);
    refused("compare a.toml broken.toml", &["broken.toml:3:7"]);
    refused("compare a.toml a.toml --model ggx", &["--model is for one scene"]);
    refused(
        "compare a.toml --model fong",
        &["no model `fong`", "lambert", "did you mean `phong`?"],
    );
    refused("compare a.toml --model ggx:9", &["roughness 9 of `ggx`"]);
    refused("compare a.toml --model ggx:x", &["`x` is not a number"]);
    refused("compare a.toml --model a --model b --model c", &["once or twice"]);
    refused("compare a.png b.png --size 3x3", &["--size is for scenes"]);
    refused("compare a.png --model ggx", &["--model is for scenes"]);
    refused("compare a.png b.png --tolerance -1", &["--tolerance"]);
    refused("compare a.png b.png -o d.jpeg", &[".png, .pfm or .exr"]);
    refused("compare a.png b.png -o no/d.png", &["no such folder"]);
    refused("compare a.png b.png -o -", &["standard output"]);
    refused("compare a.png b.png -o b.png", &["written over"]);
    refused("compare a.toml wide.toml --crop 0,0,45,3 --size 40x30", &["--crop", "40x30"]);
    assert_eq!(folder.names().len(), 7, "{:?}", folder.names());
}

#[test]
fn numbers_have_the_digits_they_were_computed_with() {
    let folder = given(&[
        (
            "a.toml",
            "version = 1\n[image]\nsize = [2, 2]\nbackground = 0.1\n[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\n",
        ),
        ("m.obj", "v 0.1 -0.0 0.3\nv 1.7 0.7 0.3\nv 0.1 0.7 0.3\nf 1 2 3\n"),
    ]);
    folder.done("render a.toml -o a.pfm --quiet");
    folder.done("render a.toml -o b.pfm --background 0.4 --quiet");
    let told = String::from_utf8(folder.when("compare a.pfm b.pfm --json").out).unwrap();
    assert!(
        told.contains("0.1,") && told.contains("0.4,") && !told.contains("0.10000000"),
        "{told}"
    );
    let told = folder.done("info m.obj --json").json();
    assert_eq!(told["bounds"].to_string(), "[[0.1,0.0,0.3],[1.7,0.7,0.3]]");
    let told = String::from_utf8(folder.done("info m.obj").out).unwrap();
    assert!(told.contains("[0.1, 0.0, 0.3] to [1.7, 0.7, 0.3]"), "{told}");
}

#[test]
fn an_empty_file_is_said_to_be_empty() {
    let folder = given(&[("e.png", "")]);
    folder.when("compare e.png e.png").is_refused(&["e.png: the file is empty"]);
}
