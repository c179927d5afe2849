//! The same picture, however it is asked for.
#![allow(clippy::unwrap_used, reason = "tests")]

mod support;

use std::fs;
use std::io::Write;
use std::process::Stdio;
use std::thread::sleep;
use std::time::{Duration, Instant};

use phong::part::Part;
use support::{BALLS, Given, Then, given};

fn balls() -> Given {
    given(&[("a.toml", BALLS)])
}

fn png_size(bytes: &[u8]) -> (u32, u32) {
    let reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
    (reader.info().width, reader.info().height)
}

/// A scene drawn in two shares, `0.part` and `1.part`, which are put together.
fn merged(folder: &Given, scene: &str) -> Vec<u8> {
    for i in 0..2 {
        folder.done(&format!("render {scene} -o {i}.part --tile {i}/2"));
    }
    folder.done("merge 1.part 0.part -o merged.png");
    folder.bytes("merged.png")
}

#[test]
fn a_picture_is_named_after_its_scene() {
    let folder = balls();
    let then = folder.done("render a.toml");
    assert_eq!((then.out.len(), then.err.as_str()), (0, ""));
    assert_eq!(folder.names(), ["a.png", "a.toml"]);
    assert_eq!(png_size(&folder.bytes("a.png")), (40, 30));
}

#[test]
fn standard_output_gets_the_very_file() {
    let folder = balls();
    for (extension, format) in
        [("png", ""), ("pfm", "--output-format pfm"), ("exr", "--output-format exr")]
    {
        folder.done(&format!("render a.toml -o b.{extension}"));
        let then = folder.done(&format!("render a.toml -o - {format}"));
        assert_eq!(then.out, folder.bytes(&format!("b.{extension}")), "{extension}");
    }
}

#[test]
fn a_scene_comes_from_standard_input() {
    let folder = balls();
    folder.done("render a.toml");
    let mut command = folder.command("render - --format toml -o b.png");
    let mut child = command.stdin(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    child.stdin.take().unwrap().write_all(BALLS.as_bytes()).unwrap();
    assert_eq!(Then::of(child.wait_with_output().unwrap()).code, Some(0));
    assert_eq!(folder.bytes("a.png"), folder.bytes("b.png"));
}

#[test]
fn lines_are_drawn_onto_the_picture_alike_in_parts_and_shares() {
    let folder = given(&[("a.toml", &format!("{BALLS}[outline]\nwidth = 1.5\n"))]);
    folder.done("render a.toml -o plain.pfm");
    folder.done("render a.toml -o whole.png --dpi 144");
    assert_eq!(folder.names(), ["a.toml", "plain.pfm", "whole.png"]);
    folder.done("render a.toml -o a.part --dpi 144 --tile 0/2");
    folder.done("render a.toml -o b.part --dpi 144 --tile 1/2");
    folder.done("merge a.part b.part -o merged.png");
    assert_eq!(folder.bytes("whole.png"), folder.bytes("merged.png"));
    // What is drawn at the edge of a part is that of the whole.
    folder.done("render a.toml -o part.png --dpi 144 --crop 3,5,20,17");
    let read = |name: &str| {
        let bytes = folder.bytes(name);
        let picture = phong::image::Picture::read(&bytes).unwrap();
        (picture.size, picture.plane("R").unwrap().to_vec())
    };
    let ((size, part), (_, whole)) = (read("part.png"), read("whole.png"));
    assert_eq!(size, [17, 12]);
    for y in 0..12 {
        let first = (y + 5) * 40 + 3;
        assert_eq!(part[y * 17..][..17], whole[first..][..17], "row {y}");
    }
    assert!(whole.iter().filter(|level| **level == 0.0).count() > 30, "there are lines");
    // OpenEXR has both pictures, and nothing that was not asked for.
    folder.done("render a.toml -o a.exr --dpi 144");
    let exr = phong::image::Picture::read(&folder.bytes("a.exr")).unwrap();
    let names: Vec<&str> = exr.planes.iter().map(|plane| plane.name.as_str()).collect();
    assert_eq!(names, ["A", "B", "G", "R", "finished.A", "finished.B", "finished.G", "finished.R"]);
    let pfm = phong::image::Picture::read(&folder.bytes("plain.pfm")).unwrap();
    assert_eq!(exr.plane("R"), pfm.plane("R"));
    let reader = png::Decoder::new(std::io::Cursor::new(folder.bytes("whole.png"))).read_info();
    let dims = reader.unwrap().info().pixel_dims.unwrap();
    assert_eq!((dims.xppu, dims.yppu), (5669, 5669));
}

const FURNITURE: &str = "[furniture]\nsize = 4\n[title]\ntext = \"T\"\n[scale_bar]\n[axes]\nlength = 5\n\
                         [[label]]\ntext = \"L\"\nat = [0, 0, 9]\n";

#[test]
fn a_figure_has_its_furniture_in_shares_and_as_outlines() {
    let folder = given(&[("a.toml", &format!("{BALLS}{FURNITURE}")), ("b.toml", BALLS)]);
    folder.done("render a.toml -o whole.png");
    folder.done("render b.toml -o bare.png");
    assert_ne!(folder.bytes("whole.png"), folder.bytes("bare.png"));
    for share in ["0/2", "1/2"] {
        folder.done(&format!("render a.toml -o {}.part --tile {share}", &share[..1]));
    }
    folder.done("merge 0.part 1.part -o merged.png");
    assert_eq!(folder.bytes("whole.png"), folder.bytes("merged.png"));
    folder.done("merge 0.part 1.part -o merged.svg");
    folder.done("render a.toml -o a.svg");
    let svg = String::from_utf8(folder.bytes("a.svg")).unwrap();
    assert_eq!(svg.as_bytes(), folder.bytes("merged.svg"));
    assert!(svg.contains("<title>T</title>") && !svg.contains("<text"), "{svg}");
    folder.when("render a.toml --terms -o b.svg").is_refused(&["an SVG holds the picture"]);
    folder.done("check a.toml");
    folder.when("check a.toml --strict").is_refused(&["axes: it stands over the title"]);
}

#[test]
fn letters_that_the_font_lacks_are_told() {
    let title = |text: &str| format!("{BALLS}[title]\ntext = \"{text}\"\n");
    let folder = given(&[("a.toml", &title("水 b")), ("b.toml", &title("µm"))]);
    assert!(folder.done("render a.toml").err.contains("title: the font has no 水 (U+6C34)"));
    assert_eq!(folder.done("render b.toml").err, "");
    folder.when("check a.toml --strict").is_refused(&["the font has no 水"]);
}

#[test]
fn furniture_that_has_no_room_is_told_by_the_size_that_is_asked_for() {
    let folder = given(&[("a.toml", &format!("{BALLS}[title]\ntext = \"Congratulations\"\n"))]);
    let told = "title: it reaches out of the picture";
    assert!(folder.done("render a.toml").err.contains(told));
    assert_eq!(folder.done("render a.toml --size 400x300").err, "");
    folder.when("render a.toml --strict").is_refused(&[told]);
    assert!(folder.done("check a.toml").err.contains(told));
    folder.when("check a.toml --strict").is_refused(&[told]);
}

#[test]
fn two_eyes_see_one_picture_beside_or_over_the_other() {
    let folder = given(&[("a.toml", &format!("{BALLS}{FURNITURE}"))]);
    for view in ["left", "right", "side-by-side", "anaglyph"] {
        folder.done(&format!("render a.toml --stereo {view} -o {view}.png"));
    }
    let read = |name: &str| {
        let bytes = folder.bytes(&format!("{name}.png"));
        let picture = phong::image::Picture::read(&bytes).unwrap();
        (picture.size, ["R", "G"].map(|plane| picture.plane(plane).unwrap().to_vec()))
    };
    let ((size, [left, _]), (_, [right, cyan])) = (read("left"), read("right"));
    assert_ne!(left, right);
    let (both, [beside, _]) = read("side-by-side");
    assert_eq!((size, both), ([40, 30], [80, 30]));
    for (y, row) in beside.chunks(80).enumerate() {
        assert_eq!(row[..40], left[40 * y..][..40], "row {y}");
        assert_eq!(row[40..], right[40 * y..][..40], "row {y}");
    }
    // But for the mixed edges of letters.
    let (_, [red, green]) = read("anaglyph");
    let differing = |a: &[f32], b: &[f32]| a.iter().zip(b).filter(|(a, b)| a != b).count();
    assert!(differing(&red, &left) < 200 && differing(&green, &cyan) < 200);
    assert_ne!(red, right);
    folder
        .when("render a.toml --stereo anaglyph --tile 0/2")
        .is_refused(&["both eyes does not take --tile", "--stereo left"]);
    folder.when("render a.toml --stereo left --eye-distance 0").is_refused(&["above 0"]);
    folder.when("render a.toml --eye-distance 1").is_refused(&["--stereo"]);
    folder.when("render a.toml --stereo anaglyph -o a.svg").is_refused(&["one eye"]);
    folder.done("render a.toml --stereo left --tile 0/1 -o l.part");
    folder.done("merge l.part -o merged.png");
    assert_eq!(folder.bytes("merged.png"), folder.bytes("left.png"));
}

#[test]
fn tone_is_the_same_in_shares_of_a_crop_that_of_the_crop_and_typed_as_it_is_written() {
    let written = "[tone]\nexposure = \"auto\"\nwhite_balance = 3200\ncurve = \"filmic\"\n";
    let folder = given(&[("a.toml", BALLS), ("toned.toml", &format!("{BALLS}{written}"))]);
    let how = "--exposure auto --white-balance 3200 --tone filmic";
    let told = folder.done(&format!("render a.toml {how} -o whole.png --json")).json();
    let stops = told["exposure"].as_f64().unwrap();
    assert!(stops != 0.0, "{told}");
    folder.done("render toned.toml -o written.png");
    assert_eq!(folder.bytes("whole.png"), folder.bytes("written.png"));
    assert_eq!(folder.bytes("whole.png"), merged(&folder, "toned.toml"));
    // What auto has found, typed, gives the same; and a part of the picture is exposed by itself.
    folder.done(&format!("merge 0.part 1.part --exposure {stops} -o typed.png"));
    assert_eq!(folder.bytes("whole.png"), folder.bytes("typed.png"));
    let part = folder.done("render toned.toml --crop 0,0,20,12 -o part.png --json").json();
    assert_ne!(part["exposure"], told["exposure"]);
    // OpenEXR has the light as it is, and what a PNG makes levels of beside it; by exposure alone nothing is beside it.
    folder.done(&format!("render a.toml --exposure {stops} -o exposed.exr"));
    folder.done("render a.toml -o plain.exr");
    assert_eq!(folder.bytes("plain.exr"), folder.bytes("exposed.exr"));
    folder.done("render toned.toml -o toned.exr");
    let picture = |name| phong::image::Picture::read(&folder.bytes(name)).unwrap();
    let (plain, toned, seen) = (picture("plain.exr"), picture("toned.exr"), picture("whole.png"));
    for name in ["R", "G", "B"] {
        assert_eq!(plain.plane(name), toned.plane(name));
        let finished = toned.plane(&format!("finished.{name}")).unwrap();
        for (&value, level) in finished.iter().zip(seen.plane(name).unwrap()) {
            let encoded = phong_scene::srgb_encode(f64::from(value.clamp(0.0, 1.0)));
            assert_eq!((encoded * 255.0 + 0.5).floor(), f64::from(level * 255.0).round());
        }
    }
    // No other file has it.
    folder.done("render a.toml -o plain.pfm");
    folder.done("render toned.toml -o toned.pfm");
    assert_eq!(folder.bytes("plain.pfm"), folder.bytes("toned.pfm"));
    folder.when("merge 0.part 1.part -o b.png --tone filmc").is_refused(&["--tone", "reinhard"]);
    folder.when("render a.toml --white-balance 300").is_refused(&["1700"]);
    folder.when("render a.toml --white-balance black").is_refused(&["black"]);
    folder.when("render a.toml --exposure lots").is_refused(&["auto"]);
    folder.when("render a.toml --tone reinhard:0").is_refused(&["above 0"]);
}

#[test]
fn what_explain_says_of_tone_ends_in_the_bytes_of_the_picture() {
    let tone = "[tone]\nexposure = \"auto\"\nneutral = \"#ffd0a0\"\ncurve = \"reinhard\"\n";
    let outline = "[outline]\nwidth = 1.5\n";
    let title = "[title]\ntext = \"Balls\"\n";
    let labels = "[[label]]\ntext = \"seen\"\nat = [0, 0, 3]\n\n\
                  [[label]]\ntext = \"hidden\"\nat = [0, 0, -9]\noffset = [0, -9]\n";
    let written = format!("{BALLS}{outline}{tone}{title}{labels}");
    let folder = given(&[("a.toml", &written)]);
    folder.done("render a.toml --samples 2 -o a.png");
    let drawn = phong::image::Picture::read(&folder.bytes("a.png")).unwrap();
    let (mut outlined, mut covered) = (0, 0);
    let some = (0..30).step_by(3).flat_map(|y| (0..40).step_by(7).map(move |x| [x, y]));
    for [x, y] in some {
        let told = folder.done(&format!("explain a.toml {x} {y} --samples 2 --json")).json();
        let steps = told["tone"].as_array().unwrap().iter().map(|s| s["step"].as_str().unwrap());
        let steps: Vec<_> = steps.collect();
        let toned = steps.strip_prefix(&["outlined"]).unwrap_or(&steps);
        assert_eq!(toned, ["exposed", "balanced", "toned"]);
        outlined += steps.len() - toned.len();
        covered += usize::from(!told["furniture"].is_null());
        for (c, name) in ["R", "G", "B"].into_iter().enumerate() {
            let level = drawn.plane(name).unwrap()[y * 40 + x] * 255.0;
            assert_eq!(told["srgb8"][c], level.round() as u64, "{name} of {x}, {y}");
        }
    }
    assert!(outlined > 2 && covered > 2, "{outlined} {covered}");
    let text = String::from_utf8(folder.done("explain a.toml 20 15 --samples 2").out).unwrap();
    for words in ["exposed", "= linear × 2^", "balanced", "Reinhard's curve, white at 4"] {
        assert!(text.contains(words), "{words} in {text}");
    }
    let latex = folder.done("explain a.toml 20 15 --samples 2 --latex --exposure 1").out;
    assert!(String::from_utf8(latex).unwrap().contains("xrightarrow{\\text{toned}}"));
    folder.done("explain a.toml --html page.html --size 8x6");
}

#[test]
fn steps_of_luminance_are_the_same_in_shares_and_crops_and_told_to_the_byte() {
    let written = BALLS.replacen("[image]\n", "[image]\ncel = 3\n", 1);
    let folder = given(&[("a.toml", &written), ("plain.toml", BALLS)]);
    folder.done("render a.toml -o whole.png");
    folder.done("render plain.toml -o plain.png");
    assert_ne!(folder.bytes("whole.png"), folder.bytes("plain.png"));
    assert_eq!(folder.bytes("whole.png"), merged(&folder, "a.toml"));
    folder.done("render a.toml -o part.png --crop 3,5,20,17");
    let picture = |name| phong::image::Picture::read(&folder.bytes(name)).unwrap();
    let (whole, part) = (picture("whole.png"), picture("part.png"));
    for (whole, part) in whole.planes.iter().zip(&part.planes) {
        for (i, value) in part.values.iter().enumerate() {
            assert_eq!(*value, whole.values[40 * (5 + i / 17) + 3 + i % 17]);
        }
    }
    let mut changed = 0;
    for [x, y] in [[20, 15], [17, 14], [3, 25], [26, 12], [0, 0]] {
        let told = folder.done(&format!("explain a.toml {x} {y} --json")).json();
        let steps = told["tone"].as_array().unwrap();
        assert_eq!(steps[0]["step"], "stepped");
        changed += u32::from(steps[0]["linear"] != told["linear"]);
        for (c, name) in ["R", "G", "B"].into_iter().enumerate() {
            let level = whole.plane(name).unwrap()[y * 40 + x] * 255.0;
            assert_eq!(told["srgb8"][c], level.round() as u64, "{name} of {x}, {y}");
        }
    }
    assert!(changed > 1, "{changed}");
    folder.done("explain a.toml --html page.html --size 8x6");
    folder.done("render a.toml -o b.png --exposure auto");
}

#[test]
fn a_look_is_put_on_and_printed_as_text() {
    let folder = balls();
    let then = folder.done("render a.toml --look ink --toml");
    let text = String::from_utf8(then.out.clone()).unwrap();
    assert!(text.contains("[outline]") && text.contains("background = 1"), "{text}");
    assert!(!text.contains("[[sphere]]") && !folder.names().contains(&"a.png".to_owned()));
    folder.done("render a.toml --look ink -o ink.png");
    folder.done("render a.toml --look ink --samples 9 --background tomato -o red.png");
    assert_ne!(folder.bytes("ink.png"), folder.bytes("red.png"));
    folder.when("render a.toml --look inc").is_refused(&["--look", "did you mean ink?"]);
    folder.when("render a.toml --dpi 0").is_refused(&["--dpi", "from 1 to 100000"]);
}

#[test]
fn a_crop_has_the_size_of_the_crop_and_the_pixels_of_the_whole() {
    let folder = balls();
    folder.done("render a.toml -o whole.pfm");
    folder.done("render a.toml -o part.pfm --crop 3,5,20,17");
    let picture = |name| phong::image::Picture::read(&folder.bytes(name)).unwrap();
    let (whole, part) = (picture("whole.pfm"), picture("part.pfm"));
    assert_eq!(part.size, [17, 12]);
    for (c, (whole, part)) in whole.planes.iter().zip(&part.planes).enumerate() {
        for (i, value) in part.values.iter().enumerate() {
            let (x, y) = (3 + i % 17, 5 + i / 17);
            assert_eq!(*value, whole.values[40 * y + x], "channel {c} at {x}, {y}");
        }
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    let folder = balls();
    for threads in [1, 2, 7] {
        folder.done(&format!("render a.toml --threads {threads} -o {threads}.exr --terms"));
    }
    assert_eq!(folder.bytes("1.exr"), folder.bytes("2.exr"));
    assert_eq!(folder.bytes("1.exr"), folder.bytes("7.exr"));
}

#[test]
fn shares_merge_to_the_very_bytes_of_the_whole() {
    let folder = balls();
    let how = "--bits 16 --exposure -0.5 --aov depth";
    folder.done(&format!("render a.toml -o whole.png {how}"));
    for i in 0..3 {
        folder.done(&format!("render a.toml -o {i}.part --tile {i}/3 {how}"));
    }
    folder.done("merge 2.part 0.part 1.part -o merged.png");
    assert_eq!(folder.bytes("whole.png"), folder.bytes("merged.png"));
    assert_eq!(folder.bytes("whole.depth.png"), folder.bytes("merged.depth.png"));

    folder.when("merge 0.part 2.part -o b.png").is_refused(&["share 1/3 is missing"]);
    folder.when("merge 0.part 0.part -o b.png").is_refused(&["0.part", "both are share 0/3"]);
    folder.done(&format!("render a.toml -o other.part --tile 1/3 --samples 5 {how}"));
    folder.when("merge 0.part other.part -o b.png").is_refused(&["samples is 4 and 5"]);
    folder.when("merge 0.part a.toml -o b.png").is_refused(&["a.toml", "no part file"]);
    folder.when("merge 0.part 1.part 2.part -o 1.part --output-format png").is_refused(&["over"]);
    assert!(!folder.path("b.png").exists());
}

#[test]
fn layers_lie_beside_the_picture_or_in_it() {
    let folder = balls();
    folder.done("render a.toml --terms --aov normal,depth,normal -o x.png");
    let names = folder.names().join(" ");
    let beside = "a.toml x.ambient.png x.background.png x.depth.png x.diffuse.png x.normal.png \
                  x.png x.reflection.png x.specular.png x.transmission.png";
    assert_eq!(names, beside);
    let folder = balls();
    folder.done("render a.toml --terms --aov normal -o x.exr");
    assert_eq!(folder.names(), ["a.toml", "x.exr"]);
}

#[test]
fn json_tells_what_was_done() {
    let folder = balls();
    let told = folder.done("render a.toml --json --crop 0,0,20,30 --threads 1").json();
    assert_eq!(told["output"], "a.png");
    assert_eq!(told["size"], serde_json::json!([20, 30]));
    assert_eq!((&told["samples"], &told["threads"]), (&4.into(), &1.into()));
    assert_eq!(told["rays"]["primary"], 20 * 30 * 4);
    for stage in ["read", "build", "trace", "write", "total"] {
        assert!(told["seconds"][stage].as_f64().unwrap() >= 0.0, "{stage}");
    }
    assert!(told["warnings"].as_array().unwrap().is_empty());
    let told = folder.done("info a.toml --json").json();
    let counts = ["format", "triangles", "spheres", "primitives", "lights", "materials", "bytes"];
    assert!(counts.iter().all(|key| !told[key].is_null()), "{told}");
    assert_eq!((&told["spheres"], &told["primitives"]), (&1.into(), &2.into()));
    let told = folder.done("bench a.toml --json").json();
    for kind in ["primary", "shadow", "secondary"] {
        assert!(told["rays_per_second"][kind].as_f64().unwrap() > 0.0, "{kind}");
    }
    assert!(told["bytes_per_primitive"].as_f64().unwrap() > 0.0);
}

#[cfg(unix)]
#[test]
fn links_are_written_through_and_devices_stay_devices() {
    use std::os::unix::fs::FileTypeExt;
    let folder = balls();
    fs::write(folder.path("real.png"), b"old").unwrap();
    std::os::unix::fs::symlink("real.png", folder.path("link.png")).unwrap();
    folder.done("render a.toml -o link.png");
    assert!(folder.path("link.png").is_symlink());
    assert_eq!(png_size(&folder.bytes("real.png")), (40, 30));
    folder.done("render a.toml -o /dev/null --output-format exr");
    assert!(fs::metadata("/dev/null").unwrap().file_type().is_char_device());
}

#[test]
fn compare_answers_with_numbers_and_an_exit_code() {
    let folder = balls();
    folder.done("render a.toml -o a.png");
    folder.done("render a.toml -o b.png --no-shadows");
    folder.done("render a.toml -o small.png --size 20x30");
    assert_eq!(folder.done("compare a.png a.png --json").json()["max"], 0.0);
    let then = folder.when("compare a.png b.png --json --diff d.png");
    assert_eq!(then.code, Some(1));
    let max = then.json()["max"].as_f64().unwrap();
    assert!(max > 0.1);
    assert_eq!(png_size(&folder.bytes("d.png")).0, 6 * 40 + 16);
    folder.done(&format!("compare a.png b.png --tolerance {max}"));
    folder.when("compare a.png small.png").is_refused(&["40x30", "20x30"]);
}

/// A render that runs until a file of this ending is there, and some time more, then is interrupted
/// unless it has ended.
#[cfg(target_os = "linux")]
fn interrupted(folder: &Given, words: &str, until: &str, time: Duration) -> Then {
    let mut command = folder.command(words);
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let begun = Instant::now();
    while child.try_wait().unwrap().is_none()
        && !folder.names().iter().any(|name| name.ends_with(until))
    {
        assert!(begun.elapsed() < Duration::from_mins(1), "no {until}: {:?}", folder.names());
        sleep(Duration::from_millis(5));
    }
    sleep(time);
    if child.try_wait().unwrap().is_none() {
        let kill = format!("kill -INT {}", child.id());
        assert!(std::process::Command::new("sh").args(["-c", &kill]).status().unwrap().success());
    }
    Then::of(child.wait_with_output().unwrap())
}

#[cfg(target_os = "linux")]
#[test]
fn an_interrupted_render_leaves_nothing_behind() {
    let folder = balls();
    let words = "render a.toml --size 2000x2000 --samples 1024 --terms";
    let then = interrupted(&folder, words, ".tmp", Duration::ZERO);
    assert_eq!(then.code, Some(130), "{}", then.err);
    assert_eq!(folder.names(), ["a.toml"]);
}

/// Tiles that the checkpoint has whole, and with the sums to go on from.
#[cfg(target_os = "linux")]
fn kept(folder: &Given, checkpoint: &str) -> (usize, usize) {
    let part = Part::read(&mut &*folder.bytes(checkpoint), u64::MAX).unwrap();
    let whole = part.film.done.iter().filter(|&&done| done).count();
    (whole, part.film.film_tiles().count())
}

#[cfg(target_os = "linux")]
#[test]
fn a_render_interrupted_again_and_again_ends_in_the_same_bytes() {
    let folder = balls();
    let words = "render a.toml --size 160x120 --samples 64 --threads 1";
    folder.done(&format!("{words} -o w.png"));
    for (name, passes) in [("p.png", "--passes"), ("r.png", "")] {
        let resumed = format!("{words} --resume {passes} -o {name}");
        let part = format!("{name}.part");
        let mut before = (0, 0);
        // Every run has more time than the one before, so that there is a last one.
        for run in 0.. {
            let time = Duration::from_millis(10 << run);
            let then = interrupted(&folder, &resumed, &part, time);
            if then.code == Some(0) {
                break;
            }
            assert_eq!((then.code, then.err.as_str()), (Some(130), ""));
            let now = kept(&folder, &part);
            assert!(now.0 >= before.0 && now.1 >= before.1, "{before:?}, then {now:?}");
            before = now;
        }
        assert_eq!(folder.bytes(name), folder.bytes("w.png"), "{passes}");
        assert!(!folder.path(&part).exists());
    }
}

#[cfg(target_os = "linux")]
#[test]
fn an_interrupted_render_keeps_its_checkpoint_and_no_other_render_takes_it() {
    let folder = balls();
    let words = "render a.toml --size 2000x2000 --samples 1024 --resume -o r.png";
    let then = interrupted(&folder, words, "r.png.part", Duration::ZERO);
    assert_eq!(then.code, Some(130), "{}", then.err);
    assert_eq!(folder.names(), ["a.toml", "r.png.part"]);
    let other = format!("{words} --seed 7");
    folder.when(&other).is_refused(&["r.png.part", "seed is 0, not 7", "remove it"]);
}

#[test]
fn a_damaged_checkpoint_is_refused_and_kept() {
    let folder = balls();
    fs::write(folder.path("a.png.part"), b"phong part 4\nrubbish\n\n").unwrap();
    folder.when("render a.toml --resume").is_refused(&["a.png.part", "damaged", "remove it"]);
    assert_eq!(folder.names(), ["a.png.part", "a.toml"]);
}
