//! Rows in large pages: with 4 kB pages, most nodes of a large tree cost a walk of the page table.

use memmap2::MmapMut;

use crate::node8::Row;

/// A fixed number of rows, zero at first.
#[derive(Debug, Default)]
pub(crate) enum Rows {
    /// None.
    #[default]
    Empty,
    /// Few, or where no mapping was to be had.
    Few(Vec<Row>),
    /// Many, in pages of 2 MB where the system has them; how many.
    Many(MmapMut, usize),
}

/// Bytes from which large pages are asked for.
const MANY: usize = 4 << 20;

impl Rows {
    /// `len` rows.
    pub(crate) fn zeroed(len: usize) -> Self {
        let bytes = len * size_of::<Row>();
        if bytes >= MANY
            && let Ok(map) = MmapMut::map_anon(bytes)
        {
            // Advice only: where it is not taken, pages are small and all else is the same.
            #[cfg(target_os = "linux")]
            let _ = map.advise(memmap2::Advice::HugePage);
            return Self::Many(map, len);
        }
        Self::Few(vec![Row::ZERO; len])
    }

    /// The rows.
    #[inline(always)]
    pub(crate) fn as_slice(&self) -> &[Row] {
        match self {
            Self::Empty => &[],
            Self::Few(rows) => rows,
            // SAFETY: the mapping begins at a page, so it is aligned; it is private, lives as long as
            // `self`, and holds `len` rows of eight f32, for which all bits are valid.
            Self::Many(map, len) => unsafe {
                std::slice::from_raw_parts(map.as_ptr().cast(), *len)
            },
        }
    }

    /// The rows, to be written.
    pub(crate) fn as_mut_slice(&mut self) -> &mut [Row] {
        match self {
            Self::Empty => &mut [],
            Self::Few(rows) => rows,
            // SAFETY: as above, and `self` is borrowed mutably.
            Self::Many(map, len) => unsafe {
                std::slice::from_raw_parts_mut(map.as_mut_ptr().cast(), *len)
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_and_many_rows_are_zero_and_keep_what_is_written() {
        for len in [0, 3, MANY / size_of::<Row>() + 1] {
            let mut rows = Rows::zeroed(len);
            assert_eq!(rows.as_slice().len(), len);
            assert!(rows.as_slice().iter().all(|row| *row == Row::ZERO));
            if let Some(last) = rows.as_mut_slice().last_mut() {
                last.0[7] = 5.0;
                assert_eq!(rows.as_slice()[len - 1].0[7], 5.0);
            }
        }
    }
}
