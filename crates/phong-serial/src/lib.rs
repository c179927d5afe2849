//! The part of rayon's interface that phong uses, on one thread.
//!
//! A WebAssembly module of phong has no threads: rayon would do there one thing after another as well, with
//! a quarter of a megabyte of code to decide how. The crates that use rayon depend on this one for `wasm32`, and
//! their first lines give it rayon's name; the rest of their code says nothing of it:
//!
//! ```ignore
//! #[cfg(target_arch = "wasm32")]
//! extern crate serial as rayon;
//! ```
//!
//! Each function has the name, the arguments and the result of rayon's, and works in the order of the items.

mod iter;
mod slice;

pub use iter::{IntoParallelIterator, IntoParallelRefIterator, IntoParallelRefMutIterator, Serial};
pub use slice::{ParallelSlice, ParallelSliceMut};

/// What `rayon::prelude` has.
pub mod prelude {
    pub use crate::iter::{
        IntoParallelIterator, IntoParallelRefIterator, IntoParallelRefMutIterator,
    };
    pub use crate::slice::{ParallelSlice, ParallelSliceMut};
}

/// Does the one, then the other.
pub fn join<A, B>(a: impl FnOnce() -> A, b: impl FnOnce() -> B) -> (A, B) {
    (a(), b())
}

/// One: this one.
pub fn current_num_threads() -> usize {
    1
}
