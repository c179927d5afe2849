//! Sorting of a few things.
//!
//! The standard library's sort is compiled once for each kind of thing and each order, five kilobytes a time, to be
//! fast with millions. Here the numbers of things are sorted, by the same function for all.

use std::cmp::Ordering;

/// Sorts things as [`slice::sort_by`] does, with the same result, but in a fraction of its code: for what
/// there are few of, or what is sorted once.
pub fn sort_by<T>(things: &mut [T], mut order: impl FnMut(&T, &T) -> Ordering) {
    for (a, b) in exchanges(things.len(), &mut |a, b| order(&things[a], &things[b])) {
        things.swap(a, b);
    }
}

/// Sorts things as [`slice::sort_by_key`] does, with the same result, but in a fraction of its code: for
/// what there are few of, or what is sorted once.
pub fn sort_by_key<T, K: Ord>(things: &mut [T], mut key: impl FnMut(&T) -> K) {
    sort_by(things, |a, b| key(a).cmp(&key(b)));
}

/// Which places have to exchange what they hold, one pair after the other, to have all in order.
fn exchanges(count: usize, order: &mut dyn FnMut(usize, usize) -> Ordering) -> Vec<(usize, usize)> {
    let mut from: Vec<usize> = (0..count).collect();
    from.sort_by(|a, b| order(*a, *b));
    let mut all = Vec::new();
    for start in 0..count {
        // Each circle of places from start to start.
        let mut at = start;
        while from[at] != start {
            let next = std::mem::replace(&mut from[at], at);
            all.push((at, next));
            at = next;
        }
        from[at] = at;
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn things_are_sorted_as_the_standard_library_does_it() {
        for count in 0..200_u32 {
            let things: Vec<(u32, u32)> =
                (0..count).map(|i| (i.wrapping_mul(2_654_435_761) >> 20 & 31, i)).collect();
            let mut wanted = things.clone();
            wanted.sort_by_key(|thing| thing.0);
            let mut got = things.clone();
            sort_by_key(&mut got, |thing| thing.0);
            assert_eq!(got, wanted);
            wanted.sort_by(|a, b| b.cmp(a));
            sort_by(&mut got, |a, b| b.cmp(a));
            assert_eq!(got, wanted);
        }
    }
}
