//! Fog, and depth cue: what is far away fades into a colour.
//!
//! ```toml
//! [fog]
//! kind = "linear"
//! start = 4
//! end = 12
//! color = "#dfe9f4"
//! ```
//!
//! | key | value | default | meaning |
//! |---|---|---|---|
//! | `kind` | `linear`, `exponential` or `exponential-squared` | `"linear"` | How the share f of the fog grows with the distance d: from 0 at `start` to 1 at `end`; 1 − e^(−density d); or 1 − e^(−(density d)²). |
//! | `color` | a colour: a number, `[r, g, b]`, "#rrggbb" or a CSS name | the background's or the sky's | Colour of the fog; of a background that runs down the picture the mean of its two, of a transparent one black, of a sky the mean along its horizon. |
//! | `start` (linear) | a number 0 or above | `0` | Where it begins, in scene units. |
//! | `end` (linear) | a number above 0 | required | Where nothing but fog is seen; above `start`. |
//! | `density` (exponential, exponential-squared) | a number above 0 | required | How dense it is, per scene unit. |
//! | `distance` | `radial` or `planar` | `"radial"` | Whether the distance is that from the eye, or that along the camera's axis alone. |
//! | `strength` | a number from 0 to 1 | `1` | The largest share; below 1 what is far away stays visible. |

use crate::color::Rgb;
use crate::limits::Range;
use crate::wording::words;

/// What is far away fades into a colour: the terms count 1 − f, and the term `fog` is f times the colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fog {
    /// How its share grows with the distance.
    pub kind: FogKind,
    /// Its colour, linear; `None`: the background's, or that of the sky's horizon.
    pub color: Option<Rgb>,
    /// Which distance. Default radial.
    pub distance: FogDistance,
    /// The largest share, from 0 to 1. Default 1.
    pub strength: f64,
}

impl Fog {
    /// Shares.
    pub(crate) const STRENGTH: Range = Range::closed(0.0, 1.0);
}

impl Default for Fog {
    /// Linear, from the eye to a distance of 1.
    fn default() -> Self {
        let kind = FogKind::Linear { start: 0.0, end: 1.0 };
        Self { kind, color: None, distance: FogDistance::Radial, strength: 1.0 }
    }
}

/// How the share f of fog grows with the distance d.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FogKind {
    /// From 0 to 1 in a straight line.
    Linear {
        /// Where it begins, scene units, ≥ 0.
        start: f64,
        /// Where nothing else is seen, scene units, above `start`.
        end: f64,
    },
    /// `1 − e^(−ρ d)`.
    Exponential {
        /// ρ, per scene unit, > 0.
        density: f64,
    },
    /// `1 − e^(−(ρ d)²)`.
    Squared {
        /// ρ, per scene unit, > 0.
        density: f64,
    },
}

words!(FogKind {
    "linear" = Linear { start: 0.0, end: 1.0 },
    "exponential" = Exponential { density: 1.0 },
    "exponential-squared" = Squared { density: 1.0 },
});

/// Which distance fog goes by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FogDistance {
    /// From the eye.
    #[default]
    Radial,
    /// Along the camera's axis.
    Planar,
}

words!(FogDistance { "radial" = Radial, "planar" = Planar });
