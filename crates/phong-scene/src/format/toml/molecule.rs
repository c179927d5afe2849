//! `[[molecule]]`: the atoms of a file, as its keys say.

use super::draft::Part;
use super::reader::Reader;
use super::table::Values;
use crate::diagnostic::Diagnostic;
use crate::format::input::Input;
use crate::molecule::{ColorMap, Drawing, Selection, Spans, Style};
use crate::wording::{self, Word};

impl Reader<'_> {
    /// `[[molecule]]`: the atoms and bonds of its file.
    pub(super) fn molecule(&mut self, v: &Values, path: &str) -> Vec<Part> {
        let drawing = self.drawing(v);
        let (Some((file, read)), Some(drawing)) = (self.reader_of(v, path), drawing) else {
            return Vec::new();
        };
        let input = Input {
            drawing: Some(&drawing),
            topology: self.topology,
            ..Input::new(&file, self.source, self.limits)
        };
        let Some(mut fragment) = self.read_input(v, &input, read) else { return Vec::new() };
        if !fragment.objects.iter().any(|object| ["atoms", "bonds"].contains(&&*object.name)) {
            let help = "atoms are read from PDB, CIF, XYZ, GRO and LAMMPS files";
            let message = format!("{} holds no atoms", wording::path(&file));
            self.notes.error(v.spot_of("file"), message).help = Some(help.to_owned());
            return Vec::new();
        }
        let number = self.take_materials(v, &mut fragment);
        self.parts(fragment, number, v, Some)
    }

    /// How the keys say that atoms are drawn; `None`: something is wrong with them, which has been
    /// said.
    fn drawing(&mut self, v: &Values) -> Option<Drawing> {
        let mut sound = true;
        let span =
            |key: &str, notes: &super::notes::Notes| v.has(key).then(|| notes.span(v.spot_of(key)));
        let spans = Spans {
            select: span("select", &self.notes),
            color_by: span("color_by", &self.notes),
            radius_by: span("radius_by", &self.notes),
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
        let number = |key: &str| v.number(key).map(|number| number as f32);
        for key in ["style", "color_map", "radius", "radius_scale", "bond_radius"] {
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
            cell: v.flag("cell").unwrap_or(false),
            spans,
        };
        sound.then_some(drawing)
    }
}
