//! Limits of numbers, and what a reader may use at most, so that no input can exhaust the machine.

/// The largest magnitude of any number in a scene: its square still fits an f32.
pub const LARGEST: f64 = 1e18;

/// An interval of numbers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Range {
    /// The lower end.
    pub(crate) min: f64,
    /// The upper end.
    pub(crate) max: f64,
    /// Whether `min` itself is in it.
    pub(crate) min_included: bool,
    /// Whether `max` itself is in it.
    pub(crate) max_included: bool,
}

impl Range {
    /// Any number.
    pub(crate) const ANY: Self = Self::closed(-LARGEST, LARGEST);
    /// Above 0.
    pub(crate) const POSITIVE: Self =
        Self { min: 0.0, max: LARGEST, min_included: false, max_included: true };
    /// 0 or above.
    pub(crate) const NOT_NEGATIVE: Self = Self::closed(0.0, LARGEST);

    /// From `min` to `max`, both included.
    pub(crate) const fn closed(min: f64, max: f64) -> Self {
        Self { min, max, min_included: true, max_included: true }
    }

    /// From `min` to `max`, neither included.
    pub(crate) const fn open(min: f64, max: f64) -> Self {
        Self { min, max, min_included: false, max_included: false }
    }

    /// From `min`, not included, to `max`, included.
    pub(crate) const fn above(min: f64, max: f64) -> Self {
        Self { min, max, min_included: false, max_included: true }
    }

    /// Whether no number of a scene is outside.
    pub(crate) fn is_any(&self) -> bool {
        self.min <= -LARGEST && self.max >= LARGEST
    }

    /// Whether it holds `v`.
    pub(crate) fn holds(&self, v: f64) -> bool {
        (if self.min_included { v >= self.min } else { v > self.min })
            && (if self.max_included { v <= self.max } else { v < self.max })
    }

    /// What a number in it is: `above 0`, `from 0 to 90`, `above 0 and below 180`.
    pub(crate) fn words(&self) -> String {
        let Self { min, max, min_included, max_included } = *self;
        let lower = if min_included { format!("from {min}") } else { format!("above {min}") };
        match max_included {
            _ if max >= LARGEST && min_included => format!("{min} or above"),
            _ if max >= LARGEST => lower,
            true if min_included => format!("{lower} to {max}"),
            true => format!("{lower} up to {max}"),
            false => format!("{lower} and below {max}"),
        }
    }
}

/// Upper bounds that every reader takes; going over one is an error at its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Bytes that all geometry read may take in memory. Default: no limit but `u64::MAX`; the
    /// program sets it from `--max-memory`. Counts that a file declares are checked against the
    /// file's own length before anything is allocated, whatever this says.
    pub bytes: u64,
    /// Bytes of one text file (TOML, MTL) that is read whole. Default 256 MiB.
    pub text_bytes: u64,
    /// Vertices of one file. Default and maximum `u32::MAX − 1`.
    pub vertices: u64,
    /// Triangles of one file. Default and maximum `u32::MAX − 1`.
    pub triangles: u64,
    /// Pixels of one image of a texture. Default 2²⁸, as many as 16,384 × 16,384.
    pub image_pixels: u64,
    /// Includes and groups within one another. Default 32.
    pub nesting: u32,
    /// Whether to draw what can be drawn of a damaged model: what is there of a file that is cut
    /// short, and all faces but those that use positions out of range. Default: no, they are errors.
    pub lenient: bool,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            bytes: u64::MAX,
            text_bytes: 256 << 20,
            vertices: u64::from(u32::MAX) - 1,
            triangles: u64::from(u32::MAX) - 1,
            image_pixels: 1 << 28,
            nesting: 32,
            lenient: false,
        }
    }
}
