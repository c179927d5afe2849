//! What a rendering says while it is under way.

use crate::film::Window;
use crate::integrator::RayCounts;

/// Something has happened. Events are told by the thread that they happened on and outside any
/// lock: a slow listener holds up that one thread and its tile, and nobody else.
///
/// Of one tile the events come in the order of its passes, and a pass is done when all events of
/// its tiles have been heard.
#[derive(Clone, Copy, Debug)]
pub enum Event<'a> {
    /// A tile has new values.
    Tile {
        /// The pass, from 0.
        pass: u32,
        /// The tile's number, row by row over the window.
        index: usize,
        /// Its pixels.
        window: Window,
        /// For each layer of the film, in order, the tile's own rows, as [`Film::put`] takes them.
        ///
        /// [`Film::put`]: crate::film::Film::put
        values: &'a [Vec<f32>],
    },
    /// A pass is done: every tile asked for has had it.
    Pass {
        /// The pass, from 0.
        pass: u32,
        /// How many there are.
        passes: u32,
        /// Samples that each pixel now has; 0 after the coarse one.
        samples: u32,
    },
    /// How far it all is; told after every tile.
    Progress(Progress),
}

/// How far a rendering is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Progress {
    /// Tiles that have all their samples, those of an earlier run included.
    pub tiles_done: usize,
    /// Tiles asked for.
    pub tiles: usize,
    /// Samples drawn of pixels, those of an earlier run included.
    pub samples_done: u64,
    /// Samples of pixels asked for.
    pub samples: u64,
    /// Rays traced in this run.
    pub rays: RayCounts,
}
