//! Iterators with the methods of parallel ones.

use std::iter::{self, Sum};

/// An iterator that is asked as a parallel one is.
#[derive(Clone, Debug)]
pub struct Serial<I>(pub(crate) I);

impl<I: Iterator> IntoIterator for Serial<I> {
    type Item = I::Item;
    type IntoIter = I;

    fn into_iter(self) -> I {
        self.0
    }
}

/// What can be walked through by value.
pub trait IntoParallelIterator: IntoIterator + Sized {
    /// Walks through it.
    fn into_par_iter(self) -> Serial<Self::IntoIter> {
        Serial(self.into_iter())
    }
}

impl<T: IntoIterator> IntoParallelIterator for T {}

/// What can be walked through by reference.
pub trait IntoParallelRefIterator<'a> {
    /// What walks through it.
    type Iter: Iterator;

    /// Walks through it.
    fn par_iter(&'a self) -> Serial<Self::Iter>;
}

impl<'a, T: ?Sized + 'a> IntoParallelRefIterator<'a> for T
where
    &'a T: IntoIterator,
{
    type Iter = <&'a T as IntoIterator>::IntoIter;

    fn par_iter(&'a self) -> Serial<Self::Iter> {
        Serial(self.into_iter())
    }
}

/// What can be walked through and changed.
pub trait IntoParallelRefMutIterator<'a> {
    /// What walks through it.
    type Iter: Iterator;

    /// Walks through it.
    fn par_iter_mut(&'a mut self) -> Serial<Self::Iter>;
}

impl<'a, T: ?Sized + 'a> IntoParallelRefMutIterator<'a> for T
where
    &'a mut T: IntoIterator,
{
    type Iter = <&'a mut T as IntoIterator>::IntoIter;

    fn par_iter_mut(&'a mut self) -> Serial<Self::Iter> {
        Serial(self.into_iter())
    }
}

impl<I: Iterator> Serial<I> {
    /// Nothing is split here, so no piece is too small.
    #[must_use]
    pub fn with_min_len(self, _min: usize) -> Self {
        self
    }

    /// Nothing is split here.
    #[must_use]
    pub fn with_max_len(self, _max: usize) -> Self {
        self
    }

    /// [`Iterator::map`].
    pub fn map<T, F: FnMut(I::Item) -> T>(self, f: F) -> Serial<iter::Map<I, F>> {
        Serial(self.0.map(f))
    }

    /// The same with something of `init` at hand.
    pub fn map_init<S, T>(
        self,
        init: impl FnOnce() -> S,
        mut f: impl FnMut(&mut S, I::Item) -> T,
    ) -> Serial<impl Iterator<Item = T>> {
        let mut at_hand = init();
        Serial(self.0.map(move |item| f(&mut at_hand, item)))
    }

    /// [`Iterator::filter`].
    pub fn filter<F: FnMut(&I::Item) -> bool>(self, f: F) -> Serial<iter::Filter<I, F>> {
        Serial(self.0.filter(f))
    }

    /// [`Iterator::filter_map`].
    pub fn filter_map<T, F>(self, f: F) -> Serial<iter::FilterMap<I, F>>
    where
        F: FnMut(I::Item) -> Option<T>,
    {
        Serial(self.0.filter_map(f))
    }

    /// [`Iterator::flat_map`].
    pub fn flat_map_iter<T, F>(self, f: F) -> Serial<iter::FlatMap<I, T, F>>
    where
        T: IntoIterator,
        F: FnMut(I::Item) -> T,
    {
        Serial(self.0.flat_map(f))
    }

    /// [`Iterator::enumerate`].
    pub fn enumerate(self) -> Serial<iter::Enumerate<I>> {
        Serial(self.0.enumerate())
    }

    /// [`Iterator::zip`].
    pub fn zip<T: IntoIterator>(self, other: T) -> Serial<iter::Zip<I, T::IntoIter>> {
        Serial(self.0.zip(other))
    }

    /// [`Iterator::for_each`].
    pub fn for_each(self, f: impl FnMut(I::Item)) {
        self.0.for_each(f);
    }

    /// [`Iterator::collect`].
    pub fn collect<C: FromIterator<I::Item>>(self) -> C {
        self.0.collect()
    }

    /// [`Iterator::sum`].
    pub fn sum<S: Sum<I::Item>>(self) -> S {
        self.0.sum()
    }

    /// [`Iterator::count`].
    pub fn count(self) -> usize {
        self.0.count()
    }

    /// [`Iterator::all`].
    pub fn all(mut self, f: impl FnMut(I::Item) -> bool) -> bool {
        self.0.all(f)
    }

    /// [`Iterator::any`].
    pub fn any(mut self, f: impl FnMut(I::Item) -> bool) -> bool {
        self.0.any(f)
    }

    /// Folds what there is to one value, which is all that is walked through then.
    pub fn fold<T>(
        self,
        identity: impl FnOnce() -> T,
        f: impl FnMut(T, I::Item) -> T,
    ) -> Serial<iter::Once<T>> {
        Serial(iter::once(self.0.fold(identity(), f)))
    }

    /// All in one, beginning with `identity`.
    pub fn reduce(
        self,
        identity: impl FnOnce() -> I::Item,
        f: impl FnMut(I::Item, I::Item) -> I::Item,
    ) -> I::Item {
        self.0.fold(identity(), f)
    }

    /// All in one; `None` if there is nothing.
    pub fn reduce_with(self, f: impl FnMut(I::Item, I::Item) -> I::Item) -> Option<I::Item> {
        self.0.reduce(f)
    }
}
