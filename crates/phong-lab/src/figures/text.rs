//! Words with italic letters, subscripts and superscripts, and how wide they are.
//!
//! The markup is what one would write in a mail: `*k*_d (*l*·*n*)`, `(*r*·*e*)^{*α*}`.

use ttf_parser::{Face, GlyphId};

use super::mark::{Anchor, Path, Point, Run, Script, Text};
use crate::draw::Pen;
use crate::markup::escaped;

/// Splits markup into runs: `*…*` is italic; `_` and `^` lower and raise the next letter or group in
/// braces. An italic letter in a script needs braces: `^{*α*}`.
pub(super) fn runs(markup: &str) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    let (mut italic, mut script, mut braced) = (false, Script::Line, false);
    let mut letters = markup.chars().peekable();
    while let Some(letter) = letters.next() {
        match letter {
            '*' => italic = !italic,
            '_' | '^' if script == Script::Line => {
                script = if letter == '_' { Script::Below } else { Script::Above };
                braced = letters.next_if_eq(&'{').is_some();
            }
            '}' if braced => (script, braced) = (Script::Line, false),
            _ => {
                match runs.last_mut() {
                    Some(run) if run.italic == italic && run.script == script => {
                        run.words.push(letter);
                    }
                    _ => runs.push(Run { words: letter.to_string(), italic, script }),
                }
                if !braced {
                    script = Script::Line;
                }
            }
        }
    }
    runs
}

/// Markup as HTML.
pub(super) fn html(markup: &str) -> String {
    let mut out = String::new();
    for Run { words, italic, script } in runs(markup) {
        let words = escaped(&words);
        let words = if italic { format!("<i>{words}</i>") } else { words };
        match script {
            Script::Line => out += &words,
            Script::Below => out.extend(["<sub>", &words, "</sub>"]),
            Script::Above => out.extend(["<sup>", &words, "</sup>"]),
        }
    }
    out
}

/// The three faces, as files. Subsets of Noto; see `font/README.md`.
pub(super) const SANS: &[u8] = include_bytes!("font/sans.ttf");
pub(super) const BOLD: &[u8] = include_bytes!("font/bold.ttf");
pub(super) const ITALIC: &[u8] = include_bytes!("font/italic.ttf");

/// The faces, ready to measure and to draw.
pub(super) struct Faces {
    sans: Face<'static>,
    bold: Face<'static>,
    italic: Face<'static>,
}

impl Faces {
    pub(super) fn new() -> Self {
        let face = |file| Face::parse(file, 0).expect("an embedded font is whole");
        Self { sans: face(SANS), bold: face(BOLD), italic: face(ITALIC) }
    }

    /// The face that draws a letter, and its glyph there: signs that italic and bold lack are
    /// taken from the upright face. `None` where no face has it.
    fn glyph(&self, letter: char, italic: bool, bold: bool) -> Option<(&Face<'static>, GlyphId)> {
        let first = match (italic, bold) {
            (true, _) => &self.italic,
            (_, true) => &self.bold,
            _ => &self.sans,
        };
        [first, &self.sans].into_iter().find_map(|face| Some((face, face.glyph_index(letter)?)))
    }

    /// Whether every letter of `runs` can be drawn.
    #[cfg(test)]
    pub(super) fn cover(&self, runs: &[Run], bold: bool) -> bool {
        let has = |run: &Run| run.words.chars().all(|c| self.glyph(c, run.italic, bold).is_some());
        runs.iter().all(has)
    }

    /// How far left and right a line of text reaches.
    pub(super) fn extent(&self, line: &Text) -> [f64; 2] {
        let width = self.width(&line.runs, line.size, line.bold);
        let left = match line.anchor {
            Anchor::Start => line.at.x,
            Anchor::Middle => line.at.x - 0.5 * width,
            Anchor::End => line.at.x - width,
        };
        [left, left + width]
    }

    /// The width of `runs` at `size`.
    fn width(&self, runs: &[Run], size: f64, bold: bool) -> f64 {
        runs.iter().map(|run| self.advance(run, bold) * size * run.script.scale()).sum()
    }

    fn advance(&self, run: &Run, bold: bool) -> f64 {
        let advance = |letter| {
            let (face, glyph) = self.glyph(letter, run.italic, bold)?;
            Some(f64::from(face.glyph_hor_advance(glyph)?) / f64::from(face.units_per_em()))
        };
        run.words.chars().filter_map(advance).sum()
    }

    /// The outlines of `runs` with the pen first at `at`.
    pub(super) fn outline(&self, runs: &[Run], at: Point, size: f64, bold: bool) -> Path {
        let mut path = Path::default();
        let mut pen = Pen { path: &mut path, at, scale: 1.0 };
        for run in runs {
            let size_here = size * run.script.scale();
            pen.at.y = at.y + run.script.drop() * size;
            for letter in run.words.chars() {
                let Some((face, glyph)) = self.glyph(letter, run.italic, bold) else { continue };
                pen.scale = size_here / f64::from(face.units_per_em());
                face.outline_glyph(glyph, &mut pen);
                pen.at.x += f64::from(face.glyph_hor_advance(glyph).unwrap_or(0)) * pen.scale;
            }
        }
        path
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(words: &str, italic: bool, script: Script) -> Run {
        Run { words: words.to_owned(), italic, script }
    }

    #[test]
    fn markup_becomes_italics_and_scripts() {
        let expected = [
            run("k", true, Script::Line),
            run("d", false, Script::Below),
            run(" (", false, Script::Line),
            run("r", true, Script::Line),
            run(")", false, Script::Line),
            run("α", true, Script::Above),
            run(" + 1", false, Script::Line),
        ];
        assert_eq!(runs("*k*_d (*r*)^{*α*} + 1"), expected);
    }

    #[test]
    fn html_escapes_words_and_keeps_scripts() {
        assert_eq!(html("*a*_i < b^{2n}"), "<i>a</i><sub>i</sub> &lt; b<sup>2n</sup>");
    }

    #[test]
    fn scripts_are_narrower_than_the_line() {
        let faces = Faces::new();
        let width = |markup| faces.width(&runs(markup), 20.0, false);
        assert!(width("x^{22}") < width("x22"));
        assert_eq!(width("−−"), 2.0 * width("−"));
    }
}
