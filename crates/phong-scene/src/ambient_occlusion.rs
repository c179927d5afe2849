//! Ambient occlusion: how much of the ambient light finds its way to a surface.
//!
//! ```toml
//! [ambient_occlusion]
//! samples = 16
//! distance = "auto"
//! ```
//!
//! | key | value | default | meaning |
//! |---|---|---|---|
//! | `samples` | a whole number from 1 to 4096 | `16` | Rays that look for open sky, from every surface that a ray meets. |
//! | `distance` | a number above 0, or "auto" | `"auto"` | How far they look, in scene units; beyond it nothing takes ambient light away. `"auto"` is a quarter of the diagonal of the box around everything but planes. |

/// What takes ambient light away: the share of rays over the surface that meet nothing is a factor of
/// the ambient term. It holds where a scene has one of these.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AmbientOcclusion {
    /// Rays from every surface that a ray meets, ≥ 1. Default 16.
    pub samples: u32,
    /// How far they look. Default auto.
    pub distance: OcclusionDistance,
}

impl AmbientOcclusion {
    /// The most rays from a surface.
    pub const MOST_SAMPLES: u32 = 4096;
}

impl Default for AmbientOcclusion {
    fn default() -> Self {
        Self { samples: 16, distance: OcclusionDistance::Auto }
    }
}

/// How far rays look for what takes ambient light away.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum OcclusionDistance {
    /// A quarter of the diagonal of the box around everything but planes; without bounds where there is
    /// nothing else.
    #[default]
    Auto,
    /// So many scene units, above 0.
    Units(f64),
}
