//! An array that several can own.

use std::fmt;
use std::ops::{Deref, DerefMut};
use std::sync::Arc;

/// An array that several own together: a clone is a reference to the same values. Whoever changes
/// it while others own it too gets a copy of its own first.
///
/// It is made of a `Vec` without a copy, and reads like one.
///
/// ```
/// use phong_scene::Shared;
/// let a = Shared::from(vec![1, 2, 3]);
/// let mut b = a.clone();
/// assert!(Shared::is_same(&a, &b));
/// b.push(4);
/// assert_eq!((a.len(), b.len()), (3, 4));
/// ```
pub struct Shared<T>(Arc<Vec<T>>);

impl<T> Shared<T> {
    /// Whether both are references to one array; equal values alone are not enough.
    pub fn is_same(a: &Self, b: &Self) -> bool {
        Arc::ptr_eq(&a.0, &b.0)
    }

    /// Where the values lie in memory: the same for two exactly if both refer to one array, as long
    /// as both are held.
    pub fn address(shared: &Self) -> usize {
        Arc::as_ptr(&shared.0).addr()
    }

    /// Another reference to the array, as the standard library's own.
    pub fn to_arc(&self) -> Arc<Vec<T>> {
        Arc::clone(&self.0)
    }
}

impl<T: fmt::Debug> fmt::Debug for Shared<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl<T> Clone for Shared<T> {
    fn clone(&self) -> Self {
        Self(self.to_arc())
    }
}

impl<T> Default for Shared<T> {
    fn default() -> Self {
        Self(Arc::new(Vec::new()))
    }
}

impl<T> Deref for Shared<T> {
    type Target = Vec<T>;

    fn deref(&self) -> &Vec<T> {
        &self.0
    }
}

impl<T: Clone> DerefMut for Shared<T> {
    fn deref_mut(&mut self) -> &mut Vec<T> {
        Arc::make_mut(&mut self.0)
    }
}

impl<T> From<Vec<T>> for Shared<T> {
    fn from(values: Vec<T>) -> Self {
        Self(Arc::new(values))
    }
}

impl<T, const N: usize> From<[T; N]> for Shared<T> {
    fn from(values: [T; N]) -> Self {
        Vec::from(values).into()
    }
}

impl<T> From<Arc<Vec<T>>> for Shared<T> {
    fn from(values: Arc<Vec<T>>) -> Self {
        Self(values)
    }
}

impl<T> FromIterator<T> for Shared<T> {
    fn from_iter<I: IntoIterator<Item = T>>(values: I) -> Self {
        Vec::from_iter(values).into()
    }
}

impl<'a, T> IntoIterator for &'a Shared<T> {
    type Item = &'a T;
    type IntoIter = std::slice::Iter<'a, T>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.iter()
    }
}

impl<T: PartialEq> PartialEq for Shared<T> {
    fn eq(&self, other: &Self) -> bool {
        Self::is_same(self, other) || self.0 == other.0
    }
}

impl<T: PartialEq> PartialEq<Vec<T>> for Shared<T> {
    fn eq(&self, other: &Vec<T>) -> bool {
        *self.0 == *other
    }
}

impl<T: PartialEq, const N: usize> PartialEq<[T; N]> for Shared<T> {
    fn eq(&self, other: &[T; N]) -> bool {
        **self.0 == other[..]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_vector_becomes_shared_without_a_copy() {
        let values = vec![1.0_f32; 5];
        let place = values.as_ptr();
        let shared = Shared::from(values);
        assert_eq!(shared.as_ptr(), place);
        assert_eq!(shared.clone().as_ptr(), place);
    }

    #[test]
    fn the_only_owner_changes_the_array_in_place() {
        let mut shared = Shared::from(vec![1, 2]);
        let place = shared.as_ptr();
        shared[0] = 7;
        assert_eq!((shared.as_ptr(), shared[0]), (place, 7));
    }
}
