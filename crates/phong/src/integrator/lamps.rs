//! The surfaces of lights, where rays see them.
//!
//! They are no part of the geometry: nothing is hidden from a light by a lamp, and a lamp may be moved
//! without a tree being built. A ray that sees one ends there, and brings the light's own colour as emission.

use fearless_simd::{Simd, f32x8, mask32x8, prelude::*};
use phong_bvh::{Hits8, Kernel, Rays8};

use crate::light::MOUNTED;
use crate::math::lanes::load3;
use crate::view::View;

/// The lamps that eight rays see.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lamps8 {
    /// How far each ray goes to its lamp; +∞ where it sees none.
    pub(super) t: [f32; 8],
    /// The number of the light.
    pub(super) light: [u32; 8],
    /// The rays that see one, a bit each.
    pub(super) seen: u32,
}

impl Lamps8 {
    const NONE: Self = Self { t: [f32::INFINITY; 8], light: [0; 8], seen: 0 };
}

/// Finds the nearest lamp before what each ray met, and takes from the hits what lies behind it.
pub(super) fn find(scene: &View, rays: &[Rays8], hits: &mut [Hits8], to: &mut Vec<Lamps8>) {
    to.clear();
    if scene.has_lamps() {
        to.resize(rays.len(), Lamps8::NONE);
        scene.world().run(Find { scene, rays, hits, to });
    }
}

struct Find<'a> {
    scene: &'a View,
    rays: &'a [Rays8],
    hits: &'a mut [Hits8],
    to: &'a mut [Lamps8],
}

impl Kernel for Find<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { scene, rays, hits, to } = self;
        let endless = f32x8::splat(simd, f32::INFINITY);
        for ((rays, hits), to) in rays.iter().zip(hits).zip(to) {
            let dir = load3(simd, &rays.dir);
            let met = mask32x8::from_bitmask(simd, hits.met.into());
            let hit = met.select(f32x8::load_array_ref(simd, &hits.t), endless);
            let mut nearest = endless;
            for (number, light) in scene.lights().iter().enumerate().filter(|(_, l)| l.is_seen) {
                let t = light.meet8(simd, &rays.origin, dir);
                let before = t.simd_lt(nearest) & (t * (1.0 - MOUNTED)).simd_le(hit);
                let seen = before.to_bitmask() as u32 & rays.there;
                if seen != 0 {
                    nearest = before.select(t, nearest);
                    for lane in phong_bvh::lanes(seen) {
                        to.light[lane] = number as u32;
                    }
                    to.seen |= seen;
                }
            }
            to.t = nearest.into();
            hits.met &= !to.seen;
        }
    }
}
