//! What finishes a picture that is whole: lines around things, tone, and a figure's furniture, as `phong render`
//! finishes a file.

use std::borrow::Cow;

use phong::film::{Film, LayerKind};
use phong::finish::{Finishing, finish};
use phong::image::{Encoding, srgb8};
use phong::render::{Lines, RenderOptions};
use phong::scene::{Scene, Tone};
use phong::terms::{Term, TermSet};
use phong_lab::furniture;

use crate::protocol::{PixelKind, frame};

/// The least width of the lines of a first pass, in its own pixels: thinner ones are not seen.
const LEAST_WIDTH: f32 = 0.5;

/// The options of a first pass with the lines of the picture that it stands for, each of whose pixels is
/// `step` of it across.
pub(super) fn of_first_pass(options: RenderOptions, scene: &Scene, step: u8) -> RenderOptions {
    let lines = scene.outline.as_ref().map(|outline| {
        let whole = Lines::of(outline, &scene.image);
        Lines { width: (whole.width / f32::from(step)).max(LEAST_WIDTH), ..whole }
    });
    options.with_finishing_of(scene).with_lines(lines)
}

/// Where a picture is sent as one tile.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sent {
    /// The picture's number.
    pub(super) picture: u32,
    /// The pass that it is the picture of.
    pub(super) pass: u16,
    /// Pixels of the picture across each of the film.
    pub(super) step: u8,
    pub(super) pixels: PixelKind,
}

/// The finished picture of a film as one tile, without the terms that are left out. `furniture` is a scene of
/// what is drawn over it.
pub(super) fn whole(
    film: &Film,
    options: &RenderOptions,
    furniture: Option<&Scene>,
    off: TermSet,
    sent: Sent,
) -> Vec<u8> {
    let film = shown(film, off);
    let Sent { picture, pass, step, pixels } = sent;
    let [width, height] = options.size();
    let mut finishing = Finishing::of(options);
    if let Some(furniture) = furniture {
        let mut furniture = furniture.clone();
        let dpi = furniture.image.dpi.unwrap_or(furniture::DPI);
        furniture.image.dpi = Some(dpi / f64::from(step));
        finishing.patches = furniture::patches(&furniture, &film, [width, height]);
    }
    let finished = finish(&film, &finishing);
    let head = frame::Head { picture, pass, step, x: 0, y: 0, width, height };
    let mut bytes = head.bytes(pixels);
    match pixels {
        PixelKind::Srgb8 => bytes.extend(srgb8(&finished, &Encoding::default())),
        PixelKind::Linear => {
            let values = |kind| finished.values(kind).unwrap_or_default();
            let (colors, alphas) = (values(LayerKind::Picture), values(LayerKind::Alpha));
            let colors = if finishing.tone == Tone::default() {
                Cow::Borrowed(colors)
            } else {
                Cow::Owned(finished.tone().toned(colors, alphas))
            };
            for (color, alpha) in colors.as_chunks::<3>().0.iter().zip(alphas) {
                color.iter().chain([alpha]).for_each(|v| bytes.extend(v.to_le_bytes()));
            }
        }
    }
    bytes
}

/// The film whose picture lacks the terms that are left out.
fn shown(film: &Film, off: TermSet) -> Cow<'_, Film> {
    if off == TermSet::NONE {
        return Cow::Borrowed(film);
    }
    let mut shown = film.clone();
    let terms = Term::ALL.map(|term| film.layer(LayerKind::Term(term)).map(|layer| &*layer.values));
    for layer in &mut shown.layers {
        if layer.kind == LayerKind::Picture {
            let sum = without(&terms.map(Option::unwrap_or_default), off, layer.values.len());
            layer.values.copy_from_slice(&sum);
        }
    }
    Cow::Owned(shown)
}

/// The sum of the terms but for those that are left out: `len` values.
pub(super) fn without(terms: &[&[f32]], off: TermSet, len: usize) -> Vec<f32> {
    let mut sum = vec![0.0; len];
    for (_, values) in Term::ALL.iter().zip(terms).filter(|(term, _)| !off.has(**term)) {
        sum.iter_mut().zip(*values).for_each(|(sum, value)| *sum += value);
    }
    sum
}
