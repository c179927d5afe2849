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

#[cfg(test)]
mod tests {
    /// Does the same with both, and compares.
    macro_rules! alike {
        ($($name:ident: $what:expr;)*) => {$(
            #[test]
            fn $name() {
                let serial = {
                    use crate::prelude::*;
                    $what
                };
                let parallel = {
                    use rayon::prelude::*;
                    $what
                };
                assert_eq!(serial, parallel);
            }
        )*};
    }

    alike! {
        ranges_are_mapped_and_filtered_in_order: (0..1000)
            .into_par_iter()
            .with_min_len(16)
            .with_max_len(64)
            .filter(|n| n % 3 == 0)
            .map(|n| n * n)
            .filter_map(|n| (n % 2 == 0).then_some(n))
            .flat_map_iter(|n| [n, n + 1])
            .collect::<Vec<u32>>();
        the_first_error_is_the_result_where_there_is_one: (0..100)
            .into_par_iter()
            .map(|n| if n == 50 { Err(n) } else { Ok(n) })
            .collect::<Result<Vec<i32>, i32>>();
        all_is_folded_and_reduced: (
            [3, 9, 4].par_iter().fold(|| 0, |most: i32, n| most.max(*n)).reduce(|| 0, i32::max),
            [3, 9, 4].par_iter().map(|n| n + 1).reduce(|| 0, |a, b| a + b),
            Vec::<i32>::new().into_par_iter().reduce_with(|a, b| a + b),
            [5, 6].into_par_iter().reduce_with(|a, b| a + b),
            [1, 2, 3].par_iter().sum::<i32>(),
            [1, 2, 3].par_iter().filter(|n| **n > 1).count(),
        );
        questions_are_answered: (
            [1, 2, 3].par_iter().all(|n| *n > 0),
            [1, 2, 3].par_iter().any(|n| *n > 3),
            Vec::<i32>::new().par_iter().all(|n| *n > 0),
        );
        items_are_changed_beside_others: {
            let mut to = vec![1, 2, 3];
            to.par_iter_mut().zip([10, 20, 30].par_iter()).for_each(|(to, from)| *to += from);
            to.par_iter_mut().enumerate().for_each(|(i, to)| *to *= i + 1);
            to
        };
        something_is_at_hand_for_each: (0..5)
            .into_par_iter()
            .map_init(String::new, |text, n| {
                text.clear();
                text.push_str(&n.to_string());
                text.clone()
            })
            .collect::<Vec<String>>();
        slices_are_cut_and_sorted: {
            let mut all: Vec<u32> = (0..100_u32).map(|n| n.wrapping_mul(2_654_435_761) >> 16).collect();
            let sums: Vec<u32> = all.par_chunks(7).map(|part| part.iter().sum()).collect();
            all.par_chunks_mut(9).for_each(<[u32]>::reverse);
            all.par_chunks_exact_mut(30).enumerate().for_each(|(i, part)| part[0] = i as u32);
            let cut = all.clone();
            all.par_sort_unstable();
            (sums, cut, all)
        };
    }

    #[test]
    fn one_thread_does_one_thing_after_the_other() {
        assert_eq!(crate::current_num_threads(), 1);
        assert_eq!(crate::join(|| 1, || 2), rayon::join(|| 1, || 2));
    }
}
