//! Lights: distant, point and spot, and those with a surface: rectangle, disc, sphere and mesh.
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
//! range = 12                      # nothing beyond it
//!
//! [[light]]
//! kind = "rectangle"
//! position = [0, 3, 0]
//! direction = [0, -1, 0]
//! width = 2
//! height = 1
//!
//! [[light]]
//! kind = "mesh"
//! object = "mesh 1"               # what is seen of it is the mesh's own `k_e`
//! ```
//!
//! | key | value | default | meaning |
//! |---|---|---|---|
//! | `kind` | `point`, `distant`, `spot`, `rectangle`, `disc`, `sphere` or `mesh` | required | Where its light comes from. |
//! | `name` | text | `light N`, N from 1 | What `explain` calls it. |
//! | `position` (point, spot, rectangle, disc, sphere) | three numbers, `[x, y, z]` | required | Where it is, in scene units. |
//! | `direction` (distant) | three numbers, `[x, y, z]`, not all 0 | required | The way the light travels; any length. |
//! | `direction` (rectangle, disc) | three numbers, `[x, y, z]`, not all 0 | required | The way the light travels from its middle, across its surface; any length. It shines to this side alone. |
//! | `up` (rectangle) | three numbers, `[x, y, z]`, not all 0 | `[0, 1, 0]`; `[0, 0, -1]` where the light travels along Y | Along its height, made perpendicular to `direction`; any length. |
//! | `width` (rectangle) | a number above 0 | required | Across `up`, scene units. |
//! | `height` (rectangle) | a number above 0 | required | Along `up`, scene units. |
//! | `object` (mesh) | text | required | The name of the mesh that shines, from all of its triangles to both sides; it does not shade its own light. |
//! | `target` (spot) | three numbers, `[x, y, z]` | required | A point on the axis of the cone. |
//! | `cone` (spot) | a number from 0 to 90 | required | Half-angle of full light, degrees. |
//! | `edge` (spot) | a number above 0 up to 90 | `cone` | Half-angle where the light ends, degrees, not below `cone`; between them smoothstep in the cosine. |
//! | `color` | a colour: a number, `[r, g, b]`, "#rrggbb" or a CSS name | `1` | `C_m,d` is this times the material's diffuse colour. |
//! | `specular_color` | a colour: a number, `[r, g, b]`, "#rrggbb" or a CSS name | `color` | `C_m,s` is this times the material's specular colour. |
//! | `attenuation` (point, spot, rectangle, disc, sphere, mesh) | `[c, l, q]`, 0 or above, not all 0 | `[1, 0, 0]` | `[c, l, q]`: the light is divided by c + l d + q d², d the distance. |
//! | `range` (point, spot, rectangle, disc, sphere) | a number above 0 | none | Distance from `position` beyond which there is nothing of it, scene units. |
//! | `shadows` | `true` or `false` | `true` | Whether things in between take the light away. |
//! | `radius` (point, spot) | a number 0 or above | `0` | Radius of the luminous sphere, scene units; 0: hard shadows. |
//! | `radius` (disc, sphere) | a number above 0 | required | Radius of the disc or sphere, scene units. |
//! | `visible` (rectangle, disc, sphere) | `true` or `false` | `true` | Whether rays see its surface, from the side to which it shines: an emission of `color`. |
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
    /// How far from its position its light reaches, scene units, above 0; beyond there is none of it.
    /// `None`: for ever. A distant light has no end.
    pub range: Option<f64>,
    /// Whether rays from the camera and mirrors see the surface of a light that has one. It glows in
    /// the light's `color`, is an emission, and throws no shadow.
    pub visible: bool,
    /// The name of the object whose surface shines, of a light that is a [mesh](LightKind::Mesh); of others
    /// nothing is asked of it.
    pub object: String,
    /// Where it was written.
    pub place: Place,
}

impl Light {
    /// The most triangles of a mesh that shines: each point that is lit looks at all of them.
    pub const MOST_TRIANGLES: usize = 256;
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
            range: None,
            visible: true,
            object: String::new(),
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
    /// A luminous rectangle: the mean, over the directions in which a point sees it, of what a point
    /// light gives. It shines to one side.
    Rectangle {
        /// Its middle, in scene units.
        position: DVec3,
        /// The way the light travels from its middle, perpendicular to it; any length but 0.
        direction: DVec3,
        /// Along its height, made perpendicular to `direction`; any length but 0. `None`: +Y, and −Z
        /// where the light travels along Y.
        up: Option<DVec3>,
        /// Across `up`, scene units.
        width: f64,
        /// Along `up`, scene units.
        height: f64,
        /// As for a point light; the distance is that of the point of it.
        attenuation: [f64; 3],
    },
    /// A luminous disc, which shines to one side, as a rectangle does.
    Disc {
        /// Its middle, in scene units.
        position: DVec3,
        /// The way the light travels from its middle, perpendicular to it; any length but 0.
        direction: DVec3,
        /// Radius in scene units, above 0.
        radius: f64,
        /// As for a rectangle.
        attenuation: [f64; 3],
    },
    /// A luminous sphere: a point light with an extent and a surface.
    Sphere {
        /// Its middle, in scene units.
        position: DVec3,
        /// Radius in scene units, above 0.
        radius: f64,
        /// As for a point light.
        attenuation: [f64; 3],
    },
    /// A luminous mesh, an object of the scene: the mean, over the solid angles of its triangles, of what a
    /// point light gives. They shine to both sides, and do not shade one another's light.
    Mesh {
        /// As for a rectangle.
        attenuation: [f64; 3],
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
            _ => None,
        }
    }

    /// Where its light comes from; `None`: from infinitely far away, or from a mesh, wherever that is.
    pub fn position(&self) -> Option<DVec3> {
        match self {
            Self::Point { position, .. }
            | Self::Spot { position, .. }
            | Self::Rectangle { position, .. }
            | Self::Disc { position, .. }
            | Self::Sphere { position, .. } => Some(*position),
            Self::Distant { .. } | Self::Mesh { .. } => None,
        }
    }

    /// `[c, l, q]`, by whose `c + l·d + q·d²` its light is divided; `None`: by nothing.
    pub fn attenuation(&self) -> Option<[f64; 3]> {
        match self {
            Self::Point { attenuation, .. }
            | Self::Spot { attenuation, .. }
            | Self::Rectangle { attenuation, .. }
            | Self::Disc { attenuation, .. }
            | Self::Sphere { attenuation, .. }
            | Self::Mesh { attenuation } => Some(*attenuation),
            Self::Distant { .. } => None,
        }
    }

    /// Radius of the sphere that holds all of it or, of light from infinitely far away, degrees across
    /// of the luminous disc; 0: hard shadows. Of a mesh, which the object alone knows, +∞.
    pub fn extent(&self) -> f64 {
        match self {
            Self::Point { radius, .. }
            | Self::Spot { radius, .. }
            | Self::Disc { radius, .. }
            | Self::Sphere { radius, .. } => *radius,
            Self::Rectangle { width, height, .. } => 0.5 * (width * width + height * height).sqrt(),
            Self::Distant { angle, .. } => *angle,
            Self::Mesh { .. } => f64::INFINITY,
        }
    }

    /// Whether it has a surface that rays can see; that of a mesh is the object's own.
    pub fn has_surface(&self) -> bool {
        matches!(self, Self::Rectangle { .. } | Self::Disc { .. } | Self::Sphere { .. })
    }

    /// The way a rectangle or a disc faces, any length; `None`: it shines all around, or in a cone.
    pub fn facing(&self) -> Option<DVec3> {
        match self {
            Self::Rectangle { direction, .. } | Self::Disc { direction, .. } => Some(*direction),
            _ => None,
        }
    }

    /// Along the height of a rectangle that faces `direction`: perpendicular to that, unit. `None`: `up`
    /// is parallel to it to rounding, or `direction` is none.
    pub fn upright(direction: DVec3, up: Option<DVec3>) -> Option<DVec3> {
        /// Below this sine of the angle between them, "up" is decided by rounding.
        const PARALLEL: f64 = 1e-8;
        let direction = direction.try_normalize()?;
        let across = |up: DVec3| {
            let up = up.try_normalize()?;
            let across = up - up.dot(direction) * direction;
            (across.length() >= PARALLEL).then_some(across)?.try_normalize()
        };
        match up {
            Some(up) => across(up),
            None => across(DVec3::Y).or_else(|| across(DVec3::NEG_Z)),
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
    "rectangle" = Rectangle {
        position: DVec3::ZERO,
        direction: -DVec3::Y,
        up: None,
        width: 1.0,
        height: 1.0,
        attenuation: [1.0, 0.0, 0.0],
    },
    "disc" = Disc {
        position: DVec3::ZERO,
        direction: -DVec3::Y,
        radius: 0.5,
        attenuation: [1.0, 0.0, 0.0],
    },
    "sphere" = Sphere { position: DVec3::ZERO, radius: 0.5, attenuation: [1.0, 0.0, 0.0] },
    "mesh" = Mesh { attenuation: [1.0, 0.0, 0.0] },
});

impl Default for LightKind {
    /// Distant, with hard shadows, travelling along (−1, −2, −1): from above, right and behind.
    fn default() -> Self {
        Self::Distant { direction: DVec3::new(-1.0, -2.0, -1.0), angle: 0.0 }
    }
}
