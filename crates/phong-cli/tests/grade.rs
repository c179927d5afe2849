//! `phong grade` as a program.

mod support;

use std::fs;

use support::{BALLS, Given, given};

/// The balls drawn as they should be, and without shadows.
fn handed_in() -> Given {
    let folder = given(&[("a.toml", BALLS)]);
    folder.done("render a.toml --samples 1 -o right.png --quiet");
    folder.done("render a.toml --samples 1 --no-shadows -o wrong.png --quiet");
    folder
}

#[test]
fn a_right_picture_passes_with_an_exit_code_of_nought() {
    let folder = handed_in();
    let then = folder.done("grade a.toml right.png");
    let text = String::from_utf8(then.out).unwrap();
    assert!(text.starts_with("right.png: pass\n"), "{text}");
    assert!(text.contains("ambient × 1.00, diffuse × 1.00"), "{text}");
    let told = folder.done("grade a.toml right.png --json").json();
    assert_eq!((&told["verdict"], &told["cause"]), (&"pass".into(), &serde_json::Value::Null));
    assert_eq!(told["candidates"], serde_json::json!([]));
}

#[test]
fn a_wrong_picture_fails_with_its_cause_and_an_exit_code_of_1() {
    let folder = handed_in();
    let then = folder.when("grade a.toml wrong.png");
    assert_eq!(then.code, Some(1), "{}", then.err);
    let text = String::from_utf8(then.out).unwrap();
    assert!(text.contains("cause: shadows-missing (confidence 0."), "{text}");
    assert!(text.contains("- shadows-missing: nothing casts a shadow"), "{text}");
    let told = folder.when("grade a.toml wrong.png --json").json();
    assert_eq!((&told["verdict"], &told["cause"]), (&"fail".into(), &"shadows-missing".into()));
    assert!(told["confidence"].as_f64().unwrap() > 0.9);
    assert_eq!(told["candidates"][0]["cause"], "shadows-missing");
    assert!(told["candidates"][0]["evidence"].as_str().unwrap().contains("rms"));
    assert!(told["terms"]["ambient"].is_f64());
}

#[test]
fn a_whole_class_is_graded_in_one_go() {
    let folder = handed_in();
    let then = folder.when("grade a.toml right.png wrong.png --json");
    assert_eq!(then.code, Some(1));
    let told = then.json();
    assert_eq!(told["pass"], false);
    let verdicts: Vec<_> =
        told["images"].as_array().unwrap().iter().map(|i| &i["verdict"]).collect();
    assert_eq!(verdicts, ["pass", "fail"]);
}

#[test]
fn a_picture_that_cannot_be_graded_takes_no_verdict_from_the_others() {
    let folder = handed_in();
    fs::write(folder.path("text.png"), "no picture").unwrap();
    let then = folder.when("grade a.toml text.png right.png nowhere.png wrong.png");
    then.is_refused(&["text.png: this is no PNG", "nowhere.png"]);
    let text = String::from_utf8(then.out).unwrap();
    assert!(text.contains("right.png: pass") && text.contains("wrong.png: fail"), "{text}");

    let then = folder.when("grade a.toml text.png right.png wrong.png --json");
    assert_eq!(then.code, Some(2), "{}", then.err);
    let told = then.json();
    assert_eq!(told["pass"], false);
    let images = told["images"].as_array().unwrap();
    let verdicts: Vec<_> = images.iter().map(|one| one["verdict"].as_str()).collect();
    assert_eq!(verdicts, [None, Some("pass"), Some("fail")]);
    assert_eq!(images[0]["image"], "text.png");
    assert!(images[0]["error"].as_str().unwrap().contains("no PNG"), "{images:?}");
}

#[test]
fn a_picture_of_any_size_is_graded_at_its_own() {
    let folder = handed_in();
    folder.done("render a.toml --size 60x40 --samples 1 -o other.png --quiet");
    let text = String::from_utf8(folder.done("grade a.toml other.png right.png").out).unwrap();
    assert!(text.contains("other.png: pass") && text.contains("right.png: pass"), "{text}");
    assert!(text.contains("drawn at its size, 60 × 40; the scene's own is 40 × 30"), "{text}");
    let told = folder.done("grade a.toml other.png --json").json();
    assert_eq!(told["size"], serde_json::json!([60, 40]));
}

#[test]
fn the_difference_is_drawn_for_one_picture() {
    let folder = handed_in();
    assert_eq!(folder.when("grade a.toml wrong.png --diff off.png").code, Some(1));
    assert_eq!(&folder.bytes("off.png")[1..4], b"PNG");
    let then = folder.when("grade a.toml wrong.png right.png --diff two.png");
    then.is_refused(&["--diff is for one picture"]);
    let then = folder.when("grade a.toml wrong.png --diff wrong.png");
    then.is_refused(&["wrong.png would be written over"]);
}

#[test]
fn causes_that_cannot_be_told_apart_are_told_as_tied() {
    // Of two lights the second is put out. In a mirror, only one of them would be missing.
    let one = BALLS.replace("reflection = 0.5", "reflection = 0");
    let two = format!("{one}\n[[light]]\nkind = \"distant\"\ndirection = [-1, -1, -1]\n");
    let folder = given(&[("one.toml", &one), ("two.toml", &two)]);
    folder.done("render one.toml --samples 1 -o right.png --quiet");
    let then = folder.when("grade two.toml right.png --json");
    let told = then.json();
    // Reversed, it would shine from under the floor.
    assert_eq!(told["cause"], "distant-reversed", "{told}");
    let tied = serde_json::json!(["first-light-only", "one-light-missing"]);
    assert_eq!(told["tied"], tied, "{told}");
    assert!(told["confidence"].as_f64().unwrap() <= 1.0 / 3.0, "{told}");
    let text = String::from_utf8(folder.when("grade two.toml right.png").out).unwrap();
    let tie = "these pictures cannot be told apart in this scene: distant-reversed, \
               first-light-only, one-light-missing; a scene that could: one with a distant light";
    assert!(text.contains(tie), "{text}");
}

#[test]
fn our_own_pictures_pass_whatever_their_curve_and_depth() {
    // Dark, where 8 linear bits leave little.
    let dark = BALLS.replace("position = [3, 4, 5]\n", "position = [3, 4, 5]\ncolor = 0.02\n");
    let dark = dark.replace("[camera]", "[ambient]\ncolor = 0.05\n[camera]");
    for scene in [BALLS, &dark] {
        let folder = given(&[("a.toml", scene)]);
        for words in ["", "--linear", "--bits 16", "--linear --bits 16"] {
            folder.done(&format!("render a.toml --samples 1 {words} -o a.png --quiet"));
            let told = folder.done("grade a.toml a.png --json").json();
            let off = told["worst"]["difference"].as_f64().unwrap();
            assert!(told["verdict"] == "pass" && off < 0.51 / 255.0, "{words}: {told}");
        }
    }
}

#[test]
fn a_picture_of_something_else_is_said_to_be_unknown() {
    let folder = handed_in();
    let other = BALLS.replace("eye = [0, 1, 5]", "eye = [4, 3, -3]");
    fs::write(folder.path("other.toml"), other).unwrap();
    folder.done("render other.toml -o other.png --quiet");
    let then = folder.when("grade a.toml other.png");
    assert_eq!(then.code, Some(1));
    let text = String::from_utf8(then.out).unwrap();
    assert!(text.contains("no known mistake explains it: is it a picture of this scene"), "{text}");
    assert!(folder.when("grade a.toml other.png --json").json()["cause"].is_null());
}

#[test]
fn values_that_are_no_numbers_are_named_with_their_place() {
    let folder = handed_in();
    folder.done("render a.toml --samples 1 -o nan.pfm --quiet");
    let mut file = folder.bytes("nan.pfm");
    // The last row of the file is the first of the picture.
    let last = file.len() - 4;
    file[last..].copy_from_slice(&f32::NAN.to_le_bytes());
    fs::write(folder.path("nan.pfm"), file).unwrap();
    let then = folder.when("grade a.toml nan.pfm");
    assert_eq!(then.code, Some(1), "{}", then.err);
    let text = String::from_utf8(then.out).unwrap();
    assert!(text.contains("cause: not-a-number"), "{text}");
    assert!(text.contains("1 pixel is no number, the first at (39, 0)"), "{text}");
}

#[test]
fn what_cannot_be_graded_is_refused_with_the_way_out() {
    let folder = handed_in();
    fs::write(folder.path("text.png"), "no picture").unwrap();
    fs::write(folder.path("broken.toml"), "version = 1\n[camera]\neye = 3\n").unwrap();
    let refused = |words: &str, told: &[&str]| folder.when(words).is_refused(told);
    refused("grade a.toml text.png", &["text.png", "no PNG, PPM, JPEG, PFM or OpenEXR"]);
    refused("grade a.toml nowhere.png", &["nowhere.png"]);
    refused("grade nowhere.toml right.png", &["nowhere.toml"]);
    refused("grade broken.toml right.png", &["broken.toml:3:7"]);
    refused("grade a.toml", &["IMAGE"]);
    assert_eq!(folder.when("grade a.toml right.png text.png").code, Some(2));
}

#[test]
fn the_help_lists_every_cause() {
    let then = given(&[]).done("grade --help");
    let text = String::from_utf8(then.out).unwrap();
    for mistake in phong_lab::grade::MISTAKES {
        assert!(text.contains(mistake.cause), "{}", mistake.cause);
    }
    assert!(text.contains("phong grade scene.toml mine.png"), "{text}");
}
