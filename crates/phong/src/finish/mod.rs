//! What finishes a picture after its film, and before it is written.
//!
//! What belongs here is drawn onto a picture (outlines, labels, tone) and is no term: the film is always
//! the sum of its terms.

mod cel;
mod outline;
mod patch;
mod tone;

use std::borrow::Cow;
use std::sync::OnceLock;

use phong_scene::{Rgb, Tone};

use crate::film::{Film, LayerKind, Window};
use crate::render::{Lines, RenderOptions};
pub use tone::{ToneMap, ToneSteps};

pub use patch::Patch;

/// How a picture is to be finished. The default leaves it as its film has it.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Finishing {
    /// The scene's [`fingerprint`](crate::part::fingerprint()): PNG and EXR files then say which
    /// scene they are of. `None`: they do not.
    pub scene: Option<u32>,
    /// The checksum of all that the picture depends on
    /// ([`Settings::checksum`](crate::part::Settings::checksum)): PNG and EXR files then say which
    /// picture they are ([`picture_of`](crate::image::picture_of)). `None`: they do not.
    pub picture: Option<u32>,
    /// Lines around things; `None`: there are none. They are drawn by [`Lines::NEEDS`] of the film.
    pub lines: Option<Lines>,
    /// In how many steps from black to white the picture's luminance comes, 2 to 64, beneath those lines;
    /// `None`: it stays as it is.
    pub cel: Option<u32>,
    /// What of the film is shown: its window without the margin that lines and steps needed, and the layers that were
    /// asked for; `None`: all of it.
    pub shown: Option<(Window, Vec<LayerKind>)>,
    /// Pixels an inch, which PNG files say; `None`: they do not.
    pub dpi: Option<f64>,
    /// What lies over all that, one upon the other: the furniture of a figure.
    pub patches: Vec<Patch>,
    /// How light becomes what a PNG shows. The film is not changed by it, nor are terms and PFM files; EXR files hold
    /// light as it is, and the finished picture beside it.
    pub tone: Tone,
}

impl Finishing {
    /// How a picture with these options is finished, of whatever scene it is; its file says nothing of
    /// that scene.
    pub fn of(options: &RenderOptions) -> Self {
        let (lines, cel) = (options.lines(), options.cel());
        let shown = options.keeps_more().then(|| (options.shown(), options.shown_layers()));
        Self { lines, cel, shown, tone: options.tone(), ..Self::default() }
    }

    /// Whether the finished picture is another than that of the film.
    pub fn draws(&self) -> bool {
        self.lines.is_some()
            || self.cel.is_some()
            || !self.patches.is_empty()
            || self.tone != Tone::default()
    }

    /// The same, of the scene with this [`fingerprint`](crate::part::fingerprint()).
    #[must_use]
    pub fn of_scene(self, fingerprint: u32) -> Self {
        Self { scene: Some(fingerprint), ..self }
    }

    /// The same, with such tone.
    #[must_use]
    pub fn with_tone(self, tone: Tone) -> Self {
        Self { tone, ..self }
    }

    /// The same, of the picture with this checksum.
    #[must_use]
    pub fn of_picture(self, checksum: u32) -> Self {
        Self { picture: Some(checksum), ..self }
    }
}

/// A film, and the picture that it is finished to.
#[derive(Clone, Debug)]
pub struct Finished<'a> {
    film: Cow<'a, Film>,
    /// The picture and its alpha with the lines that are drawn onto it, and in steps; `None`: as the film
    /// has it.
    lined: Option<[Vec<f32>; 2]>,
    /// By what steps scale the light of each pixel; empty: there are none.
    scales: Vec<f32>,
    /// How much of each pixel lines cover; empty: there are none.
    coverage: Vec<f32>,
    /// What lies over that.
    patches: Vec<Patch>,
    /// The picture and its alpha with all that is drawn onto it, where that is patches.
    covered: OnceLock<[Vec<f32>; 2]>,
    dpi: Option<f64>,
    scene: Option<u32>,
    picture: Option<u32>,
    tone: ToneMap,
}

/// A pixel with the line that is drawn onto it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lined {
    /// How much of it the line covers, above 0 and at most 1.
    pub share: f32,
    /// It, linear, and as far as it is opaque.
    pub linear: Rgb,
    /// How opaque it is, in [0, 1].
    pub alpha: f32,
}

/// Finishes a film's picture.
pub fn finish<'a>(film: &'a Film, finishing: &Finishing) -> Finished<'a> {
    let mut finished = drawn(film, finishing);
    if finishing.cel.is_some() {
        return finished;
    }
    // What covers the picture is no light that could expose it.
    let beneath = |kind| finished.beneath(kind);
    let (picture, alpha) = (beneath(LayerKind::Picture), beneath(LayerKind::Alpha));
    finished.tone = ToneMap::new(&finishing.tone, picture.unwrap_or_default(), alpha);
    finished
}

/// A film with what is drawn onto its picture, and light as it is; where that comes in steps, exposed as they
/// were found.
fn drawn<'a>(film: &'a Film, finishing: &Finishing) -> Finished<'a> {
    let Finishing { scene, picture, lines, cel, shown, dpi, patches, tone } = finishing;
    let (scene, picture, dpi, patches) = (*scene, *picture, *dpi, patches.clone());
    let shown_film = match shown {
        Some((window, kinds)) => Cow::Owned(film.cut(*window, kinds)),
        None => Cow::Borrowed(film),
    };
    // What is found of the whole film, of the part that is shown.
    let cut = |values: Vec<f32>| match shown {
        Some((window, _)) => film.cut_values(&values, 1, *window),
        None => values,
    };
    let (mut exposed, mut scales) = (ToneMap::default(), Vec::new());
    if let Some(steps) = *cel {
        let [picture, alpha] = values(&shown_film);
        exposed = ToneMap::new(tone, &picture, Some(&alpha));
        scales = cut(cel::scales(film, steps, exposed.gain()));
    }
    let lines = lines.and_then(|lines| Some((cut(outline::coverage(film, &lines)?), lines)));
    let lined = (lines.is_some() || !scales.is_empty()).then(|| {
        let mut drawn = values(&shown_film);
        cel::scale(&mut drawn[0], &scales);
        if let Some((coverage, lines)) = &lines {
            line(&mut drawn, coverage, lines);
        }
        drawn
    });
    let coverage = lines.map(|(coverage, _)| coverage).unwrap_or_default();
    let (film, covered, tone) = (shown_film, OnceLock::new(), exposed);
    Finished { film, lined, scales, coverage, patches, covered, dpi, scene, picture, tone }
}

/// A film's picture and alpha; where it has none, all of it is covered.
fn values(film: &Film) -> [Vec<f32>; 2] {
    let values = |kind| film.layer(kind).map(|layer| layer.values.to_vec());
    let picture = values(LayerKind::Picture).unwrap_or_default();
    let alpha = values(LayerKind::Alpha).unwrap_or_else(|| vec![1.0; picture.len() / 3]);
    [picture, alpha]
}

/// Draws lines over a picture and its alpha, which cover each pixel by so much.
fn line([picture, alpha]: &mut [Vec<f32>; 2], coverage: &[f32], lines: &Lines) {
    let color = lines.color.to_array();
    for (pixel, &share) in picture.as_chunks_mut::<3>().0.iter_mut().zip(coverage) {
        if share > 0.0 {
            for (value, color) in pixel.iter_mut().zip(color) {
                *value = *value * (1.0 - share) + color * share;
            }
        }
    }
    for (alpha, &share) in alpha.iter_mut().zip(coverage) {
        *alpha += (1.0 - *alpha) * share;
    }
}

impl Finished<'_> {
    /// The film, as it was rendered.
    pub fn film(&self) -> &Film {
        &self.film
    }

    /// Red, green and blue of the finished picture, and its alpha; `None`: nothing is drawn onto it.
    pub(crate) fn drawn(&self) -> Option<[&[f32]; 2]> {
        let drawn = if self.patches.is_empty() {
            self.lined.as_ref()?
        } else {
            self.covered.get_or_init(|| {
                let mut drawn = self.lined.clone().unwrap_or_else(|| values(&self.film));
                for patch in &self.patches {
                    patch.over_linear(self.film.window, &mut drawn);
                }
                drawn
            })
        };
        Some([&drawn[0], &drawn[1]])
    }

    /// Red, green and blue of the finished picture, and its alpha, as a PNG clamps it and puts it on its curve;
    /// `None`: nothing but exposure finishes it.
    pub(crate) fn toned(&self) -> Option<[Cow<'_, [f32]>; 2]> {
        if self.tone.only_gain().is_some_and(|gain| gain == 1.0) {
            return Some(self.drawn()?.map(Cow::Borrowed));
        }
        if self.lined.is_none() && self.patches.is_empty() && self.tone.only_gain().is_some() {
            return None;
        }
        let [picture, alpha] = self.lined.clone().unwrap_or_else(|| values(&self.film));
        let mut drawn = [self.tone.toned(&picture, &alpha), alpha];
        for patch in &self.patches {
            patch.over_linear(self.film.window, &mut drawn);
        }
        Some(drawn.map(Cow::Owned))
    }

    /// What is to be laid over the levels of a file that [`beneath`](Self::beneath) becomes.
    pub fn patches(&self) -> &[Patch] {
        &self.patches
    }

    /// The values of a layer as they are to be seen, without what [`patches`](Self::patches) cover.
    pub fn beneath(&self, kind: LayerKind) -> Option<&[f32]> {
        match (kind, &self.lined) {
            (LayerKind::Picture, Some([picture, _])) => return Some(picture),
            (LayerKind::Alpha, Some([_, alpha])) => return Some(alpha),
            _ => {}
        }
        self.film.layer(kind).map(|layer| &*layer.values)
    }

    /// By what steps of luminance scale the light of a pixel, which counts from the upper left corner of what
    /// is shown; `None`: there are none, or no such pixel.
    pub fn scale_at(&self, pixel: [u32; 2]) -> Option<f32> {
        self.scales.get(self.number_of(pixel)?).copied()
    }

    /// A pixel, which counts in the same way, with the line on it; `None`: there is none, or no such pixel.
    pub fn lined_at(&self, pixel: [u32; 2]) -> Option<Lined> {
        let number = self.number_of(pixel)?;
        let share = self.coverage.get(number).copied().filter(|share| *share > 0.0)?;
        let [picture, alpha] = self.lined.as_ref()?;
        let (linear, alpha) = (picture.as_chunks::<3>().0.get(number)?, *alpha.get(number)?);
        Some(Lined { share, linear: Rgb::from(*linear), alpha })
    }

    /// The number of a pixel of what is shown; `None`: there is no such pixel.
    fn number_of(&self, [x, y]: [u32; 2]) -> Option<usize> {
        let (width, height) = (self.film.width(), self.film.height());
        (x < width && y < height).then(|| y as usize * width as usize + x as usize)
    }

    /// How its light becomes what a PNG shows.
    pub fn tone(&self) -> &ToneMap {
        &self.tone
    }

    /// Pixels an inch, which files say; `None`: they do not.
    pub(crate) fn dpi(&self) -> Option<f64> {
        self.dpi
    }

    /// The finished picture as a film of its own, whose picture and alpha are what is drawn.
    #[must_use]
    pub fn into_film(self) -> Film {
        let drawn = self.drawn().map(|drawn| drawn.map(<[f32]>::to_vec));
        let mut film = self.film.into_owned();
        let Some([picture, alpha]) = drawn else { return film };
        for layer in &mut film.layers {
            match layer.kind {
                LayerKind::Picture => layer.values.copy_from_slice(&picture),
                LayerKind::Alpha => layer.values.copy_from_slice(&alpha),
                _ => {}
            }
        }
        film
    }

    /// What a file says of its origin: the program with its version, the scene's fingerprint, and the
    /// picture's checksum.
    pub(crate) fn origin(&self) -> [Option<(&'static str, String)>; 3] {
        let program = concat!("phong ", env!("CARGO_PKG_VERSION")).to_owned();
        let sum = |sum: u32| format!("crc32 {sum:08x}");
        [
            Some(("Software", program)),
            self.scene.map(|scene| ("Scene", sum(scene))),
            self.picture.map(|picture| ("Picture", sum(picture))),
        ]
    }

    /// The values of a layer as they are to be seen; `None` if the film has no such layer.
    pub fn values(&self, kind: LayerKind) -> Option<&[f32]> {
        match (kind, self.drawn()) {
            (LayerKind::Picture, Some([picture, _])) => Some(picture),
            (LayerKind::Alpha, Some([_, alpha])) => Some(alpha),
            _ => self.film.layer(kind).map(|layer| &*layer.values),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    use crate::aov::Aov;

    #[test]
    fn a_picture_that_nothing_finishes_is_its_film() {
        let size = [3, 2];
        let mut film = Film::new(size, Window::full(size), 16, &[LayerKind::Picture]);
        film.layers[0].values[4] = 0.25;
        let finished = finish(&film, &Finishing::default());
        assert_eq!(finished.film(), &film);
        assert_eq!(finished.values(LayerKind::Picture), Some(&*film.layers[0].values));
        assert_eq!(finished.values(LayerKind::Alpha), None);
    }

    /// White but for a black line of two pixels between two objects, and what a part of it shows.
    #[test]
    fn a_line_between_two_objects_covers_its_width_and_a_part_has_the_line_of_the_whole() {
        let lines =
            Lines { width: 2.0, color: Rgb::BLACK, objects: true, depth: 0.0, crease: 180.0 };
        let size = [24, 8];
        let kinds = [LayerKind::Picture, LayerKind::Alpha]
            .into_iter()
            .chain(Lines::NEEDS.map(LayerKind::Aov))
            .collect::<Vec<_>>();
        let mut film = Film::new(size, Window::full(size), 16, &kinds);
        for layer in &mut film.layers {
            let n = layer.kind.channels();
            for (i, value) in layer.values.iter_mut().enumerate() {
                let x = i / n % 24;
                *value = match layer.kind {
                    LayerKind::Picture => 1.0,
                    LayerKind::Alpha | LayerKind::Aov(Aov::Object) if x < 12 => 1.0,
                    _ => 0.0,
                };
            }
        }
        let finishing = Finishing { lines: Some(lines), ..Finishing::default() };
        let whole = finish(&film, &finishing);
        let row: Vec<f32> = (0..24)
            .map(|x| whole.values(LayerKind::Picture).expect("a picture")[3 * (4 * 24 + x)])
            .collect();
        // It runs at 11.5, between the middles of two pixels, which it covers wholly.
        assert_eq!(row[9..15], [1.0, 1.0, 0.0, 0.0, 1.0, 1.0]);
        let alpha = whole.values(LayerKind::Alpha).expect("alpha");
        assert_eq!(alpha[4 * 24 + 10..4 * 24 + 14], [1.0, 1.0, 1.0, 0.0]);
        assert_eq!(whole.film(), &film);
        let shown = Window { x0: 12, y0: 2, x1: 20, y1: 5 };
        let kinds = vec![LayerKind::Picture, LayerKind::Alpha];
        let part = Finishing { shown: Some((shown, kinds)), ..finishing };
        let part = finish(&film, &part);
        let drawn = part.values(LayerKind::Picture).expect("a picture");
        assert_eq!((drawn.len(), drawn[0], drawn[3]), (3 * 8 * 3, 0.0, 1.0));
        assert_eq!((part.film().width(), part.film().layers.len()), (8, 2));
    }
}
