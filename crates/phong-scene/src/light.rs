//! Lights: distant, point and spot.

use glam::DVec3;

use crate::{Place, Rgb};

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
