//! The pictures of two eyes as one.

use phong::film::{Film, LayerKind, Window};
use phong::finish::{Finished, Patch};

/// How the pictures of two eyes become one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pairing {
    /// The left eye's to the left of the right eye's.
    SideBySide,
    /// Red of the left eye's, green and blue of the right eye's: for glasses that are red before the left
    /// eye and cyan before the right.
    Anaglyph,
}

impl Pairing {
    /// The size of the picture that two of this size become.
    pub fn size(self, [width, height]: [u32; 2]) -> [u32; 2] {
        match self {
            Self::SideBySide => [2 * width, height],
            Self::Anaglyph => [width, height],
        }
    }

    /// The film of both eyes' finished pictures, which are of one size, and what is still to be laid over it.
    /// It holds the picture and its alpha.
    pub fn pair(self, left: &Finished<'_>, right: &Finished<'_>) -> (Film, Vec<Patch>) {
        match self {
            Self::SideBySide => side_by_side([left, right]),
            Self::Anaglyph => anaglyph([left, right]),
        }
    }
}

const KINDS: [LayerKind; 2] = [LayerKind::Picture, LayerKind::Alpha];

fn empty(size: [u32; 2], tile: u32) -> Film {
    let mut film = Film::new(size, Window::full(size), tile, &KINDS);
    film.done.fill(true);
    film
}

fn side_by_side(eyes: [&Finished<'_>; 2]) -> (Film, Vec<Patch>) {
    let film = eyes[0].film();
    let (width, height) = (film.width(), film.height());
    let mut both = empty(Pairing::SideBySide.size([width, height]), film.tile);
    let mut patches = Vec::new();
    for (eye, from) in eyes.into_iter().zip([0, width]) {
        for layer in &mut both.layers {
            let n = layer.kind.channels();
            let values = eye.beneath(layer.kind).unwrap_or_default();
            let rows = values.chunks_exact(n * width as usize);
            for (to, row) in layer.values.chunks_exact_mut(2 * n * width as usize).zip(rows) {
                to[n * from as usize..][..row.len()].copy_from_slice(row);
            }
        }
        let part = eye.film().window;
        patches.extend(eye.patches().iter().filter_map(|patch| patch.cut(part, [from, 0])));
    }
    (both, patches)
}

fn anaglyph(eyes: [&Finished<'_>; 2]) -> (Film, Vec<Patch>) {
    let film = eyes[0].film();
    let mut both = empty([film.width(), film.height()], film.tile);
    for layer in &mut both.layers {
        let [left, right] = eyes.map(|eye| eye.beneath(layer.kind).unwrap_or_default());
        let n = layer.kind.channels();
        for (i, to) in layer.values.iter_mut().enumerate() {
            let (left, right) = (left.get(i), right.get(i));
            let seen = match layer.kind {
                LayerKind::Picture if i % n == 0 => left.copied(),
                LayerKind::Picture => right.copied(),
                // What either eye sees is there.
                _ => left.zip(right).map(|(left, right)| left.max(*right)),
            };
            *to = seen.unwrap_or_default();
        }
    }
    let mut patches = Vec::new();
    for (eye, channels) in eyes.into_iter().zip([[true, false, false], [false, true, true]]) {
        let part = eye.film().window;
        let seen = eye.patches().iter().filter_map(|patch| patch.cut(part, [0, 0]));
        patches.extend(seen.map(|patch| Patch { channels, ..patch }));
    }
    (both, patches)
}

#[cfg(test)]
mod tests {
    use phong::finish::{Finishing, finish};

    use super::*;

    /// A picture of two pixels, and ink on the second.
    fn film(level: f32) -> Film {
        let mut film = empty([2, 1], 16);
        film.layers[0].values.fill(level);
        film.layers[1].values.fill(1.0);
        film
    }

    fn inked() -> Finishing {
        let window = Window { x0: 1, y0: 0, x1: 2, y1: 1 };
        let mut finishing = Finishing::default();
        finishing.patches =
            vec![Patch { window, pixels: vec![[255, 255, 255, 255]], channels: [true; 3] }];
        finishing
    }

    #[test]
    fn two_pictures_side_by_side_keep_their_ink() {
        let (left, right) = (film(0.25), film(0.5));
        let [left, right] = [&left, &right].map(|film| finish(film, &inked()));
        let (both, patches) = Pairing::SideBySide.pair(&left, &right);
        assert_eq!((both.width(), both.height(), both.is_complete()), (4, 1, true));
        let red: Vec<f32> = both.layers[0].values.iter().step_by(3).copied().collect();
        assert_eq!(red, [0.25, 0.25, 0.5, 0.5]);
        assert_eq!(patches.iter().map(|patch| patch.window.x0).collect::<Vec<_>>(), [1, 3]);
    }

    #[test]
    fn an_anaglyph_is_red_for_the_left_eye_and_cyan_for_the_right() {
        let (left, right) = (film(0.25), film(0.5));
        let [left, right] = [&left, &right].map(|film| finish(film, &inked()));
        let (both, patches) = Pairing::Anaglyph.pair(&left, &right);
        assert_eq!(*both.layers[0].values, [0.25, 0.5, 0.5, 0.25, 0.5, 0.5], "no ink is light");
        let inks: Vec<_> = patches.iter().map(|patch| (patch.window.x0, patch.channels)).collect();
        assert_eq!(inks, [(1, [true, false, false]), (1, [false, true, true])]);
    }
}
