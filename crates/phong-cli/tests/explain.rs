//! `phong explain` as a program, in all its forms.
#![expect(clippy::unwrap_used, reason = "in a test, what is not there is a failure")]

mod support;

use support::{BALLS, Given, given};

fn balls() -> Given {
    given(&[("a.toml", BALLS)])
}

fn text(out: Vec<u8>) -> String {
    String::from_utf8(out).unwrap()
}

#[test]
fn a_pixel_is_told_with_its_equation_and_its_byte() {
    let folder = balls();
    let told = text(folder.done("explain a.toml 20 15 --samples 1").out);
    for words in ["sphere 1", "a.toml:14:1", "N·L", "R·E", "k_a C_a", "k_d (N·L) C_d", "(R·E)^32"]
    {
        assert!(told.contains(words), "`{words}` is not in:\n{told}");
    }
    assert!(told.contains("reflection"), "{told}");
}

#[test]
fn the_json_is_what_is_promised_and_its_terms_are_the_pixel() {
    let folder = balls();
    folder.done("render a.toml -o a.pfm --samples 1 --quiet");
    let picture = phong::image::Picture::read(&folder.bytes("a.pfm")).unwrap();
    for [x, y] in [[20, 15], [0, 0], [12, 25], [39, 29]] {
        let told = folder.done(&format!("explain a.toml {x} {y} --samples 1 --json")).json();
        assert_eq!(told["pixel"], serde_json::json!([x, y]));
        let linear: Vec<f32> =
            told["linear"].as_array().unwrap().iter().map(|v| v.as_f64().unwrap() as f32).collect();
        let drawn: Vec<f32> = picture.planes.iter().map(|p| p.values[y * 40 + x]).collect();
        assert_eq!(linear, drawn, "{x}, {y}");
        assert_eq!(told["srgb8"].as_array().unwrap().len(), 3);
        assert_eq!(told["terms"].as_object().unwrap().len(), 8);
    }
    let told = folder.done("explain a.toml 20 15 --samples 1 --json").json();
    let sample = &told["samples"][0];
    assert_eq!(
        (&sample["hit"]["object"], &sample["hit"]["at"]),
        (&"sphere 1".into(), &"a.toml:14:1".into())
    );
    let light = &sample["lights"][0];
    for key in ["name", "l", "r", "h", "n_dot_l", "r_dot_e", "visible", "c_d", "c_s", "diffuse"] {
        assert!(!light[key].is_null(), "{key} in {light}");
    }
    assert!(sample["reflection"]["ray"].is_object());
    assert!(sample["transmission"].is_null());
}

#[test]
fn a_document_a_drawing_and_a_page_stand_by_themselves() {
    let folder = balls();
    let latex = text(folder.done("explain a.toml 20 15 --samples 1 --latex").out);
    assert!(latex.starts_with("\\documentclass") && latex.trim_end().ends_with("\\end{document}"));
    assert_eq!(latex.matches("\\begin{").count(), latex.matches("\\end{").count(), "{latex}");

    folder.done("explain a.toml 20 15 --samples 1 --svg v.svg");
    let svg = text(folder.bytes("v.svg"));
    assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>") && !svg.contains("NaN"));

    let then = folder.done("explain a.toml --html p.html");
    assert!(then.err.contains("p.html: 40 × 30 pixels explained in"), "{}", then.err);
    let html = text(folder.bytes("p.html"));
    assert!(html.trim_end().ends_with("</html>"));
    assert!(html.contains("Quiz on this pixel") && html.contains("<summary>answer</summary>"));
    assert!(html.len() < 40 * 30 * 30 + 60_000, "{}: 2 MB for 320 × 180", html.len());
    for outside in ["http://", "https://", "src=\"/", "href=\"/"] {
        let own = html.replace("http://www.w3.org/", "");
        assert!(!own.contains(outside), "the page is offline, but has {outside}");
    }
}

#[test]
fn numbers_have_as_many_digits_as_are_asked_for() {
    let folder = balls();
    let told = text(folder.done("explain a.toml 20 15 --samples 1 --digits 3").out);
    let digits = |word: &str| word.trim_start_matches(['0', '.']).replace('.', "").len();
    let numbers = told.split([' ', '(', ')', ',', '^', '\n']).filter(|word| word.contains('.'));
    let numbers = numbers.filter(|word| word.parse::<f64>().is_ok() && !word.contains('e'));
    let long: Vec<_> = numbers.filter(|word| digits(word.trim_start_matches('-')) > 3).collect();
    // Where the sample lies, and the curve, are told with digits of their own.
    assert!(long.iter().all(|word| word.len() == 8 || word.ends_with(".5")), "{long:?}");
    for words in ["from the eye, o = (0, 1, 5)", "at (3, 4, 5)", "(a.toml:12:1)", "= -d"] {
        assert!(told.contains(words), "`{words}` is not in:\n{told}");
    }
    let latex = text(folder.done("explain a.toml 20 15 --samples 1 --latex --digits 3").out);
    assert!(latex.contains("\\paragraph{Reflection}"), "{latex}");
    folder.when("explain a.toml 20 15 --digits 0").is_refused(&["--digits", "from 1 to 17"]);
}

#[test]
fn a_ray_that_meets_nothing_is_told_but_has_no_vectors_to_draw() {
    let folder = given(&[(
        "a.toml",
        &BALLS.replace("[[plane]]\npoint = [0, 0, 0]\nnormal = [0, 1, 0]\n", ""),
    )]);
    assert!(text(folder.done("explain a.toml 0 0").out).contains("background"));
    folder.when("explain a.toml 0 0 --svg v.svg").is_refused(&["--svg", "meets nothing"]);
    assert_eq!(folder.names(), ["a.toml"]);
}

#[test]
fn no_drawing_and_no_page_is_written_over_what_is_read() {
    let mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let scene = format!("{BALLS}\n[[mesh]]\nfile = \"k.obj\"\n");
    let folder = given(&[("a.toml", &scene), ("k.obj", mesh)]);
    for words in ["20 15 --svg a.toml", "--html a.toml", "20 15 --svg k.obj", "--html k.obj"] {
        let told = ["write over the input", "give another file"];
        folder.when(&format!("explain a.toml {words}")).is_refused(&told);
    }
    assert_eq!(text(folder.bytes("a.toml")), scene);
    assert_eq!(text(folder.bytes("k.obj")), mesh);
}

#[test]
fn what_cannot_be_explained_is_refused_with_the_way_out() {
    let folder = balls();
    let refused = |words: &str, told: &[&str]| folder.when(words).is_refused(told);
    refused("explain a.toml 40 0", &["40", "x is from 0 to 39, y from 0 to 29"]);
    refused("explain a.toml 0 30", &["30", "y from 0 to 29"]);
    refused("explain a.toml -1 0", &["-1"]);
    refused("explain a.toml 1.5 0", &["1.5"]);
    refused("explain a.toml 3", &["Y"]);
    refused("explain a.toml", &["X"]);
    refused("explain nowhere.toml 0 0", &["nowhere.toml"]);
    refused("explain a.toml 0 0 --sample 9", &["--sample 9", "4 samples"]);
    refused("explain a.toml 0 0 --json --latex", &["--json", "--latex"]);
    refused("explain a.toml 0 0 --svg no/v.svg", &["no such folder"]);
    refused("explain a.toml --html p.html --size 5000x5000", &["--size", "page can hold"]);
    assert_eq!(folder.names(), ["a.toml"]);
}

#[test]
fn the_help_shows_how_each_form_is_asked_for() {
    let told = text(given(&[]).done("explain --help").out);
    for words in
        ["--json", "--latex", "--svg", "--html", "Examples:", "phong explain scene.toml 480 270"]
    {
        assert!(told.contains(words), "`{words}` is not in:\n{told}");
    }
}
