//! Slices with the methods of those that several threads work on.

use std::slice::{Chunks, ChunksExactMut, ChunksMut};

use crate::iter::Serial;

/// Slices that are read piece by piece.
pub trait ParallelSlice<T> {
    /// [`slice::chunks`].
    fn par_chunks(&self, size: usize) -> Serial<Chunks<'_, T>>;
}

impl<T> ParallelSlice<T> for [T] {
    fn par_chunks(&self, size: usize) -> Serial<Chunks<'_, T>> {
        Serial(self.chunks(size))
    }
}

/// Slices that are changed.
pub trait ParallelSliceMut<T> {
    /// [`slice::chunks_mut`].
    fn par_chunks_mut(&mut self, size: usize) -> Serial<ChunksMut<'_, T>>;

    /// [`slice::chunks_exact_mut`].
    fn par_chunks_exact_mut(&mut self, size: usize) -> Serial<ChunksExactMut<'_, T>>;

    /// [`slice::sort_unstable`].
    fn par_sort_unstable(&mut self)
    where
        T: Ord;
}

impl<T> ParallelSliceMut<T> for [T] {
    fn par_chunks_mut(&mut self, size: usize) -> Serial<ChunksMut<'_, T>> {
        Serial(self.chunks_mut(size))
    }

    fn par_chunks_exact_mut(&mut self, size: usize) -> Serial<ChunksExactMut<'_, T>> {
        Serial(self.chunks_exact_mut(size))
    }

    fn par_sort_unstable(&mut self)
    where
        T: Ord,
    {
        self.sort_unstable();
    }
}
