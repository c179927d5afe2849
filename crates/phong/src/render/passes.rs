//! Passes: a picture at once, or from coarse to fine.

/// How the samples of a picture are gone about.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Passes {
    /// All samples of a tile at once. Nothing is kept of a pixel but its values.
    #[default]
    One,
    /// A coarse picture first, then 1, 2, 4, 8, … samples of each pixel, up to all of them. Each
    /// pass is a picture of the samples so far, and the last one has the bits of [`One`](Self::One).
    /// Between passes the film holds the pixels' sums, some 200 bytes a pixel.
    CoarseToFine,
    /// The same without the coarse picture: for who stops and goes on often. A coarse picture leaves
    /// nothing in the film to go on from, so it would be drawn again each time.
    Doubling,
}

/// One pass over the tiles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pass {
    /// One ray through the middle pixel of each square of [`Pass::COARSE`] pixels; the square
    /// gets what it brought.
    Coarse,
    /// The pixels' samples up to this number.
    UpTo(u32),
}

impl Pass {
    /// Edge in pixels of the squares of a coarse picture. They are counted from the picture's
    /// upper left, so that they are the same for any window and tile.
    pub const COARSE: u32 = 8;

    /// Samples of each pixel when it is done; 0 for the coarse one.
    pub fn samples(self) -> u32 {
        match self {
            Self::Coarse => 0,
            Self::UpTo(samples) => samples,
        }
    }
}

impl Passes {
    /// The passes of a picture with so many samples a pixel, in order.
    ///
    /// ```
    /// use phong::render::{Pass, Passes};
    /// let samples: Vec<u32> = Passes::CoarseToFine.of(5).into_iter().map(Pass::samples).collect();
    /// assert_eq!(samples, [0, 1, 2, 4, 5]);
    /// assert_eq!(Passes::One.of(5), [Pass::UpTo(5)]);
    /// assert_eq!(Passes::Doubling.of(3), [Pass::UpTo(1), Pass::UpTo(2), Pass::UpTo(3)]);
    /// ```
    pub fn of(self, samples: u32) -> Vec<Pass> {
        let mut passes = Vec::new();
        if self == Self::CoarseToFine {
            passes.push(Pass::Coarse);
        }
        if self != Self::One {
            let doubled = std::iter::successors(Some(1_u32), |n| n.checked_mul(2));
            passes.extend(doubled.take_while(|&n| n < samples).map(Pass::UpTo));
        }
        passes.push(Pass::UpTo(samples));
        passes
    }
}
