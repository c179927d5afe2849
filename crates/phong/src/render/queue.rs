//! Which tile is next, in which pass.

use std::collections::VecDeque;

use super::{Pass, RenderOptions};
use crate::film::Film;

/// A tile that is to have a pass.
#[derive(Clone, Copy, Debug)]
pub(super) struct Task {
    /// Index of the pass.
    pub(super) pass: usize,
    /// The tile's number.
    pub(super) tile: usize,
}

/// What is left to do. A tile stands in it at most once, and not while a thread works on it: so its
/// passes follow one another, whatever the threads do, and no thread waits for another.
#[derive(Debug)]
pub(super) struct Queue {
    next: VecDeque<Task>,
    /// Of each pass the tiles that have not yet had it.
    missing: Vec<usize>,
    abandoned: bool,
}

impl Queue {
    /// All that a film lacks: first what lacks most. Tiles follow one another as in the picture, so
    /// that neighbours in the picture are neighbours in time and the hierarchy stays warm.
    pub(super) fn new(film: &Film, options: &RenderOptions, passes: &[Pass]) -> Self {
        let mut missing = vec![0; passes.len()];
        let mut next: Vec<Task> = (0..film.tiles())
            .filter(|&tile| options.has_tile(tile) && !film.done[tile])
            .map(|tile| {
                let samples = film.samples_of(tile, options.samples());
                let begun = |pass: &&Pass| samples > 0 && pass.samples() <= samples;
                let pass = passes.iter().take_while(begun).count();
                missing[pass..].iter_mut().for_each(|missing| *missing += 1);
                Task { pass, tile }
            })
            .collect();
        next.sort_by_key(|task| (task.pass, task.tile));
        Self { next: next.into(), missing, abandoned: false }
    }

    /// Takes what is next. None: nothing is left, or other threads are at the rest.
    pub(super) fn take(&mut self) -> Option<Task> {
        self.next.pop_front()
    }

    /// A tile has had its pass; whether it was the last one of that pass.
    pub(super) fn done(&mut self, task: Task) -> bool {
        self.missing[task.pass] -= 1;
        self.missing[task.pass] == 0
    }

    /// Leaves all the rest undone.
    pub(super) fn abandon(&mut self) {
        self.abandoned = true;
        self.next.clear();
    }

    /// Puts the tile's next pass at the end, if there is one.
    pub(super) fn go_on(&mut self, task: Task) {
        if task.pass + 1 < self.missing.len() && !self.abandoned {
            self.next.push_back(Task { pass: task.pass + 1, ..task });
        }
    }
}
