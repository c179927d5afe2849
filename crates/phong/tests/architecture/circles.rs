//! No circle of imports: not among the rooms of a crate, and not among the parts of a folder.
//!
//! A folder and what is in it belong together, so what a part imports of the folder's own file is
//! not counted; what two parts of a folder import of each other is.

use std::collections::{BTreeMap, BTreeSet};

use crate::rooms::tables;
use crate::source::{Path, Source};
use crate::tree::{self, File};

/// Who imports whom among the parts of one folder, with a line that shows it.
type Imports = BTreeMap<(String, String), String>;

/// The circles of one crate, each with lines that show it.
fn circles(name: &str, files: &[File]) -> Vec<String> {
    let source = Source::of(name, files);
    let mut folders: BTreeMap<Path, Imports> = BTreeMap::new();
    for (path, module) in source.modules() {
        for (reach, line) in &module.reaches {
            let home = source.home(reach);
            let shared = path.iter().zip(&home).take_while(|(a, b)| a == b).count();
            if let (Some(from), Some(to)) = (path.get(shared), home.get(shared)) {
                let shown = format!("{}: line {line}", module.file);
                let imports = folders.entry(path[..shared].to_vec()).or_default();
                imports.entry((from.clone(), to.clone())).or_insert(shown);
            }
        }
    }
    let mut found = Vec::new();
    for (folder, imports) in &folders {
        let reached: BTreeMap<&str, BTreeSet<&str>> =
            imports.keys().map(|(from, _)| (from.as_str(), reach(from, imports))).collect();
        let mut told = BTreeSet::new();
        for (part, all) in &reached {
            if !all.contains(part) || told.contains(part) {
                continue;
            }
            let back = |other: &&&str| reached.get(**other).is_some_and(|r| r.contains(part));
            let circle: BTreeSet<&str> = all.iter().filter(back).copied().collect();
            let within = |(from, to): &(String, String)| {
                circle.contains(from.as_str()) && circle.contains(to.as_str())
            };
            let lines = imports.iter().filter(|(pair, _)| within(pair));
            let lines = lines.map(|((from, to), at)| format!("  {from} → {to} ({at})"));
            let parts = circle.iter().copied().collect::<Vec<_>>().join(", ");
            found.push(format!(
                "{}: {parts}\n{}",
                [name, &folder.join("/")].join("/").trim_end_matches('/'),
                lines.collect::<Vec<_>>().join("\n")
            ));
            told.extend(circle);
        }
    }
    found
}

/// Everything that `part` imports, and what that imports in turn.
fn reach<'a>(part: &str, imports: &'a Imports) -> BTreeSet<&'a str> {
    let mut found = BTreeSet::new();
    let mut open = vec![part];
    while let Some(next) = open.pop() {
        for (from, to) in imports.keys() {
            if from == next && found.insert(to.as_str()) {
                open.push(to);
            }
        }
    }
    found
}

#[test]
fn no_imports_run_in_a_circle() {
    let mut tree = tree::tree();
    let mut all = Vec::new();
    for table in tables() {
        let name = &table.name;
        let found = circles(name, &tree);
        let folder = format!("crates/{name}/src/{}", table.built(&tree)[0]);
        for (part, other) in [("left", "right"), ("right", "left")] {
            let (path, text) =
                (format!("{folder}/{part}.rs"), format!("use super::{other}::Thing;"));
            tree.push(File { path, text });
        }
        let more = circles(name, &tree);
        tree.truncate(tree.len() - 2);
        assert!(more.len() > found.len(), "the rule is blind to a circle in {folder}");
        all.extend(found);
    }
    println!("{} circles of imports", all.len());
    assert!(all.is_empty(), "{} circles:\n{}", all.len(), all.join("\n"));
}
