//! Words as outlines, in the one font of furniture.

use rustybuzz::ttf_parser::GlyphId;
use rustybuzz::{Face, UnicodeBuffer, shape};

use crate::draw::{Path, Pen, Point};

/// The font; see `font/README.md`.
const FONT: &[u8] = include_bytes!("font/sans.ttf");

/// From one line to the next, in heights of letters.
const LEADING: f64 = 1.25;

/// How far a capital letter rises above the line, in heights of letters.
pub(super) const CAPITAL: f64 = 0.714;

/// The font, ready to measure and to draw.
pub(super) struct Font(Face<'static>);

/// Words as an outline.
pub(super) struct Words {
    /// It, from the left end of its first line: (0, 0) is where the first letter stands on the line.
    pub(super) path: Path,
    /// How wide it is.
    pub(super) width: f64,
    /// How far its last line is below its first.
    pub(super) drop: f64,
}

impl Font {
    pub(super) fn new() -> Self {
        Self(Face::from_slice(FONT, 0).expect("an embedded font is whole"))
    }

    /// The letters that the font does not have, each once, in the order that they come in.
    pub(super) fn missing(&self, text: &str) -> Vec<char> {
        let mut missing = Vec::new();
        for letter in text.chars().filter(|letter| *letter != '\n') {
            if self.0.glyph_index(letter).is_none() && !missing.contains(&letter) {
                missing.push(letter);
            }
        }
        missing
    }

    /// Words in lines no wider than `most` with letters `size` high, as far as their spaces allow.
    pub(super) fn broken(&self, text: &str, size: f64, most: f64) -> String {
        let fits = |line: &str| self.words(line, size).width <= most;
        let mut lines: Vec<String> = Vec::new();
        for line in text.split('\n') {
            if fits(line) {
                lines.push(line.to_owned());
                continue;
            }
            let mut last = String::new();
            for word in line.split_whitespace() {
                let longer = format!("{last} {word}");
                if last.is_empty() {
                    word.clone_into(&mut last);
                } else if fits(&longer) {
                    last = longer;
                } else {
                    lines.push(std::mem::replace(&mut last, word.to_owned()));
                }
            }
            lines.push(last);
        }
        lines.join("\n")
    }

    /// Words with letters `size` high, each line shaped as its script wants it. Letters that the font does
    /// not have are left out.
    pub(super) fn words(&self, text: &str, size: f64) -> Words {
        let scale = size / f64::from(self.0.units_per_em());
        let mut words = Words { path: Path::default(), width: 0.0, drop: 0.0 };
        for (number, line) in text.split('\n').enumerate() {
            words.drop = number as f64 * LEADING * size;
            let mut buffer = UnicodeBuffer::new();
            line.chars()
                .filter(|letter| self.0.glyph_index(*letter).is_some())
                .for_each(|letter| buffer.add(letter, 0));
            buffer.guess_segment_properties();
            let glyphs = shape(&self.0, &[], buffer);
            let mut pen = Point::new(0.0, words.drop);
            for (glyph, place) in glyphs.glyph_infos().iter().zip(glyphs.glyph_positions()) {
                let off = Point::new(f64::from(place.x_offset), -f64::from(place.y_offset));
                let mut outline = Pen { path: &mut words.path, at: pen + off * scale, scale };
                let glyph = GlyphId(glyph.glyph_id as u16);
                self.0.outline_glyph(glyph, &mut outline);
                pen.x += f64::from(place.x_advance) * scale;
            }
            words.width = words.width.max(pen.x);
        }
        words
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_shaped_and_not_letters_side_by_side() {
        let font = Font::new();
        let width = |text: &str| font.words(text, 100.0).width;
        assert!(width("AV") < width("A") + width("V") - 1.0, "kerning");
        // An accent that is a letter of its own stands over the letter before it.
        assert_eq!(width("a\u{301}"), width("a"));
        assert_eq!(width("Å"), width("A\u{30a}"));
    }

    #[test]
    fn letters_that_the_font_lacks_are_named_once_and_left_out() {
        let font = Font::new();
        assert_eq!(font.missing("Å, µm, 10⁻³ Ω, λ, Жизнь, Việt\n5 ≪ x"), ['≪']);
        assert_eq!(font.missing("水と水"), ['水', 'と']);
        assert_eq!(font.words("水", 10.0).width, 0.0);
        assert!(font.words("水", 10.0).path.0.is_empty());
    }

    #[test]
    fn signs_of_mathematics_are_drawn() {
        let font = Font::new();
        for sign in "−←↑→↓∂∇∈∑√∝∞∠∥∫≈≠≤≥⊥⋅±×·°".chars()
        {
            let words = font.words(&sign.to_string(), 10.0);
            assert!(words.width > 0.0 && !words.path.0.is_empty(), "{sign}");
        }
    }

    #[test]
    fn lines_are_broken_at_spaces_where_they_are_too_wide() {
        let font = Font::new();
        let broken = |text, most| font.broken(text, 10.0, most);
        let most = font.words("one two", 10.0).width;
        assert_eq!(broken("one two", most), "one two");
        assert_eq!(broken("one two one two\n one", most), "one two\none two\n one");
        assert_eq!(broken("one two", 1.0), "one\ntwo");
    }

    #[test]
    fn lines_stand_one_below_the_other() {
        let font = Font::new();
        let (one, two) = (font.words("word", 10.0), font.words("word\nword", 10.0));
        assert_eq!((one.drop, two.drop), (0.0, 12.5));
        assert_eq!(two.width, one.width);
    }
}
