//! A bar for whoever watches; nothing in a pipe.

use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use phong::render::Progress;

use crate::report;

/// Draws no oftener than this.
const PAUSE: Duration = Duration::from_millis(100);

/// How far the work is, on standard error.
#[derive(Debug)]
pub(crate) struct Meter {
    bar: ProgressBar,
    started: Instant,
    drawn: Mutex<Option<Instant>>,
}

impl Meter {
    /// A meter that shows a stage without end; hidden if `quiet` or if nobody watches.
    pub(crate) fn new(quiet: bool, stage: &'static str) -> Self {
        let hidden = quiet || !report::is_watched();
        let bar = if hidden { ProgressBar::hidden() } else { ProgressBar::new_spinner() };
        bar.set_message(stage);
        // The bar's own thread is one that must be there; without it the bar still moves.
        if !hidden && thread::Builder::new().spawn(|| {}).is_ok() {
            bar.enable_steady_tick(PAUSE);
        }
        Self { bar, started: Instant::now(), drawn: Mutex::new(None) }
    }

    /// The next stage without end.
    pub(crate) fn stage(&self, stage: &'static str) {
        self.bar.set_message(stage);
    }

    /// From now on samples are counted.
    pub(crate) fn samples(&mut self) {
        self.started = Instant::now();
        let style = ProgressStyle::with_template("{bar:32} {percent:>3}%  {msg}, {eta} left");
        if let Ok(style) = style {
            self.bar.set_style(style);
        }
        self.bar.reset();
    }

    /// One more tile is done; so many rays were traced before, for other pictures.
    pub(crate) fn update(&self, progress: Progress, before: u64) {
        if self.bar.is_hidden() {
            return;
        }
        let now = Instant::now();
        let mut drawn = self.drawn.lock().unwrap_or_else(PoisonError::into_inner);
        if drawn.is_some_and(|last| now - last < PAUSE) {
            return;
        }
        *drawn = Some(now);
        self.bar.set_length(progress.samples);
        self.bar.set_position(progress.samples_done);
        let seconds = self.started.elapsed().as_secs_f64();
        self.bar.set_message(rate(before + progress.rays.total(), seconds));
    }

    /// Leaves no trace.
    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

/// Rays per second for people.
pub(crate) fn rate(rays: u64, seconds: f64) -> String {
    format!("{} rays/s", short(rays as f64 / seconds.max(1e-9)))
}

/// A large number for people: three digits and a unit.
pub(crate) fn short(number: f64) -> String {
    let (value, unit) = match number {
        n if n >= 1e9 => (n / 1e9, " G"),
        n if n >= 1e6 => (n / 1e6, " M"),
        n if n >= 1e3 => (n / 1e3, " k"),
        n => return format!("{n:.0}"),
    };
    let decimals = match value {
        v if v < 9.995 => 2,
        v if v < 99.95 => 1,
        _ => 0,
    };
    format!("{value:.decimals$}{unit}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_numbers_keep_three_digits() {
        assert_eq!(short(999.0), "999");
        assert_eq!(short(1234.0), "1.23 k");
        assert_eq!(short(45_678_000.0), "45.7 M");
        assert_eq!(short(9.999e9), "10.0 G");
    }
}
