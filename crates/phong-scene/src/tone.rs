//! Tone: how light becomes what a PNG shows.
//!
//! ```toml
//! [tone]
//! exposure = "auto"
//! white_balance = 3200
//! curve = "filmic"
//! ```
//!
//! | key | value | default | meaning |
//! |---|---|---|---|
//! | `exposure` | a number from -100 to 100, or "auto" | `0` | Stops by which the picture is made brighter: each doubles the light. `"auto"` makes the geometric mean luminance of what is lit 0.18. |
//! | `white_balance` | a number from 1700 to 25000 | none | Colour temperature of the light that is to look white, kelvin. |
//! | `neutral` | a colour: a number, `[r, g, b]`, "#rrggbb" or a CSS name | none | The colour that is to look grey, in place of `white_balance`. |
//! | `curve` | `clamp`, `reinhard` or `filmic` | `"clamp"` | How light beyond white is brought into the range of a display. |
//! | `white` (reinhard) | a number above 0 | `4` | The luminance that becomes white. |

use crate::color::Rgb;
use crate::limits::Range;
use crate::wording::words;

/// How light becomes what a PNG shows: exposure, white balance and a curve, in this order, before the sRGB
/// curve. It finishes a picture, and is no term of the sum; EXR and PFM hold the light as it is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tone {
    /// How much brighter the picture is made. Default 0 stops.
    pub exposure: Exposure,
    /// Colour temperature of the light that is to look white, kelvin, 1700 to 25000. `None`: colours stay.
    pub white_balance: Option<f64>,
    /// The colour that is to look grey, linear, not black; not beside `white_balance`. `None`: colours stay.
    pub neutral: Option<Rgb>,
    /// How light beyond white is brought into the range of a display. Default clamp.
    pub curve: ToneCurve,
}

impl Tone {
    /// The most stops of exposure, either way: beyond them f32s hold no light.
    pub const MOST_STOPS: f64 = 100.0;
    /// The lowest and the highest colour temperature for which there is a formula, kelvin.
    pub const TEMPERATURES: [f64; 2] = [1700.0, 25_000.0];
    pub(crate) const EXPOSURE: Range = Range::closed(-Self::MOST_STOPS, Self::MOST_STOPS);
    pub(crate) const WHITE_BALANCE: Range =
        Range::closed(Self::TEMPERATURES[0], Self::TEMPERATURES[1]);
}

/// How much brighter a picture is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Exposure {
    /// So much that the geometric mean luminance of what is lit becomes 0.18.
    Auto,
    /// So many stops, from −100 to 100: each doubles the light.
    Stops(f64),
}

impl Default for Exposure {
    /// The light as it is.
    fn default() -> Self {
        Self::Stops(0.0)
    }
}

/// How light beyond white is brought into the range of a display.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum ToneCurve {
    /// What is beyond white is white.
    #[default]
    Clamp,
    /// Luminance L becomes L (1 + L ÷ white²) ÷ (1 + L), and the colour is scaled as its luminance is
    /// (Reinhard, Stark, Shirley and Ferwerda, *Photographic Tone Reproduction for Digital Images*, 2002,
    /// equation 4).
    Reinhard {
        /// The luminance that becomes white, > 0.
        white: f64,
    },
    /// Each channel x becomes x (2.51 x + 0.03) ÷ (x (2.43 x + 0.59) + 0.14): Narkowicz's fit to the film
    /// curve of ACES (*ACES Filmic Tone Mapping Curve*, 2015).
    Filmic,
}

words!(ToneCurve {
    "clamp" = Clamp,
    "reinhard" = Reinhard { white: 4.0 },
    "filmic" = Filmic,
});
