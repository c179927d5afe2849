//! `[[molecule]]`: the atoms of a file, as its keys say.

use std::sync::Arc;

use super::change::Changes;
use super::draft::Part;
use super::path::join;
use super::reader::Reader;
use super::syntax;
use super::table::Values;
use super::text::{Spot, Text};
use crate::change::{Change, toml_string};
use crate::diagnostic::Diagnostic;
use crate::format::input::{Input, ReadModel};
use crate::fragment::Fragment;
use crate::keys;
use crate::molecule::{Arrows, ColorMap, Drawing, Images, Selection, Spans, Style};
use crate::wording::{self, Word};

/// Cells that are drawn, at most.
const MOST_CELLS: f64 = 1e6;

impl<'a> Reader<'a> {
    /// `[[molecule]]`: the atoms and bonds of its file.
    pub(super) fn molecule(&mut self, v: &Values, path: &str) -> Vec<Part> {
        let drawing = self.drawing(v, path);
        let (Some((file, read)), Some(drawing)) = (self.reader_of(v, path), drawing) else {
            return Vec::new();
        };
        let input = Input {
            drawing: Some(&drawing),
            topology: self.topology,
            ..Input::new(&file, self.source, self.limits)
        };
        let Some(mut fragment) = self.read_input(v, &input, read) else { return Vec::new() };
        let drawn = ["atoms", "bonds", "tube"];
        if !fragment.objects.iter().any(|object| drawn.contains(&&*object.name)) {
            let help = "atoms are read from PDB, CIF, XYZ, GRO and LAMMPS files";
            let message = format!("{} holds no atoms", wording::path(&file));
            self.notes.error(v.spot_of("file"), message).help = Some(help.to_owned());
            return Vec::new();
        }
        let number = self.take_materials(v, &mut fragment);
        self.parts(fragment, number, v, Some)
    }

    /// The atoms of a bare file, drawn as these changes say; their values are in `values`.
    pub(super) fn bare_molecule(
        mut self,
        input: &Input<'_>,
        read: ReadModel,
        changes: &'a [Change],
        values: &'a [String],
        out: &mut Vec<Diagnostic>,
    ) -> Option<Fragment> {
        let path = input.path;
        let name = path.rsplit(['/', '\\']).next().unwrap_or(path);
        let text = format!("file = {}", toml_string(name));
        let number = self.notes.add(Arc::new(Text::new(path.into(), text.clone(), Vec::new())));
        self.changes = Changes::new(changes, values, &mut self.notes);
        let mut mended = String::new();
        let document = syntax::parse(&text, number, &mut mended, &mut self.notes);
        let over = self.changes.over("molecule", &["1"]);
        let spot = Spot::new(number, 0..0);
        let table = document.get_ref();
        let v = Values::read_changed(&keys::MOLECULE, table, spot, &over, &mut self.notes);
        let others = ["file", "name", "material", "scale", "rotate", "translate", "matrix"];
        for key in others.into_iter().filter(|key| over.iter().any(|l| l.target.key.name == *key)) {
            let message = format!("`{key}` means nothing to a bare model");
            self.notes.error(v.spot_of(key), message).help =
                Some("write a scene that names the file in a `[[molecule]]`".to_owned());
        }
        let drawing = self.drawing(&v, path);
        let mut said = Vec::new();
        let drawing = drawing.filter(|_| !self.notes.has_errors());
        let found = drawing.and_then(|drawing| {
            read(&Input { drawing: Some(&drawing), changes: &[], ..*input }, &mut said)
        });
        out.extend(self.notes.into_diagnostics());
        out.append(&mut said);
        found
    }

    /// How the keys say that atoms are drawn; `None`: something is wrong with them, which has been
    /// said.
    fn drawing(&mut self, v: &Values, path: &str) -> Option<Drawing> {
        let mut sound = true;
        let span =
            |key: &str, notes: &super::notes::Notes| v.has(key).then(|| notes.span(v.spot_of(key)));
        let spans = Spans {
            select: span("select", &self.notes),
            color_by: span("color_by", &self.notes),
            radius_by: span("radius_by", &self.notes),
            trajectory: span("trajectory", &self.notes),
            style: span("style", &self.notes),
            vectors: span("vectors", &self.notes),
            images: span("images", &self.notes).or_else(|| span("image_layer", &self.notes)),
            cell: span("cell", &self.notes),
        };
        let select = v.text("select").and_then(|text| match Selection::parse(&text) {
            Ok(selection) => Some(selection),
            Err(wrong) => {
                sound = false;
                let spot = v.spot_of("select");
                let place = Selection::narrow(&text, &self.notes.span(spot), wrong.at);
                let error = Diagnostic::error(format!("`select`: {}", wrong.message), place);
                self.notes.say(spot, Diagnostic { help: wrong.help, ..error });
                None
            }
        });
        let color_range = v.numbers("color_range").and_then(|numbers| match numbers[..] {
            [low, high] if low < high => Some([low, high]),
            _ => {
                sound = false;
                let message = "`color_range` must be two numbers, the second above the first";
                self.notes.error(v.spot_of("color_range"), message);
                None
            }
        });
        let cells = v.numbers("images").map(|numbers| {
            let counts: Vec<u32> = numbers.iter().map(|n| *n as u32).collect();
            let count: f64 = numbers.iter().product();
            match counts[..] {
                [a, b, c] if count <= MOST_CELLS => [a, b, c],
                _ => {
                    sound = false;
                    let message = format!(
                        "`images` must be at most {MOST_CELLS} cells in all; these are {count}"
                    );
                    self.notes.error(v.spot_of("images"), message);
                    [1; 3]
                }
            }
        });
        let columns = v.texts("vectors").and_then(|names| {
            let names: Vec<String> = names.into_iter().map(|(name, _)| name).collect();
            <[String; 3]>::try_from(names).map_or_else(
                |_| {
                    sound = false;
                    let message = "`vectors` must be the names of three columns, like `[\"vx\", \"vy\", \"vz\"]`";
                    self.notes.error(v.spot_of("vectors"), message);
                    None
                },
                Some,
            )
        });
        for key in ["vector_scale", "vector_radius"].into_iter().filter(|key| v.has(key)) {
            if !v.has("vectors") {
                sound = false;
                let message =
                    format!("`{key}` is of arrows, of which there are none without `vectors`");
                self.notes.error(v.spot_of(key), message);
            }
        }
        let number = |key: &str| v.number(key).map(|number| number as f32);
        let checked = ["style", "color_map", "radius", "radius_scale", "bond_radius"];
        let more = ["vector_scale", "vector_radius", "image_layer"];
        for key in checked.into_iter().chain(more) {
            // What is written wrongly has been said.
            sound &= !v.has(key) || v.number(key).is_some() || v.word(key).is_some();
        }
        let drawing = Drawing {
            style: v.word("style").and_then(Style::of_word),
            select,
            color_by: v.text("color_by"),
            color_map: v.word("color_map").and_then(ColorMap::of_word),
            color_range,
            radius_by: v.text("radius_by"),
            radius: number("radius"),
            radius_scale: number("radius_scale").unwrap_or(1.0),
            bond_radius: number("bond_radius"),
            trajectory: v.text("trajectory").map(|name| join(path, &name)),
            vectors: columns.map(|columns| Arrows {
                columns,
                scale: number("vector_scale"),
                radius: number("vector_radius"),
            }),
            images: Images {
                cells: cells.unwrap_or([1; 3]),
                layer: v.number("image_layer").unwrap_or(0.0),
            },
            cell: v.flag("cell").unwrap_or(false),
            spans,
        };
        sound.then_some(drawing)
    }
}
