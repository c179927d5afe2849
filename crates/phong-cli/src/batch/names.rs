//! What pictures are called.

use std::collections::BTreeMap;
use std::path::Path;

use phong::image::Format;
use phong_scene::{Change, Diagnostic, Span, Written, closest, path_of};

use super::Picture;

/// The longest name, in bytes: most file systems take 255, and a layer's name may follow.
const LONGEST: usize = 200;

/// A name with places for what differs from picture to picture.
#[derive(Debug)]
pub(super) struct Pattern {
    pieces: Vec<Piece>,
    format: Format,
    /// Where it is written; `None`: it is ours.
    span: Option<Span>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum Piece {
    Text(String),
    Scene,
    Frame,
    Task,
    /// The value of the parameter of this number.
    Parameter(usize),
}

impl Pattern {
    /// The pattern that is written, or the one without it: the input's name and every value.
    pub(super) fn new(
        written: Option<&Written>,
        parameters: &[&str],
    ) -> Result<Self, Box<Diagnostic>> {
        let Some(Written { text, span }) = written else {
            let mut pieces = vec![Piece::Scene];
            for number in 0..parameters.len() {
                pieces.extend([Piece::Text("-".to_owned()), Piece::Parameter(number)]);
            }
            return Ok(Self { pieces, format: Format::Png, span: None });
        };
        let wrong = |message: String, help: Option<String>| {
            let error = Diagnostic::error(message, span.clone());
            Box::new(Diagnostic { help, ..error })
        };
        let ending = Path::new(text).extension();
        if ending.is_some_and(|ending| ending.eq_ignore_ascii_case("svg")) {
            let help = "end it in .png, .pfm or .exr; `phong render` alone writes SVG";
            return Err(wrong("a batch writes no SVG".to_owned(), Some(help.to_owned())));
        }
        let format = Format::of_path(Path::new(text));
        let stem = match format {
            Some(format) => &text[..text.len() - format.extension().len() - 1],
            None => text,
        };
        if stem.is_empty() || stem.starts_with('.') || stem.contains(['/', '\\', '\0']) {
            let help = "the folder is `output`; the name neither begins with a point nor has `/`";
            let message = format!("{text:?} is no name of a file");
            return Err(wrong(message, Some(help.to_owned())));
        }
        let mut pieces = Vec::new();
        let mut rest = stem;
        while let Some((before, after)) = rest.split_once('{') {
            pieces.push(Piece::Text(before.to_owned()));
            let Some((word, after)) = after.split_once('}') else {
                return Err(wrong("this `{` is never closed".to_owned(), None));
            };
            pieces.push(piece(word, parameters).map_err(|(message, help)| wrong(message, help))?);
            rest = after;
        }
        pieces.push(Piece::Text(rest.to_owned()));
        Ok(Self { pieces, format: format.unwrap_or(Format::Png), span: Some(span.clone()) })
    }

    pub(super) fn format(&self) -> Format {
        self.format
    }

    /// Leaves those parameters out of our own pattern that have one value alone.
    pub(super) fn vary(&mut self, counts: &[usize]) {
        if self.span.is_some() {
            return;
        }
        self.pieces = vec![Piece::Scene];
        for (number, _) in counts.iter().enumerate().filter(|(_, count)| **count > 1) {
            self.pieces.extend([Piece::Text("-".to_owned()), Piece::Parameter(number)]);
        }
    }

    /// Gives every picture its name, each another.
    pub(super) fn name(
        &mut self,
        pictures: &mut [Picture],
        inputs: usize,
    ) -> Result<(), Box<Diagnostic>> {
        if let Err((first, second, name)) = self.try_name(pictures, inputs) {
            let Some(span) = self.span.clone() else {
                // Two inputs of one name in two folders, say.
                self.pieces.extend([Piece::Text("-".to_owned()), Piece::Task]);
                let _ = self.try_name(pictures, inputs);
                return Ok(());
            };
            let message = format!("pictures {first} and {second} would both be called {name}");
            let error = Diagnostic::error(message, span).with_help("add `{task}` to the name");
            return Err(Box::new(error));
        }
        Ok(())
    }

    fn try_name(
        &self,
        pictures: &mut [Picture],
        inputs: usize,
    ) -> Result<(), (usize, usize, String)> {
        let digits = |count: usize| count.saturating_sub(1).to_string().len();
        let (frames, tasks) = (digits(inputs), digits(pictures.len()));
        let mut known: BTreeMap<String, usize> = BTreeMap::new();
        for picture in pictures {
            let piece = |piece: &Piece| match piece {
                Piece::Text(text) => text.clone(),
                Piece::Scene => stem(&picture.input),
                Piece::Frame => format!("{:0frames$}", picture.frame),
                Piece::Task => format!("{:0tasks$}", picture.number),
                Piece::Parameter(number) => value(&picture.changes[*number]),
            };
            let mut name: String = self.pieces.iter().map(piece).collect();
            if let Some((end, _)) = name.char_indices().find(|(i, c)| i + c.len_utf8() > LONGEST) {
                name.truncate(end);
            }
            name.push('.');
            name.push_str(self.format.extension());
            if let Some(first) = known.insert(name.clone(), picture.number) {
                return Err((first, picture.number, name));
            }
            picture.name = name;
        }
        Ok(())
    }
}

/// What a word between braces stands for.
fn piece(word: &str, parameters: &[&str]) -> Result<Piece, (String, Option<String>)> {
    match word {
        "scene" | "input" => return Ok(Piece::Scene),
        "frame" => return Ok(Piece::Frame),
        "task" => return Ok(Piece::Task),
        _ => {}
    }
    if let Some(number) = parameters.iter().position(|path| *path == word) {
        return Ok(Piece::Parameter(number));
    }
    let called: Vec<usize> = (0..parameters.len())
        .filter(|&number| parameters[number].rsplit('.').next() == Some(word))
        .collect();
    let written = |paths: &mut dyn Iterator<Item = &str>| {
        paths.map(|path| format!("`{{{path}}}`")).collect::<Vec<_>>().join(", ")
    };
    match called[..] {
        [] => {}
        [number] => return Ok(Piece::Parameter(number)),
        _ => {
            let message = format!("several parameters are called {word:?}");
            let all = written(&mut called.iter().map(|&number| parameters[number]));
            return Err((message, Some(format!("there are {all}"))));
        }
    }
    let words = || ["scene", "frame", "task"].into_iter();
    let lasts = parameters.iter().filter_map(|path| path.rsplit('.').next());
    let message = format!("nothing is called {word:?} that a name could have");
    let near = closest(word, words().chain(lasts).chain(parameters.iter().copied()));
    let all = written(&mut words().chain(parameters.iter().copied()));
    let help = near
        .map_or_else(|| format!("there are {all}"), |near| format!("did you mean `{{{near}}}`?"));
    Err((message, Some(help)))
}

/// The name of a file without folder and ending, as a part of another name.
fn stem(path: &str) -> String {
    let stem = path_of(path).file_stem().map(|stem| stem.to_string_lossy().into_owned());
    plain(&stem.unwrap_or_default())
}

/// A value as a part of a name: `[0, 1, 5]` is `0_1_5`.
fn value(change: &Change) -> String {
    let value = change.value();
    match value.strip_prefix('"').and_then(|text| text.strip_suffix('"')) {
        Some(path) if is_file(change) => stem(path),
        Some(text) => plain(text),
        None => plain(value),
    }
}

/// Whether a change names a file that is read.
pub(super) fn is_file(change: &Change) -> bool {
    change.path().rsplit('.').next() == Some("file")
}

/// Letters, digits and what else any file system takes; the rest as underlines, none twice.
fn plain(text: &str) -> String {
    let mut plain = String::new();
    for c in text.chars() {
        if c.is_alphanumeric() || "._+=-".contains(c) {
            plain.push(c);
        } else if !plain.is_empty() && !plain.ends_with('_') {
            plain.push('_');
        }
    }
    plain.trim_end_matches('_').to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pattern(text: &str, parameters: &[&str]) -> Result<Pattern, String> {
        let written = Written { text: text.to_owned(), span: Span::default() };
        Pattern::new(Some(&written), parameters).map_err(|error| error.to_string())
    }

    #[test]
    fn a_parameter_is_called_by_its_path_or_its_last_word() {
        let paths = ["materials.red.k_s", "camera.eye", "materials.blue.color", "light.1.color"];
        for (text, number) in [("{k_s}", 0), ("{camera.eye}", 1), ("{light.1.color}.exr", 3)] {
            let pieces = pattern(text, &paths).expect("a pattern").pieces;
            assert!(pieces.contains(&Piece::Parameter(number)), "{text}");
        }
        let two = pattern("{color}", &paths).expect_err("two colours");
        assert!(two.contains("`{materials.blue.color}`"), "{two}");
        let near = pattern("{k_d}", &paths).expect_err("no such parameter");
        assert!(near.contains("did you mean `{k_s}`?"), "{near}");
    }

    #[test]
    fn the_ending_says_what_is_written_and_a_folder_is_no_name() {
        assert_eq!(pattern("{scene}.EXR", &[]).expect("a pattern").format, Format::Exr);
        assert_eq!(pattern("{scene}.5", &[]).expect("a pattern").format, Format::Png);
        for wrong in ["a/{scene}", ".png", "..", "{scene", ".hidden.png", "fig-{task}.SVG"] {
            assert!(pattern(wrong, &[]).is_err(), "{wrong}");
        }
    }

    #[test]
    fn a_value_in_a_name_is_plain() {
        assert_eq!(plain("[0, 1.5, -5]"), "0_1.5_-5");
        assert_eq!(plain("#ff0000"), "ff0000");
        assert_eq!(plain("{ texture = \"a b\" }"), "texture_=_a_b");
        assert_eq!(plain("../ä/b"), ".._ä_b");
    }
}
