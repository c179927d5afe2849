//! Lights: distant, point and spot.
//!
//! ```toml
//! [[light]]
//! kind = "point"
//! position = [3, 4, 5]
//! color = "#fff4e0"
//!
//! [[light]]
//! kind = "distant"
//! direction = [-1, -2, -1]        # the way the light travels
//! color = 0.3
//!
//! [[light]]
//! kind = "spot"
//! position = [0, 6, 0]
//! target = [0, 0, 0]
//! cone = 20
//! edge = 25
//! ```
//!
//! | key | value | default | meaning |
//! |---|---|---|---|
//! | `kind` | `point`, `distant` or `spot` | required | Where its light comes from. |
//! | `name` | text | `light N`, N from 1 | What `explain` calls it. |
//! | `position` (point, spot) | three numbers, `[x, y, z]` | required | Where it is, in scene units. |
//! | `direction` (distant) | three numbers, `[x, y, z]`, not all 0 | required | The way the light travels; any length. |
//! | `target` (spot) | three numbers, `[x, y, z]` | required | A point on the axis of the cone. |
//! | `cone` (spot) | a number from 0 to 90 | required | Half-angle of full light, degrees. |
//! | `edge` (spot) | a number above 0 up to 90 | `cone` | Half-angle where the light ends, degrees, not below `cone`; between them smoothstep in the cosine. |
//! | `color` | a colour: a number, `[r, g, b]`, "#rrggbb" or a CSS name | `1` | `C_m,d` is this times the material's diffuse colour. |
//! | `specular_color` | a colour: a number, `[r, g, b]`, "#rrggbb" or a CSS name | `color` | `C_m,s` is this times the material's specular colour. |
//! | `attenuation` (point, spot) | `[c, l, q]`, 0 or above, not all 0 | `[1, 0, 0]` | `[c, l, q]`: the light is divided by c + l d + q d², d the distance. |
//! | `shadows` | `true` or `false` | `true` | Whether things in between take the light away. |
//! | `radius` (point, spot) | a number 0 or above | `0` | Radius of the luminous sphere, scene units; 0: hard shadows. |
//! | `angle` (distant) | a number from 0 and below 180 | `0` | Degrees across of the luminous disc; 0: hard shadows. |

use glam::DVec3;

use crate::color::Rgb;
use crate::diagnostic::Place;
use crate::limits::Range;
use crate::wording::words;

/// One light of the sum over lights.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// What `explain` calls it: the name given in the text, else `light N` (N from 1).
    pub name: String,
    /// Where its light comes from.
    pub kind: LightKind,
    /// `C_{m,d}` is this times the material's diffuse colour. Linear.
    pub color: Rgb,
    /// `C_{m,s}` is this times the material's specular colour. Linear; defaults to `color`.
    pub specular_color: Rgb,
    /// Whether things between the light and a point take the light away.
    pub shadows: bool,
    /// Where it was written.
    pub place: Place,
}

impl Default for Light {
    /// A white distant light called `light`, with shadows.
    fn default() -> Self {
        Self {
            name: "light".to_owned(),
            kind: LightKind::default(),
            color: Rgb::WHITE,
            specular_color: Rgb::WHITE,
            shadows: true,
            place: Place::default(),
        }
    }
}

/// Where a light's light comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    /// A point, the same in all directions.
    Point {
        /// Position in scene units.
        position: DVec3,
        /// `[c, l, q]`: the light is divided by `c + l·d + q·d²`, d the distance. Default `[1, 0, 0]`.
        attenuation: [f64; 3],
        /// Radius of the luminous sphere, scene units; 0: a point with hard shadows.
        radius: f64,
    },
    /// So far away that its direction is the same everywhere, like the sun.
    Distant {
        /// The way the light *travels*; any length but 0.
        direction: DVec3,
        /// Degrees across of the luminous disc; 0: hard shadows.
        angle: f64,
    },
    /// A point whose light is confined to a cone.
    Spot {
        /// Position in scene units.
        position: DVec3,
        /// The point the cone's axis passes through.
        target: DVec3,
        /// Half-angle of full light, degrees.
        cone: f64,
        /// Half-angle where the light ends, degrees, ≥ `cone`; between them smoothstep in the cosine.
        edge: f64,
        /// As for a point light.
        attenuation: [f64; 3],
        /// As for a point light.
        radius: f64,
    },
}

impl LightKind {
    /// Half-angles of full light, degrees.
    pub(crate) const CONE: Range = Range::closed(0.0, 90.0);
    /// Half-angles where a cone ends, degrees.
    pub(crate) const EDGE: Range = Range::above(0.0, 90.0);
    /// Angles across a luminous disc, degrees.
    pub(crate) const ANGLE: Range = Range { max_included: false, ..Range::closed(0.0, 180.0) };

    /// The way its light travels, if that is the same everywhere; else it comes from a
    /// [`position`](Self::position).
    pub fn direction(&self) -> Option<DVec3> {
        match self {
            Self::Distant { direction, .. } => Some(*direction),
            Self::Point { .. } | Self::Spot { .. } => None,
        }
    }

    /// Where its light comes from; `None`: from infinitely far away.
    pub fn position(&self) -> Option<DVec3> {
        match self {
            Self::Point { position, .. } | Self::Spot { position, .. } => Some(*position),
            Self::Distant { .. } => None,
        }
    }

    /// `[c, l, q]`, by whose `c + l·d + q·d²` its light is divided; `None`: by nothing.
    pub fn attenuation(&self) -> Option<[f64; 3]> {
        match self {
            Self::Point { attenuation, .. } | Self::Spot { attenuation, .. } => Some(*attenuation),
            Self::Distant { .. } => None,
        }
    }

    /// Radius of the luminous sphere or, of light from infinitely far away, degrees across of the
    /// luminous disc; 0: hard shadows.
    pub fn extent(&self) -> f64 {
        match self {
            Self::Point { radius, .. } | Self::Spot { radius, .. } => *radius,
            Self::Distant { angle, .. } => *angle,
        }
    }
}

words!(LightKind {
    "point" = Point { position: DVec3::ZERO, attenuation: [1.0, 0.0, 0.0], radius: 0.0 },
    "distant" = Distant { direction: -DVec3::Y, angle: 0.0 },
    "spot" = Spot {
        position: DVec3::ZERO,
        target: -DVec3::Y,
        cone: 30.0,
        edge: 30.0,
        attenuation: [1.0, 0.0, 0.0],
        radius: 0.0,
    },
});

impl Default for LightKind {
    /// Distant, with hard shadows, travelling along (−1, −2, −1): from above, right and behind.
    fn default() -> Self {
        Self::Distant { direction: DVec3::new(-1.0, -2.0, -1.0), angle: 0.0 }
    }
}
