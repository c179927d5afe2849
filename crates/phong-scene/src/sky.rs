//! A sky, which the ambient light comes from.
//!
//! ```toml
//! [sky]
//! kind = "sun-and-sky"
//! sun = [0.4, 0.6, 0.5]
//! turbidity = 2.5
//! ```
//!
//! | key | value | default | meaning |
//! |---|---|---|---|
//! | `kind` | `constant`, `gradient`, `sun-and-sky` or `image` | `"constant"` | What it looks like. |
//! | `color` | a colour: a number, `[r, g, b]`, "#rrggbb" or a CSS name | `1` | What all of it is multiplied by; of a constant one its colour. |
//! | `zenith` (gradient) | a colour: a number, `[r, g, b]`, "#rrggbb" or a CSS name | `1` | Its colour straight up. |
//! | `horizon` (gradient) | a colour: a number, `[r, g, b]`, "#rrggbb" or a CSS name | `1` | Its colour at the horizon; between them by the sine of the height. |
//! | `sun` (sun-and-sky) | three numbers, `[x, y, z]`, not all 0 | required | Towards the sun, any length, above the horizon. Its own light is a `distant` light, for you to add. |
//! | `turbidity` (sun-and-sky) | a number from 2 to 10 | `3` | How hazy the air is: 2 is clear, 6 hazy. |
//! | `ground` (gradient, sun-and-sky) | a colour: a number, `[r, g, b]`, "#rrggbb" or a CSS name | `horizon`; of `sun-and-sky` 0.2 | Its colour below the horizon. |
//! | `file` (image) | the path of a file, in quotes | required | The image: PNG, JPEG, Radiance HDR or OpenEXR. Its width is all around and its height from straight up to straight down; its middle lies towards −Z, of an `up` along Z towards +Y. |
//! | `rotation` (image) | a number | `0` | Degrees by which it is turned about `up`, right-handed. |
//! | `up` | three numbers, `[x, y, z]`, not all 0 | `[0, 1, 0]` | Which way is up. |
//! | `samples` | a whole number from 1 to 4096 | `16` | Rays from every surface that a ray meets, as far as there is anything; where there is `[ambient_occlusion]`, that says how many and how far. |

use std::sync::Arc;

use glam::DVec3;

use crate::color::Rgb;
use crate::diagnostic::Place;
use crate::limits::Range;
use crate::texels::Texels;
use crate::wording::words;

/// A sky around everything. Its light is the ambient light: what of it a surface meets, as a matt surface
/// weighs it, is a factor of the ambient term, colour by colour. Rays that hit nothing see it.
#[derive(Clone, Debug, PartialEq)]
pub struct Sky {
    /// What it looks like.
    pub kind: SkyKind,
    /// Which way is up; any length but 0. Default +Y.
    pub up: DVec3,
    /// What all of it is multiplied by, linear. Default white.
    pub color: Rgb,
    /// Rays from every surface that a ray meets, ≥ 1, where no ambient occlusion says how many. Default 16.
    pub samples: u32,
}

impl Sky {
    /// Turbidities: from clear mountain air to haze.
    pub(crate) const TURBIDITY: Range = Range::closed(2.0, 10.0);
}

impl Default for Sky {
    /// White all around.
    fn default() -> Self {
        Self { kind: SkyKind::Constant, up: DVec3::Y, color: Rgb::WHITE, samples: 16 }
    }
}

/// What a sky looks like.
#[derive(Clone, Debug, PartialEq)]
pub enum SkyKind {
    /// The same in every direction: what the lecture's ambient term stands for.
    Constant,
    /// From the horizon to the zenith by the sine of the height, and the ground below.
    Gradient {
        /// Straight up. Linear.
        zenith: Rgb,
        /// At the horizon. Linear.
        horizon: Rgb,
        /// Below it. Linear; `None`: as the horizon.
        ground: Option<Rgb>,
    },
    /// A clear sky by day, without the sun's own disc (Preetham, Shirley and Smits, *A Practical Analytic
    /// Model for Daylight*, 1999), as bright as makes the mean that a level open surface meets 1.
    SunAndSky {
        /// Towards the sun; any length, above the horizon.
        sun: DVec3,
        /// How hazy the air is, from 2 to 10.
        turbidity: f64,
        /// Below the horizon. Linear; `None`: a grey of 0.2.
        ground: Option<Rgb>,
    },
    /// An image of all directions: its width is all around, its height from straight up to straight down.
    /// Bytes and 16-bit numbers are sRGB, floats linear.
    Image {
        /// The file, as it was written.
        file: String,
        /// Where that stands.
        place: Place,
        /// Its pixels.
        texels: Arc<Texels>,
        /// Degrees by which it is turned about `up`, right-handed. At 0 its middle lies towards −Z, of an
        /// `up` along Z towards +Y.
        rotation: f64,
    },
}

words!(SkyKind {
    "constant" = Constant,
    "gradient" = Gradient { zenith: Rgb::WHITE, horizon: Rgb::WHITE, ground: None },
    "sun-and-sky" = SunAndSky { sun: DVec3::new(1.0, 1.0, 1.0), turbidity: 3.0, ground: None },
    "image" = Image {
        file: String::new(),
        place: Place::default(),
        texels: Arc::new(Texels::white()),
        rotation: 0.0,
    },
});
