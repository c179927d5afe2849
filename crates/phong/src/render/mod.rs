//! A whole picture: tiles of rays, in any order, on any number of threads, to the same bits.
//!
//! [`render`] is for whoever wants a picture. A [`Rendering`] is for whoever wants to talk with it
//! meanwhile: it goes in passes from coarse to fine, tells what happens, can be looked into from
//! other threads, and is stopped and gone on with at any time.

mod cancel;
mod draw;
mod event;
mod lines;
mod options;
mod passes;
mod queue;
mod rendering;
mod tile;

pub(crate) use draw::{Drawn, camera_ray};
pub(crate) use lines::SMOOTHINGS;

pub use crate::integrator::RayCounts;
pub use cancel::Cancel;
pub use event::{Event, Progress};
pub use lines::Lines;
pub use options::{OptionsError, RenderOptions};
pub use passes::{Pass, Passes};
pub use rendering::{Outcome, RenderError, Rendering};

use thiserror::Error;

use crate::film::Film;
use crate::view::View;

/// The work was asked to stop: nobody's fault.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
#[error("cancelled")]
pub struct Cancelled;

/// Renders in the current rayon pool, or in its global one where there is none.
///
/// What comes out is whole unless `cancel` was used: see [`Outcome::complete`].
pub fn render(
    scene: &View,
    options: &RenderOptions,
    listen: &(dyn Fn(Event<'_>) + Sync),
    cancel: &Cancel,
) -> Outcome {
    let rendering = Rendering::new(scene, options);
    rendering.run(listen, cancel);
    rendering.finish()
}

/// Goes on with a film of the same scene and options, which an earlier rendering left unfinished.
///
/// # Errors
/// [`RenderError`] if the film is of other options.
pub fn resume(
    scene: &View,
    options: &RenderOptions,
    film: Film,
    listen: &(dyn Fn(Event<'_>) + Sync),
    cancel: &Cancel,
) -> Result<Outcome, RenderError> {
    let rendering = Rendering::resume(scene, options, film)?;
    rendering.run(listen, cancel);
    Ok(rendering.finish())
}
