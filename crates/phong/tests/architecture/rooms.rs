//! A room imports only rooms below it. The storeys are read from ARCHITECTURE.md.

use std::collections::BTreeSet;

use crate::source::Source;
use crate::tree::{self, File};

/// The table of one crate.
pub(crate) struct Table {
    /// The crate's name.
    pub(crate) name: String,
    /// Its rooms, lowest first: a room may import those that stand before it.
    pub(crate) rooms: Vec<String>,
}

impl Table {
    /// The rooms that are there, lowest first.
    pub(crate) fn built(&self, files: &[File]) -> Vec<&str> {
        let source = Source::of(&self.name, files);
        let there = |room: &&str| source.modules().any(|(path, _)| path[0] == **room);
        self.rooms.iter().map(String::as_str).filter(there).collect()
    }
}

/// The tables under `## Rooms`, one a crate: `| storey | rooms | |`, the highest storey first.
pub(crate) fn tables() -> Vec<Table> {
    let text =
        std::fs::read_to_string(tree::root().join("ARCHITECTURE.md")).expect("ARCHITECTURE.md");
    let text = text.split("\n## Rooms\n").nth(1).expect("the chapter `## Rooms`");
    let text = text.split("\n## ").next().unwrap_or_default();
    let mut tables = Vec::new();
    for chapter in text.split("\n### ").skip(1) {
        let (name, body) = chapter.split_once('\n').expect("a table under its crate's name");
        let mut storeys: Vec<(u32, Vec<String>)> = Vec::new();
        for line in body.lines() {
            let mut cells = line.split('|').map(str::trim).skip(1);
            let (Some(storey), Some(rooms)) = (cells.next(), cells.next()) else { continue };
            let Ok(storey) = storey.parse() else { continue };
            let rooms = rooms.split('`').skip(1).step_by(2).map(str::to_owned);
            storeys.push((storey, rooms.collect()));
        }
        storeys.sort_by_key(|(storey, _)| *storey);
        let rooms = storeys.into_iter().flat_map(|(_, rooms)| rooms).collect();
        tables.push(Table { name: name.trim().to_owned(), rooms });
    }
    tables
}

/// What is wrong with the order of one crate's rooms.
fn storeys(table: &Table, files: &[File]) -> Vec<String> {
    let Table { name, rooms } = table;
    let place = |room: &str| rooms.iter().position(|r| r == room);
    let source = Source::of(name, files);
    let mut found = Vec::new();
    let built: BTreeSet<&str> = source.modules().map(|(path, _)| path[0].as_str()).collect();
    for room in &built {
        if place(room).is_none() {
            found.push(format!("{name}: ARCHITECTURE.md gives the room `{room}` no storey"));
        }
    }
    for (i, room) in rooms.iter().enumerate() {
        if rooms[..i].contains(room) {
            found.push(format!("{name}: the room `{room}` stands in ARCHITECTURE.md twice"));
        }
        if !built.contains(room.as_str()) {
            found.push(format!("{name}: the room `{room}` of ARCHITECTURE.md is not there"));
        }
    }
    for (path, module) in source.modules() {
        for (reach, line) in &module.reaches {
            let at = format!("{}: line {line}", module.file);
            let home = source.home(reach);
            let (room, own) = (home.first(), &path[0]);
            match room.map(|room| (room, place(room), place(own))) {
                None if reach.is_empty() => {} // `pub(in crate)`
                None => found.push(format!("{at}: `crate::{}` is in no room", reach.join("::"))),
                Some((room, Some(other), Some(own_place))) if other > own_place => {
                    found.push(format!("{at}: `{own}` imports `{room}`, above it"));
                }
                Some(_) => {}
            }
        }
    }
    found
}

#[test]
fn a_room_imports_only_rooms_below_it() {
    let mut tree = tree::tree();
    let tables = tables();
    let crates: BTreeSet<String> = tree
        .iter()
        .filter_map(|file| Some(file.path.strip_prefix("crates/")?.split_once('/')?.0.to_owned()))
        .collect();
    let named: BTreeSet<String> = tables.iter().map(|table| table.name.clone()).collect();
    assert_eq!(crates, named, "the crates, and those ARCHITECTURE.md has a table of");

    let mut wrong = Vec::new();
    for table in &tables {
        let found = storeys(table, &tree);
        let name = &table.name;
        let built = table.built(&tree);
        let (low, high) = (built[0], built[built.len() - 1]);
        for (path, text) in [
            (format!("{low}/planted.rs"), format!("use crate::{high}::Thing;")),
            (format!("{low}/planted.rs"), format!("use crate::{{{low}::Thing, {high}}};")),
            (
                format!("{low}/planted.rs"),
                format!("fn f() -> Option<crate::{high}::Thing> {{ None }}"),
            ),
            (format!("{low}/planted.rs"), format!("use super::super::{high}::Thing;")),
            (
                format!("{low}/planted.rs"),
                format!("mod tests {{ use super::super::super::{high}; }}"),
            ),
            (format!("{low}/planted.rs"), "use crate::Planted;".to_owned()),
            (format!("{low}/planted.rs"), "use crate::*;".to_owned()),
            ("cellar.rs".to_owned(), "//! A room on no storey.".to_owned()),
        ] {
            let path = format!("crates/{name}/src/{path}");
            tree.push(File { path: path.clone(), text: text.clone() });
            let more = storeys(table, &tree);
            tree.pop();
            assert!(more.len() > found.len(), "the rule is blind to this in {path}:\n{text}");
        }
        let gone =
            Table { name: name.clone(), rooms: [&table.rooms[..], &["gone".into()]].concat() };
        assert!(
            storeys(&gone, &tree).len() > found.len(),
            "the rule is blind to a room that is gone"
        );
        wrong.extend(found);
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
