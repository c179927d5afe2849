//! A picture under way: first at an eighth of its size, then all of it in 1, 2, 4, … samples a pixel.

use std::borrow::Cow;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

use phong::explain::Explanation;
use phong::film::{Film, Window};
use phong::finish::{Finishing, Patch, ToneMap, finish};
use phong::part::furniture_of;
use phong::render::{Cancel, Event, OptionsError, Passes, RenderOptions, Rendering, render};
use phong::scene::{Exposure, Scene, Tone};
use phong::terms::TermSet;
use phong::view::View;
use phong_lab::furniture::over_pixel;

use super::finishing::{self, Sent};
use super::{Emit, Stage, say};
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
    /// Whether something is drawn onto the picture when a pass is whole.
    draws: bool,
    /// A scene of the furniture that is; `None`: there is none.
    furniture: Option<Box<Scene>>,
    /// What there is so far; `None`: nothing.
    film: Option<Film>,
    /// What automatic exposure makes of that film; empty: nobody asked yet.
    exposed: OnceLock<ToneMap>,
    /// Whether a pass after the first is whole.
    refined: bool,
    done: bool,
}

impl Painting {
    /// The picture of this number, of which nothing is drawn yet; of a share, all but the first pass.
    pub(super) fn new(
        number: u32,
        view: View,
        scene: &Scene,
        off: TermSet,
        most: u64,
        share: Option<(u32, u32)>,
    ) -> Result<Self, String> {
        let said = |error: OptionsError| error.to_string();
        // Terms are kept apart only where one of them is left out.
        let terms = if off == TermSet::NONE { TermSet::NONE } else { TermSet::ALL };
        let image = &scene.image;
        let bare = RenderOptions::of(image).map_err(said)?.with_terms(terms);
        let whole = bare.clone().with_finishing_of(scene);
        let furniture = furniture_of(scene).map(Box::new);
        let draws = Finishing::of(&whole).draws() || furniture.is_some();
        let mut options = whole.with_passes(Passes::Doubling);
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
        let preview = bare.with_size(small).map_err(said)?.with_samples(1).map_err(said)?;
        let mut preview = Some(finishing::of_first_pass(preview, scene, STEP));
        if let Some((index, count)) = share {
            options = options.with_share(index, count).map_err(said)?;
            preview = preview.filter(|_| index == 0);
        }
        let (film, exposed) = (None, OnceLock::new());
        let (refined, done) = (false, false);
        Ok(Self {
            number,
            view,
            options,
            preview,
            off,
            draws,
            furniture,
            film,
            exposed,
            refined,
            done,
        })
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

    /// Whether something is drawn onto the picture when a pass is whole.
    pub(super) fn draws(&self) -> bool {
        self.draws
    }

    pub(super) fn is_done(&self) -> bool {
        self.done
    }

    /// How much of it was shown.
    pub(super) fn stage(&self) -> Stage {
        match (&self.preview, self.refined) {
            (Some(_), _) => Stage::Begun,
            (None, false) => Stage::Coarse,
            (None, true) => Stage::Fine,
        }
    }

    /// What there is so far.
    pub(super) fn film(&self) -> Option<&Film> {
        self.film.as_ref()
    }

    /// The film, for who puts something into it.
    pub(super) fn film_mut(&mut self) -> Option<&mut Film> {
        self.exposed.take();
        self.film.as_mut()
    }

    /// The film, if all of it is done.
    pub(super) fn finished(&self) -> Option<&Film> {
        self.film.as_ref().filter(|film| self.done && film.is_complete())
    }

    /// The finished picture as one tile, and its last pass; nothing if it is not all there.
    pub(super) fn say_finished(&self, pixels: PixelKind, emit: Emit<'_>) {
        let Some(film) = self.finished() else { return };
        let (picture, samples) = (self.number, self.options.samples());
        let passes = self.passes();
        let sent = Sent { picture, pass: passes as u16 - 1, step: 1, pixels };
        emit(Message::Frame(finishing::whole(
            film,
            &self.options,
            self.furniture.as_deref(),
            self.off,
            sent,
        )));
        say(emit, &Reply::Pass { picture, pass: passes - 1, passes, samples });
    }

    /// How the light of the picture becomes what is seen of it; exposed by what there is of it.
    fn tone(&self) -> ToneMap {
        let tone = self.options.tone();
        match self.film.as_ref().filter(|film| film.is_complete()) {
            Some(film) if tone.exposure == Exposure::Auto => {
                *self.exposed.get_or_init(|| *finish(film, &Finishing::of(&self.options)).tone())
            }
            _ => ToneMap::new(&tone, &[], None),
        }
    }

    /// Tells how a pixel's light becomes what is seen of it, beneath furniture. `view` and `options` are those that
    /// it was explained with: steps of luminance and lines are found by its neighbours, as few samples of them as of
    /// itself, but where the picture exposes itself, by what there is of that.
    pub(super) fn finish_told(
        &self,
        told: &mut Explanation,
        view: &View,
        options: &RenderOptions,
    ) -> Result<(), OptionsError> {
        let exposes_itself = options.tone().exposure == Exposure::Auto;
        let film = self.film.as_ref().filter(|film| film.is_complete());
        let is_drawn_onto = options.cel().is_some() || options.lines().is_some();
        if !is_drawn_onto || exposes_itself && film.is_none() {
            told.tone = self.tone();
        } else if let (true, Some(film)) = (exposes_itself, film) {
            told.finish_as(&finish(film, &Finishing::of(&self.options)));
        } else {
            let options = options.clone().with_terms(TermSet::NONE);
            let options = options.with_window(Window::pixel(told.pixel))?;
            let options = options.with_passes(Passes::One).with_share(0, 1)?;
            let film = render(view, &options, &|_| {}, &Cancel::new()).film;
            told.finish_as(&finish(&film, &Finishing::of(&options)));
        }
        Ok(())
    }

    /// What of the furniture lies over a pixel of it.
    pub(super) fn furniture_over(&self, pixel: [u32; 2]) -> Vec<Patch> {
        let over = |furniture: &Scene| {
            over_pixel(furniture, &self.view, &self.options, pixel, &Cancel::new())
        };
        self.furniture.as_deref().map(over).unwrap_or_default()
    }

    /// How many passes there are, with the first.
    fn passes(&self) -> u32 {
        1 + self.options.passes().of(self.options.samples()).len() as u32
    }

    /// Draws on.
    pub(super) fn advance(
        &mut self,
        pixels: PixelKind,
        cancel: &Cancel,
        emit: Emit<'_>,
    ) -> Result<(), String> {
        let passes = self.passes();
        self.exposed.take();
        let Self { number, view, options, off, furniture, .. } = self;
        let furniture = furniture.as_deref();
        let (picture, off) = (*number, *off);
        // What is drawn onto a picture needs all of it. Of a share, who puts it to the others has that.
        let draws = self.draws && options.share().is_none();
        let toned = options.tone() != Tone::default();
        // A tile has its tone at once, but for an exposure that needs all of the picture.
        let waits = toned && (draws || options.tone().exposure == Exposure::Auto);
        let tone = toned.then(|| ToneMap::new(&options.tone(), &[], None));
        let whole = |film: &Film, options: &RenderOptions, pass: u32, step| {
            let sent = Sent { picture, pass: pass as u16, step, pixels };
            emit(Message::Frame(finishing::whole(film, options, furniture, off, sent)));
        };
        let tile = |pass: u32, window: Window, values: &[Vec<f32>]| {
            let [colors, alphas, terms @ ..] = values else { return true };
            let sum = (off != TermSet::NONE).then(|| {
                let terms: Vec<&[f32]> = terms.iter().map(|values| &**values).collect();
                finishing::without(&terms, off, colors.len())
            });
            let colors = sum.as_deref().unwrap_or(colors);
            let colors = match &tone {
                Some(tone) => Cow::Owned(tone.toned(colors, alphas)),
                None => Cow::Borrowed(colors),
            };
            let frame = TileFrame {
                picture,
                pass: pass as u16 + 1,
                step: 1,
                x: window.x0,
                y: window.y0,
                width: window.width(),
                height: window.height(),
                colors: &colors,
                alphas,
            };
            emit(Message::Frame(frame.bytes(pixels)))
        };
        if let Some(preview) = &self.preview {
            // Small, and whole or not at all: it is what is seen while something is dragged.
            let drawn = render(view, preview, &|_| {}, cancel);
            if drawn.complete {
                whole(&drawn.film, preview, 0, STEP);
                say(emit, &Reply::Pass { picture, pass: 0, passes, samples: 0 });
                self.preview = None;
            }
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
        let refined = AtomicBool::new(false);
        let listen = |event: Event<'_>| {
            let goes_on = match event {
                // Nothing that was drawn onto the pass before goes away until this one is whole, and no
                // light is shown without its tone.
                Event::Tile { pass, .. } if waits || draws && pass > 0 => emit(Message::Nothing),
                Event::Tile { pass, window, values, .. } => tile(pass, window, values),
                Event::Pass { pass, samples, .. } => {
                    if draws {
                        whole(&rendering.film(), options, pass + 1, 1);
                    }
                    say(emit, &Reply::Pass { picture, pass: pass + 1, passes, samples });
                    refined.store(true, Ordering::Relaxed);
                    true
                }
                Event::Progress(_) => true,
            };
            if !goes_on {
                cancel.cancel();
            }
        };
        rendering.run(&listen, cancel);
        let outcome = rendering.finish();
        self.refined |= refined.into_inner();
        self.done = outcome.complete;
        self.film = Some(outcome.film);
        Ok(())
    }
}
