//! The modules of a crate, and what each of them imports, with re-exports followed to the module
//! that defines the name.

use std::collections::BTreeMap;

use crate::code::code_of;
use crate::tree::File;

/// A module's place below its crate's root: `["format", "toml", "write"]`; empty for the root.
pub(crate) type Path = Vec<String>;

/// The modules of one crate.
pub(crate) struct Source {
    modules: BTreeMap<Path, Module>,
}

/// One file of a crate.
pub(crate) struct Module {
    /// Its path in the project.
    pub(crate) file: String,
    /// Every path it names that starts with `crate`, `super` or `self`, from the crate's root, with
    /// its line.
    pub(crate) reaches: Vec<(Path, usize)>,
    /// Names brought in by `use`, and what they stand for.
    imports: BTreeMap<String, Path>,
}

impl Source {
    /// The library or program in `crates/NAME/src`.
    pub(crate) fn of(name: &str, tree: &[File]) -> Self {
        let folder = format!("crates/{name}/src/");
        let mut modules = BTreeMap::new();
        let places = tree.iter().filter_map(|file| {
            let inner = file.path.strip_prefix(&folder)?.strip_suffix(".rs")?;
            let inner = inner.strip_suffix("/mod").unwrap_or(inner);
            let root = inner == "lib" || inner == "main";
            let path =
                if root { Path::new() } else { inner.split('/').map(str::to_owned).collect() };
            Some((path, file))
        });
        let places: BTreeMap<Path, &File> = places.collect();
        for (path, file) in &places {
            let code = code_of(&file.text);
            let mut module =
                Module { file: file.path.clone(), reaches: Vec::new(), imports: BTreeMap::new() };
            for named in paths(&code) {
                let mut child = path.clone();
                child.extend(named.segments.first().cloned());
                let absolute = match absolute(path, &named) {
                    Some(absolute) => absolute,
                    // `use labels::Labels` beside `mod labels`.
                    None if named.import && places.contains_key(&child) => {
                        [path.as_slice(), &named.segments].concat()
                    }
                    None => continue,
                };
                if named.import
                    && named.inline == 0
                    && let Some(name) = named.alias.or(absolute.last().cloned())
                {
                    module.imports.insert(name, absolute.clone());
                }
                module.reaches.push((absolute, named.line));
            }
            modules.insert(path.clone(), module);
        }
        Self { modules }
    }

    /// Every module but the root, which stands above all others.
    pub(crate) fn modules(&self) -> impl Iterator<Item = (&Path, &Module)> {
        self.modules.iter().filter(|(path, _)| !path.is_empty())
    }

    /// The module that defines what `path` names; the root for what is defined nowhere.
    pub(crate) fn home(&self, path: &[String]) -> Path {
        self.home_within(path, 16)
    }

    fn home_within(&self, path: &[String], steps: u32) -> Path {
        let mut at = Path::new();
        for (i, name) in path.iter().enumerate() {
            let next = [at.as_slice(), std::slice::from_ref(name)].concat();
            if self.modules.contains_key(&next) {
                at = next;
                continue;
            }
            let import = self.modules.get(&at).and_then(|module| module.imports.get(name));
            return match import {
                Some(to) if steps > 0 => {
                    self.home_within(&[to.as_slice(), &path[i + 1..]].concat(), steps - 1)
                }
                _ => at,
            };
        }
        at
    }
}

/// A path as it is written.
struct Named {
    segments: Path,
    /// The name after `as`.
    alias: Option<String>,
    line: usize,
    /// Whether it stands in a `use`.
    import: bool,
    /// How many inline modules (`mod tests { … }`) it stands in.
    inline: usize,
}

/// From the crate's root, if it begins with `crate`, `super` or `self`.
fn absolute(module: &[String], named: &Named) -> Option<Path> {
    let mut here: Path = module.to_vec();
    here.extend(std::iter::repeat_n(String::new(), named.inline));
    let mut rest = named.segments.as_slice();
    match rest.first()?.as_str() {
        "crate" => {
            here.clear();
            rest = &rest[1..];
        }
        "self" => rest = &rest[1..],
        "super" => {
            while rest.first().is_some_and(|s| s == "super") {
                here.pop();
                rest = &rest[1..];
            }
        }
        _ => return None,
    }
    // What is named within the file's own inline modules stays in the file.
    here.retain(|segment| !segment.is_empty());
    here.extend(rest.iter().filter(|segment| *segment != "self").cloned());
    Some(here)
}

fn is_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// Every path of the code that stands in a `use`, or that starts with `crate`, `super` or `self`.
fn paths(code: &str) -> Vec<Named> {
    let mut found = Vec::new();
    // For each open brace, whether it opened an inline module.
    let mut open: Vec<bool> = Vec::new();
    let (mut before, mut at) = (["", ""], 0);
    while let Some(c) = code[at..].chars().next() {
        if !is_word(c) {
            match c {
                '{' => open.push(before[0] == "mod"),
                '}' => drop(open.pop()),
                _ => {}
            }
            at += c.len_utf8();
            continue;
        }
        let end = code[at..].find(|c| !is_word(c)).map_or(code.len(), |end| at + end);
        let word = &code[at..end];
        let follows = code[..at].ends_with(['$', ':', '.']);
        let import = word == "use";
        let start =
            if import { end + code[end..].len() - code[end..].trim_start().len() } else { at };
        let relative = matches!(word, "crate" | "super" | "self") && code[end..].starts_with("::");
        before = [before[1], word];
        at = end;
        if !follows && (import || relative) {
            let line = code[..start].matches('\n').count() + 1;
            let inline = open.iter().filter(|module| **module).count();
            let (paths, rest) = branches(&code[start..]);
            found.extend(paths.into_iter().map(|(segments, alias)| Named {
                segments,
                alias,
                line,
                import,
                inline,
            }));
            at = code.len() - rest.len();
        }
    }
    found
}

/// The paths of one tree such as `a::{b, c::d as e}`, each with its alias, and the code after it.
fn branches(code: &str) -> (Vec<(Path, Option<String>)>, &str) {
    let mut rest = code.trim_start();
    let mut segments = Path::new();
    loop {
        if let Some(group) = rest.strip_prefix('{') {
            let mut found = Vec::new();
            rest = group.trim_start();
            while !rest.is_empty() && !rest.starts_with('}') {
                let (inner, after) = branches(rest);
                found.extend(
                    inner.into_iter().map(|(p, alias)| ([&segments[..], &p].concat(), alias)),
                );
                let after = after.trim_start();
                let after = after.strip_prefix(',').unwrap_or(after).trim_start();
                if after.len() == rest.len() {
                    return (found, ""); // not a tree of names
                }
                rest = after;
            }
            return (found, rest.strip_prefix('}').unwrap_or(rest));
        }
        let end = match rest.strip_prefix('*') {
            Some(_) => 1,
            None => rest.find(|c| !is_word(c)).unwrap_or(rest.len()),
        };
        if end == 0 {
            break;
        }
        segments.push(rest[..end].to_owned());
        rest = &rest[end..];
        match rest.strip_prefix("::") {
            Some(more) => rest = more,
            None => break,
        }
    }
    let mut alias = None;
    if let Some(after) = rest.trim_start().strip_prefix("as ") {
        let after = after.trim_start();
        let end = after.find(|c| !is_word(c)).unwrap_or(after.len());
        alias = Some(after[..end].to_owned());
        rest = &after[end..];
    }
    (vec![(segments, alias)], rest)
}

#[test]
fn re_exports_are_followed_and_inline_modules_stay_in_their_file() {
    let file = |path: &str, text: &str| File { path: path.to_owned(), text: text.to_owned() };
    let tree = [
        file("crates/x/src/lib.rs", "mod a; pub use a::{inner::Thing as Other, Here};"),
        file("crates/x/src/a/mod.rs", "mod inner; pub use inner::Thing;"),
        file("crates/x/src/a/inner.rs", "mod t { use super::Local; use super::super::Up; }"),
        file(
            "crates/x/src/b.rs",
            "use crate::{Here, a::Thing}; fn f(_: crate::Other, _: Nothing) {}",
        ),
    ];
    let source = Source::of("x", &tree);
    let homes = |module: &str| -> Vec<String> {
        let path: Path = module.split('/').map(str::to_owned).collect();
        let module = &source.modules[&path];
        module.reaches.iter().map(|(to, _)| source.home(to).join("/")).collect()
    };
    assert_eq!(homes("b"), ["a", "a/inner", "a/inner"]);
    assert_eq!(homes("a/inner"), ["a/inner", "a"]);
    assert_eq!(homes("a"), ["a/inner"]);
}
