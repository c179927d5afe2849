//! What the vector crate does not offer, and a benchmark earns: the one home of `unsafe` in this crate.

#![expect(unsafe_code, reason = "each block says why it is sound, and NOTES.md what it brings")]

mod pages;

pub(crate) use self::pages::Rows;
use crate::node8::Row;

/// Asks for the rows of the node or leaf at `row`, before they are needed.
#[inline(always)]
pub(crate) fn prefetch(rows: &[Row], row: usize) {
    #[cfg(target_arch = "x86_64")]
    {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        let at = rows.as_ptr().wrapping_add(row).cast::<i8>();
        // SAFETY: a prefetch reads nothing and cannot fault, whatever the address.
        unsafe {
            _mm_prefetch::<_MM_HINT_T0>(at);
            _mm_prefetch::<_MM_HINT_T0>(at.wrapping_add(64));
            _mm_prefetch::<_MM_HINT_T0>(at.wrapping_add(128));
            _mm_prefetch::<_MM_HINT_T0>(at.wrapping_add(192));
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = (rows, row);
}

/// Asks for one item before it is needed; beyond the end it asks for nothing of use.
#[inline(always)]
pub(crate) fn prefetch_item<T>(items: &[T], index: usize) {
    #[cfg(target_arch = "x86_64")]
    {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        let at = items.as_ptr().wrapping_add(index).cast::<i8>();
        // SAFETY: a prefetch reads nothing and cannot fault, whatever the address.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(at) };
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = (items, index);
}
