//! The house rules as tests: each rule reads the whole source tree, and is itself tried on a planted
//! violation, so that a rule that has gone blind is noticed.

mod circles;
mod code;
mod rooms;
mod source;
mod tree;

use std::fs;

use code::{code_of, words};
use tree::{File, has_extension, hold, root, tree};

/// Lines in a source file, tests included.
const MOST_LINES: usize = 600;

/// File names that say nothing about what is in them.
const NAMELESS: &[&str] =
    &["util", "utils", "common", "helper", "helpers", "misc", "core", "types", "manager", "stuff"];

/// Marks of work left undone, in pieces so that this file does not find itself.
const UNDONE: &[&str] = &[
    concat!("TO", "DO"),
    concat!("FIX", "ME"),
    concat!("XX", "X"),
    concat!("HA", "CK"),
    concat!("#[ign", "ore"),
    concat!("todo", "!("),
    concat!("unimpl", "emented!("),
];

#[test]
fn the_leaves_import_nothing_of_the_project() {
    hold(
        leaves,
        &[
            ("crates/phong-bvh/src/ray.rs", "use phong_scene::Rgb;"),
            ("crates/phong-scene/src/scene.rs", "fn f(b: &phong_bvh::World) {}"),
            ("crates/phong-scene/tests/ply.rs", "use phong::film::Film;"),
            ("crates/phong-bvh/Cargo.toml", "[dependencies]\nphong-scene.workspace = true\n"),
        ],
    );
}

#[test]
fn a_file_has_at_most_600_lines() {
    let long = "\n".repeat(MOST_LINES + 1);
    hold(lines, &[("crates/phong/src/film.rs", &long), ("python/phong/dask.py", &long)]);
}

#[test]
fn an_export_is_named() {
    hold(
        wildcards,
        &[
            ("crates/phong/src/lib.rs", "pub use film::*;"),
            ("crates/phong-bvh/src/lib.rs", "pub(crate) use ray::{self, aabb::*};"),
        ],
    );
}

#[test]
fn unsafe_code_lives_in_one_folder() {
    hold(
        unsafety,
        &[
            ("crates/phong/src/film.rs", "fn f() { unsafe { g() } }"),
            ("crates/phong-bvh/src/bvh.rs", "pub unsafe fn f() {}"),
        ],
    );
    let kept = File {
        path: "crates/phong-bvh/src/simd/prefetch.rs".into(),
        text: "fn f() { unsafe { g() } } // unsafe".into(),
    };
    assert!(unsafety(&kept).is_empty());
}

#[test]
fn nothing_is_left_undone() {
    let marks: Vec<(&str, &str)> =
        UNDONE.iter().map(|mark| ("crates/phong/src/film.rs", *mark)).collect();
    hold(undone, &marks);
}

#[test]
fn a_name_says_what_is_inside() {
    hold(
        nameless,
        &[
            ("crates/phong/src/utils.rs", ""),
            ("crates/phong/tests/common/mod.rs", ""),
            ("python/phong/helpers.py", ""),
        ],
    );
}

#[test]
fn a_gallery_scene_opens_by_saying_what_it_shows() {
    hold(
        opening,
        &[("scenes/balls.toml", "version = 1\n"), ("scenes/glass.toml", "#\n# Glass.\n")],
    );
}

#[test]
fn no_project_file_names_the_machine_it_was_written_on() {
    hold(places, &[("README.md", concat!("see /wo", "rk/data"))]);
}

#[test]
fn the_ray_crate_keeps_the_workspace_lints_but_for_unsafe_code() {
    let read = |path: &str| fs::read_to_string(root().join(path)).expect("a manifest");
    let workspace = lint_table(&read("Cargo.toml"), "workspace.lints");
    let own = lint_table(&read("crates/phong-bvh/Cargo.toml"), "lints");
    assert!(workspace.len() > 20, "the workspace's lints were not found");
    let expected: Vec<String> = workspace
        .iter()
        .map(|line| line.replace("unsafe_code = \"forbid\"", "unsafe_code = \"deny\""))
        .collect();
    assert_eq!(own, expected);
    assert_ne!(own, workspace, "`unsafe_code` is forbidden in both");
}

#[test]
fn every_other_crate_takes_the_workspace_lints() {
    let mut seen = 0;
    for file in tree() {
        let Some(rest) = file.path.strip_prefix("crates/") else { continue };
        if !rest.ends_with("/Cargo.toml") || rest.starts_with("phong-bvh/") {
            continue;
        }
        seen += 1;
        assert!(file.text.contains("[lints]\nworkspace = true\n"), "{}", file.path);
    }
    assert!(seen >= 3, "only {seen} crates found");
}

/// Lines of the two lint tables under `prefix`, without blank lines.
fn lint_table(manifest: &str, prefix: &str) -> Vec<String> {
    let (rust, clippy) = (format!("[{prefix}.rust]"), format!("[{prefix}.clippy]"));
    let mut inside = false;
    let mut table = Vec::new();
    for line in manifest.lines() {
        if line.starts_with('[') {
            inside = line == rust || line == clippy;
        } else if inside && !line.is_empty() {
            table.push(line.to_owned());
        }
    }
    table
}

fn leaves(file: &File) -> Vec<String> {
    let leaf = ["crates/phong-bvh/", "crates/phong-scene/"]
        .into_iter()
        .find(|leaf| file.path.starts_with(leaf));
    let Some(leaf) = leaf else { return Vec::new() };
    if file.path.ends_with("Cargo.toml") {
        let named = |line: &&str| line.trim_start().starts_with("phong");
        return file.text.lines().filter(named).map(|line| format!("depends: {line}")).collect();
    }
    if !has_extension(&file.path, "rs") {
        return Vec::new();
    }
    let itself = leaf["crates/".len()..].trim_end_matches('/').replace('-', "_");
    let code = code_of(&file.text);
    words(&code)
        .filter(|(w, after)| (*w == "phong" && after.starts_with("::")) || w.starts_with("phong_"))
        .filter(|(w, _)| *w != itself)
        .map(|(w, _)| format!("names `{w}`"))
        .collect()
}

fn lines(file: &File) -> Vec<String> {
    let source = ["rs", "py", "js"].iter().any(|e| has_extension(&file.path, e));
    let count = file.text.lines().count();
    if source && count > MOST_LINES { vec![format!("{count} lines")] } else { Vec::new() }
}

fn wildcards(file: &File) -> Vec<String> {
    if !has_extension(&file.path, "rs") {
        return Vec::new();
    }
    let code = code_of(&file.text);
    code.split(';')
        .map(|statement| statement.split_whitespace().collect::<Vec<_>>().join(" "))
        .filter(|s| (s.contains("pub use ") || s.contains(") use ")) && s.contains('*'))
        .map(|s| format!("exports what it does not name: {s}"))
        .collect()
}

fn unsafety(file: &File) -> Vec<String> {
    let allowed = ["crates/phong-bvh/src/simd/", "crates/phong-bvh/benches/"];
    if !has_extension(&file.path, "rs") || allowed.iter().any(|a| file.path.starts_with(a)) {
        return Vec::new();
    }
    let code = code_of(&file.text);
    let count = words(&code).filter(|(word, _)| *word == "unsafe").count();
    if count > 0 { vec![format!("says `unsafe` {count} times")] } else { Vec::new() }
}

fn undone(file: &File) -> Vec<String> {
    UNDONE
        .iter()
        .filter(|mark| file.text.contains(**mark))
        .map(|mark| format!("has a `{mark}`"))
        .collect()
}

fn nameless(file: &File) -> Vec<String> {
    file.path
        .split('/')
        .map(|part| part.split('.').next().unwrap_or_default())
        .filter(|stem| NAMELESS.contains(stem))
        .map(|stem| format!("`{stem}` names nothing"))
        .collect()
}

fn opening(file: &File) -> Vec<String> {
    let gallery = file.path.starts_with("scenes/") && has_extension(&file.path, "toml");
    let says = file.text.strip_prefix("# ").is_some_and(|rest| rest.trim_start().len() > 1);
    if gallery && !says { vec!["opens without a comment".to_owned()] } else { Vec::new() }
}

fn places(file: &File) -> Vec<String> {
    [concat!("/wo", "rk/"), concat!("/ro", "ot/"), concat!("/ho", "me/")]
        .into_iter()
        .filter(|place| file.text.contains(place))
        .map(|place| format!("names `{place}`"))
        .collect()
}
