//! Flat arrays as bytes and back, little-endian: what a scene is pickled as.

use glam::{Vec2, Vec3};
use phong_scene::{Rgb, Shared};

/// The values of an array that was pickled.
pub(crate) trait Raw: Sized + Copy {
    /// How many bytes one takes.
    const BYTES: usize;
    fn put(self, bytes: &mut Vec<u8>);
    fn take(bytes: &[u8]) -> Option<Self>;
}

macro_rules! raw {
    ($of:ty, $word:ty, $count:literal, $value:ident => $into:expr, $words:ident => $from:expr) => {
        impl Raw for $of {
            const BYTES: usize = 4 * $count;
            fn put(self, bytes: &mut Vec<u8>) {
                let $value = self;
                let words: [$word; $count] = $into;
                for word in words {
                    bytes.extend_from_slice(&word.to_le_bytes());
                }
            }
            fn take(bytes: &[u8]) -> Option<Self> {
                let mut $words = [<$word>::default(); $count];
                for (word, bytes) in $words.iter_mut().zip(bytes.as_chunks::<4>().0) {
                    *word = <$word>::from_le_bytes(*bytes);
                }
                Some($from)
            }
        }
    };
}

raw!(Vec3, f32, 3, v => v.to_array(), w => Vec3::from_array(w));
raw!(Vec2, f32, 2, v => v.to_array(), w => Vec2::from_array(w));
raw!(Rgb, f32, 3, v => v.to_array(), w => Rgb::from(w));
raw!([f32; 4], f32, 4, v => v, w => w);
raw!([u32; 3], u32, 3, v => v, w => w);
raw!(u32, u32, 1, v => [v], w => w[0]);
raw!(f32, f32, 1, v => [v], w => w[0]);
raw!([Rgb; 2], f32, 6,
    v => { let [a, b] = v.map(Rgb::to_array); [a[0], a[1], a[2], b[0], b[1], b[2]] },
    w => [Rgb::new(w[0], w[1], w[2]), Rgb::new(w[3], w[4], w[5])]);
raw!([[f32; 4]; 2], f32, 8,
    v => { let [a, b] = v; [a[0], a[1], a[2], a[3], b[0], b[1], b[2], b[3]] },
    w => [[w[0], w[1], w[2], w[3]], [w[4], w[5], w[6], w[7]]]);

/// An array as bytes.
pub(crate) fn to_bytes<T: Raw>(values: &[T]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(values.len() * T::BYTES);
    for value in values {
        value.put(&mut bytes);
    }
    bytes
}

/// An array of its bytes; `None`: they are not of whole values.
pub(crate) fn of_bytes<T: Raw>(bytes: &[u8]) -> Option<Shared<T>> {
    if !bytes.len().is_multiple_of(T::BYTES) {
        return None;
    }
    bytes.chunks_exact(T::BYTES).map(T::take).collect::<Option<Vec<T>>>().map(Shared::from)
}
