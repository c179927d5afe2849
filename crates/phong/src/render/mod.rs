//! A whole picture: tiles of rays, in any order, on any number of threads, to the same bits.

mod draw;
mod sums;
mod tile;

pub use draw::{Drawn, camera_ray};
pub(crate) use sums::Sums8;

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

use phong_scene::{Background, FilterKind, Image};
use rayon::prelude::*;
use thiserror::Error;

use crate::aov::Aov;
use crate::film::{Film, LayerKind, Window};
use crate::integrator::{Integrator, RayCounts};
use crate::terms::TermSet;
use crate::view::View;

/// What to render.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderOptions {
    /// Width and height of the full picture, pixels, each ≥ 1.
    pub size: [u32; 2],
    /// The part of it to render.
    pub window: Window,
    /// `(i, n)`: only every nth tile of the window, from the ith on; `i < n`. `None`: all.
    pub share: Option<(u32, u32)>,
    /// Samples a pixel, ≥ 1.
    pub samples: u32,
    /// Seed of the sampling pattern.
    pub seed: u64,
    /// Mirror and glass bounces.
    pub depth: u32,
    /// Whether things stand in the way of lights at all.
    pub shadows: bool,
    /// How samples are weighted into a pixel.
    pub filter: FilterKind,
    /// What rays see that hit nothing.
    pub background: Background,
    /// Edge of a tile in pixels, ≥ 1; changes no bit of the picture.
    pub tile: u32,
    /// Which terms to keep a layer for.
    pub terms: TermSet,
    /// Which other variables to keep.
    pub aovs: Vec<Aov>,
}

impl RenderOptions {
    /// The tile size used unless another is asked for: a few hundred rays are a good bundle.
    pub const TILE: u32 = 16;

    /// All of a picture as its scene has it.
    pub fn of(image: &Image) -> Self {
        Self {
            size: image.size,
            window: Window::full(image.size),
            share: None,
            samples: image.samples,
            seed: image.seed,
            depth: image.depth,
            shadows: true,
            filter: image.filter,
            background: image.background,
            tile: Self::TILE,
            terms: TermSet::NONE,
            aovs: Vec::new(),
        }
    }

    /// The layers of the film: the picture, its alpha, the terms and variables asked for.
    pub fn layers(&self) -> Vec<LayerKind> {
        let mut kinds = vec![LayerKind::Picture, LayerKind::Alpha];
        kinds.extend(self.terms.iter().map(LayerKind::Term));
        kinds.extend(self.aovs.iter().copied().map(LayerKind::Aov));
        kinds
    }

    /// Whether a tile is in the share asked for.
    pub fn has_tile(&self, tile: usize) -> bool {
        self.share.is_none_or(|(i, n)| tile as u64 % u64::from(n) == u64::from(i))
    }
}

/// How far a rendering is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Progress {
    /// Tiles rendered, those of an earlier run included.
    pub tiles_done: usize,
    /// Tiles wanted.
    pub tiles: usize,
    /// Rays traced in this run.
    pub rays: RayCounts,
}

/// What came out.
#[derive(Clone, Debug)]
pub struct Rendered {
    /// The film, with every tile asked for.
    pub film: Film,
    /// Rays traced in this run.
    pub rays: RayCounts,
}

/// A way to stop a rendering from another thread.
#[derive(Debug, Default)]
pub struct Cancel(AtomicBool);

impl Cancel {
    /// Not cancelled.
    pub const fn new() -> Self {
        Self(AtomicBool::new(false))
    }

    /// Asks every rendering that looks at this to stop at the next tile.
    pub fn cancel(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether it was asked to stop.
    pub fn is_cancelled(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// The rendering was asked to stop: nobody's fault.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
#[error("cancelled")]
pub struct Cancelled;

/// Renders in the current rayon pool. `watch` is called after every tile, by one thread at a time.
///
/// # Errors
/// [`Cancelled`].
///
/// # Panics
/// If the options are not what their documentation asks for.
pub fn render(
    scene: &View,
    options: &RenderOptions,
    watch: &(dyn Fn(&Film, Progress) + Sync),
    cancel: &Cancel,
) -> Result<Rendered, Cancelled> {
    let film = Film::new(options.size, options.window, options.tile, &options.layers());
    resume(scene, options, film, watch, cancel)
}

/// Goes on with a film of the same options: renders the tiles it lacks.
///
/// # Errors
/// [`Cancelled`].
///
/// # Panics
/// If the options are not what their documentation asks for, or the film is of other ones.
pub fn resume(
    scene: &View,
    options: &RenderOptions,
    film: Film,
    watch: &(dyn Fn(&Film, Progress) + Sync),
    cancel: &Cancel,
) -> Result<Rendered, Cancelled> {
    assert!(options.samples > 0 && options.tile > 0 && options.window.fits(options.size));
    assert!(options.share.is_none_or(|(i, n)| i < n));
    assert_eq!((film.size, film.window, film.tile), (options.size, options.window, options.tile));
    let integrator = Integrator {
        scene,
        background: options.background,
        depth: options.depth,
        shadows: options.shadows,
    };
    let painter = tile::Painter::new(integrator, options);
    let wanted: Vec<usize> = (0..film.tiles()).filter(|&tile| options.has_tile(tile)).collect();
    let missing: Vec<usize> = wanted.iter().copied().filter(|&tile| !film.done[tile]).collect();
    let earlier = wanted.len() - missing.len();
    let shared = Mutex::new((
        film,
        Progress { tiles: wanted.len(), tiles_done: earlier, ..Progress::default() },
    ));
    let next = AtomicU64::new(0);
    // One job a thread that takes tiles in order: neighbours in the picture are neighbours in
    // time, so the hierarchy stays warm, and no thread idles while tiles are left.
    (0..rayon::current_num_threads()).into_par_iter().with_max_len(1).try_for_each(|_| {
        let mut desk = tile::Desk::default();
        loop {
            let Some(&tile) = missing.get(next.fetch_add(1, Ordering::Relaxed) as usize) else {
                return Ok(());
            };
            if cancel.is_cancelled() {
                return Err(Cancelled);
            }
            let mut rays = RayCounts::default();
            let window = options.window.tile(options.tile, tile);
            painter.paint(window, &mut desk, &mut rays, cancel)?;
            let mut shared = shared.lock().unwrap_or_else(PoisonError::into_inner);
            let (film, progress) = &mut *shared;
            film.put(tile, desk.values());
            progress.tiles_done += 1;
            progress.rays.add(&rays);
            watch(film, *progress);
        }
    })?;
    let (film, progress) = shared.into_inner().unwrap_or_else(PoisonError::into_inner);
    Ok(Rendered { film, rays: progress.rays })
}
