//! A picture in the making, which can be talked with.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use rayon::prelude::*;
use thiserror::Error;

use super::queue::{Queue, Task};
use super::tile::{TileBuffers, TileRenderer};
use super::{Cancel, Event, Pass, Progress, RenderOptions};
use crate::film::{Film, FilmTile, LayerKind};
use crate::integrator::{Integrator, RayCounts, SampleGrid, Shares};
use crate::view::View;

/// A picture in the making.
///
/// Any thread may look into it while [`run`](Self::run) is at work on others. Nothing in it is
/// global, and it renders in the rayon pool that `run` is called in.
#[derive(Debug)]
pub struct Rendering<'a> {
    scene: &'a View,
    options: &'a RenderOptions,
    passes: Vec<Pass>,
    state: Mutex<State>,
}

#[derive(Debug)]
struct State {
    film: Film,
    progress: Progress,
}

/// What came out of a rendering.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The film. [`resume`](super::resume) goes on with one that is not complete.
    pub film: Film,
    /// Whether every tile asked for has all its samples: false only where it was cancelled.
    pub complete: bool,
    /// Rays traced in this run.
    pub rays: RayCounts,
}

/// Why a film cannot be gone on with: the caller gave one of another picture.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
pub enum RenderError {
    /// It has another size, window, tile or other layers than the options.
    #[error("the film and the options differ in {0}")]
    Differ(&'static str),
    /// A tile has more samples than are asked for.
    #[error("tile {0} of the film has more samples than are asked for")]
    Samples(usize),
}

impl<'a> Rendering<'a> {
    /// A picture of which nothing is done.
    pub fn new(scene: &'a View, options: &'a RenderOptions) -> Self {
        let kinds = options.layers();
        let film = Film::new(options.size(), options.window(), options.tile(), &kinds);
        Self::of(scene, options, film)
    }

    /// A picture of which an earlier rendering of the same scene and options left this film.
    ///
    /// # Errors
    /// [`RenderError`] if it is of other options.
    pub fn resume(
        scene: &'a View,
        options: &'a RenderOptions,
        film: Film,
    ) -> Result<Self, RenderError> {
        let kinds: Vec<LayerKind> = film.layers.iter().map(|layer| layer.kind).collect();
        for (same, what) in [
            (film.size == options.size(), "size"),
            (film.window == options.window(), "window"),
            (film.tile == options.tile(), "tile size"),
            (kinds == options.layers(), "layers"),
            (film.is_sound(), "the number of their values"),
        ] {
            if !same {
                return Err(RenderError::Differ(what));
            }
        }
        let over = |tile: &usize| {
            !film.done[*tile] && film.samples_of(*tile, options.samples()) >= options.samples()
        };
        match (0..film.tiles()).find(over) {
            Some(tile) => Err(RenderError::Samples(tile)),
            None => Ok(Self::of(scene, options, film)),
        }
    }

    /// `film` is of these options.
    fn of(scene: &'a View, options: &'a RenderOptions, film: Film) -> Self {
        let mut progress = Progress::default();
        for tile in (0..film.tiles()).filter(|&tile| options.has_tile(tile)) {
            let (samples, pixels) = (options.samples(), film.tile_window(tile).pixels());
            progress.tiles += 1;
            progress.tiles_done += usize::from(film.done[tile]);
            progress.samples += pixels * u64::from(samples);
            progress.samples_done += pixels * u64::from(film.samples_of(tile, samples));
        }
        let state = Mutex::new(State { film, progress });
        Self { scene, options, passes: options.passes().of(options.samples()), state }
    }

    /// Renders until all is done or `cancel` is used, and tells `listen` what happens. It can be
    /// called again after a cancel, with another one.
    ///
    /// A panic of `listen` ends the rendering and is passed on once all threads have stopped; what
    /// was rendered until then is kept.
    pub fn run(&self, listen: &(dyn Fn(Event<'_>) + Sync), cancel: &Cancel) {
        let integrator = Integrator {
            scene: self.scene,
            depth: self.options.depth(),
            min_weight: self.options.min_weight(),
            shadows: self.options.shadows(),
            terminator: self.options.terminator(),
            grid: SampleGrid { size: self.options.size(), samples: self.options.samples() },
            shares: Shares::NONE,
            stop: Some(cancel.flag()),
        };
        let renderer = TileRenderer::new(integrator, self.options, cancel);
        let queue = Mutex::new(Queue::new(&self.state().film, self.options, &self.passes));
        // One job a thread that takes tiles in order, so that no thread idles while tiles are left.
        let threads = (0..rayon::current_num_threads()).into_par_iter().with_max_len(1);
        threads.for_each(|_| {
            let _abandon = AbandonOnPanic(&queue);
            let mut buffers = TileBuffers::default();
            while !cancel.is_cancelled() {
                let Some(task) = unpoisoned(&queue).take() else { break };
                if !self.tile(task, &renderer, &queue, &mut buffers, listen) {
                    break;
                }
            }
        });
    }

    /// Gives a tile its pass; false where it was cancelled in the middle, and then the tile is as it
    /// was. No lock is held while anything is told.
    fn tile(
        &self,
        task: Task,
        renderer: &TileRenderer<'_>,
        queue: &Mutex<Queue>,
        buffers: &mut TileBuffers,
        listen: &(dyn Fn(Event<'_>) + Sync),
    ) -> bool {
        let Task { pass: number, tile } = task;
        let (pass, window) = (self.passes[number], self.options.window());
        let window = window.tile(self.options.tile(), tile);
        let earlier = self.state().film.sums(tile).cloned();
        let begun = earlier.as_ref().map_or(0, |sums| sums.samples());
        let mut rays = RayCounts::default();
        let Ok(sums) = renderer.render(window, pass, earlier.as_deref(), buffers, &mut rays) else {
            return false;
        };
        let last = pass.samples() == self.options.samples();
        {
            let State { film, progress } = &mut *self.state();
            if earlier.is_some() {
                film.take_variables(tile, buffers.values_mut());
            }
            if last {
                film.put(tile, buffers.values());
            } else {
                film.put_unfinished(tile, buffers.values(), sums.map(Arc::new));
            }
            progress.tiles_done += usize::from(last);
            let drawn = pass.samples().saturating_sub(begun);
            progress.samples_done += window.pixels() * u64::from(drawn);
            progress.rays.add(&rays);
        }
        let pass_number = number as u32;
        listen(Event::Tile { pass: pass_number, index: tile, window, values: buffers.values() });
        let pass_done = unpoisoned(queue).done(task);
        listen(Event::Progress(self.progress()));
        if pass_done {
            let (passes, samples) = (self.passes.len() as u32, pass.samples());
            listen(Event::Pass { pass: pass_number, passes, samples });
        }
        // Only now may another thread take this tile further: its events stay in order.
        unpoisoned(queue).go_on(task);
        true
    }

    /// How far it is.
    pub fn progress(&self) -> Progress {
        self.state().progress
    }

    /// Tiles in the window, whatever is done of them.
    pub fn tiles(&self) -> usize {
        self.state().film.tiles()
    }

    /// What there is of a tile now; `None` if it has no sample of every pixel yet.
    pub fn film_tile(&self, index: usize) -> Option<FilmTile> {
        self.state().film.film_tile(index)
    }

    /// The film as it is now, copied.
    pub fn film(&self) -> Film {
        self.state().film.clone()
    }

    /// What came out.
    pub fn finish(self) -> Outcome {
        let state = self.state.into_inner();
        let State { film, progress } = state.unwrap_or_else(PoisonError::into_inner);
        Outcome { film, complete: progress.tiles_done == progress.tiles, rays: progress.rays }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        unpoisoned(&self.state)
    }
}

/// Nothing that can panic on input is done under these locks, so what they guard is whole.
fn unpoisoned<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Where one thread panics, in a listener, the others need not go on.
struct AbandonOnPanic<'a>(&'a Mutex<Queue>);

impl Drop for AbandonOnPanic<'_> {
    fn drop(&mut self) {
        if std::thread::panicking() {
            unpoisoned(self.0).abandon();
        }
    }
}
