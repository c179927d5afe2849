//! Of which style the atoms of a data file are that does not say it: what their columns hold tells.

use glam::DVec3;

use crate::bounds::Bounds;
use crate::format::atoms::is_integer;
use crate::molecule::Cell;

/// How many of the first rows are looked at.
const LOOK: usize = 64;

/// No atom has a charge beyond this, in units of the electron's; places are beyond it easily.
const MOST_CHARGE: f64 = 9.0;

/// What was found.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Guess {
    /// What stands before the place, as in [`STYLES`](super::data).
    pub(super) before: &'static str,
    /// Why another style might be meant, to be told.
    pub(super) doubt: Option<String>,
}

/// The first rows of a section, of one length.
#[derive(Debug)]
pub(super) struct Sample<'a> {
    rows: Vec<Vec<&'a [u8]>>,
    length: usize,
    /// How many types of atoms there are; 0: nobody says it.
    types: u64,
    bounds: Option<Bounds>,
}

impl<'a> Sample<'a> {
    /// The rows at the beginning of a text, which may be cut short if it is not `whole`.
    pub(super) fn new(text: &'a [u8], whole: bool, types: u64, cell: Option<&Cell>) -> Self {
        let end =
            if whole { text.len() } else { text.iter().rposition(|b| *b == b'\n').unwrap_or(0) };
        let lines = text[..end].split(|b| matches!(b, b'\n' | b'\r'));
        let words = |line: &'a [u8]| -> Vec<&'a [u8]> {
            let line = line.split(|b| *b == b'#').next().unwrap_or_default();
            line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).collect()
        };
        let mut rows: Vec<Vec<&[u8]>> = lines
            .map(words)
            .filter(|words| !words.is_empty())
            // Then another section begins.
            .take_while(|words| is_integer(words[0]))
            .take(LOOK)
            .collect();
        let length = rows.first().map_or(0, Vec::len);
        rows.retain(|row| row.len() == length);
        let bounds = cell.map(|cell| {
            let corners = (0..8).map(|corner| {
                let edges = (0..3).filter(|i| corner >> i & 1 == 1).map(|i| cell.edges[i]);
                cell.origin + edges.sum::<DVec3>()
            });
            let tight = corners.fold(Bounds::EMPTY, Bounds::with);
            let room = 1e-6 * tight.size();
            Bounds { min: tight.min - room, max: tight.max + room }
        });
        Self { rows, length, types, bounds }
    }

    /// The style that fits; `Err`: none does.
    pub(super) fn guess(&self) -> Result<Guess, String> {
        let length = self.length;
        // Three whole numbers at the end say in which image of the box an atom is.
        let images = length > 7 && (length - 3..length).all(|i| self.is_whole(i));
        let count = length - if images { 3 } else { 0 };
        let fractional = |i: usize| self.is_fractional(i);
        let mut doubt = None;
        let (before, style) = match count {
            5 => ("it", "atomic"),
            6 if self.is_type(2) && !self.is_label(1) => ("imt", "bond"),
            6 => ("itq", "charge"),
            7 if fractional(2) && self.is_volume(2, 4) => ("it--", "peri"),
            7 if fractional(2) => ("itd-", "sphere"),
            // Flags whether an atom is an ellipsoid or a body.
            7 if !self.is_type(2) && self.is_flag(2) => ("it--", "ellipsoid"),
            7 => ("imtq", "full"),
            // Density, energy and capacity; a charge, a spin and a radius; a molecule, a flag and a
            // density.
            8 if fractional(3) => ("it---", "sph"),
            8 if fractional(4) => ("itq--", "electron"),
            8 => ("imt--", "line"),
            // A place, the direction of a spin and how large it is; a charge, a place and a moment.
            9 if self.is_direction(5) => ("it", "spin"),
            9 => {
                doubt = Some("nine columns may be of several styles".to_owned());
                ("itq", "dipole")
            }
            // A charge, a spin, a radius, a number and two shares; whole numbers up to a mass, and
            // between three of them and a flag.
            11 if !fractional(3) && !fractional(5) && fractional(4) => ("itq-----", "wavepacket"),
            12 if !(0..5).any(fractional) && !fractional(8) => ("imt------", "mesont"),
            // A volume, a mass and two radii, and where it was at first.
            13 if !fractional(2) && (3..7).any(fractional) => ("itm-------", "smd"),
            _ => {
                return Err(format!(
                    "the atoms have {length} columns, which fits no style; write `Atoms # full` or the like"
                ));
            }
        };
        let start = before.len();
        let doubt = doubt.or_else(|| self.doubt(before));
        let doubt = doubt.map(|why| {
            format!(
                "the section `Atoms` does not say its style, and {why}: they are read as `{style}`, with the places \
                 in columns {} to {}; if that is wrong, write `Atoms # full` or the like",
                start + 1,
                start + 3
            )
        });
        Ok(Guess { before, doubt })
    }

    /// Why what stands in the columns may not be what it is taken for.
    fn doubt(&self, before: &str) -> Option<String> {
        let type_at = before.find('t')?;
        if !self.is_type(type_at) {
            return Some(format!("column {} holds what is no type of atoms", type_at + 1));
        }
        if let Some(charge) = before.find('q')
            && self.numbers(charge).any(|q| q.abs() > MOST_CHARGE)
        {
            return Some(format!("column {} holds what are hardly charges", charge + 1));
        }
        let own = before.len();
        let outside = self.rows.len() - self.inside(own);
        let may_be = |start: usize| {
            self.inside(start) == self.rows.len()
                && (start..start + 3).all(|i| self.is_fractional(i))
        };
        let other = (2..=self.length - 3).find(|start| *start != own && may_be(*start))?;
        (10 * outside > self.rows.len()).then(|| {
            format!(
                "columns {} to {} lie in the box, too, and better than those of the places",
                other + 1,
                other + 3
            )
        })
    }

    /// How many rows have a place in the box in the columns from this one on; all, where there is no box.
    fn inside(&self, start: usize) -> usize {
        let Some(bounds) = self.bounds else { return self.rows.len() };
        let is_inside = |row: &&Vec<&[u8]>| {
            let place = vector(row, start);
            place.cmpge(bounds.min).all() && place.cmple(bounds.max).all()
        };
        self.rows.iter().filter(is_inside).count()
    }

    fn column(&self, i: usize) -> impl Iterator<Item = &'a [u8]> {
        self.rows.iter().map(move |row| row[i])
    }

    fn numbers(&self, i: usize) -> impl Iterator<Item = f64> {
        self.column(i).map(number)
    }

    /// Whether a column holds whole numbers alone.
    fn is_whole(&self, i: usize) -> bool {
        self.column(i).all(is_integer)
    }

    /// Whether one of its numbers is written as no whole one.
    fn is_fractional(&self, i: usize) -> bool {
        self.column(i).any(|word| !is_integer(word) && !number(word).is_nan())
    }

    /// Whether it holds names: types may be given by some.
    fn is_label(&self, i: usize) -> bool {
        self.column(i).any(|word| number(word).is_nan())
    }

    /// Whether it may hold types: names, or whole numbers from 1 up to as many as there are.
    fn is_type(&self, i: usize) -> bool {
        let most = if self.types == 0 { u64::MAX } else { self.types };
        let is_type = |word: &[u8]| {
            let n = number(word);
            n.is_nan() || is_integer(word) && n >= 1.0 && n <= most as f64
        };
        self.column(i).all(is_type)
    }

    /// Whether it holds 0 and 1 alone.
    fn is_flag(&self, i: usize) -> bool {
        self.column(i).all(|word| word == b"0" || word == b"1")
    }

    /// Whether a column holds the volume that each point of a grid fills, whose places begin in another: the
    /// cube of the way from the first to its nearest.
    fn is_volume(&self, i: usize, start: usize) -> bool {
        let mut places = self.rows.iter().map(|row| vector(row, start));
        let first = places.next().unwrap_or_default();
        let way = places.map(|place| place.distance(first)).fold(f64::INFINITY, f64::min);
        self.numbers(i).all(|volume| (volume / (way * way * way) - 1.0).abs() < 0.01)
    }

    /// Whether three columns hold directions of length 1, or nothing.
    fn is_direction(&self, start: usize) -> bool {
        self.rows.iter().all(|row| {
            let length = vector(row, start).length();
            length == 0.0 || (length - 1.0).abs() < 1e-3
        })
    }
}

/// Three numbers of a row.
fn vector(row: &[&[u8]], start: usize) -> DVec3 {
    DVec3::from([0, 1, 2].map(|i| number(row[start + i])))
}

/// A word as a number; NaN if it is none.
fn number(word: &[u8]) -> f64 {
    std::str::from_utf8(word).ok().and_then(|word| word.parse().ok()).unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What rows are taken for, of two types in a box of ten units, and what is told.
    fn guessed(text: &str) -> Result<(&'static str, String), String> {
        let size = 10.0;
        let edges = [DVec3::X * size, DVec3::Y * size, DVec3::Z * size];
        let cell = Cell { origin: DVec3::ZERO, edges };
        let guess = Sample::new(text.as_bytes(), true, 2, Some(&cell)).guess()?;
        Ok((guess.before, guess.doubt.unwrap_or_default()))
    }

    fn surely(text: &str) -> &'static str {
        let (before, doubt) = guessed(text).expect("a style");
        assert_eq!(doubt, "", "{text}");
        before
    }

    #[test]
    fn nine_columns_with_images_are_bonds_or_charges_by_what_they_hold() {
        assert_eq!(surely("1 1 2 1.5 2.5 3.5 0 0 -1\n2 1 1 4.5 2.5 3.5 0 1 0\n"), "imt");
        assert_eq!(surely("1 2 -0.8 1.5 2.5 3.5 0 0 -1\n"), "itq");
        // A charge that is whole here and not there, or that is no type.
        assert_eq!(surely("1 2 1 1.5 2.5 3.5 0 0 0\n2 2 0.5 1.5 2.5 3.5 0 0 0\n"), "itq");
        assert_eq!(surely("1 2 0 1.5 2.5 3.5 0 0 0\n2 1 -1 1.5 2.5 3.5 0 0 0\n"), "itq");
        // Types by name.
        assert_eq!(surely("1 7 C 1.5 2.5 3.5 0 0 0\n2 7 H 1.5 2.5 3.5 0 0 0\n"), "imt");
        assert_eq!(surely("1 C 1 1.5 2.5 3.5 0 0 0\n2 H 1 1.5 2.5 3.5 0 0 0\n"), "itq");
        // An image is whole in every row: here the last columns are of a place.
        assert!(guessed("1 1 1 1.5 2.5 3.5 0 0 0\n2 1 1 1.5 2.5 3.5 0 0 0.5\n").is_ok());
    }

    #[test]
    fn nine_columns_without_images_are_spins_or_a_guess_that_is_told() {
        assert_eq!(surely("1 1 1.5 2.5 3.5 0.6 0.8 0 2.2\n2 1 0.5 2.5 3.5 0 0 0 0.0\n"), "it");
        let (before, doubt) = guessed("1 1 0.5 1.5 2.5 3.5 0.3 0 0.1\n").expect("a style");
        assert_eq!(before, "itq");
        assert!(doubt.contains("read as `dipole`, with the places in columns 4 to 6"), "{doubt}");
    }

    #[test]
    fn five_six_seven_and_eight_columns_are_the_common_styles() {
        assert_eq!(surely("1 2 1.5 2.5 3.5\n"), "it");
        assert_eq!(surely("1 2 1.5 2.5 3.5 0 0 0\n"), "it");
        assert_eq!(surely("1 2 1 2 3\n"), "it");
        assert_eq!(surely("1 1 2 1.5 2.5 3.5\n"), "imt");
        assert_eq!(surely("1 1 2 -0.8 1.5 2.5 3.5\n"), "imtq");
        assert_eq!(surely("1 1 2 -0.8 1.5 2.5 3.5 0 1 0 # water\n"), "imtq");
        assert_eq!(surely("1 1 1.0 1.0 1.5 2.5 3.5\n"), "itd-");
        // A volume is the cube of the way to the nearest.
        let grid =
            "1 1 0.008 2.2 1.5 2.5 3.5\n2 1 0.008 2.2 1.9 2.5 3.5\n3 1 0.008 2.2 1.5 2.7 3.5\n";
        assert_eq!(surely(grid), "it--");
        assert_eq!(surely(&grid.replace("0.008", "0.2")), "itd-");
        assert_eq!(surely("1 1 0 1.0 1.5 2.5 3.5\n2 1 1 1.0 1.5 2.5 3.5\n"), "it--");
        let refused = guessed("1 1 2 -0.8 1.5 2.5 3.5 0.5 1 0\n").expect_err("no style");
        assert!(refused.contains("10 columns"), "{refused}");
    }

    #[test]
    fn places_that_are_elsewhere_are_told() {
        // Places first and then a charge, as mixed styles have them.
        let (_, doubt) = guessed("1 1 9.5 2.5 3.5 -0.8\n2 2 1.5 2.5 9.5 0.4\n").expect("a style");
        assert!(doubt.contains("hardly charges"), "{doubt}");
        let (_, doubt) = guessed("1 1 7.5 2.5 3.5 -0.8\n2 2 1.5 2.5 7.5 -0.4\n").expect("a style");
        assert!(doubt.contains("columns 3 to 5 lie in the box, too"), "{doubt}");
        let (_, doubt) = guessed("1 5 -0.8 1.5 2.5 3.5\n").expect("a style");
        assert!(doubt.contains("column 2 holds what is no type"), "{doubt}");
        // Whole molecules reach out of a box, and nothing else lies in it.
        assert_eq!(surely("1 1 2 -0.8 11.5 2.5 3.5\n2 1 2 -0.8 10.5 2.5 3.5\n"), "imtq");
    }

    #[test]
    fn what_is_cut_short_is_not_looked_at() {
        let sample = Sample::new(b"1 1 0.5 0.5 0.5\n2 1 0.5 0.", false, 0, None);
        assert_eq!((sample.rows.len(), sample.guess().map(|guess| guess.before)), (1, Ok("it")));
        assert!(Sample::new(b"", true, 0, None).guess().is_err());
    }
}
