//! A picture under way: first at an eighth of its size, then all of it in 1, 2, 4, … samples a pixel.

use std::borrow::Cow;

use phong::film::Film;
use phong::render::{Cancel, Event, Passes, RenderOptions, Rendering, render};
use phong::scene::Image;
use phong::terms::{Term, TermSet};
use phong::view::View;

use super::{Emit, say};
use crate::protocol::{Message, PixelKind, Reply, TileFrame};

/// How many pixels of the picture, across and down, one of the first pass stands for.
const STEP: u8 = 8;

/// A picture under way.
#[derive(Debug)]
pub(super) struct Painting {
    number: u32,
    view: View,
    options: RenderOptions,
    /// How the first pass is drawn; `None`: it is done.
    preview: Option<RenderOptions>,
    /// The terms that are left out of what is shown.
    off: TermSet,
    /// What there is so far; `None`: nothing.
    film: Option<Film>,
    done: bool,
}

impl Painting {
    /// The picture of this number, of which nothing is drawn yet; of a share, all but the first pass.
    pub(super) fn new(
        number: u32,
        view: View,
        image: &Image,
        off: TermSet,
        most: u64,
        share: Option<(u32, u32)>,
    ) -> Result<Self, String> {
        let said = |error: phong::render::OptionsError| error.to_string();
        // Terms are kept apart only where one of them is left out.
        let terms = if off == TermSet::NONE { TermSet::NONE } else { TermSet::ALL };
        let whole = RenderOptions::of(image).map_err(said)?.with_terms(terms);
        let mut options = whole.clone().with_passes(Passes::Doubling);
        if options.film_bytes() > most {
            options = options.with_passes(Passes::One);
        }
        let needed = options.film_bytes();
        if needed > most {
            let [width, height] = image.size;
            return Err(format!(
                "a picture of {width} × {height} needs {needed} bytes of memory, and {most} are \
                 allowed: make `image.size` smaller"
            ));
        }
        let small = image.size.map(|side| side.div_ceil(u32::from(STEP)));
        let preview = whole.with_size(small).map_err(said)?;
        let mut preview = Some(preview.with_samples(1).map_err(said)?);
        if let Some((index, count)) = share {
            options = options.with_share(index, count).map_err(said)?;
            preview = preview.filter(|_| index == 0);
        }
        Ok(Self { number, view, options, preview, off, film: None, done: false })
    }

    pub(super) fn number(&self) -> u32 {
        self.number
    }

    pub(super) fn view(&self) -> &View {
        &self.view
    }

    pub(super) fn options(&self) -> &RenderOptions {
        &self.options
    }

    pub(super) fn is_done(&self) -> bool {
        self.done
    }

    /// What there is so far.
    pub(super) fn film(&self) -> Option<&Film> {
        self.film.as_ref()
    }

    pub(super) fn film_mut(&mut self) -> Option<&mut Film> {
        self.film.as_mut()
    }

    /// The film, if all of it is done.
    pub(super) fn finished(&self) -> Option<&Film> {
        self.film.as_ref().filter(|film| self.done && film.is_complete())
    }

    /// Draws on.
    pub(super) fn advance(
        &mut self,
        pixels: PixelKind,
        cancel: &Cancel,
        emit: Emit<'_>,
    ) -> Result<(), String> {
        let Self { number, view, options, off, .. } = self;
        let (picture, off) = (*number, *off);
        let passes = 1 + options.passes().of(options.samples()).len() as u32;
        let tile = |event: Event<'_>, step, first: u32| match event {
            Event::Tile { pass, window, values, .. } => {
                let [colors, alphas, terms @ ..] = values else { return true };
                let colors = &*without(colors, terms, off);
                let frame = TileFrame {
                    picture,
                    pass: (pass + first) as u16,
                    step,
                    x: window.x0,
                    y: window.y0,
                    width: window.width(),
                    height: window.height(),
                    colors,
                    alphas,
                };
                emit(Message::Frame(frame.bytes(pixels)))
            }
            Event::Pass { pass, samples, .. } => {
                let samples = if first == 0 { 0 } else { samples };
                say(emit, &Reply::Pass { picture, pass: pass + first, passes, samples });
                true
            }
            Event::Progress(_) => true,
        };
        if let Some(preview) = &self.preview {
            // Small, and whole or not at all: it is what is seen while something is dragged.
            let listen = |event: Event<'_>| {
                tile(event, STEP, 0);
            };
            if !render(view, preview, &listen, cancel).complete {
                return Ok(());
            }
            self.preview = None;
            return Ok(());
        }
        let rendering = match self.film.take() {
            Some(film) => Rendering::resume(view, options, film),
            None => Ok(Rendering::new(view, options)),
        };
        let rendering = rendering.map_err(|error| error.to_string())?;
        if rendering.progress().tiles == 0 {
            // A share of a picture that has fewer tiles than there are shares.
            for (pass, drawn) in (1..).zip(options.passes().of(options.samples())) {
                say(emit, &Reply::Pass { picture, pass, passes, samples: drawn.samples() });
            }
        }
        let listen = |event: Event<'_>| {
            if !tile(event, 1, 1) {
                cancel.cancel();
            }
        };
        rendering.run(&listen, cancel);
        let outcome = rendering.finish();
        self.done = outcome.complete;
        self.film = Some(outcome.film);
        Ok(())
    }
}

/// The sum of the terms but for those that are left out; `terms` are all, or none are kept apart.
fn without<'a>(colors: &'a [f32], terms: &[Vec<f32>], off: TermSet) -> Cow<'a, [f32]> {
    if off == TermSet::NONE {
        return Cow::Borrowed(colors);
    }
    let mut sum = vec![0.0; colors.len()];
    for (_, values) in Term::ALL.iter().zip(terms).filter(|(term, _)| !off.has(**term)) {
        sum.iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
    }
    Cow::Owned(sum)
}
