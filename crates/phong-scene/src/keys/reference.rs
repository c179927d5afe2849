//! The reference of the scene text, for people: one table of keys after another, in Markdown.

use super::shape::{MADE_OF, PLACED};
use super::{BACKGROUND, BATCH, FILES, Key, Kind, RANGE, SCENE, TEXTURED, Table};
use crate::dialect::Switches;
use crate::material::{AmbientRule, Dialect, Model, Tint, Viewer};

/// The reference of the scene text in Markdown: every table, key, kind, range and default.
///
/// The reader reads by the very same tables, so the two cannot differ.
///
/// ```
/// let text = phong_scene::reference_markdown();
/// assert!(text.contains("\n## `[camera]`\n"));
/// assert!(text.contains("| `fov` (perspective) | a number above 0 and below 180 | `40` |"));
/// ```
pub fn reference_markdown() -> String {
    let mut sections = vec![section(None, &SCENE)];
    for key in SCENE.keys() {
        let (header, table) = match key.kind {
            Kind::Table(table) => (format!("[{}]", key.name), table),
            Kind::Tables(table) => (format!("[[{}]]", key.name), table),
            Kind::Named(table) if table.name == "group" => continue, // holds shapes, below
            Kind::Named(table) => (format!("[{}.NAME]", key.name), table),
            _ => continue,
        };
        sections.push(section(Some(&header), table));
        if key.name == "image" {
            sections.push(section(Some("background = { .. }"), &BACKGROUND));
        }
        if key.name == "textures" {
            sections.push(section(Some("{ texture = .. }"), &TEXTURED));
        }
    }
    let any = "## Any shape\n\nEvery shape takes these as well, an instance all but `material`. \
               Those in `[groups.NAME]` are written `[[groups.NAME.sphere]]` and so on.\n\n";
    let shared: Vec<_> = MADE_OF.iter().chain(&PLACED).collect();
    sections.push(format!("{any}{}", rows(&shared)));
    sections.push(COLORS.to_owned());
    sections.push(dialects());
    sections.join("\n")
}

/// The reference of a batch file in Markdown, as [`reference_markdown`] is of the scene text.
///
/// ```
/// let text = phong_scene::batch_reference_markdown();
/// assert!(text.contains("| `shares` | a whole number from 1 to 10000 | `1` |"));
/// ```
pub fn batch_reference_markdown() -> String {
    [
        section(None, &BATCH),
        section(Some("{ from = .., to = .., steps = .. }"), &RANGE),
        section(Some("{ files = .. }"), &FILES),
    ]
    .join("\n")
}

/// What is linear and what is not.
const COLORS: &str = "\
## Colours

| written | meaning |
|---|---|
| `0.5` | linear grey: half the light of white |
| `[0.5, 0.2, 0.1]` | linear red, green and blue; 1 is full light, and light may be above it |
| `\"#c8402f\"` | bytes of sRGB, as colour pickers show them; decoded when they are read |
| `\"tomato\"` | a CSS name: the same, decoded |

Gradients run linearly between their stops, however those are written.
";

/// A table of what each dialect sets, from the very switches it presets.
fn dialects() -> String {
    let mut out = String::from(
        "## What each dialect sets\n\nEach row is what another program means by its materials. The \
         model fixes the lobe; a dialect is an error with a model that its program does not have.\n\n\
         | dialect | models | `times_cosine` | `normalize` | `tint` | `ambient_rule` | `viewer` |\n\
         |---|---|---|---|---|---|---|\n",
    );
    let lobes = [
        ("lambert", Model::Lambert),
        ("phong", Model::Phong),
        ("blinn-phong", Model::BlinnPhong),
        ("blinn-fast", Model::BlinnFast),
    ];
    for dialect in Dialect::ALL {
        let allowed = lobes.iter().filter(|(_, model)| dialect.allows(model));
        let mut models: Vec<&str> = allowed.map(|(name, _)| *name).collect();
        if dialect == Dialect::Lecture {
            models = vec!["every model"];
        }
        let Switches { times_cosine, normalize, tint, ambient_rule, viewer } = dialect.switches();
        let tint = match tint {
            Tint::Light => "light",
            Tint::Object => "object",
            Tint::Metallic => "metallic",
        };
        let ambient = match ambient_rule {
            AmbientRule::Once => "once",
            AmbientRule::PerLight => "per-light",
            AmbientRule::Both => "both",
        };
        let viewer = match viewer {
            Viewer::Local => "local",
            Viewer::Distant => "distant",
        };
        let row = format!(
            "| `{}` | {} | {times_cosine} | {normalize} | {tint} | {ambient} | {viewer} |\n",
            dialect.name(),
            models.join(", ")
        );
        out += &row;
    }
    out
}

/// A table's keys under its header; of a shape, those it does not share with all of them.
fn section(header: Option<&str>, table: &Table) -> String {
    let title = header.map(|header| format!("## `{header}`\n\n")).unwrap_or_default();
    format!("{title}{}\n\n{}", table.doc, rows(&own_keys(table)))
}

/// The keys of a table that not all shapes share.
pub(super) fn own_keys(table: &Table) -> Vec<&'static Key> {
    let shared = |list: &[Key]| std::ptr::eq(list, &PLACED) || std::ptr::eq(list, &MADE_OF);
    table.keys.iter().filter(|list| !shared(list)).flat_map(|list| list.iter()).collect()
}

/// The keys as the rows of a table in Markdown.
pub(super) fn rows(keys: &[&Key]) -> String {
    let head = "| key | value | default | meaning |\n|---|---|---|---|\n";
    let row = |key: &&Key| {
        let only = match key.only {
            [] => String::new(),
            only => format!(" ({})", only.join(", ")),
        };
        let Key { name, default, doc, .. } = key;
        format!("| `{name}`{only} | {} | {default} | {doc} |\n", key.words())
    };
    keys.iter().map(row).fold(head.to_owned(), |rows, row| rows + &row)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::keys::camera::CAMERA;
    use crate::keys::furniture::{AXES, FURNITURE, LABEL, LEGEND, SCALE_BAR, TITLE};
    use crate::keys::scene::{AMBIENT, IMAGE};
    use crate::keys::shape::SHAPES;
    use crate::keys::tone::TONE;
    use crate::keys::{CLIP, INCLUDE, LIGHT, MATERIAL, TEXTURE};

    const CONCEPTS: [(&str, &str); 13] = [
        ("ambient_occlusion.rs", include_str!("../ambient_occlusion.rs")),
        ("camera.rs", include_str!("../camera.rs")),
        ("clip.rs", include_str!("../clip.rs")),
        ("fog.rs", include_str!("../fog.rs")),
        ("furniture.rs", include_str!("../furniture.rs")),
        ("sky.rs", include_str!("../sky.rs")),
        ("light.rs", include_str!("../light.rs")),
        ("material.rs", include_str!("../material.rs")),
        ("outline.rs", include_str!("../outline.rs")),
        ("scene.rs", include_str!("../scene.rs")),
        ("shape.rs", include_str!("../shape.rs")),
        ("texture.rs", include_str!("../texture.rs")),
        ("tone.rs", include_str!("../tone.rs")),
    ];

    /// The module's doc, as Markdown.
    fn doc(file: &str) -> String {
        let source = CONCEPTS.iter().find(|(name, _)| *name == file).expect("a concept").1;
        let lines = source.lines().map_while(|line| line.strip_prefix("//!"));
        lines.map(|line| line.strip_prefix(' ').unwrap_or(line)).collect::<Vec<_>>().join("\n")
            + "\n"
    }

    #[track_caller]
    fn assert_doc_holds(file: &str, keys: &[&Key]) {
        let rows = rows(keys);
        assert!(doc(file).contains(&rows), "the doc of {file} does not hold this table:\n{rows}");
    }

    #[test]
    fn the_doc_of_each_concept_is_its_table_of_keys() {
        assert_doc_holds("camera.rs", &own_keys(&CAMERA));
        assert_doc_holds("light.rs", &own_keys(&LIGHT));
        assert_doc_holds("material.rs", &own_keys(&MATERIAL));
        assert_doc_holds("texture.rs", &own_keys(&TEXTURE));
        assert_doc_holds("texture.rs", &own_keys(&TEXTURED));
        assert_doc_holds("clip.rs", &own_keys(&CLIP));
        assert_doc_holds("tone.rs", &own_keys(&TONE));
        for table in [&FURNITURE, &TITLE, &SCALE_BAR, &AXES, &LEGEND, &LABEL] {
            assert_doc_holds("furniture.rs", &own_keys(table));
        }
        for table in [&SCENE, &IMAGE, &BACKGROUND, &AMBIENT, &INCLUDE] {
            assert_doc_holds("scene.rs", &own_keys(table));
        }
        for key in SHAPES {
            let Kind::Tables(table) = key.kind else { panic!("a shape is a list of tables") };
            assert_doc_holds("shape.rs", &own_keys(table));
        }
        assert_doc_holds("shape.rs", &MADE_OF.iter().chain(&PLACED).collect::<Vec<_>>());
    }

    #[test]
    fn the_reference_says_what_each_dialect_sets() {
        let text = reference_markdown();
        for dialect in Dialect::ALL {
            assert!(text.contains(&format!("\n| `{}` | ", dialect.name())), "{}", dialect.name());
        }
        let row = "| `three-js` | lambert, blinn-phong | true | true | light | once | local |\n";
        assert!(text.contains(row), "{text}");
    }

    #[test]
    fn the_reference_names_every_key_of_every_table() {
        let text = reference_markdown();
        let mut tables = vec![&SCENE];
        while let Some(table) = tables.pop() {
            for key in table.keys() {
                assert!(text.contains(&format!("| `{}`", key.name)), "{}", key.name);
                assert!(text.contains(key.doc), "{}: {}", key.name, key.doc);
                if let Kind::Table(t) | Kind::Tables(t) | Kind::Named(t) = key.kind {
                    tables.push(t);
                }
            }
        }
    }
}
