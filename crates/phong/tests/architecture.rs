//! The house rules as tests: each rule reads the whole source tree, and is itself tried on a planted
//! violation, so that a rule that has gone blind is noticed.

use std::fs;
use std::path::{Path, PathBuf};

/// The trunk's rooms, lowest first. A room imports only rooms that stand before it.
const ROOMS: &[&str] = &[
    // 1: numbers
    "math",
    // 2: formulas, and where samples fall
    "reflectance",
    "sampling",
    "filter",
    // 3: what a scene is made of, as the renderer holds it
    "texture",
    "camera",
    "light",
    "material",
    // 4: a scene made ready, and a point on a surface
    "interaction",
    "geometry",
    "look",
    "view",
    // 5: the road of one ray, and who listens
    "witness",
    "integrator",
    // 6: pixels
    "aov",
    "film",
    "render",
    // 7: what leaves the house
    "image",
    "part",
    "explain",
];

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

/// A file of the tree: its path from the root, with `/`, and its text.
struct File {
    path: String,
    text: String,
}

type Rule = fn(&File) -> Vec<String>;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().expect("the workspace")
}

/// Every text file of the project: what git would track, without asking git.
fn tree() -> Vec<File> {
    const KINDS: &[&str] =
        &["rs", "toml", "py", "pyi", "js", "css", "html", "md", "sh", "pov", "yml", "run"];
    const ELSEWHERE: &[&str] =
        &["target", "node_modules", "corpus", "artifacts", "book/book", "book/src/made"];
    let root = root();
    let (mut files, mut folders) = (Vec::new(), vec![root.clone()]);
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).expect("a readable folder") {
            let path = entry.expect("a readable entry").path();
            let name = path.strip_prefix(&root).expect("inside the root");
            let name = name.to_string_lossy().replace('\\', "/");
            let hidden = name.starts_with('.') && !name.starts_with(".ci");
            if hidden || ELSEWHERE.iter().any(|e| name.ends_with(e)) {
                continue;
            }
            if path.is_dir() {
                folders.push(path);
            } else if name == ".ci/run"
                || path.extension().is_some_and(|e| KINDS.iter().any(|k| e == *k))
            {
                // Broken text is what some tests of the readers feed on.
                let bytes = fs::read(&path).expect("a readable file");
                let text = String::from_utf8_lossy(&bytes).into_owned();
                files.push(File { path: name, text });
            }
        }
    }
    files.sort_by(|a, b| a.path.cmp(&b.path));
    files
}

/// Fails with everything that `rule` has against the tree, after showing that it can speak: it
/// must object to each of the `planted` files.
#[track_caller]
fn hold(rule: Rule, planted: &[(&str, &str)]) {
    for (path, text) in planted {
        let file = File { path: (*path).to_owned(), text: (*text).to_owned() };
        assert!(!rule(&file).is_empty(), "the rule is blind to this in {path}:\n{text}");
    }
    let tree = tree();
    assert!(tree.len() > 30, "only {} files found", tree.len());
    let found: Vec<String> = tree
        .iter()
        .flat_map(|file| rule(file).into_iter().map(|said| format!("{}: {said}", file.path)))
        .collect();
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn a_room_imports_only_rooms_below_it() {
    hold(
        storeys,
        &[
            ("crates/phong/src/math/dir.rs", "use crate::film::Film;"),
            ("crates/phong/src/light.rs", "use crate::{math::Dir3, render};"),
            ("crates/phong/src/film.rs", "fn f() -> Option<crate::explain::Explanation> { None }"),
            ("crates/phong/src/film.rs", "use super::math::Dir3;"),
            ("crates/phong/src/film/tile.rs", "use super::super::math::Dir3;"),
            ("crates/phong/src/film.rs", "use crate::Film;"),
            ("crates/phong/src/film.rs", "use crate::*;"),
            ("crates/phong/src/cellar.rs", "//! A room on no storey."),
        ],
    );
}

#[test]
fn the_leaves_import_nothing_of_the_project() {
    hold(
        leaves,
        &[
            ("crates/phong-bvh/src/ray.rs", "use phong_scene::Rgb;"),
            ("crates/phong-scene/src/scene.rs", "fn f(b: &phong_bvh::Bvh) {}"),
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

fn storeys(file: &File) -> Vec<String> {
    let Some(inner) = file.path.strip_prefix("crates/phong/src/") else { return Vec::new() };
    let Some(path) = inner.strip_suffix(".rs") else { return Vec::new() };
    if path == "lib" {
        return Vec::new(); // the door stands above all rooms
    }
    let path = path.strip_suffix("/mod").unwrap_or(path);
    let room = path.split('/').next().unwrap_or_default();
    let Some(own) = ROOMS.iter().position(|r| *r == room) else {
        return vec![format!("the room `{room}` stands on no storey: name it in ROOMS")];
    };
    let code = code_of(&file.text);
    let mut found = Vec::new();
    for (name, line) in crate_paths(&code) {
        match ROOMS.iter().position(|r| *r == name) {
            Some(other) if other <= own => {}
            Some(_) => found.push(format!("line {line}: `{room}` imports `{name}`, above it")),
            None => found.push(format!("line {line}: `crate::{name}` hides the room it is from")),
        }
    }
    // `super::…::super::` out of the room: at the outermost level of the file only, where `super`
    // is the file's parent and not the file itself, as it is within `mod tests`.
    let out = "super::".repeat(path.matches('/').count() + 1);
    let mut depth = 0_u32;
    for (number, line) in code.lines().enumerate() {
        if depth == 0 && line.contains(&out) {
            found.push(format!("line {}: write `crate::` for the crate's root", number + 1));
        }
        for c in line.chars() {
            match c {
                '{' => depth += 1,
                '}' => depth = depth.saturating_sub(1),
                _ => {}
            }
        }
    }
    found
}

/// The first name after each `crate::` (each of a group's), with its line.
fn crate_paths(code: &str) -> Vec<(String, usize)> {
    let word = |c: char| c.is_alphanumeric() || c == '_';
    let mut found = Vec::new();
    for (at, _) in code.match_indices("crate::") {
        if code[..at].ends_with(|c| word(c) || c == '$' || c == ':') {
            continue;
        }
        let line = code[..at].matches('\n').count() + 1;
        let rest = &code[at + "crate::".len()..];
        if let Some(group) = rest.strip_prefix('{') {
            let (mut depth, mut name) = (0, String::new());
            for c in group.chars() {
                match c {
                    '{' => depth += 1,
                    '}' if depth == 0 => break,
                    '}' => depth -= 1,
                    ',' if depth == 0 => found.push((std::mem::take(&mut name), line)),
                    _ if depth == 0 => name.push(c),
                    _ => {}
                }
            }
            found.push((name, line));
        } else {
            let end = rest.find(|c| !word(c) && c != '*').unwrap_or(rest.len());
            found.push((rest[..end].to_owned(), line));
        }
    }
    for (name, _) in &mut found {
        let first = name.trim().split(|c: char| c == ':' || c.is_whitespace()).next();
        *name = first.unwrap_or_default().to_owned();
    }
    found.retain(|(name, _)| !name.is_empty());
    found
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

fn has_extension(path: &str, extension: &str) -> bool {
    Path::new(path).extension().is_some_and(|e| e == extension)
}

/// The words of a text, each with what follows it.
fn words(code: &str) -> impl Iterator<Item = (&str, &str)> {
    code.split(|c: char| !c.is_alphanumeric() && c != '_').filter(|w| !w.is_empty()).map(|word| {
        let end = word.as_ptr() as usize - code.as_ptr() as usize + word.len();
        (word, &code[end..])
    })
}

/// Rust source without comments and without what is inside its strings; lines stay where they are.
fn code_of(text: &str) -> String {
    let bytes = text.as_bytes();
    let mut code = String::with_capacity(text.len());
    let mut i = 0;
    while i < bytes.len() {
        let rest = &text[i..];
        let skip = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if rest.starts_with("/*") {
            block_comment(rest)
        } else if rest.starts_with('"') {
            string(rest)
        } else if rest.starts_with("r\"") || rest.starts_with("r#") {
            raw_string(rest)
        } else if rest.starts_with('\'') {
            character(rest)
        } else {
            0
        };
        if skip == 0 {
            let c = rest.chars().next().unwrap_or_default();
            code.push(c);
            i += c.len_utf8();
        } else {
            code.extend(rest[..skip].chars().filter(|c| *c == '\n'));
            i += skip;
        }
    }
    code
}

fn block_comment(rest: &str) -> usize {
    let (mut depth, mut i) = (0, 0);
    while i < rest.len() {
        if rest.as_bytes()[i..].starts_with(b"/*") {
            depth += 1;
            i += 2;
        } else if rest.as_bytes()[i..].starts_with(b"*/") {
            depth -= 1;
            i += 2;
            if depth == 0 {
                return i;
            }
        } else {
            i += 1;
        }
    }
    rest.len()
}

fn string(rest: &str) -> usize {
    let mut escaped = false;
    for (i, b) in rest.bytes().enumerate().skip(1) {
        match b {
            _ if escaped => escaped = false,
            b'\\' => escaped = true,
            b'"' => return i + 1,
            _ => {}
        }
    }
    rest.len()
}

/// 0 for `r#name`, which is no string.
fn raw_string(rest: &str) -> usize {
    let hashes = rest[1..].bytes().take_while(|b| *b == b'#').count();
    if !rest[1 + hashes..].starts_with('"') {
        return 0;
    }
    let end = format!("\"{}", "#".repeat(hashes));
    let start = 2 + hashes;
    rest[start..].find(&end).map_or(rest.len(), |at| start + at + end.len())
}

/// 0 for a lifetime.
fn character(rest: &str) -> usize {
    let mut chars = rest.char_indices().skip(1);
    match chars.next() {
        Some((_, '\\')) => rest[3..].find('\'').map_or(0, |at| at + 4),
        Some(_) => match chars.next() {
            Some((at, '\'')) => at + 1,
            _ => 0,
        },
        None => 0,
    }
}

#[test]
fn comments_and_strings_are_not_code() {
    let source = "let a = \"unsafe \\\" unsafe\"; // unsafe\n/* unsafe /* unsafe */ unsafe */ \
                  let c = '\"'; let d = '\\''; let e = r#\"unsafe \" unsafe\"#; fn f<'a>(r#b: &'a u8)";
    let code = code_of(source);
    assert!(!code.contains("unsafe"), "{code}");
    assert!(code.contains("fn f<'a>(r#b: &'a u8)"), "{code}");
    assert_eq!(code.matches('\n').count(), 1);
}
