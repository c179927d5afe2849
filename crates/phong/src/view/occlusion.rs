//! How far rays look for what takes ambient light away.

use phong_bvh::World;
use phong_scene::{AmbientOcclusion, OcclusionDistance, Sky};

use crate::look::Look;

/// The share of the diagonal of the box around everything that rays look, if the scene does not say how far.
const SHARE: f64 = 0.25;

/// Ambient occlusion, ready for rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Occlusion {
    /// Rays from every surface, ≥ 1.
    pub(crate) samples: u32,
    /// How far they go, scene units; infinite: as far as there is anything.
    pub(crate) distance: f32,
}

impl Occlusion {
    /// Of a look; one with a sky looks as far as there is anything, unless it says how far.
    pub(super) fn of(look: &Look, world: &World) -> Option<Self> {
        let all_around = |sky: &Sky| Self { samples: sky.samples, distance: f32::INFINITY };
        let written = look.ambient_occlusion.as_ref().map(|written| Self::new(written, world));
        written.or_else(|| look.sky.as_ref().map(all_around))
    }

    fn new(written: &AmbientOcclusion, world: &World) -> Self {
        let distance = match written.distance {
            OcclusionDistance::Units(distance) => distance,
            OcclusionDistance::Auto => {
                world.bounds().map_or(f64::INFINITY, |[low, high]| SHARE * (high - low).length())
            }
        };
        Self { samples: written.samples, distance: distance as f32 }
    }
}
