//! What to render: options that are valid from the moment they exist.

use phong_scene::{FilterKind, Image, Scene, Tone};
use thiserror::Error;

use super::{Lines, Passes};
use crate::aov::Aov;
use crate::film::{LayerKind, Sums8, Window};
use crate::terms::TermSet;

/// What to render. Every value of this type can be rendered: what is out of range is refused where
/// it is given, with an [`OptionsError`].
///
/// ```
/// use phong::render::{OptionsError, RenderOptions};
/// use phong::terms::TermSet;
///
/// let options = RenderOptions::new([320, 180])?.with_samples(4)?.with_terms(TermSet::ALL);
/// assert_eq!((options.size(), options.samples()), ([320, 180], 4));
/// assert_eq!(options.with_samples(0), Err(OptionsError::Samples(0)));
/// # Ok::<(), OptionsError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct RenderOptions {
    size: [u32; 2],
    window: Window,
    share: Option<(u32, u32)>,
    samples: u32,
    seed: u64,
    depth: u32,
    min_weight: f32,
    shadows: bool,
    terminator: bool,
    filter: FilterKind,
    tile: u32,
    terms: TermSet,
    aovs: Vec<Aov>,
    /// How many lights have a layer of their own, beside that of the rest.
    lights: Option<u32>,
    passes: Passes,
    lines: Option<Lines>,
    /// In how many steps the luminance of the finished picture comes.
    cel: Option<u32>,
    /// Whether the distance of things is kept, for what they may hide of the picture's furniture.
    hides: bool,
    tone: Tone,
}

/// Why there are no such options: in every case the caller's fault.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum OptionsError {
    /// A picture's side has no pixel, or too many.
    #[error("a picture of {} × {} pixels: a side has 1 to {most}", .0[0], .0[1], most = Image::LARGEST)]
    Size([u32; 2]),
    /// The window holds no pixel, or reaches out of the picture.
    #[error(
        "the window from ({}, {}) to ({}, {}) holds no pixel or reaches out of the picture of {} × {}",
        window.x0, window.y0, window.x1, window.y1, size[0], size[1]
    )]
    Window {
        /// The window asked for.
        window: Window,
        /// The picture's size.
        size: [u32; 2],
    },
    /// The share is none of so many; they count from 0.
    #[error(
        "share {index} of {count}: shares count from 0, and the last is one less than their number"
    )]
    Share {
        /// The share asked for.
        index: u32,
        /// How many there are.
        count: u32,
    },
    /// There are too few or too many samples.
    #[error("{0} samples a pixel: there are 1 to {most}", most = Image::MOST_SAMPLES)]
    Samples(u32),
    /// Rays would bounce too often.
    #[error("{0} bounces: there are at most {most}", most = RenderOptions::MOST_DEPTH)]
    Depth(u32),
    /// The least weight of a ray is no share.
    #[error("a least weight of {0}: it is from 0 to 1")]
    MinWeight(f32),
    /// A tile would hold no pixel.
    #[error("a tile of 0 pixels")]
    Tile,
}

impl RenderOptions {
    /// The tile size used unless another is asked for: a few hundred rays are a good bundle.
    pub const TILE: u32 = 16;

    /// The most mirror and glass bounces.
    pub const MOST_DEPTH: u32 = 1024;

    /// All of a picture of `size` (width, height), all else as a scene that says nothing has it.
    ///
    /// # Errors
    /// [`OptionsError::Size`] unless each side is from 1 to [`Image::LARGEST`].
    pub fn new(size: [u32; 2]) -> Result<Self, OptionsError> {
        Self::of(&Image { size, ..Image::default() })
    }

    /// All of a picture as its scene has it. (The background is of the [`Look`](crate::look::Look).)
    ///
    /// # Errors
    /// As of [`new`](Self::new), [`with_samples`](Self::with_samples),
    /// [`with_depth`](Self::with_depth) and [`with_min_weight`](Self::with_min_weight): never for an
    /// image that the scene's check has passed.
    pub fn of(image: &Image) -> Result<Self, OptionsError> {
        let Image { size, samples, filter, seed, depth, min_weight, terminator, .. } = *image;
        let valid = Self {
            size: [1, 1],
            window: Window::full([1, 1]),
            share: None,
            samples: 1,
            seed,
            depth: 0,
            min_weight: 0.0,
            shadows: true,
            terminator,
            filter,
            tile: Self::TILE,
            terms: TermSet::NONE,
            aovs: Vec::new(),
            lights: None,
            passes: Passes::default(),
            lines: None,
            cel: None,
            hides: false,
            tone: Tone::default(),
        };
        valid.with_size(size)?.with_samples(samples)?.with_depth(depth)?.with_min_weight(min_weight)
    }

    /// Renders all of a picture of another size (width, height).
    ///
    /// # Errors
    /// [`OptionsError::Size`] unless each side is from 1 to [`Image::LARGEST`].
    pub fn with_size(self, size: [u32; 2]) -> Result<Self, OptionsError> {
        if size.iter().all(|side| (1..=Image::LARGEST).contains(side)) {
            Ok(Self { size, window: Window::full(size), ..self })
        } else {
            Err(OptionsError::Size(size))
        }
    }

    /// Renders only a part of the picture.
    ///
    /// # Errors
    /// [`OptionsError::Window`] if it holds no pixel or reaches out of the picture.
    pub fn with_window(self, window: Window) -> Result<Self, OptionsError> {
        if window.fits(self.size) {
            Ok(Self { window, ..self })
        } else {
            Err(OptionsError::Window { window, size: self.size })
        }
    }

    /// Renders only every `count`th tile of the window, from the one with number `index` on.
    ///
    /// # Errors
    /// [`OptionsError::Share`] unless `index < count`.
    pub fn with_share(self, index: u32, count: u32) -> Result<Self, OptionsError> {
        if index < count {
            Ok(Self { share: Some((index, count)), ..self })
        } else {
            Err(OptionsError::Share { index, count })
        }
    }

    /// Draws so many samples a pixel.
    ///
    /// # Errors
    /// [`OptionsError::Samples`] unless from 1 to [`Image::MOST_SAMPLES`].
    pub fn with_samples(self, samples: u32) -> Result<Self, OptionsError> {
        if (1..=Image::MOST_SAMPLES).contains(&samples) {
            Ok(Self { samples, ..self })
        } else {
            Err(OptionsError::Samples(samples))
        }
    }

    /// Follows mirror and glass rays over so many bounces; beyond them a ray brings black.
    ///
    /// # Errors
    /// [`OptionsError::Depth`] beyond [`RenderOptions::MOST_DEPTH`].
    pub fn with_depth(self, depth: u32) -> Result<Self, OptionsError> {
        if depth <= Self::MOST_DEPTH {
            Ok(Self { depth, ..self })
        } else {
            Err(OptionsError::Depth(depth))
        }
    }

    /// Does not follow mirror and glass rays where the product of all weights on the way from the
    /// camera is below this in every channel; they bring black. 0 follows all.
    ///
    /// # Errors
    /// [`OptionsError::MinWeight`] unless from 0 to 1.
    pub fn with_min_weight(self, min_weight: f32) -> Result<Self, OptionsError> {
        if (0.0..=1.0).contains(&min_weight) {
            Ok(Self { min_weight, ..self })
        } else {
            Err(OptionsError::MinWeight(min_weight))
        }
    }

    /// Works in tiles of this edge in pixels; it changes no bit of the picture.
    ///
    /// # Errors
    /// [`OptionsError::Tile`] for 0.
    pub fn with_tile(self, tile: u32) -> Result<Self, OptionsError> {
        if tile > 0 { Ok(Self { tile, ..self }) } else { Err(OptionsError::Tile) }
    }

    /// Draws the samples from another pattern.
    #[must_use]
    pub fn with_seed(self, seed: u64) -> Self {
        Self { seed, ..self }
    }

    /// Whether things stand in the way of lights at all; they do by default. If not, a light above the
    /// horizon of N is seen, whatever the geometry: the picture is the equation and nothing else.
    #[must_use]
    pub fn with_shadows(self, shadows: bool) -> Self {
        Self { shadows, ..self }
    }

    /// Whether shadow rays from meshes with smooth normals start above the face, so that faces do not
    /// show where light ends; else they start on the face, and light below its plane is not seen.
    #[must_use]
    pub fn with_terminator(self, terminator: bool) -> Self {
        Self { terminator, ..self }
    }

    /// Weights samples into a pixel by this filter.
    #[must_use]
    pub fn with_filter(self, filter: FilterKind) -> Self {
        Self { filter, ..self }
    }

    /// Keeps a layer for each of these terms; there is none by default.
    #[must_use]
    pub fn with_terms(self, terms: TermSet) -> Self {
        Self { terms, ..self }
    }

    /// Keeps these variables, each once, in the order of their first mention.
    #[must_use]
    pub fn with_aovs(self, aovs: &[Aov]) -> Self {
        let mut each: Vec<Aov> = Vec::with_capacity(aovs.len());
        for aov in aovs {
            if !each.contains(aov) {
                each.push(*aov);
            }
        }
        Self { aovs: each, ..self }
    }

    /// Keeps a layer of what each of the first `count` lights brought, and one of the rest; `None`, the
    /// default: neither. The rays are traced once for all of them, 16 at a time; each layer takes 12 bytes a
    /// pixel. The samples are then drawn at once, whatever the passes.
    #[must_use]
    pub fn with_lights(self, count: Option<u32>) -> Self {
        Self { lights: count, ..self }
    }

    /// Renders all samples at once, or from coarse to fine; it changes no bit of the last picture.
    #[must_use]
    pub fn with_passes(self, passes: Passes) -> Self {
        Self { passes, ..self }
    }

    /// Keeps what these lines are drawn by, and renders as much around the part that is shown as they
    /// are made of.
    #[must_use]
    pub fn with_lines(self, lines: Option<Lines>) -> Self {
        Self { lines, ..self }
    }

    /// Renders what steps of luminance are found by, when the picture comes in so many of them, from
    /// black to white: one pixel around the part that is shown. They are 2 to [`Image::MOST_STEPS`], and the
    /// nearest of these where another number is asked for.
    #[must_use]
    pub fn with_cel(self, steps: Option<u32>) -> Self {
        Self { cel: steps.map(|steps| steps.clamp(2, Image::MOST_STEPS)), ..self }
    }

    /// Keeps what the picture of this scene is finished by ([`finish`](crate::finish::finish)): its lines,
    /// its steps, and the distance of what may hide a label.
    #[must_use]
    pub fn with_finishing_of(self, scene: &Scene) -> Self {
        let Scene { outline, image, furniture, tone, .. } = scene;
        let lines = outline.as_ref().map(|outline| Lines::of(outline, image));
        let hides = furniture.needs_depth();
        let finished = self.with_lines(lines).with_cel(image.cel);
        Self { hides, ..finished.with_tone(tone.unwrap_or_default()) }
    }

    /// Makes light so what a PNG shows; it changes no bit of the film.
    #[must_use]
    pub fn with_tone(self, tone: Tone) -> Self {
        Self { tone, ..self }
    }

    /// How light becomes what a PNG shows, when the film is done.
    pub fn tone(&self) -> Tone {
        self.tone
    }

    /// Lines that are drawn when the film is done; `None`: there are none.
    pub fn lines(&self) -> Option<Lines> {
        self.lines
    }

    /// In how many steps the luminance of the finished picture comes; `None`: it stays as it is.
    pub fn cel(&self) -> Option<u32> {
        self.cel
    }

    /// Width and height of the full picture, pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// The part of it to render: what is shown, and what lines and steps need around that.
    pub fn window(&self) -> Window {
        let Window { x0, y0, x1, y1 } = self.window;
        let margin =
            self.lines.map_or(0, |lines| lines.margin()).max(u32::from(self.cel.is_some()));
        Window {
            x0: x0.saturating_sub(margin),
            y0: y0.saturating_sub(margin),
            x1: x1.saturating_add(margin).min(self.size[0]),
            y1: y1.saturating_add(margin).min(self.size[1]),
        }
    }

    /// The part of it that is shown.
    pub fn shown(&self) -> Window {
        self.window
    }

    /// `(i, n)`: only every nth tile of the window, from the ith on; `i < n`. `None`: all.
    pub fn share(&self) -> Option<(u32, u32)> {
        self.share
    }

    /// Samples a pixel, ≥ 1.
    pub fn samples(&self) -> u32 {
        self.samples
    }

    /// Seed of the sampling pattern.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// Mirror and glass bounces.
    pub fn depth(&self) -> u32 {
        self.depth
    }

    /// The least product of weights for which a mirror or glass ray is followed; 0: all are.
    pub fn min_weight(&self) -> f32 {
        self.min_weight
    }

    /// Whether things stand in the way of lights at all.
    pub fn shadows(&self) -> bool {
        self.shadows
    }

    /// Whether shadow rays from meshes with smooth normals start above the face.
    pub fn terminator(&self) -> bool {
        self.terminator
    }

    /// How samples are weighted into a pixel.
    pub fn filter(&self) -> FilterKind {
        self.filter
    }

    /// Edge of a tile in pixels, ≥ 1.
    pub fn tile(&self) -> u32 {
        self.tile
    }

    /// Which terms a layer is kept for.
    pub fn terms(&self) -> TermSet {
        self.terms
    }

    /// Which other variables are kept.
    pub fn aovs(&self) -> &[Aov] {
        &self.aovs
    }

    /// How many lights have a layer of their own, beside that of the rest; `None`: there is not even that.
    pub fn lights(&self) -> Option<u32> {
        self.lights
    }

    /// Whether all samples are drawn at once, or from coarse to fine.
    pub fn passes(&self) -> Passes {
        // Nothing is kept of lights' layers from which they could go on.
        if self.lights.is_none() { self.passes } else { Passes::One }
    }

    /// The same picture with one sample a pixel, at its centre.
    #[must_use]
    pub fn one_sample(&self) -> Self {
        Self { samples: 1, ..self.clone() }
    }

    /// Bytes of memory that a rendering keeps: its film, and between passes the pixels' sums.
    pub fn film_bytes(&self) -> u64 {
        let values: usize = self.layers().iter().map(|kind| kind.channels()).sum();
        let window = self.window();
        let film = window.pixels().saturating_mul(4 * values as u64);
        let between = match self.passes() {
            // The only sample is the last.
            Passes::CoarseToFine | Passes::Doubling if self.samples == 1 => 0,
            Passes::One => 0,
            Passes::CoarseToFine | Passes::Doubling => {
                let across = window.width().div_ceil(self.tile);
                let eights =
                    u64::from(across) * u64::from(self.tile.min(window.width()).div_ceil(8));
                let rows = eights * u64::from(window.height());
                rows.saturating_mul(size_of::<Sums8>() as u64)
            }
        };
        film.saturating_add(between)
    }

    /// The layers of the film: those that are shown, and what lines are drawn by.
    pub fn layers(&self) -> Vec<LayerKind> {
        let mut kinds = self.shown_layers();
        let lines: &[Aov] = if self.lines.is_some() { &Lines::NEEDS } else { &[] };
        let labels: &[Aov] = if self.hides { &[Aov::Depth] } else { &[] };
        for kind in lines.iter().chain(labels).map(|aov| LayerKind::Aov(*aov)) {
            if !kinds.contains(&kind) {
                kinds.push(kind);
            }
        }
        kinds
    }

    /// Whether the film holds any variable.
    pub(crate) fn has_variables(&self) -> bool {
        !self.aovs.is_empty() || self.lines.is_some() || self.hides
    }

    /// Whether the film holds more than is shown, for who finishes it.
    pub(crate) fn keeps_more(&self) -> bool {
        self.lines.is_some() || self.hides || self.cel.is_some()
    }

    /// The layers that are shown: the picture, its alpha, the terms and variables asked for.
    pub fn shown_layers(&self) -> Vec<LayerKind> {
        let mut kinds = vec![LayerKind::Picture, LayerKind::Alpha];
        kinds.extend(self.terms.iter().map(LayerKind::Term));
        kinds.extend((0..self.lights.unwrap_or(0)).map(LayerKind::Light));
        kinds.extend(self.lights.map(|_| LayerKind::Unlit));
        kinds.extend(self.aovs.iter().copied().map(LayerKind::Aov));
        kinds
    }

    /// Whether a tile is in the share asked for.
    pub fn has_tile(&self, tile: usize) -> bool {
        self.share.is_none_or(|(i, n)| tile as u64 % u64::from(n) == u64::from(i))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn options() -> RenderOptions {
        RenderOptions::new([40, 30]).unwrap()
    }

    #[test]
    fn a_side_has_from_one_pixel_to_the_largest_number() {
        for size in [[0, 5], [5, 0], [Image::LARGEST + 1, 1]] {
            assert_eq!(RenderOptions::new(size), Err(OptionsError::Size(size)));
        }
        assert!(RenderOptions::new([1, Image::LARGEST]).is_ok());
    }

    #[test]
    fn a_window_holds_a_pixel_and_lies_within() {
        for (x0, y0, x1, y1) in [(0, 0, 41, 30), (0, 0, 40, 31), (5, 5, 5, 9), (9, 5, 5, 9)] {
            let window = Window { x0, y0, x1, y1 };
            let error = OptionsError::Window { window, size: [40, 30] };
            assert_eq!(options().with_window(window), Err(error));
        }
    }

    #[test]
    fn a_share_is_one_of_so_many() {
        for (index, count) in [(2, 2), (0, 0), (7, 3)] {
            let error = OptionsError::Share { index, count };
            assert_eq!(options().with_share(index, count), Err(error));
        }
        assert_eq!(options().with_share(1, 2).unwrap().share(), Some((1, 2)));
    }

    #[test]
    fn samples_bounces_and_tiles_have_their_ranges() {
        for samples in [0, Image::MOST_SAMPLES + 1, u32::MAX] {
            assert_eq!(options().with_samples(samples), Err(OptionsError::Samples(samples)));
        }
        assert!(options().with_samples(Image::MOST_SAMPLES).is_ok());
        assert_eq!(options().with_depth(1025), Err(OptionsError::Depth(1025)));
        assert_eq!(options().with_tile(0), Err(OptionsError::Tile));
        assert_eq!(options().with_min_weight(1.5), Err(OptionsError::MinWeight(1.5)));
        assert!(options().with_min_weight(f32::NAN).is_err());
    }

    #[test]
    fn an_image_made_in_memory_is_held_to_the_same_ranges() {
        let image = Image { samples: 0, ..Image::default() };
        assert_eq!(RenderOptions::of(&image), Err(OptionsError::Samples(0)));
        let image = Image { depth: u32::MAX, ..Image::default() };
        assert_eq!(RenderOptions::of(&image), Err(OptionsError::Depth(u32::MAX)));
        assert!(RenderOptions::of(&Image::default()).is_ok());
    }

    #[test]
    fn an_error_says_what_was_asked_for_and_what_there_is() {
        let window = Window { x0: 1, y0: 2, x1: 50, y1: 30 };
        let error = options().with_window(window).unwrap_err().to_string();
        assert!(
            error.contains("(1, 2)") && error.contains("(50, 30)") && error.contains("40 × 30")
        );
        let error = options().with_samples(0).unwrap_err().to_string();
        assert_eq!(error, "0 samples a pixel: there are 1 to 1000000");
    }

    #[test]
    fn a_variable_named_twice_is_kept_once() {
        let options = options().with_aovs(&[Aov::Uv, Aov::Depth, Aov::Uv]);
        assert_eq!(options.aovs(), [Aov::Uv, Aov::Depth]);
    }
}
