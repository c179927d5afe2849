//! A layer's values, in large pages where there are many: a picture's worth of 4 kB pages costs more
//! to be handed out one by one than to be filled.

use std::fmt;
use std::ops::{Deref, DerefMut};

use memmap2::MmapMut;

/// Bytes from which large pages are asked for.
const MANY: usize = 4 << 20;

/// The values of a layer: a slice of a fixed length.
pub struct Values(Store);

enum Store {
    Few(Vec<f32>),
    Many(MmapMut),
}

impl Values {
    /// `len` times 0.
    pub fn zeroed(len: usize) -> Self {
        let bytes = len.saturating_mul(size_of::<f32>());
        if bytes >= MANY
            && let Ok(map) = MmapMut::map_anon(bytes)
        {
            // Advice only: where it is not taken, pages are small and all else is the same.
            #[cfg(target_os = "linux")]
            let _ = map.advise(memmap2::Advice::HugePage);
            return Self(Store::Many(map));
        }
        Self(Store::Few(vec![0.0; len]))
    }
}

impl Deref for Values {
    type Target = [f32];

    fn deref(&self) -> &[f32] {
        match &self.0 {
            Store::Few(values) => values,
            Store::Many(map) => bytemuck::cast_slice(map),
        }
    }
}

impl DerefMut for Values {
    fn deref_mut(&mut self) -> &mut [f32] {
        match &mut self.0 {
            Store::Few(values) => values,
            Store::Many(map) => bytemuck::cast_slice_mut(map),
        }
    }
}

impl FromIterator<f32> for Values {
    fn from_iter<I: IntoIterator<Item = f32>>(values: I) -> Self {
        Self(Store::Few(values.into_iter().collect()))
    }
}

impl Clone for Values {
    fn clone(&self) -> Self {
        let mut copy = Self::zeroed(self.len());
        copy.copy_from_slice(self);
        copy
    }
}

impl PartialEq for Values {
    fn eq(&self, other: &Self) -> bool {
        **self == **other
    }
}

impl fmt::Debug for Values {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        (**self).fmt(f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_and_many_values_are_zero_and_keep_what_is_written() {
        for len in [0, 3, MANY / size_of::<f32>() + 1] {
            let mut values = Values::zeroed(len);
            assert!(values.len() == len && values.iter().all(|&v| v == 0.0));
            if let Some(last) = values.last_mut() {
                *last = 5.0;
                assert_eq!(values.clone()[len - 1], 5.0);
                assert_ne!(values, Values::zeroed(len));
            }
        }
    }
}
