//! The files of the project.

use std::fs;
use std::path::{Path, PathBuf};

/// A file of the tree: its path from the root, with `/`, and its text.
pub(crate) struct File {
    pub(crate) path: String,
    pub(crate) text: String,
}

/// What a rule has against one file.
pub(crate) type Rule = fn(&File) -> Vec<String>;

pub(crate) fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().expect("the workspace")
}

/// Every text file of the project: what git would track, without asking git.
pub(crate) fn tree() -> Vec<File> {
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
pub(crate) fn hold(rule: Rule, planted: &[(&str, &str)]) {
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

pub(crate) fn has_extension(path: &str, extension: &str) -> bool {
    Path::new(path).extension().is_some_and(|e| e == extension)
}
