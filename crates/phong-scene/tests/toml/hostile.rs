//! Texts that are meant to hurt: each is answered, in time, with errors.

use std::fmt::Write;

use phong_scene::{Limits, Memory, Reading, read};
use proptest::prelude::*;

const HEAD: &str = "version = 1\n[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\n\
    [[light]]\nkind = \"distant\"\ndirection = [0, 0, -1]\n";

fn read_files(files: &[(String, String)], limits: &Limits) -> Reading {
    let files = files
        .iter()
        .fold(Memory::new(), |files, (path, text)| files.with(path.as_str(), text.as_bytes()));
    read("a.toml", None, &files, limits)
}

fn read_text(text: &str) -> Reading {
    read_files(&[("a.toml".to_owned(), text.to_owned())], &Limits::default())
}

/// A scene exactly if there is no error, and everything said is said of a place.
fn assert_sound(reading: &Reading) {
    let wrong = reading.diagnostics.iter().any(phong_scene::Diagnostic::is_error);
    assert_eq!(reading.scene.is_none(), wrong);
    assert!(reading.diagnostics.iter().all(|d| d.span.is_some()));
    let _ = crate::told::all(&reading.diagnostics); // panics on a mark beyond its excerpt
}

#[track_caller]
fn assert_refused(reading: &Reading, why: &str) {
    assert_sound(reading);
    let said = crate::told::all(&reading.diagnostics);
    assert!(reading.scene.is_none() && said.contains(why), "{said}");
}

fn numbered(count: usize, text: impl Fn(usize) -> String) -> String {
    (0..count).map(text).collect()
}

#[test]
fn brackets_without_end_are_answered() {
    for open in ["a = [", "a = {a=", "a.", "[a.", "[["] {
        assert_refused(&read_text(&open.repeat(50_000)), "error");
        assert_refused(&read_text(&format!("{HEAD}x = {}", open.repeat(50_000))), "error");
    }
}

#[test]
fn a_long_chain_of_groups_does_not_exhaust_the_stack() {
    let chain = numbered(20_000, |i| format!("[[groups.g{i}.instance]]\ngroup = \"g{}\"\n", i + 1));
    let text = format!("{HEAD}{chain}[groups.g20000]\n[[instance]]\ngroup = \"g0\"\n");
    assert_refused(&read_text(&text), "groups go deeper than 32");
}

#[test]
fn groups_that_double_at_every_step_are_refused() {
    let doubling =
        numbered(31, |i| format!("[[groups.g{i}.instance]]\ngroup = \"g{}\"\n", i + 1).repeat(2));
    let ball = "[[groups.g31.sphere]]\ncenter = [0, 0, 0]\nradius = 1\n";
    let text = format!("{HEAD}{doubling}{ball}[[instance]]\ngroup = \"g0\"\n");
    assert_refused(&read_text(&text), "unfold into more than");
}

#[test]
fn includes_that_double_at_every_step_are_refused() {
    let mut files: Vec<_> = (0..30)
        .map(|i| {
            (format!("{i}.toml"), format!("[[include]]\nfile = \"{}.toml\"\n", i + 1).repeat(2))
        })
        .collect();
    files.push(("30.toml".to_owned(), String::new()));
    files.push(("a.toml".to_owned(), format!("{HEAD}[[include]]\nfile = \"0.toml\"\n")));
    assert_refused(&read_files(&files, &Limits::default()), "more than 10000 files");
}

#[test]
fn a_chain_of_includes_ends_at_the_limit() {
    let mut files: Vec<_> = (0..40)
        .map(|i| (format!("{i}.toml"), format!("[[include]]\nfile = \"{}.toml\"\n", i + 1)))
        .collect();
    files.push(("a.toml".to_owned(), format!("{HEAD}[[include]]\nfile = \"0.toml\"\n")));
    let limits = Limits { nesting: 5, ..Limits::default() };
    assert_refused(&read_files(&files, &limits), "includes go deeper than 5");
}

#[test]
fn a_text_beyond_the_limits_is_refused_and_so_are_many_small_ones() {
    let ball = "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\n".repeat(100);
    let files = [
        ("a.toml".to_owned(), format!("{HEAD}[[include]]\nfile = \"b.toml\"\n{ball}")),
        ("b.toml".to_owned(), ball),
    ];
    let text_bytes = files[0].1.len() as u64 - 1;
    let limits = Limits { text_bytes, ..Limits::default() };
    assert_refused(&read_files(&files, &limits), "a.toml\n");
    let limits = Limits { text_bytes: text_bytes + 1000, ..Limits::default() };
    assert_refused(&read_files(&files, &limits), "`b.toml` cannot be read: it has 4100 bytes");
    let limits = Limits { bytes: 3 * text_bytes, ..Limits::default() };
    let told = format!(
        "{} of memory at least, over the limit of {}",
        3 * (text_bytes + 1),
        3 * text_bytes
    );
    assert_refused(&read_files(&files, &limits), &told);
}

#[test]
fn thousands_of_wrong_names_among_thousands_of_right_ones_are_told_in_time() {
    let materials = numbered(3000, |i| format!("[materials.m{i}]\n"));
    let balls = numbered(3000, |i| {
        format!("[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"x{i}\"\n")
    });
    let reading = read_text(&format!("{HEAD}{materials}{balls}"));
    assert_refused(&reading, "there is no material \"x2999\"");
    assert_eq!(reading.diagnostics.iter().filter(|d| d.is_error()).count(), 3000);
}

#[test]
fn thousands_of_lights_and_balls_are_checked_in_time() {
    let light = "[[light]]\nkind = \"point\"\nposition = [0, 0, 0]\n".repeat(4000);
    let ball = "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\n".repeat(4000);
    assert!(read_text(&format!("{HEAD}{light}{ball}")).scene.is_some());
}

#[test]
fn a_hundred_thousand_mistakes_are_told_and_the_rest_counted() {
    let scene = "version = 1\n[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\n[image]\n";
    let reading = read_text(&(scene.to_owned() + &numbered(300_000, |i| format!("k{i} = {i}\n"))));
    assert!(reading.scene.is_none());
    let told: Vec<_> = reading.diagnostics.iter().map(ToString::to_string).collect();
    assert_eq!(told.len(), 100_001);
    assert!(told[0].contains(":6:1: error: unknown key \"k0\""), "{}", told[0]);
    let rest = "and 200000 more errors, beyond the first 100000 problems, which are told";
    assert!(told[100_000].ends_with(rest), "{}", told[100_000]);
}

#[test]
fn a_key_written_a_hundred_thousand_times_is_told_twenty_times() {
    let reading = read_text(&"a = 1\n".repeat(100_000));
    let twice = reading.diagnostics.iter().filter(|d| d.message.contains("is there already"));
    assert_eq!(twice.count(), 20);
}

#[test]
fn names_of_any_length_are_answered() {
    let mut text = HEAD.to_owned();
    let long = "n".repeat(1_000_000);
    write!(text, "[materials.{long}]\ncolor = \"{long}\"\n{long} = 1\n").expect("a string");
    write!(text, "[[sphere]]\nmaterial = \"x{long}\"\n[[mesh]]\nfile = \"{long}\"\n").expect("one");
    let reading = read_text(&text);
    assert_sound(&reading);
    assert!(crate::told::all(&reading.diagnostics).len() < 10_000, "long names are cut");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn any_text_is_read_without_a_panic(text in any::<String>()) {
        assert_sound(&read_text(&text));
    }

    #[test]
    fn any_words_of_the_language_are_read_without_a_panic(
        words in prop::collection::vec(prop::sample::select(WORDS), 0..60),
    ) {
        assert_sound(&read_text(&words.concat()));
    }

    /// A text cut anywhere, or with any byte of it struck out.
    #[test]
    fn a_torn_scene_is_read_without_a_panic(cut in 0_usize..2000, strike in any::<bool>()) {
        let whole = include_str!("good/the_scene_of_the_interface.toml");
        let cut = cut % whole.len();
        let rest = if strike { &whole[cut + 1..] } else { "" };
        assert_sound(&read_text(&format!("{}{rest}", &whole[..cut])));
    }
}

const WORDS: &[&str] = &[
    "version = 1\n",
    "[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\n",
    "[[sphere]]\n",
    "center = [0, 0, 0]\n",
    "radius = 1\n",
    "[[light]]\nkind = \"distant\"\n",
    "direction = [0, 0, -1]\n",
    "[materials.a]\n",
    "material = \"a\"\n",
    "color = ",
    "\"red\"",
    "[groups.a]\n",
    "[[groups.a.instance]]\n",
    "[[instance]]\n",
    "group = \"a\"\n",
    "[",
    "]",
    "{",
    "}",
    "= ",
    "\"",
    "'''",
    "\"\"\"",
    "\n",
    "\r\n",
    "é",
    "#",
    ", ",
    "1",
    "nan",
    "[[include]]\nfile = \"a.toml\"\n",
];
